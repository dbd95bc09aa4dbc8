#include "op/rows.h"

#include "edit/bevel/vertex_bevel.h"
#include "edit/local/dissolve.h"
#include "edit/local/erase.h"
#include "edit/local/split_corners.h"
#include "edit/local/vertex.h"
#include "edit/local/vertex_split.h"

enum { VERTEX_ADD_POSITION };
enum { VERTEX_ADD_OUT_VERTEX };

static he_status run_vertex_add(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex v;
    he_status status = he_vertex_add(m, args[VERTEX_ADD_POSITION].points[0], &v, err);
    if (status == HE_OK) {
        he_results_set(out, VERTEX_ADD_OUT_VERTEX, v.i);
    }
    return status;
}

enum { VERTEX_MOVE_VERTICES, VERTEX_MOVE_TO, VERTEX_MOVE_BY };

static he_status run_vertex_move(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    he_move how = args[VERTEX_MOVE_TO].given ? HE_MOVE_TO : HE_MOVE_BY;
    const he_arg *points =
        args[VERTEX_MOVE_TO].given ? &args[VERTEX_MOVE_TO] : &args[VERTEX_MOVE_BY];
    if (points->list && points->count != args[VERTEX_MOVE_VERTICES].count) {
        return he_fail_plain(err, HE_BAD_VALUE, "%zu points are given for %zu vertices",
                             points->count, args[VERTEX_MOVE_VERTICES].count);
    }
    return he_vertex_move(m, args[VERTEX_MOVE_VERTICES].ids, args[VERTEX_MOVE_VERTICES].count, how,
                          points->points, points->count, err);
}

enum { VERTEX_DELETE_VERTEX, VERTEX_DELETE_KEEP_ISOLATED };

static he_status run_vertex_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_vertex_delete(
        m, (he_vertex){args[VERTEX_DELETE_VERTEX].id},
        args[VERTEX_DELETE_KEEP_ISOLATED].flag ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED, err);
}

enum { VERTEX_SPLIT_VERTEX, VERTEX_SPLIT_LEFT, VERTEX_SPLIT_RIGHT, VERTEX_SPLIT_TO };
enum { VERTEX_SPLIT_OUT_VERTEX, VERTEX_SPLIT_OUT_EDGES, VERTEX_SPLIT_OUT_FACES };

static he_status run_vertex_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex_parts parts;
    he_status status = he_results_reserve(out, VERTEX_SPLIT_OUT_EDGES, 3, err);
    if (status == HE_OK) {
        status = he_results_reserve(out, VERTEX_SPLIT_OUT_FACES, 2, err);
    }
    if (status == HE_OK) {
        status = he_vertex_split(
            m, (he_vertex){args[VERTEX_SPLIT_VERTEX].id}, (he_vertex){args[VERTEX_SPLIT_LEFT].id},
            (he_vertex){args[VERTEX_SPLIT_RIGHT].id}, args[VERTEX_SPLIT_TO].points[0], &parts, err);
    }
    if (status == HE_OK) {
        he_results_set(out, VERTEX_SPLIT_OUT_VERTEX, parts.vertex.i);
        for (unsigned i = 0; i <= parts.sides; i++) {
            he_results_add(out, VERTEX_SPLIT_OUT_EDGES, parts.edges[i].i);
        }
        for (unsigned i = 0; i < parts.sides; i++) {
            he_results_add(out, VERTEX_SPLIT_OUT_FACES, parts.faces[i].i);
        }
    }
    return status;
}

enum { VERTEX_DISSOLVE_VERTEX };
enum { VERTEX_DISSOLVE_OUT_FACE };

static he_status run_vertex_dissolve(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_face f;
    he_status status = he_vertex_dissolve(m, (he_vertex){args[VERTEX_DISSOLVE_VERTEX].id}, &f, err);
    if (status == HE_OK) {
        he_results_set(out, VERTEX_DISSOLVE_OUT_FACE, f.i);
    }
    return status;
}

enum { VERTEX_SPLIT_CORNERS_A, VERTEX_SPLIT_CORNERS_B };
enum { VERTEX_SPLIT_CORNERS_OUT_VERTEX, VERTEX_SPLIT_CORNERS_OUT_EDGE };

static he_status run_vertex_split_corners(he_mesh *m, const he_arg *args, he_results *out,
                                          he_error *err)
{
    he_vertex v;
    he_edge e;
    he_status status =
        he_vertex_split_corners(m, (he_halfedge){args[VERTEX_SPLIT_CORNERS_A].id},
                                (he_halfedge){args[VERTEX_SPLIT_CORNERS_B].id}, &v, &e, err);
    if (status == HE_OK) {
        he_results_set(out, VERTEX_SPLIT_CORNERS_OUT_VERTEX, v.i);
        he_results_set(out, VERTEX_SPLIT_CORNERS_OUT_EDGE, e.i);
    }
    return status;
}

