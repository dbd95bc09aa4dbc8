/* shape.h - THE table of shapes from which a mesh can be made.
 *
 * A row has a shape's name, its parameters, and the numbers of vertices, faces and corners for
 * them, so that a request over a limit is refused before memory is allocated. The decoding of
 * {"shape": ...}, its documentation and the tests are driven by the rows.
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
    bool exclusive; /* `min` is excluded; `max` is always included */
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
    he_shape_param params[HE_SHAPE_PARAMS]; /* ends at the first one without a name */
    /* Called by the functions below only, with arguments at the index of their parameter. */
    he_shape_size (*size)(const double *args);
    /* Returns early, with an incomplete soup, if the soup's watch gave up. */
    void (*fill)(const double *args, he_soup *soup);
} he_shape;

size_t he_shape_count(void);
const he_shape *he_shape_at(size_t i);
const he_shape *he_shape_find(const char *name, size_t length); /* NULL if there is none */
size_t he_shape_params(const he_shape *shape);
void he_shape_defaults(const he_shape *shape, double args[HE_SHAPE_PARAMS]);

/* Checks arguments. `*param` (which may be NULL) is the index of the one at fault.
 * Returns HE_NOT_FINITE if one is not finite.
 * Returns HE_BAD_VALUE if one is outside its range, or has a fraction where it must be whole. */
HE_NODISCARD he_status he_shape_check(const he_shape *shape, const double args[HE_SHAPE_PARAMS],
                                      size_t *param, he_error *err);
/* Makes a soup, which the caller clears; he_build accepts all of them. Fails as he_shape_check
 * does, too.
 * Returns HE_LIMIT if it would have more vertices, faces, corners or bytes than `limits` allow
 * (NULL: the structure's own).
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the watch gave up. */
HE_NODISCARD he_status he_shape_make(const he_shape *shape, const double args[HE_SHAPE_PARAMS],
                                     const he_limits *limits, he_soup *out, he_error *err);

#endif
