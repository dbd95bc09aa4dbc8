#include "op/rows.h"

#include "edit/local/erase.h"
#include "edit/merge/weld.h"
#include "edit/whole/separate.h"

static const char *const positions[] = {"mean", "lowest", NULL};

static he_status weld_near(he_mesh *m, double tolerance, he_merge_place place, he_results *out,
                           he_error *err)
{
    uint64_t moved = 0;
    he_status status = he_weld_near(m, tolerance, place, &out->list[0], &moved, err);
    if (status == HE_OK) {
        he_give_number(out, 1, (double)moved);
    }
    return status;
}

static he_status run_vertex_weld(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_merge_place place = args[2].choice == 0 ? HE_MERGE_MEAN : HE_MERGE_INTO;
    uint64_t moved = 0;
    if (!args[0].given) {
        return weld_near(m, args[1].number, place, out, err);
    }
    he_vertex into;
    he_status status = he_give_room(out, 0, 1, err);
    if (status == HE_OK) {
        status = he_vertex_weld(m, args[0].ids, args[0].count, place, &into, &moved, err);
    }
    if (status == HE_OK && args[0].count > 1) {
        he_give_add(out, 0, into.i);
    }
    if (status == HE_OK) {
        he_give_number(out, 1, (double)moved);
    }
    return status;
}

static he_status run_weld(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    return weld_near(m, args[0].number, HE_MERGE_MEAN, out, err);
}

static he_status run_vertex_separate(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    return he_vertex_separate(m, args[0].ids, args[0].count, &out->list[0], err);
}

static he_status run_separate_bowties(he_mesh *m, const he_arg *args, he_results *out,
                                      he_error *err)
{
    (void)args;
    return he_separate_bowties(m, &out->list[0], err);
}

static he_status run_delete_isolated(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)args;
    (void)out;
    return he_delete_isolated(m, err);
}

const he_op he_weld_rows[] = {
    {
        .name = "vertex_weld",
        .doc = "Merge vertices, and the boundary edges that then coincide. Faces left with fewer "
               "than three corners are deleted, and all but the first of faces that become equal.",
        .params =
            {{.name = "vertex",
              .plural = "vertices",
              .type = HE_PARAM_ELEMENTS,
              .kind = HE_VERTEX,
              .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
              .group = 'w',
              .doc = "The vertices to merge. The lowest id stays."},
             {.name = "tolerance",
              .type = HE_PARAM_NUMBER,
              .flags = HE_REQUIRED | HE_COSTS_MESH,
              .group = 'w',
              .doc = "Each vertex is merged into the lowest one within this distance that was not "
                     "itself merged."},
             {.name = "position",
              .type = HE_PARAM_CHOICE,
              .choices = positions,
              .doc =
                  "Where the merged vertex is placed: at the mean, or where the lowest one was."}},
        .results = {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                     "The vertices that others were merged into."},
                    {"moved", HE_RESULT_NUMBER, 0,
                     "How many values of vertices became values of corners, because merged "
                     "vertices had different ones."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_REPEATED_CORNER, HE_NONMANIFOLD_EDGE, HE_ORIENTATION, HE_CLOSED_FAN,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 60,
        .run = run_vertex_weld,
    },
    {
        .name = "vertex_separate",
        .doc = "Split bow-ties: give each fan of faces a vertex of its own, in the same place.",
        .params = {{.name = "vertex",
                    .plural = "vertices",
                    .type = HE_PARAM_ELEMENTS,
                    .kind = HE_VERTEX,
                    .flags = HE_REQUIRED,
                    .doc = "The vertices to split. Vertices that are not bow-ties do not change."}},
        .results = {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                     "The new vertices. `parents` tells which vertex each comes from."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, 0, 0},
        .pace = 40,
        .run = run_vertex_separate,
    },
    {
        .name = "weld",
        .doc = "Merge vertices that are close together, and the edges and faces that then "
               "coincide: vertex_weld for the whole mesh.",
        .size = HE_OP_WHOLE,
        .params = {{.name = "tolerance",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_REQUIRED,
                    .doc = "Each vertex is merged into the lowest one within this distance that "
                           "was not itself merged; 0 merges equal positions."}},
        .results = {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                     "The vertices that others were merged into."},
                    {"moved", HE_RESULT_NUMBER, 0,
                     "How many values of vertices became values of corners, because merged "
                     "vertices had different ones."}},
        .refusals = {HE_BAD_VALUE, HE_REPEATED_CORNER, HE_NONMANIFOLD_EDGE, HE_ORIENTATION,
                     HE_CLOSED_FAN, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 8,
        .run = run_weld,
    },
    {
        .name = "separate_bowties",
        .doc = "Split every bow-tie: give each fan of faces a vertex of its own.",
        .size = HE_OP_WHOLE,
        .results = {{"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                     "The new vertices. `parents` tells which vertex each comes from."}},
        .refusals = {HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, 0, 0},
        .pace = 4,
        .run = run_separate_bowties,
    },
    {
        .name = "delete_isolated",
        .doc = "Delete the vertices that have no edge.",
        .size = HE_OP_WHOLE,
        .refusals = {HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, 0, 0},
        .run = run_delete_isolated,
    },
    {.name = NULL},
};
