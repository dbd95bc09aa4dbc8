/* export.h - what writers need of a mesh: vertices without gaps in their numbers, values
 * of attributes as text, and a list of what is left behind. */
#ifndef HE_FORMAT_IO_EXPORT_H
#define HE_FORMAT_IO_EXPORT_H

#include "format/text/notes.h"
#include "mesh/walk.h"

#include <float.h>
#include <math.h>

/* The nearest float, the largest one where the value is beyond it. Volatile, for gcc 12.2 leaves
 * the rounding out where it narrows and widens two values side by side. */
static inline float he_narrow(double value)
{
    volatile float narrow = (float)fmin(fmax(value, -(double)FLT_MAX), (double)FLT_MAX);
    return narrow;
}
/* Does a float hold the value exactly? */
static inline bool he_is_float(double value)
{
    return (double)he_narrow(value) == value;
}
static inline bool he_are_floats(he_vec3 p)
{
    return he_is_float(p.x) && he_is_float(p.y) && he_is_float(p.z);
}

/* What becomes of positions that are written as floats. {0} begins. */
typedef struct he_narrowed {
    uint64_t rounded, beyond; /* positions: not exactly floats; larger than the largest one */
    uint32_t first;           /* vertex of those beyond */
} he_narrowed;

void he_narrowed_add(he_narrowed *narrowed, uint32_t vertex, he_vec3 position);
/* Note what is rounded, or fail with HE_BEYOND_FLOAT and the first vertex. */
HE_NODISCARD he_status he_narrowed_finish(const he_narrowed *narrowed, he_notes *notes,
                                          he_error *err);

/* The number of each vertex among the live ones, NULL when that is its id. HE_NO_MEMORY. */
HE_NODISCARD he_status he_export_numbers(const he_mesh *mesh, uint32_t **out, he_error *err);

/* The attribute when it exists as numbers with `least` to `most` components, else NULL. Values
 * that are not finite are noted; they are written as 0. */
const he_column *he_export_find(const he_mesh *mesh, he_kind domain, const char *name,
                                uint32_t least, uint32_t most, he_notes *notes);
/* Note every attribute that is not among the `count` used ones (NULLs are allowed). */
void he_export_note_lost(const he_mesh *mesh, const he_column *const *used, size_t count,
                         he_notes *notes);

/* Note that the table of materials is left behind, where the mesh has one. */
void he_export_note_materials(const he_mesh *mesh, he_notes *notes);

/* One component; 0 in place of a value that is not finite. */
double he_export_number(const he_column *column, size_t row, uint32_t component);
/* These write to `to` without a NUL and return the end. A text of any length, */
char *he_export_text(const char *text, char *to);
/* one component, at most HE_NUMBER_TEXT bytes, */
char *he_export_value(const he_column *column, size_t row, uint32_t component, char *to);
/* a blank and a value for each component. */
char *he_export_row(const he_column *column, size_t row, char *to);

/* What corners say, told apart bit by bit and numbered in the order of faces, so that each is
 * written once. */
typedef struct he_distinct {
    uint32_t *number; /* of the value of each half-edge that has a face */
    he_ids first;     /* for each number, a half-edge that has it */
} he_distinct;

/* They say what all of the `count` columns have; with `apart` also at which vertex they are. */
HE_NODISCARD he_status he_distinct_make(const he_mesh *mesh, const he_column *const *columns,
                                        size_t count, bool apart, he_watch *watch, he_distinct *out,
                                        he_error *err);
void he_distinct_clear(he_distinct *distinct);

#endif
