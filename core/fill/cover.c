/* cover.c - he_patch_cover: covers a hole by triangles between its corners. */
#include "fill/patch.h"

#include "base/progress.h"
#include "mesh/layout.h"

#include <assert.h>

/* The best triangles for the parts of a loop: entry i * HE_COVER_LOOP + j is for the corners i to j
 * and the chord from j to i. */
typedef struct entry {
    double cost;    /* INFINITY: there are none */
    he_vec3 normal; /* the unit normal of the triangle at the chord; zero if it has no area */
    uint8_t apex;   /* its third corner */
} entry;

typedef struct cover {
    he_patch *p;
    entry *table;
    uint32_t most; /* corners of a loop, at most HE_COVER_LOOP */
    uint64_t work; /* steps since progress was reported */
} cover;

/* A loop: corners of the hole, and the normals on the other side of the edges from each to the
 * next, and from the last to the first; zero where there are none. */
typedef struct loop {
    uint32_t count;
    uint32_t corners[HE_COVER_LOOP];
    he_vec3 beyond[HE_COVER_LOOP], closing;
} loop;

static double square(he_vec3 a)
{
    return he_vec3_dot(a, a);
}

/* Returns the cost of the bend at an edge whose length has the square `square_length`. */
static double bend(double square_length, he_vec3 a, he_vec3 b)
{
    return square(a) > 0 && square(b) > 0 ? square_length / 2 * (1 - he_vec3_dot(a, b)) : 0;
}

/* Finds the best triangle at the chord from corner j to corner i. */
static void choose(const cover *c, const loop *l, uint32_t i, uint32_t j)
{
    const he_vec3 *at = c->p->at;
    const he_vec3 a = at[l->corners[i]], b = at[l->corners[j]];
    const he_vec3 closing = j - i + 1 == l->count ? l->closing : (he_vec3){0, 0, 0};
    entry best = {INFINITY, {0, 0, 0}, 0};
    for (uint32_t k = i + 1; k < j; k++) {
        const entry *left = &c->table[i * HE_COVER_LOOP + k],
                    *right = &c->table[k * HE_COVER_LOOP + j];
        double cost = left->cost + right->cost;
        if (!(cost < best.cost)) {
            continue;
        }
        const he_vec3 apex = at[l->corners[k]];
        const double to_left = square(he_vec3_sub(apex, a)),
                     to_right = square(he_vec3_sub(b, apex));
        he_vec3 normal = he_triangle_normal(a, apex, b);
        const double length = he_vec3_length(normal);
        if (length > 0) {
            normal = he_vec3_scale(normal, 1 / length);
            cost += length / 2 + bend(to_left, normal, left->normal) +
                    bend(to_right, normal, right->normal) +
                    bend(square(he_vec3_sub(b, a)), normal, closing);
        } else {
            cost += to_left + to_right; /* as bad as folded back on both sides */
        }
        if (cost < best.cost) {
            best = (entry){cost, normal, (uint8_t)k};
        }
    }
    c->table[i * HE_COVER_LOOP + j] = best;
}

/* Adds the triangles of the corners i to j. */
static void add_triangles(const cover *c, const loop *l)
{
    uint8_t from[HE_COVER_LOOP], to[HE_COVER_LOOP];
    uint32_t depth = 1;
    from[0] = 0;
    to[0] = (uint8_t)(l->count - 1);
    while (depth > 0) {
        const uint8_t i = from[--depth], j = to[depth];
        const uint8_t k = c->table[i * HE_COVER_LOOP + j].apex;
        (void)he_patch_add_triangle(c->p, l->corners[i], l->corners[k], l->corners[j]);
        if (k - i > 1) {
            from[depth] = i;
            to[depth++] = k;
        }
        if (j - k > 1) {
            from[depth] = k;
            to[depth++] = j;
        }
    }
}

/* Adds the best triangles of a loop. Returns false if there are none. `normal` receives that of the
 * triangle at the edge from the last corner to the first. */
