/* attribute_put.c - PUT .../attributes/{domain}/{name}: writes a whole attribute, or the positions
 * of all vertices. */
#include "api/request/handlers.h"

#include "api/request/gate.h"

#include "api/document/attribute_path.h"
#include "api/json/attribute_value.h"
#include "api/write/attribute_write.h"
#include "edit/whole/positions.h"

#include <string.h>

static uint64_t body_cap(const api_writing *w)
{
    return w->octets ? API_MAX_ATTRIBUTE_BYTES : (uint64_t)API_MAX_EDITS;
}

static bool refuse_body(api_exchange *x, const api_writing *w)
{
    return api_fail(x, API_BODY_TOO_LARGE, "the body exceeds %llu bytes%s",
                    (unsigned long long)body_cap(w),
                    w->octets ? "" : "; application/octet-stream may be larger");
}

/* Sets the maximum size of the body. The exact size of a binary body is known before it arrives if
 * the mesh is in memory. */
static void set_maximum(api_exchange *x, api_writing *w)
{
    uint64_t most = body_cap(w);
    if (w->octets && x->content != NULL) {
        uint64_t rows = he_mesh_issued(x->content, x->kind);
        most = rows * w->column->row_bytes < most ? rows * w->column->row_bytes : most;
    }
    w->body.maximum = (size_t)most + 1;
}

static bool describe_by_query(api_exchange *x, api_writing *w)
{
    const bool position = api_attribute_is_position(x);
    int type = api_param_choice(x, "type"), rule = api_param_choice(x, "rule");
    he_error err = {0};
    if (type < 0 && position) {
        type = HE_DOUBLE;
    } else if (type < 0) {
        return api_fail(x, API_BAD_PARAMETER,
                        "application/octet-stream needs the parameter \"type\"");
    }
    rule = rule < 0 ? (int)api_default_rule((he_type)type) : rule;
    return he_column_new(
               &(he_column_schema){x->attribute, x->kind, (he_type)type,
                                   (uint32_t)api_param_u64(x, "components", position ? 3 : 1),
                                   (he_rule)rule},
               &w->column, &err) == HE_OK ||
           api_fail_core(x, &err);
}

void api_attribute_put_begin(api_exchange *x)
{
    api_writing *w = api_writing_begin(x);
    if (w == NULL) {
        return;
    }
    size_t length = strlen(x->attribute);
    if (strcmp(x->attribute, API_POSITION) == 0 && !api_attribute_is_position(x)) {
        api_fail(x, API_RESERVED_NAME, "the name \"%s\" is reserved for the positions of vertices",
                 API_POSITION);
        return;
    }
    if (length >= HE_COLUMN_NAME) {
        api_fail(x, HE_BAD_VALUE,
                 "an attribute's name must have 1 to %d bytes, but this name has %zu",
                 HE_COLUMN_NAME - 1, length);
        return;
    }
    w->octets = x->media_in != NULL && strcmp(x->media_in, "application/octet-stream") == 0;
    if (!w->octets && x->query.count > 0) {
        api_fail(x, API_BAD_PARAMETER,
                 "\"%s\" is a parameter for application/octet-stream only: in JSON it is a member "
                 "of the body",
                 x->query.pairs[0].name);
        return;
    }
    if (x->request.has_length && x->request.length > body_cap(w)) {
        refuse_body(x, w);
        return;
    }
    if (!w->octets || describe_by_query(x, w)) {
        set_maximum(x, w);
    }
}

void api_attribute_put_body(api_exchange *x, const char *bytes, size_t length)
{
    api_writing *w = x->state;
    if (length > w->body.maximum - w->body.length) {
        if (w->octets && w->body.maximum <= API_MAX_ATTRIBUTE_BYTES) {
            api_fail(
                x, HE_BAD_VALUE,
                "the body is longer than the %zu bytes that one value for each of all %s needs",
                w->body.maximum - 1, he_kind_plural(x->kind));
            x->problem.status = 422;
        } else {
            refuse_body(x, w);
        }
        return;
    }
    api_text_add(&w->body, bytes, length);
    if (w->body.failed) {
        api_fail_memory(x);
    }
}

