#include "op/rows.h"

#include "fill/fill.h"

#include <float.h>

/* The names that requests use for the values of he_fill_method, in the order of the enum. */
static const char *const fill_methods[] = {"polygon", "fan", "triangulate", "smooth", NULL};

enum { HOLE_FILL_HALFEDGE, HOLE_FILL_METHOD, HOLE_FILL_EDGE_LENGTH, HOLE_FILL_CONTINUITY };
enum { HOLE_FILL_OUT_VERTEX, HOLE_FILL_OUT_EDGES, HOLE_FILL_OUT_FACES, HOLE_FILL_OUT_BEND };

static he_smooth_fill smooth_fill_of(const he_arg *edge_length, const he_arg *continuity)
{
    return (he_smooth_fill){.edge_length = edge_length->given ? edge_length->number : 0,
                            .continuity = (he_continuity)continuity->number};
}

static he_status fill_hole(he_mesh *m, const he_arg *args, he_filled *out, he_error *err)
{
    const he_halfedge h = {args[HOLE_FILL_HALFEDGE].id};
    const he_fill_method method = (he_fill_method)args[HOLE_FILL_METHOD].choice;
    if (method == HE_FILL_ALL_SMOOTH) {
        const he_smooth_fill options =
            smooth_fill_of(&args[HOLE_FILL_EDGE_LENGTH], &args[HOLE_FILL_CONTINUITY]);
        return he_hole_fill_smooth(m, h, &options, out, err);
    }
    return he_hole_fill(m, h, he_fill_of(method), out, err);
}

/* Returns the number in row i of a column, or the one number for all rows. */
static double number_at(const he_arg *arg, size_t i)
{
    return arg->list ? arg->numbers[i] : arg->number;
}

/* An estimate: the sizes of the holes, but not how they bulge, are looked at. */
static double hole_fill_growth(const he_mesh *m, const he_arg *args)
{
    /* a large surface of n triangles has n / 2 vertices and 3 n / 2 edges */
    static const uint64_t most_steps = 1 << 20;
    static const double elements_of_face = 3;
    const he_arg *holes = &args[HOLE_FILL_HALFEDGE], *length = &args[HOLE_FILL_EDGE_LENGTH];
    uint64_t steps = most_steps;
    double faces = 0;
    if (m == NULL || args[HOLE_FILL_METHOD].choice != HE_FILL_ALL_SMOOTH) {
        return 1;
    }
    const double elements = (double)he_mesh_issued(m, HE_VERTEX) + he_mesh_issued(m, HE_EDGE) +
                            he_mesh_issued(m, HE_FACE);
    for (size_t i = 0; i < (holes->list ? holes->count : 1) && steps > 0; i++) {
        const he_halfedge h = {holes->list ? holes->ids[i] : holes->id};
        const he_smooth_fill options = {.edge_length = length->given ? number_at(length, i) : 0};
        const double made = he_fill_foretell(m, h, &options, &steps);
        faces += made <= HE_FILL_FACES || !length->given ? made : 0; /* else it will be refused */
    }
    return elements > 0 ? 1 + elements_of_face * faces / elements : 1;
}

/* `pace` is the time of the other methods. The equations of a higher order take longer. */
static unsigned hole_fill_times(const he_arg *args)
{
    static const unsigned smooth[] = {10, 20, 30};
    const he_arg *continuity = &args[HOLE_FILL_CONTINUITY];
    const size_t order = continuity->list ? HE_CONTINUOUS_CURVATURE : (size_t)continuity->number;
    return args[HOLE_FILL_METHOD].choice == HE_FILL_ALL_SMOOTH ? smooth[order] : 1;
}

static he_status run_hole_fill(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_filled filled;
    he_status status = fill_hole(m, args, &filled, err);
    if (status == HE_OK) {
        he_results_set(out, HOLE_FILL_OUT_VERTEX, filled.vertex.i);
        he_results_set_list(out, HOLE_FILL_OUT_EDGES, &filled.edges);
        he_results_set_list(out, HOLE_FILL_OUT_FACES, &filled.faces);
        he_results_set_number(out, HOLE_FILL_OUT_BEND, he_fill_bend(m, &filled.loop));
        he_filled_clear(&filled);
    }
    return status;
}

