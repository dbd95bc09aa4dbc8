#include "op/rows.h"

#include "edit/local/cut.h"
#include "edit/local/erase.h"
#include "edit/local/face_add.h"
#include "edit/local/poke.h"
#include "edit/whole/triangulate.h"

enum { FACE_ADD_VERTICES };
enum { FACE_ADD_OUT_FACE, FACE_ADD_OUT_EDGES };

static he_status run_face_add(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_face f;
    he_status status = he_face_add(m, args[FACE_ADD_VERTICES].ids, args[FACE_ADD_VERTICES].count,
                                   &f, &out->list[FACE_ADD_OUT_EDGES], err);
    if (status == HE_OK) {
        he_results_set(out, FACE_ADD_OUT_FACE, f.i);
    }
    return status;
}

enum { FACE_DELETE_FACES, FACE_DELETE_KEEP_ISOLATED };

static he_status run_face_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_face_delete(
        m, args[FACE_DELETE_FACES].ids, args[FACE_DELETE_FACES].count,
        args[FACE_DELETE_KEEP_ISOLATED].flag ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED, err);
}

/* Finds the half-edge of face f that leaves a corner. The client names either the corner's vertex
 * or this half-edge. */
static he_status find_corner(const he_mesh *m, he_face f, const he_arg *vertex,
                             const he_arg *halfedge, he_halfedge *out, he_error *err)
{
    if (halfedge->given) {
        *out = (he_halfedge){halfedge->id};
        return HE_OK;
    }
    he_status status = he_mesh_require(m, HE_VERTEX, vertex->id, err);
    if (status != HE_OK) {
        return status;
    }
    he_halfedge h = he_face_corner(m, f, (he_vertex){vertex->id});
    if (h.i == HE_NONE) {
        return he_fail(err, HE_NOT_A_CORNER, HE_VERTEX, vertex->id,
                       "vertex %u is not a corner of face %u", vertex->id, f.i);
    }
    *out = h;
    return HE_OK;
}

enum {
    FACE_SPLIT_FACE,
    FACE_SPLIT_FROM,
    FACE_SPLIT_FROM_HALFEDGE,
    FACE_SPLIT_TO,
    FACE_SPLIT_TO_HALFEDGE
};
enum { FACE_SPLIT_OUT_EDGE, FACE_SPLIT_OUT_FACE };

static he_status run_face_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_face f = {args[FACE_SPLIT_FACE].id}, made;
    he_halfedge from, to;
    he_edge e;
    he_status status = he_mesh_require(m, HE_FACE, f.i, err);
    if (status == HE_OK) {
        status =
            find_corner(m, f, &args[FACE_SPLIT_FROM], &args[FACE_SPLIT_FROM_HALFEDGE], &from, err);
    }
    if (status == HE_OK) {
        status = find_corner(m, f, &args[FACE_SPLIT_TO], &args[FACE_SPLIT_TO_HALFEDGE], &to, err);
    }
    if (status == HE_OK) {
        status = he_face_split(m, f, from, to, &e, &made, err);
    }
    if (status == HE_OK) {
        he_results_set(out, FACE_SPLIT_OUT_EDGE, e.i);
        he_results_set(out, FACE_SPLIT_OUT_FACE, made.i);
    }
    return status;
}

enum { FACE_JOIN_EDGE };
enum { FACE_JOIN_OUT_FACE };

static he_status run_face_join(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_face f;
    he_status status = he_face_join(m, (he_edge){args[FACE_JOIN_EDGE].id}, &f, err);
    if (status == HE_OK) {
        he_results_set(out, FACE_JOIN_OUT_FACE, f.i);
    }
    return status;
}

enum { FACE_POKE_FACE, FACE_POKE_POSITION };
enum { FACE_POKE_OUT_VERTEX, FACE_POKE_OUT_EDGES, FACE_POKE_OUT_FACES };

