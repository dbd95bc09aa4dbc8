/* Benchmark rows: the speedup by a second core. Each row is run on the calling thread alone and
 * with helping threads. Wall time is measured, because processor time adds up over threads. */
#include "bench/ours/ours.h"

#include "algo/decimate.h"
#include "algo/subdivide.h"
#include "compare/compare.h"
#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "system/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double wall_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* If `helped`, lets the work use the helping threads, which the first call starts. */
static void lend(he_progress *progress, bool helped)
{
    static st_parallel *hands;
    if (hands == NULL) {
        hands = st_parallel_new(1);
    }
    if (hands == NULL) {
        bench_require(HE_NO_MEMORY);
    }
    he_progress_init(progress, NULL, NULL);
    progress->parallel = helped ? st_parallel_host(hands) : NULL;
}

static void build(bench_side *side, bool helped, bench_result *out)
{
    he_mesh *mesh;
    he_progress progress;
    he_soup soup = bench_soup(side);
    lend(&progress, helped);
    soup.limits.progress = &progress;
    double start = wall_seconds();
    bench_require(he_build(&soup, 0, &mesh, NULL, NULL));
    out->value = wall_seconds() - start;
    out->amount = side->input.faces;
    bench_exact(out, bench_mesh_hash(mesh));
    he_mesh_free(mesh);
}

static uint64_t hash_of(const he_vec3 *rows, size_t count)
{
    uint64_t hash = 0;
    for (size_t i = 0; i < count; i++) {
        hash = hash * 31 + bench_place_hash(rows[i].x, rows[i].y, rows[i].z);
    }
    return hash;
}

static he_vec3 *rows_new(size_t count)
{
    he_vec3 *rows = malloc(count * sizeof *rows);
    if (rows == NULL) {
        bench_require(HE_NO_MEMORY);
        exit(1);
    }
    memset(rows, 1, count * sizeof *rows);
    return rows;
}

static void face_normals(bench_side *side, bool helped, bench_result *out)
{
    he_progress progress;
    const he_mesh *m = bench_mesh(side);
    uint32_t count = he_mesh_issued(m, HE_FACE);
    he_vec3 *rows = rows_new(count);
    lend(&progress, helped);
    double start = wall_seconds();
    bench_require(he_face_normals(m, &progress, rows, NULL));
    out->value = wall_seconds() - start;
    out->amount = count;
    bench_exact(out, hash_of(rows, count));
    free(rows);
}

static void corner_normals(bench_side *side, bool helped, bench_result *out)
{
    he_progress progress;
    const he_mesh *m = bench_mesh(side);
    size_t count = 2 * (size_t)he_mesh_issued(m, HE_EDGE);
    he_vec3 *rows = rows_new(count);
    lend(&progress, helped);
    double start = wall_seconds();
    bench_require(he_corner_normals(m, 0.5, &progress, rows, NULL));
    out->value = wall_seconds() - start;
    out->amount = (double)count;
    bench_exact(out, hash_of(rows, count));
    free(rows);
}

static void subdivide(bench_side *side, he_scheme scheme, bool helped, bench_result *out)
{
    he_mesh *m;
    he_progress progress;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    lend(&progress, helped);
    he_mesh_set_progress(m, &progress);
    double start = wall_seconds();
    bench_require(he_subdivide(m, scheme, 1, NULL, NULL));
    out->value = wall_seconds() - start;
    out->amount = he_mesh_faces(m);
    he_mesh_set_progress(m, NULL);
    uint64_t hash = bench_mesh_hash(m);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        hash = hash * 31 + bench_place_hash(p.x, p.y, p.z);
    }
    bench_exact(out, hash);
    he_mesh_free(m);
}

/* Compares the input with a bent copy; the trees of boxes are made before. */
static void compare(bench_side *side, bool helped, bench_result *out)
{
    he_progress progress;
    he_mesh *bent = bench_bent(side);
    he_compared surfaces[2] = {{bench_mesh(side), NULL}, {bent, NULL}};
    he_bvh *trees[2];
    he_comparison done;
    const he_compare_options options = {.bound = BENCH_COMPARE_BOUND, .bins = 1};
    for (int i = 0; i < 2; i++) {
        bench_require(he_bvh_new(surfaces[i].mesh, NULL, &trees[i], NULL));
        surfaces[i].tree = trees[i];
    }
    lend(&progress, helped);
    double start = wall_seconds();
    bench_require(he_compare(surfaces, &options, &progress, &done, NULL));
    out->value = wall_seconds() - start;
    out->amount = side->input.faces;
    bench_exact(out, bench_place_hash(done.lower, done.side[0].mean, done.side[1].rms));
    he_bvh_free(trees[0]);
    he_bvh_free(trees[1]);
    he_mesh_free(bent);
}

