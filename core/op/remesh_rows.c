#include "op/rows.h"

#include "geometry/scale.h"
#include "remesh/remesh.h"

#include <float.h>
#include <math.h>

enum {
    REMESH_EDGE_LENGTH,
    REMESH_TARGET_FACES,
    REMESH_ERROR,
    REMESH_MIN_LENGTH,
    REMESH_MAX_LENGTH,
    REMESH_STEPS,
    REMESH_CREASE,
    REMESH_KEEP_BOUNDARY,
    REMESH_KEEP_SEAMS,
    REMESH_PROJECT,
    REMESH_FACES
};
enum {
    REMESH_OUT_STOP,
    REMESH_OUT_FACES_BEFORE,
    REMESH_OUT_FACES_AFTER,
    REMESH_OUT_SHORTEST,
    REMESH_OUT_MEAN_LENGTH,
    REMESH_OUT_LONGEST,
    REMESH_OUT_SMALLEST_ANGLE,
    REMESH_OUT_LARGEST_ANGLE,
    REMESH_OUT_REGULAR,
    REMESH_OUT_DISTANCE
};

static he_remesh_options remesh_options(const he_arg *args)
{
    const he_arg *faces = &args[REMESH_FACES];
    return (he_remesh_options){.by = args[REMESH_ERROR].given          ? HE_REMESH_BY_ERROR
                                     : args[REMESH_TARGET_FACES].given ? HE_REMESH_BY_FACES
                                                                       : HE_REMESH_BY_LENGTH,
                               .edge_length = args[REMESH_EDGE_LENGTH].number,
                               .target_faces = (uint32_t)args[REMESH_TARGET_FACES].number,
                               .error = args[REMESH_ERROR].number,
                               .min_length = args[REMESH_MIN_LENGTH].number,
                               .max_length = args[REMESH_MAX_LENGTH].number,
                               .steps = (unsigned)args[REMESH_STEPS].number,
                               .crease = args[REMESH_CREASE].number,
                               .fixed_boundary = args[REMESH_KEEP_BOUNDARY].flag,
                               .keep_seams = args[REMESH_KEEP_SEAMS].flag,
                               .project = args[REMESH_PROJECT].flag,
                               .faces = faces->given ? faces->ids : NULL,
                               .face_count = faces->count};
}

static he_status run_remesh(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    const he_remesh_options options = remesh_options(args);
    he_remeshed done;
    he_status status = he_remesh(m, &options, &done, err);
    if (status == HE_OK) {
        he_results_set(out, REMESH_OUT_STOP, (uint32_t)done.stop);
        he_results_set_number(out, REMESH_OUT_FACES_BEFORE, done.faces_before);
        he_results_set_number(out, REMESH_OUT_FACES_AFTER, done.faces);
        he_results_set_number(out, REMESH_OUT_SHORTEST, done.shortest);
        he_results_set_number(out, REMESH_OUT_MEAN_LENGTH, done.mean);
        he_results_set_number(out, REMESH_OUT_LONGEST, done.longest);
        he_results_set_number(out, REMESH_OUT_SMALLEST_ANGLE, done.smallest_angle);
        he_results_set_number(out, REMESH_OUT_LARGEST_ANGLE, done.largest_angle);
        he_results_set_number(out, REMESH_OUT_REGULAR, done.regular);
        he_results_set_number(out, REMESH_OUT_DISTANCE, done.distance);
    }
    return status;
}

/* `pace` is the time of the usual number of steps, or fewer. */
static unsigned remesh_times(const he_arg *args)
{
    return 1 + (unsigned)args[REMESH_STEPS].number / (2 * HE_REMESH_STEPS_USUAL);
}

/* What will be refused makes no faces. */
static double remesh_growth(const he_mesh *mesh, const he_arg *args)
{
    const he_remesh_options options = remesh_options(args);
    const uint32_t faces = mesh == NULL ? 0 : he_mesh_faces(mesh);
    const bool foreseen = options.by == HE_REMESH_BY_LENGTH  ? options.edge_length > 0
                          : options.by == HE_REMESH_BY_ERROR ? options.error > 0
                                                             : true;
    return faces == 0 || !foreseen ? 1 : fmax(1, he_remesh_foretell(mesh, &options) / faces);
}