enum {
    FILL_HOLES_METHOD,
    FILL_HOLES_MAX_EDGES,
    FILL_HOLES_MAX_SIZE,
    FILL_HOLES_EDGE_LENGTH,
    FILL_HOLES_CONTINUITY
};
enum {
    FILL_HOLES_OUT_FILLED,
    FILL_HOLES_OUT_LEFT,
    FILL_HOLES_OUT_LARGE,
    FILL_HOLES_OUT_TOUCHING,
    FILL_HOLES_OUT_SINGLE,
    FILL_HOLES_OUT_DOUBLED,
    FILL_HOLES_OUT_BEND
};

static he_fill_holes_options fill_holes_options_of(const he_arg *args)
{
    const he_arg *edges = &args[FILL_HOLES_MAX_EDGES], *size = &args[FILL_HOLES_MAX_SIZE];
    return (he_fill_holes_options){
        .method = (he_fill_method)args[FILL_HOLES_METHOD].choice,
        .smooth = smooth_fill_of(&args[FILL_HOLES_EDGE_LENGTH], &args[FILL_HOLES_CONTINUITY]),
        .max_edges = edges->given ? (uint32_t)edges->number : 0,
        .max_size = size->given ? size->number : 0};
}

static double fill_holes_growth(const he_mesh *mesh, const he_arg *args)
{
    const uint32_t faces = mesh == NULL ? 0 : he_mesh_faces(mesh);
    if (faces == 0) {
        return 1;
    }
    const he_fill_holes_options options = fill_holes_options_of(args);
    return 1 + he_fill_holes_foretell(mesh, &options) / faces;
}

static he_status run_fill_holes(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    const he_fill_holes_options options = fill_holes_options_of(args);
    he_filled_holes done;
    he_status status = he_fill_holes(m, &options, &done, err);
    if (status == HE_OK) {
        he_results_set_number(out, FILL_HOLES_OUT_FILLED, done.filled);
        he_results_set_list(out, FILL_HOLES_OUT_LEFT, &done.left);
        he_results_set_number(out, FILL_HOLES_OUT_LARGE, done.large);
        he_results_set_number(out, FILL_HOLES_OUT_TOUCHING, done.touching);
        he_results_set_number(out, FILL_HOLES_OUT_SINGLE, done.single);
        he_results_set_number(out, FILL_HOLES_OUT_DOUBLED, done.doubled);
        he_results_set_number(out, FILL_HOLES_OUT_BEND, done.bend);
        he_filled_holes_clear(&done);
    }
    return status;
}

#define METHODS_DOC                                                                              \
    "polygon: one face. fan: triangles around a new vertex. triangulate: triangles between the " \
    "corners. smooth: triangles as large as those around the hole, on a surface that continues " \
    "the mesh."

#define EDGE_LENGTH                                                                               \
    {                                                                                             \
        .name = "edge_length", .type = HE_PARAM_NUMBER,                                           \
        .flags = HE_DERIVED | HE_RANGE | HE_EXCLUSIVE, .min = 0, .max = DBL_MAX,                  \
        .with = HE_WITH(HE_FILL_ALL_SMOOTH),                                                      \
        .doc = "The wanted length of the new edges. Default: that of the edges around the hole, " \
               "growing inwards in a hole that would get more than 50000 faces otherwise. "       \
               "A length that asks for more than 100000 faces in a hole, or 500000 in all holes " \
               "together, is refused."                                                            \
    }

#define CONTINUITY                                                                             \
    {                                                                                          \
        .name = "continuity", .type = HE_PARAM_NUMBER, .flags = HE_RANGE | HE_WHOLE, .min = 0, \
        .max = 2, .fallback = HE_CONTINUOUS_TANGENT, .with = HE_WITH(HE_FILL_ALL_SMOOTH),      \
        .doc = "How smoothly the new surface continues the mesh at the edges of the hole. 0: " \
               "without a gap. 1: also with the same tangent planes. 2: also with the same "   \
               "curvature."                                                                    \
    }

