/* off_values.h - what an OFF file says of vertices and faces besides positions and corners: the
 * same in text and in binary. */
#ifndef HE_FORMAT_OFF_OFF_VALUES_H
#define HE_FORMAT_OFF_OFF_VALUES_H

#include "format/io/colors.h"
#include "format/io/format.h"

/* What the header announces for each vertex, in a set. */
enum { HE_OFF_NORMALS = 1, HE_OFF_COLORS = 2, HE_OFF_UV = 4 };

/* {.into = ...} is empty. */
typedef struct he_off_values {
    he_import *into;
    he_colors vertex_colors, face_colors;
    he_column *normal, *uv; /* the soup's */
} he_off_values;

void he_off_values_clear(he_off_values *values);
/* The normal (3 numbers) and texture coordinates (2) of the last vertex. Return HE_NO_MEMORY. */
HE_NODISCARD he_status he_off_add_normal(he_off_values *values, const double *normal,
                                         he_error *err);
HE_NODISCARD he_status he_off_add_uv(he_off_values *values, const double *uv, he_error *err);
/* When all vertices and faces are read. HE_NO_MEMORY. */
HE_NODISCARD he_status he_off_values_finish(const he_off_values *values, he_error *err);

#endif
