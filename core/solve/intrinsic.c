#include "solve/intrinsic.h"

#include <math.h>
#include <string.h>

/* A pair of angles opposite to an edge counts as larger than 180 degrees if the sum of their
 * cotangents is below this. */
static const double NOT_DELAUNAY = -1e-10;
/* How much two sides of a triangle must at least be longer than the third, in mean lengths. */
static const double LEAST_EXCESS = 1e-9;

enum { FLIPS_FOR_EACH_SIDE = 64 };

void he_intrinsic_clear(he_intrinsic *t)
{
    he_mem_free(t->corners);
    he_mem_free(t->twins);
    he_mem_free(t->lengths);
    he_mem_free(t->cotangents);
    *t = (he_intrinsic){0};
}

static uint32_t next_of(uint32_t side)
{
    return side % 3 == 2 ? side - 2 : side + 1;
}

static uint32_t prev_of(uint32_t side)
{
    return side % 3 == 0 ? side + 2 : side - 1;
}

/* --- neighbours --- */

/* The ends of a side's edge: LOW has the smaller number. */
enum { LOW, HIGH };

static uint32_t end_of(const he_intrinsic *t, uint32_t side, int which)
{
    const uint32_t a = t->corners[side], b = t->corners[next_of(side)];
    return (a < b) == (which == LOW) ? a : b;
}

/* Where the sides of each vertex begin in a list that is sorted by vertices. */
typedef struct places {
    uint32_t vertices;
    uint32_t *begins; /* vertices + 1 entries */
} places;

/* Sorts sides by one end of their edges; sides with the same end stay in their order. If `from` is
 * NULL, they are in the order of their numbers. */
static void sort_sides(const he_intrinsic *t, int by, places p, const uint32_t *from, uint32_t *to)
{
    const uint32_t sides = 3 * t->triangles;
    uint32_t *begins = p.begins;
    memset(begins, 0, ((size_t)p.vertices + 1) * sizeof *begins);
    for (uint32_t s = 0; s < sides; s++) {
        begins[end_of(t, s, by) + 1]++;
    }
    for (uint32_t v = 0; v < p.vertices; v++) {
        begins[v + 1] += begins[v];
    }
    for (uint32_t i = 0; i < sides; i++) {
        const uint32_t s = from == NULL ? i : from[i];
        to[begins[end_of(t, s, by)]++] = s;
    }
}

/* Pairs the sides of one edge: the first that runs from its lower to its higher vertex with the
 * first that runs the other way, the second with the second, and so on. */
static void pair_edge(he_intrinsic *t, const uint32_t *sides, uint32_t count)
{
    const uint32_t low = end_of(t, sides[0], LOW);
    for (uint32_t up = 0, down = 0;; up++, down++) {
        while (up < count && t->corners[sides[up]] != low) {
            up++;
        }
        while (down < count && t->corners[sides[down]] == low) {
            down++;
        }
        if (up >= count || down >= count) {
            return;
        }
        t->twins[sides[up]] = sides[down];
        t->twins[sides[down]] = sides[up];
    }
}

/* Pairs the sides of each edge. They follow each other in `lists`. */
static void pair_sides(he_intrinsic *t, const uint32_t *lists)
{
    const uint32_t sides = 3 * t->triangles;
    memset(t->twins, 0xFF, (size_t)sides * sizeof *t->twins);
    for (uint32_t from = 0, to; from < sides; from = to) {
        const uint32_t low = end_of(t, lists[from], LOW), high = end_of(t, lists[from], HIGH);
        for (to = from + 1;
             to < sides && end_of(t, lists[to], LOW) == low && end_of(t, lists[to], HIGH) == high;
             to++) {
        }
        pair_edge(t, lists + from, to - from);
    }
}

static he_status find_twins(he_intrinsic *t, uint32_t vertices, he_error *err)
{
    const places p = {vertices, he_mem_array(NULL, (size_t)vertices + 1, sizeof *p.begins)};
    uint32_t *lists = he_mem_array(NULL, 3 * (size_t)t->triangles + 1, sizeof *lists);
    he_status status = HE_OK;
    if (p.begins == NULL || lists == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the sides of %u triangles",
                               t->triangles);
    } else {
        /* The array of the twins holds the first order until it is filled. */
        sort_sides(t, HIGH, p, NULL, t->twins);
        sort_sides(t, LOW, p, t->twins, lists);
        pair_sides(t, lists);
    }
    he_mem_free(p.begins);
    he_mem_free(lists);
    return status;
}

/* --- lengths --- */

static double distance(he_vec3 p, he_vec3 q)
{
    static const double LEAST = 0x1p-500, MOST = 0x1p500; /* their squares are normal numbers */
    const double x = q.x - p.x, y = q.y - p.y, z = q.z - p.z;
    const double length = sqrt(x * x + y * y + z * z);
    return length > LEAST && length < MOST ? length : hypot(hypot(x, y), z);
}

