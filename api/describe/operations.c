#include "api/describe/operations.h"

#include "api/describe/schemas.h"
#include "op/op.h"

#include <stdio.h>
#include <string.h>

/* --- GET /v1/operations --- */

static const char *param_type(const he_param *param)
{
    switch (param->type) {
    case HE_PARAM_ELEMENT:
    case HE_PARAM_ELEMENTS:
        return he_kind_name(param->kind);
    case HE_PARAM_CYCLE:
        return he_kind_plural(param->kind);
    case HE_PARAM_NUMBER:
        return param->flags & HE_WHOLE ? "integer" : "number";
    case HE_PARAM_POINT:
        return "point";
    case HE_PARAM_POINTS:
        return "points";
    case HE_PARAM_FLAG:
        return "flag";
    case HE_PARAM_CHOICE:
        return "choice";
    case HE_PARAM_MATRIX:
        return "matrix";
    case HE_PARAM_TEXT:
        return "text";
    case HE_PARAM_COLOR:
        return param->flags & HE_OPACITY ? "color_alpha" : "color";
    case HE_PARAM_MESH:
        return "mesh";
    }
    return "";
}

/* Writes the value of a parameter that is not given. */
static void write_default(api_out *out, const he_param *param)
{
    if (param->flags & (HE_REQUIRED | HE_DERIVED)) {
        return;
    }
    if (param->type == HE_PARAM_NUMBER) {
        api_out_key_number(out, "default", param->fallback);
    } else if (param->type == HE_PARAM_FLAG) {
        api_out_key_bool(out, "default", param->fallback > 0);
    } else if (param->type == HE_PARAM_CHOICE) {
        api_out_key_string(out, "default", param->choices[(size_t)param->fallback]);
    }
}

static void write_param(api_out *out, const he_param *param)
{
    api_out_object_begin(out);
    api_out_key_string(out, "name", param->name);
    if (param->plural != NULL) {
        api_out_key_string(out, "plural", param->plural);
        api_out_key_bool(out, "set", true);
    }
    api_out_key_string(out, "type", param_type(param));
    api_out_key_bool(out, "required", (param->flags & HE_REQUIRED) != 0);
    if (param->flags & HE_NULLABLE) {
        api_out_key_bool(out, "nullable", true);
    }
    if (param->group != 0) {
        char group[2] = {param->group, '\0'};
        api_out_key_string(out, "group", group);
    }
    write_default(out, param);
    if (param->flags & HE_RANGE) {
        api_out_key_number(out, "min", param->min);
        api_out_key_number(out, "max", param->max);
        if (param->flags & HE_EXCLUSIVE) {
            api_out_key_bool(out, "exclusive", true);
        }
    }
    if (param->choices != NULL) {
        api_schema_choices(out, "choices", param->choices);
    }
    api_out_key_string(out, "doc", param->doc == NULL ? "" : param->doc);
    api_out_object_end(out);
}

static void write_result(api_out *out, const he_result_row *result)
{
    const char *type = "";
    switch (result->type) {
    case HE_RESULT_ELEMENT:
        type = he_kind_name(result->kind);
        break;
    case HE_RESULT_ELEMENTS:
        type = he_kind_plural(result->kind);
        break;
    case HE_RESULT_NUMBER:
        type = "number";
        break;
    case HE_RESULT_CHOICE:
        type = "choice";
        break;
    case HE_RESULT_MAP:
        type = "map";
        break;
    case HE_RESULT_COUNTS:
        type = "counts";
        break;
    }
    api_out_object_begin(out);
    api_out_key_string(out, "name", result->name);
    api_out_key_string(out, "type", type);
    if (result->choices != NULL) {
        api_schema_choices(out, "choices", result->choices);
    }
    api_out_key_string(out, "doc", result->doc == NULL ? "" : result->doc);
    api_out_object_end(out);
}

static void write_op(api_out *out, const he_op *op)
{
    api_out_object_begin(out);
    api_out_key_string(out, "name", op->name);
    api_out_key_string(out, "doc", op->doc);
    api_out_key_string(out, "size", op->size == HE_OP_LOCAL ? "local" : "whole");
    api_out_key(out, "params");
    api_out_array_begin(out);
    for (size_t i = 0; i < he_op_params(op); i++) {
        write_param(out, &op->params[i]);
    }
    api_out_array_end(out);
    api_out_key(out, "results");
    api_out_array_begin(out);
    for (size_t i = 0; i < he_op_results(op); i++) {
        write_result(out, &op->results[i]);
    }
    api_out_array_end(out);
    api_out_key(out, "refusals");
    api_out_array_begin(out);
    for (size_t i = 0; i < HE_OP_REFUSALS && op->refusals[i] != HE_OK; i++) {
        api_out_string(out, he_status_slug(op->refusals[i]));
    }
    api_out_array_end(out);
    api_out_key(out, "change");
    if (op->change[0] == HE_VARIES || op->change[1] == HE_VARIES || op->change[2] == HE_VARIES) {
        api_out_null(out);
    } else {
        api_out_array_begin(out);
        for (int i = 0; i < 3; i++) {
            api_out_i64(out, op->change[i]);
        }
        api_out_array_end(out);
    }
    api_out_object_end(out);
}

