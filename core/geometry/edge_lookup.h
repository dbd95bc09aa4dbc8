/* edge_lookup.h - looks up whether an edge joins two vertices, for very many pairs in a mesh that
 * does not change.
 *
 * he_find_halfedge searches the ring of the vertex of smaller degree, which is long if two vertices
 * of large degree share very many faces. A vertex is of large degree if it has more than
 * HE_EDGE_LOOKUP_DEGREE edges. The lookup has, for every such vertex, a sorted list of its
 * neighbours of large degree, so a pair of two such vertices is found by bisection, and any other
 * pair by a short search around the vertex of smaller degree. Making the lookup takes time linear
 * in the mesh. */
#ifndef HE_GEOMETRY_EDGE_LOOKUP_H
#define HE_GEOMETRY_EDGE_LOOKUP_H

#include "mesh/walk.h"

enum { HE_EDGE_LOOKUP_DEGREE = 32 };

/* An index of edges. {0} is empty. */
typedef struct he_edge_lookup {
    /* for each vertex its index among the vertices of large degree; HE_NONE if its degree is not
     * large */
    uint32_t *rank;
    /* for each vertex of large degree the index in `lists` at which its list begins; one more entry
     * says where the last list ends */
    uint32_t *starts;
    /* one list after another: for each vertex of large degree, its neighbours of large degree
     * with smaller ids */
    uint32_t *lists;
    /* hash table of pairs of vertices that got an edge after the lookup was made; a free entry
     * is 0 */
    uint64_t *noted;
    size_t noted_count, noted_slots;
} he_edge_lookup;

/* Makes the lookup. Until he_edge_lookup_clear, which frees it, the mesh must not change except by
 * edges that are reported to he_edge_lookup_add.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_lookup_make(const he_mesh *m, he_edge_lookup *out, he_error *err);
void he_edge_lookup_clear(he_edge_lookup *lookup);
/* Makes room to add `extra` edges; an empty lookup needs none.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_lookup_reserve(he_edge_lookup *lookup, size_t extra, he_error *err);
/* Adds an edge that was made between a and b; he_edge_lookup_reserve must have made room. */
void he_edge_lookup_add(he_edge_lookup *lookup, he_vertex a, he_vertex b);
/* Returns true if an edge joins a and b. Adds the cost of the search to `*steps`. If `lookup` is
 * NULL or empty, the function searches around a and b instead. */
bool he_edge_lookup_has(const he_mesh *m, const he_edge_lookup *lookup, he_vertex a, he_vertex b,
                        uint64_t *steps);

#endif
