/* changes.h - what came, went and changed: in the answer to an edit, an undo and a redo, in an
 * event, and in the history. */
#ifndef HE_API_EVENT_CHANGES_H
#define HE_API_EVENT_CHANGES_H

#include "api/json/json_out.h"
#include "mesh/delta.h"
#include "op/op.h"
#include "store/store.h"

/* One object of `results`: {"op":"edge_split","vertex":17,"edges":[30,31,32]}. */
void api_write_results(api_out *out, const he_op *op, const he_results *results);

/* The members created, deleted, modified, parents and merged of an object that is open; and
 * "replaced":true where the content was changed as a whole and the sets are empty. */
void api_write_changes(api_out *out, const he_changes *changes);

/* "edit", "undo", "redo", "replace". */
const char *api_action_name(st_action action);

#endif
