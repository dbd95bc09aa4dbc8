/* cursor.h - the opaque string, called a cursor, with which a client requests the next page of a
 * list.
 *
 * A cursor holds the incarnation and revision of the mesh, the name of the collection, and the
 * first id of the next page. It is not secret. A cursor that was tampered with is refused
 * (bad_cursor) or addresses another position in the same collection. */
#ifndef HE_API_HEADER_CURSOR_H
#define HE_API_HEADER_CURSOR_H

#include "store/store.h"

#include "api/json/problem.h"

enum { API_CURSOR = 96 };

/* Writes the cursor of the page that begins at `position`. `collection` is a short word of lower
 * case letters, such as "vertices". */
void api_cursor_write(const char *collection, const st_mesh_info *info, uint64_t position,
                      char out[API_CURSOR]);
/* Reads the revision of the mesh to which a cursor belongs. Returns false if the cursor belongs to
 * another mesh. */
bool api_cursor_pins(const char *text, const st_mesh_info *info, uint64_t *revision);
/* Reads the position in a cursor.
 * Returns false with bad_cursor, or with revision_gone if the cursor belongs to another mesh: to an
 * earlier mesh with the same id, or to a mesh with another id (the cursor does not show which). */
bool api_cursor_read(const char *text, const char *collection, const st_mesh_info *info,
                     uint64_t *position, api_problem *problem);

#endif