static he_status measure(he_intrinsic *t, const he_surface *surface, he_error *err)
{
    const uint32_t sides = 3 * t->triangles;
    double sum = 0;
    for (uint32_t s = 0; s < sides; s++) {
        const uint32_t a = t->corners[s], b = t->corners[next_of(s)];
        t->lengths[s] = t->twins[s] < s ? t->lengths[t->twins[s]]
                                        : distance(surface->points[a], surface->points[b]);
        if (!isfinite(t->lengths[s])) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, a,
                           "the distance of the vertices %u and %u is too large for a number", a,
                           b);
        }
        sum += t->lengths[s] / sides;
    }
    t->unit = sum > 0 ? sum : 1;
    for (uint32_t s = 0; s < sides; s++) {
        t->lengths[s] /= t->unit;
    }
    return HE_OK;
}

/* Raises all lengths by the number that makes every two sides of a triangle longer than the third
 * one. */
static void lengthen(he_intrinsic *t)
{
    const uint32_t sides = 3 * t->triangles;
    double missing = 0;
    for (uint32_t s = 0; s < sides; s++) {
        const double *l = t->lengths;
        const double excess = l[next_of(s)] + l[prev_of(s)] - l[s];
        missing = fmax(missing, LEAST_EXCESS - excess);
    }
    for (uint32_t s = 0; s < sides && missing > 0; s++) {
        t->lengths[s] += missing;
    }
}

/* --- angles --- */

/* Exchanges two numbers if the second is larger. */
static void order_pair(double *a, double *b)
{
    if (*a < *b) {
        const double larger = *b;
        *b = *a;
        *a = larger;
    }
}

/* Returns 4 times the area of a triangle with these sides, by Kahan's formula, which is exact to a
 * few bits however thin the triangle is. */
static double four_areas(double a, double b, double c)
{
    order_pair(&a, &b);
    order_pair(&b, &c);
    order_pair(&a, &b);
    const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    return product > 0 ? sqrt(product) : 0;
}

double he_intrinsic_area(const he_intrinsic *t, uint32_t triangle)
{
    const double *l = t->lengths + 3 * (size_t)triangle;
    return four_areas(l[0], l[1], l[2]) / 4;
}

/* Computes the cotangents of the angles of a triangle. */
static void find_cotangents(he_intrinsic *t, uint32_t triangle)
{
    const double *l = t->lengths + 3 * (size_t)triangle;
    double *out = t->cotangents + 3 * (size_t)triangle;
    const double area = four_areas(l[0], l[1], l[2]);
    /* (b^2 + c^2 - a^2) / (4 A), without the loss of digits in a difference of squares */
    out[0] = ((l[1] - l[0]) * (l[1] + l[0]) + l[2] * l[2]) / area;
    out[1] = ((l[2] - l[1]) * (l[2] + l[1]) + l[0] * l[0]) / area;
    out[2] = ((l[0] - l[2]) * (l[0] + l[2]) + l[1] * l[1]) / area;
}

/* --- the triangulation --- */

he_status he_intrinsic_make(const he_surface *surface, he_intrinsic *out, he_error *err)
{
    const size_t sides = 3 * (size_t)surface->triangles;
    if (sides > 1 << 30) {
        return he_fail_plain(err, HE_LIMIT, "a surface of %u triangles is too large",
                             surface->triangles);
    }
    for (size_t s = 0; s < sides; s++) {
        if (surface->corners[s] >= surface->vertices) {
            return he_fail_plain(err, HE_BAD_INDEX, "corner %zu is not one of the %u vertices", s,
                                 surface->vertices);
        }
    }
    he_intrinsic t = {.triangles = surface->triangles,
                      .corners = he_mem_array(NULL, sides + 1, sizeof *t.corners),
                      .twins = he_mem_array(NULL, sides + 1, sizeof *t.twins),
                      .lengths = he_mem_array(NULL, sides + 1, sizeof *t.lengths),
                      .cotangents = he_mem_array(NULL, sides + 1, sizeof *t.cotangents)};
    he_status status = HE_OK;
    if (t.corners == NULL || t.twins == NULL || t.lengths == NULL || t.cotangents == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for a surface of %u triangles",
                               surface->triangles);
    } else {
        memcpy(t.corners, surface->corners, sides * sizeof *t.corners);
        status = find_twins(&t, surface->vertices, err);
    }
    if (status == HE_OK) {
        status = measure(&t, surface, err);
    }
    if (status != HE_OK) {
        he_intrinsic_clear(&t);
        return status;
    }
    lengthen(&t);
    for (uint32_t i = 0; i < t.triangles; i++) {
        find_cotangents(&t, i);
    }
    *out = t;
    return HE_OK;
}

/* --- flips --- */

/* The sides whose edges may not be Delaunay: a stack, with a mark for each side that is on it. */
typedef struct stack {
    uint32_t *sides;
    uint64_t *marked;
    uint32_t count;
} stack;

static void push(const he_intrinsic *t, stack *work, uint32_t side)
{
    const uint32_t twin = t->twins[side];
    if (twin == UINT32_MAX) {
        return;
    }
    side = side < twin ? side : twin;
    if (!he_bits_get(work->marked, side)) {
        he_bits_set(work->marked, side);
        work->sides[work->count++] = side;
    }
}

