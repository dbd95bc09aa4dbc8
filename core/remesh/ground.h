/* ground.h - the surface that remesh was given, on which it puts the vertices of the new one.
 *
 * The nearest point of the ground is found by a walk: from a triangle that was near the vertex
 * before, the walk goes to whichever neighbour is nearer, until none is. Vertices move by less than
 * an edge in a step, so the walk is short; a search in a tree of boxes takes several times as long.
 * And where two sheets of the surface are close together, a vertex stays on its own sheet, while
 * the nearest point of all may lie on the other one. */
#ifndef HE_REMESH_GROUND_H
#define HE_REMESH_GROUND_H

#include "remesh/net.h"

typedef struct he_ground_triangle {
    uint32_t v[3], twin[3]; /* as in he_net_triangle */
} he_ground_triangle;

typedef struct he_ground {
    he_ground_triangle *triangles;
    he_vec3 *place; /* position of each vertex, in coordinates of the net */
    float *size; /* the wanted length of edges at each vertex; NULL if it is the same everywhere */
    uint32_t *face;   /* the face of the mesh that each triangle is */
    uint32_t *vertex; /* the vertex of the mesh that each vertex is */
    uint8_t *held;    /* bit i of each triangle: its edge i is held; NULL if no edge is */
    uint32_t triangle_count, vertex_count;
} he_ground;

/* The point of the ground that is nearest to another point. */
typedef struct he_ground_point {
    uint32_t triangle;
    double weight[3]; /* barycentric coordinates in the triangle: not negative, sum 1 */
    he_vec3 place;
    double square; /* squared distance */
} he_ground_point;

/* Copies the triangles of a net, and the sizes of its vertices if `sizes` is true.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_ground_copy(const he_net *n, bool sizes, he_ground *out, he_error *err);
void he_ground_clear(he_ground *g);
/* Returns the wanted length at a point of the ground, which must have sizes. */
static inline float he_ground_size(const he_ground *g, const he_ground_point *at)
{
    const uint32_t *v = g->triangles[at->triangle].v;
    return (float)((double)g->size[v[0]] * at->weight[0] + (double)g->size[v[1]] * at->weight[1] +
                   (double)g->size[v[2]] * at->weight[2]);
}
/* Finds the point of one triangle that is nearest to `place`. */
void he_ground_nearest(const he_ground *g, he_vec3 place, uint32_t triangle, he_ground_point *out);
/* Walks from triangle `from` to a triangle that is nearer to `place` than its neighbours, and finds
 * its nearest point. The walk ends after HE_GROUND_STEPS triangles at the latest. */
enum { HE_GROUND_STEPS = 256 };
void he_ground_walk(const he_ground *g, he_vec3 place, uint32_t from, he_ground_point *out);
/* Walks as he_ground_walk does, but across no edge that is held. */
void he_ground_walk_beside(const he_ground *g, he_vec3 place, uint32_t from, he_ground_point *out);

#endif
