/* The figures of triangulation: polygons of 10,000 to a million corners that are hard to cut.
 *
 *     build/tests/bench/polygons [CORNERS...]                                                   */
#include "polygons.h"

#include "geometry/triangulation.h"
#include "mesh/walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Time of the processor: other work on the machine does not count. */
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

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
