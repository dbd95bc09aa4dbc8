/* progressive_rows.h - the answer of GET .../progressive as bytes: a coarse mesh, and the vertex
 * splits that make it finer up to the mesh as it is. See algo/progressive.h for what they mean.
 *
 * All values are little-endian, and 0xFFFFFFFF stands for none.
 *
 *     0   4   "HEDP"
 *     4   u32 version of this layout of bytes, 1
 *     8   u64 revision
 *     16  u32 vertices, edges and faces of the base
 *     28  u32 vertex splits in this answer; u32 vertex splits there are; u32 0
 *     40  u32 ids issued of vertices, edges and faces: all ids are below; u32 0
 *     56  f64 x 3 the least and f64 x 3 the largest coordinates of the mesh as it is
 *     104 the base's vertices: u32 id, u32 0, f64 x 3 position
 *         its edges: u32 id, u32 origin and u32 target of half-edge 2 * id, u32 0
 *         its faces: u32 id, u32 x 3 corners, counter-clockwise
 *         the splits, coarse to fine:
 *
 *     0   u32 bytes of this split, a multiple of 8
 *     4   u32 the new vertex, u32 the one it leaves
 *     12  u32 left and u32 right corner beside the edge between them
 *     20  u32 half-edge from the new vertex to the one it leaves, to the left and the right corner
 *     32  u32 left face and u32 right face, which come back
 *     40  u32 number of faces that go over, u32 0
 *     48  f64 x 3 position of the new vertex, f64 x 3 of the one it leaves
 *     96  u32 each: faces that go over, where the new vertex takes the corner of the other; then
 *         zeros
 *
 * A half-edge's edge is its id halved; an even one runs as its edge does. The left face is new
 * vertex, the one it leaves, left corner; the right face is the one it leaves, new vertex, right
 * corner. Edges from the one it leaves to other corners of faces that go over go over too, but for
 * those to the left and right corner. Any number of splits may be done, and leaves a valid mesh. */
#ifndef HE_API_READ_PROGRESSIVE_ROWS_H
#define HE_API_READ_PROGRESSIVE_ROWS_H

#include "algo/decimate.h"
#include "algo/progressive.h"

enum { API_SPLIT_BYTES = 96 + 4 * HE_DECIMATE_DEGREE + 8 };

/* A progressive mesh on its way: what is held is what is to be sent. */
typedef struct api_progressive {
    he_progressive mesh; /* its base goes when it has been written */
    uint64_t revision;
    size_t wanted; /* splits */
    uint32_t issued[HE_KIND_COUNT];
    he_vec3 low, high;
    unsigned char *base; /* the header, and the elements of the base */
    size_t base_bytes, base_sent;
    size_t next; /* split */
    size_t begin, end;
    unsigned char split[API_SPLIT_BYTES];
} api_progressive;

void api_progressive_clear(api_progressive *p);

/* Write the base, and let go of its mesh and of the splits that are not wanted. All members down to
 * `high` are set. `watch` may be NULL. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status api_progressive_write(api_progressive *p, he_watch *watch, he_error *err);
/* Of the answer; after write. */
int64_t api_progressive_bytes(const api_progressive *p);
/* The next bytes of it, 0 at its end. */
size_t api_progressive_read(api_progressive *p, char *buffer, size_t size);

#endif
