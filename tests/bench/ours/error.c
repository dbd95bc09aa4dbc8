/* Benchmark rows: the distance between a changed mesh, made by any of the programs, and the input,
 * from points on each surface and their nearest points on the other, as in P. Cignoni, C. Rocchini
 * and R. Scopigno, "Metro: measuring error on simplified surfaces", 1998. */
#include "bench/ours/ours.h"
#include "geometry/vec3.h"
#include "mesh/walk.h"
#include "query/bvh.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 1000000 };

/* Sums of the distances over the points of one surface. */
typedef struct sums {
    double squares, farthest;
    uint32_t turned; /* number of points whose face is turned away from the face at the nearest
                        point of the other surface */
} sums;

/* Returns a pseudo-random number from 0 to 1; the sequence is the same in every run. */
static double draw(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * 0x1p-53;
}

static void corners_of(const he_mesh *m, uint32_t f, he_vec3 out[3])
{
    he_halfedge h = he_face_halfedge(m, (he_face){f});
    for (unsigned i = 0; i < 3; i++) {
        out[i] = he_position(m, he_origin(m, h));
        h = he_next(m, h);
    }
}

/* Returns the area vector of a triangle: its normal, with twice the area as length. */
static he_vec3 area_of(const he_vec3 p[3])
{
    return he_vec3_cross(he_vec3_sub(p[1], p[0]), he_vec3_sub(p[2], p[0]));
}

static double total_area(const he_mesh *m)
{
    double sum = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        he_vec3 p[3];
        if (he_face_is_live(m, (he_face){f})) {
            corners_of(m, f, p);
            sum += he_vec3_length(area_of(p));
        }
    }
    return sum;
}

static void look(const he_bvh *tree, const he_mesh *to, he_vec3 point, he_vec3 area, sums *out)
{
    he_budget budget = {.left = UINT64_MAX};
    he_vec3 p[3];
    he_hit hit;
    bench_require(he_bvh_closest(tree, to, point, HUGE_VAL, &budget, &hit, NULL));
    corners_of(to, hit.face, p);
    out->squares += hit.distance * hit.distance;
    out->farthest = fmax(out->farthest, hit.distance);
    out->turned += he_vec3_dot(area, area_of(p)) < 0;
}

/* Measures the distances from points of `from` to `to`. The points are spread evenly over the
 * faces, in the order of the faces, so that consecutive points are near each other. */
static sums sample(const he_mesh *from, const he_bvh *tree, const he_mesh *to)
{
    sums out = {0, 0, 0};
    uint64_t state = 88172645463325252u;
    double step = total_area(from) / SAMPLES, passed = 0, next = 0.5 * step;
    for (uint32_t f = 0; f < he_mesh_issued(from, HE_FACE); f++) {
        he_vec3 p[3];
        if (!he_face_is_live(from, (he_face){f})) {
            continue;
        }
        corners_of(from, f, p);
        he_vec3 area = area_of(p);
        for (passed += he_vec3_length(area); next < passed; next += step) {
            double u = draw(&state), v = draw(&state);
            double w = u + v > 1 ? u + v - 1 : 1 - u - v;
            u = u + v > 1 ? 1 - u : u;
            v = 1 - u - w;
            he_vec3 point = he_vec3_add(he_vec3_scale(p[0], w), he_vec3_scale(p[1], u));
            look(tree, to, he_vec3_add(point, he_vec3_scale(p[2], v)), area, &out);
        }
    }
    return out;
}

/* Reads a mesh and gives each face vertices of its own. Our mesh structure accepts only manifolds,
 * and the result of another program need not be a manifold while its faces share vertices. */
static he_mesh *read_faces(const bench_side *side, const char *name)
{
    he_import import;
    he_soup apart;
    he_mesh *mesh;
    bench_read(side, "ply", name, &import);
    he_soup_init(&apart, NULL);
    for (size_t i = 0; i < import.soup.corner_count; i++) {
        he_vec3 p = import.soup.positions[import.soup.corners[i]];
        bench_require(he_soup_add_vertex(&apart, p, NULL));
    }
    for (uint32_t i = 0; i < import.soup.corner_count; i += 3) {
        bench_require(he_soup_add_face(&apart, (uint32_t[3]){i, i + 1, i + 2}, 3, NULL));
    }
    bench_require(he_build(&apart, 0, &mesh, NULL, NULL));
    he_soup_clear(&apart);
    he_import_clear(&import);
    return mesh;
}

void bench_distance(bench_side *side, const char *name, bench_result *out)
{
    const he_mesh *input = bench_mesh(side);
    he_mesh *result = read_faces(side, name);
    he_bvh *of_input, *of_result;
    bench_require(he_bvh_new(input, NULL, &of_input, NULL));
    bench_require(he_bvh_new(result, NULL, &of_result, NULL));
    sums there = sample(result, of_input, input), back = sample(input, of_result, result);
    out->value = sqrt(fmax(there.squares, back.squares) / SAMPLES);
    out->amount = there.turned + back.turned;
    bench_near(out, fmax(there.farthest, back.farthest));
    he_bvh_free(of_result);
    he_bvh_free(of_input);
    he_mesh_free(result);
}

static void decimate_error(bench_side *side, bench_result *out)
{
    bench_distance(side, "decimated.ply", out);
}

const bench_row bench_error_rows[] = {{"decimate_error", decimate_error}, {NULL, NULL}};
