/* attributes.c - GET .../attributes, and the values of one attribute: a page of them, those of some
 * ids, or all rows as binary data. */
#include "api/request/handlers.h"

#include "api/document/attribute_path.h"
#include "api/json/attribute_value.h"
#include "api/read/attribute_octets.h"
#include "api/read/records.h"
#include "api/request/mesh_access.h"

#include <stdio.h>
#include <string.h>

typedef struct list {
    uint64_t revision;
    const he_mesh *mesh;
} list;

static void write_attributes(api_out *out, const void *value)
{
    const he_mesh *mesh = ((const list *)value)->mesh;
    api_out_array_begin(out);
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        const he_column *column = he_mesh_column(mesh, i);
        if (column != NULL) {
            const api_shown_column shown = api_show_column(mesh, column);
            api_record_write(out, &api_attribute_info_record, &shown);
        }
    }
    api_out_array_end(out);
}

static const api_field list_fields[] = {
    API_FIELD("revision", "count", list, revision, .required = true),
    API_FIELD_MADE("attributes", "*#attribute_info", write_attributes, .required = true),
};
const api_record api_attribute_list_record = API_RECORD("attribute_list", list_fields);

void api_attributes_list(api_exchange *x)
{
    if (!api_not_modified(x, "attributes")) {
        api_record_write(&x->out, &api_attribute_list_record,
                         &(list){x->info.revision, x->content});
        api_answer_json(x, 200);
    }
}

bool api_attribute_is_position(const api_exchange *x)
{
    return x->kind == HE_VERTEX && strcmp(x->attribute, API_POSITION) == 0;
}

const he_column *api_attribute_find(api_exchange *x, const he_mesh *mesh)
{
    if (api_attribute_is_position(x)) {
        he_column *positions = api_arena_array(&x->arena, 1, sizeof *positions);
        if (positions == NULL) {
            api_fail_memory(x);
        } else {
            he_mesh_position_column(mesh, positions);
        }
        return positions;
    }
    const he_column *column = he_mesh_find_column(mesh, x->kind, x->attribute);
    if (column == NULL) {
        api_fail(x, HE_NO_SUCH_ATTRIBUTE, "%s have no attribute \"%.100s\"",
                 he_kind_plural(x->kind), x->attribute);
        x->problem.status = 404;
    }
    return column;
}

/* Percent-encodes all characters except letters, digits, and - _ . ~. */
static void write_segment(const char *name, char *out)
{
    static const char digits[] = "0123456789ABCDEF";
    for (; *name != '\0'; name++) {
        unsigned char c = (unsigned char)*name;
        bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                     c == '-' || c == '_' || c == '.' || c == '~';
        if (plain) {
            *out++ = (char)c;
        } else {
            *out++ = '%';
            *out++ = digits[c >> 4];
            *out++ = digits[c & 15];
        }
    }
    *out = '\0';
}

void api_attribute_path(const api_exchange *x, char out[API_LOCATION])
{
    char segment[3 * HE_COLUMN_NAME + 1];
    write_segment(x->attribute, segment);
    snprintf(out, API_LOCATION, "/v1/meshes/%s/attributes/%s/%s", x->mesh_id,
             he_kind_plural(x->kind), segment);
}

/* --- values as JSON --- */

/* The values of the JSON members of an answer with values. */
typedef struct page {
    uint64_t revision;
    api_shown_column column;
    const uint32_t *ids;
    size_t count;
    char next[API_CURSOR]; /* cursor of the next page; "" if there is none */
} page;

static void write_ids(api_out *out, const void *value)
{
    const page *p = value;
    api_out_ids(out, p->ids, p->count);
}

static void write_values(api_out *out, const void *value)
{
    const page *p = value;
    const he_column *column = p->column.column;
    api_out_array_begin(out);
    for (size_t i = 0; i < p->count; i++) {
        api_write_value(out, column, he_column_value(column, p->ids[i]));
    }
    api_out_array_end(out);
}

static const api_field values_fields[] = {
    API_FIELD("revision", "count", page, revision, .required = true),
    API_FIELD("domain", "#domain", page, column.domain, .required = true),
    API_FIELD("name", "text", page, column.name, .required = true),
    API_FIELD("type", "#type_name", page, column.type, .required = true),
    API_FIELD("components", "count", page, column.components, .required = true),
    API_FIELD("rule", "#rule_name", page, column.rule, .required = true),
    API_FIELD_MADE_OF("default", "#value", page, column, api_write_default, .required = true),
    API_FIELD("bytes", "count", page, column.bytes, .required = true),
    API_FIELD_MADE("ids", "*id", write_ids, .required = true),
    API_FIELD_MADE("values", "*#value", write_values, .required = true,
                   .doc = "One value for each id; an array if it has several components."),
    API_FIELD("next", "text?", page, next, .required = true, .zero_is_none = true,
              .doc = "The cursor of the next page."),
};
const api_record api_attribute_values_record = API_RECORD("attribute_values", values_fields);

static void answer_values(api_exchange *x, const page *p)
{
    api_record_write(&x->out, &api_attribute_values_record, p);
    api_answer_json(x, 200);
}

