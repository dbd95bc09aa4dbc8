/* input.h - the input meshes of the benchmark, made by the same code in every program: plain arrays
 * of positions and corners.
 *
 *     torus    bumpy, 2 * side * side triangles, closed
 *     grid     side * side quads, with a boundary
 *     holes    the grid less one face in a hundred
 *     pieces   64 tori, together about as many triangles as the torus
 *     roofs    a sheet of 2 * side * side triangles, folded to 32 by 32 flat patches
 *
 * In natural order the elements are numbered row by row; in shuffled order the ids of vertices and
 * faces are permuted at random. Coordinates are floats widened to doubles, so that no file format
 * rounds them. */
#ifndef TESTS_BENCH_SIDE_INPUT_H
#define TESTS_BENCH_SIDE_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct bench_input {
    double *positions; /* three coordinates for each vertex */
    uint32_t *corners; /* corners of all faces, one face after the other */
    uint32_t *starts;  /* first corner of each face */
    uint32_t vertices, faces, degree;
} bench_input;

/* Makes the input `name`. Ends the program, and prints a reason, if there is no such input or
 * memory is out. */
void bench_input_make(const char *name, bool shuffled, uint32_t side, bench_input *out);
void bench_input_clear(bench_input *input);

/* Makes a list of picks, the half-edges where edits are made, in a random order that is equal in
 * every program. A pick is a face and the index of the corner that the half-edge leaves; no two
 * picks are on one edge. `count` is the number of picks for a mesh of 1,048,352 faces; for a
 * smaller mesh the number is reduced in proportion. The caller must free the list. */
typedef struct bench_pick {
    uint32_t face, corner;
} bench_pick;

bench_pick *bench_picks(const bench_input *input, uint32_t *count);

/* Returns a hash of a face. The sum over all faces is equal for two meshes that have the same
 * faces, whatever the order of the faces and the first corner of each. */
uint64_t bench_face_hash(const uint32_t *vertices, size_t degree);
/* Returns a hash of a vertex's position; with it, meshes whose vertex ids differ can be
 * compared. */
uint32_t bench_place_hash(double x, double y, double z);

#endif
