/* hubs.h - the places where very many triangles meet.
 *
 *      \ | /        A hub is a position that HE_HUB_SPOKES corners of triangles or more have, be
 *     -- * --       they of one vertex or of several in the same place. Its spokes are the
 * triangles / | \        with a corner there.
 *
 * All boxes about the spokes of a hub hold that hub, so that no tree of boxes tells two of them
 * apart: whoever tries pairs of triangles treats hubs by themselves. Ordinary meshes have none. */
#ifndef HE_QUERY_HUBS_H
#define HE_QUERY_HUBS_H

#include "base/budget.h"
#include "mesh/mesh.h"

enum { HE_HUB_SPOKES = 32 };

typedef struct he_hubs {
    uint32_t count;
    uint32_t *first;  /* count + 1: where the spokes of each hub begin */
    uint32_t *spokes; /* triangles, rising for each hub */
    he_vec3 *places;  /* of the hubs */
} he_hubs;

/* Find the hubs of `count` triangles, given as three vertices each, `stride` words apart. A
 * triangle with two corners in one hub is a spoke of it once. n log n in the corners of hubs, else
 * linear. `out` is the caller's to clear. HE_NO_MEMORY; HE_CANCELLED and HE_LIMIT by the budget. */
HE_NODISCARD he_status he_hubs_find(const he_mesh *m, const uint32_t *triangles, size_t stride,
                                    uint32_t count, he_budget *budget, he_hubs *out, he_error *err);
void he_hubs_clear(he_hubs *hubs);

/* The hubs of each triangle, HE_HUBS_OF numbers each, in rising order; what is left is HE_NONE. */
enum { HE_HUBS_OF = 3 };
void he_hubs_of_triangles(const he_hubs *hubs, uint32_t count, uint32_t *out);

#endif
