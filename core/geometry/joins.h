/* joins.h - an index of the edges of a mesh that does not change, for many questions whether two
 * vertices are joined by an edge.
 *
 * he_find_halfedge searches the ring of the vertex of smaller degree, which is long if two vertices
 * of large degree share very many faces. This index sorts, for every vertex of more than
 * HE_JOINS_DEGREE edges, its neighbours that have as many: such a pair is found by bisection, any
 * other by a short search. Making it is linear in the mesh. */
#ifndef HE_GEOMETRY_JOINS_H
#define HE_GEOMETRY_JOINS_H

#include "mesh/walk.h"

enum { HE_JOINS_DEGREE = 32 };

/* An index of edges. {0} is empty. */
typedef struct he_joins {
    uint32_t *rank;   /* rank of a vertex among those of large degree, or HE_NONE */
    uint32_t *starts; /* where the list of each rank begins, and where the last one ends */
    uint32_t *lists;  /* for each rank, the neighbours of large degree with smaller ids */
    uint64_t *noted;  /* hash table of pairs that were joined later; 0 is a free slot */
    size_t noted_count, noted_slots;
} he_joins;

/* Makes the index. Until he_joins_clear, which frees it, the mesh must not change except by edges
 * that are reported to he_joins_note.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_joins_make(const he_mesh *m, he_joins *out, he_error *err);
void he_joins_clear(he_joins *joins);
/* Makes room to add `extra` edges; an empty index needs none.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_joins_reserve(he_joins *joins, size_t extra, he_error *err);
/* Adds an edge that was made between a and b; he_joins_reserve must have made room. */
void he_joins_note(he_joins *joins, he_vertex a, he_vertex b);
/* Returns true if an edge joins a and b. Adds the cost of the search to `*steps`. If `joins` is
 * NULL or empty, searches around the vertices. */
bool he_joined(const he_mesh *m, const he_joins *joins, he_vertex a, he_vertex b, uint64_t *steps);

#endif
