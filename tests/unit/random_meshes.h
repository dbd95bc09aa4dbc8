/* random_meshes.h - random meshes of triangles for the tests of operations on whole meshes: rough
 * scans, shapes with sharp edges, sheets with holes, bow-ties, slivers, meshes far from the origin,
 * and fans of many triangles. */
#ifndef TESTS_UNIT_RANDOM_MESHES_H
#define TESTS_UNIT_RANDOM_MESHES_H

#include "mesh/mesh.h"
#include "model/random.h"

typedef struct random_family {
    const char *name;
    he_mesh *(*make)(md_random *r);
} random_family;

enum { RANDOM_FAMILIES = 7 };
extern const random_family random_families[RANDOM_FAMILIES];

/* Moves each vertex by up to `size` in each direction, unless it would leave the range of a double.
 */
void random_shake(he_mesh *m, md_random *r, double size);

/* Adds random marks and attributes. */
void random_decorate(he_mesh *m, md_random *r);

#endif
