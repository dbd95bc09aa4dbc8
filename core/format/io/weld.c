#include "format/io/weld.h"

#include "geometry/point_hash.h"

enum { FIRST_BITS = 10 };

void he_weld_clear(he_weld *weld)
{
    he_mem_free(weld->slots);
    *weld = (he_weld){0};
}

/* Returns the slot where the search for a hash begins. Slots are in the order of the hash, so when
 * the table doubles, each entry moves to about twice its index. */
static size_t first_slot(const he_weld *weld, uint32_t h)
{
    return h >> (32 - weld->bits);
}

void he_weld_expect(const he_weld *weld, he_vec3 position)
{
    if (weld->slots != NULL) {
        __builtin_prefetch(&weld->slots[first_slot(weld, he_point_hash(weld->seed, position))]);
    }
}

static size_t following(const he_weld *weld, size_t slot)
{
    return (slot + 1) & (((size_t)1 << weld->bits) - 1);
}

static he_status widen(he_weld *weld, he_error *err)
{
    he_weld wide = {.bits = weld->slots == NULL ? FIRST_BITS : weld->bits + 1, .seed = weld->seed};
    size_t count = weld->slots == NULL ? 0 : (size_t)1 << weld->bits;
    wide.slots = he_mem_zero((size_t)1 << wide.bits, sizeof *wide.slots);
    if (wide.slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %zu positions",
                             (size_t)1 << wide.bits);
    }
    if (count == 0) {
        wide.seed = (uint64_t)(uintptr_t)wide.slots * 0x94D049BB133111EB;
    }
    for (size_t i = 0; i < count; i++) {
        if (weld->slots[i].vertex != 0) {
            size_t slot = first_slot(&wide, weld->slots[i].hash);
            while (wide.slots[slot].vertex != 0) {
                slot = following(&wide, slot);
            }
            wide.slots[slot] = weld->slots[i];
        }
    }
    he_mem_free(weld->slots);
    *weld = wide;
    return HE_OK;
}

static bool same(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

he_status he_weld_vertex(he_weld *weld, he_soup *soup, he_vec3 position, uint32_t *vertex,
                         he_error *err)
{
    he_status status = HE_OK;
    if (weld->slots == NULL || soup->vertex_count >= (size_t)1 << (weld->bits - 1)) {
        status = widen(weld, err);
        if (status != HE_OK) {
            return status;
        }
    }
    uint32_t h = he_point_hash(weld->seed, position);
    size_t slot = first_slot(weld, h);
    for (; weld->slots[slot].vertex != 0; slot = following(weld, slot)) {
        const he_weld_slot *s = &weld->slots[slot];
        if (s->hash == h && same(soup->positions[s->vertex - 1], position)) {
            *vertex = s->vertex - 1;
            return HE_OK;
        }
    }
    status = he_soup_add_vertex(soup, position, err);
    if (status == HE_OK) {
        weld->slots[slot] = (he_weld_slot){h, (uint32_t)soup->vertex_count};
        *vertex = (uint32_t)soup->vertex_count - 1;
    }
    return status;
}
