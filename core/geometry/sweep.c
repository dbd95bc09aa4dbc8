#include "geometry/sweep.h"

#include "geometry/orient.h"

#include <string.h>

/* An entry of an interval's chain. A corner that is in two chains has an entry in each of them. */
typedef struct link {
    /* `corner` is a corner of the loop; `up` and `down` are the indices of the next entries above
     * and below in the chain, HE_NONE at its ends. */
    uint32_t corner, up, down;
} link;

typedef struct interval {
    /* the sides of the loop that bound the interval; the number of a side is that of the corner at
     * which the side begins */
    uint32_t lower, upper;
    /* indices of entries of the chain: its two ends, and (`last`) the entry with the corner that
     * was visited last */
    uint32_t bottom, top, last;
    /* neighbours in the splay tree of intervals: the subtree child[0] has intervals below this one,
     * the subtree child[1] has intervals above it */
    uint32_t parent, child[2];
} interval;

typedef struct sweep {
    const he_planar_loop *f;
    uint32_t *rank; /* for each corner, how many corners are visited before it */
    /* The interval that each side of the loop bounds; HE_NONE until the sweep line reaches the
     * side. */
    uint32_t *within;
    interval *intervals;
    link *links;
    uint32_t interval_count, link_count, root;
    /* `made`: number of triangles cut so far; `corners`: the corners of these triangles */
    uint32_t *corners, made;
    uint64_t *steps;
} sweep;

static uint32_t before(const sweep *s, uint32_t i)
{
    return i == 0 ? s->f->n - 1 : i - 1;
}

static uint32_t after(const sweep *s, uint32_t i)
{
    return i + 1 == s->f->n ? 0 : i + 1;
}

static int orientation(const sweep *s, uint32_t a, uint32_t b, uint32_t c)
{
    const double *x = s->f->x, *y = s->f->y;
    return he_orient2((he_vec2){x[a], y[a]}, (he_vec2){x[b], y[b]}, (he_vec2){x[c], y[c]});
}

/* --- the order in which the sweep line visits corners --- */

static bool is_earlier(const he_planar_loop *f, uint32_t a, uint32_t b)
{
    return f->x[a] != f->x[b] ? f->x[a] < f->x[b] : f->y[a] != f->y[b] ? f->y[a] < f->y[b] : a < b;
}

/* Sorts the corners into the order in which the sweep line visits them, by merge sort with runs of
 * 1, 2, 4 and so on corners. Overwrites the arrays `from` and `to`, and returns the array that
 * holds the result. */
static uint32_t *sort(const he_planar_loop *f, uint32_t *from, uint32_t *to)
{
    for (size_t run = 1; run < f->n; run *= 2) {
        for (size_t at = 0; at < f->n; at += 2 * run) {
            size_t middle = at + run < f->n ? at + run : f->n;
            size_t end = middle + run < f->n ? middle + run : f->n;
            size_t i = at, k = middle;
            for (size_t out = at; out < end; out++) {
                bool first = k == end || (i < middle && is_earlier(f, from[i], from[k]));
                to[out] = first ? from[i++] : from[k++];
            }
        }
        uint32_t *swap = from;
        from = to;
        to = swap;
    }
    return from;
}

/* --- the tree of intervals --- */

static void hang(sweep *s, uint32_t parent, int side, uint32_t child)
{
    if (parent == HE_NONE) {
        s->root = child;
    } else {
        s->intervals[parent].child[side] = child;
    }
    if (child != HE_NONE) {
        s->intervals[child].parent = parent;
    }
}

static int side_of(const sweep *s, uint32_t child)
{
    return s->intervals[s->intervals[child].parent].child[1] == child;
}

/* Rotates node i of the splay tree above its parent. */
static void rotate(sweep *s, uint32_t i)
{
    interval *of = s->intervals;
    uint32_t parent = of[i].parent, grand = of[parent].parent;
    int side = side_of(s, i), outer = grand == HE_NONE ? 0 : side_of(s, parent);
    hang(s, parent, side, of[i].child[!side]);
    hang(s, i, !side, parent);
    hang(s, grand, outer, i);
    *s->steps += 1;
}

