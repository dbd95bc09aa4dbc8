/* split.c - the repair split: gives each fan of faces a vertex of its own. Two corners become mates
 * if their half-edges run along one edge in opposite directions and their faces stay joined there.
 * If two pairs of mates would make two edges between two vertices, they exchange their partners
 * (exchange.c). */
#include "repair/split.h"

#include <string.h>

static he_status no_memory(const he_soup *soup, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to split %zu faces apart", soup->face_count);
}

/* Makes corners along each edge mates: each corner gets the first corner without a mate whose
 * half-edge runs in the opposite direction. At any time, all corners of an edge that wait for a
 * mate run in one direction, so they form a queue, linked by `mate`. */
static he_status pair(he_splitting *s, he_error *err)
{
    const he_soup *soup = s->soup;
    size_t edges = 0;
    /* The memory of `to` is used for this array until the fans are found. */
    uint32_t *edge_of = s->to;
    uint32_t *head = NULL, *tail = NULL;
    he_status status = he_soup_number_edges(soup, edge_of, &edges, err);
    if (status != HE_OK) {
        return status;
    }
    head = he_mem_array(NULL, edges, sizeof *head);
    tail = he_mem_zero(edges + 1, sizeof *tail);
    if (head == NULL || tail == NULL) {
        he_mem_free(head);
        he_mem_free(tail);
        return no_memory(soup, err);
    }
    for (size_t e = 0; e < edges; e++) {
        head[e] = HE_NONE;
    }
    for (uint32_t c = 0; c < soup->corner_count; c++) {
        uint32_t e = edge_of[c], first = head[e];
        if (first != HE_NONE && soup->corners[first] != soup->corners[c]) {
            head[e] = s->mate[first];
            s->mate[first] = c;
            s->mate[c] = first;
            continue;
        }
        s->mate[c] = HE_NONE;
        if (first == HE_NONE) {
            head[e] = c;
        } else {
            s->mate[tail[e]] = c;
        }
        tail[e] = c;
    }
    for (size_t e = 0; e < edges; e++) {
        s->is_crowded = s->is_crowded || (head[e] != HE_NONE && s->mate[head[e]] != HE_NONE);
        for (uint32_t c = head[e]; c != HE_NONE;) {
            uint32_t waits = s->mate[c];
            s->mate[c] = HE_NONE;
            c = waits;
        }
        tail[e] = 0;
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        s->is_crowded = ++tail[edge_of[c]] > 2 || s->is_crowded;
    }
    he_mem_free(head);
    he_mem_free(tail);
    return HE_OK;
}

static he_status add_copy(he_splitting *s, uint32_t parent, he_error *err)
{
    if (s->copies == s->capacity) {
        size_t capacity = he_mem_grown(s->capacity, s->copies + 1);
        uint32_t *parents = he_mem_array(s->parents, capacity, sizeof *parents);
        if (parents == NULL) {
            return no_memory(s->soup, err);
        }
        s->parents = parents;
        s->capacity = capacity;
    }
    s->parents[s->copies++] = parent;
    return HE_OK;
}

/* Finds all corners of the fan to which corner c belongs and assigns them a vertex. The first fan
 * of a vertex keeps the vertex; every other fan gets a copy of the vertex. */
static he_status find_fan(he_splitting *s, uint32_t c, he_error *err)
{
    uint32_t v = s->soup->corners[c], vertex = v;
    bool is_first = !he_bits_get(s->taken, v);
    if (!is_first) {
        vertex = (uint32_t)(s->soup->vertex_count + s->copies);
        he_status status = add_copy(s, v, err);
        if (status != HE_OK) {
            return status;
        }
    }
    he_bits_set(s->taken, v);
    bool is_closed = false;
    uint32_t at = c;
    do {
        s->to[at] = vertex;
        he_bits_set(s->done, at);
        uint32_t mate = s->mate[at];
        at = mate == HE_NONE ? HE_NONE : he_corner_after(s, mate);
        is_closed = at == c;
    } while (at != HE_NONE && !is_closed);
    for (at = c; !is_closed && (at = s->mate[he_corner_before(s, at)]) != HE_NONE;) {
        s->to[at] = vertex;
        he_bits_set(s->done, at);
    }
    if (is_first && is_closed) {
        he_bits_set(s->closed, v);
    } else if (!is_first && (is_closed || he_bits_get(s->closed, v))) {
        s->has_closed = true;
    }
    return HE_OK;
}

