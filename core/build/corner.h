/* corner.h - finds the face and the neighbours of a corner of a soup by the corner's number. Only
 * core/build uses it. */
#ifndef HE_BUILD_CORNER_H
#define HE_BUILD_CORNER_H

#include "build/build.h"
#include "build/soup_check.h"

typedef struct he_corners {
    const he_soup *soup;
    uint32_t degree;   /* number of corners of every face if all have 3 or all have 4, else 0 */
    uint32_t *face_of; /* face of each corner if `degree` is 0, else NULL */
} he_corners;

typedef struct he_corner {
    /* the corner's face, and the next and the previous corner of that face */
    uint32_t face, next, prev;
} he_corner;

HE_NODISCARD he_status he_corners_init(const he_soup *soup, he_corners *out, he_error *err);
void he_corners_clear(he_corners *corners);

/* Finds the face and the neighbours of corner c. `degree` must equal all->degree. It is a parameter
 * so that callers can have a loop for each degree and pass a constant, because dividing by a
 * constant is fast. */
static inline he_corner he_corner_find(const he_corners *all, uint32_t c, uint32_t degree)
{
    uint32_t face = degree != 0 ? c / degree : all->face_of[c];
    uint32_t first = degree != 0 ? face * degree : all->soup->starts[face];
    uint32_t end = degree != 0 ? first + degree : he_soup_end(all->soup, face);
    return (he_corner){face, c + 1 < end ? c + 1 : first, c > first ? c - 1 : end - 1};
}

#endif
