/* Benchmark rows: many small edits at random places of a copy of the mesh, and compacting it
 * afterwards. */
#include "bench/ours/ours.h"
#include "edit/local/collapse.h"
#include "edit/local/cut.h"
#include "edit/local/flip.h"
#include "edit/local/split.h"
#include "mesh/compact.h"
#include "mesh/delta.h"
#include "mesh/walk.h"

#include <stdlib.h>

/* A function that makes an edit at a half-edge; it returns false if the edit was refused. */
typedef bool (*edit)(he_mesh *m, he_halfedge h);

static bool split(he_mesh *m, he_halfedge h)
{
    return he_edge_split(m, he_edge_of(h), 0.5, NULL, NULL) == HE_OK;
}

static bool flip(he_mesh *m, he_halfedge h)
{
    return he_edge_flip(m, he_edge_of(h), NULL) == HE_OK;
}

/* Collapses an edge. The kernel refuses it if an earlier collapse has deleted the edge. */
static bool collapse(he_mesh *m, he_halfedge h)
{
    return he_edge_collapse(m, h, 1, NULL, NULL, NULL) == HE_OK;
}

/* Returns the half-edges of the mesh where edits are made, which are the same in every program. */
static he_halfedge *find_picks(const bench_side *side, const he_mesh *m, uint32_t *count)
{
    bench_pick *picks = bench_picks(&side->input, count);
    he_halfedge *found = calloc(*count, sizeof *found);
    for (uint32_t i = 0; i < *count; i++) {
        uint32_t corner = picks[i].face * side->input.degree + picks[i].corner;
        found[i] =
            he_face_corner(m, (he_face){picks[i].face}, (he_vertex){side->input.corners[corner]});
    }
    free(picks);
    return found;
}

/* How edits are made. RECORDED: the mesh records each edit in a delta, which is emptied after the
 * edit, as in a store that passes each delta on. OF_A_LIST: the kernel is told in advance which
 * edges come next, as an algorithm such as delaunay can tell it. */
enum { RECORDED = 1, OF_A_LIST = 2 };

/* Tries the edit at `count` half-edges of a copy of the mesh; returns the copy. */
static he_mesh *run(bench_side *side, edit try, uint32_t count, unsigned how, bench_result *out)
{
    enum { NEXT = 2, SOON = 4 };
    he_mesh *m;
    he_halfedge *picks = find_picks(side, bench_mesh(side), &count);
    bench_require(he_mesh_copy(bench_mesh(side), &m, NULL));
    he_delta *delta = he_delta_new();
    if (how & RECORDED) {
        he_mesh_record(m, delta);
    }
    uint64_t done = 0;
    double start = bench_seconds();
    for (uint32_t i = 0; i < count; i++) {
        if ((how & OF_A_LIST) && i + SOON < count) {
            he_prefetch_coming(m, he_edge_of(picks[i + NEXT]), he_edge_of(picks[i + SOON]));
        }
        done += try(m, picks[i]);
        if (how & RECORDED) {
            he_delta_empty(delta);
        }
    }
    out->value = bench_seconds() - start;
    out->amount = count;
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    free(picks);
    bench_exact(out, bench_mesh_hash(m));
    bench_near(out, (double)done);
    return m;
}

enum { SPLITS = 300000, FLIPS = 1000000, COLLAPSES = 300000 };

static void time_split(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, split, SPLITS, 0, out));
}

static void time_split_list(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, split, SPLITS, OF_A_LIST, out));
}

static void time_split_recorded(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, split, SPLITS, RECORDED, out));
}

static void time_flip(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, flip, FLIPS, 0, out));
}

static void time_flip_list(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, flip, FLIPS, OF_A_LIST, out));
}

static void time_flip_recorded(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, flip, FLIPS, RECORDED, out));
}

static void time_collapse(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, collapse, COLLAPSES, 0, out));
}

static void time_collapse_list(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, collapse, COLLAPSES, OF_A_LIST, out));
}

static void time_collapse_recorded(bench_side *side, bench_result *out)
{
    he_mesh_free(run(side, collapse, COLLAPSES, RECORDED, out));
}

/* Returns a hash of the mesh by positions, because every library numbers the vertices differently
 * after edits. */
static uint64_t place_hash(const he_mesh *m)
{
    uint64_t hash = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        uint32_t corners[3];
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        for (int i = 0; i < 3; i++) {
            he_vec3 p = he_position(m, he_origin(m, h));
            corners[i] = bench_place_hash(p.x, p.y, p.z);
            h = he_next(m, h);
        }
        hash += bench_face_hash(corners, 3);
    }
    return bench_counts(hash, he_mesh_vertices(m), he_mesh_edges(m), he_mesh_faces(m));
}

static void compact(bench_side *side, bench_result *out)
{
    he_mesh *m = run(side, collapse, COLLAPSES, 0, out);
    double start = bench_seconds();
    bench_require(he_compact(m, NULL, NULL));
    out->value = bench_seconds() - start;
    out->amount = side->input.faces;
    bench_exact(out, place_hash(m));
    bench_near(out, he_mesh_faces(m));
    he_mesh_free(m);
}

const bench_row bench_edit_rows[] = {{"split", time_split},
                                     {"split_list", time_split_list},
                                     {"split_recorded", time_split_recorded},
                                     {"flip", time_flip},
                                     {"flip_list", time_flip_list},
                                     {"flip_recorded", time_flip_recorded},
                                     {"collapse", time_collapse},
                                     {"collapse_list", time_collapse_list},
                                     {"collapse_recorded", time_collapse_recorded},
                                     {"compact", compact},
                                     {NULL, NULL}};
