#include "api/describe/operations.h"

#include "api/describe/schemas.h"
#include "api/json/text.h"
#include "op/op.h"

#include <assert.h>
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
        return param->flags & HE_PROJECTIVE ? "matrix_projective" : "matrix";
    case HE_PARAM_POLYGON:
        return "polygon";
    case HE_PARAM_TEXT:
        return "text";
    case HE_PARAM_COLOR:
        return param->flags & HE_OPACITY ? "color_alpha" : "color";
    case HE_PARAM_MESH:
        return "mesh";
    }
    return "";
}

/* A parameter has a default value if it need not be given and nothing else determines its value. */
static bool has_default(const he_param *param)
{
    return (param->flags & (HE_REQUIRED | HE_DERIVED)) == 0 && param->needed == 0 &&
           (param->type == HE_PARAM_NUMBER || param->type == HE_PARAM_FLAG ||
            param->type == HE_PARAM_CHOICE);
}

static void write_default(api_out *out, const void *value)
{
    const he_param *param = value;
    if (param->type == HE_PARAM_NUMBER) {
        api_out_number(out, param->fallback);
    } else if (param->type == HE_PARAM_FLAG) {
        api_out_bool(out, param->fallback > 0);
    } else {
        api_out_string(out, param->choices[(size_t)param->fallback]);
    }
}

/* Writes the text to which `doc` points, or "" if there is none. */
static void write_doc(api_out *out, const void *doc)
{
    const char *text = *(const char *const *)doc;
    api_out_string(out, text == NULL ? "" : text);
}

/* The most choices that a selector has, one for each bit of he_param.with. */
enum { MOST_CHOICES = 32 };

/* Lists the names of those choices of the operation's selector that are in `bits`; the list ends in
 * NULL, and is empty if `bits` is 0. */
static void list_choices(const he_op *op, unsigned bits, const char *out[MOST_CHOICES + 1])
{
    size_t count = 0;
    for (size_t i = 0; i < MOST_CHOICES && bits >> i != 0; i++) {
        if (bits & HE_WITH(i)) {
            out[count++] = he_op_selector(op)->choices[i];
        }
    }
    out[count] = NULL;
}

/* A parameter with the values of its JSON members that are not in he_param. */
typedef struct shown_param {
    he_param param;
    const char *type;
    char group[2];
    bool required, selects, set, nullable, has_default, has_range, exclusive;
    const char *const *with, *const *needed; /* NULL: none */
} shown_param;

static const api_field param_fields[] = {
    API_FIELD("name", "text", shown_param, param.name, .required = true),
    API_FIELD("plural", "text", shown_param, param.plural,
              .doc = "The name of the parameter that takes a list of ids instead of one id."),
    API_FIELD("each", "text", shown_param, param.each,
              .doc = "The name of the parameter that takes a list instead of one value. The "
                     "operation then runs once for each item of the list, in order, and its other "
                     "parameters may be lists of the same length."),
    API_FIELD("set", "flag", shown_param, set, .zero_is_none = true,
              .doc = "True if a set such as {\"selected\":true} or {\"patch\":3} may be given "
                     "instead of a list of ids."),
    API_FIELD("type", "text", shown_param, type, .required = true),
    API_FIELD("required", "flag", shown_param, required, .required = true),
    API_FIELD("nullable", "flag", shown_param, nullable, .zero_is_none = true),
    API_FIELD("group", "text", shown_param, group, .zero_is_none = true,
              .doc = "Exactly one of the parameters with the same group must be given."),
    API_FIELD("selects", "flag", shown_param, selects, .zero_is_none = true,
              .doc = "True for the selector of an operation: a choice on which depends which other "
                     "parameters may be given."),
    API_FIELD("with", "*text", shown_param, with,
              .doc = "The values of the selector with which the parameter may be given. Without "
                     "this member it may be given with all."),
    API_FIELD("required_with", "*text", shown_param, needed,
              .doc = "The values of the selector with which the parameter, or one of its group, "
                     "must be given."),
    API_FIELD_MADE_OF("default", "#scalar", shown_param, param, write_default,
                      .known = API_KNOWN(shown_param, has_default)),
    API_FIELD("min", "number", shown_param, param.min, .known = API_KNOWN(shown_param, has_range)),
    API_FIELD("max", "number", shown_param, param.max, .known = API_KNOWN(shown_param, has_range)),
    API_FIELD(
        "exclusive", "flag", shown_param, exclusive, .zero_is_none = true,
        .doc = "True if the value must lie between min and max and may not be min or max itself."),
    API_FIELD("unit", "text", shown_param, param.unit,
              .doc = "The unit of a number: radians if it is an angle."),
    API_FIELD("choices", "*text", shown_param, param.choices, .required = false),
    API_FIELD_MADE_OF("doc", "text", shown_param, param.doc, write_doc, .required = true),
};
const api_record api_parameter_record = API_RECORD("parameter", param_fields);

