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
        .doc = "Make a material, or change the one of this name, and give it to faces.",
        .size = HE_OP_LOCAL,
        .params = {[NAME] = {.name = "name",
                             .type = HE_PARAM_TEXT,
                             .flags = HE_REQUIRED,
                             .doc =
                                 "The material; one of this name is made where there is none. "
                                 "With \"\" the faces have none, and nothing else may be given."},
                   [RENAME] = {.name = "rename",
                               .type = HE_PARAM_TEXT,
                               .flags = HE_COSTS_MESH,
                               .doc = "A new name for it, on faces too."},
                   [REPLACE] = {.name = "replace",
                                .type = HE_PARAM_FLAG,
                                .doc = "Begin with what a new one looks like, instead of what this "
                                       "one was."},
                   [BASE_COLOR] = {.name = "base_color",
                                   .type = HE_PARAM_COLOR,
                                   .flags = HE_OPACITY,
                                   .doc =
                                       "Linear red, green and blue from 0 to 1, and the opacity, "
                                       "which stays when not given."},
                   [METALLIC] = {.name = "metallic",
                                 .type = HE_PARAM_NUMBER,
                                 .flags = HE_RANGE | HE_DERIVED,
                                 .max = 1,
                                 .doc = "From 0 (not a metal) to 1; 0 when it is new."},
                   [ROUGHNESS] = {.name = "roughness",
                                  .type = HE_PARAM_NUMBER,
                                  .flags = HE_RANGE | HE_DERIVED,
                                  .max = 1,
                                  .doc = "From 0 (a mirror) to 1; 1 when it is new."},
                   [EMISSION] = {.name = "emission",
                                 .type = HE_PARAM_COLOR,
                                 .doc = "The light it gives off: linear red, green and blue, which "
                                        "may be above 1."},
                   [TWO_SIDED] = {.name = "two_sided",
                                  .type = HE_PARAM_FLAG,
                                  .flags = HE_DERIVED,
                                  .doc = "Do its faces show from behind? Not when it is new."},
                   [FACES] = {.name = "face",
                              .plural = "faces",
                              .type = HE_PARAM_ELEMENTS,
                              .kind = HE_FACE,
                              .flags = HE_COSTS_MESH,
                              .doc = "What gets it, in the attribute `material`; none when not "
                                     "given."}},
        .refusals = {HE_BAD_VALUE, HE_LIMIT, HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT,
                     HE_REPEATED_ELEMENT, HE_ATTRIBUTE_CLASH},
        .change = {0, 0, 0},
        .run = run_material_set,
    },
    {
        .name = "material_delete",
        .doc = "Delete a material. Faces that had it have none, or another one.",
        .size = HE_OP_LOCAL,
        .params = {[DELETED] = {.name = "name",
                                .type = HE_PARAM_TEXT,
                                .flags = HE_REQUIRED | HE_COSTS_MESH,
                                .doc = "The material."},
                   [TO] = {.name = "to",
                           .type = HE_PARAM_TEXT,
                           .doc = "The material that faces have instead; none when not given."}},
        .refusals = {HE_BAD_VALUE, HE_ATTRIBUTE_CLASH},
        .change = {0, 0, 0},
        .run = run_material_delete,
    },
    {.name = NULL},
};
