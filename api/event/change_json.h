/* change_json.h - writes the created, deleted and modified elements of a change as JSON: for
 * answers to edits, undo and redo, and for events. */
#ifndef HE_API_EVENT_CHANGE_JSON_H
#define HE_API_EVENT_CHANGE_JSON_H

#include "api/json/json_out.h"
#include "mesh/delta.h"
#include "op/op.h"
#include "store/store.h"

/* Writes the results of one operation as an object, for the list `results`:
 * {"op":"edge_split","vertex":17,"edges":[30,31,32]}. If it ran once for each item of a list, the
 * results are columns: {"op":"edge_split","each":{"vertex":[17,18],"edges":[[30,31],[32]]}}. */
void api_write_results(api_out *out, const he_op *op, const he_results *results);

/* Writes the members created, deleted, modified, parents and merged into an object that the caller
 * has begun. If the whole content of the mesh was replaced, their lists are empty and
 * "replaced":true is added. */
void api_write_changes(api_out *out, const he_changes *changes);

/* Returns the name of the kind of action that made a revision: "edit", "undo", "redo" or
 * "replace". */
const char *api_action_name(st_action action);

#endif