/* Returns true if a set of elements may be given instead of a list of ids. */
static bool takes_set(const he_param *param)
{
    return param->plural != NULL || (param->each != NULL && param->type == HE_PARAM_ELEMENT);
}

static void write_param(api_out *out, const he_op *op, const he_param *param)
{
    const bool has_range = (param->flags & HE_RANGE) != 0;
    const char *with[MOST_CHOICES + 1], *needed[MOST_CHOICES + 1];
    list_choices(op, param->with, with);
    list_choices(op, param->needed, needed);
    const shown_param shown = {.param = *param,
                               .type = param_type(param),
                               .group = {param->group, '\0'},
                               .required = (param->flags & HE_REQUIRED) != 0,
                               .selects = (param->flags & HE_SELECTS) != 0,
                               .with = param->with != 0 ? with : NULL,
                               .needed = param->needed != 0 ? needed : NULL,
                               .set = takes_set(param),
                               .nullable = (param->flags & HE_NULLABLE) != 0,
                               .has_default = has_default(param),
                               .has_range = has_range,
                               .exclusive = has_range && (param->flags & HE_EXCLUSIVE) != 0};
    api_record_write(out, &api_parameter_record, &shown);
}

static const char *result_type(const he_result_row *result)
{
    switch (result->type) {
    case HE_RESULT_ELEMENT:
        return he_kind_name(result->kind);
    case HE_RESULT_ELEMENTS:
        return he_kind_plural(result->kind);
    case HE_RESULT_NUMBER:
        return "number";
    case HE_RESULT_CHOICE:
        return "choice";
    case HE_RESULT_MAP:
        return "map";
    case HE_RESULT_COUNTS:
        return "counts";
    }
    return "";
}

static void write_result_type(api_out *out, const void *row)
{
    api_out_string(out, result_type(row));
}

static const api_field result_fields[] = {
    API_FIELD("name", "text", he_result_row, name, .required = true),
    API_FIELD_MADE("type", "text", write_result_type, .required = true),
    API_FIELD("choices", "*text", he_result_row, choices,
              .doc = "The possible values, if the type is choice."),
    API_FIELD("unit", "text", he_result_row, unit,
              .doc = "The unit of a number: radians if it is an angle."),
    API_FIELD_MADE_OF("doc", "text", he_result_row, doc, write_doc, .required = true),
};
const api_record api_result_record = API_RECORD("result", result_fields);

static void write_size(api_out *out, const void *size)
{
    api_out_string(out, *(const he_op_size *)size == HE_OP_LOCAL ? "local" : "whole");
}

static void write_params(api_out *out, const void *value)
{
    const he_op *op = value;
    api_out_array_begin(out);
    for (size_t i = 0; i < he_op_params(op); i++) {
        write_param(out, op, &op->params[i]);
    }
    api_out_array_end(out);
}

static void write_results(api_out *out, const void *value)
{
    const he_op *op = value;
    api_out_array_begin(out);
    for (size_t i = 0; i < he_op_results(op); i++) {
        api_record_write(out, &api_result_record, &op->results[i]);
    }
    api_out_array_end(out);
}

static void write_refusals(api_out *out, const void *value)
{
    const he_op *op = value;
    api_out_array_begin(out);
    for (size_t i = 0; i < HE_OP_REFUSALS && op->refusals[i] != HE_OK; i++) {
        api_out_string(out, he_status_slug(op->refusals[i]));
    }
    api_out_array_end(out);
}

