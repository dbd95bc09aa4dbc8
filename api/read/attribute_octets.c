#include "api/read/attribute_octets.h"

#include "api/document/attribute_path.h"
#include "api/request/mesh_access.h"
#include "base/mem.h"
#include "mesh/mesh.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A column whose values are sent as numbers of the type `type`. */
typedef struct rows {
    he_column column; /* a description; the values are those of the mesh */
    he_type type;
    size_t row_bytes;   /* of a value that is sent */
    uint64_t next, end; /* positions in the bytes that are sent */
} rows;

static bool is_real(he_type type)
{
    return type == HE_FLOAT || type == HE_DOUBLE;
}

bool api_attribute_octets_admit(api_exchange *x, const he_column *column)
{
    static const char *const known[] = {"revision", "ids", "type"};
    const int type = api_param_choice(x, "type");
    for (size_t i = 0; i < x->query.count; i++) {
        bool found = false;
        for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
            found |= strcmp(x->query.pairs[i].name, known[k]) == 0;
        }
        if (!found) {
            return api_fail(
                x, API_BAD_PARAMETER,
                "\"%s\" cannot be combined with application/octet-stream, which has no pages",
                x->query.pairs[i].name);
        }
    }
    if (type >= 0 && type != (int)column->type &&
        !(is_real((he_type)type) && is_real(column->type))) {
        return api_fail(x, API_BAD_PARAMETER,
                        "the values are of the type %s, which is not sent as %s",
                        he_type_name(column->type), he_type_name((he_type)type));
    }
    return true;
}

/* --- numbers of the other type --- */

static void convert(he_type from, const unsigned char *value, uint32_t components,
                    unsigned char *out)
{
    for (uint32_t i = 0; i < components; i++) {
        float narrow;
        double wide;
        if (from == HE_DOUBLE) {
            memcpy(&wide, value + i * sizeof wide, sizeof wide);
            narrow = (float)wide;
            memcpy(out + i * sizeof narrow, &narrow, sizeof narrow);
        } else {
            memcpy(&narrow, value + i * sizeof narrow, sizeof narrow);
            wide = narrow;
            memcpy(out + i * sizeof wide, &wide, sizeof wide);
        }
    }
}

static void write_row(const rows *r, uint32_t id, unsigned char *out)
{
    const unsigned char *value = he_column_value(&r->column, id);
    if (r->type == r->column.type) {
        memcpy(out, value, r->row_bytes);
    } else {
        convert(r->column.type, value, r->column.components, out);
    }
}

/* Requires that floats can hold the value of an element. */
static bool require_float(api_exchange *x, const rows *r, uint32_t id)
{
    const unsigned char *value = he_column_value(&r->column, id);
    for (uint32_t i = 0; i < r->column.components; i++) {
        double number;
        memcpy(&number, value + i * sizeof number, sizeof number);
        if (fabs(number) > (double)FLT_MAX) {
            he_error err = {0};
            he_fail(&err, HE_BEYOND_FLOAT, x->kind, id,
                    "the value of %s %u is too large for a float", he_kind_name(x->kind), id);
            return api_fail_core(x, &err);
        }
    }
    return true;
}

/* --- the answers --- */

static void free_rows(void *stream)
{
    he_mem_free(stream);
}

/* Copies bytes of values that are sent as they are stored. Elements after the last value that is
 * stored have the default value. */
static void copy_bytes(const rows *r, char *buffer, size_t length)
{
    const he_column *column = &r->column;
    const uint64_t stored = (uint64_t)column->rows * column->row_bytes;
    size_t held = r->next < stored ? (size_t)(stored - r->next) : 0;
    held = held < length ? held : length;
    if (held > 0) {
        memcpy(buffer, column->data + r->next, held);
    }
    for (size_t i = held; i < length; i++) {
        buffer[i] = (char)column->fallback[(r->next + i) % column->row_bytes];
    }
}

/* Writes bytes of converted values; the first and the last value may be cut. */
static void convert_bytes(const rows *r, char *buffer, size_t length)
{
    unsigned char row[HE_COLUMN_ROW_BYTES];
    uint64_t at = r->next;
    for (size_t done = 0; done < length;) {
        const size_t from = (size_t)(at % r->row_bytes);
        const size_t rest = r->row_bytes - from, room = length - done;
        const size_t part = rest < room ? rest : room;
        write_row(r, (uint32_t)(at / r->row_bytes), row);
        memcpy(buffer + done, row + from, part);
        done += part;
        at += part;
    }
}

static int64_t read_rows(void *stream, char *buffer, size_t size)
{
    rows *r = stream;
    const uint64_t left = r->end - r->next;
    const size_t length = left < size ? (size_t)left : size;
    if (r->type == r->column.type) {
        copy_bytes(r, buffer, length);
    } else {
        convert_bytes(r, buffer, length);
    }
    r->next += length;
    return (int64_t)length;
}

static bool fill_rows(api_exchange *x, rows *out)
{
    const he_column *column = api_attribute_find(x, x->content);
    if (column == NULL) {
        return false;
    }
    const int type = api_param_choice(x, "type");
    *out = (rows){.column = *column, .type = type < 0 ? column->type : (he_type)type};
    out->row_bytes = column->components * he_type_bytes(out->type);
    out->end = (uint64_t)he_mesh_issued(x->content, x->kind) * out->row_bytes;
    return true;
}

static bool narrows(const rows *r)
{
    return r->column.type == HE_DOUBLE && r->type == HE_FLOAT;
}

static void answer_all(api_exchange *x)
{
    if (!api_keep_mesh(x)) {
        return;
    }
    rows *r = he_mem_zero(1, sizeof *r);
    if (r == NULL) {
        api_fail_memory(x);
        return;
    }
    bool good = fill_rows(x, r);
    for (uint32_t id = 0; good && narrows(r) && id < r->column.rows; id++) {
        good = require_float(x, r, id);
    }
    if (!good) {
        free_rows(r);
        return;
    }
    const api_stream stream = {(int64_t)r->end, read_rows, r, free_rows};
    api_answer_stream(x, 200, "application/octet-stream", &stream);
}

static void answer_some(api_exchange *x, const uint32_t *ids, size_t count)
{
    rows r;
    if (!fill_rows(x, &r)) {
        return;
    }
    char *out = api_text_room(&x->text, count * r.row_bytes);
    if (out == NULL) {
        api_fail_memory(x);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        if (narrows(&r) && !require_float(x, &r, ids[i])) {
            return;
        }
        write_row(&r, ids[i], (unsigned char *)out + i * r.row_bytes);
    }
    x->text.length += count * r.row_bytes;
    api_answer_text(x, 200, "application/octet-stream");
}

void api_attribute_octets(api_exchange *x, const uint32_t *ids, size_t count)
{
    if (ids == NULL) {
        answer_all(x);
    } else {
        answer_some(x, ids, count);
    }
}
