#include "geometry/corner_tree.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const he_corner_box EMPTY = {{DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX}};

/* --- sorting corners along the Z curve --- */

typedef struct keyed {
    uint64_t key;
    uint32_t corner;
} keyed;

/* Moves bit i of the lower half of `x` to bit 2i. A point's key on the Z curve is made of two
 * coordinates whose bits were moved in this way: the bits alternate. */
static uint64_t spread(uint64_t x)
{
    x = (x | x << 16) & 0x0000FFFF0000FFFFu;
    x = (x | x << 8) & 0x00FF00FF00FF00FFu;
    x = (x | x << 4) & 0x0F0F0F0F0F0F0F0Fu;
    x = (x | x << 2) & 0x3333333333333333u;
    return (x | x << 1) & 0x5555555555555555u;
}

/* Converts a coordinate to an integer of 32 bits, for a point's key on the Z curve. Coordinates are
 * within [-2, 2] (planar_loop.h); a coordinate that rounding has moved out of this range is clamped
 * to it. */
static uint64_t on_curve(double x)
{
    double scaled = (x + 2) * ((uint64_t)1 << 30);
    return scaled <= 0 ? 0 : scaled >= UINT32_MAX ? UINT32_MAX : (uint64_t)scaled;
}

/* Sorts `count` corners by their keys on the Z curve with a stable radix sort: corners of equal
 * keys stay in the order of the loop, so corners that are neighbours in the loop stay together.
 * Overwrites the arrays `from` and `to`, and returns the array that holds the result. */
static keyed *sort(keyed *from, keyed *to, uint32_t count)
{
    for (unsigned shift = 0; shift < 64; shift += 8) {
        uint32_t starts[257] = {0};
        for (uint32_t i = 0; i < count; i++) {
            starts[(from[i].key >> shift & 255) + 1]++;
        }
        if (starts[(from[0].key >> shift & 255) + 1] == count) {
            continue;
        }
        for (unsigned i = 0; i < 256; i++) {
            starts[i + 1] += starts[i];
        }
        for (uint32_t i = 0; i < count; i++) {
            to[starts[from[i].key >> shift & 255]++] = from[i];
        }
        keyed *swap = from;
        from = to;
        to = swap;
    }
    return from;
}

static uint64_t key_of(const he_planar_loop *f, uint32_t corner)
{
    return spread(on_curve(f->x[corner])) | spread(on_curve(f->y[corner])) << 1;
}

/* The number of corners that vector instructions compare with a box at once, if the corners are
 * kept in a plain list instead of a tree. */
enum { BATCH = 8 };

static uint32_t batched(uint32_t count)
{
    return (count + BATCH - 1) / BATCH * BATCH;
}

static void put(he_corner_tree *t, uint32_t place, uint32_t corner)
{
    t->order[place] = corner;
    t->place[corner] = place;
}

static void put_in_list(he_corner_tree *t, uint32_t place, uint32_t corner)
{
    put(t, place, corner);
    t->x[place] = t->flat->x[corner];
    t->y[place] = t->flat->y[corner];
}

static void fill_list(he_corner_tree *t, const uint32_t *corners)
{
    for (uint32_t i = 0; i < t->count; i++) {
        put_in_list(t, i, corners[i]);
    }
    for (uint32_t i = t->count; i < batched(t->count); i++) {
        t->x[i] = t->y[i] = HUGE_VAL;
    }
}

static bool fill_order(he_corner_tree *t, const uint32_t *corners)
{
    keyed *block = he_mem_array(NULL, 2 * (size_t)t->count, sizeof *block);
    if (block == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < t->count; i++) {
        block[i] = (keyed){key_of(t->flat, corners[i]), corners[i]};
    }
    const keyed *sorted = sort(block, block + t->count, t->count);
    for (uint32_t i = 0; i < t->count; i++) {
        put(t, i, sorted[i].corner);
    }
    he_mem_free(block);
    return true;
}

/* --- the boxes of the tree's nodes --- */

static void include(he_corner_box *box, const he_corner_box *other)
{
    for (int k = 0; k < 2; k++) {
        box->min[k] = other->min[k] < box->min[k] ? other->min[k] : box->min[k];
        box->max[k] = other->max[k] > box->max[k] ? other->max[k] : box->max[k];
    }
}

static uint32_t leaf_start(const he_corner_tree *t, uint32_t leaf)
{
    return (uint32_t)((uint64_t)t->count * leaf / t->leaves);
}

