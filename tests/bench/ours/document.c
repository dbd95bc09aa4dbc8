/* Benchmark rows: JSON mesh documents in memory, both making a mesh from a document and a document
 * from a mesh. */
#include "bench/ours/ours.h"

#include "api/document/document_in.h"
#include "api/document/document_out.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PIECE = 65536 };

static char *print(const he_mesh *m, size_t *length)
{
    char *text = NULL;
    size_t room = 0;
    int64_t n = 1;
    api_document_out *out = api_document_out_new(m, "");
    *length = 0;
    while (out != NULL && n > 0) {
        if (room - *length < PIECE) {
            room = room * 2 + 2 * (size_t)PIECE;
            text = realloc(text, room);
        }
        n = api_document_out_read(out, text + *length, PIECE);
        *length += n > 0 ? (size_t)n : 0;
    }
    api_document_out_free(out);
    return text;
}

/* Writes the document to the benchmark's folder, for the program that is compared with ours. */
static void make_document(bench_side *side, bench_result *out)
{
    size_t length;
    char *text = print(bench_mesh(side), &length);
    FILE *file = bench_open(side, "input.json", "wb");
    if (fwrite(text, 1, length, file) != length || fclose(file) != 0) {
        fprintf(stderr, "input.json cannot be written\n");
        exit(1);
    }
    out->amount = (double)length;
    free(text);
}

static void json_read(bench_side *side, bench_result *out)
{
    api_problem problem = {0};
    he_mesh *mesh;
    size_t length;
    char *text = print(bench_mesh(side), &length);
    double start = bench_seconds();
    api_document_in *in = api_document_in_new(NULL);
    bool good = in != NULL;
    for (size_t at = 0; good && at < length; at += PIECE) {
        good = api_document_in_feed(in, text + at, length - at < PIECE ? length - at : PIECE,
                                    &problem);
    }
    if (!good || !api_document_in_end(in, &problem)) {
        fprintf(stderr, "the document was refused\n");
        exit(1);
    }
    bench_require(he_build(api_document_in_soup(in), HE_BUILD_TAKE, &mesh, NULL, NULL));
    api_document_in_free(in);
    out->value = bench_seconds() - start;
    out->amount = (double)length;
    bench_exact(out, bench_counts(0, he_mesh_vertices(mesh), 0, he_mesh_faces(mesh)));
    he_mesh_free(mesh);
    free(text);
}

static void json_print(bench_side *side, bench_result *out)
{
    size_t length;
    const he_mesh *m = bench_mesh(side);
    double start = bench_seconds();
    char *text = print(m, &length);
    out->value = bench_seconds() - start;
    out->amount = (double)length;
    bench_exact(out, bench_counts(0, he_mesh_vertices(m), 0, he_mesh_faces(m)));
    free(text);
}

const bench_row bench_document_rows[] = {{"make_document", make_document},
                                         {"json_read", json_read},
                                         {"json_print", json_print},
                                         {NULL, NULL}};
