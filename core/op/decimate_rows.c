#include "op/rows.h"

#include "algo/decimate.h"

#include <float.h>
#include <math.h>

enum { FACES, RATIO, MAX_ERROR, BOUNDARY_WEIGHT };

static he_status run_decimate(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    double faces = args[FACES].number;
    if (!args[FACES].given) {
        faces = floor(args[RATIO].number * he_mesh_faces(m));
    }
    he_decimate_options options = {.faces = (uint32_t)faces,
                                   .max_error =
                                       args[MAX_ERROR].given ? args[MAX_ERROR].number : INFINITY,
                                   .boundary_weight = args[BOUNDARY_WEIGHT].number};
    he_decimated done;
    he_status status = he_decimate(m, &options, &done, err);
    if (status == HE_OK) {
        he_give(out, 0, (uint32_t)done.stop);
        he_give_number(out, 1, done.error);
    }
    return status;
}

const he_op he_decimate_rows[] = {
    {
        .name = "decimate",
        .doc =
            "Collapse edges of triangles until few are left, those first that change the shape "
            "least; a vertex of more than 256 edges neither goes nor moves, and one of nearly as "
            "many makes each collapse beside it as dear as that many others: a face that goes "
            "takes "
            "1 us on an ordinary surface, up to 5 us in stars of 130 to 256 corners.",
        .size = HE_OP_WHOLE,
        .params = {{.name = "faces",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_REQUIRED | HE_RANGE | HE_WHOLE,
                    .group = 'f',
                    .max = HE_MAX_ROWS,
                    .doc = "Stop when there are no more than so many."},
                   {.name = "ratio",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_REQUIRED | HE_RANGE,
                    .group = 'f',
                    .max = 1,
                    .doc = "The same, of the faces there are."},
                   {.name = "max_error",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_RANGE | HE_DERIVED,
                    .max = DBL_MAX,
                    .doc =
                        "Collapse no edge whose new vertex would lie farther from the planes of "
                        "the faces it stands for: the root of the mean square, by area. No limit "
                        "when not given."},
                   {.name = "boundary_weight",
                    .type = HE_PARAM_NUMBER,
                    .flags = HE_RANGE,
                    .max = HE_BOUNDARY_WEIGHT_MAX,
                    .fallback = HE_BOUNDARY_WEIGHT,
                    .doc = "How much more a boundary or feature edge counts than a face as large "
                           "as the square over it."}},
        .results = {{.name = "stop",
                     .type = HE_RESULT_CHOICE,
                     .choices = he_decimate_stop_names,
                     .doc = "Why it ended: few enough faces, edges left that max_error does not "
                            "allow, or none left that can be collapsed."},
                    {.name = "error",
                     .type = HE_RESULT_NUMBER,
                     .doc = "The largest error of an edge that was collapsed, as max_error means "
                            "it."}},
        .refusals = {HE_NOT_TRIANGLE},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 5,
        .run = run_decimate,
    },
    {.name = NULL},
};
