#include "op/rows.h"

#include "smooth/smooth.h"

enum { SMOOTH_METHOD, SMOOTH_STEPS, SMOOTH_TIME, SMOOTH_KEEP_VOLUME, SMOOTH_VERTICES };
enum { SMOOTH_OUT_MOVED, SMOOTH_OUT_LARGEST, SMOOTH_OUT_MEAN, SMOOTH_OUT_VOLUME };

static const char *const methods[] = {"laplacian", "taubin", "bilateral", "tangential", NULL};

static he_status run_smooth(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    const he_arg *vertices = &args[SMOOTH_VERTICES], *time = &args[SMOOTH_TIME];
    if (time->given && !(time->number > 0)) {
        return he_fail_plain(err, HE_BAD_VALUE, "the time of a step must be above 0, not %g",
                             time->number);
    }
    const he_smooth_options options = {.method = (he_smooth_method)args[SMOOTH_METHOD].choice,
                                       .steps = (unsigned)args[SMOOTH_STEPS].number,
                                       .time = time->given ? time->number : 0,
                                       .keep_volume = args[SMOOTH_KEEP_VOLUME].flag,
                                       .vertices = vertices->given ? vertices->ids : NULL,
                                       .vertex_count = vertices->count};
    he_smoothed done;
    he_status status = he_smooth(m, &options, &done, err);
    if (status == HE_OK) {
        he_results_set_number(out, SMOOTH_OUT_MOVED, done.moved);
        he_results_set_number(out, SMOOTH_OUT_LARGEST, done.largest);
        he_results_set_number(out, SMOOTH_OUT_MEAN, done.mean);
        he_results_set_number(out, SMOOTH_OUT_VOLUME, done.volume);
    }
    return status;
}

/* `pace` is the time of one step. */
static unsigned smooth_times(const he_arg *args)
{
    return (unsigned)args[SMOOTH_STEPS].number;
}

const he_op he_smooth_rows[] = {
    {
        .name = "smooth",
        .doc = "Move vertices so that the surface becomes smoother. Vertices of boundaries, of "
               "edges whose bool attribute `feature` is true and of what is `locked` stay in "
               "place. Normals that are stored as attributes stay as they are.",
        .size = HE_OP_WHOLE,
        .params =
            {[SMOOTH_METHOD] =
                 {.name = "method",
                  .type = HE_PARAM_CHOICE,
                  .flags = HE_SELECTS,
                  .fallback = HE_SMOOTH_LAPLACIAN,
                  .choices = methods,
                  .doc = "laplacian: even out bumps up to a size that `time` chooses; the surface "
                         "shrinks a little. taubin: even out small bumps, and hardly shrink; takes "
                         "any faces, the other methods only triangles. bilateral: remove noise and "
                         "keep sharp edges. tangential: make triangles more even, and keep the "
                         "shape."},
             [SMOOTH_STEPS] = {.name = "steps",
                               .type = HE_PARAM_NUMBER,
                               .flags = HE_RANGE | HE_WHOLE,
                               .min = 1,
                               .max = HE_SMOOTH_STEPS,
                               .fallback = HE_SMOOTH_STEPS_USUAL,
                               .doc = "How often it is done."},
             [SMOOTH_TIME] = {.name = "time",
                              .type = HE_PARAM_NUMBER,
                              .flags = HE_DERIVED,
                              .with = HE_WITH(HE_SMOOTH_LAPLACIAN),
                              .doc = "Above 0: the time of one step of the flow, in "
                                     "square units of the mesh. Default: a tenth of the square of "
                                     "the mean length of the edges."},
             [SMOOTH_KEEP_VOLUME] = {.name = "keep_volume",
                                     .type = HE_PARAM_FLAG,
                                     .doc = "Then move the vertices along the normals until the "
                                            "volume is that from before. The surface must be "
                                            "closed."},
             [SMOOTH_VERTICES] = {.name = "vertex",
                                  .plural = "vertices",
                                  .type = HE_PARAM_ELEMENTS,
                                  .kind = HE_VERTEX,
                                  .doc = "The vertices that may move. Default: all."}},
        .results = {[SMOOTH_OUT_MOVED] = {"moved", HE_RESULT_NUMBER, HE_VERTEX,
                                          "How many vertices moved."},
                    [SMOOTH_OUT_LARGEST] = {"largest", HE_RESULT_NUMBER, HE_VERTEX,
                                            "The largest distance that a vertex moved."},
                    [SMOOTH_OUT_MEAN] = {"mean", HE_RESULT_NUMBER, HE_VERTEX,
                                         "The mean distance of the vertices that moved."},
                    [SMOOTH_OUT_VOLUME] = {"volume", HE_RESULT_NUMBER, HE_FACE,
                                           "By how much the volume grew; 0 if the surface has a "
                                           "boundary."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_TRIANGLE,
                     HE_BOUNDARY_EDGE, HE_BAD_VALUE, HE_NOT_FINITE},
        .change = {0, 0, 0},
        .pace = 30,
        .times = smooth_times,
        .run = run_smooth,
    },
    {.name = NULL},
};
