/* geometry_rows.h - the binary answers of GET .../geometry: chooses and writes their rows.
 *
 * An answer holds all rows of one revision, or only those that changed since an earlier one. All
 * values are little-endian.
 *
 *     0   4   "HEDG"
 *     4   u32 version of this layout of bytes, 2
 *     8   u64 revision
 *     16  u64 base: the earlier revision whose rows these replace; 0: these are all rows
 *     24  u64 bytes of the vertex part, then u64 bytes of the triangle part
 *     40  u32 vertex rows, then u32 triangle rows of the revision
 *     48  f64 x 3 origin, f64 scale: a vertex row holds (position - origin) * scale
 *     80  u64 layout: identifies the placement of triangles, below 2^53
 *     88  u32 vertex rows, then u32 triangle rows in this answer
 *     96  the vertex part, then the triangle part
 *
 *     base 0      vertices f32 x 4, row i for id i; triangles u32 x 4, row i for slot i
 *     else        u32 each: the row numbers, ascending, and zeros up to a multiple of 16 bytes;
 *                 then the rows, vertices f32 x 4, triangles u32 x 4
 *
 * draw/draw_arrays.h says what a row contains. Row i of the triangles is called slot i; the row of
 * a slot without a triangle is four zeros. Each list begins at a multiple of 16 bytes. Within a
 * layout the numbers of rows never decrease, and new rows that are not in the answer are zeros.
 *
 * A CLIENT fetches all rows, draws, and then requests ?since=REVISION&layout=LAYOUT with its own
 * revision and layout. If the answer's base is 0, it starts again with these rows. Otherwise it
 * extends its arrays with zeros to the numbers of rows in the header and replaces the rows listed.
 * The client's arrays are then equal, byte for byte, to all rows of the answer's revision. Origin
 * and scale do not change within a layout. */
#ifndef HE_API_READ_GEOMETRY_ROWS_H
#define HE_API_READ_GEOMETRY_ROWS_H

#include "draw/draw_slots.h"
#include "store/store.h"

enum { API_ROWS_AT_ONCE = 1024, API_ROW_BYTES = 16 };

/* The rows of an answer, and how far the answer was read. {0} has no rows. */
typedef struct api_rows {
    uint64_t revision, base, layout;
    he_frame frame;
    uint32_t vertices, triangles; /* how many rows of vertices and of triangles the revision has */
    he_ids vertex_ids, slot_ids;  /* numbers of the rows to send, if `base` is not 0 */
    uint32_t *owner; /* the face of each triangle to send, or a mark for none (draw_slots.h) */
    he_draw_arrays drawing;
    he_draw_arrays_walk walk;
    int part;
    /* The next row or id to write, in the part of the answer that is being written. */
    uint32_t next;
    size_t begin, end; /* `begin` to `end` is the part of `buffer` that was not read yet */
    unsigned char buffer[API_ROWS_AT_ONCE * API_ROW_BYTES];
} api_rows;

/* api_rows_take_all chooses all rows, to be sent; api_rows_take_changes chooses the rows that
 * changed after revision `since`. `slots` is not used after the call.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_UNSUPPORTED if the changed rows are not known, so that all rows must be sent.
 * Returns HE_LIMIT if more than `most` changes would have to be visited. */
HE_NODISCARD he_status api_rows_take_all(api_rows *rows, const he_draw_slots *slots, he_error *err);
HE_NODISCARD he_status api_rows_take_changes(api_rows *rows, const he_draw_slots *slots,
                                             uint64_t since, uint64_t most, he_error *err);
/* Returns the number of rows that the answer will contain. */
uint64_t api_rows_count(const api_rows *rows);
/* Prepares to read the rows. `mesh` must be at the revision of the rows and must not change until
 * the last row was read. On failure nothing changes.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_LIMIT if the changed rows take more than `most` steps. */
HE_NODISCARD he_status api_rows_draw(api_rows *rows, const he_mesh *mesh, uint64_t most,
                                     he_error *err);
/* Returns the size of the answer in bytes. */
int64_t api_rows_bytes(const api_rows *rows);
/* Reads the next bytes of the answer; returns 0 at its end. */
size_t api_rows_read(api_rows *rows, char *buffer, size_t size);
void api_rows_clear(api_rows *rows);

#endif
