#include "op/rows.h"

#include "edit/bevel/edge_bevel.h"
#include "edit/local/bisect.h"
#include "edit/local/collapse.h"
#include "edit/local/flip.h"
#include "edit/local/split.h"

enum { EDGE_BISECT_EDGE, EDGE_BISECT_T };
enum { EDGE_BISECT_OUT_VERTEX, EDGE_BISECT_OUT_EDGE };

static he_status run_edge_bisect(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex v;
    he_edge e;
    he_status status = he_edge_bisect(m, (he_edge){args[EDGE_BISECT_EDGE].id},
                                      args[EDGE_BISECT_T].number, &v, &e, err);
    if (status == HE_OK) {
        he_results_set(out, EDGE_BISECT_OUT_VERTEX, v.i);
        he_results_set(out, EDGE_BISECT_OUT_EDGE, e.i);
    }
    return status;
}

enum { EDGE_JOIN_VERTEX };
enum { EDGE_JOIN_OUT_EDGE };

static he_status run_edge_join(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_edge e;
    he_status status = he_edge_join(m, (he_vertex){args[EDGE_JOIN_VERTEX].id}, &e, err);
    if (status == HE_OK) {
        he_results_set(out, EDGE_JOIN_OUT_EDGE, e.i);
    }
    return status;
}

enum { EDGE_SPLIT_EDGE, EDGE_SPLIT_T };
enum { EDGE_SPLIT_OUT_VERTEX, EDGE_SPLIT_OUT_EDGES, EDGE_SPLIT_OUT_FACES };

static he_status run_edge_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_split split;
    he_status status = he_results_reserve(out, EDGE_SPLIT_OUT_EDGES, 3, err);
    if (status == HE_OK) {
        status = he_results_reserve(out, EDGE_SPLIT_OUT_FACES, 2, err);
    }
    if (status == HE_OK) {
        status = he_edge_split(m, (he_edge){args[EDGE_SPLIT_EDGE].id}, args[EDGE_SPLIT_T].number,
                               &split, err);
    }
    if (status == HE_OK) {
        he_results_set(out, EDGE_SPLIT_OUT_VERTEX, split.vertex.i);
        for (unsigned i = 0; i <= split.sides; i++) {
            he_results_add(out, EDGE_SPLIT_OUT_EDGES, split.edges[i].i);
        }
        for (unsigned i = 0; i < split.sides; i++) {
            he_results_add(out, EDGE_SPLIT_OUT_FACES, split.faces[i].i);
        }
    }
    return status;
}

enum { EDGE_FLIP_EDGE };
enum { EDGE_FLIP_OUT_EDGE };

static he_status run_edge_flip(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_status status = he_edge_flip(m, (he_edge){args[EDGE_FLIP_EDGE].id}, err);
    if (status == HE_OK) {
        he_results_set(out, EDGE_FLIP_OUT_EDGE, args[EDGE_FLIP_EDGE].id);
    }
    return status;
}

enum { EDGE_COLLAPSE_HALFEDGE, EDGE_COLLAPSE_EDGE, EDGE_COLLAPSE_T, EDGE_COLLAPSE_TO };
enum { EDGE_COLLAPSE_OUT_VERTEX };

static he_status run_edge_collapse(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_halfedge h = {args[EDGE_COLLAPSE_HALFEDGE].id};
    if (args[EDGE_COLLAPSE_EDGE].given) {
        he_status status = he_mesh_require(m, HE_EDGE, args[EDGE_COLLAPSE_EDGE].id, err);
        if (status != HE_OK) {
            return status;
        }
        h.i = 2 * args[EDGE_COLLAPSE_EDGE].id;
    }
    he_vertex v;
    he_status status = he_edge_collapse(
        m, h, args[EDGE_COLLAPSE_T].number,
        args[EDGE_COLLAPSE_TO].given ? args[EDGE_COLLAPSE_TO].points : NULL, &v, err);
    if (status == HE_OK) {
        he_results_set(out, EDGE_COLLAPSE_OUT_VERTEX, v.i);
    }
    return status;
}

