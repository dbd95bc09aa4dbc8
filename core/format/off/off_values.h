/* off_values.h - the attributes of vertices and faces in OFF files, text and binary. */
#ifndef HE_FORMAT_OFF_OFF_VALUES_H
#define HE_FORMAT_OFF_OFF_VALUES_H

#include "format/io/colors.h"
#include "format/io/format.h"

/* Flags that say which values each vertex has, according to the header of an OFF file. */
enum { HE_OFF_NORMALS = 1, HE_OFF_COLORS = 2, HE_OFF_UV = 4 };

/* {.into = ...} is empty. */
typedef struct he_off_values {
    he_import *into;
    he_colors vertex_colors, face_colors;
    he_column *normal, *uv; /* borrowed from the soup */
} he_off_values;

void he_off_values_clear(he_off_values *values);
/* These functions add a value of the last vertex: its normal (3 numbers) or its texture coordinates
 * (2 numbers).
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_off_add_normal(he_off_values *values, const double *normal,
                                         he_error *err);
HE_NODISCARD he_status he_off_add_uv(he_off_values *values, const double *uv, he_error *err);
/* Makes the attributes, after all vertices and faces are read.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_off_values_finish(const he_off_values *values, he_error *err);

#endif
