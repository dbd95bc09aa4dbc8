/* attribute_write.c - PUT, PATCH and DELETE .../attributes/{domain}/{name}, which are edits of a
 * mesh. */
#include "api/request/handlers.h"

#include "api/request/gate.h"

#include "api/document/attribute_path.h"
#include "api/event/change_json.h"
#include "api/json/attribute_value.h"
#include "api/write/element_set.h"
#include "edit/whole/attribute.h"

#include <string.h>

/* The state of a request between the decoding of its body and its answer. */
typedef struct writing {
    api_text body; /* the body of a PUT */
    api_document document;
    api_in root, expected;
    bool has_expected, dry_run, octets;
    he_column *column;     /* the new column of a PUT, until the mesh owns it */
    unsigned char *values; /* new values, one row after the other */
    size_t count;
    bool same; /* true if `values` is one value for all elements */
    api_in at; /* cursor at the values, for the JSON pointer of a refusal */
    bool has_at;
    bool effect; /* true if the new values differ from the old ones */
    /* Position of the revision in the answer, where it is filled in after the commit. */
    size_t revision_at;
} writing;

static void free_writing(void *state)
{
    writing *w = state;
    api_text_clear(&w->body);
    api_document_clear(&w->document);
    he_column_free(w->column);
    he_mem_free(w->values);
    he_mem_free(w);
}

static writing *begin(api_exchange *x)
{
    writing *w = he_mem_zero(1, sizeof *w);
    if (w == NULL) {
        api_fail_memory(x);
    } else {
        w->dry_run = api_param_flag(x, "dry_run");
        x->state = w;
        x->free_state = free_writing;
    }
    return w;
}

/* --- ending a write --- */

/* Writes the whole answer before the commit, so that no failure can follow the commit. Only the
 * revision is filled in after it. */
static bool write_answer(api_exchange *x, writing *w)
{
    const he_mesh *mesh = x->write.content;
    const he_column *column = he_mesh_find_column(mesh, x->kind, x->attribute);
    api_out *out = &x->out;
    api_out_object_begin(out);
    api_out_key(out, "revision");
    w->revision_at = api_out_later(out);
    if (w->dry_run) {
        api_out_key_bool(out, "dry_run", true);
    }
    if (column != NULL) {
        api_shown_column shown = api_show_column(mesh, column);
        shown.has_labels = false; /* the client has sent them, and they may be many */
        api_out_key(out, "attribute");
        api_record_write(out, &api_attribute_info_record, &shown);
    }
    api_write_changes(out, &x->write.changes);
    if (w->effect && !st_write_undoable(&x->write)) {
        api_out_key_bool(out, "undoable", false);
    }
    api_out_object_end(out);
    return !x->text.failed || api_fail_memory(x);
}

/* Ends the write that was begun: if `good` is true, commits it and answers; else aborts it. Dry
 * runs, and writes that change nothing, are also aborted and answered. */
static void publish(api_exchange *x, writing *w, const char *op, int status, bool good)
{
    he_error err = {0};
    if (good && st_write_changes(&x->write, &err) != HE_OK) {
        good = api_fail_core(x, &err);
    }
    w->effect = good && !he_changes_none(&x->write.changes);
    good = good && write_answer(x, w);
    bool commits = good && w->effect && !w->dry_run;
    if (!commits) {
        st_write_abort(&x->write);
    }
    if (!good || (commits && !api_write_commit(x, op))) {
        return;
    }
    if (commits) {
        api_publish(x, status == 201 ? 201 : 204);
        api_attribute_path(x, x->location);
    }
    api_out_fill(&x->text, w->revision_at, x->info.revision + (w->dry_run && w->effect ? 1 : 0));
    if (!w->dry_run) {
        api_answer_etag(x, "attribute");
    }
    if (api_answer_minimal(x)) {
        return;
    }
    if (!w->dry_run && status == 201) {
        api_answer_header(x, "Location", x->location);
    }
    api_answer_json(x, w->dry_run ? 200 : status);
}

static const api_in *expected_of(const writing *w)
{
    return w->has_expected ? &w->expected : NULL;
}

static bool may_write(api_exchange *x, const writing *w)
{
    return w->dry_run || api_gate_may_change(x);
}

static he_mesh *write_begin(api_exchange *x, writing *w)
{
    bool begun = may_write(x, w) && api_write_begin(x, expected_of(w));
    return begun ? x->write.content : NULL;
}

/* Refuses values with 422, because they are well formed but do not fit this mesh. */
static bool refuse_values(api_exchange *x, const writing *w, const he_error *err)
{
    api_fail_core(x, err);
    if (err->status == HE_BAD_VALUE) {
        x->problem.status = 422;
    }
    if (w->has_at) {
        api_in_point(&w->at);
    }
    return false;
}

