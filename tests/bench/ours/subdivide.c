/* Benchmark rows: one step of subdivision of a copy of the input. */
#include "bench/ours/ours.h"

#include "algo/subdivide.h"
#include "mesh/walk.h"

#include <math.h>

static void describe(const he_mesh *m, bench_result *out)
{
    double sum = 0;
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        sum += fabs(p.x) + 2 * fabs(p.y) + 3 * fabs(p.z);
    }
    out->amount = he_mesh_faces(m);
    bench_exact(out, bench_counts(0, he_mesh_vertices(m), he_mesh_edges(m), he_mesh_faces(m)));
    bench_near(out, sum);
}

static void subdivide(bench_side *side, he_scheme scheme, bench_result *out)
{
    he_mesh *m;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    double start = bench_seconds();
    bench_require(he_subdivide(m, scheme, 1, NULL, NULL));
    out->value = bench_seconds() - start;
    describe(m, out);
    he_mesh_free(m);
}

static void loop(bench_side *side, bench_result *out)
{
    subdivide(side, HE_LOOP, out);
}

static void catmull_clark(bench_side *side, bench_result *out)
{
    subdivide(side, HE_CATMULL_CLARK, out);
}

const bench_row bench_subdivide_rows[] = {
    {"loop", loop}, {"catmull_clark", catmull_clark}, {NULL, NULL}};