static bool decode_json(api_exchange *x, api_writing *w)
{
    static const char *const members[] = {
        "type",   "components", "rule",    "default",           "labels",
        "values", "value",      "dry_run", "expected_revision", NULL};
    const api_in_options options = {.values = API_MAX_EDITS_VALUES};
    bool good =
        api_document_parse(api_text_bytes(&w->body), &options, &w->document, &w->root, &x->problem);
    api_text_clear(&w->body);
    return good && api_in_only(&w->root, members) && api_writing_read_common(w, &w->root) &&
           api_read_column(&w->root, x->kind, x->attribute, &w->column) &&
           api_writing_read_values(w, &w->root, w->column);
}

static bool decode_octets(api_exchange *x, api_writing *w)
{
    size_t row = w->column->row_bytes;
    if (w->body.length % row != 0) {
        return api_fail(
            x, HE_BAD_VALUE,
            "the body has %zu bytes, which is not a whole number of values of %zu bytes each",
            w->body.length, row);
    }
    w->count = w->body.length / row;
    return api_writing_check_octets(x, w->column, w->body.bytes, w->count, 0);
}

/* Requires that the column which the request describes can hold positions. */
static bool check_position(api_exchange *x, const api_writing *w)
{
    static const unsigned char zero[HE_COLUMN_ROW_BYTES];
    const he_column *c = w->column;
    if ((c->type != HE_FLOAT && c->type != HE_DOUBLE) || c->components != 3 ||
        c->rule != HE_INTERPOLATE || memcmp(c->fallback, zero, c->row_bytes) != 0) {
        return api_fail(x, HE_BAD_VALUE,
                        "a position has 3 components of the type double or float, the rule "
                        "interpolate, and no default");
    }
    return w->octets || w->has_at || w->same ||
           api_in_fail(&w->root, API_MISSING_MEMBER, "\"values\" or \"value\" is missing");
}

/* Requires a value for each issued id, if the values came as binary data. */
static bool fits(api_exchange *x, const api_writing *w, uint32_t issued)
{
    he_error err = {0};
    if (!w->octets || w->count == issued) {
        return true;
    }
    he_fail_plain(&err, HE_BAD_VALUE,
                  "the body has %zu values, but must have one value for each of the %u ids of %s",
                  w->count, issued, he_kind_plural(x->kind));
    return api_writing_refuse(x, w, &err);
}

/* Fills the new column with what the request has: a value for each live element, one value for all
 * elements, all values as binary data, or nothing, which means the default value. */
