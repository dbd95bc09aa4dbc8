/* idmap.h - a set of ids, numbered in the order in which they were added.
 *
 * A walk over part of a mesh must remember the elements it has visited, at a cost proportional to
 * what it touched and not to the mesh. The n-th id added gets the index n, so the caller can store
 * values for each element (such as its depth) in arrays parallel to `ids`, and `ids` itself is the
 * queue of a breadth-first walk. {0} is empty. */
#ifndef HE_QUERY_IDMAP_H
#define HE_QUERY_IDMAP_H

#include "mesh/mesh.h"

typedef struct he_idmap {
    he_ids ids; /* the ids in the order in which they were added */
    /* Hash table with open addressing, at most half full. An entry is an index in `ids`, plus 1; 0
     * if it is free. */
    uint32_t *slots;
    unsigned log2; /* base-2 logarithm of the number of slots; 0: there are no slots yet */
} he_idmap;

/* Returns the index of an id, HE_NONE if the id was never added. */
uint32_t he_idmap_find(const he_idmap *map, uint32_t id);
/* Finds the index of an id, which is added at the end if it is new; `*added` says whether it was.
 * Expected constant time.
 * Returns HE_NO_MEMORY if memory is out; the map is as it was. */
HE_NODISCARD he_status he_idmap_add(he_idmap *map, uint32_t id, uint32_t *index, bool *added,
                                    he_error *err);
void he_idmap_clear(he_idmap *map); /* frees the memory */

#endif
