#include "op/rows.h"

#include "edit/local/face_collapse.h"
#include "edit/region/extrude.h"
#include "edit/region/inset.h"

enum { FACE_EXTRUDE_FACES, FACE_EXTRUDE_BY, FACE_EXTRUDE_DISTANCE, FACE_EXTRUDE_REGION };
enum { FACE_EXTRUDE_OUT_VERTICES, FACE_EXTRUDE_OUT_EDGES, FACE_EXTRUDE_OUT_FACES };

static he_status run_face_extrude(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_region_parts parts;
    const he_vec3 *by = args[FACE_EXTRUDE_BY].given ? args[FACE_EXTRUDE_BY].points : NULL;
    he_status status =
        he_face_extrude(m, args[FACE_EXTRUDE_FACES].ids, args[FACE_EXTRUDE_FACES].count,
                        args[FACE_EXTRUDE_REGION].flag,
                        (he_extrude_motion){by, args[FACE_EXTRUDE_DISTANCE].number}, &parts, err);
    if (status == HE_OK) {
        he_results_set_list(out, FACE_EXTRUDE_OUT_VERTICES, &parts.vertices);
        he_results_set_list(out, FACE_EXTRUDE_OUT_EDGES, &parts.edges);
        he_results_set_list(out, FACE_EXTRUDE_OUT_FACES, &parts.faces);
        he_region_parts_clear(&parts);
    }
    return status;
}

enum { FACE_INSET_FACES, FACE_INSET_FACTOR, FACE_INSET_DISTANCE, FACE_INSET_REGION };
enum { FACE_INSET_OUT_VERTICES, FACE_INSET_OUT_EDGES, FACE_INSET_OUT_FACES };

static he_status run_face_inset(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_region_parts parts;
    double factor = args[FACE_INSET_FACTOR].given ? args[FACE_INSET_FACTOR].number : 0;
    he_status status = he_face_inset(
        m, args[FACE_INSET_FACES].ids, args[FACE_INSET_FACES].count, args[FACE_INSET_REGION].flag,
        (he_inset_width){factor, args[FACE_INSET_DISTANCE].number}, &parts, err);
    if (status == HE_OK) {
        he_results_set_list(out, FACE_INSET_OUT_VERTICES, &parts.vertices);
        he_results_set_list(out, FACE_INSET_OUT_EDGES, &parts.edges);
        he_results_set_list(out, FACE_INSET_OUT_FACES, &parts.faces);
        he_region_parts_clear(&parts);
    }
    return status;
}

enum { FACE_COLLAPSE_FACE };
enum { FACE_COLLAPSE_OUT_VERTEX };

static he_status run_face_collapse(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    he_vertex v;
    he_status status = he_face_collapse(m, (he_face){args[FACE_COLLAPSE_FACE].id}, &v, err);
    if (status == HE_OK) {
        he_results_set(out, FACE_COLLAPSE_OUT_VERTEX, v.i);
    }
    return status;
}