/* --- reading the members that PUT and PATCH share --- */

static bool read_common(writing *w, const api_in *root)
{
    api_in dry;
    w->has_expected = api_in_find(root, "expected_revision", &w->expected);
    return !api_in_find(root, "dry_run", &dry) || api_in_bool(&dry, &w->dry_run);
}

/* Reads the member "values" or "value"; leaves `values` of the state NULL if the body has
 * neither. */
static bool read_values(writing *w, const api_in *root, const he_column *column)
{
    api_in one;
    w->has_at = api_in_find(root, "values", &w->at);
    w->same = api_in_find(root, "value", &one);
    if (w->same && w->has_at) {
        return api_in_fail(&one, API_CONFLICTING_MEMBERS, "give either \"values\" or \"value\"");
    }
    if (w->has_at) {
        return api_read_values(&w->at, column, &w->values, &w->count);
    }
    if (!w->same) {
        return true;
    }
    w->values = he_mem_alloc(column->row_bytes);
    w->count = 1;
    return w->values == NULL ? api_in_fail(&one, HE_NO_MEMORY, "no memory for a value")
                             : api_read_value(&one, column, w->values);
}

/* --- PUT --- */

static uint64_t body_cap(const writing *w)
{
    return w->octets ? API_MAX_ATTRIBUTE_BYTES : (uint64_t)API_MAX_EDITS;
}

static bool refuse_body(api_exchange *x, const writing *w)
{
    return api_fail(x, API_BODY_TOO_LARGE, "the body exceeds %llu bytes%s",
                    (unsigned long long)body_cap(w),
                    w->octets ? "" : "; application/octet-stream may be larger");
}

/* Sets the maximum size of the body. The exact size of a binary body is known before it arrives if
 * the mesh is in memory. */
static void set_maximum(api_exchange *x, writing *w)
{
    uint64_t most = body_cap(w);
    if (w->octets && x->content != NULL) {
        uint64_t rows = he_mesh_issued(x->content, x->kind);
        most = rows * w->column->row_bytes < most ? rows * w->column->row_bytes : most;
    }
    w->body.maximum = (size_t)most + 1;
}

static bool describe_by_query(api_exchange *x, writing *w)
{
    int type = api_param_choice(x, "type"), rule = api_param_choice(x, "rule");
    he_error err = {0};
    if (type < 0) {
        return api_fail(x, API_BAD_PARAMETER,
                        "application/octet-stream needs the parameter \"type\"");
    }
    rule = rule < 0 ? (int)api_default_rule((he_type)type) : rule;
    return he_column_new(&(he_column_schema){x->attribute, x->kind, (he_type)type,
                                             (uint32_t)api_param_u64(x, "components", 1),
                                             (he_rule)rule},
                         &w->column, &err) == HE_OK ||
           api_fail_core(x, &err);
}

