/* dense.h - meshes of many triangles for the tests of decimation, and a measure of the distance
 * between two surfaces. If a function fails, the test fails. */
#ifndef TESTS_UNIT_DENSE_H
#define TESTS_UNIT_DENSE_H

#include "tests/unit/fixture.h"

#include "algo/decimate.h"

/* Decimates the mesh with the default weight of boundaries, and checks that the result is valid. */
he_decimated dense_decimate(he_mesh *m, uint32_t faces, double max_error);

/* dense_add_vertex() and dense_add_triangle() add one vertex or one triangle to a soup (a list of
 * unconnected faces). */
uint32_t dense_add_vertex(he_soup *soup, double x, double y, double z);
void dense_add_triangle(he_soup *soup, uint32_t a, uint32_t b, uint32_t c);
he_mesh *dense_built(he_soup *takes);

/* Makes a grid of side x side square cells, each divided into two triangles. The height of a point
 * is height(x, y) for x and y from 0 to 1, or 0 if `height` is NULL; all coordinates are multiplied
 * by `scale`. */
he_mesh *dense_grid(uint32_t side, double (*height)(double x, double y), double scale);
double dense_waves(double x, double y); /* a height function with waves, for dense_grid() */
he_mesh *dense_torus(uint32_t side);
/* Makes the primitive shape `name` as a mesh of triangles. Sets its parameter `param` to `value`
 * unless `param` is NULL. */
he_mesh *dense_shape(const char *name, const char *param, double value);
/* Makes a closed cube; each of the six sides has side x side cells of two triangles. */
he_mesh *dense_cube(uint32_t side);
he_mesh *dense_copy(const he_mesh *m);

bool dense_same_point(he_vec3 a, he_vec3 b); /* returns true if two points have the same bits */
he_vec3 dense_corner(const he_mesh *m, uint32_t face, unsigned i);
/* Returns the vector that has the direction of the face's normal and the face's area as length. */
he_vec3 dense_area(const he_mesh *m, uint32_t face);

typedef struct dense_apart {
    double farthest, root_mean_square;
    /* number of measured points where the faces of the two meshes look in opposite directions */
    uint32_t turned;
} dense_apart;

/* Measures the distances from 16 points in each face of `from` to the nearest points of `to`. */
dense_apart dense_measure(const he_mesh *from, const he_mesh *to);

#endif
