#include "op/rows.h"

#include "edit/whole/material.h"

enum { NAME, RENAME, REPLACE, BASE_COLOR, METALLIC, ROUGHNESS, EMISSION, TWO_SIDED, FACES };

static he_status run_material_set(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    const he_material_change change = {
        .rename = args[RENAME].given ? args[RENAME].text : NULL,
        .replace = args[REPLACE].flag,
        .base_color = args[BASE_COLOR].given ? args[BASE_COLOR].color : NULL,
        .opaque_too = args[BASE_COLOR].count == 4,
        .metallic = args[METALLIC].given ? &args[METALLIC].number : NULL,
        .roughness = args[ROUGHNESS].given ? &args[ROUGHNESS].number : NULL,
        .emission = args[EMISSION].given ? args[EMISSION].color : NULL,
        .two_sided = args[TWO_SIDED].given ? &args[TWO_SIDED].flag : NULL,
        .faces = args[FACES].given ? args[FACES].ids : NULL,
        .face_count = args[FACES].count,
    };
    return he_material_set(m, args[NAME].text, &change, err);
}

enum { DELETED, TO };

static he_status run_material_delete(he_mesh *m, const he_arg *args, he_results *out, he_error *err)
{
    (void)out;
    return he_material_delete(m, args[DELETED].text, args[TO].given ? args[TO].text : NULL, err);
}

const he_op he_material_rows[] = {
    {
        .name = "material_set",
        .doc = "Create a material, or change the one with this name, and assign it to faces.",
        .size = HE_OP_LOCAL,
        .params =
            {[NAME] = {.name = "name",
                       .type = HE_PARAM_TEXT,
                       .flags = HE_REQUIRED,
                       .doc = "The name of the material, which is created if there is none. With "
                              "\"\" the faces have no material, and nothing else may be given."},
             [RENAME] = {.name = "rename",
                         .type = HE_PARAM_TEXT,
                         .flags = HE_COSTS_MESH,
                         .doc = "A new name for the material."},
             [REPLACE] = {.name = "replace",
                          .type = HE_PARAM_FLAG,
                          .doc = "Reset the values that are not given to those of a new material."},
             [BASE_COLOR] = {.name = "base_color",
                             .type = HE_PARAM_COLOR,
                             .flags = HE_OPACITY,
                             .doc = "Linear red, green and blue from 0 to 1, and opacity, which "
                                    "may be left out to keep it."},
             [METALLIC] = {.name = "metallic",
                           .type = HE_PARAM_NUMBER,
                           .flags = HE_RANGE | HE_DERIVED,
                           .max = 1,
                           .doc = "From 0 (not a metal) to 1. A new material has 0."},
             [ROUGHNESS] = {.name = "roughness",
                            .type = HE_PARAM_NUMBER,
                            .flags = HE_RANGE | HE_DERIVED,
                            .max = 1,
                            .doc = "From 0 (a mirror) to 1. A new material has 1."},
             [EMISSION] =
                 {.name = "emission",
                  .type = HE_PARAM_COLOR,
                  .doc =
                      "The light that it emits: linear red, green and blue, which may be above 1."},
             [TWO_SIDED] =
                 {.name = "two_sided",
                  .type = HE_PARAM_FLAG,
                  .flags = HE_DERIVED,
                  .doc = "Are its faces visible from behind? Those of a new material are not."},
             [FACES] = {.name = "face",
                        .plural = "faces",
                        .type = HE_PARAM_ELEMENTS,
                        .kind = HE_FACE,
                        .flags = HE_COSTS_MESH,
                        .doc = "The faces that get the material, in the attribute `material`. "
                               "Default: none."}},
        .refusals = {HE_BAD_VALUE, HE_LIMIT, HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT,
                     HE_REPEATED_ELEMENT, HE_ATTRIBUTE_CLASH},
        .change = {0, 0, 0},
        .run = run_material_set,
    },
    {
        .name = "material_delete",
        .doc = "Delete a material. Faces that had it have no material, or another one.",
        .size = HE_OP_LOCAL,
        .params = {[DELETED] = {.name = "name",
                                .type = HE_PARAM_TEXT,
                                .flags = HE_REQUIRED | HE_COSTS_MESH,
                                .doc = "The name of the material."},
                   [TO] = {.name = "to",
                           .type = HE_PARAM_TEXT,
                           .doc = "The material that these faces get instead. Default: none."}},
        .refusals = {HE_BAD_VALUE, HE_ATTRIBUTE_CLASH},
        .change = {0, 0, 0},
        .run = run_material_delete,
    },
    {.name = NULL},
};
