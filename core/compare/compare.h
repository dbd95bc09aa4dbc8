/* compare.h - how far two surfaces are from each other.
 *
 * The one-sided distance from a surface A to a surface B is the largest distance of a point of A
 * from B:
 *
 *     A ____/\____      The point of the peak is farthest from B. Seen from B the distance is
 *     B __________      smaller: every point of B is near some point of A.
 *
 * The larger of the two one-sided distances is the Hausdorff distance. A surface is all triangles
 * of the faces of a mesh, those that a drawing shows (draw/draw_arrays.h), with all points in their
 * interiors; isolated vertices are not part of it.
 *
 * Each distance is found as a lower bound, which is the distance of a point that is reported, and
 * an upper bound, at most `bound` larger. Both hold for every point of the surfaces, not only for
 * samples, up to rounding errors of about 1e-15 of the largest coordinate.
 *
 * METHOD. Branch and bound (M. Tang, M. Lee and Y. J. Kim, "Interactive Hausdorff distance
 * computation for general polygonal models", 2009), with cuts of our own. The triangles of A are
 * sampled (sample.c), which gives the lower bound, the means and a first upper bound of every
 * triangle; or, if no means are wanted, bounded by near triangles of B (bound.c). Triangles whose
 * upper bound is too large are cut into convex pieces (branch.c), those with the largest upper
 * bound first. The distance to one triangle of B is a convex function, so on a piece it is largest
 * at a corner. Pieces are therefore cut by the planes through the sides of a near triangle of B,
 * perpendicular to it, and by the plane between two such triangles: on the parts the bounds are
 * mostly equal. A triangle of A that is a triangle of B, too, has the distance 0 and is not
 * sampled. */
#ifndef HE_COMPARE_COMPARE_H
#define HE_COMPARE_COMPARE_H

#include "base/progress.h"
#include "query/bvh.h"

enum { HE_COMPARE_BINS = 256 };

/* A mesh and the tree of boxes over its triangles, both borrowed. */
typedef struct he_compared {
    const he_mesh *mesh;
    const he_bvh *tree;
} he_compared;

typedef struct he_compare_options {
    double bound; /* how much an upper bound may exceed the lower bound; above 0 */
    /* Number of bins of the histograms, up to HE_COMPARE_BINS. 0: neither histograms nor means are
     * made, and the bounds take less than half of the time. */
    uint32_t bins;
    uint64_t most_pieces; /* how many pieces may be made in each direction; 0: no limit */
} he_compare_options;

/* A point of one surface, and the nearest point of the other one. */
typedef struct he_far_place {
    uint32_t face, near_face;
    he_vec3 point, near_point;
} he_far_place;

/* What is known about the distances of the points of one surface from the other one. */
typedef struct he_one_sided {
    double lower, upper; /* of the largest distance */
    he_far_place place;  /* where the distance is `lower` */
    /* The mean and the root mean square of the distances, weighted by area, as found from the
     * samples: four in every triangle, and more in triangles that are a large part of the
     * surface. 0 without bins. */
    double mean, rms;
    /* What share of the area has distances in each bin. All bins have the width
     * he_comparison.bin_width; a distance between two bins counts in the upper one. */
    double share[HE_COMPARE_BINS];
    uint64_t pieces;      /* how many pieces were made */
    uint32_t equal_faces; /* number of triangles that are triangles of the other surface, too */
} he_one_sided;

typedef struct he_comparison {
    he_one_sided side[2]; /* from the first surface to the second one, and back */
    double lower, upper;  /* of the Hausdorff distance */
    double bin_width;     /* 0 without bins */
    /* False if the bounds are not as near to each other as wanted, because pieces ran out or
     * became as small as rounding errors. */
    bool complete;
} he_comparison;

/* Returns the bound that is used if none is given: a thousandth of the diagonal of the box around
 * both surfaces. */
double he_compare_default_bound(const he_compared surfaces[2]);

/* Returns how many boxes and triangles may be looked at in each direction: thousands for each
 * triangle, many times what surfaces take that are not made to be slow. */
uint64_t he_compare_budget(const he_compared surfaces[2]);

/* Compares two surfaces, which must not change meanwhile. `progress` may be NULL.
 * Returns HE_NO_FACES if one of the meshes has no faces.
 * Returns HE_BAD_VALUE if the bound is not above 0, or the number of bins is out of range.
 * Returns HE_NOT_FINITE if the bound is not finite.
 * Returns HE_LIMIT if a coordinate of one surface is more than 2^90 times larger than all of the
 * other one, so that products of coordinates would overflow, or if very many triangles are at one
 * place, so that looking for nearest points takes more than he_compare_budget steps.
 * Returns HE_CANCELLED if the work was cancelled, HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_compare(const he_compared surfaces[2], const he_compare_options *options,
                                  he_progress *progress, he_comparison *out, he_error *err);

#endif