static void splay(sweep *s, uint32_t i)
{
    const interval *of = s->intervals;
    while (of[i].parent != HE_NONE) {
        uint32_t parent = of[i].parent;
        if (of[parent].parent != HE_NONE) {
            rotate(s, side_of(s, i) == side_of(s, parent) ? parent : i);
        }
        rotate(s, i);
    }
}

/* Returns the highest interval whose lower side is below a corner; HE_NONE if there is none. */
static uint32_t find_below(sweep *s, uint32_t corner)
{
    uint32_t found = HE_NONE, deepest = HE_NONE;
    for (uint32_t i = s->root; i != HE_NONE;) {
        uint32_t lower = s->intervals[i].lower;
        bool above = orientation(s, lower, after(s, lower), corner) > 0;
        found = above ? i : found;
        deepest = i;
        i = s->intervals[i].child[above];
    }
    /* Splaying the deepest node that the search has visited makes a search take logarithmic
     * amortized time. */
    if (deepest != HE_NONE) {
        splay(s, deepest);
    }
    return found;
}

/* Adds an interval to the tree, directly above the interval `below`, or below all intervals if
 * `below` is HE_NONE. Returns the index of the new interval. */
static uint32_t add_interval(sweep *s, uint32_t below)
{
    interval *of = s->intervals;
    uint32_t made = s->interval_count++;
    of[made] = (interval){.parent = HE_NONE, .child = {HE_NONE, HE_NONE}};
    if (below == HE_NONE) {
        hang(s, made, 1, s->root);
    } else {
        splay(s, below);
        hang(s, made, 1, of[below].child[1]);
        of[below].child[1] = HE_NONE;
        hang(s, made, 0, below);
    }
    hang(s, HE_NONE, 0, made);
    return made;
}

static void remove_interval(sweep *s, uint32_t gone)
{
    const interval *of = s->intervals;
    splay(s, gone);
    uint32_t below = of[gone].child[0], above = of[gone].child[1];
    hang(s, HE_NONE, 0, below);
    if (below == HE_NONE) {
        hang(s, HE_NONE, 0, above);
        return;
    }
    while (of[below].child[1] != HE_NONE) {
        below = of[below].child[1];
    }
    splay(s, below);
    hang(s, below, 1, above);
}

/* --- chains --- */

static uint32_t new_link(sweep *s, uint32_t corner)
{
    s->links[s->link_count] = (link){corner, HE_NONE, HE_NONE};
    return s->link_count++;
}

static void join_links(sweep *s, uint32_t lower, uint32_t upper)
{
    s->links[lower].up = upper;
    s->links[upper].down = lower;
}

/* Adds the triangle between `corner`, which the sweep line visits, and the corners of the chain
 * entries `upper` and `lower`. Returns false, and adds nothing, if the triangle does not turn left,
 * or if n - 2 triangles were added already. */
static bool cut(sweep *s, uint32_t corner, uint32_t upper, uint32_t lower)
{
    uint32_t a = s->links[upper].corner, b = s->links[lower].corner;
    *s->steps += 1;
    if (s->made == s->f->n - 2 || orientation(s, corner, a, b) <= 0) {
        return false;
    }
    uint32_t *triangle = s->corners + 3 * (size_t)s->made++;
    triangle[0] = corner;
    triangle[1] = a;
    triangle[2] = b;
    return true;
}

/* Makes a corner the new top of an interval's chain. First cuts off the triangles between this
 * corner and the corners at the top of the chain that it sees. */
static void add_top(sweep *s, interval *of, uint32_t corner)
{
    uint32_t top = of->top;
    while (s->links[top].down != HE_NONE && cut(s, corner, top, s->links[top].down)) {
        top = s->links[top].down;
    }
    of->top = of->last = new_link(s, corner);
    join_links(s, top, of->top);
}

static void add_bottom(sweep *s, interval *of, uint32_t corner)
{
    uint32_t bottom = of->bottom;
    while (s->links[bottom].up != HE_NONE && cut(s, corner, s->links[bottom].up, bottom)) {
        bottom = s->links[bottom].up;
    }
    of->bottom = of->last = new_link(s, corner);
    join_links(s, of->bottom, bottom);
}