const he_op he_fill_rows[] = {
    {
        .name = "hole_fill",
        .doc = "Fill a hole.",
        .params = {[HOLE_FILL_HALFEDGE] = {.name = "halfedge",
                                           .each = "halfedges",
                                           .type = HE_PARAM_ELEMENT,
                                           .kind = HE_HALFEDGE,
                                           .flags = HE_REQUIRED,
                                           .doc = "A boundary half-edge of the hole."},
                   [HOLE_FILL_METHOD] = {.name = "method",
                                         .type = HE_PARAM_CHOICE,
                                         .flags = HE_SELECTS,
                                         .choices = fill_methods,
                                         .doc = METHODS_DOC},
                   [HOLE_FILL_EDGE_LENGTH] = EDGE_LENGTH,
                   [HOLE_FILL_CONTINUITY] = CONTINUITY},
        .results =
            {[HOLE_FILL_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX,
                                       "The new vertex, or null if there is not exactly one."},
             [HOLE_FILL_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE, "The new edges."},
             [HOLE_FILL_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE, "The new faces."},
             [HOLE_FILL_OUT_BEND] = {"bend", HE_RESULT_NUMBER, HE_EDGE,
                                     "The largest angle between the normals of a new face "
                                     "and of its neighbour outside of the hole.",
                                     .unit = HE_RADIANS}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_NOT_BOUNDARY, HE_REPEATED_CORNER,
                     HE_DOUBLED_EDGE, HE_LIMIT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .times = hole_fill_times,
        .growth = hole_fill_growth,
        .run = run_hole_fill,
    },
    {
        .name = "fill_holes",
        .doc = "Fill all holes, each as hole_fill does. The outer boundary of an open surface is a "
               "hole, too: max_edges or max_size leave it open.",
        .size = HE_OP_WHOLE,
        .params = {[FILL_HOLES_METHOD] = {.name = "method",
                                          .type = HE_PARAM_CHOICE,
                                          .flags = HE_SELECTS,
                                          .fallback = HE_FILL_ALL_SMOOTH,
                                          .choices = fill_methods,
                                          .doc = METHODS_DOC},
                   [FILL_HOLES_MAX_EDGES] = {.name = "max_edges",
                                             .type = HE_PARAM_NUMBER,
                                             .flags = HE_DERIVED | HE_RANGE | HE_WHOLE,
                                             .min = 3,
                                             .max = UINT32_MAX,
                                             .doc = "Holes with more edges are left. Default: "
                                                    "holes of any number of edges are filled."},
                   [FILL_HOLES_MAX_SIZE] = {.name = "max_size",
                                            .type = HE_PARAM_NUMBER,
                                            .flags = HE_DERIVED | HE_RANGE | HE_EXCLUSIVE,
                                            .min = 0,
                                            .max = DBL_MAX,
                                            .doc = "Holes whose box has a longer diagonal are "
                                                   "left. Default: holes of any size are filled."},
                   [FILL_HOLES_EDGE_LENGTH] = EDGE_LENGTH,
                   [FILL_HOLES_CONTINUITY] = CONTINUITY},
        .results = {[FILL_HOLES_OUT_FILLED] = {"filled", HE_RESULT_NUMBER, HE_FACE,
                                               "How many holes were filled."},
                    [FILL_HOLES_OUT_LEFT] = {"left", HE_RESULT_ELEMENTS, HE_HALFEDGE,
                                             "A boundary half-edge of each hole that was left."},
                    [FILL_HOLES_OUT_LARGE] = {"large", HE_RESULT_NUMBER, HE_HALFEDGE,
                                              "How many were left because of max_edges or "
                                              "max_size."},
                    [FILL_HOLES_OUT_TOUCHING] = {"touching", HE_RESULT_NUMBER, HE_HALFEDGE,
                                                 "How many were left because they pass a vertex "
                                                 "twice."},
                    [FILL_HOLES_OUT_SINGLE] = {"single", HE_RESULT_NUMBER, HE_HALFEDGE,
                                               "How many were left because there is only one face "
                                               "around them."},
                    [FILL_HOLES_OUT_DOUBLED] = {"doubled", HE_RESULT_NUMBER, HE_HALFEDGE,
                                                "How many were left because triangles between "
                                                "their corners would double an edge."},
                    [FILL_HOLES_OUT_BEND] = {"bend", HE_RESULT_NUMBER, HE_EDGE,
                                             "The largest angle between the normals of a new face "
                                             "and of its neighbour outside of the hole.",
                                             .unit = HE_RADIANS}},
        .refusals = {HE_LIMIT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 20,
        .growth = fill_holes_growth,
        .run = run_fill_holes,
    },
    {.name = NULL},
};
