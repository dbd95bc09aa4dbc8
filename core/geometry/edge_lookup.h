/* edge_lookup.h - tells whether an edge joins two vertices, for very many pairs of vertices in a
 * mesh that does not change.
 *
 * he_find_halfedge searches the half-edges around the vertex of smaller degree. This takes long if
 * many pairs of vertices have large degrees at both ends. Here a vertex is of large degree if it
 * has more than HE_EDGE_LOOKUP_DEGREE edges. For every such vertex, the lookup has a sorted list of
 * the vertex's neighbours of large degree. So an edge between two vertices of large degree is found
 * by bisection of a list, and any other edge by a short search around the vertex of smaller degree.
 * Making the lookup takes time linear in the size of the mesh. */
#ifndef HE_GEOMETRY_EDGE_LOOKUP_H
#define HE_GEOMETRY_EDGE_LOOKUP_H

#include "mesh/walk.h"

enum { HE_EDGE_LOOKUP_DEGREE = 32 };

/* An index of the edges between vertices of large degree. {0} is empty. */
typedef struct he_edge_lookup {
    /* for each vertex, its index among the vertices of large degree; HE_NONE if the vertex's degree
     * is not large */
    uint32_t *rank;
    /* for each vertex of large degree, the index in `lists` at which the vertex's list begins; one
     * more entry says where the last list ends */
    uint32_t *starts;
    /* the lists of all vertices of large degree, one after another: a list has the ids of the
     * vertex's neighbours that have large degrees and smaller ids than the vertex */
    uint32_t *lists;
    /* hash table of pairs of vertices that got an edge after the lookup was made; an unused entry
     * is 0 */
    uint64_t *noted;
    size_t noted_count, noted_slots;
} he_edge_lookup;

/* Makes the lookup. he_edge_lookup_clear frees it. Until then the mesh must not change, except that
 * edges may be added if each is reported to he_edge_lookup_add.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_lookup_make(const he_mesh *m, he_edge_lookup *out, he_error *err);
void he_edge_lookup_clear(he_edge_lookup *lookup);
/* Allocates memory for adding `extra` edges; an empty lookup needs none.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_lookup_reserve(he_edge_lookup *lookup, size_t extra, he_error *err);
/* Adds an edge that was made between a and b. he_edge_lookup_reserve must have allocated memory for
 * it. */
void he_edge_lookup_add(he_edge_lookup *lookup, he_vertex a, he_vertex b);
/* Returns true if an edge joins the vertices a and b. Adds the number of steps of the search to
 * `*steps`. If `lookup` is NULL or empty, the function searches around a and b instead. */
bool he_edge_lookup_has(const he_mesh *m, const he_edge_lookup *lookup, he_vertex a, he_vertex b,
                        uint64_t *steps);

#endif
