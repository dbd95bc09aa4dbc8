#include "op/rows.h"

#include "edit/local/erase.h"
#include "edit/merge/weld.h"
#include "edit/whole/separate.h"

static const char *const positions[] = {"mean", "lowest", NULL};

/* Merges the vertices that the client names into one of them. Adds that vertex to `kept`, unless
 * the client names no other vertex. */
static he_status weld_named(he_mesh *m, const he_arg *named, he_merge_place place, he_ids *kept,
                            uint64_t *moved, he_error *err)
{
    he_vertex into;
    he_status status = he_ids_reserve(kept, 1, err);
    if (status == HE_OK) {
        status = he_vertex_weld(m, named->ids, named->count, place, &into, moved, err);
    }
    if (status == HE_OK && named->count > 1) {
        kept->ids[kept->count++] = into.i;
    }
    return status;
}

enum { VERTEX_WELD_VERTICES, VERTEX_WELD_TOLERANCE, VERTEX_WELD_POSITION };
enum { VERTEX_WELD_OUT_VERTICES, VERTEX_WELD_OUT_MOVED };

static he_status run_vertex_weld(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_merge_place place = args[VERTEX_WELD_POSITION].choice == 0 ? HE_MERGE_MEAN : HE_MERGE_INTO;
    he_ids *kept = &out->list[VERTEX_WELD_OUT_VERTICES];
    uint64_t moved = 0;
    he_status status =
        args[VERTEX_WELD_VERTICES].given
            ? weld_named(m, &args[VERTEX_WELD_VERTICES], place, kept, &moved, err)
            : he_weld_near(m, args[VERTEX_WELD_TOLERANCE].number, place, kept, &moved, err);
    if (status == HE_OK) {
        he_results_set_number(out, VERTEX_WELD_OUT_MOVED, (double)moved);
    }
    return status;
}

enum { WELD_TOLERANCE };
enum { WELD_OUT_VERTICES, WELD_OUT_MOVED };

static he_status run_weld(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    uint64_t moved = 0;
    he_status status = he_weld_near(m, args[WELD_TOLERANCE].number, HE_MERGE_MEAN,
                                    &out->list[WELD_OUT_VERTICES], &moved, err);
    if (status == HE_OK) {
        he_results_set_number(out, WELD_OUT_MOVED, (double)moved);
    }
    return status;
}

enum { VERTEX_SEPARATE_VERTICES };
enum { VERTEX_SEPARATE_OUT_VERTICES };

static he_status run_vertex_separate(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    return he_vertex_separate(m, args[VERTEX_SEPARATE_VERTICES].ids,
                              args[VERTEX_SEPARATE_VERTICES].count,
                              &out->list[VERTEX_SEPARATE_OUT_VERTICES], err);
}

enum { SEPARATE_BOWTIES_OUT_VERTICES };

static he_status run_separate_bowties(he_mesh *m, const he_arg *args, he_results *out,
                                      he_error *err)
{
    (void)args;
    return he_separate_bowties(m, &out->list[SEPARATE_BOWTIES_OUT_VERTICES], err);
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
        .doc = "Merge vertices, and the boundary edges that then coincide. Faces that have fewer "
               "than three corners left are deleted. If several faces become equal, only the first "
               "is kept.",
        .params = {[VERTEX_WELD_VERTICES] =
                       {.name = "vertex",
                        .plural = "vertices",
                        .type = HE_PARAM_ELEMENTS,
                        .kind = HE_VERTEX,
                        .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                        .group = 'w',
                        .doc = "The vertices to merge. The vertex with the lowest id stays."},
                   [VERTEX_WELD_TOLERANCE] =
                       {.name = "tolerance",
                        .type = HE_PARAM_NUMBER,
                        .flags = HE_REQUIRED | HE_COSTS_MESH,
                        .group = 'w',
                        .doc = "The tolerance. Each vertex is merged into a vertex within this "
                               "distance: the one with the lowest id that was not itself merged."},
                   [VERTEX_WELD_POSITION] =
                       {.name = "position",
                        .type = HE_PARAM_CHOICE,
                        .choices = positions,
                        .doc = "Where the merged vertex is placed: at the mean position, or where "
                               "the vertex with the lowest id was."}},
        .results = {[VERTEX_WELD_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                                  "The vertices that others were merged into."},
                    [VERTEX_WELD_OUT_MOVED] =
                        {"moved", HE_RESULT_NUMBER, 0,
                         "How many attribute values of vertices became values of corners, because "
                         "the merged vertices had different values."}},
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
        .params =
            {[VERTEX_SEPARATE_VERTICES] =
                 {.name = "vertex",
                  .plural = "vertices",
                  .type = HE_PARAM_ELEMENTS,
                  .kind = HE_VERTEX,
                  .flags = HE_REQUIRED,
                  .doc = "The vertices to split. Vertices that are not bow-ties do not change."}},
        .results = {[VERTEX_SEPARATE_OUT_VERTICES] =
                        {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
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
        .params =
            {[WELD_TOLERANCE] = {.name = "tolerance",
                                 .type = HE_PARAM_NUMBER,
                                 .flags = HE_REQUIRED,
                                 .doc = "The tolerance. Each vertex is merged into a vertex within "
                                        "this distance: the one with the lowest id that was not "
                                        "itself merged. 0 merges vertices at equal positions."}},
        .results =
            {[WELD_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                    "The vertices that others were merged into."},
             [WELD_OUT_MOVED] = {"moved", HE_RESULT_NUMBER, 0,
                                 "How many attribute values of vertices became values of corners, "
                                 "because the merged vertices had different values."}},
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
        .results = {[SEPARATE_BOWTIES_OUT_VERTICES] =
                        {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
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
