/* comparing.h - for the files of core/compare only: the state of the search for the largest
 * distance of a point of one surface from another one.
 *
 *     compare.c      both directions, one after the other
 *     parts.c        loops over the triangles in parts, on several threads
 *     sample.c       samples of all triangles: a lower bound, means, upper bounds
 *     bound.c        lower and upper bounds without samples
 *     branch.c       triangles whose upper bound is too large are cut until it is not
 *     piece.c        convex polygons that are cut by planes
 *     equal_faces.c  triangles that both surfaces have
 *
 * All coordinates and distances are those of the tree of the surface `to`, unless a comment says
 * otherwise. */
#ifndef HE_COMPARE_COMPARING_H
#define HE_COMPARE_COMPARING_H

#include "compare/compare.h"
#include "query/bvh_walk.h"

/* The distance at a sample, and how much of the area the sample stands for. */
typedef struct he_sample {
    double distance, weight;
} he_sample;

typedef struct he_comparing {
    he_compared from, to;
    he_budget budget;
    double bound;
    uint64_t most_pieces;
    bool samples_wanted; /* false: neither means nor histograms, `first` to `area` are unused */
    /* The largest distance found so far, at the point `at` of a triangle of `from`; the nearest
     * triangle of `to`, and the point in it. */
    double lower;
    he_vec3 at;
    uint32_t triangle;
    he_bvh_found found;
    double settled; /* no piece that needs no further cuts has a larger distance */
    double target;  /* a piece with this upper bound, `lower` + `bound`, needs no further cuts */
    /* The nearest triangle of each vertex of `from` that was reached, and its distance. Vertices
     * that were not reached have HE_NONE. The first triangle that has a vertex, and is not in both
     * surfaces, reaches it. */
    uint32_t *first;
    uint32_t *nearest;
    double *distance;
    he_sample *samples;
    size_t sample_count, sample_capacity;
    double weight, sum, squares; /* sums over the samples */
    double area;                 /* of `from`, in coordinates of its own tree */
    double *upper;   /* for each triangle of `from` an upper bound of the distances of its points */
    uint64_t *equal; /* bits of the triangles of `from` that `to` has, too */
    uint64_t pieces;
    bool complete;
} he_comparing;

/* Finds the triangle of `to` nearest to a point of triangle `triangle` of `from`, and raises the
 * lower bound if the distance is larger. */
HE_NODISCARD he_status he_comparing_ask(he_comparing *c, he_vec3 point, uint32_t triangle,
                                        uint32_t *nearest, double *distance, he_error *err);
/* Reports the progress of a loop over the triangles of `from`.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_comparing_report(const he_comparing *c, uint32_t triangle, he_error *err);
/* Returns the corners of a triangle of `from`. */
void he_comparing_corners(const he_comparing *c, uint32_t triangle, he_vec3 out[3]);
/* Returns the largest distance of some points from triangle `to_triangle` of `to`, and the number
 * of the point that has it. The distance to one triangle is convex, so no point of the points'
 * convex hull is farther away. */
double he_comparing_farthest(const he_comparing *c, const he_vec3 *points, uint32_t count,
                             uint32_t to_triangle, uint32_t *farthest);

/* The work on the triangles `from` to `to` - 1 of a part of the loop. */
typedef he_status (*he_compare_part)(he_comparing *part, uint32_t from, uint32_t to, he_error *err);

/* Calls `work` for HE_COMPARE_PART triangles of `from` at a time, on several threads if some are
 * lent. Each part has a copy of `c` of its own, without samples and sums, and parts may write only
 * such entries of the arrays that no other part reads or writes. The copies are then joined in
 * order, so the result does not depend on the number of threads.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns the error of `work` if it fails. */
enum { HE_COMPARE_PART = 2048 };
HE_NODISCARD he_status he_compare_in_parts(he_comparing *c, he_compare_part work, he_error *err);

/* Finds the distances of all vertices. Fills the arrays of `c`, which must have room. */
HE_NODISCARD he_status he_compare_reach(he_comparing *c, he_error *err);
/* Samples all triangles, whose vertices were reached. */
HE_NODISCARD he_status he_compare_sample(he_comparing *c, he_error *err);
/* Finds the distances of some vertices, which give a first lower bound. */
HE_NODISCARD he_status he_compare_scout(he_comparing *c, he_error *err);
/* Finds an upper bound of each triangle, without samples and without distances of its vertices. */
HE_NODISCARD he_status he_compare_bound(he_comparing *c, he_error *err);
/* Cuts triangles until the largest upper bound is at most `bound` above the lower bound. */
HE_NODISCARD he_status he_compare_branch(he_comparing *c, he_error *err);

/* Sets the bits of the triangles of `from` whose corners are at the positions of the corners of a
 * triangle of `to`, in any order. `equal` has zero bits before.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_LIMIT or HE_CANCELLED if the budget ends the work. */
HE_NODISCARD he_status he_find_equal_faces(const he_compared *from, const he_compared *to,
                                           he_budget *budget, uint64_t *equal, he_error *err);

#endif
