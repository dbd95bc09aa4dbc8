/* adjacency.h - the neighbours of an element.
 *
 *     of          relation    gives
 *     vertex      vertices    its neighbours along edges
 *                 outgoing    half-edges that leave it
 *                 incoming    half-edges that arrive at it: the twins of outgoing, in their order
 *                 edges       those of outgoing, in their order
 *                 faces       those left of outgoing, in their order
 *     face        vertices    its corners
 *                 halfedges   its loop
 *                 edges       those of halfedges
 *                 faces       across its edges
 *     edge        vertices    origin and target of half-edge 2e
 *                 halfedges   2e, 2e + 1
 *                 faces       left of them
 *     halfedge    loop        around its face or hole, from itself
 *                 ring        half-edges that leave its origin, from itself
 *
 * ORDER is counter-clockwise from the stored half-edge (the boundary one at a boundary vertex, so
 * that a fan comes in one piece), by h -> twin(prev(h)) about a vertex and h -> next(h) around a
 * face. At a bow-tie all fans are visited. Holes are left out, and an element that is reached twice
 * (a face that shares several edges) is listed only once, the first time. With HE_CLOCKWISE the
 * first element stays first and the others follow backwards.
 *
 * No walk is longer than the number of half-edges: links that do not close give HE_CORRUPT. A walk
 * takes time proportional to what it visits. */
#ifndef HE_QUERY_ADJACENCY_H
#define HE_QUERY_ADJACENCY_H

#include "mesh/mesh.h"

/* Flags of the functions below. */
enum { HE_CLOCKWISE = 1 };

/* The collector to which the function of a relation passes the ids of neighbours. Its members are
 * private to adjacency.c. */
struct he_gather;

typedef struct he_relation {
    he_kind of, gives;
    const char *name;
    /* Appends the neighbours of one element, without checks. Only the functions declared below call
     * it. */
    he_status (*append)(const he_mesh *m, struct he_gather *out, he_error *err);
} he_relation;

size_t he_relation_count(void);
const he_relation *he_relation_at(size_t i);
/* Returns the relation of elements of the kind `of` that has this name, NULL if there is none. */
const he_relation *he_relation_find(he_kind of, const char *name, size_t length);

/* Appends the neighbours of one element to `out`.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if the element is not live.
 * Returns HE_CORRUPT if links do not close.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_relation_append(const he_mesh *m, const he_relation *relation,
                                          uint32_t id, unsigned flags, he_ids *out, he_error *err);

/* The neighbours of many elements: those of element i are ids[offsets[i]] up to, not including,
 * ids[offsets[i + 1]]. There is one offset more than elements. {0} is empty. */
typedef struct he_dense {
    he_ids offsets, ids;
} he_dense;

/* A request for the neighbours of many elements. */
typedef struct he_neighbours {
    const he_relation *relation;
    const uint32_t *of; /* the elements, which may repeat; NULL: all live ones by rising id */
    size_t count;
    unsigned flags;
} he_neighbours;

/* Finds the neighbours of many elements. `limit` is the largest number of half-edges to visit,
 * since a list may name one vertex of a thousand neighbours a thousand times; 0 means that only the
 * range of 32-bit offsets limits it. The caller clears `out`. Returns the errors of
 * he_relation_append, too. Returns HE_LIMIT if more half-edges would be visited. */
HE_NODISCARD he_status he_relation_dense(const he_mesh *m, const he_neighbours *asked,
                                         uint64_t limit, he_dense *out, he_error *err);
void he_dense_clear(he_dense *dense);

/* Appends the faces that have both vertices a and b as corners, in the order about `a`: up to two
 * beside the edge between a and b, and faces in which a and b are corners that no side joins. Takes
 * time linear in the sum of the degrees.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if a vertex is not live.
 * Returns HE_CORRUPT if links do not close.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_common_faces(const he_mesh *m, he_vertex a, he_vertex b, he_ids *out,
                                       he_error *err);

#endif
