#include "api/json/attribute_value.h"

#include "api/limits.h"
#include "format/text/number.h"

#include <math.h>
#include <string.h>

const char *const api_type_names[] = {"bool", "int32", "uint32", "float", "double", NULL};
const char *const api_rule_names[] = {"copy", "interpolate", "default", NULL};

he_rule api_default_rule(he_type type)
{
    return type == HE_FLOAT || type == HE_DOUBLE ? HE_INTERPOLATE : HE_COPY;
}

/* --- writing attribute values --- */

static void write_number(api_out *out, he_type type, const unsigned char *at)
{
    char text[HE_NUMBER_TEXT];
    int32_t whole;
    uint32_t natural;
    float single;
    double number;
    switch (type) {
    case HE_BOOL:
        api_out_bool(out, *at != 0);
        break;
    case HE_INT32:
        memcpy(&whole, at, sizeof whole);
        api_out_i64(out, whole);
        break;
    case HE_UINT32:
        memcpy(&natural, at, sizeof natural);
        api_out_u64(out, natural);
        break;
    case HE_FLOAT:
        memcpy(&single, at, sizeof single);
        if (isfinite(single)) {
            api_out_raw(out, text, he_float_print(single, text));
        } else {
            api_out_null(out);
        }
        break;
    case HE_DOUBLE:
        memcpy(&number, at, sizeof number);
        api_out_number(out, number);
        break;
    case HE_TYPE_COUNT:
        break;
    }
}

void api_write_components(api_out *out, const he_column *column, const unsigned char *row)
{
    size_t size = he_type_bytes(column->type);
    for (uint32_t i = 0; i < column->components; i++) {
        write_number(out, column->type, row + i * size);
    }
}

void api_write_value(api_out *out, const he_column *column, const unsigned char *row)
{
    bool many = column->components > 1;
    if (many) {
        api_out_array_begin(out);
    }
    api_write_components(out, column, row);
    if (many) {
        api_out_array_end(out);
    }
}

/* --- the JSON members of an attribute --- */

api_shown_column api_show_column(const he_mesh *mesh, const he_column *column)
{
    return (api_shown_column){.column = column,
                              .domain = he_kind_plural(column->domain),
                              .name = column->name,
                              .type = he_type_name(column->type),
                              .components = column->components,
                              .rule = he_rule_name(column->rule),
                              .has_labels = column->labels != NULL,
                              .bytes = (uint64_t)he_mesh_issued(mesh, column->domain) *
                                       column->row_bytes};
}

void api_write_default(api_out *out, const void *shown)
{
    const he_column *column = ((const api_shown_column *)shown)->column;
    api_write_value(out, column, column->fallback);
}

static void write_labels(api_out *out, const void *shown)
{
    const he_labels *labels = ((const api_shown_column *)shown)->column->labels;
    const size_t count = he_labels_count(labels);
    api_out_array_begin(out);
    for (size_t i = 0; i < count && i < API_MAX_LABELS; i++) {
        api_out_string(out, he_labels_get(labels, i));
    }
    api_out_array_end(out);
}

/* The rows with which the two tables below begin. */
#define HEAD_FIELDS                                                                      \
    API_FIELD("domain", "#domain", api_shown_column, domain, .required = true),          \
        API_FIELD("name", "text", api_shown_column, name, .required = true),             \
        API_FIELD("type", "#type_name", api_shown_column, type, .required = true),       \
        API_FIELD("components", "count", api_shown_column, components, .required = true, \
                  .doc = "How many numbers one value has."),                             \
        API_FIELD("rule", "#rule_name", api_shown_column, rule, .required = true),       \
        API_FIELD_MADE("default", "#value", api_write_default, .required = true,         \
                       .doc = "The value of elements for which none was written.")

static const api_field added_fields[] = {
    HEAD_FIELDS,
    API_FIELD_MADE("labels", "*text", write_labels,
                   .known = API_KNOWN(api_shown_column, has_labels),
                   .doc = "The texts of the attribute: its values are indices into this list."),
};
const api_record api_attribute_added_record = API_RECORD("attribute_added", added_fields);
/* The first two rows, which identify an attribute. */
const api_record api_attribute_read_record = {"attribute_read", added_fields, 2};

static const api_field info_fields[] = {
    HEAD_FIELDS,
    API_FIELD("bytes", "count", api_shown_column, bytes, .required = true,
              .doc = "Size of the values as application/octet-stream."),
    API_FIELD_MADE("labels", "*text", write_labels,
                   .known = API_KNOWN(api_shown_column, has_labels),
                   .doc = "Only in the list of attributes: the texts of the attribute, whose "
                          "values are indices into this list."),
};
const api_record api_attribute_info_record = API_RECORD("attribute_info", info_fields);
#undef HEAD_FIELDS

uint32_t api_write_attributes(api_out *out, const he_mesh *mesh, he_kind kind, uint32_t id)
{
    bool open = false;
    uint32_t numbers = 0;
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        const he_column *column = he_mesh_column(mesh, i);
        if (column == NULL || column->domain != kind) {
            continue;
        }
        if (!open) {
            api_out_key(out, "attributes");
            api_out_object_begin(out);
            open = true;
        }
        api_out_key(out, column->name);
        api_write_value(out, column, he_column_value(column, id));
        numbers += column->components;
    }
    if (open) {
        api_out_object_end(out);
    }
    return numbers;
}

