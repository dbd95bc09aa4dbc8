#include "compare/comparing.h"
#include "geometry/point_hash.h"

static bool is_at(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static size_t slots_for(size_t things)
{
    size_t size = 16;
    while (size < 2 * things) {
        size *= 2;
    }
    return size;
}

/* --- points --- */

/* A hash table of points: numbers of vertices + 1, or 0. It is at most half full. */
typedef struct point_table {
    const he_mesh *mesh;
    uint32_t *slots;
    size_t mask;
} point_table;

/* Returns the slot of a vertex at p, or the empty slot in which such a vertex would be. The
 * address of the table, which clients do not know, is the seed of the hash. */
static size_t find_point(const point_table *t, he_vec3 p)
{
    size_t at = he_point_hash((uintptr_t)t->slots, p) & t->mask;
    while (t->slots[at] != 0 && !is_at(p, t->mesh->c.position[t->slots[at] - 1])) {
        at = (at + 1) & t->mask;
    }
    return at;
}

/* Sets the bits of the vertices of `from` at whose position `to` has a vertex, too. Vertices that
 * were removed may count. */
static he_status find_equal_points(const he_mesh *from, const he_mesh *to, he_budget *budget,
                                   uint64_t *equal, he_error *err)
{
    const uint32_t known = to->c.vertices.issued, asked = from->c.vertices.issued;
    const size_t size = slots_for(known);
    point_table t = {to, he_mem_zero(size, sizeof *t.slots), size - 1};
    if (t.slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to look for vertices in both meshes");
    }
    he_status status = HE_OK;
    for (uint32_t v = 0; status == HE_OK && v < known; v++) {
        t.slots[find_point(&t, to->c.position[v])] = v + 1;
        status = he_budget_take(budget, HE_BVH_LOOK, err);
    }
    for (uint32_t v = 0; status == HE_OK && v < asked; v++) {
        if (t.slots[find_point(&t, from->c.position[v])] != 0) {
            he_bits_set(equal, v);
        }
        status = he_budget_take(budget, HE_BVH_LOOK, err);
    }
    he_mem_free(t.slots);
    return status;
}

/* Returns true if all corners of a triangle of `from` are vertices of `to`, too. */
static bool may_be_equal(const he_compared *from, const uint64_t *equal_points, uint32_t triangle)
{
    const uint32_t *vertex = from->tree->triangles[triangle].vertex;
    return he_bits_get(equal_points, vertex[0]) && he_bits_get(equal_points, vertex[1]) &&
           he_bits_get(equal_points, vertex[2]);
}

/* --- triangles --- */

/* A hash table of triangles by the positions of their corners: numbers of triangles + 1, or 0. It
 * is at most half full. */
typedef struct table {
    const he_compared *of;
    uint32_t *slots;
    size_t mask;
} table;

static he_vec3 corner(const he_compared *s, uint32_t triangle, int k)
{
    return s->mesh->c.position[s->tree->triangles[triangle].vertex[k]];
}

/* Returns a hash that does not depend on the order of the corners. The address of the table, which
 * clients do not know, is the seed. */
static size_t home(const table *t, const he_compared *s, uint32_t triangle)
{
    uint64_t sum = 0;
    for (int k = 0; k < 3; k++) {
        sum += he_point_hash((uintptr_t)t->slots, corner(s, triangle, k));
    }
    return (size_t)(sum * UINT64_C(0x9E3779B97F4A7C15) >> 31) & t->mask;
}

static bool are_equal(const he_compared *s, uint32_t i, const he_compared *t, uint32_t k)
{
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                     {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int o = 0; o < 6; o++) {
        if (is_at(corner(s, i, 0), corner(t, k, orders[o][0])) &&
            is_at(corner(s, i, 1), corner(t, k, orders[o][1])) &&
            is_at(corner(s, i, 2), corner(t, k, orders[o][2]))) {
            return true;
        }
    }
    return false;
}

/* Returns the slot of a triangle equal to triangle `triangle` of `s`, or the empty slot in which
 * such a triangle would be. */
static size_t find(const table *t, const he_compared *s, uint32_t triangle)
{
    size_t at = home(t, s, triangle);
    while (t->slots[at] != 0 && !are_equal(s, triangle, t->of, t->slots[at] - 1)) {
        at = (at + 1) & t->mask;
    }
    return at;
}

/* Looks for the triangles of `from` that may be equal to one of `to`. */
static he_status find_triangles(const he_compared *from, const he_compared *to, he_budget *budget,
                                const uint64_t *equal_points, uint64_t *equal, he_error *err)
{
    const size_t size = slots_for(to->tree->count);
    table t = {to, he_mem_zero(size, sizeof *t.slots), size - 1};
    if (t.slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to look for triangles in both meshes");
    }
    he_status status = HE_OK;
    for (uint32_t i = 0; status == HE_OK && i < to->tree->count; i++) {
        t.slots[find(&t, to, i)] = i + 1;
        status = he_budget_take(budget, HE_BVH_LOOK, err);
    }
    for (uint32_t i = 0; status == HE_OK && i < from->tree->count; i++) {
        if (may_be_equal(from, equal_points, i) && t.slots[find(&t, from, i)] != 0) {
            he_bits_set(equal, i);
        }
        status = he_budget_take(budget, HE_BVH_LOOK, err);
    }
    he_mem_free(t.slots);
    return status;
}

he_status he_find_equal_faces(const he_compared *from, const he_compared *to, he_budget *budget,
                              uint64_t *equal, he_error *err)
{
    uint64_t *points = he_bits_new(from->mesh->c.vertices.issued);
    if (points == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to look for vertices in both meshes");
    }
    he_status status = find_equal_points(from->mesh, to->mesh, budget, points, err);
    uint32_t i = 0;
    while (status == HE_OK && i < from->tree->count && !may_be_equal(from, points, i)) {
        i++;
    }
    if (status == HE_OK && i < from->tree->count) {
        status = find_triangles(from, to, budget, points, equal, err);
    }
    he_mem_free(points);
    return status;
}
