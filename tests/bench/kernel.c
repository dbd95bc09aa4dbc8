/* The kernel's bare figures: build, one-ring, edge splits, memory. On a torus of about a million
 * triangles, in natural order and with vertex and face ids shuffled. Medians of ROUNDS runs.
 *
 *     build/tests/bench/kernel [ROUNDS]                                                        */
#include "edit/split.h"
#include "mesh/build.h"
#include "mesh/delta.h"
#include "mesh/walk.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum {
    SIDE = 724,
    VERTICES = SIDE * SIDE,
    FACES = 2 * VERTICES,
    SPLITS = 300000,
    MOST_ROUNDS = 99
};

typedef struct order {
    uint32_t *vertex, *face; /* the id of each in the file */
} order;

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static uint64_t state = 88172645463325252u;

/* xorshift64 (Marsaglia 2003) */
static uint32_t random_below(uint32_t n)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (uint32_t)((state >> 32) * n >> 32);
}

static uint32_t *permutation(uint32_t count, bool shuffled)
{
    uint32_t *ids = malloc(count * sizeof *ids);
    if (ids == NULL) {
        exit(1);
    }
    for (uint32_t i = 0; i < count; i++) {
        ids[i] = i;
    }
    for (uint32_t i = count - 1; shuffled && i > 0; i--) {
        uint32_t k = random_below(i + 1), swap = ids[i];
        ids[i] = ids[k];
        ids[k] = swap;
    }
    return ids;
}

static void require(he_status status)
{
    if (status != HE_OK) {
        fprintf(stderr, "%s\n", he_status_title(status));
        exit(1);
    }
}

static void fill(he_soup *soup, const order *o)
{
    he_soup_init(soup, NULL);
    for (uint32_t i = 0; i < VERTICES; i++) {
        uint32_t row = i / SIDE;
        require(he_soup_add_vertex(soup, (he_vec3){i % SIDE, row, i % 7}, NULL));
    }
    for (uint32_t k = 0; k < FACES; k++) {
        uint32_t f = o->face[k], q = f / 2, i = q / SIDE, j = q % SIDE;
        uint32_t down = (i + 1) % SIDE * SIDE, right = (j + 1) % SIDE;
        uint32_t a = o->vertex[i * SIDE + j], b = o->vertex[down + j];
        uint32_t c = o->vertex[down + right], d = o->vertex[i * SIDE + right];
        const uint32_t triangles[2][3] = {{a, b, c}, {a, c, d}};
        require(he_soup_add_face(soup, triangles[f & 1], 3, NULL));
    }
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare);
    return values[count / 2];
}

/* Keeps what was computed from being thought useless. */
static volatile double sink;

static double time_rings(const he_mesh *m)
{
    double start = seconds(), sum = 0;
    uint64_t visited = 0;
    for (uint32_t v = 0; v < VERTICES; v++) {
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){v}), h = first;
        do {
            sum += he_position(m, he_target(m, h)).x;
            visited++;
            h = he_turn_ccw(m, h);
        } while (h.i != first.i);
    }
    sink = sum;
    return (double)visited / (seconds() - start) / 1e6;
}

/* Millions of random edge splits a second. Recording empties the delta after each, as a store
 * that hands it on does. */
static double time_splits(const he_mesh *original, bool record)
{
    he_mesh *m;
    require(he_mesh_copy(original, &m, NULL));
    he_delta *delta = he_delta_new();
    if (record) {
        he_mesh_record(m, delta);
    }
    double start = seconds();
    for (int i = 0; i < SPLITS; i++) {
        he_edge e = {random_below(he_mesh_issued(m, HE_EDGE))};
        require(he_edge_split(m, e, 0.5, NULL, NULL));
        if (record) {
            he_delta_empty(delta);
        }
    }
    double rate = SPLITS / (seconds() - start) / 1e6;
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    he_mesh_free(m);
    return rate;
}

static void run(const char *name, bool shuffled, int rounds)
{
    double build[MOST_ROUNDS], rings[MOST_ROUNDS], plain[MOST_ROUNDS], recorded[MOST_ROUNDS];
    double bytes = 0;
    order o = {permutation(VERTICES, shuffled), permutation(FACES, shuffled)};
    for (int i = 0; i < rounds; i++) {
        he_soup soup;
        he_mesh *m;
        fill(&soup, &o);
        double start = seconds();
        require(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL));
        build[i] = FACES / (seconds() - start) / 1e6;
        rings[i] = time_rings(m);
        plain[i] = time_splits(m, false);
        recorded[i] = time_splits(m, true);
        bytes = (double)he_mesh_bytes(m) / FACES;
        he_mesh_free(m);
    }
    printf("%-9s build %6.2f Mface/s   one-ring %6.1f M half-edges/s   edge_split %5.2f M/s, "
           "recorded %5.2f M/s   %.1f bytes a face\n",
           name, median(build, rounds), median(rings, rounds), median(plain, rounds),
           median(recorded, rounds), bytes);
    free(o.vertex);
    free(o.face);
}

int main(int argc, char **argv)
{
    int rounds = argc > 1 ? (int)strtol(argv[1], NULL, 10) : 5;
    if (rounds < 1 || rounds > MOST_ROUNDS) {
        fprintf(stderr, "usage: %s [ROUNDS from 1 to %d]\n", argv[0], MOST_ROUNDS);
        return 2;
    }
    printf("torus of %d triangles, medians of %d\n", FACES, rounds);
    run("natural", false, rounds);
    run("shuffled", true, rounds);
    return 0;
}
