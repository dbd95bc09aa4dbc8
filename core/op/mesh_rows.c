#include "op/rows.h"

#include "edit/plane/plane_cut.h"
#include "edit/plane/plane_split.h"
#include "edit/whole/delaunay.h"
#include "edit/whole/transform.h"
#include "mesh/compact.h"

enum { TRANSFORM_MATRIX, TRANSFORM_VERTICES };

static he_status run_transform(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    const uint32_t *vertices = args[TRANSFORM_VERTICES].given ? args[TRANSFORM_VERTICES].ids : NULL;
    return he_transform(m, args[TRANSFORM_MATRIX].matrix, vertices, args[TRANSFORM_VERTICES].count,
                        err);
}

enum { PLANE_SPLIT_POINT, PLANE_SPLIT_NORMAL, PLANE_SPLIT_FACES, PLANE_SPLIT_TOLERANCE };
enum {
    PLANE_SPLIT_OUT_EDGES_SPLIT,
    PLANE_SPLIT_OUT_FACES_SPLIT,
    PLANE_SPLIT_OUT_VERTICES,
    PLANE_SPLIT_OUT_EDGES,
    PLANE_SPLIT_OUT_FACES
};

static he_status run_plane_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_plane_parts parts;
    const he_plane plane = {args[PLANE_SPLIT_POINT].points[0], args[PLANE_SPLIT_NORMAL].points[0],
                            args[PLANE_SPLIT_TOLERANCE].given ? &args[PLANE_SPLIT_TOLERANCE].number
                                                              : NULL};
    const uint32_t *faces = args[PLANE_SPLIT_FACES].given ? args[PLANE_SPLIT_FACES].ids : NULL;
    he_status status = he_plane_split(m, &plane, faces, args[PLANE_SPLIT_FACES].count, &parts, err);
    if (status == HE_OK) {
        he_results_set_number(out, PLANE_SPLIT_OUT_EDGES_SPLIT, (double)parts.vertices.count);
        he_results_set_number(out, PLANE_SPLIT_OUT_FACES_SPLIT, parts.faces_split);
        he_results_set_list(out, PLANE_SPLIT_OUT_VERTICES, &parts.vertices);
        he_results_set_list(out, PLANE_SPLIT_OUT_EDGES, &parts.edges);
        he_results_set_list(out, PLANE_SPLIT_OUT_FACES, &parts.faces);
        he_plane_parts_clear(&parts);
    }
    return status;
}

enum { PLANE_CUT_POINT, PLANE_CUT_NORMAL, PLANE_CUT_KEEP, PLANE_CUT_CAP, PLANE_CUT_TOLERANCE };
enum {
    PLANE_CUT_OUT_EDGES_SPLIT,
    PLANE_CUT_OUT_FACES_SPLIT,
    PLANE_CUT_OUT_FACES_DELETED,
    PLANE_CUT_OUT_CAPS
};

static he_status run_plane_cut(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_cut_parts parts;
    const he_plane plane = {args[PLANE_CUT_POINT].points[0], args[PLANE_CUT_NORMAL].points[0],
                            args[PLANE_CUT_TOLERANCE].given ? &args[PLANE_CUT_TOLERANCE].number
                                                            : NULL};
    he_status status = he_plane_cut(m, &plane, (he_cut_side)args[PLANE_CUT_KEEP].choice,
                                    args[PLANE_CUT_CAP].flag, &parts, err);
    if (status == HE_OK) {
        he_results_set_number(out, PLANE_CUT_OUT_EDGES_SPLIT, parts.edges_split);
        he_results_set_number(out, PLANE_CUT_OUT_FACES_SPLIT, parts.faces_split);
        he_results_set_number(out, PLANE_CUT_OUT_FACES_DELETED, parts.faces_deleted);
        he_results_set_list(out, PLANE_CUT_OUT_CAPS, &parts.caps);
        he_cut_parts_clear(&parts);
    }
    return status;
}

enum { DELAUNAY_EDGES };
enum { DELAUNAY_OUT_FLIPS, DELAUNAY_OUT_EDGES };

