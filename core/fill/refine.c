/* refine.c - he_patch_refine and he_patch_relax: more vertices, and rounder triangles. */
#include "fill/fill.h"
#include "fill/patch.h"

#include "base/progress.h"
#include "mesh/layout.h"

#include <assert.h>

/* --- flips --- */

/* Sides whose edges are to be looked at. */
typedef struct queue {
    uint32_t *sides;
    uint64_t *waiting; /* the sides that are in the queue: a bit set */
    size_t count, room;
} queue;

static he_status queue_reserve(queue *q, const he_patch *p, he_error *err)
{
    const size_t sides = 3 * (size_t)p->triangle_room;
    if (sides <= q->room) {
        return HE_OK;
    }
    uint32_t *list = he_mem_array(q->sides, sides, sizeof *list);
    q->sides = list == NULL ? q->sides : list;
    uint64_t *waiting = he_bits_new(sides);
    if (list == NULL || waiting == NULL) {
        he_mem_free(waiting);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to fill a hole with %u triangles",
                             p->triangles);
    }
    for (size_t i = 0; i < q->count; i++) {
        he_bits_set(waiting, q->sides[i]);
    }
    he_mem_free(q->waiting);
    q->waiting = waiting;
    q->room = sides;
    return HE_OK;
}

static void queue_clear(queue *q)
{
    he_mem_free(q->sides);
    he_mem_free(q->waiting);
}

/* Puts the edge of a side into the queue, as one of its sides. */
static void queue_add(queue *q, const he_patch *p, uint32_t side)
{
    const uint32_t twin = p->twins[side];
    const uint32_t one = twin < side ? twin : side;
    assert(q->waiting != NULL);
    if (twin != UINT32_MAX && !he_bits_get(q->waiting, one)) {
        he_bits_set(q->waiting, one);
        q->sides[q->count++] = one;
    }
}

static uint32_t queue_take(queue *q)
{
    const uint32_t side = q->sides[--q->count];
    q->waiting[side >> 6] &= ~((uint64_t)1 << (side & 63));
    return side;
}

/* Returns true if the angles at c and d in the triangles a b c and b a d add up to more than 180
 * degrees: their cotangents are then below 0 in sum. */
static bool is_flat(he_vec3 a, he_vec3 b, he_vec3 c, he_vec3 d)
{
    static const double EPS = 1e-10;
    const he_vec3 ca = he_vec3_sub(a, c), cb = he_vec3_sub(b, c), da = he_vec3_sub(a, d),
                  db = he_vec3_sub(b, d);
    const double at_c = he_vec3_dot(ca, cb), at_d = he_vec3_dot(db, da);
    if (at_c >= 0 && at_d >= 0) {
        return false; /* no angle is obtuse, as at most edges */
    }
    return at_c / he_vec3_length(he_vec3_cross(ca, cb)) +
               at_d / he_vec3_length(he_vec3_cross(db, da)) <
           -EPS;
}

/* Returns true if an edge of the patch joins the vertex where `side` begins and vertex `v`. */
static bool is_joined(const he_patch *p, uint32_t side, uint32_t v)
{
    uint32_t s = side, twin = side;
    do { /* counter-clockwise */
        s = twin;
        if (p->corners[he_patch_next(s)] == v || p->corners[he_patch_prev(s)] == v) {
            return true;
        }
        twin = p->twins[he_patch_prev(s)];
    } while (twin != UINT32_MAX && twin != side);
    if (twin == side) {
        return false;
    }
    /* The rim was reached, so there may be triangles on the other side. */
    for (twin = p->twins[side]; twin != UINT32_MAX; twin = p->twins[s]) {
        s = he_patch_next(twin);
        if (p->corners[he_patch_next(s)] == v || p->corners[he_patch_prev(s)] == v) {
            return true;
        }
    }
    return false;
}

/* The four vertices around the edge of a side that runs from a to b:
 *
 *            c
 *          /   \
 *        a ----> b
 *          \   /
 *            d
 */
typedef struct diamond {
    uint32_t side, twin;
    uint32_t a, b, c, d;
} diamond;

static diamond diamond_of(const he_patch *p, uint32_t side)
{
    const uint32_t twin = p->twins[side];
    return (diamond){side,
                     twin,
                     p->corners[side],
                     p->corners[twin],
                     p->corners[he_patch_prev(side)],
                     p->corners[he_patch_prev(twin)]};
}

/* Returns true if the angles at c and d add up to more than 180 degrees, and the edge from c to d
 * would neither fold the surface nor join vertices that have an edge. */
