/* Benchmark rows: a copy of the input is divided into patches. */
#include "bench/ours/ours.h"

#include "mesh/column.h"
#include "select/segment.h"

#include <stdlib.h>
#include <string.h>

/* Returns a hash of the patches, whatever their numbers are: of each face and the first face of its
 * patch. Patches are numbered in the order of their first faces. */
static uint64_t hash_of(const he_mesh *m, uint32_t patches)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, "patch");
    uint32_t *first = calloc(patches + 1, sizeof *first), known = 0;
    uint64_t hash = 0;
    for (uint32_t f = 0; f < he_mesh_faces(m) && first != NULL; f++) {
        uint32_t patch;
        memcpy(&patch, he_column_value(column, f), sizeof patch);
        if (patch > known) {
            known = patch;
            first[patch] = f;
        }
        hash += bench_face_hash((uint32_t[]){f, first[patch]}, 2);
    }
    free(first);
    return hash;
}

static he_segmented run(bench_side *side, const he_segment_options *options, bench_result *out)
{
    he_mesh *m;
    he_segmented done;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    double start = bench_seconds();
    bench_require(he_segment(m, options, &done, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    if (options->planes == 0) {
        bench_exact(out, hash_of(m, done.patches));
    }
    he_mesh_free(m);
    return done;
}

static void by_angle(bench_side *side, bench_result *out)
{
    const he_segment_options options = {.into = "patch", .angle = 0.5235987755982988};
    bench_near(out, run(side, &options, out).features);
}

static void by_planes(bench_side *side, bench_result *out)
{
    const he_segment_options options = {.into = "patch", .planes = 64};
    bench_near(out, run(side, &options, out).deviation);
}

const bench_row bench_segment_rows[] = {
    {"segment_angle", by_angle}, {"segment_planes", by_planes}, {NULL, NULL}};
