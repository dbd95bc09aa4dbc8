/* triangulation.h - choosing the triangles that fill a loop.
 *
 * A triangulation lists them in an order in which each cuts one corner, its middle one, off what
 * is left of the loop; the last one is what is left.
 *
 * Loops of up to HE_EXACT_CORNERS corners get the triangulation with the fewest triangles that do
 * not turn left in the Newell plane, none for a simple polygon, and among those the shortest
 * diagonals (G. T. Klincsek, "Minimal triangulations of polygonal domains", 1980).
 *
 * Longer loops are cut ear by ear: see ears.h.
 *
 * With HE_ANY_DIAGONALS short loops are cut ear by ear too, and only those where that turns a
 * triangle over are searched for the best: for callers that want triangles, and many of them soon.
 *
 * With HE_AVOID_EDGES no diagonal is an edge that exists: an edit would double it. Short loops
 * avoid them wherever that costs no triangle that is turned over. In long ones an ear whose
 * diagonal exists is passed over; when only such are left the loop is refused, though another order
 * of cuts might have done. Where no diagonal of the triangulation exists as an edge, the flag
 * changes nothing.
 *
 * WORK. A short loop takes at most three tables of HE_EXACT_CORNERS cubed / 6 steps, a long one of
 * n corners about n log n. Looking for edges costs a few steps for each diagonal: where it costs
 * more, the edges at vertices of many are sorted (joins.h). So the work for the loops of a mesh is
 * bounded by its corners and needs no limit.
 *
 * A mesh that keeps the triangulations of its long faces (long_faces.h) lends them.
 *
 * All depends on nothing but the loop, its first half-edge and the mesh's edges. */
#ifndef HE_GEOMETRY_TRIANGULATION_H
#define HE_GEOMETRY_TRIANGULATION_H

#include "base/watch.h"
#include "geometry/flat.h"
#include "geometry/joins.h"

enum { HE_EXACT_CORNERS = 64 };

typedef struct he_triangulation {
    he_flat flat;      /* without x and y where the mesh kept the triangulation */
    uint32_t *corners; /* three a triangle, counter-clockwise, of flat.n - 2 triangles */
    bool degenerate;   /* some triangle has no area in the plane, or is seen from behind */
    uint64_t steps;    /* that were taken */
} he_triangulation;

/* What many loops of a mesh share; {0} begins it. The mesh may not change but by the diagonals of
 * its loops, which the caller notes in `own` (he_joins_reserve, he_joins_note). */
typedef struct he_triangulation_work {
    uint64_t steps;        /* that were taken, for loops that were refused too */
    uint64_t searched;     /* of these, to look for edges */
    const he_joins *joins; /* NULL: edges are looked for around their ends */
    he_joins own;    /* `joins`, once it is worth making them; notes of the caller's diagonals */
    uint64_t sorted; /* what was searched when they were made */
    he_watch *watch; /* told from time to time of the `done` of `of`, which the caller counts */
    uint64_t done, of, told;
} he_triangulation_work;

enum { HE_AVOID_EDGES = 1, HE_ANY_DIAGONALS = 2 };

/* Triangulates the loop of `first`. `work` may be NULL for one loop alone. Returns
 * HE_DOUBLED_EDGE if no triangulation was found that avoids the edges there are,
 * HE_NO_MEMORY if memory is out,
 * HE_CANCELLED if the watch says so.
 * he_triangulation_clear frees. */
HE_NODISCARD he_status he_triangulation_make(const he_mesh *m, he_halfedge first, unsigned flags,
                                             he_triangulation_work *work, he_triangulation *out,
                                             he_error *err);
void he_triangulation_clear(he_triangulation *triangulation);
void he_triangulation_work_clear(he_triangulation_work *work);

/* --- for ears.c --- */

/* Does an edge join corners i and k? Counts the steps. */
bool he_diagonal_exists(const he_mesh *m, const he_flat *flat, uint32_t i, uint32_t k,
                        he_triangulation_work *work);
/* Between two cuts. Returns HE_CANCELLED, or HE_NO_MEMORY for the joins. */
HE_NODISCARD he_status he_triangulation_step(const he_mesh *m, he_triangulation_work *work,
                                             he_error *err);
/* HE_DOUBLED_EDGE. */
HE_NODISCARD he_status he_diagonals_refuse(const he_mesh *m, const he_flat *flat, he_error *err);

#endif
