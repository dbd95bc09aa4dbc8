#include "op/rows.h"

#include "edit/whole/material.h"

enum {
    MATERIAL_SET_NAME,
    MATERIAL_SET_RENAME,
    MATERIAL_SET_REPLACE,
    MATERIAL_SET_BASE_COLOR,
    MATERIAL_SET_METALLIC,
    MATERIAL_SET_ROUGHNESS,
    MATERIAL_SET_EMISSION,
    MATERIAL_SET_TWO_SIDED,
    MATERIAL_SET_FACES
};

static he_status run_material_set(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    const he_material_change change = {
        .rename = args[MATERIAL_SET_RENAME].given ? args[MATERIAL_SET_RENAME].text : NULL,
        .replace = args[MATERIAL_SET_REPLACE].flag,
        .base_color =
            args[MATERIAL_SET_BASE_COLOR].given ? args[MATERIAL_SET_BASE_COLOR].color : NULL,
        .opaque_too = args[MATERIAL_SET_BASE_COLOR].count == 4,
        .metallic = args[MATERIAL_SET_METALLIC].given ? &args[MATERIAL_SET_METALLIC].number : NULL,
        .roughness =
            args[MATERIAL_SET_ROUGHNESS].given ? &args[MATERIAL_SET_ROUGHNESS].number : NULL,
        .emission = args[MATERIAL_SET_EMISSION].given ? args[MATERIAL_SET_EMISSION].color : NULL,
        .two_sided = args[MATERIAL_SET_TWO_SIDED].given ? &args[MATERIAL_SET_TWO_SIDED].flag : NULL,
        .faces = args[MATERIAL_SET_FACES].given ? args[MATERIAL_SET_FACES].ids : NULL,
        .face_count = args[MATERIAL_SET_FACES].count,
    };
    return he_material_set(m, args[MATERIAL_SET_NAME].text, &change, err);
}

enum { MATERIAL_DELETE_NAME, MATERIAL_DELETE_TO };

static he_status run_material_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_material_delete(m, args[MATERIAL_DELETE_NAME].text,
                              args[MATERIAL_DELETE_TO].given ? args[MATERIAL_DELETE_TO].text : NULL,
                              err);
}

const he_op he_material_rows[] = {
    {
        .name = "material_set",
        .doc = "Create a material, or change the one with this name, and assign it to faces.",
        .size = HE_OP_LOCAL,
        .params =
            {[MATERIAL_SET_NAME] = {.name = "name",
                                    .type = HE_PARAM_TEXT,
                                    .flags = HE_REQUIRED,
                                    .doc = "The name of the material, which is created if it does "
                                           "not exist. If the name is \"\", the faces lose their "
                                           "material, and only `faces` may be given."},
             [MATERIAL_SET_RENAME] = {.name = "rename",
                                      .type = HE_PARAM_TEXT,
                                      .flags = HE_COSTS_MESH,
                                      .doc = "A new name for the material."},
             [MATERIAL_SET_REPLACE] =
                 {.name = "replace",
                  .type = HE_PARAM_FLAG,
                  .doc = "Reset the values that are not given to those of a new material."},
             [MATERIAL_SET_BASE_COLOR] =
                 {.name = "base_color",
                  .type = HE_PARAM_COLOR,
                  .flags = HE_OPACITY,
                  .doc = "Linear red, green and blue from 0 to 1, and opacity from 0 to 1. If "
                         "opacity is left out, it does not change."},
             [MATERIAL_SET_METALLIC] = {.name = "metallic",
                                        .type = HE_PARAM_NUMBER,
                                        .flags = HE_RANGE | HE_DERIVED,
                                        .max = 1,
                                        .doc = "From 0 (not a metal) to 1. A new material has 0."},
             [MATERIAL_SET_ROUGHNESS] = {.name = "roughness",
                                         .type = HE_PARAM_NUMBER,
                                         .flags = HE_RANGE | HE_DERIVED,
                                         .max = 1,
                                         .doc = "From 0 (a mirror) to 1. A new material has 1."},
             [MATERIAL_SET_EMISSION] = {.name = "emission",
                                        .type = HE_PARAM_COLOR,
                                        .doc = "The light that the material emits: linear red, "
                                               "green and blue, which may be above 1."},
             [MATERIAL_SET_TWO_SIDED] = {.name = "two_sided",
                                         .type = HE_PARAM_FLAG,
                                         .flags = HE_DERIVED,
                                         .doc = "Whether faces of the material are visible from "
                                                "behind. Default for a new material: false."},
             [MATERIAL_SET_FACES] = {.name = "face",
                                     .plural = "faces",
                                     .type = HE_PARAM_ELEMENTS,
                                     .kind = HE_FACE,
                                     .flags = HE_COSTS_MESH,
                                     .doc = "The faces that get the material. Their attribute "
                                            "`material` names it. Default: none."}},
        .refusals = {HE_BAD_VALUE, HE_LIMIT, HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT,
                     HE_REPEATED_ELEMENT, HE_ATTRIBUTE_CLASH},
        .change = {0, 0, 0},
        .run = run_material_set,
    },
    {
        .name = "material_delete",
        .doc = "Delete a material. Its faces lose it, or get the material `to` instead.",
        .size = HE_OP_LOCAL,
        .params = {[MATERIAL_DELETE_NAME] = {.name = "name",
                                             .type = HE_PARAM_TEXT,
                                             .flags = HE_REQUIRED | HE_COSTS_MESH,
                                             .doc = "The name of the material."},
                   [MATERIAL_DELETE_TO] = {.name = "to",
                                           .type = HE_PARAM_TEXT,
                                           .doc = "The material that the faces of the deleted "
                                                  "material get instead. Default: none."}},
        .refusals = {HE_BAD_VALUE, HE_ATTRIBUTE_CLASH},
        .change = {0, 0, 0},
        .run = run_material_delete,
    },
    {.name = NULL},
};
