#include "op/rows.h"

#include "algo/subdivide.h"

#include <math.h>

enum { SUBDIVIDE_SCHEME, SUBDIVIDE_STEPS };
enum { SUBDIVIDE_OUT_VERTICES, SUBDIVIDE_OUT_EDGES, SUBDIVIDE_OUT_FACES };

static he_status run_subdivide(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_subdivide_counts counts[HE_SUBDIVIDE_STEPS];
    unsigned steps = (unsigned)args[SUBDIVIDE_STEPS].number;
    for (size_t i = SUBDIVIDE_OUT_VERTICES; i <= SUBDIVIDE_OUT_FACES; i++) {
        he_status status = he_results_reserve(out, i, steps, err);
        if (status != HE_OK) {
            return status;
        }
    }
    he_status status =
        he_subdivide(m, (he_scheme)args[SUBDIVIDE_SCHEME].choice, steps, counts, err);
    for (unsigned i = 0; i < steps && status == HE_OK; i++) {
        he_results_add(out, SUBDIVIDE_OUT_VERTICES, counts[i].vertices);
        he_results_add(out, SUBDIVIDE_OUT_EDGES, counts[i].edges);
        he_results_add(out, SUBDIVIDE_OUT_FACES, counts[i].faces);
    }
    return status;
}

/* Returns the factor by which the number of faces grows: each step divides a face into three if the
 * scheme is sqrt3, else into four. */
static double subdivide_growth(const he_mesh *mesh, const he_arg *args)
{
    (void)mesh;
    return pow(args[SUBDIVIDE_SCHEME].choice == HE_SQRT3 ? 3 : 4, args[SUBDIVIDE_STEPS].number);
}

static he_status foresee_subdivide(const he_mesh *m, const he_arg *args, he_error *err)
{
    return he_subdivide_fits(m, (he_scheme)args[SUBDIVIDE_SCHEME].choice,
                             (unsigned)args[SUBDIVIDE_STEPS].number, err);
}

/* The names that requests use for the values of he_scheme, in the order of the enum. */
static const char *const schemes[] = {"loop", "catmull_clark", "linear", "sqrt3", NULL};

const he_op he_refine_rows[] = {
    {
        .name = "subdivide",
        .doc = "Refine the whole mesh by a subdivision scheme: finer faces and, except with "
               "linear, a smoother surface.",
        .size = HE_OP_WHOLE,
        .params =
            {[SUBDIVIDE_SCHEME] =
                 {.name = "scheme",
                  .type = HE_PARAM_CHOICE,
                  .fallback = HE_CATMULL_CLARK,
                  .choices = schemes,
                  .doc = "loop: each triangle becomes 4. catmull_clark: each face becomes quads. "
                         "linear: each triangle becomes 4, each other face becomes quads, and no "
                         "vertex moves. sqrt3: each triangle becomes 3. Boundaries, and edges "
                         "whose bool attribute `feature` is true, are smoothed as curves; "
                         "vertices whose `locked` is true do not move."},
             [SUBDIVIDE_STEPS] = {.name = "steps",
                                  .type = HE_PARAM_NUMBER,
                                  .flags = HE_RANGE | HE_WHOLE,
                                  .min = 1,
                                  .max = HE_SUBDIVIDE_STEPS,
                                  .fallback = 1,
                                  .doc = "How often to subdivide."}},
        .results = {[SUBDIVIDE_OUT_VERTICES] = {"vertices", HE_RESULT_COUNTS, HE_VERTEX,
                                                "The number of vertices after each step."},
                    [SUBDIVIDE_OUT_EDGES] = {"edges", HE_RESULT_COUNTS, HE_EDGE,
                                             "The number of edges after each step."},
                    [SUBDIVIDE_OUT_FACES] = {"faces", HE_RESULT_COUNTS, HE_FACE,
                                             "The number of faces after each step."}},
        .refusals = {HE_LIMIT, HE_NOT_TRIANGLE, HE_DOUBLED_EDGE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .growth = subdivide_growth,
        .foresee = foresee_subdivide,
        .run = run_subdivide,
    },
    {.name = NULL},
};
