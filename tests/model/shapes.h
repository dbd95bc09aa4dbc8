/* shapes.h - random meshes to start from, by family: closed and open, triangles to 12-gons, with
 * handles, bow-ties, several components, isolated vertices, or empty. */
#ifndef TESTS_MODEL_SHAPES_H
#define TESTS_MODEL_SHAPES_H

#include "model/random.h"
#include "oracle/oracle.h"

/* The largest coordinate of the mesh made by md_fill_far: the sum of two such coordinates
 * overflows. */
#define MD_FAR 1.6e308

/* The following functions add vertices and faces to an empty oracle. */
/* Adds a mixture of the shapes that the functions below make; the last five functions are not
 * used. */
void md_fill_mixed(or_mesh *o, md_random *r);
void md_fill_closed_triangles(or_mesh *o, md_random *r);
void md_fill_open_triangles(or_mesh *o, md_random *r);
void md_fill_quads(or_mesh *o, md_random *r);
void md_fill_polygons(or_mesh *o, md_random *r);
void md_fill_genus_2(or_mesh *o, md_random *r);
void md_fill_components(or_mesh *o, md_random *r);
void md_fill_bowties(or_mesh *o, md_random *r);
void md_fill_fan_1000(or_mesh *o, md_random *r);
void md_fill_triangle(or_mesh *o, md_random *r);
void md_fill_doubled_square(or_mesh *o, md_random *r);
void md_fill_tetrahedron(or_mesh *o, md_random *r);
void md_fill_far(or_mesh *o, md_random *r);

/* Fills an empty oracle by `fill`. Edges get the ids that he_build promises: they are numbered in
 * the order in which faces name them, and directed as in the first face that has them. */
void md_shape(or_mesh *o, md_random *r, void (*fill)(or_mesh *, md_random *));
/* Builds hedge's mesh from the oracle by he_build; returns NULL if he_build refuses. */
he_mesh *md_build(const or_mesh *o);

#endif