static he_corner_box box_of_leaf(const he_corner_tree *t, uint32_t leaf)
{
    he_corner_box box = EMPTY;
    for (uint32_t i = leaf_start(t, leaf); i < leaf_start(t, leaf + 1); i++) {
        uint32_t c = t->order[i];
        if (c != HE_NONE) {
            double x = t->flat->x[c], y = t->flat->y[c];
            include(&box, &(he_corner_box){{x, y}, {x, y}});
        }
    }
    return box;
}

static he_corner_box box_of_children(const he_corner_tree *t, uint32_t node)
{
    he_corner_box box = t->boxes[2 * (size_t)node];
    include(&box, &t->boxes[2 * (size_t)node + 1]);
    return box;
}

static bool same_box(const he_corner_box *a, const he_corner_box *b)
{
    return a->min[0] == b->min[0] && a->min[1] == b->min[1] && a->max[0] == b->max[0] &&
           a->max[1] == b->max[1];
}

void he_corner_tree_clear(he_corner_tree *tree)
{
    he_mem_free(tree->memory);
    *tree = (he_corner_tree){.memory = NULL};
}

he_status he_corner_tree_make(he_corner_tree *out, const he_planar_loop *flat,
                              const uint32_t *corners, uint32_t count, he_error *err)
{
    he_corner_tree t = {.flat = flat, .count = count, .made = count};
    if (count == 0) {
        *out = t;
        return HE_OK;
    }
    if (count > HE_CORNER_FEW) {
        t.leaves = 1;
        while ((uint64_t)t.leaves * HE_CORNER_LEAF < count) {
            t.leaves *= 2;
        }
    }
    size_t boxes = 2 * (size_t)t.leaves, listed = t.leaves == 0 ? batched(count) : 0;
    size_t words = (size_t)flat->n + count;
    t.memory = he_mem_array(NULL, boxes + listed / 2 + words / 8 + 1, sizeof *t.boxes);
    if (t.memory != NULL) {
        t.boxes = t.memory;
        t.x = (double *)(t.boxes + boxes);
        t.y = t.x + listed;
        t.place = (uint32_t *)(t.y + listed);
        t.order = t.place + flat->n;
        memset(t.place, 0xFF, flat->n * sizeof *t.place);
    }
    if (t.memory == NULL || (t.leaves > 0 && !fill_order(&t, corners))) {
        he_corner_tree_clear(&t);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %u corners of a loop", count);
    }
    if (t.leaves == 0) {
        fill_list(&t, corners);
    }
    for (uint32_t leaf = 0; leaf < t.leaves; leaf++) {
        t.boxes[t.leaves + leaf] = box_of_leaf(&t, leaf);
    }
    for (uint32_t node = t.leaves; node-- > 1;) {
        t.boxes[node] = box_of_children(&t, node);
    }
    *out = t;
    return HE_OK;
}

/* Returns the number of the leaf that holds entry `place` of the array `order`. This is the inverse
 * of leaf_start, which returns the first entry of a leaf. */
static uint32_t leaf_of(const he_corner_tree *t, uint32_t place)
{
    return (uint32_t)((((uint64_t)place + 1) * t->leaves - 1) / t->count);
}

void he_corner_tree_remove(he_corner_tree *t, uint32_t corner)
{
    if (t->leaves == 0) {
        uint32_t last = --t->count;
        put_in_list(t, t->place[corner], t->order[last]);
        t->x[last] = t->y[last] = HUGE_VAL;
        t->place[corner] = HE_NONE;
        return;
    }
    uint32_t leaf = leaf_of(t, t->place[corner]), node = t->leaves + leaf;
    t->order[t->place[corner]] = HE_NONE;
    t->place[corner] = HE_NONE;
    he_corner_box box = box_of_leaf(t, leaf);
    while (!same_box(&box, &t->boxes[node])) {
        t->boxes[node] = box;
        if (node == 1) {
            break;
        }
        node /= 2;
        box = box_of_children(t, node);
    }
}

/* --- searching --- */

/* The tolerance of the searches in this file. It is relative to the size of the triangle for
 * distances, and to the square of that size for areas. The tolerance is four times
 * HE_PLANAR_LOOP_THIN, so that it covers rounding errors and all points that
 * he_planar_loop_turns_left regards as lying on a side of the triangle. */
static const double ABOUT = 4e-12;

