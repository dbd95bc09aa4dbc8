#include "query/open_seams.h"

#include "geometry/point_hash.h"
#include "mesh/walk.h"

/* An entry of the hash table: the boundary half-edges that run from one position to another and for
 * which no half-edge in the opposite direction was found yet. */
typedef struct slot {
    uint32_t halfedge; /* id of the first such half-edge, plus 1; 0 if the entry is free */
    uint32_t waiting;
} slot;

typedef struct table {
    slot *slots;
    size_t mask;
} table;

static bool same(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Returns the entry for half-edges that run from position `from` to position `to`. If there is
 * none, returns the free entry in which it must be stored. */
static slot *find(const table *t, const he_mesh *m, he_vec3 from, he_vec3 to)
{
    uint64_t seed = (uint64_t)(uintptr_t)t->slots;
    uint64_t h = ((uint64_t)he_point_hash(seed, from) << 32 | he_point_hash(~seed, to));
    size_t i = (size_t)(h * 0x9E3779B97F4A7C15 >> 20) & t->mask;
    for (; t->slots[i].halfedge != 0; i = (i + 1) & t->mask) {
        he_halfedge k = {t->slots[i].halfedge - 1};
        if (same(he_position(m, he_origin(m, k)), from) &&
            same(he_position(m, he_target(m, k)), to)) {
            break;
        }
    }
    return &t->slots[i];
}

he_status he_open_seams_count(const he_mesh *m, uint64_t *out, he_error *err)
{
    uint64_t seams = 0;
    size_t size = 8;
    *out = 0;
    if (m->c.boundary_halfedges == 0) {
        return HE_OK;
    }
    while (size < 2 * (size_t)m->c.boundary_halfedges) {
        size *= 2;
    }
    table t = {he_mem_zero(size, sizeof *t.slots), size - 1};
    if (t.slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %u boundary half-edges",
                             m->c.boundary_halfedges);
    }
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE); h++) {
        if (m->c.face[h] != HE_NONE) {
            continue;
        }
        he_vec3 from = he_position(m, he_origin(m, (he_halfedge){h}));
        he_vec3 to = he_position(m, he_target(m, (he_halfedge){h}));
        if (same(from, to)) {
            continue;
        }
        slot *other = find(&t, m, to, from);
        if (other->halfedge != 0 && other->waiting > 0) {
            other->waiting--;
            seams++;
        } else {
            slot *mine = find(&t, m, from, to);
            mine->halfedge = mine->halfedge != 0 ? mine->halfedge : h + 1;
            mine->waiting++;
        }
    }
    he_mem_free(t.slots);
    *out = seams;
    return HE_OK;
}
