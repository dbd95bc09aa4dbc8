/* hubs.h - finds hubs: positions at which very many triangles meet.
 *
 *      \ | /       A hub is a position of at least HE_HUB_SPOKES corners of triangles, whether
 *     -- * --      they belong to one vertex or to several at one position. Its spokes are the
 *      / | \       triangles with a corner there.
 *
 * All boxes around the spokes of a hub contain the hub, so a tree of boxes cannot separate two
 * spokes: searches for pairs of triangles treat hubs separately. Ordinary meshes have no hubs. */
#ifndef HE_QUERY_HUBS_H
#define HE_QUERY_HUBS_H

#include "base/budget.h"
#include "mesh/mesh.h"

enum { HE_HUB_SPOKES = 32 };

typedef struct he_hubs {
    uint32_t count;
    /* `count` + 1 indices of `spokes`: where the spokes of each hub begin, and where the last
     * ones end */
    uint32_t *first;
    /* the triangles at the hubs, one hub after another, for each hub in rising order */
    uint32_t *spokes;
    he_vec3 *places; /* positions of the hubs */
} he_hubs;

/* Finds the hubs of `count` triangles. Each is given as three vertices, and the next triangle
 * begins `stride` words later. A triangle with two corners at one hub is one spoke of it. Takes O(n
 * log n) time for n corners at hubs, and linear time for all other corners. The caller clears
 * `out`.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED or HE_LIMIT if the budget ends the work. */
HE_NODISCARD he_status he_hubs_find(const he_mesh *m, const uint32_t *triangles, size_t stride,
                                    uint32_t count, he_budget *budget, he_hubs *out, he_error *err);
void he_hubs_clear(he_hubs *hubs);

/* Lists the hubs at which each triangle has a corner: HE_HUBS_OF numbers for each triangle, in
 * rising order; unused ones are HE_NONE. */
enum { HE_HUBS_OF = 3 };
void he_hubs_of_triangles(const he_hubs *hubs, uint32_t count, uint32_t *out);

#endif
