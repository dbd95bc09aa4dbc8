#include "api/json/material_value.h"

#include <string.h>

static void write_numbers(api_out *out, const double *numbers, size_t count)
{
    api_out_array_begin(out);
    for (size_t i = 0; i < count; i++) {
        api_out_number(out, numbers[i]);
    }
    api_out_array_end(out);
}

static void write_color(api_out *out, const void *color)
{
    write_numbers(out, color, 3);
}

static void write_color_alpha(api_out *out, const void *color)
{
    write_numbers(out, color, 4);
}

static const api_field material_fields[] = {
    API_FIELD("name", "#material_name", he_material, name, .required = true,
              .doc = "The name of the material, which differs from the names of other materials."),
    API_FIELD_MADE_OF("base_color", "#color_alpha", he_material, look.base_color, write_color_alpha,
                      .required = true, .doc = "Colour and opacity."),
    API_FIELD("metallic", "#fraction", he_material, look.metallic, .required = true),
    API_FIELD("roughness", "#fraction", he_material, look.roughness, .required = true),
    API_FIELD_MADE_OF("emission", "#color", he_material, look.emission, write_color,
                      .required = true),
    API_FIELD("two_sided", "flag", he_material, look.two_sided, .required = true),
};
const api_record api_material_record = API_RECORD("material_row", material_fields);

void api_write_materials(api_out *out, const he_materials *materials)
{
    api_out_array_begin(out);
    for (size_t i = 0; i < materials->count; i++) {
        if (materials->rows[i] != NULL) {
            api_record_write(out, &api_material_record, materials->rows[i]);
        }
    }
    api_out_array_end(out);
}

bool api_read_color(const api_in *in, size_t most, double color[4], size_t *count)
{
    api_in child;
    size_t n = 0;
    if (!api_in_array(in, 3, most)) {
        return false;
    }
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!api_in_number(&child, &color[n])) {
            return false;
        }
        if (color[n] < 0) {
            return api_in_fail(&child, HE_BAD_VALUE, "the numbers of a colour must not be below 0");
        }
        n++;
    }
    *count = n;
    return true;
}

static bool read_color(const api_in *object, const char *key, size_t most, double *out)
{
    api_in member;
    double color[4] = {0, 0, 0, 1};
    size_t count = 0;
    if (!api_in_find(object, key, &member)) {
        return true;
    }
    if (!api_read_color(&member, most, color, &count)) {
        return false;
    }
    memcpy(out, color, most * sizeof *out);
    return true;
}

static bool read_fraction(const api_in *object, const char *key, double *out)
{
    api_in member;
    return !api_in_find(object, key, &member) || api_in_number_within(&member, 0, 1, false, out);
}

static bool read_material(const api_in *in, he_materials *out)
{
    static const char *const members[] = {"name",     "base_color", "metallic", "roughness",
                                          "emission", "two_sided",  NULL};
    he_look look = he_plain_look;
    he_material *row = NULL;
    he_error err = {0};
    api_in name, sides;
    const char *text;
    if (!api_in_object(in) || !api_in_only(in, members) || !api_in_need(in, "name", &name) ||
        !api_in_string(&name, HE_MATERIAL_NAME, &text) ||
        !read_color(in, "base_color", 4, look.base_color) ||
        !read_fraction(in, "metallic", &look.metallic) ||
        !read_fraction(in, "roughness", &look.roughness) ||
        !read_color(in, "emission", 3, look.emission) ||
        (api_in_find(in, "two_sided", &sides) && !api_in_bool(&sides, &look.two_sided))) {
        return false;
    }
    if (he_materials_find(out, text, strlen(text)) != SIZE_MAX) {
        return api_in_fail(&name, API_DUPLICATE_MEMBER, "another material already has this name");
    }
    if (he_material_new(text, strlen(text), &look, &row, &err) != HE_OK ||
        he_materials_add(out, row, &err) != HE_OK) {
        he_material_release(row);
        return api_in_fail(in, (int)err.status, "%s", err.text);
    }
    return true;
}

bool api_read_materials(const api_in *in, he_materials *out)
{
    api_in child;
    if (!api_in_array(in, 0, HE_MATERIALS)) {
        return false;
    }
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!read_material(&child, out)) {
            return false;
        }
    }
    return true;
}
