/* polygons.h - polygons of any number of corners that are hard to triangulate. */
#ifndef TESTS_POLYGONS_H
#define TESTS_POLYGONS_H

#include "mesh/mesh.h"

#include <stdbool.h>

typedef struct polygon_shape {
    const char *name;
    bool simple; /* without a point that lies on two of its sides, other than its corners */
    /* The places of n corners, counter-clockwise; z stays 0. n is at least 64 and even. */
    void (*make)(uint32_t n, he_vec3 *out);
} polygon_shape;

extern const polygon_shape polygon_shapes[];
extern const unsigned polygon_shape_count;

/* A mesh of one face over the points; NULL without memory. */
he_mesh *polygon_mesh(const he_vec3 *points, uint32_t n);

#endif