static bool may_flip(const he_intrinsic *t, uint32_t side)
{
    const uint32_t twin = t->twins[side];
    return twin != UINT32_MAX && side / 3 != twin / 3 &&
           t->cotangents[side] + t->cotangents[twin] < NOT_DELAUNAY;
}

/* Returns the length of the other diagonal of the two triangles at a side; 0 if they are too thin
 * for a number. */
static double other_diagonal(const he_intrinsic *t, uint32_t side)
{
    const uint32_t twin = t->twins[side];
    const double l = t->lengths[side];
    const double a = t->lengths[prev_of(side)], b = t->lengths[next_of(side)];
    const double c = t->lengths[next_of(twin)], d = t->lengths[prev_of(twin)];
    /* The side begins at the origin and runs along x; the third corners are above and below it. The
     * one above has the distance a from the origin, the one below the distance c. */
    const double x0 = (l + (a - b) * (a + b) / l) / 2, y0 = four_areas(l, a, b) / (2 * l);
    const double x1 = (l + (c - d) * (c + d) / l) / 2, y1 = four_areas(l, c, d) / (2 * l);
    const double length = hypot(x0 - x1, y0 + y1);
    /* Rounding must not make a triangle whose sides do not reach. */
    const double least = fmax(fabs(a - c), fabs(b - d)) + LEAST_EXCESS / 2;
    const double most = fmin(a + c, b + d) - LEAST_EXCESS / 2;
    return least <= most ? fmin(fmax(length, least), most) : 0;
}

static void join(he_intrinsic *t, uint32_t side, uint32_t twin)
{
    t->twins[side] = twin;
    if (twin != UINT32_MAX) {
        t->twins[twin] = side;
    }
}

/* Writes a side; its twin is joined by the caller. */
static void set_side(he_intrinsic *t, uint32_t side, uint32_t vertex, double length)
{
    t->corners[side] = vertex;
    t->lengths[side] = length;
}

/* Flips the edge of a side.
 *
 *            k                      k
 *          / |\                   / | \
 *         /     \                /  |  \
 *        i -s--> j      ->      i   |   j
 *         \     /                \  |  /
 *          \   /                  \ | /
 *            m                      m                                          */
static void flip(he_intrinsic *t, uint32_t s, double length)
{
    const uint32_t r = t->twins[s], jk = next_of(s), ki = prev_of(s), im = next_of(r),
                   mj = prev_of(r);
    const uint32_t i = t->corners[s], j = t->corners[r], k = t->corners[ki], m = t->corners[mj];
    const uint32_t outer[4] = {t->twins[ki], t->twins[im], t->twins[mj], t->twins[jk]};
    const double lengths[4] = {t->lengths[ki], t->lengths[im], t->lengths[mj], t->lengths[jk]};
    /* the triangle of s becomes k i m, that of r becomes m j k */
    const uint32_t sides[4] = {jk, ki, im, mj};
    set_side(t, s, m, length);
    set_side(t, jk, k, lengths[0]);
    set_side(t, ki, i, lengths[1]);
    set_side(t, r, k, length);
    set_side(t, im, m, lengths[2]);
    set_side(t, mj, j, lengths[3]);
    for (int e = 0; e < 4; e++) {
        /* The two triangles may also be neighbours at other edges than the flipped one. */
        const uint32_t twin = outer[e];
        join(t, sides[e],
             twin == ki   ? sides[0]
             : twin == im ? sides[1]
             : twin == mj ? sides[2]
             : twin == jk ? sides[3]
                          : twin);
    }
    find_cotangents(t, s / 3);
    find_cotangents(t, r / 3);
    t->flips++;
}

he_status he_intrinsic_flip(he_intrinsic *t, he_progress *progress, he_error *err)
{
    const uint32_t sides = 3 * t->triangles;
    const uint64_t most = (uint64_t)sides * FLIPS_FOR_EACH_SIDE;
    stack work = {.sides = he_mem_array(NULL, (size_t)sides + 1, sizeof *work.sides),
                  .marked = he_bits_new((size_t)sides + 1)};
    he_status status = HE_OK;
    if (work.sides == NULL || work.marked == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to flip the edges of %u triangles",
                               t->triangles);
    }
    for (uint32_t s = 0; s < sides && status == HE_OK; s++) {
        if (may_flip(t, s)) {
            push(t, &work, s);
        }
    }
    for (uint64_t steps = 0; work.count > 0 && status == HE_OK && t->flips < most; steps++) {
        const uint32_t s = work.sides[--work.count];
        work.marked[s >> 6] &= ~((uint64_t)1 << (s & 63));
        status = he_progress_at(progress, steps, steps + work.count + 1, err);
        const double length = status == HE_OK && may_flip(t, s) ? other_diagonal(t, s) : 0;
        if (length > 0) {
            const uint32_t twin = t->twins[s];
            flip(t, s, length);
            push(t, &work, next_of(s));
            push(t, &work, prev_of(s));
            push(t, &work, next_of(twin));
            push(t, &work, prev_of(twin));
        }
    }
    he_mem_free(work.sides);
    he_mem_free(work.marked);
    return status;
}
