#include "query/hubs.h"

#include "base/mem.h"
#include "geometry/point_hash.h"
#include "mesh/walk.h"

#include <stdlib.h>
#include <string.h>

/* A vertex that may be at a hub, a position at which very many triangles meet. */
typedef struct candidate {
    he_vec3 place;
    uint32_t vertex, corners;
} candidate;

typedef struct search {
    const he_mesh *m;
    const uint32_t *triangles;
    size_t stride;
    uint32_t count;
    /* The number of triangle corners at each vertex; number_hubs overwrites it with the number of
     * the hub at which the vertex is, or HE_NONE. */
    uint32_t *corners;
    he_budget *budget;
} search;

static const uint32_t *triangle_of(const search *s, uint32_t i)
{
    return s->triangles + i * s->stride;
}

static int compare(const void *left, const void *right)
{
    const candidate *a = left, *b = right;
    if (a->place.x != b->place.x) {
        return a->place.x < b->place.x ? -1 : 1;
    }
    if (a->place.y != b->place.y) {
        return a->place.y < b->place.y ? -1 : 1;
    }
    if (a->place.z != b->place.z) {
        return a->place.z < b->place.z ? -1 : 1;
    }
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static bool same(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static he_status count_corners(const search *s, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t i = 0; i < s->count && status == HE_OK; i++) {
        const uint32_t *t = triangle_of(s, i);
        s->corners[t[0]]++;
        s->corners[t[1]]++;
        s->corners[t[2]]++;
        status = he_budget_take(s->budget, 1, err);
    }
    return status;
}

/* Lists the vertices that may be at a hub, a position at which very many triangles meet. A small
 * table counts triangle corners by the hash of their position. Several positions may have one hash,
 * so the count for a hash is at least the count of each position: if it is too small for a hub,
 * there is no hub at any of these positions. All other vertices are listed, and number_hubs
 * compares their positions exactly. In an ordinary mesh few vertices are listed. */
static he_status list_candidates(const search *s, candidate **out, size_t *count, he_error *err)
{
    uint32_t vertices = s->m->c.vertices.issued;
    size_t slots = 1024;
    while (slots < vertices) {
        slots *= 2;
    }
    uint32_t *sums = he_mem_zero(slots, sizeof *sums);
    candidate *list = NULL;
    he_status status = HE_OK;
    size_t most = 0;
    if (sums == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory to find which of %u vertices share a position", vertices);
    }
    const uint64_t seed = (uintptr_t)sums;
    for (uint32_t v = 0; v < vertices && status == HE_OK; v++) {
        if (s->corners[v] > 0) {
            sums[he_point_hash(seed, s->m->c.position[v]) & (slots - 1)] += s->corners[v];
        }
        status = he_budget_take(s->budget, 1, err);
    }
    for (int pass = 0; pass < 2 && status == HE_OK; pass++) {
        size_t found = 0;
        for (uint32_t v = 0; v < vertices; v++) {
            if (s->corners[v] == 0 ||
                sums[he_point_hash(seed, s->m->c.position[v]) & (slots - 1)] < HE_HUB_SPOKES) {
                continue;
            }
            if (pass == 1) {
                list[found] = (candidate){s->m->c.position[v], v, s->corners[v]};
            }
            found++;
        }
        most = found;
        if (pass == 0 && found == 0) {
            break;
        }
        if (pass == 0) {
            list = he_mem_array(NULL, found, sizeof *list);
            if (list == NULL) {
                status =
                    he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %zu positions", found);
            }
        }
    }
    he_mem_free(sums);
    if (status != HE_OK) {
        he_mem_free(list);
        return status;
    }
    *out = list;
    *count = most;
    return HE_OK;
}

/* Numbers the hubs (positions at which very many triangles meet) among the sorted candidates.
 * Overwrites s->corners of each vertex with the number of its hub, or HE_NONE if the vertex is at
 * no hub. Returns the number of hubs. */
static uint32_t number_hubs(const search *s, const candidate *list, size_t count, he_vec3 *places)
{
    uint32_t hubs = 0;
    memset(s->corners, 0xff, (size_t)s->m->c.vertices.issued * sizeof *s->corners);
    for (size_t begin = 0, end; begin < count; begin = end) {
        uint64_t corners = 0;
        for (end = begin; end < count && same(list[begin].place, list[end].place); end++) {
            corners += list[end].corners;
        }
        if (corners < HE_HUB_SPOKES) {
            continue;
        }
        for (size_t i = begin; i < end; i++) {
            s->corners[list[i].vertex] = hubs;
        }
        places[hubs++] = list[begin].place;
    }
    return hubs;
}

/* Writes to `out` the numbers of the hubs (positions at which very many triangles meet) at which
 * this triangle has corners, each hub once. Returns the number of hubs written. */
static int hubs_at(const search *s, uint32_t triangle, uint32_t out[3])
{
    const uint32_t *t = triangle_of(s, triangle);
    int found = 0;
    for (int k = 0; k < 3; k++) {
        uint32_t hub = s->corners[t[k]];
        bool known = hub == HE_NONE;
        for (int i = 0; i < found; i++) {
            known = known || out[i] == hub;
        }
        if (!known) {
            out[found++] = hub;
        }
    }
    return found;
}

static he_status list_spokes(const search *s, he_hubs *hubs, he_error *err)
{
    hubs->first = he_mem_zero((size_t)hubs->count + 1, sizeof *hubs->first);
    if (hubs->first == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory for %u positions at which many triangles meet",
                             hubs->count);
    }
    uint64_t total = 0;
    uint32_t at[3];
    for (uint32_t i = 0; i < s->count; i++) {
        int found = hubs_at(s, i, at);
        for (int k = 0; k < found; k++) {
            hubs->first[at[k]]++;
            total++;
        }
    }
    if (total > UINT32_MAX) {
        return he_fail_plain(err, HE_IDS_EXHAUSTED,
                             "too many triangles meet at vertices that are in the same place");
    }
    hubs->spokes = he_mem_array(NULL, (size_t)total, sizeof *hubs->spokes);
    if (hubs->spokes == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the triangles at %u vertices",
                             hubs->count);
    }
    /* first[h] is the number of spokes (triangles) of hub h here. The sum over all hubs up to h
     * then makes it the index in `spokes` at which the entries of hub h end. The loop after that
     * fills these entries from the last to the first and decrements first[h] for each, so at the
     * end first[h] is the index at which they begin. */
    uint32_t sum = 0;
    for (uint32_t h = 0; h < hubs->count; h++) {
        sum += hubs->first[h];
        hubs->first[h] = sum;
    }
    hubs->first[hubs->count] = sum;
    for (uint32_t i = s->count; i-- > 0;) {
        int found = hubs_at(s, i, at);
        for (int k = 0; k < found; k++) {
            hubs->spokes[--hubs->first[at[k]]] = i;
        }
    }
    return HE_OK;
}

