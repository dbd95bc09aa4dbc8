/* shape.h - THE table of shapes from which a mesh can be made.
 *
 * A row has a shape's name, its parameters, and a function that computes the numbers of vertices,
 * faces and corners from these, so that a request over a limit is refused before memory is
 * allocated. The decoding of {"shape": ...}, its documentation and the tests are driven by the
 * rows.
 *
 * All shapes are centred at the origin with z up. Solids and closed surfaces wind so that normals
 * point outwards; flat ones (grid, disk, polygon) lie in z = 0 and face up. Points that symmetry
 * puts on an axis are exactly there. */
#ifndef HE_ALGO_SHAPE_H
#define HE_ALGO_SHAPE_H

#include "build/build.h"

typedef enum he_shape_type {
    HE_SHAPE_NUMBER,  /* a finite number */
    HE_SHAPE_INTEGER, /* a number without a fraction */
    HE_SHAPE_FLAG     /* 0 or 1 */
} he_shape_type;

typedef struct he_shape_param {
    const char *name;
    he_shape_type type;
    bool exclusive; /* `min` itself is not allowed; `max` always is */
    double fallback, min, max;
    const char *doc;
} he_shape_param;

enum { HE_SHAPE_PARAMS = 4 };

typedef struct he_shape_size {
    uint64_t vertices, faces, corners;
} he_shape_size;

typedef struct he_shape {
    const char *name;
    const char *doc;
    /* The list ends at the first parameter without a name. */
    he_shape_param params[HE_SHAPE_PARAMS];
    /* Computes how many vertices, faces and corners the shape has; args[i] is the value of
     * params[i]. Only the functions declared below call it. */
    he_shape_size (*size)(const double *args);
    /* Fills the soup with the shape. If the soup's `progress` cancels the work, it returns early
     * with an incomplete soup. */
    void (*fill)(const double *args, he_soup *soup);
} he_shape;

size_t he_shape_count(void);
const he_shape *he_shape_at(size_t i);
const he_shape *he_shape_find(const char *name, size_t length); /* NULL if there is none */
size_t he_shape_params(const he_shape *shape);
void he_shape_defaults(const he_shape *shape, double args[HE_SHAPE_PARAMS]);

/* Checks the arguments of a shape. On failure `*param` (which may be NULL) is the index of the bad
 * argument.
 * Returns HE_NOT_FINITE if an argument is not finite.
 * Returns HE_BAD_VALUE if an argument is outside its range, or has a fraction where it must be
 * whole. */
HE_NODISCARD he_status he_shape_check(const he_shape *shape, const double args[HE_SHAPE_PARAMS],
                                      size_t *param, he_error *err);
/* Makes a soup of the shape, which the caller clears; he_build accepts every such soup. Returns the
 * errors of he_shape_check, too.
 * Returns HE_LIMIT if the soup would have more vertices, faces, corners or bytes than `limits`
 * allow. If `limits` is NULL, only the limits of meshes apply.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_shape_make(const he_shape *shape, const double args[HE_SHAPE_PARAMS],
                                     const he_limits *limits, he_soup *out, he_error *err);

#endif
