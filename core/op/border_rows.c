#include "op/rows.h"

#include "edit/border/edge_extrude.h"
#include "edit/border/seam.h"
#include "edit/local/erase.h"

enum { EDGE_DELETE_EDGES, EDGE_DELETE_KEEP_ISOLATED };

static he_status run_edge_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_edge_delete(
        m, args[EDGE_DELETE_EDGES].ids, args[EDGE_DELETE_EDGES].count,
        args[EDGE_DELETE_KEEP_ISOLATED].flag ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED, err);
}

enum { EDGE_CUT_EDGES };
enum { EDGE_CUT_OUT_VERTICES, EDGE_CUT_OUT_EDGES };

static he_status run_edge_cut(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_seam seam;
    he_status status =
        he_edge_cut(m, args[EDGE_CUT_EDGES].ids, args[EDGE_CUT_EDGES].count, &seam, err);
    if (status == HE_OK) {
        he_results_set_list(out, EDGE_CUT_OUT_VERTICES, &seam.vertices);
        he_results_set_list(out, EDGE_CUT_OUT_EDGES, &seam.edges);
        he_seam_clear(&seam);
    }
    return status;
}

enum { EDGE_WELD_A, EDGE_WELD_B, EDGE_WELD_KEEP };
enum { EDGE_WELD_OUT_EDGE, EDGE_WELD_OUT_MOVED };

static he_status run_edge_weld(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    uint64_t moved = 0;
    he_status status =
        he_edge_weld(m, (he_edge){args[EDGE_WELD_A].id}, (he_edge){args[EDGE_WELD_B].id},
                     (he_keep)args[EDGE_WELD_KEEP].choice, &moved, err);
    if (status == HE_OK) {
        he_results_set(out, EDGE_WELD_OUT_EDGE, args[EDGE_WELD_A].id);
        he_results_set_number(out, EDGE_WELD_OUT_MOVED, (double)moved);
    }
    return status;
}

enum { EDGE_EXTRUDE_EDGES, EDGE_EXTRUDE_BY };
enum { EDGE_EXTRUDE_OUT_VERTICES, EDGE_EXTRUDE_OUT_EDGES, EDGE_EXTRUDE_OUT_FACES };

static he_status run_edge_extrude(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_walls walls;
    he_status status =
        he_edge_extrude(m, args[EDGE_EXTRUDE_EDGES].ids, args[EDGE_EXTRUDE_EDGES].count,
                        args[EDGE_EXTRUDE_BY].points[0], &walls, err);
    if (status == HE_OK) {
        he_results_set_list(out, EDGE_EXTRUDE_OUT_VERTICES, &walls.vertices);
        he_results_set_list(out, EDGE_EXTRUDE_OUT_EDGES, &walls.edges);
        he_results_set_list(out, EDGE_EXTRUDE_OUT_FACES, &walls.faces);
        he_walls_clear(&walls);
    }
    return status;
}

/* The names that requests use for the values of he_keep, in the order of the enum. */
static const char *const keeps[] = {"mean", "a", "b", NULL};

const he_op he_border_rows[] = {
    {
        .name = "edge_delete",
        .doc = "Delete edges and the faces beside them, and then the other edges and the vertices "
               "that have no face left.",
        .params = {[EDGE_DELETE_EDGES] = {.name = "edge",
                                          .plural = "edges",
                                          .type = HE_PARAM_ELEMENTS,
                                          .kind = HE_EDGE,
                                          .flags = HE_REQUIRED,
                                          .doc = "The edges to delete."},
                   [EDGE_DELETE_KEEP_ISOLATED] = {.name = "keep_isolated",
                                                  .type = HE_PARAM_FLAG,
                                                  .doc =
                                                      "Keep vertices that lose their last face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 60,
        .run = run_edge_delete,
    },
    {
        .name = "edge_cut",
        .doc = "Cut the mesh open along edges. Each cut edge becomes two boundary edges.",
        .params = {[EDGE_CUT_EDGES] = {.name = "edge",
                                       .plural = "edges",
                                       .type = HE_PARAM_ELEMENTS,
                                       .kind = HE_EDGE,
                                       .flags = HE_REQUIRED | HE_WALKS,
                                       .doc = "The edges to cut. Each edge keeps its id on the "
                                              "side of its first half-edge."}},
        .results =
            {[EDGE_CUT_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                        "The new vertices; each is in the same place as the vertex "
                                        "that it was split from."},
             [EDGE_CUT_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                     "The new edges, on the other side of the cut, in ascending "
                                     "order of the cut edges."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BOUNDARY_EDGE,
                     HE_DOUBLED_EDGE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, 0},
        .pace = 40,
        .run = run_edge_cut,
    },
    {
        .name = "edge_weld",
        .doc = "Merge two boundary edges. This is the inverse of edge_cut.",
        .params =
            {[EDGE_WELD_A] = {.name = "a",
                              .each = "a",
                              .type = HE_PARAM_ELEMENT,
                              .kind = HE_EDGE,
                              .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                              .doc = "The edge that stays, with its two vertices."},
             [EDGE_WELD_B] = {.name = "b",
                              .type = HE_PARAM_ELEMENT,
                              .kind = HE_EDGE,
                              .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                              .doc = "The edge that is merged into `a`, with its two vertices."},
             [EDGE_WELD_KEEP] = {.name = "keep",
                                 .type = HE_PARAM_CHOICE,
                                 .choices = keeps,
                                 .doc =
                                     "Where the merged vertices are placed: midway between the old "
                                     "vertices, or where the vertices of `a` or of `b` were."}},
        .results = {[EDGE_WELD_OUT_EDGE] = {"edge", HE_RESULT_ELEMENT, HE_EDGE,
                                            "The edge that stays."},
                    [EDGE_WELD_OUT_MOVED] =
                        {"moved", HE_RESULT_NUMBER, 0,
                         "How many attribute values of vertices became values of corners, because "
                         "the merged vertices had different values."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_BOUNDARY,
                     HE_REPEATED_CORNER, HE_DOUBLED_EDGE, HE_CLOSED_FAN, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, -1, 0},
        .run = run_edge_weld,
    },
    {
        .name = "edge_extrude",
        .doc = "Extrude boundary edges into quads.",
        .params = {[EDGE_EXTRUDE_EDGES] = {.name = "edge",
                                           .plural = "edges",
                                           .type = HE_PARAM_ELEMENTS,
                                           .kind = HE_EDGE,
                                           .flags = HE_REQUIRED,
                                           .doc =
                                               "The edges to extrude. If one edge follows another "
                                               "along the boundary, their quads share a side."},
                   [EDGE_EXTRUDE_BY] = {.name = "by",
                                        .type = HE_PARAM_POINT,
                                        .flags = HE_REQUIRED,
                                        .doc = "The vector from the edges to their copies."}},
        .results =
            {[EDGE_EXTRUDE_OUT_VERTICES] =
                 {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                  "The new vertices, in ascending order of the vertices that they are copies of."},
             [EDGE_EXTRUDE_OUT_EDGES] =
                 {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                  "The copies of the edges, in the order of the given edges."},
             [EDGE_EXTRUDE_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                         "The quads, in the order of the given edges."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_BOUNDARY,
                     HE_BRANCHING_CHAIN, HE_CLOSED_FAN, HE_NOT_FINITE},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 40,
        .run = run_edge_extrude,
    },
    {.name = NULL},
};
