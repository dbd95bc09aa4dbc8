#include "mesh/column.h"

#include "base/utf8.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name;
    size_t bytes;
} types[HE_TYPE_COUNT] = {
    {"bool", 1}, {"int32", 4}, {"uint32", 4}, {"float", 4}, {"double", 8},
};

static const char *const rules[HE_RULE_COUNT] = {"copy", "interpolate", "default"};

const char *he_type_name(he_type type)
{
    return types[type].name;
}

size_t he_type_bytes(he_type type)
{
    return types[type].bytes;
}

const char *he_rule_name(he_rule rule)
{
    return rules[rule];
}

/* Returns the schema of a column. The name in the schema is borrowed from the column. */
static he_column_schema schema_of(const he_column *column)
{
    return (he_column_schema){column->name, column->domain, column->type, column->components,
                              column->rule};
}

const he_column_schema he_position_schema = {"position", HE_VERTEX, HE_DOUBLE, 3, HE_INTERPOLATE};

he_status he_column_new(const he_column_schema *schema, he_column **out, he_error *err)
{
    size_t length = strlen(schema->name);
    uint32_t components = schema->components;
    if (length == 0 || length >= HE_COLUMN_NAME) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "an attribute's name must have 1 to %d bytes, but this name has %zu",
                             HE_COLUMN_NAME - 1, length);
    }
    if (components == 0 || components > HE_COLUMN_COMPONENTS) {
        return he_fail_plain(err, HE_BAD_VALUE, "an attribute must have 1 to %d components, not %u",
                             HE_COLUMN_COMPONENTS, components);
    }
    he_column *column = he_mem_zero(1, sizeof *column);
    if (column == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for attribute %s", schema->name);
    }
    memcpy(column->name, schema->name, length + 1);
    column->domain = schema->domain;
    column->type = schema->type;
    column->rule = schema->rule;
    column->components = components;
    column->row_bytes = components * (uint32_t)types[schema->type].bytes;
    *out = column;
    return HE_OK;
}

void he_column_free(he_column *column)
{
    if (column != NULL) {
        he_labels_release(column->labels);
        he_mem_free(column->data);
        he_mem_free(column);
    }
}

he_status he_column_like(const he_column *column, size_t rows, he_column **out, he_error *err)
{
    he_column *like;
    const he_column_schema schema = schema_of(column);
    he_status status = he_column_new(&schema, &like, err);
    if (status != HE_OK) {
        return status;
    }
    memcpy(like->fallback, column->fallback, column->row_bytes);
    like->labels = he_labels_retain(column->labels);
    status = he_column_extend(like, rows, err);
    if (status != HE_OK) {
        he_column_free(like);
        return status;
    }
    *out = like;
    return HE_OK;
}

double he_column_number(const he_column *column, size_t row, uint32_t component)
{
    const unsigned char *at = he_column_value(column, row) + component * types[column->type].bytes;
    int32_t whole;
    uint32_t natural;
    float single;
    double number = 0;
    switch (column->type) {
    case HE_BOOL:
        return *at;
    case HE_INT32:
        memcpy(&whole, at, sizeof whole);
        return whole;
    case HE_UINT32:
        memcpy(&natural, at, sizeof natural);
        return natural;
    case HE_FLOAT:
        memcpy(&single, at, sizeof single);
        return (double)single;
    case HE_DOUBLE:
        memcpy(&number, at, sizeof number);
        break;
    case HE_TYPE_COUNT:
        break;
    }
    return number;
}

void he_column_put_number(const he_column *column, uint32_t component, double number,
                          unsigned char *value)
{
    unsigned char *to = value + component * types[column->type].bytes;
    int32_t whole;
    uint32_t natural;
    float single;
    switch (column->type) {
    case HE_BOOL:
        *to = number >= 0.5;
        break;
    case HE_INT32:
        whole = (int32_t)round(fmax(INT32_MIN, fmin(number, INT32_MAX)));
        memcpy(to, &whole, sizeof whole);
        break;
    case HE_UINT32:
        natural = (uint32_t)round(fmax(0, fmin(number, UINT32_MAX)));
        memcpy(to, &natural, sizeof natural);
        break;
    case HE_FLOAT:
        single = (float)number;
        memcpy(to, &single, sizeof single);
        break;
    case HE_DOUBLE:
        memcpy(to, &number, sizeof number);
        break;
    case HE_TYPE_COUNT:
        break;
    }
}

