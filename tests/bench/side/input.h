/* input.h - the meshes that both sides of the bench are measured on, made the same way in every
 * program: plain arrays of positions and corners.
 *
 *     torus    bumpy, 2 * side * side triangles, closed
 *     grid     side * side quads, with a boundary
 *     holes    the grid less one face in a hundred
 *     pieces   64 tori, together about as many triangles as the torus
 *
 * Natural order is row by row; shuffled has vertex and face ids permuted. Coordinates are floats
 * widened to doubles, so that no file format rounds them. */
#ifndef TESTS_BENCH_SIDE_INPUT_H
#define TESTS_BENCH_SIDE_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct bench_input {
    double *positions; /* three a vertex */
    uint32_t *corners; /* faces one after another */
    uint32_t *starts;  /* first corner of each face */
    uint32_t vertices, faces, degree;
} bench_input;

/* Ends the program, saying why, where there is no such input or no memory. */
void bench_input_make(const char *name, bool shuffled, uint32_t side, bench_input *out);
void bench_input_clear(bench_input *input);

/* Half-edges, each once, in random order and the same in every program: a face and which of its
 * corners the half-edge leaves. No two are of one edge. `count` is how many of a mesh of 1,048,352
 * faces; of a smaller one it is lowered to the same part of it, so that as much is left. The caller
 * frees. */
typedef struct bench_pick {
    uint32_t face, corner;
} bench_pick;

bench_pick *bench_picks(const bench_input *input, uint32_t *count);

/* A number that two meshes share when they have the same faces, whatever the order of the faces and
 * the corner each begins at: the sum of this over all faces. */
uint64_t bench_face_hash(const uint32_t *vertices, size_t degree);
/* The name of a vertex by its place, where ids are not comparable. */
uint32_t bench_place_hash(double x, double y, double z);

#endif
