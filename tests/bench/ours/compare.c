/* Benchmark rows: the distance between the input and a copy of it that was bent, alone and with
 * means and histograms. */
#include "bench/ours/ours.h"

#include "compare/compare.h"
#include "mesh/write.h"

he_mesh *bench_bent(bench_side *side)
{
    he_mesh *m;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        const he_vec3 p = he_position(m, (he_vertex){v});
        double moved[3] = {p.x, p.y, p.z};
        bench_bend(moved);
        he_set_position(m, (he_vertex){v}, (he_vec3){moved[0], moved[1], moved[2]});
    }
    return m;
}

/* The trees of boxes are made within the time, as CGAL makes its own. */
static void compare(bench_side *side, uint32_t bins, bench_result *out)
{
    he_mesh *meshes[2] = {bench_mesh(side), bench_bent(side)};
    he_bvh *trees[2];
    he_compared surfaces[2];
    he_comparison done;
    const he_compare_options options = {.bound = BENCH_COMPARE_BOUND, .bins = bins};
    const double start = bench_seconds();
    for (int i = 0; i < 2; i++) {
        bench_require(he_bvh_new(meshes[i], NULL, &trees[i], NULL));
        surfaces[i] = (he_compared){meshes[i], trees[i]};
    }
    bench_require(he_compare(surfaces, &options, NULL, &done, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, done.lower);
    for (int i = 0; i < 2; i++) {
        he_bvh_free(trees[i]);
    }
    he_mesh_free(meshes[1]);
}

static void compare_alone(bench_side *side, bench_result *out)
{
    compare(side, 0, out);
}

static void compare_with_means(bench_side *side, bench_result *out)
{
    compare(side, HE_COMPARE_BINS, out);
}

const bench_row bench_compare_rows[] = {
    {"compare", compare_alone}, {"compare_with_means", compare_with_means}, {NULL, NULL}};
