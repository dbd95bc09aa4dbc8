/* export.h - functions for writers: vertices numbered without gaps, values of attributes as text,
 * and notes of what cannot be written. */
#ifndef HE_FORMAT_IO_EXPORT_H
#define HE_FORMAT_IO_EXPORT_H

#include "format/text/notes.h"
#include "mesh/walk.h"

#include <float.h>
#include <math.h>

/* Returns the nearest float, the largest one if the value is beyond it. Volatile, because gcc 12.2
 * omits the rounding if it narrows and widens two values side by side. */
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

/* Counts positions that are changed by writing them as floats. {0} begins. */
typedef struct he_narrowed {
    uint64_t rounded, beyond; /* positions that are no floats; positions beyond the largest float */
    uint32_t first;           /* first vertex of those beyond */
} he_narrowed;

void he_narrowed_add(he_narrowed *narrowed, uint32_t vertex, he_vec3 position);
/* Notes the rounded positions.
 * Returns HE_BEYOND_FLOAT, naming the first vertex, if a position is beyond the largest float. */
HE_NODISCARD he_status he_narrowed_finish(const he_narrowed *narrowed, he_notes *notes,
                                          he_error *err);

/* Computes the number of each vertex among the live ones; *out is NULL if that is its id.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_export_numbers(const he_mesh *mesh, uint32_t **out, he_error *err);

/* Finds the attribute if it is of numbers with `least` to `most` components, else returns NULL.
 * Values that are not finite are noted; they are written as 0. */
const he_column *he_export_find(const he_mesh *mesh, he_kind domain, const char *name,
                                uint32_t least, uint32_t most, he_notes *notes);
/* Notes every attribute that is not among the `count` used ones (NULLs are allowed) as lost. */
void he_export_note_lost(const he_mesh *mesh, const he_column *const *used, size_t count,
                         he_notes *notes);

/* Notes that the table of materials is lost, if the mesh has one. */
void he_export_note_materials(const he_mesh *mesh, he_notes *notes);

/* Returns one component; 0 in place of a value that is not finite. */
double he_export_number(const he_column *column, size_t row, uint32_t component);
/* These write to `to` without a NUL and return the end: a text of any length, */
char *he_export_text(const char *text, char *to);
/* one component, at most HE_NUMBER_TEXT bytes, */
char *he_export_value(const he_column *column, size_t row, uint32_t component, char *to);
/* a blank and a value for each component. */
char *he_export_row(const he_column *column, size_t row, char *to);

/* The distinct values of corners, compared bit by bit and numbered in the order of faces, so that
 * each is written once. */
typedef struct he_distinct {
    uint32_t *number; /* number of the value of each half-edge that has a face */
    he_ids first;     /* for each number, a half-edge that has it */
} he_distinct;

/* Finds the distinct combinations of values in the `count` columns; with `apart` corners of
 * different vertices always differ. */
HE_NODISCARD he_status he_distinct_make(const he_mesh *mesh, const he_column *const *columns,
                                        size_t count, bool apart, he_watch *watch, he_distinct *out,
                                        he_error *err);
void he_distinct_clear(he_distinct *distinct);

#endif
