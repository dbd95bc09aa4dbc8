/* bvh.h - a tree of boxes over the triangles of a mesh: rays, nearest points, self-intersections.
 *
 * The triangles are those of draw_arrays.h, so a ray hits what is drawn. The tree is made by
 * boxes.h. The triangles at a hub (a position at which very many meet, hubs.h) form a subtree of
 * their own, and so do those of a face of many triangles.
 *
 *     nodes      as in boxes.h, over `triangles` boxes      in coordinates times `scale`, a power
 *     of two that brings the faces near the unit cube and does not depend on isolated vertices, so
 *     that no finite input overflows. Faces that
 *                are 1e70 times smaller than the largest coordinate of a face count as points for
 *                rays and nearest points. The boxes are floats, rounded outward
 *     discs      around the same triangles, see bvh_disc.h
 *     wide       the same boxes for searches for nearest points, see bvh_wide.h
 *
 * A tree is valid as long as the mesh for which it was made does not change; the functions take
 * that mesh as an argument. Trees are never written to, so any number of threads may search one.
 *
 * BUDGETS (base/budget.h) are charged HE_BVH_LOOK for each node and triangle that a ray or a point
 * visits, a step for each pair of boxes and HE_BVH_PAIR for each pair of triangles that is tried; a
 * budget that runs out gives HE_LIMIT. In ordinary meshes a ray or a nearest point takes some
 * thousand steps, but if all triangles are at one place, it takes as many as there are
 * triangles. */
#ifndef HE_QUERY_BVH_H
#define HE_QUERY_BVH_H

#include "query/boxes.h"
#include "query/bvh_wide.h"
#include "query/hubs.h"

enum { HE_BVH_LOOK = 8, HE_BVH_PAIR = 64 };

typedef struct he_bvh_disc {
    /* `thick` is the thickness to either side of the disc's middle plane */
    float center[3], normal[3], thick, radius;
} he_bvh_disc;

typedef struct he_bvh_triangle {
    uint32_t vertex[3], face;
} he_bvh_triangle;

/* The tree of boxes over the triangles of a mesh. All code may read the fields; only bvh.c writes
 * them. */
typedef struct he_bvh {
    int exponent;
    double scale;          /* 2^-exponent */
    double min[3], max[3]; /* box around all faces, not rounded */
    he_box_node *nodes;
    he_bvh_disc *discs; /* one for each node */
    he_bvh_triangle *triangles;
    he_bvh_wide *wide;
    uint32_t node_count, wide_count, count; /* all are 0 without faces */
    bool has_wide_faces;                    /* some face has HE_HUB_SPOKES triangles or more */
    he_hubs hubs;
} he_bvh;

/* Makes a tree, in O(n log n) time for n triangles. Progress is reported to `progress`, which may
 * be NULL, and not to the watch of the mesh, so other threads may read the mesh meanwhile.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the id of a face is too large for the arrays of a drawing
 * (draw_arrays.h), or there are more than 2^31 triangles.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_bvh_new(const he_mesh *m, he_progress *progress, he_bvh **out,
                                  he_error *err);
void he_bvh_free(he_bvh *tree);

/* The point where a ray hits a face, or the nearest point on a face. */
typedef struct he_hit {
    uint32_t face;      /* HE_NONE: nothing was hit, and the other fields are not set */
    uint32_t vertex[3]; /* the corners of a triangle of the face; the point lies in that triangle */
    double weight[3];   /* barycentric coordinates of the point: not negative, sum 1 */
    he_vec3 point;
    /* Distance of the point from the ray's origin or the given point; at most DBL_MAX. */
    double distance;
} he_hit;

/* A ray, which hits nothing farther from its origin than `max`, in the mesh's unit. */
typedef struct he_ray {
    he_vec3 origin;
    he_vec3 direction; /* of any length but zero */
    double max;        /* greatest distance of a hit; may be HUGE_VAL */
} he_ray;

/* Finds the first face that a ray hits, from either side.
 * Returns HE_BAD_VALUE if the direction is zero.
 *
 * A ray through an edge or a vertex hits at least one of the faces there: there are no cracks (S.
 * Woop, C. Benthin and I. Wald, "Watertight ray/triangle intersection", 2013; boxes are entered as
 * in T. Ize, "Robust BVH ray traversal", 2013). Among faces at one distance the one with the least
 * id is hit, so the result is unique. A face seen exactly from its side, or without area, is not
 * hit. */
HE_NODISCARD he_status he_bvh_ray(const he_bvh *tree, const he_mesh *m, const he_ray *along,
                                  he_budget *budget, he_hit *out, he_error *err);

/* Finds the point of the faces that is nearest to `point`, if it is no farther away than `max`.
 * Among faces at one distance the one with the least id is taken. C. Ericson, "Real-Time Collision
 * Detection", 2005, 5.1.5; triangles without area count as the segments they look like. */
HE_NODISCARD he_status he_bvh_closest(const he_bvh *tree, const he_mesh *m, he_vec3 point,
                                      double max, he_budget *budget, he_hit *out, he_error *err);

/* Appends pairs of faces that intersect, each pair once and the lesser id first, in rising order:
 * faces that share a point which is not a corner of both, whether they are neighbours or not.
 * Corners at one position count as one corner, so an open seam is no intersection; faces that fold
 * back onto their neighbour, or overlap, do intersect. The decision is exact, without rounding
 * (orient.h), from signs alone as in P. Guigue and O. Devillers, "Fast and robust triangle-triangle
 * overlap test using orientation predicates", 2003. Triangles without area intersect nothing, and
 * triangles of one face are not tested against each other.
 *
 * `complete` is set to false if the budget ran out or `most` pairs were found; there may be more
 * pairs then. A pair of faces of many triangles may count several times towards `most`. `progress`
 * may be NULL.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_bvh_intersections(const he_bvh *tree, const he_mesh *m, size_t most,
                                            he_budget *budget, he_ids *pairs, bool *complete,
                                            he_error *err);

#endif
