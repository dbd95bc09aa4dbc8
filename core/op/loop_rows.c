#include "op/rows.h"

#include "edit/border/bridge.h"
#include "edit/border/loop_join.h"
#include "edit/border/loop_split.h"

static he_status run_loop_bridge(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_bridge bridge;
    he_status status =
        he_loop_bridge(m, (he_halfedge){args[0].id}, (he_halfedge){args[1].id}, &bridge, err);
    if (status == HE_OK) {
        he_give_list(out, 0, &bridge.edges);
        he_give_list(out, 1, &bridge.faces);
        he_bridge_clear(&bridge);
    }
    return status;
}

static he_status run_loop_join(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    uint64_t moved = 0;
    he_status status =
        he_loop_join(m, (he_halfedge){args[0].id}, (he_halfedge){args[1].id}, &moved, err);
    if (status == HE_OK) {
        he_give_number(out, 0, (double)moved);
    }
    return status;
}

static he_status run_loop_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_loop_parts parts;
    he_status status = HE_OK;
    for (size_t i = 0; status == HE_OK && i < 3; i++) {
        status = he_give_room(out, i, 3, err);
    }
    if (status == HE_OK) {
        status = he_loop_split(m, (he_edge){args[0].id}, (he_edge){args[1].id},
                               (he_edge){args[2].id}, &parts, err);
    }
    if (status == HE_OK) {
        for (size_t i = 0; i < 3; i++) {
            he_give_add(out, 0, parts.vertices[i].i);
            he_give_add(out, 1, parts.edges[i].i);
        }
        he_give_add(out, 2, parts.faces[0].i);
        he_give_add(out, 2, parts.faces[1].i);
    }
    return status;
}

const he_op he_loop_rows[] = {
    {
        .name = "loop_bridge",
        .doc = "Join two holes by a strip of faces: quads if both have the same number of edges, "
               "otherwise triangles.",
        .params = {{.name = "a",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_HALFEDGE,
                    .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                    .doc = "A boundary half-edge of one hole."},
                   {.name = "b",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_HALFEDGE,
                    .flags = HE_REQUIRED | HE_WALKS,
                    .doc = "A boundary half-edge of the other hole. The positions decide which "
                           "corners are joined."}},
        .results = {{"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                     "The new edges, beginning at the origin of `a`."},
                    {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                     "The new faces: each lies between the new edge at the same place in the list "
                     "and the next one."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_NOT_BOUNDARY, HE_SAME_LOOP,
                     HE_SHARED_VERTEX, HE_DOUBLED_EDGE},
        .change = {0, HE_VARIES, HE_VARIES},
        .run = run_loop_bridge,
    },
    {
        .name = "loop_join",
        .doc = "Sew two loops with the same number of edges together. Each is the outline of a "
               "face, which is removed, or of a hole.",
        .params = {{.name = "a",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_HALFEDGE,
                    .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                    .doc = "A half-edge of one loop, whose vertices and edges stay."},
                   {.name = "b",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_HALFEDGE,
                    .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                    .doc = "The half-edge of the other loop that is merged with `a`: its target "
                           "becomes the origin of `a`."}},
        .results = {{"moved", HE_RESULT_NUMBER, 0,
                     "How many values of vertices became values of corners, because merged "
                     "vertices had different ones."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_SAME_LOOP, HE_LOOP_LENGTH,
                     HE_REPEATED_CORNER, HE_SHARED_VERTEX, HE_BOUNDARY_EDGE, HE_DOUBLED_EDGE,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .run = run_loop_join,
    },
    {
        .name = "loop_split",
        .doc = "Cut the mesh around three edges and cap both sides with triangles; the inverse of "
               "loop_join.",
        .params =
            {{.name = "a",
              .type = HE_PARAM_ELEMENT,
              .kind = HE_EDGE,
              .flags = HE_REQUIRED | HE_WALKS,
              .doc =
                  "An edge of the cycle. The side left of its first half-edge keeps the vertices."},
             {.name = "b",
              .type = HE_PARAM_ELEMENT,
              .kind = HE_EDGE,
              .flags = HE_REQUIRED,
              .doc = "The second edge of the cycle."},
             {.name = "c",
              .type = HE_PARAM_ELEMENT,
              .kind = HE_EDGE,
              .flags = HE_REQUIRED,
              .doc = "The third edge of the cycle."}},
        .results =
            {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
              "The new vertices, beginning with the copy of the origin of the first half-edge of "
              "`a`."},
             {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
              "The new edges: between the first and second new vertex, and so on around."},
             {"faces", HE_RESULT_ELEMENTS, HE_FACE,
              "The two caps: first the one at the old vertices, then the one at the new ones."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_NOT_A_CYCLE, HE_BOUNDARY_VERTEX,
                     HE_SHARED_FACE, HE_LOCKED_ELEMENT},
        .change = {3, 3, 2},
        .run = run_loop_split,
    },
    {.name = NULL},
};
