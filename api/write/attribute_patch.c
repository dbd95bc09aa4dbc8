/* attribute_patch.c - PATCH .../attributes/{domain}/{name}: writes values by ids, or the
 * positions of vertices. */
#include "api/request/handlers.h"

#include "api/document/attribute_path.h"
#include "api/header/media.h"
#include "api/json/attribute_value.h"
#include "api/write/attribute_write.h"
#include "api/write/element_set.h"
#include "edit/whole/positions.h"

#include <string.h>

/* Reads the ids that a request names. `*ids` is set to NULL if it names all live elements. */
static bool read_ids(api_exchange *x, const api_in *in, const he_mesh *mesh, uint32_t **ids,
                     size_t *count)
{
    static const char *const all[] = {"all", NULL};
    int choice;
    if (api_in_is_string(in)) {
        *ids = NULL;
        *count = he_mesh_count(mesh, x->kind);
        return api_in_choice(in, all, &choice);
    }
    if (api_in_is_object(in)) {
        return api_find_set(in, mesh, x->kind, &x->arena, ids, count);
    }
    return api_in_ids(in, 1, &x->arena, ids, count);
}

/* Sets the JSON pointer of a refusal to the last item of the list `ids` that names the refused
 * element. */
static void point_at_id(const api_exchange *x, const api_in *ids)
{
    api_in child, found;
    uint32_t id;
    bool any = false;
    if (!x->problem.has_element || !api_in_is_array(ids)) {
        return;
    }
    for (bool more = api_in_first(ids, &child); more; more = api_in_next(&child)) {
        if (api_in_id(&child, &id) && id == x->problem.id) {
            found = child;
            any = true;
        }
    }
    if (any) {
        api_in_point(&found);
    }
}

/* The values of a PATCH, decoded for the mesh that they are written to. */
typedef struct change {
    uint32_t *ids; /* NULL: all live elements */
    size_t count;
    const void *values; /* of the column's type */
    bool same;
} change;

/* Lists all live vertices, so that their positions can be written in the order of ids. */
static bool list_all(api_exchange *x, const he_mesh *mesh, change *c)
{
    c->ids = api_arena_array(&x->arena, c->count, sizeof *c->ids);
    if (c->ids == NULL) {
        return api_fail_memory(x);
    }
    uint32_t id = he_mesh_next_live(mesh, x->kind, 0);
    for (size_t i = 0; i < c->count; i++, id = he_mesh_next_live(mesh, x->kind, (uint64_t)id + 1)) {
        c->ids[i] = id;
    }
    return true;
}

static he_status write_values(he_mesh *mesh, const he_column *column, bool position,
                              const change *c, he_error *err)
{
    return position ? he_positions_write(mesh, c->ids, c->count, c->values, c->same, err)
                    : he_attribute_write(mesh, column, c->ids, c->count, c->values, c->same, err);
}

static bool is_too_much(const change *c, const he_column *column)
{
    return c->count > API_MAX_EDITS_ROWS / (column->row_bytes / 4 + 1);
}

/* --- JSON --- */

static bool patch(api_exchange *x, api_writing *w, he_mesh *mesh)
{
    const he_column *column = api_attribute_find(x, mesh);
    const bool position = api_attribute_is_position(x);
    api_in ids_in;
    change c = {.ids = NULL};
    he_error err = {0};
    if (column == NULL || !api_in_need(&x->root, "ids", &ids_in) ||
        !read_ids(x, &ids_in, mesh, &c.ids, &c.count) ||
        !api_writing_read_values(w, &x->root, column)) {
        return false;
    }
    if (w->values == NULL) {
        return api_in_fail(&x->root, API_MISSING_MEMBER, "\"values\" or \"value\" is missing");
    }
    if (!w->same && w->count != c.count) {
        he_fail_plain(&err, HE_BAD_VALUE, "%zu values are given for %zu ids", w->count, c.count);
        return api_writing_refuse(x, w, &err);
    }
    if (is_too_much(&c, column)) {
        return api_in_fail(&ids_in, HE_LIMIT,
                           "%zu values are too many to be written by ids: PUT the whole attribute",
                           c.count);
    }
    c.values = w->values;
    c.same = w->same;
    if (position && c.ids == NULL && !list_all(x, mesh, &c)) {
        return false;
    }
    if (write_values(mesh, column, position, &c, &err) != HE_OK) {
        api_fail_core(x, &err);
        point_at_id(x, &ids_in);
        return false;
    }
    return true;
}

