/* Benchmark rows: a mesh and its edits encoded as bytes (core/stored). They measure the size of an
 * encoded edit, the time to apply many edits, and the encoding of whole meshes. */
#include "bench/ours/ours.h"

#include "edit/local/collapse.h"
#include "edit/local/flip.h"
#include "edit/local/poke.h"
#include "edit/local/split.h"
#include "edit/local/vertex.h"
#include "mesh/delta.h"
#include "mesh/walk.h"
#include "stored/stored.h"

#include <stdio.h>
#include <stdlib.h>

enum { EDITS = 1000, SPLITS = 10000 };

/* A function that makes an edit at a half-edge of a mesh that records its changes; it returns false
 * if the edit was refused. */
typedef bool (*edit)(he_mesh *m, he_halfedge h);

static bool move(he_mesh *m, he_halfedge h)
{
    he_vertex v = he_origin(m, h);
    he_vec3 p = he_position(m, v), to = {p.x + 0.1, p.y + 0.2, p.z - 0.3};
    return he_vertex_move(m, &v.i, 1, HE_MOVE_TO, &to, 1, NULL) == HE_OK;
}

static bool flip(he_mesh *m, he_halfedge h)
{
    return he_edge_flip(m, he_edge_of(h), NULL) == HE_OK;
}

static bool poke(he_mesh *m, he_halfedge h)
{
    return he_face_poke(m, he_face_of(m, h), NULL, NULL, NULL, NULL, NULL) == HE_OK;
}

static bool split(he_mesh *m, he_halfedge h)
{
    return he_edge_split(m, he_edge_of(h), 0.5, NULL, NULL) == HE_OK;
}

static bool collapse(he_mesh *m, he_halfedge h)
{
    return he_edge_collapse(m, h, 0.5, NULL, NULL, NULL) == HE_OK;
}

/* A list of encoded edits, whose bytes follow each other. */
typedef struct coded {
    unsigned char *bytes;
    size_t size, capacity, count;
    struct {
        size_t at, size;
        uint32_t issued[HE_KIND_COUNT];
    } edit[SPLITS];
} coded;

static void keep(coded *list, const he_delta *delta, const he_mesh *m)
{
    size_t bound = he_stored_edit_bound(delta, m);
    if (bound > list->capacity - list->size) {
        list->capacity = 2 * list->capacity + bound;
        list->bytes = realloc(list->bytes, list->capacity);
    }
    size_t size = he_stored_edit_write(delta, m, list->bytes + list->size), i = list->count++;
    list->edit[i].at = list->size;
    list->edit[i].size = size;
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        list->edit[i].issued[kind] = he_mesh_issued(m, (he_kind)kind);
    }
    list->size += size;
}

/* Makes edits all over a copy of the mesh and encodes them; refused edits are left out. */
static coded *code_edits(bench_side *side, edit try, uint32_t count)
{
    he_mesh *m;
    coded *list = calloc(1, sizeof *list);
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    uint32_t edges = he_mesh_edges(m);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    for (uint32_t i = 0; i < count; i++) {
        he_halfedge h = he_edge_halfedge((he_edge){(uint32_t)((uint64_t)i * edges / count)}, 0);
        if (he_edge_is_live(m, he_edge_of(h)) && try(m, h)) {
            keep(list, delta, m);
        }
        he_delta_empty(delta);
    }
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    he_mesh_free(m);
    return list;
}

static void coded_free(coded *list)
{
    free(list->bytes);
    free(list);
}

static void record(bench_side *side, edit try, bench_result *out)
{
    coded *list = code_edits(side, try, EDITS);
    out->value = (double)list->size;
    out->amount = (double)list->count;
    coded_free(list);
}

static void stored_move(bench_side *side, bench_result *out)
{
    record(side, move, out);
}

static void stored_flip(bench_side *side, bench_result *out)
{
    record(side, flip, out);
}

static void stored_poke(bench_side *side, bench_result *out)
{
    record(side, poke, out);
}

static void stored_split(bench_side *side, bench_result *out)
{
    record(side, split, out);
}

static void stored_collapse(bench_side *side, bench_result *out)
{
    record(side, collapse, out);
}

/* Decodes edge splits and applies them to a copy of the mesh from before these splits. */
static void stored_forward(bench_side *side, bench_result *out)
{
    he_mesh *m;
    coded *list = code_edits(side, split, SPLITS);
    he_delta **deltas = calloc(list->count, sizeof *deltas);
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    /* The first edit has to enlarge the arrays of the mesh, which copies all of it, so it is not
     * measured. */
    bench_require(he_stored_edit_forward(list->bytes, list->edit[0].size, list->edit[0].issued, m,
                                         &deltas[0], NULL));
    double start = bench_seconds();
    for (size_t i = 1; i < list->count; i++) {
        bench_require(he_stored_edit_forward(list->bytes + list->edit[i].at, list->edit[i].size,
                                             list->edit[i].issued, m, &deltas[i], NULL));
    }
    out->value = bench_seconds() - start;
    out->amount = (double)list->count - 1;
    for (size_t i = 0; i < list->count; i++) {
        he_delta_free(deltas[i]);
    }
    free(deltas);
    coded_free(list);
    he_mesh_free(m);
}

/* Returns a block of memory that is large enough for the encoded mesh and contains it. All pages of
 * the block have been written to. */
static unsigned char *block_of(const he_mesh *m, size_t *size)
{
    unsigned char *block = calloc(he_stored_content_bound(m), 1);
    *size = he_stored_content_write(m, block);
    return block;
}

static void content_write(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    size_t size;
    unsigned char *block = block_of(m, &size);
    double start = bench_seconds();
    size = he_stored_content_write(m, block);
    out->value = bench_seconds() - start;
    out->amount = (double)he_mesh_bytes(m) / 1e6;
    free(block);
}

static void content_read(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    he_mesh *read;
    size_t size;
    unsigned char *block = block_of(m, &size);
    double start = bench_seconds();
    bench_require(he_stored_content_read(block, size, &read, NULL));
    out->value = bench_seconds() - start;
    out->amount = (double)he_mesh_bytes(m) / 1e6;
    if (!he_mesh_equal(read, m)) {
        fprintf(stderr, "the mesh came back as another\n");
        exit(1);
    }
    free(block);
    he_mesh_free(read);
}

static void content_bytes(bench_side *side, bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    size_t size;
    free(block_of(m, &size));
    out->value = (double)size;
    out->amount = he_mesh_faces(m);
}

const bench_row bench_stored_rows[] = {
    {"stored_move", stored_move},         {"stored_flip", stored_flip},
    {"stored_poke", stored_poke},         {"stored_split", stored_split},
    {"stored_collapse", stored_collapse}, {"stored_forward", stored_forward},
    {"content_write", content_write},     {"content_read", content_read},
    {"content_bytes", content_bytes},     {NULL, NULL}};
