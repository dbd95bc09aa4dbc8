/* triangles.h - choosing and making the triangles that fill a loop. */
#ifndef HE_EDIT_TRIANGLES_H
#define HE_EDIT_TRIANGLES_H

#include "edit/flat.h"
#include "mesh/write.h"

/* A plan lists the triangles in an order in which each cuts one corner, its middle one, off what
 * is left of the loop; the last one is what is left.
 *
 * Loops of up to HE_EXACT_CORNERS corners get the triangulation with the fewest triangles that do
 * not turn left in the Newell plane, none for a simple polygon, and among those the shortest
 * diagonals (G. T. Klincsek, "Minimal triangulations of polygonal domains", 1980). Diagonals that
 * exist as edges are avoided wherever that costs no such triangle.
 *
 * Longer loops are cut ear by ear (G. H. Meisters, "Polygons have ears", 1975), going round so
 * that the triangles stay balanced. An ear whose diagonal exists as an edge is passed over; when
 * only such are left the loop is refused, though another order of cuts might have done. Where
 * there is no ear at all, which happens only in loops that meet themselves in the plane, any
 * corner is cut. The work is the corners times the reflex corners, and limited.
 *
 * Both depend on nothing but the loop, its first half-edge and the mesh's edges. */
enum { HE_EXACT_CORNERS = 64 };
#define HE_EAR_TESTS ((uint64_t)1 << 28)

typedef struct he_triangles {
    he_flat flat;
    uint32_t *corners; /* three a triangle, counter-clockwise, of flat.n - 2 triangles */
    uint32_t *side;    /* COMMIT's: the half-edge that leaves each corner in what is left */
    bool degenerate;   /* some triangle has no area in the plane, or is seen from behind */
} he_triangles;

/* CHECK: HE_DOUBLED_EDGE when none was found that avoids the edges there are, HE_LIMIT when a loop
 * would take more than HE_EAR_TESTS tests, HE_NO_MEMORY. he_triangles_clear frees. */
HE_NODISCARD he_status he_triangles_plan(const he_mesh *m, he_halfedge first, he_triangles *out,
                                         he_error *err);
void he_triangles_clear(he_triangles *plan);

/* COMMIT. With `keep` the loop is a face: the triangle of its stored half-edge keeps its id, the
 * others descend from it, and corners copy its corners. Without, the loop is a hole, all triangles
 * are new, and its vertices are left for he_ring_settle. Half-edge 2e of a new edge runs along
 * the triangle that was cut off. `edges` and `faces` have room, or are NULL. */
void he_triangles_need(const he_triangles *plan, bool keep, he_need *need);
void he_triangles_commit(he_mesh *m, he_triangles *plan, bool keep, he_ids *edges, he_ids *faces);

#endif