void api_operations_write(api_out *out)
{
    api_out_object_begin(out);
    api_out_key(out, "operations");
    api_out_array_begin(out);
    for (size_t i = 0; i < he_op_count(); i++) {
        write_op(out, he_op_at(i));
    }
    api_out_array_end(out);
    api_out_object_end(out);
}

/* --- schemas of operations --- */

static void write_list_schema(api_out *out, unsigned min)
{
    api_out_object_begin(out);
    api_out_key_string(out, "type", "array");
    api_schema_ref_key(out, "items", "id_or_reference");
    api_out_key_u64(out, "minItems", min);
    api_out_object_end(out);
}

static void write_number_schema(api_out *out, const he_param *param)
{
    api_out_object_begin(out);
    api_out_key_string(out, "type", param->flags & HE_WHOLE ? "integer" : "number");
    if (param->flags & HE_RANGE) {
        bool exclusive = (param->flags & HE_EXCLUSIVE) != 0;
        api_out_key_number(out, exclusive ? "exclusiveMinimum" : "minimum", param->min);
        api_out_key_number(out, exclusive ? "exclusiveMaximum" : "maximum", param->max);
    }
    write_default(out, param);
    api_out_object_end(out);
}

static void write_value_schema(api_out *out, const he_param *param)
{
    switch (param->type) {
    case HE_PARAM_ELEMENT:
    case HE_PARAM_ELEMENTS:
        if (!(param->flags & HE_NULLABLE)) {
            api_schema_ref(out, "schemas", "id_or_reference");
            return;
        }
        api_out_object_begin(out);
        api_out_key(out, "anyOf");
        api_out_array_begin(out);
        api_schema_ref(out, "schemas", "id_or_reference");
        api_out_raw(out, "{\"type\":\"null\"}", 15);
        api_out_array_end(out);
        api_out_object_end(out);
        return;
    case HE_PARAM_CYCLE:
        write_list_schema(out, 0);
        return;
    case HE_PARAM_NUMBER:
        write_number_schema(out, param);
        return;
    case HE_PARAM_POINT:
        api_schema_ref(out, "schemas", "point");
        return;
    case HE_PARAM_POINTS:
        api_schema_ref(out, "schemas", "points");
        return;
    case HE_PARAM_FLAG:
        api_out_object_begin(out);
        api_out_key_string(out, "type", "boolean");
        write_default(out, param);
        api_out_object_end(out);
        return;
    case HE_PARAM_CHOICE:
        api_out_object_begin(out);
        api_schema_choices(out, "enum", param->choices);
        write_default(out, param);
        api_out_object_end(out);
        return;
    case HE_PARAM_MATRIX:
        api_schema_ref(out, "schemas", "matrix");
        return;
    case HE_PARAM_TEXT:
        api_out_raw(out, "{\"type\":\"string\"}", 17);
        return;
    case HE_PARAM_COLOR:
        api_schema_ref(out, "schemas", param->flags & HE_OPACITY ? "color_alpha" : "color");
        return;
    case HE_PARAM_MESH:
        api_schema_ref(out, "schemas", "mesh_id");
        return;
    }
}

static void write_param_schema(api_out *out, const he_param *param)
{
    api_out_key(out, param->name);
    api_out_object_begin(out);
    if (param->doc != NULL) {
        api_out_key_string(out, "description", param->doc);
    }
    api_out_key(out, "allOf");
    api_out_array_begin(out);
    write_value_schema(out, param);
    api_out_array_end(out);
    api_out_object_end(out);
    if (param->plural != NULL) {
        api_out_key(out, param->plural);
        api_out_object_begin(out);
        api_out_key(out, "anyOf");
        api_out_array_begin(out);
        write_list_schema(out, 1);
        api_schema_ref(out, "schemas", "set");
        api_out_array_end(out);
        api_out_object_end(out);
    }
}

static void write_alternative(api_out *out, const char *name)
{
    api_out_object_begin(out);
    api_out_key(out, "required");
    api_out_array_begin(out);
    api_out_string(out, name);
    api_out_array_end(out);
    api_out_object_end(out);
}

/* Writes "exactly one of these members" for each group that requires one. */
static void write_groups(api_out *out, const he_op *op)
{
    bool opened = false;
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        bool first = true, required = false;
        for (size_t j = 0; j < he_op_params(op); j++) {
            bool same = j == i || (param->group != 0 && op->params[j].group == param->group);
            first = first && !(same && j < i);
            required = required || (same && (op->params[j].flags & HE_REQUIRED));
        }
        if (!first || !required || (param->group == 0 && param->plural == NULL)) {
            continue;
        }
        if (!opened) {
            api_out_key(out, "allOf");
            api_out_array_begin(out);
            opened = true;
        }
        api_out_object_begin(out);
        api_out_key(out, "oneOf");
        api_out_array_begin(out);
        for (size_t j = i; j < he_op_params(op); j++) {
            const he_param *other = &op->params[j];
            if (j == i || (param->group != 0 && other->group == param->group)) {
                write_alternative(out, other->name);
                if (other->plural != NULL) {
                    write_alternative(out, other->plural);
                }
            }
        }
        api_out_array_end(out);
        api_out_object_end(out);
    }
    if (opened) {
        api_out_array_end(out);
    }
}

