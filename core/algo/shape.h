/* shape.h - THE table of shapes a mesh can be made as.
 *
 * A row says what a shape is called, what may be asked of it, and how many vertices, faces and
 * corners that gives, so that a request over a limit is refused before memory is taken for it. From
 * the rows come the decoding of {"shape": ...}, its documentation, and the tests.
 *
 * All shapes are centred at the origin with z up. Solids and closed surfaces wind so that normals
 * point outwards; flat ones (grid, disk, polygon) lie in z = 0 and face up. Points that symmetry
 * puts on an axis are exactly there. */
#ifndef HE_ALGO_SHAPE_H
#define HE_ALGO_SHAPE_H

#include "build/build.h"

typedef enum he_shape_type {
    HE_SHAPE_NUMBER,  /* finite */
    HE_SHAPE_INTEGER, /* a number without a fraction */
    HE_SHAPE_FLAG     /* 0 or 1 */
} he_shape_type;

typedef struct he_shape_param {
    const char *name;
    he_shape_type type;
    bool exclusive; /* `min` is not in the range; `max` always is */
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
    he_shape_param params[HE_SHAPE_PARAMS]; /* ends at the first without a name */
    /* Call through the functions below, with arguments at the index of their parameter. */
    he_shape_size (*size)(const double *args);
    /* Returns early, with whatever it has, once the soup's watch has given up. */
    void (*fill)(const double *args, he_soup *soup);
} he_shape;

size_t he_shape_count(void);
const he_shape *he_shape_at(size_t i);
const he_shape *he_shape_find(const char *name, size_t length); /* NULL when there is none */
size_t he_shape_params(const he_shape *shape);
void he_shape_defaults(const he_shape *shape, double args[HE_SHAPE_PARAMS]);

/* HE_NOT_FINITE, or HE_BAD_VALUE outside a parameter's range or with a fraction where none may be.
 * `*param` (which may be NULL) is the index of the one at fault. */
HE_NODISCARD he_status he_shape_check(const he_shape *shape, const double args[HE_SHAPE_PARAMS],
                                      size_t *param, he_error *err);
/* The soup is the caller's to clear, and he_build refuses none of them. As he_shape_check; HE_LIMIT
 * when it would have more vertices, faces, corners or bytes than `limits` (NULL: than the
 * structure) allows, HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_shape_make(const he_shape *shape, const double args[HE_SHAPE_PARAMS],
                                     const he_limits *limits, he_soup *out, he_error *err);

#endif
