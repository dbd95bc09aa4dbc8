#include "op/rows.h"

#include "edit/border/edge_extrude.h"
#include "edit/border/seam.h"
#include "edit/local/erase.h"

static he_status run_edge_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_edge_delete(m, args[0].ids, args[0].count,
                          args[1].flag ? HE_KEEP_ISOLATED : HE_DROP_ISOLATED, err);
}

static he_status run_edge_cut(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_seam seam;
    he_status status = he_edge_cut(m, args[0].ids, args[0].count, &seam, err);
    if (status == HE_OK) {
        he_give_list(out, 0, &seam.vertices);
        he_give_list(out, 1, &seam.edges);
        he_seam_clear(&seam);
    }
    return status;
}

static he_status run_edge_weld(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    uint64_t moved = 0;
    he_status status = he_edge_weld(m, (he_edge){args[0].id}, (he_edge){args[1].id},
                                    (he_keep)args[2].choice, &moved, err);
    if (status == HE_OK) {
        he_give(out, 0, args[0].id);
        he_give_number(out, 1, (double)moved);
    }
    return status;
}

static he_status run_edge_extrude(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_walls walls;
    he_status status =
        he_edge_extrude(m, args[0].ids, args[0].count, args[1].points[0], &walls, err);
    if (status == HE_OK) {
        he_give_list(out, 0, &walls.vertices);
        he_give_list(out, 1, &walls.edges);
        he_give_list(out, 2, &walls.faces);
        he_walls_clear(&walls);
    }
    return status;
}

/* The names of the values of he_keep, in their order. */
static const char *const keeps[] = {"mean", "a", "b", NULL};

const he_op he_border_rows[] = {
    {
        .name = "edge_delete",
        .doc = "Delete edges and the faces beside them, and then the edges and vertices that have "
               "no face left.",
        .params = {{.name = "edge",
                    .plural = "edges",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED,
                    .doc = "The edges to delete."},
                   {.name = "keep_isolated",
                    .type = HE_PARAM_FLAG,
                    .doc = "Keep vertices that lose their last face."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 60,
        .run = run_edge_delete,
    },
    {
        .name = "edge_cut",
        .doc = "Cut the mesh open along edges. Each becomes two boundary edges.",
        .params = {{.name = "edge",
                    .plural = "edges",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED | HE_WALKS,
                    .doc =
                        "The edges to cut. Each keeps its id on the side of its first half-edge."}},
        .results = {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                     "The new vertices, in the same places as those that they were split from."},
                    {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                     "The new edges on the other side, in ascending order of the cut edges."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BOUNDARY_EDGE,
                     HE_DOUBLED_EDGE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, 0},
        .pace = 40,
        .run = run_edge_cut,
    },
    {
        .name = "edge_weld",
        .doc = "Merge two boundary edges. The inverse of edge_cut.",
        .params =
            {{.name = "a",
              .type = HE_PARAM_ELEMENT,
              .kind = HE_EDGE,
              .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
              .doc = "The edge that stays, with its two vertices."},
             {.name = "b",
              .type = HE_PARAM_ELEMENT,
              .kind = HE_EDGE,
              .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
              .doc = "The edge that is merged into it, with its two vertices."},
             {.name = "keep",
              .type = HE_PARAM_CHOICE,
              .choices = keeps,
              .doc =
                  "Where the merged vertices are placed: midway, or where those of a or b were."}},
        .results = {{"edge", HE_RESULT_ELEMENT, HE_EDGE, "The edge that stays."},
                    {"moved", HE_RESULT_NUMBER, 0,
                     "How many values of vertices became values of corners, because merged "
                     "vertices had different ones."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_BOUNDARY,
                     HE_REPEATED_CORNER, HE_DOUBLED_EDGE, HE_CLOSED_FAN, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, -1, 0},
        .run = run_edge_weld,
    },
    {
        .name = "edge_extrude",
        .doc = "Extrude boundary edges into quads.",
        .params = {{.name = "edge",
                    .plural = "edges",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_EDGE,
                    .flags = HE_REQUIRED,
                    .doc = "The edges to extrude. Edges that follow each other share corners."},
                   {.name = "by",
                    .type = HE_PARAM_POINT,
                    .flags = HE_REQUIRED,
                    .doc = "The vector from the edges to their copies."}},
        .results =
            {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
              "The new vertices, in ascending order of the vertices that they are copies of."},
             {"edges", HE_RESULT_ELEMENTS, HE_EDGE, "The copies of the edges, in the same order."},
             {"faces", HE_RESULT_ELEMENTS, HE_FACE, "The quads, in the same order."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_BOUNDARY,
                     HE_BRANCHING_CHAIN, HE_CLOSED_FAN, HE_NOT_FINITE},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 40,
        .run = run_edge_extrude,
    },
    {.name = NULL},
};
