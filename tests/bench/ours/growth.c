/* Benchmark rows of which only the growth of time with the size matters: the checker of meshes, and
 * memory access by itself. */
#include "bench/ours/ours.h"

#include "base/mem.h"
#include "mesh/check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    he_problem problem;
    size_t total;
    double start = bench_seconds();
    bench_require(he_check(m, &problem, 1, &total, NULL));
    out->value = bench_seconds() - start;
    out->amount = he_mesh_faces(m);
    if (total != 0) {
        fprintf(stderr, "the mesh is not valid: %s\n", problem.text);
        exit(1);
    }
}

/* Measures reads of words at random places of a block as large as the mesh; no read depends on
 * another. */
static void gather(bench_side *side, bench_result *out)
{
    enum { READS = 1 << 23, BYTES_A_FACE = 66 };
    uint64_t words = (uint64_t)side->input.faces * BYTES_A_FACE / sizeof(uint32_t), state = 1;
    uint32_t *block = he_mem_array(NULL, words, sizeof *block), sum = 0;
    if (block == NULL) {
        bench_require(HE_NO_MEMORY);
    }
    memset(block, 1, words * sizeof *block);
    double start = bench_seconds();
    for (int i = 0; i < READS; i++) {
        /* The places come from a linear congruential generator (Knuth, TAOCP 2, 3.3.4). */
        state = state * 6364136223846793005u + 1442695040888963407u;
        sum += block[(state >> 32) * words >> 32];
    }
    out->value = bench_seconds() - start;
    out->amount = READS;
    bench_near(out, sum);
    he_mem_free(block);
}

const bench_row bench_growth_rows[] = {{"check", check}, {"gather", gather}, {NULL, NULL}};
