/* topology.h - the shape of a mesh as a whole: components, boundary loops, handles.
 *
 * Two faces are in one component BY EDGE if a chain of faces leads from one to the other, each
 * sharing an edge with the one before; BY VERTEX if sharing a corner is enough. The two differ only
 * at bow-ties. Isolated vertices belong to no component and are counted separately.
 *
 *     euler = used vertices - edges + faces
 *     genus = (2 components - euler - boundary loops) / 2, the number of handles; it means nothing
 *             if there is a bow-tie, because fans share a vertex that the formula counts once
 *
 * All functions take time linear in the size of the mesh, except for the inverse Ackermann factor
 * of union-find. Links that do not close, or lead to elements that do not exist, give HE_CORRUPT;
 * every function may return HE_NO_MEMORY. The caller clears outputs. */
#ifndef HE_QUERY_TOPOLOGY_H
#define HE_QUERY_TOPOLOGY_H

#include "mesh/mesh.h"

/* The number of faces of one degree. */
typedef struct he_degree_count {
    uint32_t degree, faces;
} he_degree_count;

typedef struct he_topology {
    uint32_t vertices, edges, faces; /* numbers of live elements */
    uint32_t isolated_vertices;
    uint32_t boundary_halfedges, boundary_loops;
    uint32_t bowties; /* vertices of two fans or more */
    uint32_t components, components_by_edge;
    int64_t euler, genus;
    bool has_genus;
    /* There is no boundary half-edge; a mesh without faces is not closed. */
    bool closed;
    bool manifold; /* there is no bow-tie; a mesh without faces is not manifold */
    /* the degrees that occur, in rising order, each with its number of faces */
    he_degree_count *degrees;
    size_t degree_count;
} he_topology;

/* Computes the whole topology of a mesh in one call: counts, components, boundary loops and
 * handles. */
HE_NODISCARD he_status he_topology_find(const he_mesh *m, he_topology *out, he_error *err);
void he_topology_clear(he_topology *topology);

/* BOUNDARY LOOPS. Each boundary half-edge belongs to exactly one loop. */
typedef struct he_boundary {
    /* The half-edge of the loop with the lowest id; he_traverse_loop gives the other half-edges. */
    uint32_t halfedge;
    uint32_t length;
} he_boundary;

typedef struct he_boundaries {
    he_boundary *loops; /* in rising order of their half-edges */
    size_t count, capacity;
} he_boundaries;

HE_NODISCARD he_status he_boundaries_find(const he_mesh *m, he_boundaries *out, he_error *err);
void he_boundaries_clear(he_boundaries *boundaries);

/* COMPONENTS. The two relations by which faces are connected into components: a shared edge, or a
 * shared vertex. */
typedef enum he_connection { HE_JOINED_BY_VERTEX, HE_JOINED_BY_EDGE } he_connection;

typedef struct he_component {
    uint32_t faces;
    /* Number of vertices of the component's faces. A bow-tie vertex that several components share
     * counts in each of them. */
    uint32_t vertices;
    uint32_t face; /* the component's face with the lowest id */
} he_component;

typedef struct he_components {
    he_component *components; /* in the order of the lowest face ids of the components */
    size_t count, capacity;
} he_components;

HE_NODISCARD he_status he_components_find(const he_mesh *m, he_connection by, he_components *out,
                                          he_error *err);
void he_components_clear(he_components *components);

/* Finds for each face that was ever issued the number of its component by edge, HE_NONE if the face
 * was deleted, and the number of components. Components are numbered from 0 in the order of their
 * lowest face ids. The caller frees the array. */
HE_NODISCARD he_status he_components_label(const he_mesh *m, uint32_t **labels, uint32_t *count,
                                           he_error *err);

/* Appends the bow-ties, which are the vertices of two fans or more, by rising id. */
HE_NODISCARD he_status he_bowties_find(const he_mesh *m, he_ids *out, he_error *err);

#endif
