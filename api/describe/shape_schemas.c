#include "api/describe/shape_schemas.h"

#include "algo/shape.h"
#include "api/describe/schemas.h"

#include <assert.h>
#include <stdio.h>

static void write_param(api_out *out, const he_shape_param *param)
{
    api_out_key(out, param->name);
    api_out_object_begin(out);
    if (param->doc != NULL) {
        api_out_key_string(out, "description", param->doc);
    }
    if (param->type == HE_SHAPE_FLAG) {
        api_out_key_string(out, "type", "boolean");
        api_out_key_bool(out, "default", param->fallback > 0);
    } else {
        api_out_key_string(out, "type", param->type == HE_SHAPE_INTEGER ? "integer" : "number");
        api_out_key_number(out, param->exclusive ? "exclusiveMinimum" : "minimum", param->min);
        api_out_key_number(out, "maximum", param->max);
        api_out_key_number(out, "default", param->fallback);
    }
    api_out_object_end(out);
}

static void write_shape(api_out *out, const he_shape *shape)
{
    static const char name[] = "{\"anyOf\":[{\"type\":\"string\"},{\"type\":\"null\"}]}";
    char schema[64];
    snprintf(schema, sizeof schema, "shape_%s", shape->name);
    api_out_key(out, schema);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    api_out_key_string(out, "description", shape->doc);
    api_out_key(out, "properties");
    api_out_object_begin(out);
    api_out_key(out, "shape");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    api_out_key_string(out, "const", shape->name);
    api_out_object_end(out);
    api_out_key(out, "name");
    api_out_raw(out, name, sizeof name - 1);
    for (size_t i = 0; i < he_shape_params(shape); i++) {
        write_param(out, &shape->params[i]);
    }
    api_out_object_end(out);
    api_out_key(out, "required");
    api_out_array_begin(out);
    api_out_string(out, "shape");
    api_out_array_end(out);
    api_out_key_bool(out, "additionalProperties", false);
    api_out_object_end(out);
}

void api_shape_schemas_write(api_out *out)
{
    enum { MOST_SHAPES = 64 };
    const char *names[MOST_SHAPES + 1] = {NULL};
    assert(he_shape_count() <= MOST_SHAPES);
    for (size_t i = 0; i < he_shape_count(); i++) {
        names[i] = he_shape_at(i)->name;
        write_shape(out, he_shape_at(i));
    }
    api_schema_union(out, "shape", "shape", "shape", names);
}
