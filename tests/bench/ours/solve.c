/* Benchmark rows: linear systems over the surface of a mesh (core/solve). */
#include "bench/ours/ours.h"

#include "solve/factor.h"
#include "solve/laplacian.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDES = 3 };

/* Writes the lower triangle of a matrix: the number of rows and of entries, then the entries. */
static void write_matrix(const bench_side *side, const he_sparse *m, const char *name)
{
    FILE *file = bench_open(side, name, "wb");
    uint32_t count = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t j = 0; j < m->n; j++) {
            for (size_t i = m->starts[j]; i < m->starts[j + 1]; i++) {
                const he_entry entry = {m->rows[i], j, m->values[i]};
                if (entry.row >= j && pass == 0) {
                    count++;
                } else if (entry.row >= j && fwrite(&entry, sizeof entry, 1, file) != 1) {
                    fprintf(stderr, "%s cannot be written\n", name);
                    exit(1);
                }
            }
        }
        if (pass == 0) {
            fwrite(&m->n, sizeof m->n, 1, file);
            fwrite(&count, sizeof count, 1, file);
        }
    }
    fclose(file);
}

/* Makes the matrices M + t L, of a step of the heat equation by about a hundred triangles, and
 * M + t^2 L (1/M) L. */
static void make_matrices(bench_side *side, bench_result *out)
{
    const bench_input *in = &side->input;
    he_vec3 *points = malloc(in->vertices * sizeof *points);
    for (uint32_t v = 0; v < in->vertices; v++) {
        const double *p = in->positions + 3 * (size_t)v;
        points[v] = (he_vec3){p[0], p[1], p[2]};
    }
    const he_surface surface = {in->vertices, in->faces, in->corners, points};
    he_laplacian l, power = {0};
    he_sparse step;
    bench_require(he_laplacian_make(&surface, NULL, &l, NULL));
    double amount = 0, *inverse = malloc(in->vertices * sizeof *inverse);
    for (uint32_t v = 0; v < in->vertices; v++) {
        amount += 100 * l.masses[v] / in->vertices;
        inverse[v] = 1 / l.masses[v];
    }
    bench_require(he_laplacian_step(&l, amount, &step, NULL));
    write_matrix(side, &step, "cotangents.bin");
    he_sparse_clear(&step);
    bench_require(he_sparse_product(&l.matrix, inverse, &l.matrix, &power.matrix, NULL, NULL));
    power.masses = l.masses;
    bench_require(he_laplacian_step(&power, amount * amount, &step, NULL));
    write_matrix(side, &step, "biharmonic.bin");
    he_sparse_clear(&step);
    he_sparse_clear(&power.matrix);
    he_laplacian_clear(&l);
    free(inverse);
    free(points);
    out->amount = in->vertices;
}

static he_sparse read_matrix(const bench_side *side, const char *name)
{
    FILE *file = bench_open(side, name, "rb");
    uint32_t sizes[2];
    he_sparse m;
    if (fread(sizes, sizeof sizes, 1, file) != 1) {
        sizes[0] = sizes[1] = 0;
    }
    he_entry *entries = malloc((size_t)sizes[1] * sizeof *entries + 1);
    if (entries == NULL || fread(entries, sizeof *entries, sizes[1], file) != sizes[1]) {
        fprintf(stderr, "%s cannot be read\n", name);
        exit(1);
    }
    bench_require(he_sparse_make(sizes[0], entries, sizes[1], &m, NULL));
    free(entries);
    fclose(file);
    return m;
}

static void factor_of(const bench_side *side, const char *name, bench_result *out)
{
    he_sparse m = read_matrix(side, name);
    he_factor *f = NULL;
    const double start = bench_seconds();
    bench_require(he_factor_make(&m, NULL, &f, NULL));
    out->value = bench_seconds() - start;
    out->amount = m.n;
    he_factor_free(f);
    he_sparse_clear(&m);
}

static void factor(bench_side *side, bench_result *out)
{
    factor_of(side, "cotangents.bin", out);
}

static void factor_biharmonic(bench_side *side, bench_result *out)
{
    factor_of(side, "biharmonic.bin", out);
}

/* The right sides are sines of the row's number, so that they are equal in each program. */
static void solve(bench_side *side, bench_result *out)
{
    he_sparse m = read_matrix(side, "cotangents.bin");
    he_factor *f = NULL;
    const size_t count = (size_t)m.n * SIDES;
    double *x = malloc(count * sizeof *x), sum = 0, residual;
    for (size_t i = 0; i < count; i++) {
        x[i] = sin((double)i);
    }
    bench_require(he_factor_make(&m, NULL, &f, NULL));
    const double start = bench_seconds();
    bench_require(he_factor_solve(f, &m, (he_right_sides){x, x, SIDES, false}, &residual, NULL));
    out->value = bench_seconds() - start;
    out->amount = m.n;
    for (size_t i = 0; i < count; i++) {
        sum += fabs(x[i]);
    }
    bench_near(out, sum);
    free(x);
    he_factor_free(f);
    he_sparse_clear(&m);
}

const bench_row bench_solve_rows[] = {{"make_matrices", make_matrices},
                                      {"factor", factor},
                                      {"factor_biharmonic", factor_biharmonic},
                                      {"solve", solve},
                                      {NULL, NULL}};
