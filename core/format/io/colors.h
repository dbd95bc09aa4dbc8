/* colors.h - colours: in a mesh three or four numbers of 0 to 1, in files those or bytes.
 *
 * A mesh's colours are its attributes "color" (of glTF color1 and so on, too) of float or double;
 * 1 is full, and what a byte says is k / 255. So bytes come back from a mesh as they were.
 *
 * READING of text formats: three or four numbers, on some elements. They count from 0 to 255 when
 * the format tells integers from fractions and all of them were integers; or, with a note, when all
 * but alphas are whole and one is above 1. What is above 255 is full then. The attribute is of
 * double, and has four components when any colour is not opaque; those without an alpha are.
 * Elements without a colour get zeros. */
#ifndef HE_FORMAT_IO_COLORS_H
#define HE_FORMAT_IO_COLORS_H

#include "build/build.h"
#include "format/io/export.h"

/* {0} is empty. */
typedef struct he_colors {
    double (*rows)[4];
    size_t count, capacity; /* rows; elements beyond have no colour */
    size_t given;
    bool fractions; /* the format has no integers, or one was none */
    bool broken;    /* a number other than an alpha has a fraction */
    double highest; /* of all numbers but alphas */
} he_colors;

void he_colors_clear(he_colors *colors);
/* Elements in order, some left out. `count` is 3 or 4. HE_NO_MEMORY. */
HE_NODISCARD he_status he_colors_add(he_colors *colors, size_t element, const double *values,
                                     size_t count, he_error *err);
/* Make the attribute for `elements` elements, if any had a colour. */
HE_NODISCARD he_status he_colors_finish(const he_colors *colors, he_soup *soup, he_notes *notes,
                                        he_kind domain, size_t elements, he_error *err);

/* The colours that a writer finds: an attribute of floats or doubles with three or four components,
 * else NULL. */
const he_column *he_colors_find(const he_mesh *mesh, he_kind domain, he_notes *notes);
/* The byte nearest to a component, */
uint32_t he_color_byte(double component);
/* and whether that is what it says, to the precision of a float. */
bool he_color_is_byte(double component);
/* Do bytes say all of the colours? `lost` counts the rows of which they do not. */
bool he_colors_are_bytes(const he_mesh *mesh, const he_column *column, uint64_t *lost);

#endif