/* --- reading attribute values --- */

static bool read_whole(const api_in *in, double low, double high, double *out)
{
    if (!api_in_number(in, out)) {
        return false;
    }
    if (*out < low || *out > high || floor(*out) < *out) {
        return api_in_fail(in, HE_BAD_VALUE, "the value must be a whole number from %.0f to %.0f",
                           low, high);
    }
    return true;
}

static bool read_number(const api_in *in, const he_column *column, unsigned char *at)
{
    double number;
    bool flag;
    switch (column->type) {
    case HE_BOOL:
        if (!api_in_bool(in, &flag)) {
            return false;
        }
        *at = flag;
        return true;
    case HE_INT32: {
        if (!read_whole(in, INT32_MIN, INT32_MAX, &number)) {
            return false;
        }
        int32_t whole = (int32_t)number;
        memcpy(at, &whole, sizeof whole);
        return true;
    }
    case HE_UINT32: {
        if (!read_whole(in, 0, UINT32_MAX, &number)) {
            return false;
        }
        uint32_t natural = (uint32_t)number;
        if (column->labels != NULL && natural >= he_labels_count(column->labels)) {
            return api_in_fail(in, HE_BAD_VALUE, "%u is not the index of one of the %zu labels",
                               natural, he_labels_count(column->labels));
        }
        memcpy(at, &natural, sizeof natural);
        return true;
    }
    case HE_FLOAT: {
        if (!api_in_number(in, &number)) {
            return false;
        }
        float single = (float)number;
        if (!isfinite(single)) {
            return api_in_fail(in, HE_NOT_FINITE, "the number is too large for a float");
        }
        memcpy(at, &single, sizeof single);
        return true;
    }
    case HE_DOUBLE:
        if (!api_in_number(in, &number)) {
            return false;
        }
        memcpy(at, &number, sizeof number);
        return true;
    case HE_TYPE_COUNT:
        break;
    }
    return api_in_fail(in, API_INTERNAL,
                       "the member that gives the type of the attribute is missing");
}

bool api_read_value(const api_in *in, const he_column *column, unsigned char *row)
{
    size_t size = he_type_bytes(column->type);
    if (column->components == 1) {
        return read_number(in, column, row);
    }
    api_in child;
    if (!api_in_array(in, column->components, column->components)) {
        return false;
    }
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!read_number(&child, column, row)) {
            return false;
        }
        row += size;
    }
    return true;
}

bool api_read_values(const api_in *in, const he_column *column, unsigned char **rows, size_t *count)
{
    if (!api_in_array(in, 0, SIZE_MAX)) {
        return false;
    }
    size_t n = api_in_count(in), i = 0;
    unsigned char *values = he_mem_array(NULL, n + 1, column->row_bytes);
    if (values == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for %zu values", n);
    }
    api_in child;
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        if (!api_read_value(&child, column, values + i++ * column->row_bytes)) {
            he_mem_free(values);
            return false;
        }
    }
    *rows = values;
    *count = n;
    return true;
}

static bool read_labels(const api_in *in, he_column *column)
{
    api_in child;
    if (column->type != HE_UINT32 || column->components != 1) {
        return api_in_fail(in, HE_BAD_VALUE,
                           "only an attribute of type uint32 with one component can have labels");
    }
    if (!api_in_array(in, 1, API_MAX_LABELS)) {
        return false;
    }
    column->labels = he_labels_new();
    if (column->labels == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for labels");
    }
    for (bool more = api_in_first(in, &child); more; more = api_in_next(&child)) {
        const char *text;
        uint32_t index;
        size_t before = he_labels_count(column->labels);
        if (!api_in_string(&child, API_MAX_LABEL, &text)) {
            return false;
        }
        if (he_labels_add(column->labels, text, strlen(text), &index, NULL) != HE_OK) {
            return api_in_fail(&child, HE_NO_MEMORY, "no memory for a label");
        }
        if (index < before) {
            return api_in_fail(&child, HE_BAD_VALUE, "the label is given twice");
        }
    }
    return true;
}

bool api_read_column(const api_in *object, he_kind domain, const char *name, he_column **out)
{
    api_in member, components = *object;
    int type, rule;
    uint64_t count = 1;
    if (!api_in_need(object, "type", &member) || !api_in_choice(&member, api_type_names, &type)) {
        return false;
    }
    if (api_in_find(object, "components", &components) &&
        !api_in_u64(&components, 1, HE_COLUMN_COMPONENTS, &count)) {
        return false;
    }
    rule = (int)api_default_rule((he_type)type);
    if (api_in_find(object, "rule", &member) && !api_in_choice(&member, api_rule_names, &rule)) {
        return false;
    }
    he_column *column = NULL;
    he_error err = {0};
    if (he_column_new(
            &(he_column_schema){name, domain, (he_type)type, (uint32_t)count, (he_rule)rule},
            &column, &err) != HE_OK) {
        return api_in_fail(object, (int)err.status, "%s", err.text);
    }
    bool good = !api_in_find(object, "labels", &member) || read_labels(&member, column);
    if (good && api_in_find(object, "default", &member)) {
        good = api_read_value(&member, column, column->fallback);
    }
    if (!good) {
        he_column_free(column);
        return false;
    }
    *out = column;
    return true;
}