/* Decimates to nine tenths of the faces, of which the costs of all edges are a large part. */
static void decimate(bench_side *side, bool helped, bench_result *out)
{
    he_mesh *m;
    he_progress progress;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    lend(&progress, helped);
    he_mesh_set_progress(m, &progress);
    const he_decimate_options options = {.faces = he_mesh_faces(m) / 10 * 9,
                                         .max_error = INFINITY,
                                         .boundary_weight = HE_BOUNDARY_WEIGHT};
    double start = wall_seconds();
    bench_require(he_decimate(m, &options, NULL, NULL));
    out->value = wall_seconds() - start;
    out->amount = side->input.faces;
    he_mesh_set_progress(m, NULL);
    bench_exact(out, bench_mesh_hash(m));
    he_mesh_free(m);
}

static void loop(bench_side *side, bool helped, bench_result *out)
{
    subdivide(side, HE_LOOP, helped, out);
}

static void catmull_clark(bench_side *side, bool helped, bench_result *out)
{
    subdivide(side, HE_CATMULL_CLARK, helped, out);
}

/* Imports a file. Building the mesh uses helping threads, reading the file does not. */
static void import(bench_side *side, const char *format, const char *name, bool helped,
                   bench_result *out)
{
    he_import import;
    he_mesh *mesh;
    he_progress progress;
    lend(&progress, helped);
    double start = wall_seconds();
    bench_read(side, format, name, &import);
    import.soup.limits.progress = &progress;
    bench_require(he_build(&import.soup, HE_BUILD_TAKE, &mesh, NULL, NULL));
    he_import_clear(&import);
    out->value = wall_seconds() - start;
    out->amount = he_mesh_faces(mesh);
    bench_exact(out, bench_mesh_hash(mesh));
    he_mesh_free(mesh);
}

static void import_obj(bench_side *side, bool helped, bench_result *out)
{
    import(side, "obj", "input.obj", helped, out);
}

static void import_ply(bench_side *side, bool helped, bench_result *out)
{
    import(side, "ply", "input.ply", helped, out);
}

/* Exports a file, in the pieces in which a download asks for it. */
static void export(bench_side *side, const char *name, const char *encoding, bool helped,
                   bench_result *out)
{
    static char buffer[128 * 1024];
    he_writer *writer;
    he_progress progress;
    const he_mesh *mesh = bench_mesh(side);
    const he_format *format = he_format_find(name);
    uint64_t bytes = 0;
    lend(&progress, helped);
    double start = wall_seconds();
    bench_require(he_writer_new(format, mesh, (size_t)he_format_encoding(format, encoding),
                                &progress, &writer, NULL));
    for (size_t n; (n = he_writer_read(writer, buffer, sizeof buffer)) > 0;) {
        bytes += n;
    }
    out->value = wall_seconds() - start;
    out->amount = he_mesh_faces(mesh);
    bench_exact(out, bytes);
    he_writer_free(writer);
}

static void export_obj(bench_side *side, bool helped, bench_result *out)
{
    export(side, "obj", "ascii", helped, out);
}

static void export_ply(bench_side *side, bool helped, bench_result *out)
{
    export(side, "ply", "binary", helped, out);
}

static void export_ply_text(bench_side *side, bool helped, bench_result *out)
{
    export(side, "ply", "ascii", helped, out);
}

static void export_off(bench_side *side, bool helped, bench_result *out)
{
    export(side, "off", "ascii", helped, out);
}

#define BOTH(row)                                            \
    static void row##_1(bench_side *side, bench_result *out) \
    {                                                        \
        row(side, false, out);                               \
    }                                                        \
    static void row##_2(bench_side *side, bench_result *out) \
    {                                                        \
        row(side, true, out);                                \
    }
BOTH(build)
BOTH(face_normals)
BOTH(corner_normals)
BOTH(decimate)
BOTH(loop)
BOTH(compare)
BOTH(catmull_clark)
BOTH(import_obj)
BOTH(import_ply)
BOTH(export_obj)
BOTH(export_ply)
BOTH(export_ply_text)
BOTH(export_off)
#undef BOTH

const bench_row bench_scaling_rows[] = {{"build_1", build_1},
                                        {"build_2", build_2},
                                        {"face_normals_1", face_normals_1},
                                        {"face_normals_2", face_normals_2},
                                        {"corner_normals_1", corner_normals_1},
                                        {"corner_normals_2", corner_normals_2},
                                        {"decimate_1", decimate_1},
                                        {"decimate_2", decimate_2},
                                        {"loop_1", loop_1},
                                        {"loop_2", loop_2},
                                        {"compare_1", compare_1},
                                        {"compare_2", compare_2},
                                        {"catmull_clark_1", catmull_clark_1},
                                        {"catmull_clark_2", catmull_clark_2},
                                        {"import_obj_1", import_obj_1},
                                        {"import_obj_2", import_obj_2},
                                        {"import_ply_1", import_ply_1},
                                        {"import_ply_2", import_ply_2},
                                        {"export_obj_1", export_obj_1},
                                        {"export_obj_2", export_obj_2},
                                        {"export_ply_1", export_ply_1},
                                        {"export_ply_2", export_ply_2},
                                        {"export_ply_text_1", export_ply_text_1},
                                        {"export_ply_text_2", export_ply_text_2},
                                        {"export_off_1", export_off_1},
                                        {"export_off_2", export_off_2},
                                        {NULL, NULL}};
