#include "op/rows.h"

#include "edit/bevel/edge_bevel.h"
#include "edit/local/bisect.h"
#include "edit/local/collapse.h"
#include "edit/local/flip.h"
#include "edit/local/split.h"

static he_status run_edge_bisect(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex v;
    he_edge e;
    he_status status = he_edge_bisect(m, (he_edge){args[0].id}, args[1].number, &v, &e, err);
    if (status == HE_OK) {
        he_give(out, 0, v.i);
        he_give(out, 1, e.i);
    }
    return status;
}

static he_status run_edge_join(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_edge e;
    he_status status = he_edge_join(m, (he_vertex){args[0].id}, &e, err);
    if (status == HE_OK) {
        he_give(out, 0, e.i);
    }
    return status;
}

static he_status run_edge_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_split split;
    he_status status = he_give_room(out, 1, 3, err);
    if (status == HE_OK) {
        status = he_give_room(out, 2, 2, err);
    }
    if (status == HE_OK) {
        status = he_edge_split(m, (he_edge){args[0].id}, args[1].number, &split, err);
    }
    if (status == HE_OK) {
        he_give(out, 0, split.vertex.i);
        for (unsigned i = 0; i <= split.sides; i++) {
            he_give_add(out, 1, split.edges[i].i);
        }
        for (unsigned i = 0; i < split.sides; i++) {
            he_give_add(out, 2, split.faces[i].i);
        }
    }
    return status;
}

static he_status run_edge_flip(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_status status = he_edge_flip(m, (he_edge){args[0].id}, err);
    if (status == HE_OK) {
        he_give(out, 0, args[0].id);
    }
    return status;
}

static he_status run_edge_collapse(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_halfedge h = {args[0].id};
    if (args[1].given) {
        he_status status = he_mesh_require(m, HE_EDGE, args[1].id, err);
        if (status != HE_OK) {
            return status;
        }
        h.i = 2 * args[1].id;
    }
    he_vertex v;
    he_status status =
        he_edge_collapse(m, h, args[2].number, args[3].given ? args[3].points : NULL, &v, err);
    if (status == HE_OK) {
        he_give(out, 0, v.i);
    }
    return status;
}

static he_status run_edge_bevel(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_bevel bevel;
    he_status status = he_edge_bevel(m, (he_edge){args[0].id}, args[1].number, &bevel, err);
    if (status == HE_OK) {
        he_give(out, 0, bevel.face.i);
        he_give_list(out, 1, &bevel.vertices);
        he_give_list(out, 2, &bevel.edges);
        he_bevel_clear(&bevel);
    }
    return status;
}

const he_op he_edge_rows[] = {
    {
        .name = "edge_bisect",
        .doc = "Insert a vertex into an edge.",
        .params = {{.name = "edge",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED,
                    .doc = "The edge to divide. The part at the origin of its first half-edge "
                           "keeps the id."},
                   {.name = "t",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_RANGE | HE_EXCLUSIVE,
                    .min = 0,
                    .max = 1,
                    .fallback = 0.5,
                    .doc = "Where on the edge: 0 = that origin, 1 = the other end."}},
        .results = {{"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The new vertex."},
                    {"edge", HE_RESULT_ELEMENT, HE_EDGE, "The new edge, at the other end."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT},
        .change = {1, 1, 0},
        .run = run_edge_bisect,
    },
    {
        .name = "edge_join",
        .doc = "Remove a vertex of degree two and join its two edges. The inverse of edge_bisect.",
        .params = {{.name = "vertex",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED | HE_WALKS,
                    .doc = "The vertex to remove."}},
        .results = {{"edge", HE_RESULT_ELEMENT, HE_EDGE, "The edge that stays."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_WRONG_DEGREE, HE_TRIANGLE_SIDE,
                     HE_DOUBLED_EDGE, HE_LOCKED_ELEMENT},
        .change = {-1, -1, 0},
        .run = run_edge_join,
    },
    {
        .name = "edge_split",
        .doc = "Insert a vertex into an edge and connect it to a corner of each face beside it.",
        .params =
            {{.name = "edge",
              .type = HE_PARAM_ELEMENT,
              .kind = HE_EDGE,
              .flags = HE_REQUIRED,
              .doc =
                  "The edge to split. The part at the origin of its first half-edge keeps the id."},
             {.name = "t",
              .type = HE_PARAM_NUMBER,
              .flags = HE_RANGE | HE_EXCLUSIVE,
              .min = 0,
              .max = 1,
              .fallback = 0.5,
              .doc = "Where on the edge: 0 = that origin, 1 = the other end."}},
        .results = {{"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The new vertex."},
                    {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                     "The new part of the edge, then the diagonals."},
                    {"faces", HE_RESULT_ELEMENTS, HE_FACE, "The new faces, left one first."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_DOUBLED_EDGE},
        .change = {1, HE_VARIES, HE_VARIES},
        .run = run_edge_split,
    },
    {
        .name = "edge_flip",
        .doc = "Flip an edge: turn it counter-clockwise inside its two faces.",
        .params = {{.name = "edge",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED,
                    .doc = "The edge to flip. Each end moves to the next corner of its face."}},
        .results = {{"edge", HE_RESULT_ELEMENT, HE_EDGE, "The same edge."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BOUNDARY_EDGE, HE_SAME_ENDS,
                     HE_LOW_DEGREE, HE_DOUBLED_EDGE, HE_REPEATED_CORNER, HE_FEATURE_EDGE,
                     HE_LOCKED_ELEMENT},
        .change = {0, 0, 0},
        .run = run_edge_flip,
    },
    {
        .name = "edge_collapse",
        .doc = "Collapse an edge to one vertex.",
        .params = {{.name = "halfedge",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_HALFEDGE,
                    .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                    .group = 'e',
                    .doc = "The half-edge to collapse. Its origin is removed, its target stays."},
                   {.name = "edge",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                    .group = 'e',
                    .doc = "The edge to collapse, which means its first half-edge."},
                   {.name = "t",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_RANGE,
                    .group = 'p',
                    .min = 0,
                    .max = 1,
                    .fallback = 0.5,
                    .doc = "Where the vertex is placed: 0 = origin, 1 = target. Default: the "
                           "midpoint, unless `to` is given."},
                   {.name = "to",
                    .type = HE_PARAM_POINT,
                    .group = 'p',
                    .doc = "The point where the vertex is placed instead."}},
        .results = {{"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The vertex that stays."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_LINK_CONDITION, HE_FEATURE_EDGE,
                     HE_LOCKED_ELEMENT},
        .change = {-1, HE_VARIES, HE_VARIES},
        .run = run_edge_collapse,
    },
    {
        .name = "edge_bevel",
        .doc = "Bevel an edge: replace it by a flat face.",
        .params = {{.name = "edge",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED,
                    .doc = "The edge to bevel."},
                   {.name = "width",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_REQUIRED,
                    .doc = "The distance from its ends at which the neighbouring edges are cut: "
                           "above 0, and at most 0.99 of their length."}},
        .results = {{"face", HE_RESULT_ELEMENT, HE_FACE, "The new face."},
                    {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                     "The new vertices, in the order of the new face."},
                    {"edges", HE_RESULT_ELEMENTS, HE_EDGE, "Its sides, in the same order."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BOUNDARY_EDGE, HE_BAD_VALUE,
                     HE_LOW_DEGREE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, 1},
        .run = run_edge_bevel,
    },
    {.name = NULL},
};