static bool should_flip(const he_patch *p, const diamond *q)
{
    const he_vec3 a = p->at[q->a], b = p->at[q->b], c = p->at[q->c], d = p->at[q->d];
    if (!is_flat(a, b, c, d)) {
        return false;
    }
    const double before = he_vec3_dot(he_triangle_normal(a, b, c), he_triangle_normal(b, a, d)),
                 after = he_vec3_dot(he_triangle_normal(a, d, c), he_triangle_normal(d, b, c));
    if (after <= 0 && before > 0) {
        return false;
    }
    const bool fewer = p->degree[q->c] <= p->degree[q->d];
    return !he_patch_is_chord(p, q->c, q->d) &&
           !is_joined(p, he_patch_prev(fewer ? q->side : q->twin), fewer ? q->d : q->c);
}

static void put_side(he_patch *p, uint32_t side, uint32_t corner, uint32_t twin)
{
    p->corners[side] = corner;
    p->twins[side] = twin;
    if (twin != UINT32_MAX) {
        p->twins[twin] = side;
    }
}

/* Replaces the edge from a to b by one from c to d. */
static void flip(he_patch *p, const diamond *q)
{
    const uint32_t bc = p->twins[he_patch_next(q->side)], ca = p->twins[he_patch_prev(q->side)],
                   ad = p->twins[he_patch_next(q->twin)], db = p->twins[he_patch_prev(q->twin)];
    const uint32_t s = 3 * (q->side / 3), t = 3 * (q->twin / 3);
    put_side(p, s, q->a, ad);
    put_side(p, s + 2, q->c, ca);
    put_side(p, t, q->d, db);
    put_side(p, t + 1, q->b, bc);
    put_side(p, s + 1, q->d, t + 2);
    put_side(p, t + 2, q->c, s + 1);
    p->degree[q->a]--;
    p->degree[q->b]--;
    p->degree[q->c]++;
    p->degree[q->d]++;
}

/* Flips edges until the queue is empty, or so many were flipped that they seem to come back: in
 * space, unlike in a plane, that is not ruled out. */
static he_status flip_all(he_patch *p, queue *q, he_error *err)
{
    const uint64_t most = 20 * (uint64_t)p->triangles;
    uint64_t flips = 0, looks = 0;
    he_status status = HE_OK;
    while (q->count > 0 && status == HE_OK) {
        const uint32_t side = queue_take(q);
        status = he_progress_at(p->mesh->progress, ++looks, 6 * (uint64_t)p->triangles, err);
        if (status != HE_OK || flips == most || p->twins[side] == UINT32_MAX) {
            continue; /* another change may have brought the side to the rim */
        }
        const diamond around = diamond_of(p, side);
        if (should_flip(p, &around)) {
            flip(p, &around);
            flips++;
            const uint32_t s = 3 * (around.side / 3), t = 3 * (around.twin / 3);
            queue_add(q, p, s);
            queue_add(q, p, s + 2);
            queue_add(q, p, t);
            queue_add(q, p, t + 1);
        }
    }
    return status;
}

he_status he_patch_relax(he_patch *p, he_error *err)
{
    queue q = {.sides = NULL};
    he_status status = queue_reserve(&q, p, err);
    for (uint32_t s = 0; s < 3 * p->triangles && status == HE_OK; s++) {
        queue_add(&q, p, s);
    }
    if (status == HE_OK) {
        status = flip_all(p, &q, err);
    }
    queue_clear(&q);
    return status;
}

/* --- new vertices --- */

/* What decides where vertices are added. */
typedef struct spacing {
    double length; /* the wanted length of all edges; 0: that of the rim */
    double growth; /* by how much it grows for each unit of distance from the rim */
    double most;   /* the number of triangles at which dividing ends */
} spacing;

static double area(const he_patch *p, uint32_t triangle)
{
    const uint32_t *v = &p->corners[3 * (size_t)triangle];
    return he_vec3_length(he_triangle_normal(p->at[v[0]], p->at[v[1]], p->at[v[2]])) / 2;
}

/* Returns about how many triangles there will be: the area of an equilateral triangle is
 * sqrt(3) / 4 of the square of its sides. */
static double foresee(const he_patch *p)
{
    double sum = 0;
    for (uint32_t t = 0; t < p->triangles; t++) {
        const uint32_t *v = &p->corners[3 * (size_t)t];
        const double size = (p->size[v[0]] + p->size[v[1]] + p->size[v[2]]) / 3;
        const double count = area(p, t) / (0.433 * size * size);
        sum += count > 1 ? count : 1;
    }
    return sum;
}

/* Adds a vertex in the middle of a triangle if all its edges stay long enough. Returns whether it
 * did; there must be room. */
