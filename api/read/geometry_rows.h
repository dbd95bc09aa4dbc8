/* geometry_rows.h - the answers of GET .../geometry as bytes: which rows, and how they are written.
 *
 * An answer holds all rows of one revision, or those that a revision before it does not have. All
 * values are little-endian.
 *
 *     0   4   "HEDG"
 *     4   u32 version of this layout of bytes, 2
 *     8   u64 revision
 *     16  u64 base: the revision that these rows are a change of, 0: of none, they are all
 *     24  u64 bytes of the part of vertices, then u64 bytes of the part of triangles
 *     40  u32 rows of vertices, then u32 rows of triangles, that there are at the revision
 *     48  f64 x 3 origin, f64 scale: (position - origin) * scale is what a vertex holds
 *     80  u64 layout: which places the triangles have, below 2^53
 *     88  u32 rows of vertices, then u32 rows of triangles, that are in this answer
 *     96  the part of vertices, then the part of triangles
 *
 *     base 0      vertices f32 x 4, row i that of id i; triangles u32 x 4, row i that of slot i
 *     else        u32 each: the places of the rows, rising, and zeros up to a multiple of 16 bytes;
 *                 then as many rows, of vertices f32 x 4, of triangles u32 x 4
 *
 * See draw/drawing.h for the rows; slots without a face are four zeros. Each list begins at a
 * multiple of 16. Numbers of rows never fall within a layout, and rows that are new and not listed
 * are zeros.
 *
 * A CLIENT fetches all, draws, and then asks for ?since=REVISION&layout=LAYOUT with the ones it is
 * at. Where the answer's base is 0 it starts afresh. Otherwise it grows its arrays with zeros to
 * the numbers of rows in the header, puts each row in its place, and is at the answer's revision,
 * byte for byte what fetching all would have given. The frame stays within a layout. */
#ifndef HE_API_READ_GEOMETRY_ROWS_H
#define HE_API_READ_GEOMETRY_ROWS_H

#include "draw/slots.h"
#include "store/store.h"

enum { API_ROWS_AT_ONCE = 1024, API_ROW_BYTES = 16 };

/* Rows to send and how far they are. {0} is cleared. */
typedef struct api_rows {
    uint64_t revision, base, layout;
    he_frame frame;
    uint32_t vertices, triangles; /* that there are */
    he_ids vertex_ids, slot_ids;  /* places of those to send, where base is not 0 */
    uint32_t *owner;              /* of each triangle to send: see slots.h */
    he_drawing drawing;
    he_drawing_walk walk;
    int part;
    uint32_t next;     /* row of the part */
    size_t begin, end; /* of what is not read yet in the buffer */
    unsigned char buffer[API_ROWS_AT_ONCE * API_ROW_BYTES];
} api_rows;

/* Take note of all rows, or of those changed since a revision; nothing of the slots is needed
 * afterwards. HE_NO_MEMORY; HE_UNSUPPORTED where only all rows will do; HE_LIMIT where more than
 * `most` changes must be looked at. */
HE_NODISCARD he_status api_rows_take_all(api_rows *rows, const he_slots *slots, he_error *err);
HE_NODISCARD he_status api_rows_take_changes(api_rows *rows, const he_slots *slots, uint64_t since,
                                             uint64_t most, he_error *err);
/* How many rows are to be sent. */
uint64_t api_rows_count(const api_rows *rows);
/* Prepare to draw them from a mesh at their revision, which must not change until the last is read.
 * HE_NO_MEMORY; HE_LIMIT when changed rows take more than `most` steps. Then nothing is prepared.
 */
HE_NODISCARD he_status api_rows_draw(api_rows *rows, const he_mesh *mesh, uint64_t most,
                                     he_error *err);
/* Of the answer. */
int64_t api_rows_bytes(const api_rows *rows);
/* The next bytes of the answer, 0 at its end. */
size_t api_rows_read(api_rows *rows, char *buffer, size_t size);
void api_rows_clear(api_rows *rows);

#endif
