/* Benchmark rows that measure only memory: a history as the store keeps it, and mesh documents read
 * from and written to files. The rows of the other tables can be run with a memory measurement,
 * too. */
#include "bench/ours/ours.h"

#include "api/document/document_in.h"
#include "api/document/document_out.h"
#include "edit/local/split.h"
#include "mesh/delta.h"

#include <stdio.h>
#include <stdlib.h>

enum { SPLITS = 300000, PIECE = 65536 };

/* Splits edges all over a copy of the mesh and keeps the delta of each split for undo. With
 * `undone` all splits are undone afterwards, so that the memory that stays allocated is measured.
 * The growth of the mesh itself is measured by the row `split`. */
static void keep_history(bench_side *side, bool undone, bench_result *out)
{
    he_mesh *m;
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    uint32_t edges = he_mesh_edges(m), count = edges < SPLITS ? edges : SPLITS;
    he_delta **deltas = calloc(count, sizeof *deltas);
    double start = bench_seconds();
    for (uint32_t i = 0; i < count; i++) {
        deltas[i] = he_delta_new();
        he_mesh_record(m, deltas[i]);
        he_edge edge = {(uint32_t)((uint64_t)i * edges / count)};
        bench_require(he_edge_split(m, edge, 0.5, NULL, NULL));
        he_delta_trim(deltas[i]);
    }
    he_mesh_record(m, NULL);
    for (uint32_t i = count; undone && i-- > 0;) {
        he_delta_undo(deltas[i], m);
    }
    out->value = bench_seconds() - start;
    out->amount = count;
    for (uint32_t i = 0; i < count; i++) {
        he_delta_free(deltas[i]);
    }
    free(deltas);
    he_mesh_free(m);
}

static void split_kept(bench_side *side, bench_result *out)
{
    keep_history(side, false, out);
}

static void split_undone(bench_side *side, bench_result *out)
{
    keep_history(side, true, out);
}

static void import_json(bench_side *side, bench_result *out)
{
    api_problem problem = {0};
    he_mesh *mesh;
    char *piece = malloc(PIECE);
    FILE *file = bench_open(side, "input.json", "rb");
    double start = bench_seconds();
    api_document_in *in = api_document_in_new(NULL);
    size_t n;
    bool good = in != NULL;
    while (good && (n = fread(piece, 1, PIECE, file)) > 0) {
        good = api_document_in_feed(in, piece, n, &problem);
    }
    if (!good || !api_document_in_end(in, &problem)) {
        fprintf(stderr, "the document was refused\n");
        exit(1);
    }
    bench_require(he_build(api_document_in_soup(in), HE_BUILD_TAKE, &mesh, NULL, NULL));
    api_document_in_free(in);
    out->value = bench_seconds() - start;
    out->amount = he_mesh_faces(mesh);
    fclose(file);
    free(piece);
    he_mesh_free(mesh);
}

static void export_json(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    char *piece = malloc(PIECE);
    FILE *file = bench_open(side, "output.json", "wb");
    double start = bench_seconds();
    api_document_out *document = api_document_out_new(m, "");
    int64_t n = 1;
    while (document != NULL && (n = api_document_out_read(document, piece, PIECE)) > 0) {
        if (fwrite(piece, 1, (size_t)n, file) != (size_t)n) {
            exit(1);
        }
    }
    if (document == NULL || n < 0) {
        fprintf(stderr, "the document was not written\n");
        exit(1);
    }
    api_document_out_free(document);
    out->value = bench_seconds() - start;
    out->amount = he_mesh_faces(m);
    fclose(file);
    free(piece);
}

const bench_row bench_memory_rows[] = {{"split_kept", split_kept},
                                       {"split_undone", split_undone},
                                       {"import_json", import_json},
                                       {"export_json", export_json},
                                       {NULL, NULL}};
