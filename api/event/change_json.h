/* change_json.h - writes the created, deleted and modified elements of a change as JSON: in answers
 * to edit, undo and redo, in events, and in the history. */
#ifndef HE_API_EVENT_CHANGE_JSON_H
#define HE_API_EVENT_CHANGE_JSON_H

#include "api/json/json_out.h"
#include "mesh/delta.h"
#include "op/op.h"
#include "store/store.h"

/* Writes the result of one operation, an object of the list `results`:
 * {"op":"edge_split","vertex":17,"edges":[30,31,32]}. */
void api_write_results(api_out *out, const he_op *op, const he_results *results);

/* Writes the changes into an object that is open: the members created, deleted, modified, parents
 * and merged. If the content was replaced as a whole, the sets are empty and "replaced":true is
 * added. */
void api_write_changes(api_out *out, const he_changes *changes);

/* Returns the name of an action: "edit", "undo", "redo" or "replace". */
const char *api_action_name(st_action action);

#endif