static bool divide(he_patch *p, const spacing *wanted, uint32_t triangle)
{
    const uint32_t side = 3 * triangle;
    const uint32_t v[3] = {p->corners[side], p->corners[side + 1], p->corners[side + 2]};
    const he_vec3 sum = he_vec3_add(he_vec3_add(p->at[v[0]], p->at[v[1]]), p->at[v[2]]);
    const he_vec3 middle = he_vec3_scale(sum, 1.0 / 3);
    double distance[3], size = 0, largest = 0;
    uint32_t near = 0;
    for (uint32_t k = 0; k < 3; k++) {
        distance[k] = he_vec3_length(he_vec3_sub(p->at[v[k]], middle));
        largest = fmax(largest, p->size[v[k]]);
        size += (p->size[v[k]] + wanted->growth * distance[k]) / 3;
        near = distance[k] < distance[near] ? k : near;
    }
    size = wanted->length > 0 ? wanted->length : size;
    for (uint32_t k = 0; k < 3; k++) {
        if (!(M_SQRT2 * distance[k] > fmax(size, p->size[v[k]]))) {
            return false;
        }
    }
    /* Triangles without area would only get more of their kind. */
    static const double LEAST_AREA = 1e-6;
    if (!(area(p, triangle) > LEAST_AREA * largest * largest)) {
        return false;
    }
    const uint32_t bc = p->twins[side + 1], ca = p->twins[side + 2];
    const uint32_t w = he_patch_add_vertex(p, middle, size, p->corner[v[near]]);
    /* the triangle keeps its first side */
    p->corners[side + 2] = w;
    p->degree[v[2]]--;
    p->degree[w]++;
    const uint32_t s = 3 * he_patch_add_triangle(p, v[1], v[2], w),
                   t = 3 * he_patch_add_triangle(p, v[2], v[0], w);
    put_side(p, s, v[1], bc);
    put_side(p, t, v[2], ca);
    put_side(p, side + 1, v[1], s + 2);
    put_side(p, s + 1, v[2], t + 2);
    put_side(p, t + 1, v[0], side + 2);
    return true;
}

/* Divides each triangle once where it may be, and flips edges. Sets *more if any was divided. */
static he_status divide_all(he_patch *p, const spacing *wanted, queue *q, bool *more, he_error *err)
{
    const uint32_t triangles = p->triangles;
    he_status status = HE_OK;
    *more = false;
    for (uint32_t t = 0; t < triangles && status == HE_OK; t++) {
        status = he_progress_at(p->mesh->progress, t + 1, triangles, err);
        if (status == HE_OK) {
            status = he_patch_reserve(p, err);
        }
        if (status == HE_OK) {
            status = queue_reserve(q, p, err);
        }
        if (status == HE_OK && p->triangles + 2 <= wanted->most && divide(p, wanted, t)) {
            *more = true;
            queue_add(q, p, 3 * t);
            queue_add(q, p, 3 * (p->triangles - 2));
            queue_add(q, p, 3 * (p->triangles - 1));
        }
    }
    return status == HE_OK ? flip_all(p, q, err) : status;
}

/* Chooses the lengths of edges, and refuses those that make too many faces. */
static he_status plan(he_patch *p, double edge_length, spacing *out, he_error *err)
{
    /* Edges that grow inwards make less than FOR_EACH_EDGE faces for each edge of the hole. What is
     * foreseen is mostly a third too few. Dividing ends at twice as many, to be safe, and at
     * MOST. */
    static const double MANY = 50000, FOR_EACH_EDGE = 8, MOST = 1000000;
    *out = (spacing){.length = edge_length};
    for (uint32_t v = 0; v < p->vertices && edge_length > 0; v++) {
        p->size[v] = edge_length;
    }
    const double faces = foresee(p), growing = fmax(MANY, FOR_EACH_EDGE * p->rim);
    const bool grows = edge_length <= 0 && faces > MANY;
    he_status status = edge_length > 0 ? he_fill_within(faces, edge_length * p->unit, err) : HE_OK;
    out->growth = grows ? 0.25 : 0;
    out->most = fmin(MOST, 2 * fmax(HE_FILL_FACES, grows ? growing : 0));
    return status == HE_OK ? he_fill_within_all(grows ? growing : faces, p->left, err) : status;
}

static void scale_sizes(he_patch *p, double factor)
{
    for (uint32_t v = 0; v < p->vertices; v++) {
        p->size[v] *= factor;
    }
}

he_status he_patch_refine(he_patch *p, double edge_length, double coarseness, he_error *err)
{
    enum { PASSES = 60 };
    spacing wanted;
    queue q = {.sides = NULL};
    bool more = true;
    he_status status = he_patch_relax(p, err);
    if (status == HE_OK) {
        status = plan(p, edge_length, &wanted, err);
    }
    if (status == HE_OK) {
        scale_sizes(p, coarseness);
        wanted.length *= coarseness;
        wanted.growth *= coarseness;
    }
    for (unsigned i = 0; i < PASSES && more && status == HE_OK; i++) {
        status = divide_all(p, &wanted, &q, &more, err);
    }
    if (status == HE_OK) {
        scale_sizes(p, 1 / coarseness);
    }
    queue_clear(&q);
    return status;
}
