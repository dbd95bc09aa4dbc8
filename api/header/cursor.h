/* cursor.h - the opaque string that continues a page.
 *
 * It pins the incarnation and revision of the mesh, names the collection, and holds the first id
 * not yet given. It is not secret; a cursor that was tampered with is refused (bad_cursor) or names
 * another place of the same collection. */
#ifndef HE_API_HEADER_CURSOR_H
#define HE_API_HEADER_CURSOR_H

#include "store/store.h"

#include "api/json/problem.h"

enum { API_CURSOR = 96 };

/* `collection` is a short word of lower case letters, such as "vertices". */
void api_cursor_write(const char *collection, const st_mesh_info *info, uint64_t position,
                      char out[API_CURSOR]);
/* The revision a cursor pins. False when it is none of this mesh. */
bool api_cursor_pins(const char *text, const st_mesh_info *info, uint64_t *revision);
/* bad_cursor; revision_gone where it is of another mesh: one that had the id before, or has another
 * id. A cursor does not tell which. */
bool api_cursor_read(const char *text, const char *collection, const st_mesh_info *info,
                     uint64_t *position, api_problem *problem);

#endif
