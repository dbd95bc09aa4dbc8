/* source_map.h - the line or byte of the input at which each vertex or face begins, so that errors
 * found later (a third face on an edge, an index beyond the last vertex) can name it.
 *
 * Elements mostly follow one another at equal steps (a line each, or a fixed number of bytes each),
 * so a run of such elements is stored as one entry. */
#ifndef HE_FORMAT_IO_SOURCE_MAP_H
#define HE_FORMAT_IO_SOURCE_MAP_H

#include "base/mem.h"

typedef struct he_source_run {
    uint64_t at; /* line or byte at which element `first` begins */
    uint32_t first;
} he_source_run;

typedef struct he_source_map {
    he_place unit;
    uint32_t step; /* distance from one element to the next inside a run */
    he_source_run *runs;
    size_t count, capacity;
} he_source_map;

void he_source_map_init(he_source_map *map, he_place unit, uint32_t step);
void he_source_map_clear(he_source_map *map);
HE_NODISCARD he_status he_source_map_begin_run(he_source_map *map, uint32_t element, uint64_t at,
                                               he_error *err);
/* Adds the line or byte `at` of an element. Elements must come in order.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD static inline he_status he_source_map_add(he_source_map *map, uint32_t element,
                                                       uint64_t at, he_error *err)
{
    if (map->count > 0) {
        const he_source_run *run = &map->runs[map->count - 1];
        if (at == run->at + (uint64_t)(element - run->first) * map->step) {
            return HE_OK;
        }
    }
    return he_source_map_begin_run(map, element, at, err);
}
/* Returns the line or byte of an element that was added before. */
uint64_t he_source_map_find(const he_source_map *map, uint32_t element);

#endif
