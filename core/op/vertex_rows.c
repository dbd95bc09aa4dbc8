#include "op/rows.h"

#include "edit/bevel/vertex_bevel.h"
#include "edit/local/dissolve.h"
#include "edit/local/erase.h"
#include "edit/local/split_corners.h"
#include "edit/local/vertex.h"
#include "edit/local/vertex_split.h"

static he_status run_vertex_add(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex v;
    he_status status = he_vertex_add(m, args[0].points[0], &v, err);
    if (status == HE_OK) {
        he_give(out, 0, v.i);
    }
    return status;
}

static he_status run_vertex_move(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    he_move how = args[1].given ? HE_MOVE_TO : HE_MOVE_BY;
    const he_arg *points = args[1].given ? &args[1] : &args[2];
    if (points->list && points->count != args[0].count) {
        return he_fail_plain(err, HE_BAD_VALUE, "%zu points are given for %zu vertices",
                             points->count, args[0].count);
    }
    return he_vertex_move(m, args[0].ids, args[0].count, how, points->points, points->count, err);
}

static he_status run_vertex_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_vertex_delete(m, (he_vertex){args[0].id},
                            args[1].flag ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED, err);
}

static he_status run_vertex_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex_parts parts;
    he_status status = he_give_room(out, 1, 3, err);
    if (status == HE_OK) {
        status = he_give_room(out, 2, 2, err);
    }
    if (status == HE_OK) {
        status = he_vertex_split(m, (he_vertex){args[0].id}, (he_vertex){args[1].id},
                                 (he_vertex){args[2].id}, args[3].points[0], &parts, err);
    }
    if (status == HE_OK) {
        he_give(out, 0, parts.vertex.i);
        for (unsigned i = 0; i <= parts.sides; i++) {
            he_give_add(out, 1, parts.edges[i].i);
        }
        for (unsigned i = 0; i < parts.sides; i++) {
            he_give_add(out, 2, parts.faces[i].i);
        }
    }
    return status;
}

static he_status run_vertex_dissolve(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_face f;
    he_status status = he_vertex_dissolve(m, (he_vertex){args[0].id}, &f, err);
    if (status == HE_OK) {
        he_give(out, 0, f.i);
    }
    return status;
}

static he_status run_vertex_split_corners(he_mesh *m, const he_arg *args, he_results *out,
                                          he_error *err)
{
    he_vertex v;
    he_edge e;
    he_status status = he_vertex_split_corners(m, (he_halfedge){args[0].id},
                                               (he_halfedge){args[1].id}, &v, &e, err);
    if (status == HE_OK) {
        he_give(out, 0, v.i);
        he_give(out, 1, e.i);
    }
    return status;
}

static he_status run_vertex_bevel(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_face f;
    he_status status = he_vertex_bevel(m, (he_vertex){args[0].id}, args[1].number, &out->list[0],
                                       &out->list[1], &f, err);
    if (status == HE_OK) {
        he_give(out, 2, f.i);
    }
    return status;
}