void he_hubs_clear(he_hubs *hubs)
{
    he_mem_free(hubs->first);
    he_mem_free(hubs->spokes);
    he_mem_free(hubs->places);
    *hubs = (he_hubs){0};
}

static he_status find(search *s, he_hubs *out, he_error *err)
{
    candidate *list = NULL;
    size_t count = 0;
    he_hubs hubs = {0};
    he_status status = count_corners(s, err);
    if (status == HE_OK) {
        status = list_candidates(s, &list, &count, err);
    }
    if (status != HE_OK || count == 0) {
        return status;
    }
    qsort(list, count, sizeof *list, compare);
    hubs.places = he_mem_array(NULL, count, sizeof *hubs.places);
    if (hubs.places == NULL) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory for the positions of %zu vertices", count);
    } else {
        hubs.count = number_hubs(s, list, count, hubs.places);
    }
    he_mem_free(list);
    if (status == HE_OK && hubs.count > 0) {
        status = list_spokes(s, &hubs, err);
    }
    if (status != HE_OK || hubs.count == 0) {
        he_hubs_clear(&hubs);
        return status;
    }
    *out = hubs;
    return HE_OK;
}

he_status he_hubs_find(const he_mesh *m, const uint32_t *triangles, size_t stride, uint32_t count,
                       he_budget *budget, he_hubs *out, he_error *err)
{
    search s = {m, triangles, stride, count, NULL, budget};
    s.corners = he_mem_zero((size_t)m->c.vertices.issued + 1, sizeof *s.corners);
    if (s.corners == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory to find which of %u vertices share a position",
                             m->c.vertices.issued);
    }
    *out = (he_hubs){0};
    he_status status = find(&s, out, err);
    he_mem_free(s.corners);
    return status;
}

void he_hubs_of_triangles(const he_hubs *hubs, uint32_t count, uint32_t *out)
{
    memset(out, 0xff, (size_t)count * HE_HUBS_OF * sizeof *out);
    for (uint32_t h = 0; h < hubs->count; h++) {
        for (uint32_t i = hubs->first[h]; i < hubs->first[h + 1]; i++) {
            uint32_t *of = out + (size_t)hubs->spokes[i] * HE_HUBS_OF;
            *(of[0] == HE_NONE ? &of[0] : of[1] == HE_NONE ? &of[1] : &of[2]) = h;
        }
    }
}
