/* remeshing.h - the state of a remeshing, and its passes: each goes once over all triangles or
 * vertices of the net. remesh.c calls them. */
#ifndef HE_REMESH_REMESHING_H
#define HE_REMESH_REMESHING_H

#include "remesh/ground.h"
#include "remesh/net.h"

/* An edge is too long if it is longer than HE_REMESH_LONG times the wanted length, and too short if
 * it is shorter than HE_REMESH_SHORT times that length. With these limits, the mean length becomes
 * a little less than the wanted one, as with the limits 4/3 and 4/5 of Botsch and Kobbelt. */
#define HE_REMESH_LONG  1.19
#define HE_REMESH_SHORT 0.75

/* The mean area of triangles if the wanted length is 1: that of regular triangles whose sides are
 * as long as the mean of the edges that result, about 0.95. */
#define HE_REMESH_MEAN_AREA 0.39

typedef struct he_remeshing {
    he_net net;
    he_ground ground;
    he_progress *progress;
    bool project;
    uint64_t changes; /* number of splits, collapses and flips in this step */
    double moved;     /* the sum of the moves of all vertices in this step, in wanted lengths */
} he_remeshing;

/* How flips are chosen. */
typedef enum he_flip_aim {
    HE_FLIP_DEGREES, /* degrees come nearer to the ideal */
    HE_FLIP_ANGLES   /* the angles opposite an edge add up to at most pi */
} he_flip_aim;

/* Each returns HE_NO_MEMORY if memory is out, or HE_CANCELLED if the work was cancelled.
 * he_remesh_split also returns HE_LIMIT if there would be too many triangles. */
/* If `rounds` is true, edges are split in rounds: first those that are longer than a large multiple
 * of the limit, then those longer than half of that, and so on, so that long edges are split before
 * shorter ones. Later steps find few long edges and need no rounds. */
HE_NODISCARD he_status he_remesh_split(he_remeshing *r, bool rounds, he_error *err);
/* If `rounds` is true, edges are collapsed in rounds: first those that are much shorter than the
 * limit, then those shorter than twice as much, and so on, so that triangles grow evenly. */
HE_NODISCARD he_status he_remesh_collapse(he_remeshing *r, bool rounds, he_error *err);
/* Tests all edges `sweeps` times, or until there is nothing to flip any more. */
HE_NODISCARD he_status he_remesh_flip(he_remeshing *r, he_flip_aim aim, unsigned sweeps,
                                      he_error *err);
HE_NODISCARD he_status he_remesh_relax(he_remeshing *r, he_error *err);
/* Moves the corners of the triangles that are least round, so that they become rounder. */
HE_NODISCARD he_status he_remesh_round(he_remeshing *r, he_error *err);
/* Moves vertices that are not on lines a little off the ground, so that the faces are as near to it
 * as they can be. */
HE_NODISCARD he_status he_remesh_fit(he_remeshing *r, he_error *err);
/* Finds a bound of the distances of all points of the net from the ground, in coordinates of the
 * net. */
HE_NODISCARD he_status he_remesh_bound(const he_remeshing *r, double *out, he_error *err);

/* --- shapes of triangles --- */

static inline double he_remesh_square(he_vec3 a, he_vec3 b)
{
    he_vec3 d = he_vec3_sub(b, a);
    return he_vec3_dot(d, d);
}

/* A triangle's area vector, twice as long as its area, and its roundness: the square of 4 sqrt(3)
 * area / (sum of the squared sides), which is 1 for a regular triangle, and 0 for one without area.
 * It is stored as a fraction, because a division takes as long as many products. */
typedef struct he_roundness {
    he_vec3 area;
    double part, whole; /* the roundness is part / whole; `whole` is above 0 */
} he_roundness;

static inline he_roundness he_roundness_of(he_vec3 a, he_vec3 b, he_vec3 c)
{
    he_vec3 ab = he_vec3_sub(b, a), ac = he_vec3_sub(c, a), bc = he_vec3_sub(c, b);
    he_vec3 area = he_vec3_cross(ab, ac);
    double sum = he_vec3_dot(ab, ab) + he_vec3_dot(ac, ac) + he_vec3_dot(bc, bc);
    return (he_roundness){area, 12 * he_vec3_dot(area, area), sum > 0 ? sum * sum : 1};
}
static inline bool he_roundness_is_less(const he_roundness *a, const he_roundness *b)
{
    return a->part * b->whole < b->part * a->whole;
}
static inline bool he_roundness_is_below(const he_roundness *a, double limit)
{
    return a->part < limit * a->whole;
}
/* Lowers *worst to the roundness of `a` if that is less. */
static inline void he_roundness_lower(he_roundness *worst, const he_roundness *a)
{
    if (he_roundness_is_less(a, worst)) {
        *worst = *a;
    }
}

/* Returns true if the directions of two area vectors differ by at most 60 degrees, or if one of
 * them has no direction. */
static inline bool he_remesh_agree(he_vec3 a, he_vec3 b)
{
    double along = he_vec3_dot(a, b);
    double squares = he_vec3_dot(a, a) * he_vec3_dot(b, b);
    return squares == 0 || (along > 0 && along * along >= 0.25 * squares);
}

#endif