static void clear_bits(uint64_t *bits, size_t count)
{
    memset(bits, 0, (count + 63) / 64 * sizeof *bits);
}

static he_status find_fans(he_splitting *s, he_error *err)
{
    const he_soup *soup = s->soup;
    he_status status = HE_OK;
    clear_bits(s->done, soup->corner_count);
    clear_bits(s->taken, soup->vertex_count);
    clear_bits(s->closed, soup->vertex_count);
    s->copies = 0;
    for (uint32_t c = 0; c < soup->corner_count && status == HE_OK; c++) {
        status = he_progress_at(soup->limits.progress, c, soup->corner_count, err);
        if (status == HE_OK && !he_bits_get(s->done, c)) {
            status = find_fan(s, c, err);
        }
    }
    return status;
}

static void clear(he_splitting *s)
{
    he_mem_free(s->mate);
    he_mem_free(s->face_of);
    he_mem_free(s->to);
    he_mem_free(s->parents);
    he_mem_free(s->done);
    he_mem_free(s->taken);
    he_mem_free(s->closed);
}

/* Begins the repair: allocates its memory and finds the mate of each corner. */
static he_status begin(he_splitting *s, he_error *err)
{
    const he_soup *soup = s->soup;
    s->mate = he_mem_array(NULL, soup->corner_count, sizeof *s->mate);
    s->face_of = he_mem_array(NULL, soup->corner_count, sizeof *s->face_of);
    s->to = he_mem_array(NULL, soup->corner_count, sizeof *s->to);
    s->done = he_bits_new(soup->corner_count);
    s->taken = he_bits_new(soup->vertex_count);
    s->closed = he_bits_new(soup->vertex_count);
    if (s->mate == NULL || s->face_of == NULL || s->to == NULL || s->done == NULL ||
        s->taken == NULL || s->closed == NULL) {
        return no_memory(soup, err);
    }
    he_mend_faces(soup, s->face_of);
    return pair(s, err);
}

static he_status plan(he_splitting *s, he_error *err)
{
    bool again = false;
    he_status status = begin(s, err);
    if (status == HE_OK) {
        status = find_fans(s, err);
    }
    if (status == HE_OK && s->is_crowded) {
        status = he_splitting_exchange(s, &again, err);
    }
    if (status == HE_OK && again) {
        status = find_fans(s, err);
    }
    return status;
}

/* Changes the soup so that each fan has a vertex of its own. Nothing is changed before all memory
 * is allocated. */
static he_status apply(he_mend *m, he_splitting *s, he_error *err)
{
    he_soup *soup = m->soup;
    he_repaired *out = m->out;
    he_repair_account *account = &out->accounts[HE_REPAIR_SPLIT];
    size_t old = soup->vertex_count, all = old + s->copies;
    uint32_t *from = out->vertex_from == NULL ? he_mend_same(old, all)
                                              : he_mem_array(out->vertex_from, all, sizeof *from);
    if (from == NULL) {
        return no_memory(soup, err);
    }
    out->vertex_from = from;
    he_status status = HE_OK;
    clear_bits(s->taken, old);
    for (size_t i = 0; i < s->copies && status == HE_OK; i++) {
        uint32_t parent = s->parents[i];
        from[old + i] = from[parent];
        status = he_soup_add_vertex(soup, soup->positions[parent], err);
        he_mend_name(account, (uint32_t)(old + i), parent);
        account->parts += !he_bits_get(s->taken, parent);
        he_bits_set(s->taken, parent);
    }
    account->count = s->copies;
    out->vertices = all;
    if (status == HE_OK) {
        memcpy(soup->corners, s->to, soup->corner_count * sizeof *soup->corners);
    }
    return status;
}

he_status he_mend_split(he_mend *m, he_error *err)
{
    he_splitting s = {.soup = m->soup};
    he_status status = plan(&s, err);
    if (status == HE_OK && s.copies > 0) {
        status = apply(m, &s, err);
    }
    clear(&s);
    return status;
}

he_status he_mend_needs_split(const he_soup *soup, bool *out, he_error *err)
{
    he_splitting s = {.soup = soup};
    he_status status = begin(&s, err);
    if (status == HE_OK && !s.is_crowded) {
        status = find_fans(&s, err);
    }
    if (status == HE_OK) {
        *out = s.is_crowded || s.has_closed;
    }
    clear(&s);
    return status;
}