/* Begins the schema of an object whose member "op" is the operation's name; leaves the object and
 * its properties open. */
static void begin_named(api_out *out, const he_op *op, const char *description)
{
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    if (description != NULL) {
        api_out_key_string(out, "description", description);
    }
    api_out_key(out, "properties");
    api_out_object_begin(out);
    api_out_key(out, "op");
    api_out_object_begin(out);
    api_out_key_string(out, "const", op->name);
    api_out_object_end(out);
}

static void write_op_schema(api_out *out, const he_op *op)
{
    char name[80];
    snprintf(name, sizeof name, "op_%s", op->name);
    api_out_key(out, name);
    begin_named(out, op, op->doc);
    for (size_t i = 0; i < he_op_params(op); i++) {
        write_param_schema(out, &op->params[i]);
    }
    api_out_object_end(out);
    api_out_key(out, "required");
    api_out_array_begin(out);
    api_out_string(out, "op");
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        if ((param->flags & HE_REQUIRED) && param->group == 0 && param->plural == NULL) {
            api_out_string(out, param->name);
        }
    }
    api_out_array_end(out);
    write_groups(out, op);
    api_out_object_end(out);
}

/* Writes the schema of any operation with additional members: "as" in a list, "expected_revision"
 * for a single one. */
static void write_any_op(api_out *out, const char *name, const char *beside)
{
    api_out_key(out, name);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    if (he_op_count() > 0) {
        api_out_key(out, "oneOf");
        api_out_array_begin(out);
        for (size_t i = 0; i < he_op_count(); i++) {
            char schema[80];
            snprintf(schema, sizeof schema, "op_%s", he_op_at(i)->name);
            api_schema_ref(out, "schemas", schema);
        }
        api_out_array_end(out);
    }
    api_out_key(out, "properties");
    api_out_raw(out, beside, strlen(beside));
    api_out_key_bool(out, "unevaluatedProperties", false);
    api_out_object_end(out);
}

static void write_nullable_id(api_out *out)
{
    api_schema_ref(out, "schemas", "id_or_null");
}

static void write_id(api_out *out)
{
    api_schema_ref(out, "schemas", "id");
}

static void write_array(api_out *out, void (*write_item)(api_out *out))
{
    api_out_key_string(out, "type", "array");
    api_out_key(out, "items");
    write_item(out);
}

static void write_result_schema(api_out *out, const he_result_row *result)
{
    api_out_key(out, result->name);
    api_out_object_begin(out);
    if (result->doc != NULL) {
        api_out_key_string(out, "description", result->doc);
    }
    switch (result->type) {
    case HE_RESULT_ELEMENT:
        api_out_key(out, "allOf");
        api_out_array_begin(out);
        write_nullable_id(out);
        api_out_array_end(out);
        break;
    case HE_RESULT_ELEMENTS:
    case HE_RESULT_COUNTS:
        write_array(out, write_id);
        break;
    case HE_RESULT_NUMBER:
        api_out_key_string(out, "type", "number");
        break;
    case HE_RESULT_CHOICE:
        api_out_key_string(out, "type", "string");
        api_schema_choices(out, "enum", result->choices);
        break;
    case HE_RESULT_MAP:
        write_array(out, write_nullable_id);
        break;
    }
    api_out_object_end(out);
}

/* Writes the schema of an operation's results: its name, and results that the call may have had. */
static void write_done_schema(api_out *out, const he_op *op)
{
    begin_named(out, op, NULL);
    for (size_t i = 0; i < he_op_results(op); i++) {
        write_result_schema(out, &op->results[i]);
    }
    api_out_object_end(out);
    api_out_key(out, "required");
    api_out_raw(out, "[\"op\"]", 6);
    api_out_object_end(out);
}

static void write_any_done(api_out *out)
{
    api_out_key(out, "done");
    api_out_object_begin(out);
    api_out_key(out, "oneOf");
    api_out_array_begin(out);
    for (size_t i = 0; i < he_op_count(); i++) {
        write_done_schema(out, he_op_at(i));
    }
    api_out_array_end(out);
    api_out_object_end(out);
}

void api_operation_schemas_write(api_out *out)
{
    for (size_t i = 0; i < he_op_count(); i++) {
        write_op_schema(out, he_op_at(i));
    }
    write_any_done(out);
    write_any_op(out, "operation",
                 "{\"as\":{\"type\":\"string\",\"maxLength\":64,"
                 "\"pattern\":\"^[A-Za-z_][A-Za-z0-9_]*$\"}}");
    write_any_op(out, "edit_one",
                 "{\"expected_revision\":{\"type\":\"integer\",\"minimum\":1},"
                 "\"dry_run\":{\"type\":\"boolean\"}}");
}