static void write_change(api_out *out, const void *value)
{
    const he_op *op = value;
    if (op->change[0] == HE_VARIES || op->change[1] == HE_VARIES || op->change[2] == HE_VARIES) {
        api_out_null(out);
        return;
    }
    api_out_array_begin(out);
    for (int i = 0; i < 3; i++) {
        api_out_i64(out, op->change[i]);
    }
    api_out_array_end(out);
}

static void write_page(api_out *out, const void *value)
{
    char path[64];
    snprintf(path, sizeof path, "/docs/operations/%s", ((const he_op *)value)->name);
    api_out_string(out, path);
}

static const api_field op_fields[] = {
    API_FIELD("name", "text", he_op, name, .required = true),
    API_FIELD("doc", "text", he_op, doc, .required = true),
    API_FIELD_MADE_OF("size", "#op_size", he_op, size, write_size, .required = true,
                      .doc = "local: the edit touches a few elements. whole: it may touch all of "
                             "the mesh."),
    API_FIELD_MADE("params", "*#parameter", write_params, .required = true),
    API_FIELD_MADE("results", "*#result", write_results, .required = true),
    API_FIELD_MADE("refusals", "*text", write_refusals, .required = true),
    API_FIELD_MADE("change", "#triple?", write_change, .required = true,
                   .doc = "Change in the numbers of vertices, edges and faces; null if it varies."),
    API_FIELD_MADE("docs", "text", write_page, .required = true,
                   .doc = "The path of its page in the manual."),
};
const api_record api_operation_row_record = API_RECORD("operation_row", op_fields);

/* The table of operations, from which the JSON members of the answer are written. */
typedef struct op_table {
    size_t count;
} op_table;

static void write_ops(api_out *out, const void *value)
{
    const op_table *table = value;
    api_out_array_begin(out);
    for (size_t i = 0; i < table->count; i++) {
        api_record_write(out, &api_operation_row_record, he_op_at(i));
    }
    api_out_array_end(out);
}

static const api_field operations_fields[] = {
    API_FIELD_MADE("operations", "*#operation_row", write_ops, .required = true),
};
const api_record api_operations_record = API_RECORD("operations", operations_fields);

void api_operations_write(api_out *out)
{
    api_record_write(out, &api_operations_record, &(op_table){he_op_count()});
}

/* --- schemas of operations --- */

/* Members that an operation may have besides its parameters: the first, "as", if the operation is
 * in a list of operations, the others if it is the only operation of a request. */
static const struct {
    const char *name, *json;
} beside[] = {
    {"as", "{\"type\":\"string\",\"maxLength\":64,\"pattern\":\"^[A-Za-z_][A-Za-z0-9_]*$\","
           "\"description\":\"Only in a list of operations: a name by which later operations refer "
           "to the results of this one.\"}"},
    {"expected_revision",
     "{\"type\":\"integer\",\"format\":\"int64\",\"minimum\":1,\"description\":\"Only outside a "
     "list of operations: the revision that the edit is meant for.\"}"},
    {"dry_run", "{\"type\":\"boolean\",\"description\":\"Only outside a list of operations: true: "
                "answer without changing anything.\"}"},
};

static void write_default_member(api_out *out, const he_param *param)
{
    if (has_default(param)) {
        api_out_key(out, "default");
        write_default(out, param);
    }
}

/* The functions from write_list_schema to write_value_schema write the members of a schema into an
 * object that the caller has begun. */

static void write_list_schema(api_out *out, unsigned min)
{
    api_out_key_string(out, "type", "array");
    api_schema_ref_key(out, "items", "id_or_reference");
    api_out_key_u64(out, "minItems", min);
}

static void write_number_schema(api_out *out, const he_param *param)
{
    api_out_key_string(out, "type", param->flags & HE_WHOLE ? "integer" : "number");
    if ((param->flags & HE_WHOLE) && !((param->flags & HE_RANGE) && param->max < INT32_MAX)) {
        api_out_key_string(out, "format", "int64");
    }
    if (param->flags & HE_RANGE) {
        bool exclusive = (param->flags & HE_EXCLUSIVE) != 0;
        api_out_key_number(out, exclusive ? "exclusiveMinimum" : "minimum", param->min);
        api_out_key_number(out, exclusive ? "exclusiveMaximum" : "maximum", param->max);
    }
    write_default_member(out, param);
}

