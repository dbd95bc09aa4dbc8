#include "op/rows.h"

#include "edit/border/bridge.h"
#include "edit/border/loop_join.h"
#include "edit/border/loop_split.h"

enum { LOOP_BRIDGE_A, LOOP_BRIDGE_B };
enum { LOOP_BRIDGE_OUT_EDGES, LOOP_BRIDGE_OUT_FACES };

static he_status run_loop_bridge(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_bridge bridge;
    he_status status = he_loop_bridge(m, (he_halfedge){args[LOOP_BRIDGE_A].id},
                                      (he_halfedge){args[LOOP_BRIDGE_B].id}, &bridge, err);
    if (status == HE_OK) {
        he_results_set_list(out, LOOP_BRIDGE_OUT_EDGES, &bridge.edges);
        he_results_set_list(out, LOOP_BRIDGE_OUT_FACES, &bridge.faces);
        he_bridge_clear(&bridge);
    }
    return status;
}

enum { LOOP_JOIN_A, LOOP_JOIN_B };
enum { LOOP_JOIN_OUT_MOVED };

static he_status run_loop_join(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    uint64_t moved = 0;
    he_status status = he_loop_join(m, (he_halfedge){args[LOOP_JOIN_A].id},
                                    (he_halfedge){args[LOOP_JOIN_B].id}, &moved, err);
    if (status == HE_OK) {
        he_results_set_number(out, LOOP_JOIN_OUT_MOVED, (double)moved);
    }
    return status;
}

enum { LOOP_SPLIT_A, LOOP_SPLIT_B, LOOP_SPLIT_C };
enum { LOOP_SPLIT_OUT_VERTICES, LOOP_SPLIT_OUT_EDGES, LOOP_SPLIT_OUT_FACES };

static he_status run_loop_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_loop_parts parts;
    he_status status = HE_OK;
    for (size_t i = LOOP_SPLIT_OUT_VERTICES; status == HE_OK && i <= LOOP_SPLIT_OUT_FACES; i++) {
        status = he_results_reserve(out, i, 3, err);
    }
    if (status == HE_OK) {
        status =
            he_loop_split(m, (he_edge){args[LOOP_SPLIT_A].id}, (he_edge){args[LOOP_SPLIT_B].id},
                          (he_edge){args[LOOP_SPLIT_C].id}, &parts, err);
    }
    if (status == HE_OK) {
        for (size_t i = 0; i < 3; i++) {
            he_results_add(out, LOOP_SPLIT_OUT_VERTICES, parts.vertices[i].i);
            he_results_add(out, LOOP_SPLIT_OUT_EDGES, parts.edges[i].i);
        }
        he_results_add(out, LOOP_SPLIT_OUT_FACES, parts.faces[0].i);
        he_results_add(out, LOOP_SPLIT_OUT_FACES, parts.faces[1].i);
    }
    return status;
}

const he_op he_loop_rows[] = {
    {
        .name = "loop_bridge",
        .doc = "Join two holes by a strip of faces, which are quads if both holes have the same "
               "number of edges, otherwise triangles.",
        .params = {[LOOP_BRIDGE_A] = {.name = "a",
                                      .each = "a",
                                      .type = HE_PARAM_ELEMENT,
                                      .kind = HE_HALFEDGE,
                                      .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                                      .doc = "A boundary half-edge of one hole."},
                   [LOOP_BRIDGE_B] =
                       {.name = "b",
                        .type = HE_PARAM_ELEMENT,
                        .kind = HE_HALFEDGE,
                        .flags = HE_REQUIRED | HE_WALKS,
                        .doc = "A boundary half-edge of the other hole. The positions decide which "
                               "corners are joined."}},
        .results = {[LOOP_BRIDGE_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                               "The new edges, beginning at the origin of `a`."},
                    [LOOP_BRIDGE_OUT_FACES] =
                        {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                         "The new faces: face i lies between entries i and i + 1 of `edges`, and "
                         "the last face between the last entry and the first."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_NOT_BOUNDARY, HE_SAME_LOOP,
                     HE_SHARED_VERTEX, HE_DOUBLED_EDGE},
        .change = {0, HE_VARIES, HE_VARIES},
        .run = run_loop_bridge,
    },
    {
        .name = "loop_join",
        .doc = "Sew together two loops with the same number of edges. Each loop is the outline of "
               "a hole, or of a face, which is removed.",
        .params = {[LOOP_JOIN_A] = {.name = "a",
                                    .each = "a",
                                    .type = HE_PARAM_ELEMENT,
                                    .kind = HE_HALFEDGE,
                                    .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                                    .doc =
                                        "A half-edge of the loop whose vertices and edges stay."},
                   [LOOP_JOIN_B] = {.name = "b",
                                    .type = HE_PARAM_ELEMENT,
                                    .kind = HE_HALFEDGE,
                                    .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                                    .doc = "The half-edge of the other loop that is merged with "
                                           "`a`; its target is merged into the origin of `a`."}},
        .results = {[LOOP_JOIN_OUT_MOVED] =
                        {"moved", HE_RESULT_NUMBER, 0,
                         "How many attribute values of vertices became values of corners, because "
                         "the merged vertices had different values."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_SAME_LOOP, HE_LOOP_LENGTH,
                     HE_REPEATED_CORNER, HE_SHARED_VERTEX, HE_BOUNDARY_EDGE, HE_DOUBLED_EDGE,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .run = run_loop_join,
    },
    {
        .name = "loop_split",
        .doc = "Cut the mesh around three edges and cap both sides of the cut with triangles. This "
               "is the inverse of loop_join.",
        .params = {[LOOP_SPLIT_A] = {.name = "a",
                                     .each = "a",
                                     .type = HE_PARAM_ELEMENT,
                                     .kind = HE_EDGE,
                                     .flags = HE_REQUIRED | HE_WALKS,
                                     .doc = "An edge of the cycle. The side of the cut to the left "
                                            "of its first half-edge keeps the vertices."},
                   [LOOP_SPLIT_B] = {.name = "b",
                                     .type = HE_PARAM_ELEMENT,
                                     .kind = HE_EDGE,
                                     .flags = HE_REQUIRED,
                                     .doc = "The second edge of the cycle."},
                   [LOOP_SPLIT_C] = {.name = "c",
                                     .type = HE_PARAM_ELEMENT,
                                     .kind = HE_EDGE,
                                     .flags = HE_REQUIRED,
                                     .doc = "The third edge of the cycle."}},
        .results =
            {[LOOP_SPLIT_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                          "The new vertices, beginning with the copy of the origin "
                                          "of the first half-edge of `a`."},
             [LOOP_SPLIT_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                       "The new edges in the order of the new vertices: the first "
                                       "joins the first and second new vertex, and so on."},
             [LOOP_SPLIT_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                       "The two triangles that cap the cut: first the one at the "
                                       "old vertices, then the one at the new vertices."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_NOT_A_CYCLE, HE_BOUNDARY_VERTEX,
                     HE_SHARED_FACE, HE_LOCKED_ELEMENT},
        .change = {3, 3, 2},
        .run = run_loop_split,
    },
    {.name = NULL},
};
