/* joins.h - which vertices an edge joins, for who asks of many pairs while the mesh stays.
 *
 * he_find_halfedge turns about the vertex of smaller degree. Where two of large degree meet in very
 * many faces, that is long for each of them. Here the neighbours of every vertex of more than
 * HE_JOINS_DEGREE edges, those of such a degree too, are kept in rising order: a pair of them is
 * searched by halves, any other costs a few turns. Making it is linear in the mesh. */
#ifndef HE_GEOMETRY_JOINS_H
#define HE_GEOMETRY_JOINS_H

#include "mesh/walk.h"

enum { HE_JOINS_DEGREE = 32 };

/* {0} is empty. */
typedef struct he_joins {
    uint32_t *rank;   /* of a vertex among those of large degree, else HE_NONE */
    uint32_t *starts; /* of the lists of each rank, and the end of the last one */
    uint32_t *lists;  /* smaller neighbours of large degree */
    uint64_t *noted;  /* pairs that were joined later, hashed, 0 in free slots */
    size_t noted_count, noted_slots;
} he_joins;

/* HE_NO_MEMORY. Until he_joins_clear, which frees, the mesh must not change but by edges that are
 * noted. */
HE_NODISCARD he_status he_joins_make(const he_mesh *m, he_joins *out, he_error *err);
void he_joins_clear(he_joins *joins);
/* Makes room to note `extra` edges. Returns HE_NO_MEMORY if memory is out. Joins that are empty
 * need none. */
HE_NODISCARD he_status he_joins_reserve(he_joins *joins, size_t extra, he_error *err);
/* An edge was made between a and b. There is room. */
void he_joins_note(he_joins *joins, he_vertex a, he_vertex b);
/* Does an edge join a and b? Adds what it cost. `joins` NULL or empty: turn about them. */
bool he_joined(const he_mesh *m, const he_joins *joins, he_vertex a, he_vertex b, uint64_t *steps);

#endif