static void write_element_schema(api_out *out, const he_param *param)
{
    if (!(param->flags & HE_NULLABLE)) {
        api_schema_reference(out, "id_or_reference");
        return;
    }
    api_out_key(out, "anyOf");
    api_out_array_begin(out);
    api_schema_ref(out, "schemas", "id_or_reference");
    api_out_raw(out, "{\"type\":\"null\"}", 15);
    api_out_array_end(out);
}

static void write_value_schema(api_out *out, const he_param *param)
{
    switch (param->type) {
    case HE_PARAM_ELEMENT:
    case HE_PARAM_ELEMENTS:
        write_element_schema(out, param);
        break;
    case HE_PARAM_CYCLE:
        write_list_schema(out, 0);
        break;
    case HE_PARAM_NUMBER:
        write_number_schema(out, param);
        break;
    case HE_PARAM_POINT:
        api_schema_reference(out, "point");
        break;
    case HE_PARAM_POINTS:
        api_schema_reference(out, "points");
        break;
    case HE_PARAM_FLAG:
        api_out_key_string(out, "type", "boolean");
        write_default_member(out, param);
        break;
    case HE_PARAM_CHOICE:
        api_out_key_string(out, "type", "string");
        api_schema_choices(out, "enum", param->choices);
        write_default_member(out, param);
        break;
    case HE_PARAM_MATRIX:
        api_schema_reference(out, param_type(param));
        break;
    case HE_PARAM_POLYGON:
        api_schema_reference(out, "polygon");
        break;
    case HE_PARAM_TEXT:
        api_out_key_string(out, "type", "string");
        break;
    case HE_PARAM_COLOR:
        api_schema_reference(out, param->flags & HE_OPACITY ? "color_alpha" : "color");
        break;
    case HE_PARAM_MESH:
        api_schema_reference(out, "mesh_or_revision");
        break;
    }
}

/* Returns true if the operation can run once for each item of a list. */
static bool runs_each(const he_op *op)
{
    bool each = false;
    for (size_t i = 0; i < he_op_params(op); i++) {
        each = each || op->params[i].each != NULL;
    }
    return each;
}

/* Returns true if a parameter of the operation may be given as a column. */
static bool is_column(const he_op *op, const he_param *param)
{
    return runs_each(op) && he_op_is_column(param) &&
           (param->each == NULL || strcmp(param->each, param->name) == 0);
}

/* Writes the members of the schema of a value or a column of values. */
static void write_column_schema(api_out *out, const he_param *param)
{
    if (param->type == HE_PARAM_POINT) {
        api_schema_reference(out, "points");
        return;
    }
    api_out_key(out, "oneOf");
    api_out_array_begin(out);
    api_out_object_begin(out);
    write_value_schema(out, param);
    api_out_object_end(out);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "array");
    api_out_key(out, "items");
    api_out_object_begin(out);
    write_value_schema(out, param);
    api_out_object_end(out);
    api_out_key_u64(out, "minItems", 1);
    api_out_object_end(out);
    if (takes_set(param)) {
        api_schema_ref(out, "schemas", "set");
    }
    api_out_array_end(out);
}

/* Writes that a value is a list of ids or a set. */
static void write_list_or_set(api_out *out)
{
    api_out_key(out, "oneOf");
    api_out_array_begin(out);
    api_out_object_begin(out);
    write_list_schema(out, 1);
    api_out_object_end(out);
    api_schema_ref(out, "schemas", "set");
    api_out_array_end(out);
}

/* Writes the schema of the list for each of whose items the operation runs. */
static void write_each_schema(api_out *out, const he_param *param)
{
    api_out_key_string(out, "description",
                       "A list: the operation runs once for each item, in order. Other parameters "
                       "may then be lists of the same length, or one value for all.");
    if (param->type == HE_PARAM_ELEMENT) {
        write_list_or_set(out);
        return;
    }
    api_out_key_string(out, "type", "array");
    if (param->type == HE_PARAM_POINT) {
        api_schema_ref_key(out, "items", "point");
    } else {
        api_out_key(out, "items");
        api_out_object_begin(out);
        write_list_schema(out, 0);
        api_out_object_end(out);
    }
    api_out_key_u64(out, "minItems", 1);
}

