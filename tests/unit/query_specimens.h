/* query_specimens.h - the meshes on which the tests try every query. */
#ifndef TESTS_UNIT_QUERY_SPECIMENS_H
#define TESTS_UNIT_QUERY_SPECIMENS_H

#include "fixture.h"

#include "algo/shape.h"
#include "mesh/write.h"

/* query_specimens[] has, in this order: an empty mesh, closed and open meshes, a bow-tie, isolated
 * vertices, polygons, faces that share two edges, two components, two components that touch at a
 * vertex, a mesh of genus 1, and a strip through all corners of a cube. */
enum { QUERY_SPECIMENS = 16 };
extern const char *const query_specimens[QUERY_SPECIMENS];

/* Deletes the component that consists of all vertices, edges and faces with at least these ids: the
 * mesh then has array entries of deleted elements. */
void query_bury(he_mesh *m, uint32_t vertex, uint32_t edge, uint32_t face);

/* Makes a mesh of two triangles and an isolated vertex, and deletes the second triangle. */
he_mesh *query_with_dead_rows(void);

/* Makes the primitive shape `name`, whose first four parameters are a, b, c and d; the caller must
 * free the mesh. */
he_mesh *query_shape(const char *name, double a, double b, double c, double d);

/* Returns a pseudo-random number (SplitMix64); equal seeds give equal numbers on every machine. */
uint64_t query_random(uint64_t *seed);

/* Returns a pseudo-random number from `low` up to `high`. */
double query_uniform(uint64_t *seed, double low, double high);
/* Returns a point whose coordinates are pseudo-random numbers from -reach up to `reach`. */
he_vec3 query_random_point(uint64_t *seed, double reach);
/* Makes a mesh with vertices at random positions, so that faces intersect and polygons are not
 * planar. The caller must free the mesh. */
he_mesh *query_tangle(uint64_t *seed);

/* Corrupts one random link of a mesh: sets it to the id of a wrong or deleted element, to null, or
 * to an id out of range. */
void query_spoil(he_mesh *m, uint64_t *seed);

#endif
