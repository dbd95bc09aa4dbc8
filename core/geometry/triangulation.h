/* triangulation.h - chooses the triangles that fill a loop.
 *
 * A triangulation lists its triangles in such an order that each cuts one corner, the middle one of
 * its three, off the rest of the loop; the last triangle is what then is left.
 *
 * Loops of up to HE_EXACT_CORNERS corners get the triangulation with the fewest triangles that do
 * not turn left in the Newell plane (none for a simple polygon), and among those the one with the
 * shortest diagonals (G. T. Klincsek, "Minimal triangulations of polygonal domains", 1980).
 *
 * Longer loops are cut by ear clipping, see ears.h.
 *
 * With HE_ANY_DIAGONALS short loops are cut by ear clipping too, and the best triangulation is
 * searched only if that flips a triangle. This is for callers that need many triangulations fast.
 *
 * With HE_AVOID_EDGES no diagonal is an existing edge, which an edit would double. In short loops
 * existing edges are avoided if that flips no triangle. In long ones an ear whose diagonal exists
 * is skipped; when only such ears are left the loop is refused, though another order of cuts might
 * have succeeded. If no diagonal of the triangulation exists as an edge, the flag changes nothing.
 *
 * WORK. A short loop takes at most three tables of HE_EXACT_CORNERS^3 / 6 steps each, a long one of
 * n corners about n log n steps. Searching for edges costs a few steps for each diagonal; if it
 * costs more, an index of the edges at vertices of large degree is made (edge_lookup.h). So the
 * work for the loops of a mesh is bounded by its corners and needs no limit.
 *
 * If the mesh has a cache of long faces (long_faces.h), their triangulations are taken from it.
 *
 * The result depends only on the loop, its first half-edge and the mesh's edges. */
#ifndef HE_GEOMETRY_TRIANGULATION_H
#define HE_GEOMETRY_TRIANGULATION_H

#include "base/progress.h"
#include "geometry/edge_lookup.h"
#include "geometry/planar_loop.h"

enum { HE_EXACT_CORNERS = 64 };

typedef struct he_triangulation {
    /* The loop in its plane; without x and y if the triangulation is from the cache. */
    he_planar_loop flat;
    uint32_t *corners; /* three for each of the flat.n - 2 triangles, counter-clockwise */
    bool degenerate;   /* some triangle has no area in the plane, or is flipped */
    uint64_t steps;    /* number of steps that this triangulation took */
} he_triangulation;

/* State shared by many triangulations of a mesh; {0} begins it. The mesh must not change meanwhile,
 * except that the caller may make edges of diagonals, if it reports them to `own`
 * (he_edge_lookup_reserve, he_edge_lookup_add). */
typedef struct he_triangulation_work {
    uint64_t steps;               /* steps taken, also for loops that were refused */
    uint64_t searched;            /* how many of `steps` were spent searching for edges */
    const he_edge_lookup *lookup; /* index of edges; NULL: edges are searched around their ends */
    /* index of edges that is made when it is worth its cost; has the caller's diagonals, too */
    he_edge_lookup own;
    uint64_t sorted; /* value of `searched` when the index was made */
    /* The watch that progress is reported to, as `done` of `of`; the caller counts both. `told` is
     * the value of `steps` at the last report. */
    he_progress *progress;
    uint64_t done, of, told;
} he_triangulation_work;

enum { HE_AVOID_EDGES = 1, HE_ANY_DIAGONALS = 2 };

/* Triangulates the loop of half-edge `first`. `work` may be NULL for a single loop.
 * he_triangulation_clear frees the result.
 * Returns HE_DOUBLED_EDGE if no triangulation was found that avoids the existing edges.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_triangulation_make(const he_mesh *m, he_halfedge first, unsigned flags,
                                             he_triangulation_work *work, he_triangulation *out,
                                             he_error *err);
void he_triangulation_clear(he_triangulation *triangulation);
void he_triangulation_work_clear(he_triangulation_work *work);

/* --- functions for ears.c --- */

/* Returns true if an edge of the mesh joins the corners i and k of a loop. Counts the steps of the
 * search. */
bool he_diagonal_exists(const he_mesh *m, const he_planar_loop *flat, uint32_t i, uint32_t k,
                        he_triangulation_work *work);
/* Reports progress; must be called between two cuts.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_NO_MEMORY if memory for the index of edges is out. */
HE_NODISCARD he_status he_triangulation_step(const he_mesh *m, he_triangulation_work *work,
                                             he_error *err);
/* Returns HE_DOUBLED_EDGE with a message about the loop. */
HE_NODISCARD he_status he_diagonals_refuse(const he_mesh *m, const he_planar_loop *flat,
                                           he_error *err);

#endif