static void add_choices(api_text *text, const char *before, const char *const *choices)
{
    for (; *choices != NULL; choices++) {
        api_text_add_format(text, "%s`%s`", before, *choices);
        before = ", ";
    }
}

/* Adds the description of a parameter or result, with its unit if it has one. */
static void add_doc(api_text *text, const char *doc, const char *unit)
{
    api_text_add_string(text, doc);
    if (unit != NULL) {
        api_text_add_format(text, " In %s.", unit);
    }
}

/* Writes a text as the description of a schema, or `doc` if there was no memory for the text.
 * Clears the text. */
static void end_description(api_out *out, api_text *text, const char *doc)
{
    api_text_add(text, "", 1); /* the NUL at its end */
    api_out_key_string(out, "description", text->failed ? doc : text->bytes);
    api_text_clear(text);
}

/* Writes the description of a parameter. If the parameter depends on the operation's selector, a
 * sentence at its end says so. */
static void write_description(api_out *out, const he_op *op, const he_param *param)
{
    api_text text = {0};
    add_doc(&text, param->doc, param->unit);
    if (param->with == 0) {
        end_description(out, &text, param->doc);
        return;
    }
    const char *with[MOST_CHOICES + 1], *needed[MOST_CHOICES + 1];
    list_choices(op, param->with, with);
    list_choices(op, param->needed, needed);
    api_text_add_format(&text, " Only if `%s` is ", he_op_selector(op)->name);
    add_choices(&text, "", with);
    api_text_add_string(&text, ".");
    if (param->needed == param->with && param->group == 0 && param->plural == NULL) {
        api_text_add_string(&text, " Then it is required.");
    } else if (param->needed != 0) {
        add_choices(&text,
                    param->group != 0 ? " One of its group is required for "
                                      : " It is required for ",
                    needed);
        api_text_add_string(&text, ".");
    }
    end_description(out, &text, param->doc);
}

/* Returns true if the list for each of whose items the operation runs has a name of its own. */
static bool has_own_list(const he_param *param)
{
    return param->each != NULL && strcmp(param->each, param->name) != 0;
}

static void write_param_schema(api_out *out, const he_op *op, const he_param *param)
{
    api_out_key(out, param->name);
    api_out_object_begin(out);
    if (param->doc != NULL) {
        write_description(out, op, param);
    }
    if (is_column(op, param)) {
        write_column_schema(out, param);
    } else {
        write_value_schema(out, param);
    }
    api_out_object_end(out);
    if (has_own_list(param)) {
        api_out_key(out, param->each);
        api_out_object_begin(out);
        write_each_schema(out, param);
        api_out_object_end(out);
    }
    if (param->plural == NULL) {
        return;
    }
    api_out_key(out, param->plural);
    api_out_object_begin(out);
    write_list_or_set(out);
    api_out_object_end(out);
}

/* Adds to `text` a sentence for each group of members of which exactly one is required. The schema
 * could express that with "oneOf", but generators of client code make nameless types from it. */
static void describe_groups(api_text *text, const he_op *op)
{
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        bool first = true, required = false;
        for (size_t j = 0; j < he_op_params(op); j++) {
            bool same = j == i || (param->group != 0 && op->params[j].group == param->group);
            first = first && !(same && j < i);
            required = required || (same && (op->params[j].flags & HE_REQUIRED));
        }
        if (!first || !required ||
            (param->group == 0 && param->plural == NULL && !has_own_list(param))) {
            continue;
        }
        const char *before = " Give exactly one of ";
        for (size_t j = i; j < he_op_params(op); j++) {
            const he_param *other = &op->params[j];
            if (j == i || (param->group != 0 && other->group == param->group)) {
                api_text_add_format(text, "%s`%s`", before, other->name);
                before = ", ";
                if (other->plural != NULL || has_own_list(other)) {
                    api_text_add_format(text, "%s`%s`", before,
                                        other->plural != NULL ? other->plural : other->each);
                }
            }
        }
        api_text_add_string(text, ".");
    }
}

/* Begins the schema PREFIX_NAME of an object whose member "op" is the operation's name; the caller
 * ends the object and its "properties". */
