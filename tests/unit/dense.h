/* dense.h - meshes of many triangles for the tests of decimation, and a measure of the distance
 * between two surfaces. Any failure inside fails the test. */
#ifndef TESTS_UNIT_DENSE_H
#define TESTS_UNIT_DENSE_H

#include "tests/unit/fixture.h"

#include "algo/decimate.h"

/* Decimates the mesh with the default weight of boundaries, and checks that it is valid. */
he_decimated dense_decimate(he_mesh *m, uint32_t faces, double max_error);

/* Add a vertex and a triangle to a soup. */
uint32_t dense_add_vertex(he_soup *soup, double x, double y, double z);
void dense_add_triangle(he_soup *soup, uint32_t a, uint32_t b, uint32_t c);
he_mesh *dense_built(he_soup *takes);

/* Makes a grid of side x side cells, each of two triangles, row by row; z is `height` over the unit
 * square, or 0 if `height` is NULL. */
he_mesh *dense_grid(uint32_t side, double (*height)(double x, double y), double scale);
double dense_waves(double x, double y); /* a function for `height` */
he_mesh *dense_torus(uint32_t side);
/* Makes a primitive shape by its name, in triangles; `param` may be NULL. */
he_mesh *dense_shape(const char *name, const char *param, double value);
/* Makes the six sides of a cube, each with side x side cells. */
he_mesh *dense_cube(uint32_t side);
he_mesh *dense_copy(const he_mesh *m);

he_vec3 dense_corner(const he_mesh *m, uint32_t face, unsigned i);
/* Returns the area vector of a face, which has the direction of the normal. */
he_vec3 dense_area(const he_mesh *m, uint32_t face);

typedef struct dense_apart {
    double farthest, root_mean_square;
    uint32_t turned; /* points whose face is turned away from the face of the nearest point */
} dense_apart;

/* Measures the distances from 16 points in each face of `from` to the nearest points of `to`. */
dense_apart dense_measure(const he_mesh *from, const he_mesh *to);

#endif