static bool fill(api_exchange *x, api_writing *w, const he_mesh *mesh)
{
    he_column *column = w->column;
    uint32_t issued = he_mesh_issued(mesh, x->kind);
    he_error err = {0};
    if ((uint64_t)issued * column->row_bytes > API_MAX_ATTRIBUTE_BYTES) {
        return api_fail(x, HE_LIMIT, "the attribute would have more than %llu bytes",
                        (unsigned long long)API_MAX_ATTRIBUTE_BYTES);
    }
    if (!fits(x, w, issued)) {
        return false;
    }
    if (w->has_at) {
        return he_attribute_fill(mesh, column, w->values, w->count, &err) == HE_OK ||
               api_writing_refuse(x, w, &err);
    }
    if (he_column_extend(column, issued, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    for (uint32_t id = 0; id < issued && (w->octets || w->same); id++) {
        const unsigned char *from =
            w->octets ? (const unsigned char *)w->body.bytes + (size_t)id * column->row_bytes
                      : w->values;
        memcpy(he_column_row(column, id), from, column->row_bytes);
    }
    he_attribute_settle(mesh, column);
    return true;
}

static size_t count_columns(const he_mesh *mesh)
{
    size_t count = 0;
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        count += he_mesh_column(mesh, i) != NULL;
    }
    return count;
}

/* Makes the body, which has a value for each issued id, the memory of the column. */
static void take_body(api_writing *w)
{
    he_column *column = w->column;
    column->data = he_mem_shrink(w->body.bytes, w->count * column->row_bytes);
    column->rows = column->capacity = w->count;
    w->body = (api_text){0};
}

/* Makes the values of the request the rows of its column of positions, as doubles. The body of a
 * request with doubles becomes the memory of the column, because it may be large. */
static bool fill_positions(api_exchange *x, api_writing *w, const he_mesh *mesh)
{
    const uint32_t issued = he_mesh_issued(mesh, HE_VERTEX);
    he_column *column = NULL;
    he_error err = {0};
    if (!(w->octets ? fits(x, w, issued) : fill(x, w, mesh))) {
        return false;
    }
    if (w->octets) {
        take_body(w);
    }
    if (w->column->type == HE_DOUBLE) {
        return true;
    }
    if (he_column_new(&he_position_schema, &column, &err) != HE_OK ||
        he_column_reserve(column, issued, &err) != HE_OK) {
        he_column_free(column);
        return api_fail_core(x, &err);
    }
    column->rows = issued;
    for (size_t i = 0; i < 3 * (size_t)issued; i++) {
        float narrow;
        memcpy(&narrow, w->column->data + i * sizeof narrow, sizeof narrow);
        const double wide = narrow;
        memcpy(column->data + i * sizeof wide, &wide, sizeof wide);
    }
    he_column_free(w->column);
    w->column = column;
    return true;
}

/* Moves all vertices to the positions that the request has, and ends the write. */
static void put_positions(api_exchange *x, api_writing *w)
{
    he_mesh *mesh = x->write.content;
    he_error err = {0};
    bool good = fill_positions(x, w, mesh);
    if (good && he_positions_put(mesh, w->column, &err) != HE_OK) {
        good = api_writing_refuse(x, w, &err);
    } else if (good) {
        w->column = NULL;
    }
    api_writing_publish(x, w, "attribute_write", 200, good);
}

/* Adds the column to the mesh of the write that was begun, and ends the write. */
static void put_column(api_exchange *x, api_writing *w)
{
    he_mesh *mesh = x->write.content;
    he_error err = {0};
    bool is_new = he_mesh_find_column(mesh, x->kind, x->attribute) == NULL;
    bool good = !is_new || count_columns(mesh) < API_MAX_ATTRIBUTES ||
                api_fail(x, HE_LIMIT, "the mesh already has %zu attributes, and may not have more",
                         count_columns(mesh));
    good = good && fill(x, w, mesh);
    if (good && he_attribute_put(mesh, w->column, &err) != HE_OK) {
        good = api_fail_core(x, &err);
    }
    if (good) {
        w->column = NULL;
    }
    api_writing_publish(x, w, is_new ? "attribute_create" : "attribute_replace", is_new ? 201 : 200,
                        good);
}

static void put(api_exchange *x, api_writing *w)
{
    if (api_attribute_is_position(x)) {
        put_positions(x, w);
    } else {
        put_column(x, w);
    }
}

/* Adds a large column to a copy of the mesh, under a claim (store/write.h): the mesh is reserved,
 * but not locked, while the change is written to the disk. */
static void put_claimed(api_exchange *x)
{
    he_error err = {0};
    if (!api_write_claim(x, api_writing_expected(x->state))) {
        return;
    }
    if (st_write_copy(&x->write, &x->progress, &err) != HE_OK) {
        api_fail_core(x, &err);
        return;
    }
    he_mesh_set_progress(x->write.content, NULL);
    put(x, x->state);
}

/* Returns true if the column is too large to be encoded for the journal while the mesh is locked.
 * If the request has no value for each element, the number of all elements of the mesh is taken as
 * the number of rows, which is an upper bound. */
static bool is_large(const api_exchange *x, const api_writing *w)
{
    st_mesh_info info;
    const uint64_t rows = w->octets || w->has_at ? w->count : st_read_card(x->mesh, &info);
    return st_store_stages(x->store, rows * w->column->row_bytes);
}

void api_attribute_put(api_exchange *x)
{
    api_writing *w = x->state;
    if (!(w->octets ? decode_octets(x, w) : decode_json(x, w)) ||
        (api_attribute_is_position(x) && !check_position(x, w)) || !api_writing_may(x, w)) {
        return;
    }
    if (is_large(x, w)) {
        api_defer(x, put_claimed);
    } else if (api_write_begin(x, api_writing_expected(w))) {
        put(x, w);
    }
}
