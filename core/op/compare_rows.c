#include "op/rows.h"

#include "compare/deviation.h"

enum { DEVIATION_WITH, DEVIATION_ATTRIBUTE };
enum {
    DEVIATION_OUT_LEAST,
    DEVIATION_OUT_LARGEST,
    DEVIATION_OUT_MEAN,
    DEVIATION_OUT_RMS,
    DEVIATION_OUT_FARTHEST
};

static he_status run_deviation(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    const char *attribute =
        args[DEVIATION_ATTRIBUTE].given ? args[DEVIATION_ATTRIBUTE].text : "deviation";
    he_deviated done;
    he_status status = he_deviation(m, args[DEVIATION_WITH].mesh, attribute, &done, err);
    if (status == HE_OK) {
        he_results_set_number(out, DEVIATION_OUT_LEAST, done.least);
        he_results_set_number(out, DEVIATION_OUT_LARGEST, done.largest);
        he_results_set_number(out, DEVIATION_OUT_MEAN, done.mean);
        he_results_set_number(out, DEVIATION_OUT_RMS, done.rms);
        he_results_set(out, DEVIATION_OUT_FARTHEST, done.farthest_vertex);
    }
    return status;
}

const he_op he_compare_rows[] = {
    {
        .name = "deviation",
        .doc =
            "Write into an attribute how far each vertex is from the surface of another mesh; "
            "the distance is below 0 on the inner side of that surface. Nothing moves. `weld` the "
            "other mesh first if it has open seams: beside them signs may be wrong.",
        .size = HE_OP_WHOLE,
        .params =
            {[DEVIATION_WITH] = {.name = "with",
                                 .type = HE_PARAM_MESH,
                                 .flags = HE_REQUIRED,
                                 .doc = "The id of the other mesh, as it was when the request "
                                        "began, or the number of an earlier revision of this "
                                        "mesh. POST .../compare gives exact bounds of the "
                                        "largest distance."},
             [DEVIATION_ATTRIBUTE] =
                 {.name = "attribute",
                  .type = HE_PARAM_TEXT,
                  .doc = "The attribute of vertices that gets the distances: a float or double. It "
                         "is created as a float if it does not exist. Default: `deviation`."}},
        .results =
            {[DEVIATION_OUT_LEAST] = {"least", HE_RESULT_NUMBER, HE_VERTEX,
                                      "The least signed distance, or 0 without vertices."},
             [DEVIATION_OUT_LARGEST] = {"largest", HE_RESULT_NUMBER, HE_VERTEX,
                                        "The largest signed distance, or 0 without vertices."},
             [DEVIATION_OUT_MEAN] = {"mean", HE_RESULT_NUMBER, HE_VERTEX,
                                     "The mean of the signed distances of all vertices."},
             [DEVIATION_OUT_RMS] = {"rms", HE_RESULT_NUMBER, HE_VERTEX,
                                    "The root mean square of the distances of all vertices."},
             [DEVIATION_OUT_FARTHEST] = {"farthest", HE_RESULT_ELEMENT, HE_VERTEX,
                                         "The vertex that is farthest from the other surface."}},
        .refusals = {HE_NO_FACES, HE_BAD_VALUE, HE_ATTRIBUTE_CLASH, HE_LIMIT},
        .change = {0, 0, 0},
        .pace = 20,
        .run = run_deviation,
    },
    {.name = NULL},
};
