#include "bench/side/input.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *array(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    if (memory == NULL) {
        fprintf(stderr, "no memory for the bench's input\n");
        exit(1);
    }
    return memory;
}

/* Returns a pseudo-random number from 0 to n - 1: xorshift64 (Marsaglia 2003). */
static uint32_t random_below(uint64_t *state, uint32_t n)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (uint32_t)((*state >> 32) * n >> 32);
}

static uint32_t *permutation(uint64_t *state, uint32_t count, bool shuffled)
{
    uint32_t *ids = (uint32_t *)array(count, sizeof *ids);
    for (uint32_t i = 0; i < count; i++) {
        ids[i] = i;
    }
    for (uint32_t i = count - 1; shuffled && i > 0; i--) {
        uint32_t k = random_below(state, i + 1), swap = ids[i];
        ids[i] = ids[k];
        ids[k] = swap;
    }
    return ids;
}

static void allocate(bench_input *in, uint32_t vertices, uint32_t faces, uint32_t degree)
{
    in->vertices = vertices;
    in->faces = faces;
    in->degree = degree;
    in->positions = (double *)array(vertices, 3 * sizeof *in->positions);
    in->corners = (uint32_t *)array(faces, degree * sizeof *in->corners);
    in->starts = (uint32_t *)array(faces, sizeof *in->starts);
    for (uint32_t f = 0; f < faces; f++) {
        in->starts[f] = f * degree;
    }
}

static void place(bench_input *in, uint32_t v, double x, double y, double z)
{
    in->positions[3 * v] = (double)(float)x;
    in->positions[3 * v + 1] = (double)(float)y;
    in->positions[3 * v + 2] = (double)(float)z;
}

/* Adds a torus, shifted by `x`, to the input. Its vertices get ids from `vertex` on, its faces get
 * ids from `face` on. */
static void fill_torus(bench_input *in, uint32_t side, uint32_t vertex, uint32_t face, double x)
{
    const double turn = 6.283185307179586 / side;
    for (uint32_t i = 0; i < side; i++) {
        for (uint32_t j = 0; j < side; j++) {
            double a = turn * i, b = turn * j, r = 3 + cos(b) + 0.1 * sin(9 * a);
            place(in, vertex + i * side + j, x + r * cos(a), r * sin(a), sin(b));
            uint32_t down = vertex + (i + 1) % side * side, right = (j + 1) % side;
            uint32_t here = vertex + i * side;
            const uint32_t two[6] = {here + j, down + j,     down + right,
                                     here + j, down + right, here + right};
            memcpy(in->corners + 3 * (face + 2 * (i * side + j)), two, sizeof two);
        }
    }
}

static bool is_missing(bool holes, uint32_t i, uint32_t j)
{
    return holes && i % 10 == 5 && j % 10 == 5;
}

static void make_grid(bench_input *in, uint32_t side, bool holes)
{
    uint32_t faces = 0, row = side + 1;
    for (uint32_t q = 0; q < side * side; q++) {
        faces += !is_missing(holes, q / side, q % side);
    }
    allocate(in, row * row, faces, 4);
    for (uint32_t v = 0; v < row * row; v++) {
        uint32_t i = v / row, j = v % row;
        double x = (double)j / side, y = (double)i / side;
        place(in, v, x, y, 0.05 * sin(20 * x) * cos(17 * y));
    }
    uint32_t *to = in->corners;
    for (uint32_t q = 0; q < side * side; q++) {
        uint32_t i = q / side, j = q % side, a = i * row + j;
        if (!is_missing(holes, i, j)) {
            const uint32_t quad[4] = {a, a + 1, a + row + 1, a + row};
            memcpy(to, quad, sizeof quad);
            to += 4;
        }
    }
}

/* Returns the height of a zigzag of 32 slopes after `i` of `side` steps; it rises and falls by one
 * step each. */
static double zigzag(uint32_t side, uint32_t i)
{
    int height = 0;
    for (uint32_t k = 0; k < i; k++) {
        height += (uint64_t)k * 32 / side % 2 == 0 ? 1 : -1;
    }
    return (double)height / side;
}

