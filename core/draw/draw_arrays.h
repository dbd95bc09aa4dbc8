/* draw_arrays.h - a mesh as two arrays for a renderer.
 *
 * VERTICES, one row for each id ever issued, so that a vertex's index is its id: x, y, z, state.
 * The state is HE_DRAWN_USED, HE_DRAWN_ISOLATED, or HE_DRAWN_DEAD for a deleted vertex, whose row
 * is otherwise zero.
 *
 * TRIANGLES, degree - 2 for each live face: three vertices and a word
 *
 *            c              bits 0-28: the face's id
 *           / \             bit 29: a -> b is an edge of the polygon
 *          /   \            bit 30: b -> c
 *         a-----b           bit 31: c -> a
 *
 * A side whose bit is clear is a diagonal. Sides that are edges have the direction of the face's
 * half-edges.
 *
 * A vertex's row depends on that vertex and the frame (he_frame). A face's triangles depend on the
 * face, the order of its corners from the stored half-edge, their positions unless the face is a
 * triangle, and the frame. So an edit changes only the rows of elements that it touches. The caller
 * decides where in the array the triangles of a face are: see draw_slots.h.
 *
 * A face whose corners are all visible from its first one is drawn as the fan of triangles at that
 * corner; a quadrilateral is cut along the diagonal that makes no flipped triangle, or along the
 * shorter diagonal if neither makes one; all other faces are cut as triangulation.h says. */
#ifndef HE_DRAW_DRAW_ARRAYS_H
#define HE_DRAW_DRAW_ARRAYS_H

#include "mesh/mesh.h"

/* A frame transforms positions before they become floats: (p - origin) * scale is within the unit
 * ball for every vertex that has edges. The ball also contains an isolated vertex, unless its
 * distance from the centre of the bounding box of the vertices with edges is more than 4,096 times
 * half of the box's longest side: in a larger frame the floats would have too few digits for the
 * rest of the mesh, so such a vertex is drawn at the point where the line to it leaves the ball. If
 * no vertex has edges, the ball contains all vertices.
 *
 * The scale is a power of two, and the origin a multiple of an eighth of its inverse: so an edit
 * that hardly changes the box does not change the frame, nor the rows of vertices that did not
 * move. A mesh whose box has a longest side below 2^-1021, or below 2^-900 of its largest
 * coordinate, is drawn much smaller than the ball. */
typedef struct he_frame {
    he_vec3 origin;
    double scale;
} he_frame;

he_frame he_frame_of(const he_mesh *m);

enum { HE_DRAWN_DEAD = 0, HE_DRAWN_USED = 1, HE_DRAWN_ISOLATED = 2 };
enum {
    HE_DRAWN_SIDES = 29, /* the first of the three bits that mark sides as edges */
    HE_DRAWN_ROW = 4     /* number of words in a row of either array */
};

typedef struct he_draw_arrays {
    const he_mesh *mesh;
    he_frame frame;
    uint32_t *cut; /* triangles of the faces that are not drawn as fans, in the order of faces */
    size_t cut_rows;
    size_t cut_capacity;
} he_draw_arrays;

/* Prepares to draw all faces. Borrows the mesh, which must not change while it is drawn; `frame`
 * must bring all vertices that have edges into the unit ball. he_draw_arrays_clear frees the
 * drawing.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the id of a face does not fit into 29 bits. */
HE_NODISCARD he_status he_draw_arrays_init(he_draw_arrays *drawing, const he_mesh *m,
                                           const he_frame *frame, he_error *err);
/* Prepares like he_draw_arrays_init, but to draw only some live faces, which must be in rising
 * order.
 * Returns HE_LIMIT if the faces that are not drawn as fans would take more than `most` steps. A
 * face of n corners takes n * n steps, or n * HE_EXACT_CORNERS if that is less. */
HE_NODISCARD he_status he_draw_arrays_init_faces(he_draw_arrays *drawing, const he_mesh *m,
                                                 const he_frame *frame, const uint32_t *faces,
                                                 size_t count, uint64_t most, he_error *err);
void he_draw_arrays_clear(he_draw_arrays *drawing);

/* Writes the row of vertex `id`, which may be deleted. */
void he_draw_arrays_vertex(const he_draw_arrays *drawing, uint32_t id, float out[HE_DRAWN_ROW]);

/* The position of a walk over the triangles of a face. {0} is a walk that has ended. */
typedef struct he_draw_arrays_walk {
    /* `face` is the face, `left` the number of its triangles that the walk has not reached */
    uint32_t face, left;
    /* half-edges: `apex` leaves the apex of the fan, `at` is the outer side of the next triangle */
    uint32_t apex, at;
    /* the next triangle in he_draw_arrays.cut if the face is not drawn as a fan, else NULL */
    const uint32_t *cut;
} he_draw_arrays_walk;

/* Begins a walk over the triangles of a face that was prepared, always in the same order. The walk
 * cannot fail, because he_draw_arrays_init has allocated its memory. he_draw_arrays_next writes the
 * next triangle; it returns false after the last one. */
void he_draw_arrays_begin(const he_draw_arrays *drawing, uint32_t face, he_draw_arrays_walk *walk);
bool he_draw_arrays_next(const he_draw_arrays *drawing, he_draw_arrays_walk *walk,
                         uint32_t out[HE_DRAWN_ROW]);

#endif
