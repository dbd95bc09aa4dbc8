/* exchange.c - exchanges the mates of corners where the repair split would otherwise make two edges
 * between one pair of vertices.
 *
 * Two corners are mates if their half-edges run along one edge in opposite directions and their
 * faces stay joined there. A fan is a run of faces around a vertex that are joined in this way; the
 * repair gives each fan a vertex of its own.
 *
 * Let x and y be corners whose half-edges run along one edge in one direction. If these half-edges
 * begin in one fan and end in one fan, the repair would make two edges between two vertices. To
 * prevent this, x gets the mate of y, and y gets the mate of x. In the order around the vertex, the
 * corners that followed x then follow y, and the corners that followed y follow x. So the fan falls
 * into two fans, one with x and one with y:
 *
 *     ... x | a ... y | b ...      ->      x | b ...      and      y | a ... (and on to y)
 *
 * The fan at the far end of the edge falls into two fans as well. No exchange joins two fans, so
 * edges that are separate stay separate, and each edge is handled only once. The number of corners
 * with mates does not change, so a closed surface stays closed.
 *
 * The corners of an edge are settled one by one: each is compared with the settled corners of the
 * edge by the numbers of the fans at the two ends of its half-edge, and exchanges its mate if
 * necessary. If a fan falls into two parts, the smaller part gets a new number. A corner is thus
 * renumbered few times, and all exchanges together take n log n steps. */
#include "repair/split.h"

#include <assert.h>

/* An entry of a hash table for a settled corner of the edge being handled. A corner is settled once
 * it was compared with the other corners of its edge and got another mate if necessary. The numbers
 * of the fans at the two ends of the corner's half-edge are those at that time and may have changed
 * since. */
typedef struct slot {
    /* number of the edge being handled, plus 1; the entry is free if the value differs */
    uint32_t epoch;
    uint32_t corner, from, to;
} slot;

typedef struct exchanging {
    he_splitting *s;
    uint32_t *edge_of; /* the edge along which the half-edge of each corner runs */
    /* Index at which the corners of each edge begin in `list`. The list omits edges that have at
     * most two corners. */
    uint32_t *begin;
    uint32_t *list;
    size_t edges;
    uint32_t fans; /* number of fans so far, including the fans that resulted from exchanges */
    bool any;
    /* The edge being handled, and one of its two vertices: the one at which most of the edge's
     * corners are. */
    uint32_t edge, origin;
    uint64_t *settled; /* one bit for each corner: set if the corner is settled */
    slot *slots;
    size_t mask, used;
} exchanging;

static he_status no_memory(const exchanging *x, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to split %zu faces apart",
                         x->s->soup->face_count);
}

/* --- finding settled corners by their fans --- */

static bool is_valid(const exchanging *x, const slot *at)
{
    const he_splitting *s = x->s;
    return at->epoch == x->edge + 1 && s->to[at->corner] == at->from &&
           s->to[he_corner_after(s, at->corner)] == at->to;
}

/* Returns the index in `slots` of a settled corner of the edge being handled whose half-edge runs
 * from fan `from` to fan `to`; if there is none, the index of a free slot. */
static size_t slot_of(const exchanging *x, uint32_t from, uint32_t to)
{
    uint64_t sum = (uint64_t)(uintptr_t)x->slots * 0x94D049BB133111EB;
    sum = (sum ^ from) * 0x9E3779B97F4A7C15;
    sum = (sum ^ sum >> 32 ^ to) * 0xBF58476D1CE4E5B9;
    size_t at = (size_t)(sum >> 24) & x->mask;
    while (x->slots[at].epoch == x->edge + 1 &&
           (x->slots[at].from != from || x->slots[at].to != to || !is_valid(x, &x->slots[at]))) {
        at = (at + 1) & x->mask;
    }
    return at;
}

static void put(exchanging *x, uint32_t corner)
{
    uint32_t from = x->s->to[corner], to = x->s->to[he_corner_after(x->s, corner)];
    size_t at = slot_of(x, from, to);
    x->used += x->slots[at].epoch != x->edge + 1;
    x->slots[at] = (slot){x->edge + 1, corner, from, to};
}

/* Makes room in the hash table for `more` more entries. If the table is too full, it is replaced by
 * another one without the entries that are obsolete. */
static he_status make_room(exchanging *x, size_t more, he_error *err)
{
    if (x->slots != NULL && 2 * (x->used + more) <= x->mask) {
        return HE_OK;
    }
    exchanging wide = *x;
    wide.used = 0;
    size_t count = 64;
    for (size_t i = 0; x->slots != NULL && i <= x->mask; i++) {
        wide.used += is_valid(x, &x->slots[i]);
    }
    while (count <= 4 * (wide.used + more)) {
        count *= 2;
    }
    wide.used = 0;
    wide.mask = count - 1;
    wide.slots = he_mem_zero(count, sizeof *wide.slots);
    if (wide.slots == NULL) {
        return no_memory(x, err);
    }
    for (size_t i = 0; x->slots != NULL && i <= x->mask; i++) {
        if (is_valid(x, &x->slots[i])) {
            put(&wide, x->slots[i].corner);
        }
    }
    he_mem_free(x->slots);
    *x = wide;
    return HE_OK;
}

/* --- fans --- */

/* A walk over the corners of a fan. It begins at `start` and goes around the vertex until the fan
 * ends, then continues from `start` in the opposite direction (`back`). */
typedef struct walk {
    uint32_t start, at;
    bool back;
} walk;

/* Moves the walk to the next corner of the fan. Returns false when all corners were visited. */
static bool step(const he_splitting *s, walk *w)
{
    if (!w->back) {
        uint32_t mate = s->mate[w->at];
        if (mate != HE_NONE) {
            w->at = he_corner_after(s, mate);
            return w->at != w->start;
        }
        w->back = true;
        w->at = w->start;
    }
    uint32_t mate = s->mate[he_corner_before(s, w->at)];
    w->at = mate;
    return mate != HE_NONE;
}