static he_status run_delaunay(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    const uint32_t *edges = args[DELAUNAY_EDGES].given ? args[DELAUNAY_EDGES].ids : NULL;
    he_status status =
        he_delaunay(m, edges, args[DELAUNAY_EDGES].count, &out->list[DELAUNAY_OUT_EDGES], err);
    if (status == HE_OK) {
        he_results_set_number(out, DELAUNAY_OUT_FLIPS, (double)out->list[DELAUNAY_OUT_EDGES].count);
    }
    return status;
}

static void give_map(he_results *out, size_t slot, uint32_t **takes, uint32_t count)
{
    he_ids list = {*takes, count, count};
    he_results_set_list(out, slot, &list);
    *takes = NULL;
}

enum { COMPACT_OUT_VERTICES, COMPACT_OUT_EDGES, COMPACT_OUT_FACES };

static he_status run_compact(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)args;
    he_maps maps = {0};
    he_status status = he_compact(m, &maps, err);
    if (status == HE_OK) {
        give_map(out, COMPACT_OUT_VERTICES, &maps.vertex, maps.vertices);
        give_map(out, COMPACT_OUT_EDGES, &maps.edge, maps.edges);
        give_map(out, COMPACT_OUT_FACES, &maps.face, maps.faces);
        he_maps_clear(&maps);
    }
    return status;
}

/* Parameters and results that plane_split and plane_cut have in common. */
#define PLANE_POINT                                                    \
    {                                                                  \
        .name = "point", .type = HE_PARAM_POINT, .flags = HE_REQUIRED, \
        .doc = "Any point of the plane."                               \
    }
#define PLANE_NORMAL                                                                               \
    {                                                                                              \
        .name = "normal", .type = HE_PARAM_POINT, .flags = HE_REQUIRED,                            \
        .doc = "The direction of the plane's normal. Its length does not matter, but must not be " \
               "zero."                                                                             \
    }
#define PLANE_TOLERANCE                                                                            \
    {                                                                                              \
        .name = "tolerance", .type = HE_PARAM_NUMBER, .flags = HE_DERIVED,                         \
        .doc = "Vertices within this distance of the plane count as in the plane. Default: 1e-9 "  \
               "of the longest side of the bounding box of the edges, or more if the rounding of " \
               "large coordinates needs it."                                                       \
    }
#define EDGES_SPLIT                                                            \
    {                                                                          \
        "edges_split", HE_RESULT_NUMBER, HE_EDGE, "How many edges were split." \
    }
#define FACES_SPLIT                                                          \
    {                                                                        \
        "faces_split", HE_RESULT_NUMBER, HE_FACE, "How many faces were cut." \
    }

/* The names that requests use for the values of he_cut_side, in the order of the enum. */
static const char *const cut_sides[] = {"above", "below", NULL};