static bool cut_loop(const cover *c, const loop *l, he_vec3 *normal)
{
    const uint32_t last = l->count - 1;
    for (uint32_t i = 0; i < last; i++) {
        c->table[i * HE_COVER_LOOP + i + 1] = (entry){0, l->beyond[i], 0};
    }
    for (uint32_t span = 2; span <= last; span++) {
        for (uint32_t i = 0; i + span <= last; i++) {
            if (span < last && he_patch_is_chord(c->p, l->corners[i], l->corners[i + span])) {
                c->table[i * HE_COVER_LOOP + i + span] = (entry){INFINITY, {0, 0, 0}, 0};
            } else {
                choose(c, l, i, i + span);
            }
        }
    }
    *normal = c->table[last].normal;
    if (!(c->table[last].cost < INFINITY)) {
        return false;
    }
    add_triangles(c, l);
    return true;
}

/* Adds triangles for `count` corners of the hole from corner `first` on. The loop is closed by the
 * chord from the last one to the first, or by the last edge of the rim if all corners are counted.
 * Sets *found to false if there are none. */
static he_status cover_range(cover *c, uint32_t first, uint32_t count, he_vec3 *normal, bool *found,
                             he_error *err)
{
    he_patch *p = c->p;
    assert(count >= 2);
    loop l = {.count = count < c->most ? count : c->most};
    const uint32_t edges = count - 1, parts = l.count - 1;
    he_status status = HE_OK;
    l.closing = count == p->rim ? p->beyond[p->rim - 1] : (he_vec3){0, 0, 0};
    for (uint32_t i = 0; i < l.count; i++) {
        l.corners[i] = first + (uint32_t)((uint64_t)edges * i / parts);
    }
    for (uint32_t i = 0; i < parts && status == HE_OK && *found; i++) {
        const uint32_t from = l.corners[i], to = l.corners[i + 1];
        if (to - from == 1) {
            l.beyond[i] = p->beyond[from];
        } else if (he_patch_is_chord(p, from, to)) {
            *found = false;
        } else {
            status = cover_range(c, from, to - from + 1, &l.beyond[i], found, err);
        }
    }
    c->work += (uint64_t)l.count * l.count * l.count;
    if (status == HE_OK && c->work > (uint64_t)HE_COVER_LOOP * HE_COVER_LOOP * HE_COVER_LOOP) {
        c->work = 0;
        status = he_progress_step(p->mesh->progress, first, p->rim, err);
    }
    if (status == HE_OK && *found) {
        *found = cut_loop(c, &l, normal);
    }
    return status;
}

static void remove_triangles(he_patch *p)
{
    p->triangles = 0;
    for (uint32_t i = 0; i < p->rim; i++) {
        p->degree[i] = 0;
    }
}

/* Covers the hole by triangles around a new vertex. */
static he_status fan(he_patch *p, he_error *err)
{
    he_vec3 sum = {0, 0, 0};
    double size = 0;
    for (uint32_t i = 0; i < p->rim; i++) {
        sum = he_vec3_add(sum, he_vec3_scale(p->at[i], 1.0 / p->rim));
        size += p->size[i] / p->rim;
    }
    he_status status = he_patch_reserve(p, err);
    if (status != HE_OK) {
        return status;
    }
    const uint32_t middle = he_patch_add_vertex(p, sum, size, 0);
    for (uint32_t i = 0; i < p->rim; i++) {
        (void)he_patch_add_triangle(p, i, i + 1 == p->rim ? 0 : i + 1, middle);
    }
    return HE_OK;
}

he_status he_patch_cover(he_patch *p, he_error *err)
{
    /* A long hole is first cut along chords between some of its corners. If the mesh has one of
     * these edges already, other corners are tried. */
    static const uint32_t most[] = {HE_COVER_PARTS + 1, HE_COVER_PARTS - 2, HE_COVER_PARTS - 4,
                                    HE_COVER_PARTS - 10};
    cover c = {.p = p};
    bool found = false;
    he_status status = HE_OK;
    c.table = he_mem_array(NULL, (size_t)HE_COVER_LOOP * HE_COVER_LOOP, sizeof *c.table);
    if (c.table == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to fill a hole of %u edges", p->rim);
    }
    for (size_t i = 0; i < sizeof most / sizeof *most && !found && status == HE_OK; i++) {
        he_vec3 normal;
        c.most = i == 0 && p->rim <= HE_COVER_LOOP ? HE_COVER_LOOP : most[i];
        found = true;
        status = cover_range(&c, 0, p->rim, &normal, &found, err);
        if (!found) {
            remove_triangles(p);
        }
    }
    he_mem_free(c.table);
    if (status == HE_OK && !found) {
        status = fan(p, err);
    }
    return status == HE_OK ? he_patch_pair(p, err) : status;
}
