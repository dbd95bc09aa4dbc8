/* Benchmark rows: an implicit step of smoothing, and the area of the result, which any of the
 * programs has made. */
#include "bench/ours/ours.h"
#include "geometry/vec3.h"
#include "mesh/walk.h"
#include "smooth/smooth.h"

#include <stdlib.h>

static const char *const FILE_NAME = "smoothed.bin";

static void smooth(bench_side *side, bench_result *out)
{
    he_mesh *m;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    const he_smooth_options options = {
        .method = HE_SMOOTH_LAPLACIAN, .steps = 1, .time = BENCH_SMOOTH_TIME};
    const double start = bench_seconds();
    bench_require(he_smooth(m, &options, NULL, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.vertices;
    bench_write_positions(side, FILE_NAME, m, 0);
    he_mesh_free(m);
}

/* VALUE: the area of the smoothed surface as a part of the area before. */
static void smooth_area(bench_side *side, bench_result *out)
{
    const bench_input *in = &side->input;
    double *after = malloc(3 * (size_t)in->vertices * sizeof *after), areas[2] = {0, 0};
    FILE *file = bench_open(side, FILE_NAME, "rb");
    if (after == NULL || fread(after, 3 * sizeof *after, in->vertices, file) != in->vertices) {
        bench_require(HE_NO_MEMORY);
    }
    (void)fclose(file);
    const double *const positions[2] = {in->positions, after};
    for (uint32_t f = 0; f < in->faces; f++) {
        const uint32_t *c = in->corners + in->starts[f];
        for (unsigned which = 0; which < 2; which++) {
            he_vec3 p[3];
            for (unsigned i = 0; i < 3; i++) {
                const double *at = positions[which] + 3 * (size_t)c[i];
                p[i] = (he_vec3){at[0], at[1], at[2]};
            }
            areas[which] +=
                he_vec3_length(he_vec3_cross(he_vec3_sub(p[1], p[0]), he_vec3_sub(p[2], p[0])));
        }
    }
    free(after);
    out->value = areas[1] / areas[0];
    out->amount = in->vertices;
}

const bench_row bench_smooth_rows[] = {
    {"smooth", smooth}, {"smooth_area", smooth_area}, {NULL, NULL}};
