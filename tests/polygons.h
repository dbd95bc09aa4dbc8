/* polygons.h - polygons of any number of corners that are hard to triangulate. */
#ifndef TESTS_POLYGONS_H
#define TESTS_POLYGONS_H

#include "mesh/mesh.h"

#include <stdbool.h>

typedef struct polygon_shape {
    const char *name;
    bool simple; /* no two sides touch or cross, except neighbours at their common corner */
    /* Writes the positions of n corners, counter-clockwise, with z = 0; n must be even and at least
     * 64. */
    void (*make)(uint32_t n, he_vec3 *out);
} polygon_shape;

extern const polygon_shape polygon_shapes[];
extern const unsigned polygon_shape_count;

/* Makes a mesh of one face with these corners; returns NULL if memory is out. */
he_mesh *polygon_mesh(const he_vec3 *points, uint32_t n);

#endif
