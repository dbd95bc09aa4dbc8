/* edge_lookup.h - looks up whether an edge joins two vertices, for very many pairs in a mesh that
 * does not change.
 *
 * he_find_halfedge searches the ring of the vertex of smaller degree, which is long if two vertices
 * of large degree share very many faces. The lookup sorts, for every vertex of more than
 * HE_EDGE_LOOKUP_DEGREE edges, its neighbours that have as many: such a pair is found by bisection,
 * any other by a short search. Making it is linear in the mesh. */
#ifndef HE_GEOMETRY_EDGE_LOOKUP_H
#define HE_GEOMETRY_EDGE_LOOKUP_H

#include "mesh/walk.h"

enum { HE_EDGE_LOOKUP_DEGREE = 32 };

/* An index of edges. {0} is empty. */
typedef struct he_edge_lookup {
    uint32_t *rank; /* rank of a vertex among those of large degree, or HE_NONE */
    /* index in `lists` where the list of each rank begins; at the end, where the last list ends */
    uint32_t *starts;
    uint32_t *lists; /* a list for each rank: the neighbours of large degree with smaller ids */
    /* hash table of pairs of vertices that were joined after the lookup was made; 0 is a free
     * slot */
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
 * NULL or empty, searches around the vertices. */
bool he_edge_lookup_has(const he_mesh *m, const he_edge_lookup *lookup, he_vertex a, he_vertex b,
                        uint64_t *steps);

#endif
