/* cursor.h - the opaque string, called a cursor, with which a client requests the next page of a
 * list.
 *
 * It holds the incarnation and revision of the mesh, the name of the collection, and the first id
 * of the next page. It is not secret. A cursor that was tampered with is refused (bad_cursor) or
 * addresses another position in the same collection. */
#ifndef HE_API_HEADER_CURSOR_H
#define HE_API_HEADER_CURSOR_H

#include "store/store.h"

#include "api/json/problem.h"

enum { API_CURSOR = 96 };

/* Writes a cursor. `collection` is a short word of lower case letters, such as "vertices". */
void api_cursor_write(const char *collection, const st_mesh_info *info, uint64_t position,
                      char out[API_CURSOR]);
/* Reads the revision of the mesh that a cursor belongs to. Returns false if the cursor is not of
 * this mesh. */
bool api_cursor_pins(const char *text, const st_mesh_info *info, uint64_t *revision);
/* Reads the position in a cursor.
 * Returns false with bad_cursor, or with revision_gone if the cursor is of another mesh: one that
 * had this id before, or one with another id. The cursor does not show which. */
bool api_cursor_read(const char *text, const char *collection, const st_mesh_info *info,
                     uint64_t *position, api_problem *problem);

#endif
