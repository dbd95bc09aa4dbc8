#include "api/write/attribute_write.h"

#include "api/request/gate.h"
#include "api/request/handlers.h"

#include "api/document/attribute_path.h"
#include "api/event/change_json.h"
#include "api/json/attribute_value.h"

#include <string.h>

static void free_writing(void *state)
{
    api_writing *w = state;
    api_text_clear(&w->body);
    api_document_clear(&w->document);
    he_column_free(w->column);
    he_mem_free(w->values);
    he_mem_free(w);
}

api_writing *api_writing_begin(api_exchange *x)
{
    api_writing *w = he_mem_zero(1, sizeof *w);
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
 * revision is filled in after it. A client that prefers no body gets none, so it is not written. */
static bool write_answer(api_exchange *x, api_writing *w)
{
    const he_mesh *mesh = x->write.content;
    const he_column *column = he_mesh_find_column(mesh, x->kind, x->attribute);
    he_column positions;
    if (api_attribute_is_position(x)) {
        he_mesh_position_column(mesh, &positions);
        column = &positions;
    }
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

void api_writing_publish(api_exchange *x, api_writing *w, const char *op, int status, bool good)
{
    he_error err = {0};
    if (good && st_write_changes(&x->write, &err) != HE_OK) {
        good = api_fail_core(x, &err);
    }
    w->effect = good && !he_changes_none(&x->write.changes);
    good = good && (x->prefer.minimal || write_answer(x, w));
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
    if (!w->dry_run) {
        api_answer_etag(x, "attribute");
    }
    if (api_answer_minimal(x)) {
        return;
    }
    api_out_fill(&x->text, w->revision_at, x->info.revision + (w->dry_run && w->effect ? 1 : 0));
    if (!w->dry_run && status == 201) {
        api_answer_header(x, "Location", x->location);
    }
    api_answer_json(x, w->dry_run ? 200 : status);
}

const api_in *api_writing_expected(const api_writing *w)
{
    return w->has_expected ? &w->expected : NULL;
}

bool api_writing_may(api_exchange *x, const api_writing *w)
{
    return w->dry_run || api_gate_may_change(x);
}

he_mesh *api_writing_mesh(api_exchange *x, api_writing *w)
{
    bool begun = api_writing_may(x, w) && api_write_begin(x, api_writing_expected(w));
    return begun ? x->write.content : NULL;
}

bool api_writing_refuse(api_exchange *x, const api_writing *w, const he_error *err)
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

bool api_writing_read_common(api_writing *w, const api_in *root)
{
    api_in dry;
    w->has_expected = api_in_find(root, "expected_revision", &w->expected);
    return !api_in_find(root, "dry_run", &dry) || api_in_bool(&dry, &w->dry_run);
}

bool api_writing_read_values(api_writing *w, const api_in *root, const he_column *column)
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

/* --- reading values as binary data --- */

bool api_writing_check_octets(api_exchange *x, const he_column *column, const void *values,
                              size_t count, size_t offset)
{
    size_t at = 0;
    he_error err = {0};
    if (he_attribute_check(column, values, count, &at, &err) != HE_OK) {
        return api_fail(x, (int)err.status, "byte %zu: %s",
                        offset + at * he_type_bytes(column->type), err.text);
    }
    return true;
}

const void *api_writing_convert(api_exchange *x, he_type from, const void *values, size_t count,
                                he_type to)
{
    const unsigned char *bytes = values;
    if (from == to && (uintptr_t)bytes % sizeof(double) == 0) {
        return values;
    }
    unsigned char *out = api_arena_array(&x->arena, count, he_type_bytes(to));
    if (out == NULL) {
        api_fail_memory(x);
        return NULL;
    }
    if (from == to) {
        memcpy(out, bytes, count * he_type_bytes(to));
    }
    for (size_t i = 0; i < count && from != to; i++) {
        float narrow;
        double wide;
        if (from == HE_FLOAT) {
            memcpy(&narrow, bytes + i * sizeof narrow, sizeof narrow);
            wide = narrow;
            memcpy(out + i * sizeof wide, &wide, sizeof wide);
        } else {
            memcpy(&wide, bytes + i * sizeof wide, sizeof wide);
            narrow = (float)wide;
            memcpy(out + i * sizeof narrow, &narrow, sizeof narrow);
        }
    }
    return out;
}

/* --- DELETE --- */

void api_attribute_delete(api_exchange *x)
{
    api_writing *w = api_writing_begin(x);
    if (w != NULL && api_attribute_is_position(x)) {
        api_fail(x, API_RESERVED_NAME, "the positions of vertices cannot be deleted");
        return;
    }
    he_mesh *mesh = w == NULL ? NULL : api_writing_mesh(x, w);
    if (mesh == NULL) {
        return;
    }
    he_error err = {0};
    const he_column *column = api_attribute_find(x, mesh);
    bool good = column != NULL &&
                (he_attribute_drop(mesh, column, &err) == HE_OK || api_fail_core(x, &err));
    api_writing_publish(x, w, "attribute_delete", 200, good);
}
