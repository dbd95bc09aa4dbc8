/* hubs.h - finds positions at which very many triangles meet.
 *
 *      \ | /        A hub is a position of at least HE_HUB_SPOKES corners of triangles, whether
 *     -- * --       they belong to one vertex or to several at one position. Its spokes are the
 * triangles / | \        with a corner there.
 *
 * All boxes around the spokes of a hub contain the hub, so a tree of boxes cannot separate two
 * spokes: searches for pairs of triangles treat hubs separately. Ordinary meshes have none. */
#ifndef HE_QUERY_HUBS_H
#define HE_QUERY_HUBS_H

#include "base/budget.h"
#include "mesh/mesh.h"

enum { HE_HUB_SPOKES = 32 };

typedef struct he_hubs {
    uint32_t count;
    uint32_t *first;  /* count + 1 numbers: where the spokes of each hub begin */
    uint32_t *spokes; /* triangles, in rising order for each hub */
    he_vec3 *places;  /* positions of the hubs */
} he_hubs;

/* Finds the hubs of `count` triangles, given as three vertices each, `stride` words apart. A
 * triangle with two corners at one hub is one spoke of it. The time is n log n in the corners of
 * hubs, else linear. The caller clears `out`.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED or HE_LIMIT if the budget ends the work. */
HE_NODISCARD he_status he_hubs_find(const he_mesh *m, const uint32_t *triangles, size_t stride,
                                    uint32_t count, he_budget *budget, he_hubs *out, he_error *err);
void he_hubs_clear(he_hubs *hubs);

/* Lists the hubs of each triangle, HE_HUBS_OF numbers each, in rising order; unused ones are
 * HE_NONE. */
enum { HE_HUBS_OF = 3 };
void he_hubs_of_triangles(const he_hubs *hubs, uint32_t count, uint32_t *out);

#endif
