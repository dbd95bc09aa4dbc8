/* solid.h - fills soups, whose arrays are large enough already, with the five regular solids and
 * the icosphere. `radius` is that of the sphere through the vertices. Only shape.c uses it. */
#ifndef HE_ALGO_SOLID_H
#define HE_ALGO_SOLID_H

#include "build/build.h"

/* Reports to the soup's `progress` how full the soup is. A function that fills a soup calls it
 * before each row of vertices or faces. Returns false if the work was cancelled. */
bool he_solid_goes_on(const he_soup *soup);
/* Appends a vertex to a soup that has room. */
void he_solid_vertex(he_soup *soup, double x, double y, double z);
void he_solid_face(he_soup *soup, const uint32_t *corners, size_t count);

void he_solid_tetrahedron(he_soup *soup, double radius);
void he_solid_cube(he_soup *soup, double size); /* `size` is the length of each edge of the cube */
void he_solid_octahedron(he_soup *soup, double radius);
void he_solid_icosahedron(he_soup *soup, double radius);
void he_solid_dodecahedron(he_soup *soup, double radius);

/* Divides each triangle of the icosahedron into 4^subdivisions: edges are halved and the new points
 * moved to the sphere, repeatedly. Vertices: 10 * 4^subdivisions + 2. */
void he_solid_icosphere(he_soup *soup, unsigned subdivisions, double radius);

#endif
