/* parts.h - pieces of random meshes: vertices in a small box, and faces between them. */
#ifndef TESTS_MODEL_PARTS_H
#define TESTS_MODEL_PARTS_H

#include "model/random.h"
#include "oracle/oracle.h"

/* Adds n vertices to the oracle at random places; returns the id of the first. */
uint32_t md_add_vertices(or_mesh *o, md_random *r, uint32_t n);
/* Adds a face whose corners are the n vertices from `first` on, in this order or backwards. */
void md_add_row(or_mesh *o, uint32_t first, uint32_t n, bool backwards);

/* Adds a polygon of 3 to 12 sides, as one face, or as two faces of opposite orientation that share
 * all edges. */
void md_add_polygon(or_mesh *o, md_random *r, bool both_sides);
/* Adds a prism over a polygon of 3 to 12 sides. A quad is split into triangles with a probability
 * of `triangles` percent, and a cap exists with a probability of `caps` percent. */
void md_add_prism(or_mesh *o, md_random *r, uint32_t triangles, uint32_t caps);
/* Adds a fan of triangles around a vertex. `below` says what closes the fan on its other side:
 * another fan (0), a polygon (1), or nothing. */
void md_add_pyramid(or_mesh *o, md_random *r, uint32_t below);
/* Adds polygons that share one vertex and nothing else. */
void md_add_bowtie(or_mesh *o, md_random *r);

/* A grid of cells that may wrap around in each direction, so that it is a sheet, a tube or a torus.
 * In a checkerboard the white squares are missing. */
typedef struct md_sheet {
    uint32_t columns, rows;
    bool wrap_x, wrap_y, board;
    uint32_t triangles; /* percentage of the cells that consist of two triangles */
} md_sheet;

void md_add_grid(or_mesh *o, md_random *r, md_sheet sheet);

#endif