/* --- what is done when the sweep line reaches a corner; a function returns false if the loop
 * cannot be a simple polygon --- */

static void bound(sweep *s, uint32_t which, uint32_t lower, uint32_t upper)
{
    s->intervals[which].lower = lower;
    s->intervals[which].upper = upper;
    s->within[lower] = s->within[upper] = which;
}

/* Handles a corner whose two sides lie ahead of the sweep line, with the inside of the loop between
 * the sides: a new interval begins. */
static bool start(sweep *s, uint32_t corner)
{
    uint32_t made = add_interval(s, find_below(s, corner));
    interval *of = &s->intervals[made];
    bound(s, made, corner, before(s, corner));
    of->bottom = of->top = of->last = new_link(s, corner);
    return true;
}

/* Handles a corner whose two sides lie ahead of the sweep line, with the outside of the loop
 * between the sides: the interval in which the corner lies is split in two. */
static bool split(sweep *s, uint32_t corner)
{
    uint32_t below = find_below(s, corner);
    if (below == HE_NONE) {
        return false;
    }
    uint32_t above = add_interval(s, below);
    interval *low = &s->intervals[below], *high = &s->intervals[above];
    link *last = &s->links[low->last];
    bound(s, above, corner, low->upper);
    bound(s, below, low->lower, before(s, corner));
    /* The chain is split at the corner that was visited last. This corner ends the lower chain and
     * begins the upper chain, so it gets a second entry. */
    high->bottom = new_link(s, last->corner);
    high->top = high->bottom;
    if (last->up != HE_NONE) {
        high->top = low->top;
        join_links(s, high->bottom, last->up);
        last->up = HE_NONE;
    }
    low->top = low->last;
    add_top(s, low, corner);
    add_bottom(s, high, corner);
    return true;
}

/* Handles a corner whose two sides lie behind the sweep line, with the outside of the loop between
 * the sides: the intervals below and above the corner become one. */
static bool merge(sweep *s, uint32_t corner)
{
    uint32_t below = s->within[corner], above = s->within[before(s, corner)];
    if (below == above) {
        return false;
    }
    interval *low = &s->intervals[below], *high = &s->intervals[above];
    add_top(s, low, corner);
    add_bottom(s, high, corner);
    /* The corner is now the top of the lower chain and the bottom of the upper chain. The chains
     * are joined, and the corner's entry in the upper chain is dropped. */
    join_links(s, low->top, s->links[high->bottom].up);
    low->last = low->top;
    low->top = high->top;
    bound(s, below, low->lower, high->upper);
    remove_interval(s, above);
    return true;
}

/* Handles a corner whose two sides lie behind the sweep line, with the inside of the loop between
 * the sides: the interval between the sides ends. */
static bool end(sweep *s, uint32_t corner)
{
    uint32_t which = s->within[corner];
    if (which != s->within[before(s, corner)]) {
        return false;
    }
    interval *of = &s->intervals[which];
    add_top(s, of, corner);
    remove_interval(s, which);
    return s->links[of->top].down == of->bottom;
}

static bool meet(sweep *s, uint32_t corner)
{
    uint32_t b = before(s, corner), a = after(s, corner);
    bool onward = s->rank[a] > s->rank[corner], back = s->rank[b] > s->rank[corner];
    /* Each side that ends at this corner must bound an interval. */
    if ((!onward && s->within[corner] == HE_NONE) || (!back && s->within[b] == HE_NONE)) {
        return false;
    }
    if (onward != back) {
        interval *of = &s->intervals[s->within[onward ? b : corner]];
        s->within[onward ? corner : b] = s->within[onward ? b : corner];
        if (onward) {
            of->lower = corner;
            add_bottom(s, of, corner);
        } else {
            of->upper = b;
            add_top(s, of, corner);
        }
        return true;
    }
    int turn = orientation(s, b, corner, a);
    if (turn == 0) {
        return false;
    }
    return turn > 0 ? (onward ? start(s, corner) : end(s, corner))
                    : (onward ? split(s, corner) : merge(s, corner));
}