const he_op he_vertex_rows[] = {
    {
        .name = "vertex_add",
        .doc = "Add an isolated vertex.",
        .params = {{.name = "position",
                    .type = HE_PARAM_POINT,
                    .flags = HE_REQUIRED,
                    .doc = "Where the vertex lies."}},
        .results = {{"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The new vertex."}},
        .change = {1, 0, 0},
        .run = run_vertex_add,
    },
    {
        .name = "vertex_move",
        .doc = "Move vertices to points, or by vectors.",
        .params = {{.name = "vertex",
                    .plural = "vertices",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED,
                    .doc = "What moves."},
                   {.name = "to",
                    .type = HE_PARAM_POINTS,
                    .flags = HE_REQUIRED,
                    .group = 'p',
                    .doc = "Where to: one point for all, or a list with one for each."},
                   {.name = "by",
                    .type = HE_PARAM_POINTS,
                    .flags = HE_REQUIRED,
                    .group = 'p',
                    .doc = "By how much: one vector for all, or a list with one for each."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_NOT_FINITE, HE_LOCKED_ELEMENT},
        .change = {0, 0, 0},
        .run = run_vertex_move,
    },
    {
        .name = "vertex_delete",
        .doc = "Delete a vertex and the faces about it.",
        .params = {{.name = "vertex",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED | HE_REACHES,
                    .doc = "What goes."},
                   {.name = "keep_isolated",
                    .type = HE_PARAM_FLAG,
                    .doc = "Keep neighbours that are left without a face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .run = run_vertex_delete,
    },
    {
        .name = "vertex_split",
        .doc = "Draw a vertex apart into an edge with a triangle on each side; the inverse of "
               "edge_collapse.",
        .params = {{.name = "vertex",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED | HE_WALKS,
                    .doc = "What is split; it stays where it is."},
                   {.name = "left",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED | HE_NULLABLE,
                    .doc = "The neighbour from which, counter-clockwise, faces go to the new "
                           "vertex; null for the hole at a boundary vertex."},
                   {.name = "right",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED | HE_NULLABLE,
                    .doc = "The neighbour up to which they go, or null for the hole."},
                   {.name = "to",
                    .type = HE_PARAM_POINT,
                    .flags = HE_REQUIRED,
                    .doc = "Where the new vertex lies."}},
        .results = {{"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The new vertex."},
                    {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                     "The edge between the two, then those to left and right."},
                    {"faces", HE_RESULT_ELEMENTS, HE_FACE, "The triangles, left and right."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_BOWTIE, HE_NOT_BOUNDARY, HE_NOT_NEIGHBOUR, HE_NO_SECTOR},
        .change = {1, HE_VARIES, HE_VARIES},
        .run = run_vertex_split,
    },
    {
        .name = "vertex_dissolve",
        .doc = "Take a vertex out of the middle of its faces, which become one; the inverse of "
               "face_poke.",
        .params = {{.name = "vertex",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED | HE_REACHES,
                    .doc = "What goes, and the edges at it."}},
        .results = {{"face", HE_RESULT_ELEMENT, HE_FACE, "What the faces about it became."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BOUNDARY_VERTEX, HE_TOO_FEW_CORNERS,
                     HE_REPEATED_CORNER, HE_LOCKED_ELEMENT},
        .change = {-1, HE_VARIES, HE_VARIES},
        .run = run_vertex_dissolve,
    },
    {
        .name = "vertex_split_corners",
        .doc = "Draw a vertex apart into an edge between two of its corners; edge_collapse of the "
               "edge is the inverse.",
        .params = {{.name = "a",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_HALFEDGE,
                    .flags = HE_REQUIRED | HE_WALKS,
                    .doc = "The first half-edge, counter-clockwise, that goes to the new vertex; "
                           "the edge comes into the corner clockwise of it."},
                   {.name = "b",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_HALFEDGE,
                    .flags = HE_REQUIRED,
                    .doc = "The half-edge of the same origin up to which they go, which stays; the "
                           "edge comes into the corner clockwise of it."}},
        .results = {{"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The new vertex."},
                    {"edge", HE_RESULT_ELEMENT, HE_EDGE, "The edge between the two."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_SAME_CORNER, HE_DIFFERENT_ORIGINS,
                     HE_NO_FACE},
        .change = {1, 1, 0},
        .run = run_vertex_split_corners,
    },
    {
        .name = "vertex_bevel",
        .doc = "Cut a corner off: a face across the edges at a vertex.",
        .params = {{.name = "vertex",
                    .type = HE_PARAM_ELEMENT,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED,
                    .doc = "What is cut off; it stays as the new face's first corner."},
                   {.name = "width",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_REQUIRED,
                    .doc = "How far from it each edge is cut, above 0; 99 % of an edge that is not "
                           "longer."}},
        .results = {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                     "The new vertices, counter-clockwise."},
                    {"edges", HE_RESULT_ELEMENTS, HE_EDGE, "The edges of the new face."},
                    {"face", HE_RESULT_ELEMENT, HE_FACE, "The new face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BAD_VALUE, HE_BOUNDARY_VERTEX,
                     HE_LOW_DEGREE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, 1},
        .run = run_vertex_bevel,
    },
    {.name = NULL},
};
