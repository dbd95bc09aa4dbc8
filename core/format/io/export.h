/* export.h - functions for writers of files: vertices numbered without gaps, values of attributes
 * as text, and warnings about what cannot be written. */
#ifndef HE_FORMAT_IO_EXPORT_H
#define HE_FORMAT_IO_EXPORT_H

#include "format/text/warnings.h"
#include "mesh/walk.h"

#include <float.h>
#include <math.h>

/* Returns the float nearest to a value; the largest float, with the sign of the value, if the
 * value is beyond it. The variable is volatile because gcc 12.2 omits the rounding if it narrows
 * and widens two values side by side. */
static inline float he_narrow(double value)
{
    volatile float narrow = (float)fmin(fmax(value, -(double)FLT_MAX), (double)FLT_MAX);
    return narrow;
}
/* Returns true if a float can hold the value exactly. */
static inline bool he_is_float(double value)
{
    return (double)he_narrow(value) == value;
}
static inline bool he_are_floats(he_vec3 p)
{
    return he_is_float(p.x) && he_is_float(p.y) && he_is_float(p.z);
}

/* Counts of the positions that change when they are written as floats. The caller initialises the
 * struct with {0}. */
typedef struct he_narrowed {
    uint64_t rounded, beyond; /* `rounded` counts the positions that no floats represent exactly,
                                 `beyond` those beyond the largest float */
    uint32_t first;           /* first vertex of those beyond */
} he_narrowed;

void he_narrowed_add(he_narrowed *narrowed, uint32_t vertex, he_vec3 position);
/* Adds a warning about the positions that were rounded, if there are any.
 * Returns HE_BEYOND_FLOAT, naming the first vertex, if a position is beyond the largest float. */
HE_NODISCARD he_status he_narrowed_finish(const he_narrowed *narrowed, he_warnings *warnings,
                                          he_error *err);

/* Computes the number of each vertex among the live vertices; *out is NULL if every vertex's number
 * is its id.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_export_numbers(const he_mesh *mesh, uint32_t **out, he_error *err);

/* Finds an attribute by its name. Returns NULL if there is none, or if its values are not numbers
 * with `least` to `most` components. Values that are not finite get a warning; they are written as
 * 0. */
const he_column *he_export_find(const he_mesh *mesh, he_kind domain, const char *name,
                                uint32_t least, uint32_t most, he_warnings *warnings);
/* Adds a warning for every attribute that is not among the `count` columns that are written, some
 * of which may be NULL. */
void he_export_note_lost(const he_mesh *mesh, const he_column *const *used, size_t count,
                         he_warnings *warnings);

/* Adds a warning that the table of materials is not written, if the mesh has one. */
void he_export_note_materials(const he_mesh *mesh, he_warnings *warnings);

/* Returns one component of an attribute's value as a double; 0 in place of a value that is not
 * finite. */
double he_export_number(const he_column *column, size_t row, uint32_t component);
/* Copies a text of any length to `to`, without its NUL, and returns the end of the copy. */
char *he_export_text(const char *text, char *to);
/* Writes one component of an attribute's value to `to`, at most HE_NUMBER_TEXT bytes, and
 * returns the end of this text. */
char *he_export_value(const he_column *column, size_t row, uint32_t component, char *to);
/* Writes to `to`, for each component of one element's value, a blank and a number, and returns the
 * end of this text. */
char *he_export_row(const he_column *column, size_t row, char *to);

/* The distinct values of attributes at all corners, compared bit by bit and numbered in the order
 * of faces, so that each is written to a file only once. */
typedef struct he_distinct {
    uint32_t *number; /* number of the value at the corner of each half-edge that has a face */
    he_ids first;     /* the first half-edge with each value, by the value's number */
} he_distinct;

/* Finds the distinct combinations of values in the `count` columns. If `apart` is true, values of
 * corners at different vertices always count as distinct. */
HE_NODISCARD he_status he_distinct_make(const he_mesh *mesh, const he_column *const *columns,
                                        size_t count, bool apart, he_progress *progress,
                                        he_distinct *out, he_error *err);
void he_distinct_clear(he_distinct *distinct);

#endif