/* --- sorting the triangles so that each triangle cuts a corner off the rest of the loop --- */

/* Returns the corner whose number is neither the lowest nor the highest of the three. */
static uint32_t middle_of(const uint32_t t[3])
{
    uint32_t low = t[0] < t[1] ? t[0] : t[1], high = t[0] < t[1] ? t[1] : t[0];
    return t[2] < low ? low : t[2] > high ? high : t[2];
}

static uint32_t span_of(const uint32_t t[3])
{
    uint32_t low = t[0], high = t[0];
    for (int i = 1; i < 3; i++) {
        low = t[i] < low ? t[i] : low;
        high = t[i] > high ? t[i] : high;
    }
    return high - low;
}

/* Sorts the triangles so that each triangle cuts one corner off what the triangles before it have
 * left of the loop. The span of a triangle is the difference between its highest and its lowest
 * corner number. The triangles that cut off the corners between these two numbers have smaller
 * spans, so triangles are sorted by their spans, the smallest first. Returns false if the triangles
 * are no triangulation of the loop. `room` is scratch space for n + 2 numbers. */
static bool put_in_order(const he_planar_loop *f, const uint32_t *from, uint32_t *to,
                         uint32_t *room)
{
    uint32_t n = f->n, *next = room;
    memset(room, 0, ((size_t)n + 2) * sizeof *room);
    for (uint32_t k = 0; k + 2 < n; k++) {
        room[span_of(from + 3 * (size_t)k) + 1]++;
    }
    for (uint32_t i = 1; i < n; i++) {
        room[i] += room[i - 1];
    }
    for (uint32_t k = 0; k + 2 < n; k++) {
        const uint32_t *t = from + 3 * (size_t)k;
        uint32_t middle = middle_of(t), first = t[0] == middle ? 2 : t[1] == middle ? 0 : 1;
        uint32_t *out = to + 3 * (size_t)room[span_of(t)]++;
        for (uint32_t i = 0; i < 3; i++) {
            out[i] = t[(first + i) % 3];
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        next[i] = i + 1;
    }
    for (uint32_t k = 0; k + 2 < n; k++) {
        const uint32_t *t = to + 3 * (size_t)k;
        if (t[0] >= t[1] || next[t[0]] != t[1] || next[t[1]] != t[2]) {
            return false;
        }
        next[t[0]] = t[2];
    }
    return true;
}

/* --- the whole triangulation --- */

static bool sweep_over(sweep *s, const uint32_t *order)
{
    for (uint32_t i = 0; i < s->f->n; i++) {
        s->rank[order[i]] = i;
        s->within[i] = HE_NONE;
    }
    for (uint32_t i = 0; i < s->f->n; i++) {
        if (!meet(s, order[i])) {
            return false;
        }
    }
    return s->made == s->f->n - 2;
}

he_status he_sweep_cut(const he_planar_loop *f, uint32_t *corners, bool *done, uint64_t *steps,
                       he_error *err)
{
    size_t n = f->n;
    he_status status = HE_NO_MEMORY;
    sweep s = {.f = f, .root = HE_NONE, .steps = steps};
    uint32_t *words = he_mem_array(NULL, n + 1, 7 * sizeof *words);
    /* At each corner the sweep line makes at most one interval and at most three chain entries. */
    s.intervals = he_mem_array(NULL, n, sizeof *s.intervals);
    s.links = he_mem_array(NULL, n, 3 * sizeof *s.links);
    if (words == NULL || s.intervals == NULL || s.links == NULL) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop of %zu corners", n);
        goto out;
    }
    s.rank = words + 2 * n;
    s.within = words + 3 * n;
    s.corners = words + 4 * n;
    for (uint32_t i = 0; i < n; i++) {
        words[i] = i;
    }
    *done = sweep_over(&s, sort(f, words, words + n)) && put_in_order(f, s.corners, corners, words);
    *steps += n;
    status = HE_OK;
out:
    he_mem_free(words);
    he_mem_free(s.intervals);
    he_mem_free(s.links);
    return status;
}
