/* Benchmark rows: deformation, and the energy of the result, which any of the programs has made. */
#include "bench/ours/ours.h"
#include "deform/deform.h"
#include "deform/rotation.h"
#include "mesh/walk.h"

#include <stdlib.h>

static const char *const FILE_NAME = "deformed.bin";

typedef struct lists {
    uint32_t *handles, *fixed;
    he_vec3 *goals;
    size_t handle_count, fixed_count;
} lists;

static void make_lists(const bench_side *side, lists *l)
{
    const size_t room = side->input.vertices;
    *l = (lists){.handles = malloc(room * sizeof *l->handles),
                 .fixed = malloc(room * sizeof *l->fixed),
                 .goals = malloc(room * sizeof *l->goals)};
    if (l->handles == NULL || l->fixed == NULL || l->goals == NULL) {
        bench_require(HE_NO_MEMORY);
    }
    for (uint32_t v = 0; v < side->input.vertices; v++) {
        double to[3];
        switch (bench_deform_part(side, v)) {
        case BENCH_HANDLE:
            bench_deform_goal(side, v, to);
            l->goals[l->handle_count] = (he_vec3){to[0], to[1], to[2]};
            l->handles[l->handle_count++] = v;
            break;
        case BENCH_FIXED:
            l->fixed[l->fixed_count++] = v;
            break;
        case BENCH_FREE:
            break;
        }
    }
}

static void clear_lists(lists *l)
{
    free(l->handles);
    free(l->fixed);
    free(l->goals);
}

static void deform(bench_side *side, bench_result *out)
{
    he_mesh *m;
    lists l;
    make_lists(side, &l);
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    const he_deform_sets sets = {HE_DEFORM_ARAP, l.handles, l.handle_count, l.fixed, l.fixed_count};
    const he_deform_goal goal = {.to = l.goals, .count = l.handle_count};
    const double start = bench_seconds();
    bench_require(he_deform(m, &sets, &goal, 10, NULL, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.vertices;
    bench_write_positions(side, FILE_NAME, m, 0);
    he_mesh_free(m);
    clear_lists(&l);
}

/* Measures one step of a system that is ready. */
static void drag(bench_side *side, he_deform_method method, bench_result *out)
{
    lists l;
    he_deformer *d;
    he_mesh *m = bench_mesh(side);
    uint32_t count;
    make_lists(side, &l);
    const he_deform_sets sets = {method, l.handles, l.handle_count, l.fixed, l.fixed_count};
    bench_require(he_deformer_make(m, &sets, NULL, &d, NULL));
    (void)he_deformer_vertices(d, &count);
    he_deform_motion motion = {
        .goals = l.goals, .steps = 1, .positions = malloc(count * sizeof *motion.positions)};
    if (motion.positions == NULL) {
        bench_require(HE_NO_MEMORY);
    }
    const double start = bench_seconds();
    bench_require(he_deformer_solve(d, &motion, NULL, NULL));
    out->value = bench_seconds() - start;
    out->amount = count;
    free(motion.positions);
    he_deformer_free(d);
    const he_deform_goal goal = {.to = l.goals, .count = l.handle_count};
    bench_require(he_mesh_copy(m, &m, NULL));
    bench_require(he_deform(m, &sets, &goal, 1, NULL, NULL));
    bench_write_positions(side, FILE_NAME, m, 0);
    he_mesh_free(m);
    clear_lists(&l);
}

static void deform_drag(bench_side *side, bench_result *out)
{
    drag(side, HE_DEFORM_ARAP, out);
}
static void deform_biharmonic(bench_side *side, bench_result *out)
{
    drag(side, HE_DEFORM_BIHARMONIC, out);
}

static he_vec3 corner_at(const double *positions, uint32_t v)
{
    const double *p = positions + 3 * (size_t)v;
    return (he_vec3){p[0], p[1], p[2]};
}

/* Adds the product of the old and the new edge to both vertices, and returns the part of the energy
 * that does not depend on the rotations. */
static double add_edge(const bench_side *side, const double *after, double (*products)[9],
                       const uint32_t edge[2], double weight)
{
    const double *before = side->input.positions;
    const he_vec3 p = he_vec3_sub(corner_at(before, edge[0]), corner_at(before, edge[1]));
    const he_vec3 q = he_vec3_sub(corner_at(after, edge[0]), corner_at(after, edge[1]));
    he_matrix_add(products[edge[0]], weight, q, p);
    he_matrix_add(products[edge[1]], weight, q, p);
    return 2 * weight * (he_vec3_dot(p, p) + he_vec3_dot(q, q));
}

/* VALUE: the energy of Sorkine and Alexa, with the cotangent weights of the triangles of the input
 * and the best rotation of each vertex. */
static void deform_energy(bench_side *side, bench_result *out)
{
    const bench_input *in = &side->input;
    double *after = malloc(3 * (size_t)in->vertices * sizeof *after), energy = 0;
    double(*products)[9] = calloc(in->vertices, sizeof *products);
    FILE *file = bench_open(side, FILE_NAME, "rb");
    if (after == NULL || products == NULL ||
        fread(after, 3 * sizeof *after, in->vertices, file) != in->vertices) {
        bench_require(HE_NO_MEMORY);
    }
    (void)fclose(file);
    for (uint32_t f = 0; f < in->faces; f++) {
        const uint32_t *c = in->corners + in->starts[f];
        for (unsigned i = 0; i < 3; i++) {
            const he_vec3 p = corner_at(in->positions, c[i]);
            const uint32_t edge[2] = {c[(i + 1) % 3], c[(i + 2) % 3]};
            const he_vec3 a = he_vec3_sub(corner_at(in->positions, edge[0]), p),
                          b = he_vec3_sub(corner_at(in->positions, edge[1]), p);
            const double weight = he_vec3_dot(a, b) / he_vec3_length(he_vec3_cross(a, b)) / 2;
            energy += add_edge(side, after, products, edge, weight);
        }
    }
    for (uint32_t v = 0; v < in->vertices; v++) {
        const he_rotation r = he_rotation_nearest(products[v]);
        for (int k = 0; k < 9; k++) {
            energy -= 2 * r.k[k] * products[v][k];
        }
    }
    out->value = energy;
    out->amount = in->vertices;
    free(after);
    free(products);
}

const bench_row bench_deform_rows[] = {{"deform", deform},
                                       {"deform_drag", deform_drag},
                                       {"deform_biharmonic", deform_biharmonic},
                                       {"deform_energy", deform_energy},
                                       {NULL, NULL}};
