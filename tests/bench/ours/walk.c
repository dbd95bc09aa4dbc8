/* Benchmark rows: visiting a whole mesh, with neighbours, normals, loops and components. */
#include "bench/ours/ours.h"
#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "query/topology.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void one_ring(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    double sum = 0, start = bench_seconds();
    uint64_t visited = 0;
    uint32_t vertices = he_mesh_issued(m, HE_VERTEX);
    for (uint32_t v = 0; v < vertices; v++) {
        he_halfedge first = he_vertex_halfedge(m, (he_vertex){v}), h = first;
        do {
            he_vec3 p = he_position(m, he_target(m, h));
            sum += p.x + p.y + p.z;
            visited++;
            h = he_swing_ccw(m, h);
        } while (h.i != first.i);
    }
    out->value = bench_seconds() - start;
    out->amount = (double)visited;
    bench_near(out, sum);
}

static double size_of(const he_vec3 *normals, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += fabs(normals[i].x) + 2 * fabs(normals[i].y) + 3 * fabs(normals[i].z);
    }
    return sum;
}

/* Allocates memory for normals and writes to all of it, as the other programs do, so that the row
 * does not measure the allocation of pages. */
static he_vec3 *normals_new(size_t count)
{
    he_vec3 *normals = malloc(count * sizeof *normals);
    if (normals == NULL) {
        exit(1);
    }
    memset(normals, 1, count * sizeof *normals);
    return normals;
}

static void face_normals(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    uint32_t count = he_mesh_issued(m, HE_FACE);
    he_vec3 *normals = normals_new(count);
    double start = bench_seconds();
    bench_require(he_face_normals(m, NULL, normals, NULL));
    out->value = bench_seconds() - start;
    out->amount = count;
    bench_near(out, size_of(normals, count));
    free(normals);
}

static void vertex_normals(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    uint32_t count = he_mesh_issued(m, HE_VERTEX);
    he_vec3 *normals = normals_new(count);
    double start = bench_seconds();
    bench_require(he_vertex_normals(m, HE_WEIGHT_UNIFORM, NULL, normals, NULL));
    out->value = bench_seconds() - start;
    out->amount = count;
    bench_near(out, size_of(normals, count));
    free(normals);
}

static void loops(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    he_boundaries boundaries = {0};
    double start = bench_seconds();
    bench_require(he_boundaries_find(m, &boundaries, NULL));
    out->value = bench_seconds() - start;
    out->amount = 2.0 * he_mesh_edges(m);
    uint64_t hash = boundaries.count;
    for (size_t i = 0; i < boundaries.count; i++) {
        hash += (uint64_t)boundaries.loops[i].length * boundaries.loops[i].length << 20;
    }
    bench_exact(out, hash);
    he_boundaries_clear(&boundaries);
}

static void components(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    he_components found = {0};
    double start = bench_seconds();
    bench_require(he_components_find(m, HE_JOINED_BY_EDGE, &found, NULL));
    out->value = bench_seconds() - start;
    out->amount = he_mesh_faces(m);
    uint64_t hash = found.count;
    for (size_t i = 0; i < found.count; i++) {
        hash += (uint64_t)found.components[i].faces * found.components[i].faces << 8;
    }
    bench_exact(out, hash);
    he_components_clear(&found);
}

const bench_row bench_walk_rows[] = {
    {"one_ring", one_ring}, {"face_normals", face_normals}, {"vertex_normals", vertex_normals},
    {"loops", loops},       {"components", components},     {NULL, NULL}};
