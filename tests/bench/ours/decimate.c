/* Benchmark rows: decimation to a tenth of the faces. The result is written to the benchmark's
 * folder, where the row of error.c measures its error. */
#include "algo/decimate.h"
#include "bench/ours/ours.h"

#include <math.h>

static void decimate(bench_side *side, bench_result *out)
{
    he_mesh *m;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    const he_decimate_options options = {.faces = he_mesh_faces(m) / 10,
                                         .max_error = INFINITY,
                                         .boundary_weight = HE_BOUNDARY_WEIGHT};
    double start = bench_seconds();
    bench_require(he_decimate(m, &options, NULL, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, he_mesh_faces(m));
    bench_write(side, m, "ply", "binary", "decimated.ply");
    he_mesh_free(m);
}

const bench_row bench_decimate_rows[] = {{"decimate", decimate}, {NULL, NULL}};