static void make_roofs(bench_input *in, uint32_t side)
{
    const uint32_t row = side + 1;
    double *heights = (double *)array(row, sizeof *heights);
    allocate(in, row * row, 2 * side * side, 3);
    for (uint32_t i = 0; i < row; i++) {
        heights[i] = zigzag(side, i);
    }
    for (uint32_t v = 0; v < row * row; v++) {
        const uint32_t i = v / row, j = v % row;
        place(in, v, (double)j / side, (double)i / side, heights[i] + heights[j]);
    }
    uint32_t *to = in->corners;
    for (uint32_t q = 0; q < side * side; q++) {
        const uint32_t a = q / side * row + q % side;
        const uint32_t two[6] = {a, a + 1, a + row + 1, a, a + row + 1, a + row};
        memcpy(to, two, sizeof two);
        to += 6;
    }
    free(heights);
}

static void shuffle(bench_input *in)
{
    uint64_t state = 88172645463325252u;
    uint32_t *vertex = permutation(&state, in->vertices, true);
    uint32_t *face = permutation(&state, in->faces, true);
    bench_input to;
    allocate(&to, in->vertices, in->faces, in->degree);
    for (uint32_t v = 0; v < in->vertices; v++) {
        memcpy(to.positions + 3 * (size_t)vertex[v], in->positions + 3 * (size_t)v,
               3 * sizeof(double));
    }
    for (uint32_t f = 0; f < in->faces; f++) {
        for (uint32_t k = 0; k < in->degree; k++) {
            to.corners[face[f] * in->degree + k] = vertex[in->corners[f * in->degree + k]];
        }
    }
    free(vertex);
    free(face);
    bench_input_clear(in);
    *in = to;
}

void bench_input_make(const char *name, bool shuffled, uint32_t side, bench_input *out)
{
    if (strcmp(name, "torus") == 0) {
        allocate(out, side * side, 2 * side * side, 3);
        fill_torus(out, side, 0, 0, 0);
    } else if (strcmp(name, "grid") == 0 || strcmp(name, "holes") == 0) {
        make_grid(out, side, name[0] == 'h');
    } else if (strcmp(name, "roofs") == 0) {
        make_roofs(out, side);
    } else if (strcmp(name, "pieces") == 0) {
        uint32_t part = side / 8;
        allocate(out, 64 * part * part, 128 * part * part, 3);
        for (uint32_t i = 0; i < 64; i++) {
            fill_torus(out, part, i * part * part, 2 * i * part * part, 10 * (double)i);
        }
    } else {
        fprintf(stderr, "there is no input %s\n", name);
        exit(2);
    }
    if (shuffled) {
        shuffle(out);
    }
}

void bench_input_clear(bench_input *input)
{
    free(input->positions);
    free(input->corners);
    free(input->starts);
    *input = (bench_input){0};
}

enum { USUAL_FACES = 2 * 724 * 724 };

bench_pick *bench_picks(const bench_input *input, uint32_t *count)
{
    uint64_t state = 2463534242u;
    uint32_t halfedges = input->faces * input->degree, picked = 0;
    if (input->faces < USUAL_FACES) {
        *count = (uint32_t)((uint64_t)*count * input->faces / USUAL_FACES);
    }
    uint32_t *order = permutation(&state, halfedges, true);
    bench_pick *picks = (bench_pick *)array(*count, sizeof *picks);
    for (uint32_t i = 0; i < halfedges && picked < *count; i++) {
        uint32_t f = order[i] / input->degree, k = order[i] % input->degree;
        const uint32_t *corners = input->corners + f * input->degree;
        /* Each edge gives only one of its two half-edges: the one whose target has the larger
         * id. */
        if (corners[k] < corners[(k + 1) % input->degree]) {
            picks[picked++] = (bench_pick){f, k};
        }
    }
    free(order);
    *count = picked;
    return picks;
}

static uint64_t mix(uint64_t x)
{
    x ^= x >> 31;
    x *= 0x9E3779B97F4A7C15u;
    return x ^ x >> 29;
}

uint64_t bench_face_hash(const uint32_t *vertices, size_t degree)
{
    size_t first = 0;
    for (size_t i = 1; i < degree; i++) {
        first = vertices[i] < vertices[first] ? i : first;
    }
    uint64_t hash = degree;
    for (size_t i = 0; i < degree; i++) {
        hash = mix(hash * 31 + vertices[first + i < degree ? first + i : first + i - degree]);
    }
    return hash;
}

uint32_t bench_place_hash(double x, double y, double z)
{
    const double place[3] = {x, y, z};
    uint64_t hash = 0, bits;
    for (int i = 0; i < 3; i++) {
        memcpy(&bits, &place[i], sizeof bits);
        hash = mix(hash ^ bits);
    }
    return (uint32_t)(hash >> 16);
}
