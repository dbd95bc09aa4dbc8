#include "geometry/edge_lookup.h"

#include "base/word_hash.h"

void he_edge_lookup_clear(he_edge_lookup *lookup)
{
    he_mem_free(lookup->rank);
    he_mem_free(lookup->starts);
    he_mem_free(lookup->lists);
    he_mem_free(lookup->noted);
    *lookup = (he_edge_lookup){.rank = NULL};
}

/* Numbers the vertices of large degree: rank[v] becomes the number of vertex v among them, or
 * HE_NONE if the degree of v is not large. Returns the number of vertices of large degree. */
static uint32_t rank_vertices(const he_mesh *m, uint32_t *rank)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < 2 * m->c.edges.issued; h++) {
        if (he_edge_is_live(m, he_edge_of((he_halfedge){h}))) {
            rank[m->c.origin[h]]++;
        }
    }
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        rank[v] = rank[v] > HE_EDGE_LOOKUP_DEGREE ? count++ : HE_NONE;
    }
    return count;
}

/* Returns true if the target of half-edge h belongs into the list of neighbours of h's origin: the
 * origin and the target have large degrees, and the target has the smaller id. */
static bool is_listed(const he_mesh *m, const uint32_t *rank, uint32_t h)
{
    uint32_t from = m->c.origin[h], to = m->c.origin[h ^ 1u];
    return to < from && rank[from] != HE_NONE && rank[to] != HE_NONE;
}

/* Computes where, in the array that holds all lists one after another, the list of each vertex of
 * large degree begins. Returns the length of the array. The beginning of list i is stored in
 * starts[i + 1]; while fill_lists fills the list, it moves this position to the end of the list. */
static uint32_t measure_lists(const he_mesh *m, const uint32_t *rank, uint32_t count,
                              uint32_t *starts)
{
    uint32_t total = 0;
    for (uint32_t h = 0; h < 2 * m->c.edges.issued; h++) {
        if (he_edge_is_live(m, he_edge_of((he_halfedge){h})) && is_listed(m, rank, h)) {
            starts[rank[m->c.origin[h]] + 1]++;
        }
    }
    for (uint32_t i = 1; i <= count; i++) {
        uint32_t length = starts[i];
        starts[i] = total;
        total += length;
    }
    return total;
}

/* Appends each vertex of large degree to the lists of its neighbours that have large degrees and
 * larger ids. The vertices are visited in rising order of ids, so every list is sorted. */
static void fill_lists(const he_mesh *m, const he_edge_lookup *j)
{
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (j->rank[v] == HE_NONE) {
            continue;
        }
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){v}), h = first;
        do {
            if (is_listed(m, j->rank, he_twin(h).i)) {
                j->lists[j->starts[j->rank[he_target(m, h).i] + 1]++] = v;
            }
            h = he_swing_cw(m, h);
        } while (h.i != first.i);
    }
}

he_status he_edge_lookup_make(const he_mesh *m, he_edge_lookup *out, he_error *err)
{
    he_edge_lookup made = {.rank =
                               he_mem_zero((size_t)m->c.vertices.issued + 1, sizeof *made.rank)};
    uint32_t count = made.rank == NULL ? 0 : rank_vertices(m, made.rank);
    made.starts = he_mem_zero((size_t)count + 2, sizeof *made.starts);
    if (made.rank != NULL && made.starts != NULL) {
        uint32_t total = measure_lists(m, made.rank, count, made.starts);
        made.lists = he_mem_array(NULL, (size_t)total + 1, sizeof *made.lists);
    }
    if (made.lists == NULL) {
        he_edge_lookup_clear(&made);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the neighbours of %u vertices",
                             m->c.vertices.live);
    }
    fill_lists(m, &made);
    *out = made;
    return HE_OK;
}

/* --- pairs of vertices that got an edge after the lookup was made --- */

/* Returns the key of a pair of vertices in the hash table. A key is never 0, because its upper half
 * is the larger of the two ids, which is not 0. */
static uint64_t key_of(he_vertex a, he_vertex b)
{
    return a.i < b.i ? (uint64_t)b.i << 32 | a.i : (uint64_t)a.i << 32 | b.i;
}

/* Returns the index of the entry of the hash table that holds a key, or of the free entry in which
 * the key belongs. */
static size_t slot_of(const he_edge_lookup *j, uint64_t key)
{
    size_t mask = j->noted_slots - 1;
    size_t at = (size_t)(he_word_hash((uintptr_t)j->noted, key) >> 32) & mask;
    while (j->noted[at] != 0 && j->noted[at] != key) {
        at = (at + 1) & mask;
    }
    return at;
}

he_status he_edge_lookup_reserve(he_edge_lookup *lookup, size_t extra, he_error *err)
{
    if (lookup->rank == NULL || 2 * (lookup->noted_count + extra) <= lookup->noted_slots) {
        return HE_OK;
    }
    he_edge_lookup grown = {.noted_slots = 64};
    while (grown.noted_slots < 4 * (lookup->noted_count + extra)) {
        grown.noted_slots *= 2;
    }
    grown.noted = he_mem_zero(grown.noted_slots, sizeof *grown.noted);
    if (grown.noted == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu new edges", extra);
    }
    for (size_t i = 0; i < lookup->noted_slots; i++) {
        if (lookup->noted[i] != 0) {
            grown.noted[slot_of(&grown, lookup->noted[i])] = lookup->noted[i];
        }
    }
    he_mem_free(lookup->noted);
    lookup->noted = grown.noted;
    lookup->noted_slots = grown.noted_slots;
    return HE_OK;
}

void he_edge_lookup_add(he_edge_lookup *lookup, he_vertex a, he_vertex b)
{
    if (lookup->rank[a.i] != HE_NONE && lookup->rank[b.i] != HE_NONE) {
        lookup->noted[slot_of(lookup, key_of(a, b))] = key_of(a, b);
        lookup->noted_count++;
    }
}

bool he_edge_lookup_has(const he_mesh *m, const he_edge_lookup *lookup, he_vertex a, he_vertex b,
                        uint64_t *steps)
{
    if (lookup == NULL || lookup->rank == NULL || lookup->rank[a.i] == HE_NONE ||
        lookup->rank[b.i] == HE_NONE) {
        return he_find_halfedge_counted(m, a, b, steps).i != HE_NONE;
    }
    uint32_t small = a.i < b.i ? a.i : b.i, large = a.i < b.i ? b.i : a.i;
    uint32_t from = lookup->starts[lookup->rank[large]],
             to = lookup->starts[lookup->rank[large] + 1];
    while (from < to) {
        uint32_t middle = from + (to - from) / 2;
        *steps += 1;
        if (lookup->lists[middle] == small) {
            return true;
        }
        if (lookup->lists[middle] < small) {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    *steps += 1;
    return lookup->noted_count > 0 && lookup->noted[slot_of(lookup, key_of(a, b))] != 0;
}
