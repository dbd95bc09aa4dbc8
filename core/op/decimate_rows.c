#include "op/rows.h"

#include "algo/decimate.h"

#include <float.h>
#include <math.h>

enum { DECIMATE_FACES, DECIMATE_RATIO, DECIMATE_MAX_ERROR, DECIMATE_BOUNDARY_WEIGHT };
enum { DECIMATE_OUT_STOP, DECIMATE_OUT_ERROR };

static he_status run_decimate(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    double faces = args[DECIMATE_FACES].number;
    if (!args[DECIMATE_FACES].given) {
        faces = floor(args[DECIMATE_RATIO].number * he_mesh_faces(m));
    }
    he_decimate_options options = {
        .faces = (uint32_t)faces,
        .max_error = args[DECIMATE_MAX_ERROR].given ? args[DECIMATE_MAX_ERROR].number : INFINITY,
        .boundary_weight = args[DECIMATE_BOUNDARY_WEIGHT].number};
    he_decimated done;
    he_status status = he_decimate(m, &options, &done, err);
    if (status == HE_OK) {
        he_results_set(out, DECIMATE_OUT_STOP, (uint32_t)done.stop);
        he_results_set_number(out, DECIMATE_OUT_ERROR, done.error);
    }
    return status;
}

const he_op he_decimate_rows[] = {
    {
        .name = "decimate",
        .doc = "Simplify a mesh of triangles by collapsing the edges that change the shape least. "
               "A vertex with more than 256 edges is neither removed nor moved. Each removed face "
               "takes about 1 us, and up to 5 us near vertices with 130 to 256 edges.",
        .size = HE_OP_WHOLE,
        .params = {[DECIMATE_FACES] = {.name = "faces",
                                       .type = HE_PARAM_NUMBER,
                                       .flags = HE_REQUIRED | HE_RANGE | HE_WHOLE,
                                       .group = 'f',
                                       .max = HE_MAX_ROWS,
                                       .doc = "Target number of faces."},
                   [DECIMATE_RATIO] = {.name = "ratio",
                                       .type = HE_PARAM_NUMBER,
                                       .flags = HE_REQUIRED | HE_RANGE,
                                       .group = 'f',
                                       .max = 1,
                                       .doc =
                                           "Target as a fraction of the present number of faces."},
                   [DECIMATE_MAX_ERROR] =
                       {.name = "max_error",
                        .type = HE_PARAM_NUMBER,
                        .flags = HE_RANGE | HE_DERIVED,
                        .max = DBL_MAX,
                        .doc =
                            "Do not collapse an edge if the new vertex would be farther than this "
                            "from the planes of the original faces (root mean square, weighted by "
                            "area). Default: no limit."},
                   [DECIMATE_BOUNDARY_WEIGHT] =
                       {.name = "boundary_weight",
                        .type = HE_PARAM_NUMBER,
                        .flags = HE_RANGE,
                        .max = HE_BOUNDARY_WEIGHT_MAX,
                        .fallback = HE_BOUNDARY_WEIGHT,
                        .doc = "Weight of boundary and feature edges relative to faces."}},
        .results = {[DECIMATE_OUT_STOP] =
                        {.name = "stop",
                         .type = HE_RESULT_CHOICE,
                         .choices = he_decimate_stop_names,
                         .doc =
                             "Why it stopped: the target was reached, max_error allows no more, or "
                             "no edge can be collapsed any more."},
                    [DECIMATE_OUT_ERROR] =
                        {.name = "error",
                         .type = HE_RESULT_NUMBER,
                         .doc =
                             "The largest error of a collapsed edge, measured as for max_error."}},
        .refusals = {HE_NOT_TRIANGLE},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 5,
        .run = run_decimate,
    },
    {.name = NULL},
};
