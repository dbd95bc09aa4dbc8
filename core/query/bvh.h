/* bvh.h - a tree of boxes over the triangles of a mesh: rays, nearest points, self-intersections.
 *
 * The triangles are those of drawing.h, so that what is hit is what is drawn. The tree is one of
 * boxes.h; the triangles of a hub (hubs.h), and those of a face that has many, have subtrees of
 * their own.
 *
 *     nodes      as in boxes.h, over `triangles`
 *     boxes      in coordinates times `scale`, a power of two that brings the faces near the unit
 *                cube, whatever isolated vertices there are: no finite input overflows. Faces that
 *                are 1e70 times smaller than the largest coordinate of a face are points to a ray
 *                and to a search for the nearest. Floats, rounded outward
 *     discs      of the same triangles, see bvh_disc.h
 *
 * A tree belongs to the mesh as it was when the tree was made: the functions take that mesh along,
 * and a mesh that has changed gets another tree. Trees are never written to: any number of threads
 * may ask.
 *
 * BUDGETS (base/budget.h) are charged HE_BVH_LOOK for each box and triangle that a ray or a point
 * looks at, a step for each pair of boxes and HE_BVH_PAIR for each pair of triangles that is tried;
 * what runs out is HE_LIMIT. In ordinary meshes a ray or a nearest point takes some thousand steps,
 * but in one whose triangles all lie in the same place, as many as there are triangles. */
#ifndef HE_QUERY_BVH_H
#define HE_QUERY_BVH_H

#include "query/boxes.h"
#include "query/hubs.h"

enum { HE_BVH_LOOK = 8, HE_BVH_PAIR = 64 };

typedef struct he_bvh_disc {
    float center[3], normal[3], thick, radius; /* the thickness to either side */
} he_bvh_disc;

typedef struct he_bvh_triangle {
    uint32_t vertex[3], face;
} he_bvh_triangle;

/* Open for reading; only bvh.c writes it. */
typedef struct he_bvh {
    int exponent;
    double scale;          /* 2^-exponent */
    double min[3], max[3]; /* of all, not rounded */
    he_box_node *nodes;
    he_bvh_disc *discs; /* one a node */
    he_bvh_triangle *triangles;
    uint32_t node_count, count; /* both 0 without faces */
    bool has_wide_faces;        /* some face has HE_HUB_SPOKES triangles or more */
    he_hubs hubs;
} he_bvh;

/* n log n in triangles. HE_NO_MEMORY; HE_IDS_EXHAUSTED as for drawings, or where there are more
 * than 2^31 triangles; HE_CANCELLED by the watch, which may be NULL and is not the mesh's: others
 * may read that one meanwhile. */
HE_NODISCARD he_status he_bvh_new(const he_mesh *m, he_watch *watch, he_bvh **out, he_error *err);
void he_bvh_free(he_bvh *tree);

/* A place on a face. */
typedef struct he_hit {
    uint32_t face;      /* HE_NONE: there is none, and nothing else is told */
    uint32_t vertex[3]; /* of one of its triangles */
    double weight[3];   /* the point is their mean, with these; not negative, sum 1 */
    he_vec3 point;
    double distance; /* at most DBL_MAX */
} he_hit;

/* The first face that a ray meets, from either side, at a distance from 0 to `max` (lengths, which
 * may be HUGE_VAL) of its origin. The direction may have any length but zero (HE_BAD_VALUE).
 *
 * A ray through an edge or a vertex meets at least one of the faces there: there are no cracks
 * (S. Woop, C. Benthin and I. Wald, "Watertight ray/triangle intersection", 2013; boxes are entered
 * as T. Ize, "Robust BVH ray traversal", 2013). Of faces at the same distance the one with the
 * least id is met, so that it is one hit. A face seen exactly from its side, or without area, is
 * not. */
HE_NODISCARD he_status he_bvh_ray(const he_bvh *tree, const he_mesh *m, he_vec3 origin,
                                  he_vec3 direction, double max, he_budget *budget, he_hit *out,
                                  he_error *err);

/* The point of the faces nearest to `point`, and within `max` of it. Of faces at the same distance
 * the one with the least id. C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5; triangles
 * without area are the segments they look like. */
HE_NODISCARD he_status he_bvh_closest(const he_bvh *tree, const he_mesh *m, he_vec3 point,
                                      double max, he_budget *budget, he_hit *out, he_error *err);

/* Append pairs of faces that meet where they should not, each pair once and the lesser id first, in
 * rising order: faces that share a point which is not a corner of both, be they neighbours or not.
 * Corners at the same place are the same corner, so a seam that was not sewn is no intersection;
 * faces that fold back onto their neighbour, or lie on one another, are. Decided without rounding
 * (orient.h), from signs alone as in P. Guigue and O. Devillers, "Fast and robust triangle-triangle
 * overlap test using orientation predicates", 2003. Triangles without area meet nothing, and those
 * of one face are not tried against each other.
 *
 * `complete` is false when the budget ran out or `most` pairs were met, faces of many triangles
 * perhaps more than once: then there may be more. HE_NO_MEMORY; HE_CANCELLED by the watch, which
 * may be NULL. */
HE_NODISCARD he_status he_bvh_intersections(const he_bvh *tree, const he_mesh *m, size_t most,
                                            he_budget *budget, he_ids *pairs, bool *complete,
                                            he_error *err);

#endif
