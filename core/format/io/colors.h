/* colors.h - colours as text formats give them: three or four numbers, on some elements.
 *
 * The numbers are kept as written. They become the attribute "color", of uint32 when the format
 * tells integers (0 to 255) from fractions and all of them were integers, else of double (0 to 1).
 * It has four components when any colour had an alpha; the others get an opaque one. Elements
 * without a colour get zeros. */
#ifndef HE_FORMAT_IO_COLORS_H
#define HE_FORMAT_IO_COLORS_H

#include "build/build.h"

/* {0} is empty. */
typedef struct he_colors {
    double (*rows)[4];
    size_t count, capacity; /* rows; elements beyond have no colour */
    size_t given;
    bool alpha, fractions;
} he_colors;

void he_colors_clear(he_colors *colors);
/* Elements in order, some left out. `count` is 3 or 4. Unless the caller sets `fractions`, all
 * values must be integers that fit 32 bits. HE_NO_MEMORY. */
HE_NODISCARD he_status he_colors_add(he_colors *colors, size_t element, const double *values,
                                     size_t count, he_error *err);
/* Make the attribute for `elements` elements, if any had a colour. */
HE_NODISCARD he_status he_colors_finish(const he_colors *colors, he_soup *soup, he_kind domain,
                                        size_t elements, he_error *err);

#endif