he_status he_column_copy(const he_column *column, he_column **out, he_error *err)
{
    he_column *copy = he_mem_alloc(sizeof *copy);
    if (copy == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to copy attribute %s", column->name);
    }
    *copy = *column;
    copy->data = NULL;
    copy->capacity = 0;
    copy->rows = 0;
    copy->labels = he_labels_retain(column->labels);
    he_status status = he_column_reserve(copy, column->rows, err);
    if (status != HE_OK) {
        he_column_free(copy);
        return status;
    }
    copy->rows = column->rows;
    if (copy->rows > 0) {
        memcpy(copy->data, column->data, copy->rows * copy->row_bytes);
    }
    *out = copy;
    return HE_OK;
}

size_t he_rows_grown(size_t capacity, size_t rows)
{
    enum { MANY = 1 << 17 };
    size_t grown = capacity + capacity / 8;
    return capacity < MANY || grown < rows ? he_mem_grown(capacity, rows) : grown;
}

he_status he_column_reserve(he_column *column, size_t rows, he_error *err)
{
    if (rows <= column->capacity) {
        return HE_OK;
    }
    size_t capacity = column->rows == 0 ? rows : he_rows_grown(column->capacity, rows);
    unsigned char *data = he_mem_array(column->data, capacity, column->row_bytes);
    if (data == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu values of attribute %s", rows,
                             column->name);
    }
    column->data = data;
    column->capacity = capacity;
    return HE_OK;
}

he_status he_column_extend(he_column *column, size_t rows, he_error *err)
{
    he_status status = he_column_reserve(column, column->rows + rows, err);
    if (status != HE_OK) {
        return status;
    }
    static const unsigned char zero[HE_COLUMN_ROW_BYTES];
    if (rows > 0 && memcmp(column->fallback, zero, column->row_bytes) == 0) {
        memset(he_column_row(column, column->rows), 0, rows * column->row_bytes);
    } else {
        for (size_t i = 0; i < rows; i++) {
            memcpy(he_column_row(column, column->rows + i), column->fallback, column->row_bytes);
        }
    }
    column->rows += rows;
    return HE_OK;
}

size_t he_column_bytes(const he_column *column)
{
    return sizeof *column + column->capacity * column->row_bytes;
}

size_t he_column_rows_bytes(const he_column *column)
{
    return sizeof *column + column->rows * column->row_bytes;
}

bool he_column_same_kind(const he_column *a, const he_column *b)
{
    return strcmp(a->name, b->name) == 0 && a->domain == b->domain && a->type == b->type &&
           a->rule == b->rule && a->components == b->components &&
           he_labels_equal(a->labels, b->labels) &&
           memcmp(a->fallback, b->fallback, a->row_bytes) == 0;
}

bool he_column_same_values(const he_column *a, const he_column *b)
{
    return a->type == b->type && a->components == b->components && a->labels == b->labels;
}

bool he_is_material_column(const he_column *column)
{
    return column->domain == HE_FACE && column->type == HE_UINT32 && column->components == 1 &&
           column->labels != NULL && strcmp(column->name, HE_MATERIAL_ATTRIBUTE) == 0;
}

bool he_is_normal_column(const he_column *column)
{
    return (column->type == HE_FLOAT || column->type == HE_DOUBLE) && column->components == 3 &&
           strcmp(column->name, "normal") == 0;
}

void he_normal_negate(const he_column *column, unsigned char *row)
{
    size_t size = he_type_bytes(column->type);
    /* The three values are floats or doubles in little-endian byte order, so the sign of a value is
     * the top bit of its last byte. */
    for (size_t k = 1; k <= 3; k++) {
        row[k * size - 1] ^= 0x80;
    }
}

he_status he_column_for_corners(const he_column *column, const char *name, size_t rows,
                                he_column **out, he_error *err)
{
    he_column *made;
    he_column_schema schema = schema_of(column);
    schema.name = name;
    schema.domain = HE_HALFEDGE;
    he_status status = he_column_new(&schema, &made, err);
    if (status != HE_OK) {
        return status;
    }
    memcpy(made->fallback, column->fallback, column->row_bytes);
    made->labels = he_labels_retain(column->labels);
    status = he_column_extend(made, rows, err);
    if (status != HE_OK) {
        he_column_free(made);
        return status;
    }
    *out = made;
    return HE_OK;
}

void he_column_number_name(const char *name, unsigned number, char out[HE_COLUMN_NAME])
{
    he_name_number(name, number, out, HE_COLUMN_NAME);
}