const he_op he_remesh_rows[] = {
    {
        .name = "remesh",
        .doc = "Replace triangles by others of even size and shape that cover the same surface. "
               "Boundaries, edges whose bool attribute `feature` is true, creases, seams of "
               "attributes such as uv, and borders of materials keep their shape: vertices move "
               "only along them, and their corners stay. "
               "What is `locked` does not change. A million faces take about 6 s.",
        .size = HE_OP_WHOLE,
        .params =
            {[REMESH_EDGE_LENGTH] = {.name = "edge_length",
                                     .type = HE_PARAM_NUMBER,
                                     .flags = HE_REQUIRED,
                                     .group = 's',
                                     .fallback = 1,
                                     .doc = "The wanted length of edges, above 0. The mean length "
                                            "becomes a little less."},
             [REMESH_TARGET_FACES] = {.name = "target_faces",
                                      .type = HE_PARAM_NUMBER,
                                      .flags = HE_REQUIRED | HE_RANGE | HE_WHOLE,
                                      .group = 's',
                                      .min = 1,
                                      .max = HE_REMESH_FACES,
                                      .doc =
                                          "The wanted number of faces, which is met within a few "
                                          "percent."},
             [REMESH_ERROR] = {.name = "error",
                               .type = HE_PARAM_NUMBER,
                               .flags = HE_REQUIRED,
                               .group = 's',
                               .fallback = 0.01,
                               .doc =
                                   "Edges become shorter where the surface is more curved: about "
                                   "how far the triangles may be from a smooth surface, above "
                                   "0."},
             [REMESH_MIN_LENGTH] =
                 {.name = "min_length",
                  .type = HE_PARAM_NUMBER,
                  .flags = HE_RANGE | HE_DERIVED,
                  .max = DBL_MAX,
                  .doc = "With error: edges need not be shorter than this. Default: the error."},
             [REMESH_MAX_LENGTH] =
                 {.name = "max_length",
                  .type = HE_PARAM_NUMBER,
                  .flags = HE_RANGE | HE_DERIVED,
                  .max = DBL_MAX,
                  .doc = "With error: edges may not be longer than this. Default: a tenth of the "
                         "largest extent of the faces."},
             [REMESH_STEPS] = {.name = "steps",
                               .type = HE_PARAM_NUMBER,
                               .flags = HE_RANGE | HE_WHOLE,
                               .min = 1,
                               .max = HE_REMESH_STEPS,
                               .fallback = HE_REMESH_STEPS_USUAL,
                               .doc = "The largest number of steps; it stops before if a step "
                                      "changes almost nothing."},
             [REMESH_CREASE] = {.name = "crease",
                                .type = HE_PARAM_NUMBER,
                                .flags = HE_RANGE,
                                .min = 0,
                                .max = HE_PI,
                                .fallback = HE_REMESH_CREASE,
                                .unit = HE_RADIANS,
                                .doc = "Edges between faces whose normals differ by more than this "
                                       "angle count as features, and vertices at which a boundary "
                                       "or feature line turns by more stay in place."},
             [REMESH_KEEP_BOUNDARY] = {.name = "keep_boundary",
                                       .type = HE_PARAM_FLAG,
                                       .doc = "Do not change boundary edges at all."},
             [REMESH_KEEP_SEAMS] = {.name = "keep_seams",
                                    .type = HE_PARAM_FLAG,
                                    .fallback = 1,
                                    .doc = "Edges at which an interpolated attribute of corners "
                                           "has different values on both sides, such as the seams "
                                           "of uv, count as features. The attributes normal and "
                                           "tangent have no seams."},
             [REMESH_PROJECT] = {.name = "project",
                                 .type = HE_PARAM_FLAG,
                                 .fallback = 1,
                                 .doc = "Put moved vertices back onto the surface, and at last so "
                                        "far off it that the faces are as near to it as they can "
                                        "be."},
             [REMESH_FACES] = {.name = "face",
                               .plural = "faces",
                               .type = HE_PARAM_ELEMENTS,
                               .kind = HE_FACE,
                               .doc = "The faces to replace. Other faces, with their edges and "
                                      "vertices, do not change. Default: all."}},
        .results =
            {[REMESH_OUT_STOP] = {.name = "stop",
                                  .type = HE_RESULT_CHOICE,
                                  .choices =
                                      he_remesh_stop_names,
                                  .doc = "Why it stopped: the last step changed almost nothing, or "
                                         "all steps were done."},
             [REMESH_OUT_FACES_BEFORE] = {"faces_before", HE_RESULT_NUMBER, HE_FACE,
                                          "How many faces were replaced."},
             [REMESH_OUT_FACES_AFTER] = {"faces_after", HE_RESULT_NUMBER, HE_FACE,
                                         "By how many faces they were replaced. The other results "
                                         "describe these faces."},
             [REMESH_OUT_SHORTEST] = {"shortest", HE_RESULT_NUMBER, HE_EDGE,
                                      "The length of the shortest edge."},
             [REMESH_OUT_MEAN_LENGTH] = {"mean_length", HE_RESULT_NUMBER, HE_EDGE,
                                         "The mean length of the edges."},
             [REMESH_OUT_LONGEST] = {"longest", HE_RESULT_NUMBER, HE_EDGE,
                                     "The length of the longest edge."},
             [REMESH_OUT_SMALLEST_ANGLE] = {"smallest_angle", HE_RESULT_NUMBER, HE_HALFEDGE,
                                            "The smallest angle of a face.", .unit = HE_RADIANS},
             [REMESH_OUT_LARGEST_ANGLE] = {"largest_angle", HE_RESULT_NUMBER, HE_HALFEDGE,
                                           "The largest angle of a face.", .unit = HE_RADIANS},
             [REMESH_OUT_REGULAR] =
                 {"regular", HE_RESULT_NUMBER, HE_VERTEX,
                  "The fraction of the vertices that have six edges, among those "
                  "that are not on lines and may move."},
             [REMESH_OUT_DISTANCE] =
                 {"distance", HE_RESULT_NUMBER, HE_FACE,
                  "No point of the new faces is farther than this from the faces that were "
                  "replaced. Mostly the farthest point is nearly as far."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NOT_TRIANGLE,
                     HE_BAD_VALUE, HE_LIMIT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 25,
        .times = remesh_times,
        .growth = remesh_growth,
        .run = run_remesh,
    },
    {.name = NULL},
};
