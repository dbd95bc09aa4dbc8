/* triangulation.h - chooses the triangles that fill a loop.
 *
 * A triangulation lists its triangles in such an order that each triangle cuts its middle corner
 * off the rest of the loop; the last triangle is all that is left of the loop.
 *
 * Loops of up to HE_EXACT_CORNERS corners get a triangulation with as few triangles as possible
 * that do not turn left in the Newell plane (none for a simple polygon). If there are several such
 * triangulations, they get the one with the shortest diagonals (G. T. Klincsek, "Minimal
 * triangulations of polygonal domains", 1980).
 *
 * Longer loops are cut by ear clipping (ears.h).
 *
 * With the flag HE_ANY_DIAGONALS short loops are cut by ear clipping, too, and the best
 * triangulation is searched only if ear clipping makes a flipped triangle. This is for callers that
 * need many triangulations fast.
 *
 * With the flag HE_AVOID_EDGES no diagonal joins two vertices that an edge of the mesh joins
 * already. In short loops such diagonals are avoided only if that flips no triangle. In long loops
 * an ear with such a diagonal is skipped; if only such ears are left, the loop is refused, although
 * another order of cuts might have succeeded. The flag changes nothing if the triangulation without
 * the flag has no such diagonal.
 *
 * WORK. A short loop takes at most three tables of HE_EXACT_CORNERS^3 / 6 steps each, a long loop
 * of n corners about n log n steps. Searching for edges costs a few steps for each diagonal; if it
 * costs more, an index of the edges at vertices of large degree is made (edge_lookup.h). So the
 * work for all loops of a mesh is bounded by the number of its corners and needs no limit.
 *
 * If the mesh has a cache of long faces (long_faces.h), the triangulations of these faces are taken
 * from the cache.
 *
 * The result depends only on the loop, its first half-edge and the mesh's edges. */
#ifndef HE_GEOMETRY_TRIANGULATION_H
#define HE_GEOMETRY_TRIANGULATION_H

#include "base/progress.h"
#include "geometry/edge_lookup.h"
#include "geometry/planar_loop.h"

enum { HE_EXACT_CORNERS = 64 };

typedef struct he_triangulation {
    /* The loop, projected into its plane; x and y are not filled if the triangulation is from the
     * cache. */
    he_planar_loop flat;
    uint32_t *corners; /* three corners for each of the flat.n - 2 triangles, counter-clockwise */
    /* true if a triangle has no area in the plane, or is flipped (does not turn left) */
    bool degenerate;
    uint64_t steps; /* number of steps that this triangulation took */
} he_triangulation;

/* State that many triangulations of one mesh share; {0} is the state before the first
 * triangulation. The mesh must not change meanwhile, except that the caller may turn diagonals into
 * edges, if it reports them to `own` (he_edge_lookup_reserve, he_edge_lookup_add). */
typedef struct he_triangulation_work {
    uint64_t steps;    /* steps taken, also for loops that were refused */
    uint64_t searched; /* how many of `steps` were spent searching for edges */
    /* the index of edges that is used: `own`, or one of the caller; NULL if there is none, and an
     * edge is searched around its ends */
    const he_edge_lookup *lookup;
    /* Index of edges, which is made when searches without it have cost as much as making it. The
     * caller must add the diagonals that it turns into edges. */
    he_edge_lookup own;
    uint64_t sorted; /* the value of `searched` when `own` was made */
    /* `progress`: the watch to which progress is reported as step `done` of `of`; the caller sets
     * these three members. `told`: the value of `steps` at the latest report. */
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

/* Returns true if an edge of the mesh joins the vertices of the corners i and k of a loop. Adds the
 * steps of the search to `work`. */
bool he_diagonal_exists(const he_mesh *m, const he_planar_loop *flat, uint32_t i, uint32_t k,
                        he_triangulation_work *work);
/* Reports progress, and makes the index of edges if it pays. Must be called between two cuts.
 * Returns HE_CANCELLED if the work was cancelled.
 * Returns HE_NO_MEMORY if memory for the index of edges is out. */
HE_NODISCARD he_status he_triangulation_step(const he_mesh *m, he_triangulation_work *work,
                                             he_error *err);
/* Returns HE_DOUBLED_EDGE with a message that a diagonal of the loop would double an edge. */
HE_NODISCARD he_status he_diagonals_refuse(const he_mesh *m, const he_planar_loop *flat,
                                           he_error *err);

#endif
