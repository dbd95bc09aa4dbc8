/* adjacency.h - what lies beside an element.
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
 * face. At a bow-tie all fans are visited. Holes are left out, and an element that is met twice (a
 * face that shares several edges) appears where it was met first. With HE_CLOCKWISE the first
 * element stays first and the others follow backwards.
 *
 * No walk is longer than the number of half-edges: links that do not close are HE_CORRUPT. Costs
 * are proportional to what is visited. */
#ifndef HE_QUERY_ADJACENCY_H
#define HE_QUERY_ADJACENCY_H

#include "mesh/mesh.h"

/* Flags. */
enum { HE_CLOCKWISE = 1 };

struct he_gather; /* where a relation's function puts its ids; adjacency.c knows */

typedef struct he_relation {
    he_kind of, gives;
    const char *name;
    /* Call through the functions below. */
    he_status (*append)(const he_mesh *m, struct he_gather *out, he_error *err);
} he_relation;

size_t he_relation_count(void);
const he_relation *he_relation_at(size_t i);
/* NULL when this kind has no relation of that name. */
const he_relation *he_relation_find(he_kind of, const char *name, size_t length);

/* Append the ids beside one element to `out`. HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_CORRUPT,
 * HE_NO_MEMORY. */
HE_NODISCARD he_status he_relation_append(const he_mesh *m, const he_relation *relation,
                                          uint32_t id, unsigned flags, he_ids *out, he_error *err);

/* Those of many elements: element i has ids[offsets[i]] up to, not including, ids[offsets[i + 1]].
 * There is one offset more than elements. {0} is empty. */
typedef struct he_dense {
    he_ids offsets, ids;
} he_dense;

/* `of` lists `count` elements, which may repeat; NULL means every live one by rising id. `limit`
 * bounds the half-edges visited (0: only by what 32-bit offsets hold), since a list may name one
 * vertex of a thousand neighbours a thousand times: HE_LIMIT. `out` is the caller's to clear.
 * Otherwise as above. */
HE_NODISCARD he_status he_relation_dense(const he_mesh *m, const he_relation *relation,
                                         const uint32_t *of, size_t count, unsigned flags,
                                         uint64_t limit, he_dense *out, he_error *err);
void he_dense_clear(he_dense *dense);

/* Append the faces that have both vertices as corners, in the order about `a`: up to two where an
 * edge joins them, others where they are corners apart. Costs the sum of the degrees.
 * HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_CORRUPT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_common_faces(const he_mesh *m, he_vertex a, he_vertex b, he_ids *out,
                                       he_error *err);

#endif