static he_status run_face_poke(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex v;
    he_status status =
        he_face_poke(m, (he_face){args[FACE_POKE_FACE].id},
                     args[FACE_POKE_POSITION].given ? args[FACE_POKE_POSITION].points : NULL, &v,
                     &out->list[FACE_POKE_OUT_EDGES], &out->list[FACE_POKE_OUT_FACES], err);
    if (status == HE_OK) {
        he_results_set(out, FACE_POKE_OUT_VERTEX, v.i);
    }
    return status;
}

enum { FACE_TRIANGULATE_FACES };
enum { FACE_TRIANGULATE_OUT_EDGES, FACE_TRIANGULATE_OUT_FACES, FACE_TRIANGULATE_OUT_DEGENERATE };

static he_status run_face_triangulate(he_mesh *m, const he_arg *args, he_results *out,
                                      he_error *err)
{
    return he_face_triangulate(
        m, args[FACE_TRIANGULATE_FACES].ids, args[FACE_TRIANGULATE_FACES].count,
        &out->list[FACE_TRIANGULATE_OUT_EDGES], &out->list[FACE_TRIANGULATE_OUT_FACES],
        &out->list[FACE_TRIANGULATE_OUT_DEGENERATE], err);
}

const he_op he_face_rows[] = {
    {
        .name = "face_add",
        .doc = "Add a face between existing vertices. Missing edges between them are made.",
        .params = {[FACE_ADD_VERTICES] =
                       {.name = "vertices",
                        .each = "faces",
                        .type = HE_PARAM_CYCLE,
                        .kind = HE_VERTEX,
                        .flags = HE_REQUIRED | HE_WALKS,
                        .doc = "The vertices at the corners of the face, counter-clockwise."}},
        .results =
            {[FACE_ADD_OUT_FACE] = {"face", HE_RESULT_ELEMENT, HE_FACE, "The new face."},
             [FACE_ADD_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                     "The new edges, in the order of the sides of the face."}},
        .refusals = {HE_TOO_FEW_CORNERS, HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_CORNER,
                     HE_INTERIOR_VERTEX, HE_NONMANIFOLD_EDGE, HE_ORIENTATION, HE_CLOSED_FAN},
        .change = {0, HE_VARIES, 1},
        .run = run_face_add,
    },
    {
        .name = "face_delete",
        .doc = "Delete faces, and then the edges and vertices that have no face left.",
        .params =
            {[FACE_DELETE_FACES] = {.name = "face",
                                    .plural = "faces",
                                    .type = HE_PARAM_ELEMENTS,
                                    .kind = HE_FACE,
                                    .flags = HE_REQUIRED,
                                    .doc = "The faces to delete."},
             [FACE_DELETE_KEEP_ISOLATED] = {.name = "keep_isolated",
                                            .type = HE_PARAM_FLAG,
                                            .doc = "Keep vertices that are left without a face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 40,
        .run = run_face_delete,
    },
    {
        .name = "face_split",
        .doc = "Cut a face in two along a diagonal between two of its corners.",
        .params =
            {[FACE_SPLIT_FACE] =
                 {.name = "face",
                  .each = "faces",
                  .type = HE_PARAM_ELEMENT,
                  .kind = HE_FACE,
                  .flags = HE_REQUIRED | HE_WALKS,
                  .doc = "The face to cut. The part to the left of the diagonal keeps the id."},
             [FACE_SPLIT_FROM] = {.name = "from",
                                  .type = HE_PARAM_ELEMENT,
                                  .kind = HE_VERTEX,
                                  .flags = HE_REQUIRED,
                                  .group = 'f',
                                  .doc = "The corner where the diagonal begins."},
             [FACE_SPLIT_FROM_HALFEDGE] = {.name = "from_halfedge",
                                           .type = HE_PARAM_ELEMENT,
                                           .kind = HE_HALFEDGE,
                                           .flags = HE_REQUIRED,
                                           .group = 'f',
                                           .doc = "The corner where the diagonal begins, given as "
                                                  "the half-edge of the face that leaves it."},
             [FACE_SPLIT_TO] = {.name = "to",
                                .type = HE_PARAM_ELEMENT,
                                .kind = HE_VERTEX,
                                .flags = HE_REQUIRED,
                                .group = 't',
                                .doc = "The corner where the diagonal ends."},
             [FACE_SPLIT_TO_HALFEDGE] = {.name = "to_halfedge",
                                         .type = HE_PARAM_ELEMENT,
                                         .kind = HE_HALFEDGE,
                                         .flags = HE_REQUIRED,
                                         .group = 't',
                                         .doc = "The corner where the diagonal ends, given as the "
                                                "half-edge of the face that leaves it."}},
        .results = {[FACE_SPLIT_OUT_EDGE] = {"edge", HE_RESULT_ELEMENT, HE_EDGE, "The diagonal."},
                    [FACE_SPLIT_OUT_FACE] = {"face", HE_RESULT_ELEMENT, HE_FACE,
                                             "The new face, to the right of the diagonal."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_NOT_A_CORNER, HE_SAME_CORNER,
                     HE_ADJACENT_CORNERS, HE_DOUBLED_EDGE},
        .change = {0, 1, 1},
        .run = run_face_split,
    },
    {
        .name = "face_join",
        .doc = "Delete an edge and merge its two faces. This is the inverse of face_split.",
        .params = {[FACE_JOIN_EDGE] =
                       {.name = "edge",
                        .each = "edges",
                        .type = HE_PARAM_ELEMENT,
                        .kind = HE_EDGE,
                        .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                        .doc = "The edge to delete. The face of its first half-edge stays."}},
        .results = {[FACE_JOIN_OUT_FACE] = {"face", HE_RESULT_ELEMENT, HE_FACE,
                                            "The face that stays."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_BOUNDARY_EDGE, HE_SHARED_BOUNDARY,
                     HE_LOCKED_ELEMENT},
        .change = {0, -1, -1},
        .run = run_face_join,
    },
    {
        .name = "face_poke",
        .doc = "Divide a face into triangles around a new vertex.",
        .params =
            {[FACE_POKE_FACE] =
                 {.name = "face",
                  .each = "faces",
                  .type = HE_PARAM_ELEMENT,
                  .kind = HE_FACE,
                  .flags =
                      HE_REQUIRED,
                  .doc = "The face to divide. The triangle at its stored half-edge keeps the id."},
             [FACE_POKE_POSITION] =
                 {.name = "position",
                  .type = HE_PARAM_POINT,
                  .doc = "Where the vertex is placed. Default: the mean of the corners."}},
        .results =
            {[FACE_POKE_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX, "The new vertex."},
             [FACE_POKE_OUT_EDGES] =
                 {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                  "The new edges, beginning at the corner of the stored half-edge."},
             [FACE_POKE_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                      "The new faces, counter-clockwise, beginning after the "
                                      "triangle that keeps the id."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT},
        .change = {1, HE_VARIES, HE_VARIES},
        .run = run_face_poke,
    },
    {
        .name = "face_triangulate",
        .doc = "Cut faces into triangles by diagonals.",
        .params = {[FACE_TRIANGULATE_FACES] = {.name = "face",
                                               .plural = "faces",
                                               .type = HE_PARAM_ELEMENTS,
                                               .kind = HE_FACE,
                                               .flags = HE_REQUIRED,
                                               .doc =
                                                   "The faces to cut. In each face, the triangle "
                                                   "at its stored half-edge keeps the id."}},
        .results =
            {[FACE_TRIANGULATE_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                             "The diagonals."},
             [FACE_TRIANGULATE_OUT_FACES] = {"faces",
                                             HE_RESULT_ELEMENTS, HE_FACE, "The new faces."},
             [FACE_TRIANGULATE_OUT_DEGENERATE] =
                 {"degenerate", HE_RESULT_ELEMENTS, HE_FACE,
                  "The faces in which a triangle has no area or is turned over, as seen in "
                  "the plane of the face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_DOUBLED_EDGE},
        .change = {0, HE_VARIES, HE_VARIES},
        .pace = 40,
        .run = run_face_triangulate,
    },
    {.name = NULL},
};
