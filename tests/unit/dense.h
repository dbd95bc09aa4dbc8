/* dense.h - meshes of many triangles to decimate, and the distance between two surfaces. Any
 * failure fails the test. */
#ifndef TESTS_UNIT_DENSE_H
#define TESTS_UNIT_DENSE_H

#include "tests/unit/fixture.h"

#include "algo/decimate.h"

/* Decimates with the default weight of boundaries, and checks the mesh. */
he_decimated dense_decimate(he_mesh *m, uint32_t faces, double max_error);

/* Build one soup, corner by corner. */
uint32_t dense_add_vertex(he_soup *soup, double x, double y, double z);
void dense_add_triangle(he_soup *soup, uint32_t a, uint32_t b, uint32_t c);
he_mesh *dense_built(he_soup *takes);

/* Makes a grid of cells of two triangles, row by row, with z = `height` over the unit square, or
 * flat. */
he_mesh *dense_grid(uint32_t side, double (*height)(double x, double y), double scale);
double dense_waves(double x, double y); /* a height function */
he_mesh *dense_torus(uint32_t side);
/* Makes a shape of the table, in triangles; `param` may be NULL. */
he_mesh *dense_shape(const char *name, const char *param, double value);
/* Makes the six sides of a cube of edge `side`, each with side by side cells. */
he_mesh *dense_cube(uint32_t side);
he_mesh *dense_copy(const he_mesh *m);

he_vec3 dense_corner(const he_mesh *m, uint32_t face, unsigned i);
/* Returns the area vector, which has the direction of the normal. */
he_vec3 dense_area(const he_mesh *m, uint32_t face);

typedef struct dense_apart {
    double farthest, root_mean_square;
    uint32_t turned; /* samples whose face looks away from the face of the nearest point */
} dense_apart;

/* Measures from 16 points in each face of `from` to the nearest points of `to`. */
dense_apart dense_measure(const he_mesh *from, const he_mesh *to);

#endif