/* A side of a triangle: it begins at the point `at` and ends at the point `at` + `along`. */
typedef struct side {
    double at[2], along[2];
    /* Which corner of any axis-aligned box lies furthest to the left of the side: high[i] is true
     * if on axis i that corner has the maximum of the box, false if it has the minimum. */
    bool high[2];
} side;

typedef struct triangle {
    uint32_t corner[3];
    side sides[3];
    he_corner_box box;
    /* If left_of a side and a point is less than -slack, the point is not in the triangle. */
    double slack;
} triangle;

static double least(double a, double b)
{
    return a < b ? a : b;
}

static double most(double a, double b)
{
    return a > b ? a : b;
}

/* Returns the axis-aligned box around the triangle of the corners a, b and c, enlarged by a margin
 * for rounding errors. */
static inline he_corner_box box_around(const he_planar_loop *f, uint32_t a, uint32_t b, uint32_t c)
{
    double left = least(least(f->x[a], f->x[b]), f->x[c]);
    double right = most(most(f->x[a], f->x[b]), f->x[c]);
    double low = least(least(f->y[a], f->y[b]), f->y[c]);
    double high = most(most(f->y[a], f->y[b]), f->y[c]);
    double about = ABOUT * ((right - left) + (high - low));
    return (he_corner_box){{left - about, low - about}, {right + about, high + about}};
}

static inline triangle triangle_of(const he_planar_loop *f, uint32_t a, uint32_t b, uint32_t c,
                                   const he_corner_box *box)
{
    triangle t = {.corner = {a, b, c}, .box = *box};
    for (int i = 0; i < 3; i++) {
        double x = f->x[t.corner[i]], y = f->y[t.corner[i]];
        uint32_t to = t.corner[(i + 1) % 3];
        double dx = f->x[to] - x, dy = f->y[to] - y;
        t.sides[i] = (side){{x, y}, {dx, dy}, {dy<0, dx> 0}};
    }
    double size = (box->max[0] - box->min[0]) + (box->max[1] - box->min[1]);
    t.slack = ABOUT * size * size;
    return t;
}

static double clamped(double x, double min, double max)
{
    return x < min ? min : x > max ? max : x;
}

/* Returns twice the area of the triangle between a side and the point (x, y); the area is negative
 * if the point is to the right of the side. */
static double left_of(const side *s, double x, double y)
{
    return s->along[0] * (y - s->at[1]) - s->along[1] * (x - s->at[0]);
}

/* Returns false only if the triangle and the box certainly have no point in common. The test is
 * quick, and may return true for a triangle and a box that are disjoint. */
static inline bool touches(const triangle *t, const he_corner_box *box)
{
    if (box->min[0] > t->box.max[0] || box->max[0] < t->box.min[0] || box->min[1] > t->box.max[1] ||
        box->max[1] < t->box.min[1]) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        const side *s = &t->sides[i];
        double x = s->high[0] ? box->max[0] : box->min[0];
        double y = s->high[1] ? box->max[1] : box->min[1];
        if (left_of(s, clamped(x, t->box.min[0], t->box.max[0]),
                    clamped(y, t->box.min[1], t->box.max[1])) < -t->slack) {
            return false;
        }
    }
    return true;
}

/* Two doubles that one vector instruction processes together. */
typedef double pair __attribute__((vector_size(2 * sizeof(double))));
typedef int64_t pair_mask __attribute__((vector_size(2 * sizeof(int64_t))));

static inline pair pair_at(const double *from)
{
    pair p;
    memcpy(&p, from, sizeof p);
    return p;
}

/* Returns true if at least one of BATCH points is in the box; x and y are the coordinates of the
 * points. */
static inline bool is_any_in_box(const he_corner_box *box, const double *x, const double *y)
{
    const double left = box->min[0], right = box->max[0], low = box->min[1], high = box->max[1];
    pair_mask any = {0, 0};
    for (unsigned i = 0; i < BATCH; i += 2) {
        pair px = pair_at(x + i), py = pair_at(y + i);
        any |= (px >= left) & (px <= right) & (py >= low) & (py <= high);
    }
    return (any[0] | any[1]) != 0;
}