enum { VERTEX_BEVEL_VERTEX, VERTEX_BEVEL_WIDTH };
enum { VERTEX_BEVEL_OUT_VERTICES, VERTEX_BEVEL_OUT_EDGES, VERTEX_BEVEL_OUT_FACE };

static he_status run_vertex_bevel(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_face f;
    he_status status = he_vertex_bevel(
        m, (he_vertex){args[VERTEX_BEVEL_VERTEX].id}, args[VERTEX_BEVEL_WIDTH].number,
        &out->list[VERTEX_BEVEL_OUT_VERTICES], &out->list[VERTEX_BEVEL_OUT_EDGES], &f, err);
    if (status == HE_OK) {
        he_results_set(out, VERTEX_BEVEL_OUT_FACE, f.i);
    }
    return status;
}

const he_op he_vertex_rows[] = {
    {
        .name = "vertex_add",
        .doc = "Add an isolated vertex.",
        .params = {[VERTEX_ADD_POSITION] = {.name = "position",
                                            .each = "positions",
                                            .type = HE_PARAM_POINT,
                                            .flags = HE_REQUIRED,
                                            .doc = "Where the vertex is placed."}},
        .results = {[VERTEX_ADD_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX,
                                               "The new vertex."}},
        .change = {1, 0, 0},
        .run = run_vertex_add,
    },
    {
        .name = "vertex_move",
        .doc = "Move vertices to points, or by vectors.",
        .params = {[VERTEX_MOVE_VERTICES] = {.name = "vertex",
                                             .plural = "vertices",
                                             .type = HE_PARAM_ELEMENTS,
                                             .kind = HE_VERTEX,
                                             .flags = HE_REQUIRED,
                                             .doc = "The vertices to move."},
                   [VERTEX_MOVE_TO] = {.name = "to",
                                       .type = HE_PARAM_POINTS,
                                       .flags = HE_REQUIRED,
                                       .group = 'p',
                                       .doc = "The new position: one point for all vertices, or a "
                                              "list with one point for each vertex."},
                   [VERTEX_MOVE_BY] = {.name = "by",
                                       .type = HE_PARAM_POINTS,
                                       .flags = HE_REQUIRED,
                                       .group = 'p',
                                       .doc = "The vector to move by: one vector for all vertices, "
                                              "or a list with one vector for each vertex."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_NOT_FINITE, HE_LOCKED_ELEMENT},
        .change = {0, 0, 0},
        .run = run_vertex_move,
    },
    {
        .name = "vertex_delete",
        .doc = "Delete a vertex and the faces around it.",
        .params = {[VERTEX_DELETE_VERTEX] = {.name = "vertex",
                                             .each = "vertices",
                                             .type = HE_PARAM_ELEMENT,
                                             .kind = HE_VERTEX,
                                             .flags = HE_REQUIRED | HE_REACHES,
                                             .doc = "The vertex to delete."},
                   [VERTEX_DELETE_KEEP_ISOLATED] =
                       {.name = "keep_isolated",
                        .type = HE_PARAM_FLAG,
                        .doc =
                            "Keep the neighbours of the deleted vertex that have no face left."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .run = run_vertex_delete,
    },
    {
        .name = "vertex_split",
        .doc = "Split a vertex into an edge with a triangle on each side. This is the inverse of "
               "edge_collapse.",
        .params = {[VERTEX_SPLIT_VERTEX] = {.name = "vertex",
                                            .each = "vertices",
                                            .type = HE_PARAM_ELEMENT,
                                            .kind = HE_VERTEX,
                                            .flags = HE_REQUIRED | HE_WALKS,
                                            .doc = "The vertex to split. It does not move."},
                   [VERTEX_SPLIT_LEFT] = {.name = "left",
                                          .type = HE_PARAM_ELEMENT,
                                          .kind = HE_VERTEX,
                                          .flags = HE_REQUIRED | HE_NULLABLE,
                                          .doc =
                                              "A neighbour of the vertex, or null, which stands "
                                              "for the boundary. The faces counter-clockwise from "
                                              "this neighbour to `right` move to the new vertex."},
                   [VERTEX_SPLIT_RIGHT] = {.name = "right",
                                           .type = HE_PARAM_ELEMENT,
                                           .kind = HE_VERTEX,
                                           .flags = HE_REQUIRED | HE_NULLABLE,
                                           .doc =
                                               "A neighbour of the vertex, or null, which stands "
                                               "for the boundary. The faces counter-clockwise from "
                                               "`left` to this neighbour move to the new vertex."},
                   [VERTEX_SPLIT_TO] = {.name = "to",
                                        .type = HE_PARAM_POINT,
                                        .flags = HE_REQUIRED,
                                        .doc = "Where the new vertex is placed."}},
        .results =
            {[VERTEX_SPLIT_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX,
                                          "The new vertex."},
             [VERTEX_SPLIT_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                         "The edge between the old and the new vertex, then the "
                                         "new vertex's edges to the left and the right neighbour."},
             [VERTEX_SPLIT_OUT_FACES] =
                 {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                  "The new triangles, first the left one, then the right one."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_BOWTIE, HE_NOT_BOUNDARY, HE_NOT_NEIGHBOUR, HE_NO_SECTOR},
        .change = {1, HE_VARIES, HE_VARIES},
        .run = run_vertex_split,
    },
    {
        .name = "vertex_dissolve",
        .doc = "Remove a vertex and merge the faces around it into one. This is the inverse of "
               "face_poke.",
        .params = {[VERTEX_DISSOLVE_VERTEX] = {.name = "vertex",
                                               .each = "vertices",
                                               .type = HE_PARAM_ELEMENT,
                                               .kind = HE_VERTEX,
                                               .flags = HE_REQUIRED | HE_REACHES,
                                               .doc = "The vertex to remove, with its edges."}},
        .results = {[VERTEX_DISSOLVE_OUT_FACE] = {"face", HE_RESULT_ELEMENT, HE_FACE,
                                                  "The merged face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BOUNDARY_VERTEX, HE_TOO_FEW_CORNERS,
                     HE_REPEATED_CORNER, HE_LOCKED_ELEMENT},
        .change = {-1, HE_VARIES, HE_VARIES},
        .run = run_vertex_dissolve,
    },
    {
        .name = "vertex_split_corners",
        .doc = "Split a vertex into an edge between two of its corners. Collapsing that edge is "
               "the inverse.",
        .params = {[VERTEX_SPLIT_CORNERS_A] =
                       {.name = "a",
                        .each = "a",
                        .type = HE_PARAM_ELEMENT,
                        .kind = HE_HALFEDGE,
                        .flags = HE_REQUIRED | HE_WALKS,
                        .doc =
                            "The first half-edge, counter-clockwise, that moves to the new vertex. "
                            "The new edge lies in the corner that is clockwise of this half-edge."},
                   [VERTEX_SPLIT_CORNERS_B] =
                       {.name = "b",
                        .type = HE_PARAM_ELEMENT,
                        .kind = HE_HALFEDGE,
                        .flags = HE_REQUIRED,
                        .doc = "The first half-edge, counter-clockwise, that stays; it has the "
                               "same origin as `a`. The new edge lies in the corner that is "
                               "clockwise of this half-edge."}},
        .results =
            {[VERTEX_SPLIT_CORNERS_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX,
                                                  "The new vertex."},
             [VERTEX_SPLIT_CORNERS_OUT_EDGE] = {"edge", HE_RESULT_ELEMENT, HE_EDGE,
                                                "The edge between the old and the new vertex."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_SAME_CORNER, HE_DIFFERENT_ORIGINS,
                     HE_NO_FACE},
        .change = {1, 1, 0},
        .run = run_vertex_split_corners,
    },
    {
        .name = "vertex_bevel",
        .doc = "Bevel a vertex: replace it by a face across its edges.",
        .params =
            {[VERTEX_BEVEL_VERTEX] =
                 {.name = "vertex",
                  .each = "vertices",
                  .type = HE_PARAM_ELEMENT,
                  .kind = HE_VERTEX,
                  .flags =
                      HE_REQUIRED,
                  .doc = "The vertex to bevel. It becomes the first corner of the new face."},
             [VERTEX_BEVEL_WIDTH] =
                 {.name = "width",
                  .type = HE_PARAM_NUMBER,
                  .flags =
                      HE_REQUIRED,
                  .doc = "The distance from the vertex at which each edge is cut, above 0; an edge "
                         "that is not longer than this distance is cut at 99 % of its length."}},
        .results = {[VERTEX_BEVEL_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                                   "The new vertices, counter-clockwise."},
                    [VERTEX_BEVEL_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                                "The edges of the new face."},
                    [VERTEX_BEVEL_OUT_FACE] = {"face", HE_RESULT_ELEMENT, HE_FACE,
                                               "The new face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BAD_VALUE, HE_BOUNDARY_VERTEX,
                     HE_LOW_DEGREE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, 1},
        .run = run_vertex_bevel,
    },
    {.name = NULL},
};
