#include "format/io/source_map.h"

void he_source_map_init(he_source_map *map, he_place unit, uint32_t step)
{
    *map = (he_source_map){.unit = unit, .step = step};
}

void he_source_map_clear(he_source_map *map)
{
    he_mem_free(map->runs);
    he_source_map_init(map, map->unit, map->step);
}

he_status he_source_map_begin_run(he_source_map *map, uint32_t element, uint64_t at, he_error *err)
{
    if (map->count == map->capacity) {
        size_t capacity = he_mem_grown(map->capacity, map->count + 1);
        he_source_run *runs = he_mem_array(map->runs, capacity, sizeof *runs);
        if (runs == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu line numbers", capacity);
        }
        map->runs = runs;
        map->capacity = capacity;
    }
    map->runs[map->count++] = (he_source_run){at, element};
    return HE_OK;
}

uint64_t he_source_map_find(const he_source_map *map, uint32_t element)
{
    size_t low = 0, high = map->count; /* the run that has the element is one of [low, high) */
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (map->runs[middle].first <= element) {
            low = middle;
        } else {
            high = middle;
        }
    }
    if (map->count == 0) {
        return 0;
    }
    const he_source_run *run = &map->runs[low];
    return run->at + (uint64_t)(element - run->first) * map->step;
}