static void begin_named(api_out *out, const char *prefix, const he_op *op, const char *description)
{
    char name[80];
    snprintf(name, sizeof name, "%s_%s", prefix, op->name);
    api_out_key(out, name);
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    if (description != NULL) {
        api_out_key_string(out, "description", description);
    }
    api_out_key(out, "properties");
    api_out_object_begin(out);
    api_out_key(out, "op");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "string");
    api_out_key_string(out, "const", op->name);
    api_out_object_end(out);
}

static void write_op_schema(api_out *out, const he_op *op)
{
    api_text description = {0};
    api_text_add_string(&description, op->doc);
    describe_groups(&description, op);
    api_text_add(&description, "", 1); /* the NUL at its end */
    begin_named(out, "op", op, description.failed ? op->doc : description.bytes);
    api_text_clear(&description);
    for (size_t i = 0; i < he_op_params(op); i++) {
        write_param_schema(out, op, &op->params[i]);
    }
    for (size_t i = 0; i < sizeof beside / sizeof *beside; i++) {
        api_out_key(out, beside[i].name);
        api_out_raw(out, beside[i].json, strlen(beside[i].json));
    }
    api_out_object_end(out);
    api_out_key(out, "required");
    api_out_array_begin(out);
    api_out_string(out, "op");
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *param = &op->params[i];
        if ((param->flags & HE_REQUIRED) && param->group == 0 && param->plural == NULL &&
            !has_own_list(param)) {
            api_out_string(out, param->name);
        }
    }
    api_out_array_end(out);
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
        api_text text = {0};
        add_doc(&text, result->doc, result->unit);
        end_description(out, &text, result->doc);
    }
    switch (result->type) {
    case HE_RESULT_ELEMENT:
        api_schema_reference(out, "id_or_null");
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

/* Writes the schema of the columns of results, if the operation can run for each item of a list. */
static void write_columns_schema(api_out *out, const he_op *op)
{
    api_out_key(out, "each");
    api_out_object_begin(out);
    api_out_key_string(out, "type", "object");
    api_out_key_string(out, "description",
                       "If the operation ran for each item of a list: the results, each as a list "
                       "with one value for each item. The other members are then missing.");
    api_out_key(out, "properties");
    api_out_object_begin(out);
    for (size_t i = 0; i < he_op_results(op); i++) {
        api_out_key(out, op->results[i].name);
        api_out_object_begin(out);
        api_out_key_string(out, "type", "array");
        api_out_key(out, "items");
        if (op->results[i].type == HE_RESULT_ELEMENTS) {
            api_out_object_begin(out);
            write_array(out, write_id);
            api_out_object_end(out);
        } else if (op->results[i].type == HE_RESULT_NUMBER) {
            static const char type[] = "{\"anyOf\":[{\"type\":\"number\"},{\"type\":\"null\"}]}";
            api_out_raw(out, type, sizeof type - 1);
        } else {
            write_nullable_id(out);
        }
        api_out_object_end(out);
    }
    api_out_object_end(out);
    api_out_object_end(out);
}

/* Writes the schema done_NAME of the object that has an operation's name and results. */
static void write_done_schema(api_out *out, const he_op *op)
{
    begin_named(out, "done", op, NULL);
    for (size_t i = 0; i < he_op_results(op); i++) {
        write_result_schema(out, &op->results[i]);
    }
    if (runs_each(op)) {
        write_columns_schema(out, op);
    }
    api_out_object_end(out);
    api_out_key(out, "required");
    api_out_raw(out, "[\"op\"]", 6);
    api_out_object_end(out);
}

void api_operation_schemas_write(api_out *out)
{
    enum { MOST_OPERATIONS = 128 };
    const char *names[MOST_OPERATIONS + 1] = {NULL};
    assert(he_op_count() <= MOST_OPERATIONS);
    for (size_t i = 0; i < he_op_count(); i++) {
        names[i] = he_op_at(i)->name;
        write_op_schema(out, he_op_at(i));
        write_done_schema(out, he_op_at(i));
    }
    api_schema_union(out, "operation", "op", "op", names);
    api_schema_union(out, "done", "op", "done", names);
}