void api_attribute_put_begin(api_exchange *x)
{
    writing *w = begin(x);
    if (w == NULL) {
        return;
    }
    size_t length = strlen(x->attribute);
    if (strcmp(x->attribute, API_POSITION) == 0) {
        api_fail(x, API_RESERVED_NAME, "\"%s\" is built in", API_POSITION);
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
    writing *w = x->state;
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

static bool decode_json(api_exchange *x, writing *w)
{
    static const char *const members[] = {
        "type",   "components", "rule",    "default",           "labels",
        "values", "value",      "dry_run", "expected_revision", NULL};
    const api_in_options options = {.values = API_MAX_EDITS_VALUES};
    bool good =
        api_document_parse(api_text_bytes(&w->body), &options, &w->document, &w->root, &x->problem);
    api_text_clear(&w->body);
    return good && api_in_only(&w->root, members) && read_common(w, &w->root) &&
           api_read_column(&w->root, x->kind, x->attribute, &w->column) &&
           read_values(w, &w->root, w->column);
}

static bool decode_octets(api_exchange *x, writing *w)
{
    size_t row = w->column->row_bytes, at = 0;
    he_error err = {0};
    if (w->body.length % row != 0) {
        return api_fail(
            x, HE_BAD_VALUE,
            "the body has %zu bytes, which is not a whole number of values of %zu bytes each",
            w->body.length, row);
    }
    w->count = w->body.length / row;
    if (he_attribute_check(w->column, w->body.bytes, w->count, &at, &err) != HE_OK) {
        return api_fail(x, (int)err.status, "byte %zu: %s", at * he_type_bytes(w->column->type),
                        err.text);
    }
    return true;
}

/* Fills the new column with what the request has: a value for each live element, one value for all
 * elements, all values as binary data, or nothing, which means the default value. */
static bool fill(api_exchange *x, writing *w, const he_mesh *mesh)
{
    he_column *column = w->column;
    uint32_t issued = he_mesh_issued(mesh, x->kind);
    he_error err = {0};
    if ((uint64_t)issued * column->row_bytes > API_MAX_ATTRIBUTE_BYTES) {
        return api_fail(x, HE_LIMIT, "the attribute would have more than %llu bytes",
                        (unsigned long long)API_MAX_ATTRIBUTE_BYTES);
    }
    if (w->octets && w->count != issued) {
        he_fail_plain(
            &err, HE_BAD_VALUE,
            "the body has %zu values, but must have one value for each of the %u ids of %s",
            w->count, issued, he_kind_plural(x->kind));
        return refuse_values(x, w, &err);
    }
    if (w->has_at) {
        return he_attribute_fill(mesh, column, w->values, w->count, &err) == HE_OK ||
               refuse_values(x, w, &err);
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

/* Adds the column to the mesh of the write that was begun, and ends the write. */
static void put(api_exchange *x, writing *w)
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
    publish(x, w, is_new ? "attribute_create" : "attribute_replace", is_new ? 201 : 200, good);
}

/* Adds a large column to a copy of the mesh, under a claim (store/write.h): the mesh is reserved,
 * but not locked, while the change is written to the disk. */
static void put_claimed(api_exchange *x)
{
    he_error err = {0};
    if (!api_write_claim(x, expected_of(x->state))) {
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
static bool is_large(const api_exchange *x, const writing *w)
{
    st_mesh_info info;
    const uint64_t rows = w->octets || w->has_at ? w->count : st_read_card(x->mesh, &info);
    return st_store_stages(x->store, rows * w->column->row_bytes);
}

void api_attribute_put(api_exchange *x)
{
    writing *w = x->state;
    if (!(w->octets ? decode_octets(x, w) : decode_json(x, w)) || !may_write(x, w)) {
        return;
    }
    if (is_large(x, w)) {
        api_defer(x, put_claimed);
    } else if (api_write_begin(x, expected_of(w))) {
        put(x, w);
    }
}

/* --- PATCH --- */

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

static bool patch(api_exchange *x, writing *w, he_mesh *mesh)
{
    const he_column *column = api_attribute_find(x, mesh);
    api_in ids_in;
    uint32_t *ids = NULL;
    size_t count = 0;
    he_error err = {0};
    if (column == NULL || !api_in_need(&x->root, "ids", &ids_in) ||
        !read_ids(x, &ids_in, mesh, &ids, &count) || !read_values(w, &x->root, column)) {
        return false;
    }
    if (w->values == NULL) {
        return api_in_fail(&x->root, API_MISSING_MEMBER, "\"values\" or \"value\" is missing");
    }
    if (!w->same && w->count != count) {
        he_fail_plain(&err, HE_BAD_VALUE, "%zu values are given for %zu ids", w->count, count);
        return refuse_values(x, w, &err);
    }
    if (count > API_MAX_EDITS_ROWS / (column->row_bytes / 4 + 1)) {
        return api_in_fail(&ids_in, HE_LIMIT,
                           "%zu values are too many to be written by ids: PUT the whole attribute",
                           count);
    }
    if (he_attribute_write(mesh, column, ids, count, w->values, w->same, &err) != HE_OK) {
        api_fail_core(x, &err);
        point_at_id(x, &ids_in);
        return false;
    }
    return true;
}

void api_attribute_patch(api_exchange *x)
{
    static const char *const members[] = {"ids", "values", "value", "dry_run", "expected_revision",
                                          NULL};
    writing *w = begin(x);
    if (w == NULL || !api_in_only(&x->root, members) || !read_common(w, &x->root)) {
        return;
    }
    he_mesh *mesh = write_begin(x, w);
    if (mesh != NULL) {
        bool good = patch(x, w, mesh);
        publish(x, w, "attribute_write", 200, good);
    }
}

/* --- DELETE --- */

void api_attribute_delete(api_exchange *x)
{
    writing *w = begin(x);
    he_mesh *mesh = w == NULL ? NULL : write_begin(x, w);
    if (mesh == NULL) {
        return;
    }
    he_error err = {0};
    const he_column *column = api_attribute_find(x, mesh);
    bool good = column != NULL &&
                (he_attribute_drop(mesh, column, &err) == HE_OK || api_fail_core(x, &err));
    publish(x, w, "attribute_delete", 200, good);
}
