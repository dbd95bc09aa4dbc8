/* places.h - the line or byte of the input at which each vertex or face begins, so that errors
 * found later (a third face on an edge, an index beyond the last vertex) can name it.
 *
 * Elements mostly follow one another at equal steps (a line each, or a fixed number of bytes each),
 * so a run of such elements is stored as one entry. */
#ifndef HE_FORMAT_IO_PLACES_H
#define HE_FORMAT_IO_PLACES_H

#include "base/mem.h"

typedef struct he_place_run {
    uint64_t at; /* line or byte of element `first` */
    uint32_t first;
} he_place_run;

typedef struct he_places {
    he_place unit;
    uint32_t step; /* distance from one element to the next inside a run */
    he_place_run *runs;
    size_t count, capacity;
} he_places;

void he_places_init(he_places *places, he_place unit, uint32_t step);
void he_places_clear(he_places *places);
HE_NODISCARD he_status he_places_begin_run(he_places *places, uint32_t element, uint64_t at,
                                           he_error *err);
/* Adds the line or byte `at` of an element. Elements must come in order.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD static inline he_status he_places_add(he_places *places, uint32_t element, uint64_t at,
                                                   he_error *err)
{
    if (places->count > 0) {
        const he_place_run *run = &places->runs[places->count - 1];
        if (at == run->at + (uint64_t)(element - run->first) * places->step) {
            return HE_OK;
        }
    }
    return he_places_begin_run(places, element, at, err);
}
/* Returns the line or byte of an element that was added before. */
uint64_t he_places_find(const he_places *places, uint32_t element);

#endif
