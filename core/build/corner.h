/* corner.h - the corners of a soup's faces by their numbers. For core/mesh only. */
#ifndef HE_BUILD_CORNER_H
#define HE_BUILD_CORNER_H

#include "build/build.h"
#include "build/pair.h"

typedef struct he_corners {
    const he_soup *soup;
    uint32_t degree;   /* of all faces where that is 3 or 4, else 0 */
    uint32_t *face_of; /* of each corner where `degree` is 0, else NULL */
} he_corners;

typedef struct he_corner {
    uint32_t face, next, prev; /* the corners beside it in its face */
} he_corner;

HE_NODISCARD he_status he_corners_init(const he_soup *soup, he_corners *out, he_error *err);
void he_corners_clear(he_corners *corners);

/* `degree` is that of `all`, but a constant where a caller has a loop for each: to divide by. */
static inline he_corner he_corner_find(const he_corners *all, uint32_t c, uint32_t degree)
{
    uint32_t face = degree != 0 ? c / degree : all->face_of[c];
    uint32_t first = degree != 0 ? face * degree : all->soup->starts[face];
    uint32_t end = degree != 0 ? first + degree : he_soup_end(all->soup, face);
    return (he_corner){face, c + 1 < end ? c + 1 : first, c > first ? c - 1 : end - 1};
}

#endif
