#include "query/idmap.h"

#include "base/word_hash.h"

enum { FIRST_LOG2 = 5 };

static size_t slot_of(const he_idmap *map, uint32_t id)
{
    size_t mask = ((size_t)1 << map->log2) - 1;
    size_t slot = he_word_hash((uintptr_t)map->slots, id) >> (64 - map->log2);
    while (map->slots[slot] != 0 && map->ids.ids[map->slots[slot] - 1] != id) {
        slot = (slot + 1) & mask;
    }
    return slot;
}

static he_status grow(he_idmap *map, he_error *err)
{
    unsigned log2 = map->log2 == 0 ? FIRST_LOG2 : map->log2 + 1;
    uint32_t *slots = he_mem_zero((size_t)1 << log2, sizeof *slots);
    if (slots == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a set of %zu ids", map->ids.count);
    }
    he_mem_free(map->slots);
    map->slots = slots;
    map->log2 = log2;
    for (size_t i = 0; i < map->ids.count; i++) {
        slots[slot_of(map, map->ids.ids[i])] = (uint32_t)i + 1;
    }
    return HE_OK;
}

uint32_t he_idmap_find(const he_idmap *map, uint32_t id)
{
    if (map->log2 == 0) {
        return HE_NONE;
    }
    uint32_t entry = map->slots[slot_of(map, id)];
    return entry == 0 ? HE_NONE : entry - 1;
}

he_status he_idmap_add(he_idmap *map, uint32_t id, uint32_t *index, bool *added, he_error *err)
{
    if (map->log2 == 0 || map->ids.count * 2 >= (size_t)1 << map->log2) {
        he_status status = grow(map, err);
        if (status != HE_OK) {
            return status;
        }
    }
    size_t slot = slot_of(map, id);
    *added = map->slots[slot] == 0;
    if (*added) {
        he_status status = he_ids_add(&map->ids, id, err);
        if (status != HE_OK) {
            return status;
        }
        map->slots[slot] = (uint32_t)map->ids.count;
    }
    *index = map->slots[slot] - 1;
    return HE_OK;
}

void he_idmap_clear(he_idmap *map)
{
    he_ids_clear(&map->ids);
    he_mem_free(map->slots);
    *map = (he_idmap){0};
}
