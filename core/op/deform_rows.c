#include "op/deform_arguments.h"
#include "op/rows.h"

enum {
    DEFORM_METHOD,
    DEFORM_STEPS,
    DEFORM_VERTICES,
    DEFORM_TO,
    DEFORM_BY,
    DEFORM_MATRIX,
    DEFORM_FIXED
};
enum { DEFORM_OUT_MOVED, DEFORM_OUT_LARGEST, DEFORM_OUT_MEAN, DEFORM_OUT_ENERGY };

static const char *const methods[] = {"arap", "biharmonic", NULL};

void he_deform_arguments(const he_arg *args, he_deform_sets *sets, he_deform_goal *goal,
                         unsigned *steps)
{
    const he_arg *to = &args[DEFORM_TO], *by = &args[DEFORM_BY];
    *sets = (he_deform_sets){.method = (he_deform_method)args[DEFORM_METHOD].choice,
                             .handles = args[DEFORM_VERTICES].ids,
                             .handle_count = args[DEFORM_VERTICES].count,
                             .fixed = args[DEFORM_FIXED].ids,
                             .fixed_count = args[DEFORM_FIXED].count};
    *goal =
        (he_deform_goal){.to = to->given ? to->points : NULL,
                         .by = by->given ? by->points : NULL,
                         .count = to->given ? to->count : by->count,
                         .matrix = args[DEFORM_MATRIX].given ? args[DEFORM_MATRIX].matrix : NULL};
    *steps = (unsigned)args[DEFORM_STEPS].number;
}

static he_status run_deform(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_deform_sets sets;
    he_deform_goal goal;
    unsigned steps;
    he_deformed done;
    he_deform_arguments(args, &sets, &goal, &steps);
    he_status status = he_deform(m, &sets, &goal, steps, &done, err);
    if (status == HE_OK) {
        he_results_set_number(out, DEFORM_OUT_MOVED, done.moved);
        he_results_set_number(out, DEFORM_OUT_LARGEST, done.largest);
        he_results_set_number(out, DEFORM_OUT_MEAN, done.mean);
        he_results_set_number(out, DEFORM_OUT_ENERGY, done.energy);
        if (sets.method != HE_DEFORM_ARAP) {
            he_results_omit(out, DEFORM_OUT_ENERGY);
        }
    }
    return status;
}

/* `pace` is the time of making the system of equations with the usual number of steps. */
static unsigned deform_times(const he_arg *args)
{
    return 1 + (unsigned)args[DEFORM_STEPS].number / (2 * HE_DEFORM_STEPS_USUAL);
}

const he_op he_deform_rows[] = {
    {
        .name = "deform",
        .doc = "Move some vertices, and bend the surface around them so that it follows. Locked "
               "vertices, and those of locked edges and faces, stay in place. Normals that are "
               "stored as attributes stay as they are.",
        .size = HE_OP_WHOLE,
        .params =
            {[DEFORM_METHOD] = {.name = "method",
                                .type = HE_PARAM_CHOICE,
                                .flags = HE_SELECTS,
                                .fallback = HE_DEFORM_ARAP,
                                .choices = methods,
                                .doc = "arap: as rigid as possible, so parts turn and details keep "
                                       "their shape. biharmonic: smooth and quick; details do not "
                                       "turn, and a vertex may have at most 4096 neighbours."},
             [DEFORM_STEPS] = {.name = "steps",
                               .type = HE_PARAM_NUMBER,
                               .flags = HE_RANGE | HE_WHOLE,
                               .with = HE_WITH(HE_DEFORM_ARAP),
                               .min = 1,
                               .max = HE_DEFORM_STEPS,
                               .fallback = HE_DEFORM_STEPS_USUAL,
                               .doc = "How often the rotations and positions are improved."},
             [DEFORM_VERTICES] = {.name = "vertex",
                                  .plural = "vertices",
                                  .type = HE_PARAM_ELEMENTS,
                                  .kind = HE_VERTEX,
                                  .flags = HE_REQUIRED | HE_MAY_BE_EMPTY,
                                  .doc = "The vertices that move, called handles. The vertices "
                                         "that are connected with them follow."},
             [DEFORM_TO] = {.name = "to",
                            .type = HE_PARAM_POINTS,
                            .flags = HE_REQUIRED,
                            .group = 'g',
                            .doc = "The new position of the handles: one point for all, or a list "
                                   "with one point for each."},
             [DEFORM_BY] = {.name = "by",
                            .type = HE_PARAM_POINTS,
                            .flags = HE_REQUIRED,
                            .group = 'g',
                            .doc = "The vector to move the handles by: one vector for all, or a "
                                   "list with one vector for each."},
             [DEFORM_MATRIX] = {.name = "matrix",
                                .type = HE_PARAM_MATRIX,
                                .flags = HE_REQUIRED,
                                .group = 'g',
                                .doc = "The affine map of the handles: 16 numbers in row-major "
                                       "order; the last row is 0 0 0 1."},
             [DEFORM_FIXED] = {.name = "fixed_vertex",
                               .plural = "fixed",
                               .type = HE_PARAM_ELEMENTS,
                               .kind = HE_VERTEX,
                               .flags = HE_MAY_BE_EMPTY,
                               .doc = "The vertices that stay in place. What lies behind them "
                                      "stays, too. Default: none."}},
        .results = {[DEFORM_OUT_MOVED] = {"moved", HE_RESULT_NUMBER, HE_VERTEX,
                                          "How many vertices moved."},
                    [DEFORM_OUT_LARGEST] = {"largest", HE_RESULT_NUMBER, HE_VERTEX,
                                            "The largest distance that a vertex moved."},
                    [DEFORM_OUT_MEAN] = {"mean", HE_RESULT_NUMBER, HE_VERTEX,
                                         "The mean distance of the vertices that moved."},
                    [DEFORM_OUT_ENERGY] = {"energy", HE_RESULT_NUMBER, HE_VERTEX,
                                           "With arap: how much the surface is bent and stretched, "
                                           "in square units of the mesh."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_NOT_FINITE, HE_LOCKED_ELEMENT, HE_LIMIT},
        .change = {0, 0, 0},
        .pace = 30,
        .times = deform_times,
        .run = run_deform,
    },
    {.name = NULL},
};