const he_op he_region_rows[] = {
    {
        .name = "face_extrude",
        .doc = "Move faces outward and join them to the surrounding surface by side faces.",
        .params =
            {[FACE_EXTRUDE_FACES] = {.name = "face",
                                     .plural = "faces",
                                     .type = HE_PARAM_ELEMENTS,
                                     .kind = HE_FACE,
                                     .flags = HE_REQUIRED | HE_REACHES,
                                     .doc = "The faces to move. They keep their ids."},
             [FACE_EXTRUDE_BY] = {.name = "by",
                                  .type = HE_PARAM_POINT,
                                  .flags = HE_REQUIRED,
                                  .group = 'b',
                                  .doc = "The vector by which the faces move."},
             [FACE_EXTRUDE_DISTANCE] =
                 {.name = "distance",
                  .type = HE_PARAM_NUMBER,
                  .flags = HE_REQUIRED,
                  .group = 'b',
                  .doc = "How far to move along the normal; negative values move inward."},
             [FACE_EXTRUDE_REGION] =
                 {.name = "region",
                  .type = HE_PARAM_FLAG,
                  .doc =
                      "Faces that share an edge move together, without side faces between them."}},
        .results = {[FACE_EXTRUDE_OUT_VERTICES] =
                        {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                         "The new vertices, one for each corner of the outline."},
                    [FACE_EXTRUDE_OUT_EDGES] =
                        {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                         "Two edges for each new vertex: an edge of the moved outline, and the "
                         "edge from the old vertex to the new one."},
                    [FACE_EXTRUDE_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                                "The side faces."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_NO_RIM,
                     HE_RIM_MEETS_ITSELF, HE_NO_NORMAL, HE_NOT_FINITE, HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 200,
        .run = run_face_extrude,
    },
    {
        .name = "face_inset",
        .doc = "Shrink faces within their outline. New faces form a border around them.",
        .params =
            {[FACE_INSET_FACES] = {.name = "face",
                                   .plural = "faces",
                                   .type = HE_PARAM_ELEMENTS,
                                   .kind = HE_FACE,
                                   .flags = HE_REQUIRED | HE_REACHES,
                                   .doc = "The faces to shrink. The shrunk faces keep their ids."},
             [FACE_INSET_FACTOR] =
                 {.name = "factor",
                  .type = HE_PARAM_NUMBER,
                  .flags = HE_REQUIRED | HE_RANGE | HE_EXCLUSIVE,
                  .group = 'b',
                  .min = 0,
                  .max = 1,
                  .fallback = 0.5,
                  .doc = "How far the corners move towards the centres of their faces: from 0 "
                         "(not at all) to 1 (all the way)."},
             [FACE_INSET_DISTANCE] = {.name = "distance",
                                      .type = HE_PARAM_NUMBER,
                                      .flags = HE_REQUIRED,
                                      .group = 'b',
                                      .doc = "The width of the border of new faces, above 0. The "
                                             "border is narrower where it would intersect itself."},
             [FACE_INSET_REGION] =
                 {.name = "region",
                  .type = HE_PARAM_FLAG,
                  .doc = "Faces that share an edge shrink together, with one border."}},
        .results =
            {[FACE_INSET_OUT_VERTICES] = {"vertices", HE_RESULT_ELEMENTS, HE_VERTEX,
                                          "The new vertices, one for each corner of the outline."},
             [FACE_INSET_OUT_EDGES] = {"edges", HE_RESULT_ELEMENTS, HE_EDGE,
                                       "Two edges for each new vertex: an edge of the inner part, "
                                       "and the edge across the border."},
             [FACE_INSET_OUT_FACES] = {"faces", HE_RESULT_ELEMENTS, HE_FACE,
                                       "The new faces of the border."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT, HE_BAD_VALUE,
                     HE_NO_RIM, HE_RIM_MEETS_ITSELF, HE_NO_NORMAL, HE_LIMIT, HE_NOT_FINITE,
                     HE_LOCKED_ELEMENT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .pace = 200,
        .run = run_face_inset,
    },
    {
        .name = "face_collapse",
        .doc = "Collapse a face to one vertex at the mean of its corners.",
        .params = {[FACE_COLLAPSE_FACE] = {.name = "face",
                                           .each = "faces",
                                           .type = HE_PARAM_ELEMENT,
                                           .kind = HE_FACE,
                                           .flags = HE_REQUIRED | HE_REACHES | HE_WALKS,
                                           .doc = "The face to collapse. The corner at the origin "
                                                  "of its stored half-edge stays."}},
        .results = {[FACE_COLLAPSE_OUT_VERTEX] = {"vertex", HE_RESULT_ELEMENT, HE_VERTEX,
                                                  "The vertex that stays."}},
        .refusals = {HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_LINK_CONDITION, HE_FEATURE_EDGE,
                     HE_LOCKED_ELEMENT, HE_LIMIT},
        .change = {HE_VARIES, HE_VARIES, HE_VARIES},
        .run = run_face_collapse,
    },
    {.name = NULL},
};
