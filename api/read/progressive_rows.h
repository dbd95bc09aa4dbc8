/* progressive_rows.h - the binary answer of GET .../progressive: a coarse mesh, and the vertex
 * splits that refine it to the present mesh. algo/progressive.h explains vertex splits.
 *
 * All values are little-endian, and 0xFFFFFFFF stands for none.
 *
 *     0   4   "HEDP"
 *     4   u32 version of this layout of bytes, 1
 *     8   u64 revision
 *     16  u32 vertices, edges and faces of the base
 *     28  u32 vertex splits in this answer; u32 vertex splits in total; u32 0
 *     40  u32 x 3 upper bounds of the ids of vertices, edges and faces; u32 0
 *     56  f64 x 3 least and f64 x 3 largest coordinates of the present mesh
 *     104 the base's vertices: u32 id, u32 0, f64 x 3 position
 *         its edges: u32 id, u32 origin and u32 target of half-edge 2 * id, u32 0
 *         its faces: u32 id, u32 x 3 corners, counter-clockwise
 *         the splits, coarse to fine:
 *
 *     0   u32 bytes of this split, a multiple of 8
 *     4   u32 the new vertex, u32 the vertex that is split
 *     12  u32 left and u32 right corner beside the edge between them
 *     20  u32 x 3 half-edges from the new vertex: to the split vertex, the left and right corner
 *     32  u32 left face and u32 right face, which are created
 *     40  u32 number of faces that move to the new vertex, u32 0
 *     48  f64 x 3 position of the new vertex, f64 x 3 of the split vertex
 *     96  u32 each: those faces, in which the new vertex replaces the split vertex; then
 *         zeros
 *
 * The id of a half-edge halved is the id of its edge; a half-edge with an even id has the direction
 * of its edge. The corners of the left face are new vertex, split vertex, left corner; those of the
 * right face are split vertex, new vertex, right corner. Edges from the split vertex to corners of
 * faces that move also move to the new vertex, except those to the left and right corner. The mesh
 * is valid after any number of splits. */
#ifndef HE_API_READ_PROGRESSIVE_ROWS_H
#define HE_API_READ_PROGRESSIVE_ROWS_H

#include "algo/decimate.h"
#include "algo/progressive.h"

enum { API_SPLIT_BYTES = 96 + 4 * HE_DECIMATE_DEGREE + 8 };

/* A progressive mesh while it is sent: it keeps only what is still to be sent. */
typedef struct api_progressive {
    he_progressive mesh; /* the splits to send; its base is freed by api_progressive_write */
    uint64_t revision;
    size_t wanted; /* number of splits to send */
    uint32_t issued[HE_KIND_COUNT];
    he_vec3 low, high;
    unsigned char *base; /* the bytes of the header and of the elements of the base */
    size_t base_bytes, base_sent;
    size_t next; /* index of the next split to send */
    size_t begin, end;
    unsigned char split[API_SPLIT_BYTES];
} api_progressive;

void api_progressive_clear(api_progressive *p);

/* Writes the bytes of the base, and frees the base's mesh and the splits that the answer does not
 * contain. The caller must have set the members of `p` from the first to `high`. `progress` may be
 * NULL.
 * Returns HE_NO_MEMORY or HE_CANCELLED. */
HE_NODISCARD he_status api_progressive_write(api_progressive *p, he_progress *progress,
                                             he_error *err);
/* Returns the size of the answer in bytes; it must be called after api_progressive_write. */
int64_t api_progressive_bytes(const api_progressive *p);
/* Reads the next bytes of the answer; returns 0 at its end. */
size_t api_progressive_read(api_progressive *p, char *buffer, size_t size);

#endif
