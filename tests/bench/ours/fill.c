/* Benchmark rows: filling a hole, and how far the result is from the surface before. */
#include "bench/ours/ours.h"
#include "edit/local/erase.h"
#include "fill/fill.h"
#include "geometry/vec3.h"
#include "mesh/walk.h"
#include "query/bvh.h"

#include <math.h>

static const char *const FILE_NAME = "filled.bin";

/* Deletes the faces at the vertices of a cap, and returns a half-edge of the hole. */
static he_halfedge cut(const bench_side *side, he_mesh *m, bool left)
{
    he_ids faces = {0};
    he_halfedge hole = {0};
    for (uint32_t f = 0; f < side->input.faces; f++) {
        const uint32_t *c = side->input.corners + side->input.starts[f];
        if (bench_in_cap(side, c[0], left) && bench_in_cap(side, c[1], left) &&
            bench_in_cap(side, c[2], left)) {
            bench_require(he_ids_add(&faces, f, NULL));
        }
    }
    bench_require(he_face_delete(m, faces.ids, faces.count, HE_DROP_ISOLATED, NULL));
    he_ids_clear(&faces);
    while (!he_mesh_is_live(m, HE_EDGE, hole.i / 2) || !he_is_boundary_halfedge(m, hole)) {
        hole.i++;
    }
    return hole;
}

static const he_smooth_fill options = {.continuity = HE_CONTINUOUS_TANGENT};

/* Fills the hole to the right. If `again` is true, the one to the left was filled before. */
static void fill_one(bench_side *side, bool again, bench_result *out)
{
    he_mesh *m;
    he_filled filled;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    if (again) {
        bench_require(he_hole_fill_smooth(m, cut(side, m, true), &options, NULL, NULL));
    }
    const he_halfedge hole = cut(side, m, false);
    const uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    const double start = bench_seconds();
    bench_require(he_hole_fill_smooth(m, hole, &options, &filled, NULL));
    out->value = bench_seconds() - start;
    out->amount = (double)filled.faces.count;
    he_filled_clear(&filled);
    bench_write_positions(side, FILE_NAME, m, issued);
    he_mesh_free(m);
}

static void fill(bench_side *side, bench_result *out)
{
    fill_one(side, false, out);
}

static void fill_again(bench_side *side, bench_result *out)
{
    fill_one(side, true, out);
}

/* VALUE: the root mean square of the distances of the new vertices, which any of the programs has
 * made, from the surface before it was cut. */
static void fill_error(bench_side *side, bench_result *out)
{
    he_mesh *m = bench_mesh(side);
    he_budget budget = {.left = UINT64_MAX};
    he_bvh *tree;
    FILE *file = bench_open(side, FILE_NAME, "rb");
    double c[3], sum = 0;
    size_t count = 0;
    bench_require(he_bvh_new(m, NULL, &tree, NULL));
    while (fread(c, sizeof c, 1, file) == 1) {
        he_hit hit;
        bench_require(
            he_bvh_closest(tree, m, (he_vec3){c[0], c[1], c[2]}, HUGE_VAL, &budget, &hit, NULL));
        sum += hit.distance * hit.distance;
        count++;
    }
    (void)fclose(file);
    he_bvh_free(tree);
    out->value = count == 0 ? HUGE_VAL : sqrt(sum / (double)count);
    out->amount = (double)count;
}

const bench_row bench_fill_rows[] = {
    {"fill", fill}, {"fill_again", fill_again}, {"fill_error", fill_error}, {NULL, NULL}};