/* --- binary data: all ids, and then all values --- */

static bool read_octets(api_exchange *x, const he_column *column, change *out)
{
    const char *bytes = x->body.bytes;
    const int choice = api_param_choice(x, "type");
    const he_type type = choice < 0 ? column->type : (he_type)choice;
    const bool real = (type == HE_FLOAT || type == HE_DOUBLE) &&
                      (column->type == HE_FLOAT || column->type == HE_DOUBLE);
    if (type != column->type && !real) {
        return api_fail(x, API_BAD_PARAMETER,
                        "the values are of the type %s, and are not read from %s",
                        he_type_name(column->type), he_type_name(type));
    }
    /* A column with the type of the numbers in the body, by which they are checked. */
    he_column sent = *column;
    sent.type = type;
    sent.row_bytes = sent.components * (uint32_t)he_type_bytes(type);
    const size_t item = sizeof(uint32_t) + sent.row_bytes;
    if (x->body.length % item != 0) {
        return api_fail(x, HE_BAD_VALUE,
                        "the body has %zu bytes, which is not a whole number of ids of 4 bytes and "
                        "values of %u bytes",
                        x->body.length, sent.row_bytes);
    }
    out->count = x->body.length / item;
    out->ids = api_arena_array(&x->arena, out->count, sizeof *out->ids);
    if (out->ids == NULL) {
        return api_fail_memory(x);
    }
    memcpy(out->ids, bytes, out->count * sizeof *out->ids);
    const char *values = bytes + out->count * sizeof *out->ids;
    if (!api_writing_check_octets(x, &sent, values, out->count, (size_t)(values - bytes))) {
        return false;
    }
    out->values =
        api_writing_convert(x, type, values, out->count * column->components, column->type);
    if (out->values == NULL) {
        return false;
    }
    if (type == HE_DOUBLE && column->type == HE_FLOAT) {
        /* a double beyond the range of floats has become an infinity */
        return api_writing_check_octets(x, column, out->values, out->count,
                                        (size_t)(values - bytes));
    }
    return true;
}

static bool patch_octets(api_exchange *x, he_mesh *mesh)
{
    const he_column *column = api_attribute_find(x, mesh);
    change c = {.ids = NULL};
    he_error err = {0};
    if (column == NULL || !read_octets(x, column, &c)) {
        return false;
    }
    return write_values(mesh, column, api_attribute_is_position(x), &c, &err) == HE_OK ||
           api_fail_core(x, &err);
}

/* --- the handler --- */

static bool check_query(api_exchange *x, bool octets)
{
    return octets || x->query.count == 0 ||
           api_fail(x, API_BAD_PARAMETER, "\"%s\" is a parameter for application/octet-stream only",
                    x->query.pairs[0].name);
}

void api_attribute_patch(api_exchange *x)
{
    static const char *const members[] = {"ids", "values", "value", "dry_run", "expected_revision",
                                          NULL};
    const bool octets = api_media_is(x->media_in, "application/octet-stream");
    api_writing *w = api_writing_begin(x);
    if (w == NULL || !check_query(x, octets) ||
        (!octets && (!api_in_only(&x->root, members) || !api_writing_read_common(w, &x->root)))) {
        return;
    }
    he_mesh *mesh = api_writing_mesh(x, w);
    if (mesh != NULL) {
        bool good = octets ? patch_octets(x, mesh) : patch(x, w, mesh);
        api_writing_publish(x, w, "attribute_write", 200, good);
    }
}