/* Returns true if corner p is inside the triangle, as he_corner_tree_find defines it. */
static inline bool holds(const triangle *t, const he_planar_loop *f, uint32_t p)
{
    double x = f->x[p], y = f->y[p];
    if (x < t->box.min[0] || x > t->box.max[0] || y < t->box.min[1] || y > t->box.max[1]) {
        return false;
    }
    double left[3];
    for (int i = 0; i < 3; i++) {
        left[i] = left_of(&t->sides[i], x, y);
        if (left[i] < -t->slack) {
            return false;
        }
    }
    for (int i = 0; i < 3; i++) {
        if (p == t->corner[i] || (x == t->sides[i].at[0] && y == t->sides[i].at[1]) ||
            (left[i] < t->slack &&
             he_planar_loop_turns_left(f, t->corner[(i + 1) % 3], t->corner[i], p))) {
            return false;
        }
    }
    return true;
}

static inline uint32_t find_in_leaf(const he_corner_tree *tree, uint32_t leaf, const triangle *t,
                                    uint64_t *steps)
{
    for (uint32_t i = leaf_start(tree, leaf); i < leaf_start(tree, leaf + 1); i++) {
        uint32_t c = tree->order[i];
        *steps += 1;
        if (c != HE_NONE && holds(t, tree->flat, c)) {
            return c;
        }
    }
    return HE_NONE;
}

/* Returns true if corner a comes before corner b along the Z curve. */
static bool is_before(const he_planar_loop *f, uint32_t a, uint32_t b)
{
    uint64_t of_a = key_of(f, a), of_b = key_of(f, b);
    return of_a != of_b ? of_a < of_b : a < b;
}

/* Returns p if corner p is inside the triangle and either `found` is HE_NONE or corner p comes
 * before corner `found` along the Z curve; otherwise returns `found`. */
static inline uint32_t better(const he_corner_tree *tree, const triangle *t, uint32_t p,
                              uint32_t found)
{
    const he_planar_loop *f = tree->flat;
    if (p == t->corner[0] || p == t->corner[2] || !holds(t, f, p)) {
        return found;
    }
    return found == HE_NONE || is_before(f, p, found) ? p : found;
}

/* Searches a plain list for corners inside the triangle a, b, c. Returns the corner found that
 * comes first along the Z curve, as a search of a tree would; HE_NONE if no corner is inside. If
 * the list had at most HE_CORNER_UNSORTED corners when it was made, returns the corner found that
 * comes first in the list instead. */
static uint32_t find_in_list(const he_corner_tree *tree, uint32_t a, uint32_t b, uint32_t c,
                             uint64_t *steps)
{
    const he_corner_box box = box_around(tree->flat, a, b, c);
    triangle t;
    uint32_t found = HE_NONE;
    bool has_sides = false;
    *steps += 1 + tree->count / HE_CORNER_LEAF;
    for (uint32_t i = 0; i < tree->count; i += BATCH) {
        if (!is_any_in_box(&box, tree->x + i, tree->y + i)) {
            continue;
        }
        /* The sides of the triangle are computed only when a corner in the box around the triangle
         * has been found. */
        if (!has_sides) {
            t = triangle_of(tree->flat, a, b, c, &box);
            has_sides = true;
        }
        for (uint32_t k = i; k < i + BATCH && k < tree->count; k++) {
            found = better(tree, &t, tree->order[k], found);
            if (found != HE_NONE && tree->made <= HE_CORNER_UNSORTED) {
                return found;
            }
        }
    }
    return found;
}

static uint32_t find_in_tree(const he_corner_tree *tree, const triangle *t, uint64_t *steps)
{
    /* The stack holds nodes that are still to be visited: at most one node of each level of the
     * tree, and two nodes of the deepest level. */
    uint32_t stack[34], depth = 0;
    stack[depth++] = 1;
    while (depth > 0) {
        uint32_t node = stack[--depth];
        *steps += 1;
        if (!touches(t, &tree->boxes[node])) {
            continue;
        }
        if (node < tree->leaves) {
            stack[depth++] = 2 * node + 1;
            stack[depth++] = 2 * node;
            continue;
        }
        uint32_t found = find_in_leaf(tree, node - tree->leaves, t, steps);
        if (found != HE_NONE) {
            return found;
        }
    }
    return HE_NONE;
}

uint32_t he_corner_tree_find(const he_corner_tree *tree, uint32_t a, uint32_t b, uint32_t c,
                             uint64_t *steps)
{
    if (tree->count == 0) {
        return HE_NONE;
    }
    if (tree->leaves == 0) {
        return find_in_list(tree, a, b, c, steps);
    }
    const he_corner_box box = box_around(tree->flat, a, b, c);
    const triangle t = triangle_of(tree->flat, a, b, c, &box);
    return find_in_tree(tree, &t, steps);
}
