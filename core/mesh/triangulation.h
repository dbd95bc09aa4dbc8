/* triangulation.h - choosing the triangles that fill a loop.
 *
 * A triangulation lists them in an order in which each cuts one corner, its middle one, off what
 * is left of the loop; the last one is what is left.
 *
 * Loops of up to HE_EXACT_CORNERS corners get the triangulation with the fewest triangles that do
 * not turn left in the Newell plane, none for a simple polygon, and among those the shortest
 * diagonals (G. T. Klincsek, "Minimal triangulations of polygonal domains", 1980).
 *
 * Longer loops are cut ear by ear (G. H. Meisters, "Polygons have ears", 1975), going round so
 * that the triangles stay balanced. Where there is no ear at all, which happens only in loops that
 * meet themselves in the plane, any corner is cut. The work is the corners times the reflex
 * corners.
 *
 * With HE_ANY_DIAGONALS short loops are cut ear by ear too, and only those where that turns a
 * triangle over are searched for the best: for who wants triangles, and many of them soon. The
 * work for a loop is counted, and limited.
 *
 * With HE_AVOID_EDGES no diagonal is an edge that exists: an edit would double it. Short loops
 * avoid them wherever that costs no triangle that is turned over. In long ones an ear whose
 * diagonal exists is passed over; when only such are left the loop is refused, though another order
 * of cuts might have done.
 *
 * All depends on nothing but the loop, its first half-edge and the mesh's edges. */
#ifndef HE_MESH_TRIANGULATION_H
#define HE_MESH_TRIANGULATION_H

#include "mesh/flat.h"
#include "mesh/joins.h"

enum { HE_EXACT_CORNERS = 64 };
#define HE_TRIANGULATION_STEPS ((uint64_t)1 << 28)

typedef struct he_triangulation {
    he_flat flat;
    uint32_t *corners; /* three a triangle, counter-clockwise, of flat.n - 2 triangles */
    bool degenerate;   /* some triangle has no area in the plane, or is seen from behind */
    uint64_t steps;    /* that were taken */
} he_triangulation;

/* What many loops share; {0} begins it. */
typedef struct he_triangulation_work {
    uint64_t steps;        /* that were taken, for loops that were refused too */
    const he_joins *joins; /* NULL: edges are looked for round their ends */
} he_triangulation_work;

enum { HE_AVOID_EDGES = 1, HE_ANY_DIAGONALS = 2 };

/* `work` NULL: of this loop alone. HE_DOUBLED_EDGE when none was found that avoids the edges there
 * are, HE_LIMIT when the work would come to more than HE_TRIANGULATION_STEPS, HE_NO_MEMORY.
 * he_triangulation_clear frees. */
HE_NODISCARD he_status he_triangulation_make(const he_mesh *m, he_halfedge first, unsigned flags,
                                             he_triangulation_work *work, he_triangulation *out,
                                             he_error *err);
void he_triangulation_clear(he_triangulation *triangulation);

#endif
