/* Benchmark of triangulation: meshes of short polygons with many reflex corners, and polygons of
 * 10,000 to a million corners that are hard to triangulate.
 *
 *     build/tests/bench/polygons [CORNERS...] */
#include "polygons.h"

#include "geometry/triangulation.h"
#include "mesh/walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Returns the processor time of this program, so that other work on the machine does not count. */
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* --- short polygons, one after another as an export triangulates them --- */

enum { SHORT_POLYGONS = 64, SHORT_ROUNDS = 200, SHORT_MOST = 256 };

/* Returns a pseudo-random number from 0 to 1: xorshift64 (Marsaglia 2003). */
static double random_number(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return ldexp((double)(*state >> 11), -53);
}

/* Makes a star-shaped polygon: each corner has an angle of its own around the centre, so no two
 * sides cross. */
static void short_star(uint32_t n, uint64_t *state, he_vec3 *out)
{
    for (uint32_t i = 0; i < n; i++) {
        double angle = 6.283185307179586 * (i + 0.9 * random_number(state)) / n;
        double radius = 0.1 + random_number(state);
        out[i] = (he_vec3){radius * cos(angle), radius * sin(angle), 0};
    }
}

/* Makes a polygon of teeth of random length on a straight side. */
static void short_comb(uint32_t n, uint64_t *state, he_vec3 *out)
{
    out[0] = (he_vec3){0, 0, 0};
    out[1] = (he_vec3){n, 0, 0};
    for (uint32_t i = 2; i < n; i++) {
        out[i] = (he_vec3){n - i, (i % 2 == 0 ? 1 : 10) + random_number(state), 0};
    }
}

/* Prints the time of all rounds, and a checksum (corner numbers times their positions) that shows
 * whether two runs give equal triangles. */
static void measure_short(const char *name, uint32_t n,
                          void (*make)(uint32_t n, uint64_t *state, he_vec3 *out))
{
    uint64_t state = 88172645463325252u, steps = 0;
    uint32_t sum = 0;
    double took = 0;
    for (unsigned p = 0; p < SHORT_POLYGONS; p++) {
        he_vec3 points[SHORT_MOST];
        make(n, &state, points);
        he_mesh *m = polygon_mesh(points, n);
        if (m == NULL) {
            exit(1);
        }
        double start = seconds();
        for (unsigned round = 0; round < SHORT_ROUNDS; round++) {
            he_triangulation t;
            if (he_triangulation_make(m, he_face_halfedge(m, (he_face){0}), HE_ANY_DIAGONALS, NULL,
                                      &t, NULL) != HE_OK) {
                exit(1);
            }
            for (uint32_t i = 0; i < 3 * (n - 2) && round == 0; i++) {
                sum += (i + 1) * (t.corners[i] + 1) * (p + 1);
            }
            steps += t.steps;
            he_triangulation_clear(&t);
        }
        took += seconds() - start;
        he_mesh_free(m);
    }
    double corners = (double)SHORT_POLYGONS * SHORT_ROUNDS * n;
    printf("%-16s %8u corners %8.2f us %7.0f ns a corner %6.1f steps a corner, triangles %08x\n",
           name, n, 1e6 * took / (SHORT_POLYGONS * SHORT_ROUNDS), 1e9 * took / corners,
           (double)steps / corners, sum);
    fflush(stdout);
}

/* --- long polygons --- */

static void measure(const polygon_shape *shape, uint32_t n)
{
    he_vec3 *points = calloc(n, sizeof *points);
    if (points == NULL) {
        exit(1);
    }
    shape->make(n, points);
    he_mesh *m = polygon_mesh(points, n);
    free(points);
    he_triangulation t;
    double start = seconds();
    if (m == NULL || he_triangulation_make(m, he_face_halfedge(m, (he_face){0}), HE_ANY_DIAGONALS,
                                           NULL, &t, NULL) != HE_OK) {
        exit(1);
    }
    double took = seconds() - start;
    printf("%-16s %8u corners %8.1f ms %7.0f ns a corner %6.1f steps a corner%s\n", shape->name, n,
           1e3 * took, 1e9 * took / n, (double)t.steps / n,
           t.degenerate ? "   (triangles without area or turned over)" : "");
    fflush(stdout);
    he_triangulation_clear(&t);
    he_mesh_free(m);
}

int main(int argc, char **argv)
{
    static const uint32_t sizes[] = {10000, 60000, 1000000};
    for (uint32_t n = 8; n <= SHORT_MOST && argc == 1; n *= 2) {
        measure_short("short star", n, short_star);
        measure_short("short comb", n, short_comb);
    }
    for (unsigned s = 0; s < polygon_shape_count; s++) {
        for (unsigned i = 0; i < sizeof sizes / sizeof *sizes && argc == 1; i++) {
            measure(&polygon_shapes[s], sizes[i]);
        }
        for (int i = 1; i < argc; i++) {
            measure(&polygon_shapes[s], (uint32_t)strtoul(argv[i], NULL, 10) / 2 * 2);
        }
    }
    return 0;
}
