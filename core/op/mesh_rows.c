#include "op/rows.h"

#include "edit/plane/plane_cut.h"
#include "edit/plane/plane_split.h"
#include "edit/whole/delaunay.h"
#include "edit/whole/transform.h"
#include "mesh/compact.h"

static he_status run_transform(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    const uint32_t *vertices = args[1].given ? args[1].ids : NULL;
    return he_transform(m, args[0].matrix, vertices, args[1].count, err);
}

static he_status run_plane_split(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_plane_parts parts;
    const double *tolerance = args[3].given ? &args[3].number : NULL;
    const uint32_t *faces = args[2].given ? args[2].ids : NULL;
    he_status status = he_plane_split(m, args[0].points[0], args[1].points[0], tolerance, faces,
                                      args[2].count, &parts, err);
    if (status == HE_OK) {
        he_give_number(out, 0, (double)parts.vertices.count);
        he_give_number(out, 1, parts.faces_split);
        he_give_list(out, 2, &parts.vertices);
        he_give_list(out, 3, &parts.edges);
        he_give_list(out, 4, &parts.faces);
        he_plane_parts_clear(&parts);
    }
    return status;
}

static he_status run_plane_cut(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_cut_parts parts;
    const double *tolerance = args[4].given ? &args[4].number : NULL;
    he_status status = he_plane_cut(m, args[0].points[0], args[1].points[0], tolerance,
                                    (he_cut_side)args[2].choice, args[3].flag, &parts, err);
    if (status == HE_OK) {
        he_give_number(out, 0, parts.edges_split);
        he_give_number(out, 1, parts.faces_split);
        he_give_number(out, 2, parts.faces_deleted);
        he_give_list(out, 3, &parts.caps);
        he_cut_parts_clear(&parts);
    }
    return status;
}

static he_status run_delaunay(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    const uint32_t *edges = args[0].given ? args[0].ids : NULL;
    he_status status = he_delaunay(m, edges, args[0].count, &out->list[1], err);
    if (status == HE_OK) {
        he_give_number(out, 0, (double)out->list[1].count);
    }
    return status;
}

static void give_map(he_results *out, size_t i, uint32_t **takes, uint32_t count)
{
    he_ids list = {*takes, count, count};
    he_give_list(out, i, &list);
    *takes = NULL;
}

static he_status run_compact(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)args;
    he_maps maps = {0};
    he_status status = he_compact(m, &maps, err);
    if (status == HE_OK) {
        give_map(out, 0, &maps.vertex, maps.vertices);
        give_map(out, 1, &maps.edge, maps.edges);
        give_map(out, 2, &maps.face, maps.faces);
        he_maps_clear(&maps);
    }
    return status;
}

/* The parameters that plane_split and plane_cut have in common. */
#define PLANE                                                           \
    {.name = "point",                                                   \
     .type = HE_PARAM_POINT,                                            \
     .flags = HE_REQUIRED,                                              \
     .doc = "Any point of the plane."},                                 \
    {                                                                   \
        .name = "normal", .type = HE_PARAM_POINT, .flags = HE_REQUIRED, \
        .doc = "The direction it faces, of any length but zero."        \
    }
#define TOLERANCE                                                                        \
    {                                                                                    \
        .name = "tolerance", .type = HE_PARAM_NUMBER, .flags = HE_DERIVED,               \
        .doc = "Vertices within this distance of the plane count as in it; 1e-9 of the " \
               "longest side of the box around the edges when not given, or what "       \
               "rounding needs where coordinates are larger than that."                  \
    }
#define SPLIT_COUNTS                                                            \
    {"edges_split", HE_RESULT_NUMBER, HE_EDGE, "How many edges got a vertex."}, \
    {                                                                           \
        "faces_split", HE_RESULT_NUMBER, HE_FACE, "How many faces were cut."    \
    }

/* The names of the values of he_cut_side, in their order. */
static const char *const cut_sides[] = {"above", "below", NULL};

const he_op he_mesh_rows[] = {
    {
        .name = "transform",
        .doc = "Apply an affine map to vertices, and to attributes `normal`.",
        .size = HE_OP_WHOLE,
        .params = {{.name = "matrix",
                    .type = HE_PARAM_MATRIX,
                    .flags = HE_REQUIRED,
                    .doc = "16 numbers, row-major, the last row 0 0 0 1."},
                   {.name = "vertex",
                    .plural = "vertices",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_VERTEX,
                    .doc = "What moves; all vertices when not given."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_FINITE,
                     HE_LOCKED_ELEMENT},
        .change = {0, 0, 0},
        .run = run_transform,
    },
    {
        .name = "plane_split",
        .doc = "Split the faces a plane crosses: a vertex on each edge it crosses, a diagonal in "
               "each face.",
        .size = HE_OP_WHOLE,
        .params = {PLANE,
                   {.name = "face",
                    .plural = "faces",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_FACE,
                    .doc = "What is cut; all faces when not given."},
                   TOLERANCE},
        .results = {SPLIT_COUNTS,
                    {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX, "The new vertices."},
                    {"edges", HE_RESULT_ELEMENTS, HE_EDGE, "The diagonals."},
                    {"faces", HE_RESULT_ELEMENTS, HE_FACE, "The new faces, one a diagonal."}},
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
        .params = {PLANE,
                   {.name = "keep",
                    .type = HE_PARAM_CHOICE,
                    .choices = cut_sides,
                    .doc = "The side that stays; above is where the normal points. A face in the "
                           "plane is below it when it faces up."},
                   {.name = "cap",
                    .type = HE_PARAM_FLAG,
                    .doc = "Close each loop of the cut with a polygon."},
                   TOLERANCE},
        .results = {SPLIT_COUNTS,
                    {"faces_deleted", HE_RESULT_NUMBER, HE_FACE,
                     "How many faces went, the parts of those that were cut among them."},
                    {"caps", HE_RESULT_ELEMENTS, HE_FACE, "The polygons that close the cut."}},
        .refusals = {HE_BAD_VALUE, HE_DOUBLED_EDGE, HE_LOCKED_ELEMENT, HE_OPEN_LOOP,
                     HE_REPEATED_CORNER},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 10,
        .run = run_plane_cut,
    },
    {
        .name = "delaunay",
        .doc = "Flip edges between triangles while the angles opposite to them sum to more than "
               "pi; flips may grow with the square of the edges, and what takes more than 512 "
               "steps for each edge of the mesh is refused.",
        .size = HE_OP_WHOLE,
        .params = {{.name = "edge",
                    .plural = "edges",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_EDGE,
                    .doc = "Where to begin, from where flips spread; all edges when not given. "
                           "Edges whose bool attribute `feature` or `locked` is true are kept, "
                           "and those beside a locked face."}},
        .results = {{"flips", HE_RESULT_NUMBER, HE_EDGE, "How many."},
                    {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                     "What was flipped, in order; twice what was flipped twice."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_LIMIT},
        .change = {0, 0, 0},
        .pace = 2,
        .run = run_delaunay,
    },
    {
        .name = "compact",
        .doc = "Drop deleted ids and number what lives anew.",
        .size = HE_OP_WHOLE,
        .results = {{"vertices", HE_RESULT_MAP, HE_VERTEX, "The new id of each old one."},
                    {"edges", HE_RESULT_MAP, HE_EDGE, "The new id of each old one."},
                    {"faces", HE_RESULT_MAP, HE_FACE, "The new id of each old one."}},
        .change = {0, 0, 0},
        .pace = 2,
        .run = run_compact,
    },
    {.name = NULL},
};
