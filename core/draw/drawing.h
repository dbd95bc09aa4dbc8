/* drawing.h - a mesh as the two arrays from which a renderer draws it.
 *
 * VERTICES, one row an id ever issued, so that a vertex's place is its id: x, y, z, state. The
 * state is HE_DRAWN_USED, HE_DRAWN_ISOLATED, or HE_DRAWN_DEAD in a row that is otherwise zero.
 *
 * TRIANGLES, degree - 2 of each live face: three vertices and a word
 *
 *            c              bits 0-28: the face's id
 *           / \             bit 29: a -> b is an edge of the polygon
 *          /   \            bit 30: b -> c
 *         a-----b           bit 31: c -> a
 *
 * A side whose bit is clear is a diagonal. Sides that are edges run as the face does.
 *
 * A vertex's row depends on that vertex and the frame, a face's triangles on the face, the order of
 * its corners from the stored half-edge, their positions unless it is a triangle, and the frame: an
 * edit changes the rows of what it touches and no others. Which places the triangles have is left
 * to whoever keeps the array: see slots.h.
 *
 * A face whose corners are all seen from its first one is the fan about it; a quadrilateral is cut
 * along the diagonal that turns no triangle over, the shorter one where both do not; others are cut
 * as triangulation.h says. */
#ifndef HE_DRAW_DRAWING_H
#define HE_DRAW_DRAWING_H

#include "mesh/mesh.h"

/* Where positions are moved to before they become floats: (p - origin) * scale lies within the unit
 * ball for every vertex that has edges, and for isolated ones that are not farther from the middle
 * of the box of those than 4,096 times half of its longest side. Isolated vertices that lie beyond
 * would leave floats no digits for what else there is: their rows say where the way to them leaves
 * the ball, which is not where they are. Where no vertex has edges the ball holds all. The scale is
 * a power of two and the origin a multiple of an eighth of its inverse: an edit that hardly changes
 * the box leaves the frame alone, and with it the rows of what did not move. A box below 2^-1021,
 * or 2^-900 of its largest coordinate, is drawn smaller than the ball. */
typedef struct he_frame {
    he_vec3 origin;
    double scale;
} he_frame;

he_frame he_frame_of(const he_mesh *m);

enum { HE_DRAWN_DEAD = 0, HE_DRAWN_USED = 1, HE_DRAWN_ISOLATED = 2 };
enum { HE_DRAWN_SIDES = 29, HE_DRAWN_ROW = 4 }; /* shift of the bits; words a row, in both arrays */

typedef struct he_drawing {
    const he_mesh *mesh;
    he_frame frame;
    uint32_t *cut; /* rows of the faces that are no fan, in the order of faces */
    size_t cut_rows;
    size_t cut_capacity;
} he_drawing;

/* Prepare to draw all faces. Borrows the mesh, which must not change while it is drawn, and whose
 * vertices with edges `frame` must keep in the ball. HE_NO_MEMORY; HE_IDS_EXHAUSTED where a face's
 * id does not fit its bits. he_drawing_clear frees. */
HE_NODISCARD he_status he_drawing_init(he_drawing *drawing, const he_mesh *m, const he_frame *frame,
                                       he_error *err);
/* Prepares, as he_drawing_init does, to draw some live faces only, in rising order. Returns
 * HE_LIMIT if those that are no fan would take more than `most` steps: for each of their corners
 * one for each of the face's, HE_EXACT_CORNERS at most. */
HE_NODISCARD he_status he_drawing_init_faces(he_drawing *drawing, const he_mesh *m,
                                             const he_frame *frame, const uint32_t *faces,
                                             size_t count, uint64_t most, he_error *err);
void he_drawing_clear(he_drawing *drawing);

/* Any issued row. */
void he_drawing_vertex(const he_drawing *drawing, uint32_t id, float out[HE_DRAWN_ROW]);

/* Where a walk over the triangles of a face is. {0} is after the last. */
typedef struct he_drawing_walk {
    uint32_t face, left; /* triangles to come */
    uint32_t apex, at;   /* half-edges: what leaves the fan's middle, the outer side to come */
    const uint32_t *cut; /* the row to come where the face is no fan, else NULL */
} he_drawing_walk;

/* Begin with a face that was prepared for. The triangles come in one order, whenever they are asked
 * for. Neither can fail: what needs memory was done in init. False after the last one. */
void he_drawing_begin(const he_drawing *drawing, uint32_t face, he_drawing_walk *walk);
bool he_drawing_next(const he_drawing *drawing, he_drawing_walk *walk, uint32_t out[HE_DRAWN_ROW]);

#endif
