#include "edit/weld.h"

#include "edit/list.h"
#include "mesh/walk.h"

#include <math.h>
#include <string.h>

he_status he_vertex_weld(he_mesh *m, const uint32_t *vertices, size_t count, he_merge_place place,
                         he_vertex *into, he_error *err)
{
    he_ids gone = {0}, to = {0};
    he_status status = he_list_require(m, HE_VERTEX, vertices, count, HE_REPEATED_ELEMENT, err);
    uint32_t lowest = HE_NONE;
    for (size_t i = 0; i < count; i++) {
        lowest = vertices[i] < lowest ? vertices[i] : lowest;
    }
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        if (vertices[i] != lowest) {
            status = he_ids_add(&gone, vertices[i], err);
            if (status == HE_OK) {
                status = he_ids_add(&to, lowest, err);
            }
        }
    }
    if (status == HE_OK && gone.count > 0) {
        const he_merge how = {gone.ids, to.ids, gone.count, place};
        status = he_merge_vertices(m, &how, err);
    }
    he_ids_clear(&gone);
    he_ids_clear(&to);
    if (status == HE_OK && into != NULL) {
        *into = (he_vertex){lowest};
    }
    return status;
}

/* Vertices that stay, by the cell they lie in. */
typedef struct cells {
    uint32_t *slots; /* vertex + 1; 0 where free */
    size_t count;    /* a power of two */
    double size;     /* 0: only equal positions share a cell */
    double tolerance;
} cells;

/* Beyond this many cells from the origin doubles are farther apart than the tolerance, so that only
 * equal numbers are near. */
static const double FAR = 0x1p52;

static bool is_far(const cells *c, double x)
{
    return c->size == 0 || fabs(x / c->size) >= FAR;
}

static double cell_of(const cells *c, double x)
{
    return (is_far(c, x) ? x : floor(x / c->size)) + 0.0; /* -0 is 0 */
}

static he_vec3 cell_at(const cells *c, he_vec3 p)
{
    return (he_vec3){cell_of(c, p.x), cell_of(c, p.y), cell_of(c, p.z)};
}

static uint64_t mix(uint64_t h, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    h = (h ^ bits) * UINT64_C(0x9E3779B97F4A7C15);
    return h ^ h >> 32;
}

static size_t slot_of(const cells *c, he_vec3 cell)
{
    uint64_t seed = (uint64_t)(uintptr_t)c->slots;
    uint64_t h = mix(mix(mix(seed, cell.x), cell.y), cell.z) * UINT64_C(0xBF58476D1CE4E5B9);
    return (size_t)(h >> 32) & (c->count - 1);
}

static bool is_near(const cells *c, he_vec3 p, he_vec3 q)
{
    return hypot(hypot(p.x - q.x, p.y - q.y), p.z - q.z) <= c->tolerance;
}

/* The lowest vertex of a cell that is near p, or `found` when that is lower. */
static uint32_t look(const cells *c, const he_mesh *m, he_vec3 cell, he_vec3 p, uint32_t found)
{
    for (size_t slot = slot_of(c, cell); c->slots[slot] != 0; slot = (slot + 1) & (c->count - 1)) {
        uint32_t v = c->slots[slot] - 1;
        if (v < found && is_near(c, he_position(m, (he_vertex){v}), p)) {
            found = v;
        }
    }
    return found;
}

/* The lowest vertex that stays and is near p, or HE_NONE. */
static uint32_t find_near(const cells *c, const he_mesh *m, he_vec3 p)
{
    he_vec3 cell = cell_at(c, p);
    int x = !is_far(c, p.x), y = !is_far(c, p.y), z = !is_far(c, p.z);
    uint32_t found = HE_NONE;
    for (int i = -x; i <= x; i++) {
        for (int j = -y; j <= y; j++) {
            for (int k = -z; k <= z; k++) {
                found = look(c, m, (he_vec3){cell.x + i, cell.y + j, cell.z + k}, p, found);
            }
        }
    }
    return found;
}

/* Which vertices become part of which. */
static he_status find_pairs(const he_mesh *m, double tolerance, he_ids *gone, he_ids *to,
                            he_error *err)
{
    uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    /* A little larger, so that rounding takes no neighbour two cells away. */
    cells c = {.count = 16, .size = tolerance * 1.001, .tolerance = tolerance};
    he_status status = HE_OK;
    while (c.count < 2 * (size_t)he_mesh_vertices(m)) {
        c.count *= 2;
    }
    c.slots = he_mem_zero(c.count, sizeof *c.slots);
    if (c.slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %u vertices",
                             he_mesh_vertices(m));
    }
    for (uint32_t v = 0; status == HE_OK && v < issued; v++) {
        status = he_watch_at(m->watch, v, issued, err);
        if (status != HE_OK || !he_vertex_is_live(m, (he_vertex){v})) {
            continue;
        }
        he_vec3 p = he_position(m, (he_vertex){v});
        uint32_t near = find_near(&c, m, p);
        if (near != HE_NONE) {
            status = he_ids_add(gone, v, err);
            if (status == HE_OK) {
                status = he_ids_add(to, near, err);
            }
            continue;
        }
        size_t slot = slot_of(&c, cell_at(&c, p));
        while (c.slots[slot] != 0) {
            slot = (slot + 1) & (c.count - 1);
        }
        c.slots[slot] = v + 1;
    }
    he_mem_free(c.slots);
    return status;
}

he_status he_weld_near(he_mesh *m, double tolerance, he_merge_place place, he_ids *into,
                       he_error *err)
{
    he_ids gone = {0}, to = {0}, stay = {0};
    if (!(tolerance >= 0)) {
        return he_fail_plain(err, HE_BAD_VALUE, "a tolerance cannot be %g", tolerance);
    }
    he_status status = he_watch_phase(m->watch, "comparing", 0.4, err);
    if (status == HE_OK) {
        status = find_pairs(m, tolerance, &gone, &to, err);
    }
    for (size_t i = 0; status == HE_OK && i < to.count; i++) {
        status = he_ids_add(&stay, to.ids[i], err);
    }
    if (status == HE_OK) {
        status = he_ids_sort(&stay, err);
    }
    if (status == HE_OK && into != NULL) {
        status = he_ids_reserve(into, stay.count, err);
    }
    if (status == HE_OK && gone.count > 0) {
        const he_merge how = {gone.ids, to.ids, gone.count, place};
        status = he_merge_vertices(m, &how, err);
    }
    for (size_t i = 0; status == HE_OK && into != NULL && i < stay.count; i++) {
        into->ids[into->count++] = stay.ids[i];
    }
    he_ids_clear(&gone);
    he_ids_clear(&to);
    he_ids_clear(&stay);
    return status;
}