enum { EDGE_BEVEL_EDGE, EDGE_BEVEL_WIDTH };
enum { EDGE_BEVEL_OUT_FACE, EDGE_BEVEL_OUT_VERTICES, EDGE_BEVEL_OUT_EDGES };

static he_status run_edge_bevel(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_bevel bevel;
    he_status status = he_edge_bevel(m, (he_edge){args[EDGE_BEVEL_EDGE].id},
                                     args[EDGE_BEVEL_WIDTH].number, &bevel, err);
    if (status == HE_OK) {
        he_results_set(out, EDGE_BEVEL_OUT_FACE, bevel.face.i);
        he_results_set_list(out, EDGE_BEVEL_OUT_VERTICES, &bevel.vertices);
        he_results_set_list(out, EDGE_BEVEL_OUT_EDGES, &bevel.edges);
        he_bevel_clear(&bevel);
    }
    return status;
}

const he_op he_edge_rows[] = {
    {
        .name = "edge_bisect",
        .doc = "Insert a vertex into an edge.",
        .params = {[EDGE_BISECT_EDGE] = {.name = "edge",
                                         .each = "edges",
                                         .type = HE_PARAM_ELEMENT,
                                         .kind = HE_EDGE,
                                         .flags = HE_REQUIRED,
                                         .doc = "The edge to divide. The part at the origin of its "
                                                "first half-edge keeps the id of the edge."},
                   [EDGE_BISECT_T] = {.name = "t",
                                      .type = HE_PARAM_NUMBER,
                                      .flags = HE_RANGE | HE_EXCLUSIVE,
                                      .min = 0,
                                      .max = 1,
                                      .fallback = 0.5,
                                      .doc = "Where on the edge the new vertex is placed: 0 = the "
                                             "origin of its first half-edge, 1 = the other end."}},
        .results = {[EDGE_BISECT_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX,
                                                "The new vertex."},
                    [EDGE_BISECT_OUT_EDGE] =
                        {"edge", HE_RESULT_ELEMENT, HE_EDGE,
                         "The new edge, from the new vertex to the far end of the divided edge."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT},
        .change = {1, 1, 0},
        .run = run_edge_bisect,
    },
    {
        .name = "edge_join",
        .doc = "Remove a vertex of degree two and join its two edges.",
        .params = {[EDGE_JOIN_VERTEX] = {.name = "vertex",
                                         .each = "vertices",
                                         .type = HE_PARAM_ELEMENT,
                                         .kind = HE_VERTEX,
                                         .flags = HE_REQUIRED | HE_WALKS,
                                         .doc = "The vertex to remove."}},
        .results =
            {[EDGE_JOIN_OUT_EDGE] = {"edge", HE_RESULT_ELEMENT, HE_EDGE,
                                     "The edge that stays; the other edge is merged into it."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_WRONG_DEGREE, HE_TRIANGLE_SIDE,
                     HE_DOUBLED_EDGE, HE_LOCKED_ELEMENT},
        .change = {-1, -1, 0},
        .run = run_edge_join,
    },
    {
        .name = "edge_split",
        .doc =
            "Insert a vertex into an edge and connect it to a corner of each face beside the edge.",
        .params = {[EDGE_SPLIT_EDGE] = {.name = "edge",
                                        .each = "edges",
                                        .type = HE_PARAM_ELEMENT,
                                        .kind = HE_EDGE,
                                        .flags = HE_REQUIRED,
                                        .doc = "The edge to split. The part at the origin of its "
                                               "first half-edge keeps the id of the edge."},
                   [EDGE_SPLIT_T] = {.name = "t",
                                     .type = HE_PARAM_NUMBER,
                                     .flags = HE_RANGE | HE_EXCLUSIVE,
                                     .min = 0,
                                     .max = 1,
                                     .fallback = 0.5,
                                     .doc = "Where on the edge the new vertex is placed: 0 = the "
                                            "origin of its first half-edge, 1 = the other end."}},
        .results =
            {[EDGE_SPLIT_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The new vertex."},
             [EDGE_SPLIT_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                       "First the new part of the edge, then the new diagonals."},
             [EDGE_SPLIT_OUT_FACES] =
                 {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                  "The new faces, first the one to the left of the edge's first half-edge."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_DOUBLED_EDGE},
        .change = {1, HE_VARIES, HE_VARIES},
        .run = run_edge_split,
    },
    {
        .name = "edge_flip",
        .doc = "Flip an edge: turn it counter-clockwise inside its two faces.",
        .params = {[EDGE_FLIP_EDGE] = {.name = "edge",
                                       .each = "edges",
                                       .type = HE_PARAM_ELEMENT,
                                       .kind = HE_EDGE,
                                       .flags = HE_REQUIRED | HE_WALKS,
                                       .doc = "The edge to flip. Each of its ends moves to the "
                                              "next corner, counter-clockwise."}},
        .results = {[EDGE_FLIP_OUT_EDGE] = {"edge", HE_RESULT_ELEMENT, HE_EDGE,
                                            "The edge, which keeps its id."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BOUNDARY_EDGE, HE_SAME_ENDS,
                     HE_LOW_DEGREE, HE_DOUBLED_EDGE, HE_REPEATED_CORNER, HE_FEATURE_EDGE,
                     HE_LOCKED_ELEMENT},
        .change = {0, 0, 0},
        .run = run_edge_flip,
    },
    {
        .name = "edge_collapse",
        .doc = "Collapse an edge to one vertex.",
        .params = {[EDGE_COLLAPSE_HALFEDGE] =
                       {.name = "halfedge",
                        .each = "halfedges",
                        .type = HE_PARAM_ELEMENT,
                        .kind = HE_HALFEDGE,
                        .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                        .group = 'e',
                        .doc =
                            "The half-edge to collapse. Its origin is removed, its target stays."},
                   [EDGE_COLLAPSE_EDGE] = {.name = "edge",
                                           .each = "edges",
                                           .type = HE_PARAM_ELEMENT,
                                           .kind = HE_EDGE,
                                           .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                                           .group = 'e',
                                           .doc = "The edge to collapse, given instead of "
                                                  "`halfedge`; it stands for its first half-edge."},
                   [EDGE_COLLAPSE_T] =
                       {.name = "t",
                        .type = HE_PARAM_NUMBER,
                        .flags = HE_RANGE,
                        .group = 'p',
                        .min = 0,
                        .max = 1,
                        .fallback = 0.5,
                        .doc = "Where the vertex is placed: 0 = origin, 1 = target. Default: the "
                               "midpoint, unless `to` is given."},
                   [EDGE_COLLAPSE_TO] =
                       {.name = "to",
                        .type = HE_PARAM_POINT,
                        .group = 'p',
                        .doc = "The point where the vertex is placed, given instead of `t`."}},
        .results = {[EDGE_COLLAPSE_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX,
                                                  "The vertex that stays."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_LINK_CONDITION, HE_FEATURE_EDGE,
                     HE_LOCKED_ELEMENT},
        .change = {-1, HE_VARIES, HE_VARIES},
        .run = run_edge_collapse,
    },
    {
        .name = "edge_bevel",
        .doc = "Bevel an edge: replace it by a flat face.",
        .params = {[EDGE_BEVEL_EDGE] = {.name = "edge",
                                        .each = "edges",
                                        .type = HE_PARAM_ELEMENT,
                                        .kind = HE_EDGE,
                                        .flags = HE_REQUIRED,
                                        .doc = "The edge to bevel."},
                   [EDGE_BEVEL_WIDTH] =
                       {.name = "width",
                        .type = HE_PARAM_NUMBER,
                        .flags = HE_REQUIRED,
                        .doc = "The distance from the ends of the edge at which the neighbouring "
                               "edges are cut: above 0, and at most 0.99 of their length."}},
        .results =
            {[EDGE_BEVEL_OUT_FACE] = {"face", HE_RESULT_ELEMENT, HE_FACE, "The new face."},
             [EDGE_BEVEL_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                          "The new vertices, in the order of the new face."},
             [EDGE_BEVEL_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                       "The edges of the new face, in the order of its corners."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BOUNDARY_EDGE, HE_BAD_VALUE,
                     HE_LOW_DEGREE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, 1},
        .run = run_edge_bevel,
    },
    {.name = NULL},
};
