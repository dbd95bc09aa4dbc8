/* Benchmark rows: remeshing, and the shapes of the triangles and the distance of the result, which
 * any of the programs has made. */
#include "bench/ours/ours.h"
#include "geometry/scale.h"
#include "remesh/remesh.h"

/* Remeshes the input with edges so many times as long as those of as many regular triangles as it
 * has faces. `done` is NULL or receives the report, whose bound of the distance takes time. */
static void run(bench_side *side, double times, he_remeshed *done, bench_result *out)
{
    he_mesh *m;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    const he_remesh_options options = {.by = HE_REMESH_BY_LENGTH,
                                       .edge_length = times * bench_remesh_length(side),
                                       .steps = HE_REMESH_STEPS_USUAL,
                                       .project = true,
                                       .crease = HE_REMESH_CREASE};
    double start = bench_seconds();
    bench_require(he_remesh(m, &options, done, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_near(out, he_mesh_faces(m));
    bench_write(side, m, "ply", "binary", "remeshed.ply");
    he_mesh_free(m);
}

static void remesh(bench_side *side, bench_result *out)
{
    run(side, 1, NULL, out);
}
static void remesh_reported(bench_side *side, bench_result *out)
{
    he_remeshed done;
    run(side, 1, &done, out);
}
static void remesh_coarse(bench_side *side, bench_result *out)
{
    run(side, 3, NULL, out);
}

static void remesh_error(bench_side *side, bench_result *out)
{
    bench_distance(side, "remeshed.ply", out);
}

static double angle_at(const he_soup *soup, const uint32_t *corners, unsigned i)
{
    he_vec3 p = soup->positions[corners[i]];
    he_vec3 a = he_vec3_sub(soup->positions[corners[(i + 1) % 3]], p);
    he_vec3 b = he_vec3_sub(soup->positions[corners[(i + 2) % 3]], p);
    return he_vec3_angle(a, b) * 180 / HE_PI;
}

/* Measures the angles of the triangles in degrees. VALUE: the mean over the faces of their smallest
 * angle; NEAR: the smallest angle of all; AMOUNT: the percentage of faces that have an angle below
 * 30 degrees. */
static void remesh_shape(bench_side *side, bench_result *out)
{
    he_import import;
    double sum = 0, least = 180, small = 0;
    bench_read(side, "ply", "remeshed.ply", &import);
    const he_soup *soup = &import.soup;
    for (size_t i = 0; i + 2 < soup->corner_count; i += 3) {
        double own = 180;
        for (unsigned k = 0; k < 3; k++) {
            own = fmin(own, angle_at(soup, soup->corners + i, k));
        }
        sum += own;
        least = fmin(least, own);
        small += own < 30;
    }
    double faces = (double)soup->corner_count / 3;
    out->value = sum / faces;
    out->amount = 100 * small / faces;
    bench_near(out, least);
    he_import_clear(&import);
}

const bench_row bench_remesh_rows[] = {{"remesh", remesh},
                                       {"remesh_reported", remesh_reported},
                                       {"remesh_coarse", remesh_coarse},
                                       {"remesh_error", remesh_error},
                                       {"remesh_shape", remesh_shape},
                                       {NULL, NULL}};
