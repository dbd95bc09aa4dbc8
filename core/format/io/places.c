#include "format/io/places.h"

void he_places_init(he_places *places, he_place unit, uint32_t step)
{
    *places = (he_places){.unit = unit, .step = step};
}

void he_places_clear(he_places *places)
{
    he_mem_free(places->runs);
    he_places_init(places, places->unit, places->step);
}

he_status he_places_begin_run(he_places *places, uint32_t element, uint64_t at, he_error *err)
{
    if (places->count == places->capacity) {
        size_t capacity = he_mem_grown(places->capacity, places->count + 1);
        he_place_run *runs = he_mem_array(places->runs, capacity, sizeof *runs);
        if (runs == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu line numbers", capacity);
        }
        places->runs = runs;
        places->capacity = capacity;
    }
    places->runs[places->count++] = (he_place_run){at, element};
    return HE_OK;
}

uint64_t he_places_find(const he_places *places, uint32_t element)
{
    size_t low = 0, high = places->count; /* the run sought is one of [low, high) */
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (places->runs[middle].first <= element) {
            low = middle;
        } else {
            high = middle;
        }
    }
    if (places->count == 0) {
        return 0;
    }
    const he_place_run *run = &places->runs[low];
    return run->at + (uint64_t)(element - run->first) * places->step;
}