const he_op he_mesh_rows[] = {
    {
        .name = "transform",
        .doc = "Apply an affine transformation to vertices and to the attributes named `normal`.",
        .size = HE_OP_WHOLE,
        .params = {[TRANSFORM_MATRIX] = {.name = "matrix",
                                         .type = HE_PARAM_MATRIX,
                                         .flags = HE_REQUIRED,
                                         .doc = "The matrix of the transformation: 16 numbers, row "
                                                "by row; the last row is 0 0 0 1."},
                   [TRANSFORM_VERTICES] = {.name = "vertex",
                                           .plural = "vertices",
                                           .type = HE_PARAM_ELEMENTS,
                                           .kind = HE_VERTEX,
                                           .doc = "The vertices to move. Default: all."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_FINITE,
                     HE_LOCKED_ELEMENT},
        .change = {0, 0, 0},
        .run = run_transform,
    },
    {
        .name = "plane_split",
        .doc = "Split the faces that a plane crosses: a new vertex on each edge, a new edge in "
               "each face.",
        .size = HE_OP_WHOLE,
        .params = {[PLANE_SPLIT_POINT] = PLANE_POINT,
                   [PLANE_SPLIT_NORMAL] = PLANE_NORMAL,
                   [PLANE_SPLIT_FACES] = {.name = "face",
                                          .plural = "faces",
                                          .type = HE_PARAM_ELEMENTS,
                                          .kind = HE_FACE,
                                          .doc = "The faces to cut. Default: all."},
                   [PLANE_SPLIT_TOLERANCE] = PLANE_TOLERANCE},
        .results =
            {[PLANE_SPLIT_OUT_EDGES_SPLIT] = EDGES_SPLIT,
             [PLANE_SPLIT_OUT_FACES_SPLIT] = FACES_SPLIT,
             [PLANE_SPLIT_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                           "The new vertices."},
             [PLANE_SPLIT_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                        "The new edges inside the faces."},
             [PLANE_SPLIT_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                        "The new faces, one for each new edge inside a face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_DOUBLED_EDGE},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 6,
        .run = run_plane_split,
    },
    {
        .name = "plane_cut",
        .doc = "Split the mesh along a plane and delete what is on one side.",
        .size = HE_OP_WHOLE,
        .params = {[PLANE_CUT_POINT] = PLANE_POINT,
                   [PLANE_CUT_NORMAL] = PLANE_NORMAL,
                   [PLANE_CUT_KEEP] =
                       {.name = "keep",
                        .type = HE_PARAM_CHOICE,
                        .choices = cut_sides,
                        .doc = "The side of the plane that is kept; above is the side to which the "
                               "normal points. A face that lies in the plane counts as below if "
                               "its own normal points to the side above."},
                   [PLANE_CUT_CAP] = {.name = "cap",
                                      .type = HE_PARAM_FLAG,
                                      .doc = "Close each loop of the cut with a polygon."},
                   [PLANE_CUT_TOLERANCE] = PLANE_TOLERANCE},
        .results = {[PLANE_CUT_OUT_EDGES_SPLIT] = EDGES_SPLIT,
                    [PLANE_CUT_OUT_FACES_SPLIT] = FACES_SPLIT,
                    [PLANE_CUT_OUT_FACES_DELETED] =
                        {"faces_deleted", HE_RESULT_NUMBER, HE_FACE,
                         "How many faces were deleted. Parts of faces that were cut count, too."},
                    [PLANE_CUT_OUT_CAPS] = {"caps", HE_RESULT_ELEMENTS, HE_FACE,
                                            "The polygons that close the cut."}},
        .refusals = {HE_BAD_VALUE, HE_DOUBLED_EDGE, HE_LOCKED_ELEMENT, HE_OPEN_LOOP,
                     HE_REPEATED_CORNER},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 10,
        .run = run_plane_cut,
    },
    {
        .name = "delaunay",
        .doc = "Flip edges between triangles until the angles opposite each edge add up to at most "
               "pi (Delaunay). An input that takes more than 512 steps for each edge of the mesh "
               "is refused.",
        .size = HE_OP_WHOLE,
        .params = {[DELAUNAY_EDGES] =
                       {.name = "edge",
                        .plural = "edges",
                        .type = HE_PARAM_ELEMENTS,
                        .kind = HE_EDGE,
                        .doc = "The edges to begin with; flips spread from these edges. Default: "
                               "all. Edges whose bool attribute `feature` or `locked` is true, and "
                               "edges of locked faces, are not flipped."}},
        .results = {[DELAUNAY_OUT_FLIPS] = {"flips", HE_RESULT_NUMBER, HE_EDGE,
                                            "How many flips were made."},
                    [DELAUNAY_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                            "The flipped edges, in the order of the flips. An edge "
                                            "that was flipped twice is listed twice."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_LIMIT},
        .change = {0, 0, 0},
        .pace = 2,
        .run = run_delaunay,
    },
    {
        .name = "compact",
        .doc = "Renumber all elements without gaps. All ids change, and the history is cleared.",
        .size = HE_OP_WHOLE,
        .results =
            {[COMPACT_OUT_VERTICES] =
                 {"vertices", HE_RESULT_MAP, HE_VERTEX,
                  "For each old id of a vertex the new id, or null if the vertex was deleted."},
             [COMPACT_OUT_EDGES] =
                 {"edges", HE_RESULT_MAP, HE_EDGE,
                  "For each old id of an edge the new id, or null if the edge was deleted."},
             [COMPACT_OUT_FACES] =
                 {"faces", HE_RESULT_MAP, HE_FACE,
                  "For each old id of a face the new id, or null if the face was deleted."}},
        .change = {0, 0, 0},
        .pace = 2,
        .run = run_compact,
    },
    {.name = NULL},
};