static bool is_settled(const exchanging *x, uint32_t c)
{
    return x->edge_of[c] == x->edge && he_bits_get(x->settled, c);
}

/* Gives numbers to the two parts into which a fan has fallen: the smaller part gets a new number,
 * and the larger part keeps the fan's number. Corner a is in one part, and corner b in the other
 * part. */
static he_status number(exchanging *x, uint32_t a, uint32_t b, he_error *err)
{
    const he_splitting *s = x->s;
    walk of_a = {a, a, false}, of_b = {b, b, false};
    size_t size = 1;
    bool more_a = true, more_b = true;
    for (; more_a && more_b; size++) {
        more_a = step(s, &of_a);
        more_b = step(s, &of_b);
    }
    he_status status = make_room(x, 2 * size, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t fan = x->fans++;
    walk w = {more_a ? b : a, more_a ? b : a, false};
    do {
        uint32_t before = he_corner_before(s, w.at);
        s->to[w.at] = fan;
        if (is_settled(x, w.at)) {
            put(x, w.at);
        }
        if (is_settled(x, before)) {
            put(x, before);
        }
    } while (step(s, &w));
    return HE_OK;
}

static void join(he_splitting *s, uint32_t c, uint32_t mate)
{
    s->mate[c] = mate;
    if (mate != HE_NONE) {
        s->mate[mate] = c;
    }
}

static he_status settle(exchanging *x, uint32_t c, he_error *err)
{
    he_splitting *s = x->s;
    he_status status = make_room(x, 1, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t after = he_corner_after(s, c);
    const slot *at = &x->slots[slot_of(x, s->to[c], s->to[after])];
    if (at->epoch == x->edge + 1) {
        uint32_t other = at->corner, mate = s->mate[c];
        assert(mate != HE_NONE || s->mate[other] != HE_NONE);
        join(s, c, s->mate[other]);
        join(s, other, mate);
        x->any = true;
        status = number(x, c, other, err);
        if (status == HE_OK) {
            status = number(x, after, he_corner_after(s, other), err);
        }
        if (status == HE_OK) {
            status = make_room(x, 1, err);
        }
    }
    if (status == HE_OK) {
        he_bits_set(x->settled, c);
        put(x, c);
    }
    return status;
}

/* --- edges --- */

/* Lists the corners of each edge that has more than two corners. */
static he_status list_corners(exchanging *x, he_error *err)
{
    const he_soup *soup = x->s->soup;
    x->edge_of = he_mem_array(NULL, soup->corner_count, sizeof *x->edge_of);
    if (x->edge_of == NULL) {
        return no_memory(x, err);
    }
    he_status status = he_soup_number_edges(soup, x->edge_of, &x->edges, err);
    if (status != HE_OK) {
        return status;
    }
    x->begin = he_mem_zero(x->edges + 1, sizeof *x->begin);
    x->settled = he_bits_new(soup->corner_count);
    if (x->begin == NULL || x->settled == NULL) {
        return no_memory(x, err);
    }
    uint32_t all = 0;
    for (size_t c = 0; c < soup->corner_count; c++) {
        x->begin[x->edge_of[c]]++;
    }
    for (size_t e = 0; e <= x->edges; e++) {
        uint32_t count = e < x->edges ? x->begin[e] : 0;
        x->begin[e] = all;
        all += count > 2 ? count : 0;
    }
    x->list = he_mem_array(NULL, all, sizeof *x->list);
    uint32_t *next = he_mem_array(NULL, x->edges + 1, sizeof *next);
    if (x->list == NULL || next == NULL) {
        he_mem_free(next);
        return no_memory(x, err);
    }
    for (size_t e = 0; e < x->edges; e++) {
        next[e] = x->begin[e];
    }
    for (uint32_t c = 0; c < soup->corner_count; c++) {
        uint32_t e = x->edge_of[c];
        if (next[e] < x->begin[e + 1]) {
            x->list[next[e]++] = c;
        }
    }
    he_mem_free(next);
    return HE_OK;
}

static he_status settle_edge(exchanging *x, uint32_t edge, he_error *err)
{
    const uint32_t *corners = x->s->soup->corners, *list = x->list + x->begin[edge];
    uint32_t count = x->begin[edge + 1] - x->begin[edge], leave = 0;
    he_status status = HE_OK;
    for (uint32_t i = 0; i < count; i++) {
        leave += corners[list[i]] == corners[list[0]];
    }
    uint32_t i = 0;
    while (2 * leave < count && corners[list[i]] == corners[list[0]]) {
        i++;
    }
    x->edge = edge;
    x->origin = corners[list[i]];
    x->used = 0;
    for (i = 0; i < count && status == HE_OK; i++) {
        if (corners[list[i]] == x->origin) {
            status = settle(x, list[i], err);
        }
    }
    return status;
}

he_status he_splitting_exchange(he_splitting *s, bool *exchanged, he_error *err)
{
    exchanging x = {.s = s, .fans = (uint32_t)(s->soup->vertex_count + s->copies)};
    he_status status = list_corners(&x, err);
    for (uint32_t e = 0; e < x.edges && status == HE_OK; e++) {
        status = he_progress_at(s->soup->limits.progress, e, x.edges, err);
        if (status == HE_OK && x.begin[e] < x.begin[e + 1]) {
            status = settle_edge(&x, e, err);
        }
    }
    *exchanged = x.any;
    he_mem_free(x.edge_of);
    he_mem_free(x.begin);
    he_mem_free(x.list);
    he_mem_free(x.settled);
    he_mem_free(x.slots);
    return status;
}
