/* colors.h - colours: in a mesh three or four numbers from 0 to 1, in files also bytes.
 *
 * A mesh's colours are its attributes "color" (from glTF also color1 and so on) of float or double;
 * 1 is full intensity, and a byte k means k / 255. So bytes are written back as they were read.
 *
 * READING. In a text format a colour is three or four numbers, and some elements may have none. The
 * numbers count from 0 to 255 if the format distinguishes integers from fractions and all of them
 * are integers; or, with a warning, if all numbers but alphas are whole and one is above 1. Numbers
 * above 255 then mean full intensity. The attribute has doubles, in four components if any colour
 * is not opaque; a colour without an alpha is opaque. Elements without a colour get zeros. */
#ifndef HE_FORMAT_IO_COLORS_H
#define HE_FORMAT_IO_COLORS_H

#include "build/build.h"
#include "format/io/export.h"

/* {0} is empty. */
typedef struct he_colors {
    double (*rows)[4];
    size_t count, capacity; /* count: how many elements (vertices or faces) are in the list, from
                             * the first to the last that has a colour */
    size_t given;           /* number of elements that have a colour */
    /* True if the format does not distinguish integers, or some number was not an integer. */
    bool fractions;
    bool broken;    /* true if a number other than an alpha is not whole */
    double highest; /* highest of all numbers other than alphas */
} he_colors;

void he_colors_clear(he_colors *colors);
/* Adds the colour of an element (a vertex or a face). Elements must come in order; those without a
 * colour are left out. `count` is the number of values, 3 or 4.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_colors_add(he_colors *colors, size_t element, const double *values,
                                     size_t count, he_error *err);
/* Makes the colour attribute of the vertices or faces, of which there are `elements`, if any of
 * them has a colour. */
HE_NODISCARD he_status he_colors_finish(const he_colors *colors, he_soup *soup,
                                        he_warnings *warnings, he_kind domain, size_t elements,
                                        he_error *err);

/* Returns the attribute of colours that is to be written; NULL unless its values are three or
 * four floats or doubles. */
const he_column *he_colors_find(const he_mesh *mesh, he_kind domain, he_warnings *warnings);
/* Returns the byte that is nearest to a colour component between 0 and 1. */
uint32_t he_color_byte(double component);
/* Returns true if the component equals its nearest byte, to the precision of a float. */
bool he_color_is_byte(double component);
/* Returns true if bytes can represent all colours exactly. Sets *lost to the number of colours that
 * they cannot represent. */
bool he_colors_are_bytes(const he_mesh *mesh, const he_column *column, uint64_t *lost);

#endif