/* Writes the cursor of the page that begins at `id`, and the header Link with it. */
static void find_next(api_exchange *x, uint32_t id, uint64_t limit, char cursor[API_CURSOR])
{
    char path[API_LOCATION];
    api_cursor_write("attribute", &x->info, id, cursor);
    api_attribute_path(x, path);
    api_answer_header_format(x, "Link", "<%s?limit=%llu&cursor=%s>; rel=\"next\"", path,
                             (unsigned long long)limit, cursor);
}

/* Which values of an attribute the client wants. */
typedef struct choice {
    uint64_t from;      /* first id of the page, if `of` is NULL */
    const uint32_t *of; /* the ids whose values the client wants; NULL: it wants a page */
    size_t count;
} choice;

static bool read_page(api_exchange *x, choice *out)
{
    const char *cursor = api_param_text(x, "cursor");
    return cursor == NULL ||
           api_cursor_read(cursor, "attribute", &x->info, &out->from, &x->problem);
}

static void answer_page(api_exchange *x, const he_mesh *mesh, const he_column *column,
                        uint64_t from)
{
    uint64_t limit = api_param_u64(x, "limit", API_DEFAULT_PAGE);
    uint32_t *ids = api_arena_array(&x->arena, limit, sizeof *ids);
    if (ids == NULL) {
        api_fail_memory(x);
        return;
    }
    size_t count = 0;
    uint32_t id = he_mesh_next_live(mesh, x->kind, from);
    for (; count < limit && id != HE_NONE;
         id = he_mesh_next_live(mesh, x->kind, (uint64_t)id + 1)) {
        ids[count++] = id;
    }
    page p = {.revision = x->info.revision,
              .column = api_show_column(mesh, column),
              .ids = ids,
              .count = count};
    if (id != HE_NONE) {
        find_next(x, id, limit, p.next);
    }
    answer_values(x, &p);
}

/* Reads the ids in a parameter such as "1,2,3". The parameter has at most one id for every two
 * bytes. */
static bool read_ids(api_exchange *x, const char *text, choice *out)
{
    uint32_t *ids = api_arena_array(&x->arena, strlen(text) / 2 + 1, sizeof *ids);
    if (ids == NULL) {
        return api_fail_memory(x);
    }
    for (size_t n = 0;; n++) {
        char id[16];
        size_t length = strcspn(text, ",");
        bool good = length < sizeof id;
        if (good) {
            memcpy(id, text, length);
            id[length] = '\0';
            good = api_path_id(id, &ids[n]);
        }
        if (!good) {
            return api_fail(x, API_BAD_PARAMETER,
                            "\"ids\" must be ids separated by commas, not \"%.40s\"", text);
        }
        text += length;
        if (*text++ == '\0') {
            out->of = ids;
            out->count = n + 1;
            return true;
        }
    }
}

/* Reads the ids that the client wants, which must be live. */
static bool read_some(api_exchange *x, const he_mesh *mesh, choice *out)
{
    he_error err = {0};
    if (api_param_text(x, "cursor") != NULL || api_param_text(x, "limit") != NULL) {
        return api_fail(x, API_BAD_PARAMETER, "\"ids\" cannot be combined with cursor and limit");
    }
    if (!read_ids(x, api_param_text(x, "ids"), out)) {
        return false;
    }
    for (size_t i = 0; i < out->count; i++) {
        if (he_mesh_require(mesh, x->kind, out->of[i], &err) != HE_OK) {
            return api_fail_path(x, &err);
        }
    }
    return true;
}

static void answer_some(api_exchange *x, const he_mesh *mesh, const he_column *column,
                        const choice *chosen)
{
    answer_values(x, &(page){.revision = x->info.revision,
                             .column = api_show_column(mesh, column),
                             .ids = chosen->of,
                             .count = chosen->count});
}

/* --- handlers --- */

static bool wants_octets(const api_exchange *x)
{
    return strcmp(x->media_out, "application/octet-stream") == 0;
}

bool api_attribute_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    choice *chosen = api_arena_array(&x->arena, 1, sizeof *chosen);
    if (chosen == NULL) {
        return api_fail_memory(x);
    }
    *chosen = (choice){.from = 0};
    x->state = chosen;
    x->reading.tag = wants_octets(x) ? "octets" : "values";
    if (!wants_octets(x) && api_param_text(x, "type") != NULL) {
        return api_fail(x, API_BAD_PARAMETER,
                        "\"type\" is a parameter for application/octet-stream only");
    }
    const bool some = api_param_text(x, "ids") != NULL;
    const he_column *column = api_attribute_find(x, mesh);
    return column != NULL && (!wants_octets(x) || api_attribute_octets_admit(x, column)) &&
           (some ? read_some(x, mesh, chosen) : read_page(x, chosen)) &&
           api_cost_of_mesh(x, mesh, out);
}

void api_attribute_get(api_exchange *x)
{
    const choice *chosen = x->state;
    const he_column *column = NULL;
    if (wants_octets(x)) {
        api_attribute_octets(x, chosen->of, chosen->count);
    } else if ((column = api_attribute_find(x, x->content)) == NULL) {
        return;
    } else if (chosen->of != NULL) {
        answer_some(x, x->content, column, chosen);
    } else {
        answer_page(x, x->content, column, chosen->from);
    }
}
