/* parts.h - what random meshes are put together from: vertices anywhere in a small box, and faces
 * of them. */
#ifndef TESTS_MODEL_PARTS_H
#define TESTS_MODEL_PARTS_H

#include "model/random.h"
#include "oracle/oracle.h"

/* How many; the first. */
uint32_t md_add_vertices(or_mesh *o, md_random *r, uint32_t n);
/* A face of the vertices from `first` on, in order or backwards. */
void md_add_row(or_mesh *o, uint32_t first, uint32_t n, bool backwards);

/* Of 3 to 12 sides. */
void md_add_polygon(or_mesh *o, md_random *r, bool both_sides);
/* Two rings of 3 to 12. Of a hundred quads between them `triangles` are two triangles, of a hundred
 * caps `caps` are there. */
void md_add_prism(or_mesh *o, md_random *r, uint32_t triangles, uint32_t caps);
/* A fan about a vertex, closed below by another fan (0), by a polygon (1), or not. */
void md_add_pyramid(or_mesh *o, md_random *r, uint32_t below);
/* Polygons that share nothing but one vertex. */
void md_add_bowtie(or_mesh *o, md_random *r);

/* Cells of a grid, either direction of which may wrap: sheet, tube or torus. The white squares of a
 * checkerboard are missing. */
typedef struct md_sheet {
    uint32_t columns, rows;
    bool wrap_x, wrap_y, board;
    uint32_t triangles; /* cells in a hundred that are two */
} md_sheet;

void md_add_grid(or_mesh *o, md_random *r, md_sheet sheet);

#endif
