/* Undo, redo, and the list of what each revision did. */
#include "api/handlers.h"

#include "api/changes.h"

#include <string.h>

static const char *const step_members[] = {"expected_revision", NULL};

/* The revision a step makes is one step further in the log, so its changes are those of the delta
 * it applied, seen in the direction it was applied. */
static void write_step(api_exchange *x, const he_mesh *mesh, const he_delta *delta,
                       api_action which)
{
    he_changes changes;
    he_error err = {0};
    bool undone = which == API_UNDO;
    if (he_changes_find(mesh, delta, 0, delta->count, undone, &changes, &err) != HE_OK) {
        api_fail_core(x, &err);
        return;
    }
    api_out *out = &x->out;
    api_out_object_begin(out);
    api_out_key_u64(out, "revision", x->info.revision);
    api_out_key(out, "results");
    api_out_array_begin(out);
    api_out_array_end(out);
    api_write_changes(out, &changes);
    api_out_key_u64(out, "undo", x->info.undo);
    api_out_key_u64(out, "redo", x->info.redo);
    api_out_object_end(out);
    he_changes_clear(&changes);
}

static void step(api_exchange *x, api_action which)
{
    const api_store *store = x->store;
    api_in expected;
    bool has_expected = false;
    if (x->has_root) {
        if (!api_in_only(&x->root, step_members)) {
            return;
        }
        has_expected = api_in_find(&x->root, "expected_revision", &expected);
    }
    const he_delta *delta = NULL;
    he_delta *recording;
    he_mesh *mesh = api_write_begin(x, has_expected ? &expected : NULL, &recording);
    if (mesh == NULL) {
        return;
    }
    api_store_status status = store->step(store->self, x->mesh, which, 1, &delta, &x->info);
    if (status == API_STORE_NOTHING) {
        api_fail(x, which == API_UNDO ? API_NOTHING_TO_UNDO : API_NOTHING_TO_REDO,
                 "no edit is left to %s at revision %llu", which == API_UNDO ? "undo" : "do again",
                 (unsigned long long)x->info.revision);
    } else if (status != API_STORE_OK) {
        api_fail_store(x, status);
    } else {
        api_publish(x, 204);
        write_step(x, mesh, delta, which);
    }
    store->write_end(store->self, x->mesh);
    if (x->problem.code != HE_OK) {
        return;
    }
    api_answer_etag(x, "edits");
    if (!api_answer_minimal(x)) {
        api_answer_json(x, 200);
    }
}

void api_undo_post(api_exchange *x)
{
    step(x, API_UNDO);
}

void api_redo_post(api_exchange *x)
{
    step(x, API_REDO);
}

static const char *const actions[] = {
    [API_EDIT] = "edit", [API_UNDO] = "undo", [API_REDO] = "redo", [API_REPLACE] = "replace"};

/* "a,b,..." as ["a","b","..."]. */
static void write_names(api_out *out, const char *names)
{
    api_out_array_begin(out);
    while (*names != '\0') {
        size_t length = strcspn(names, ",");
        api_out_string_length(out, names, length);
        names += length + (names[length] == ',');
    }
    api_out_array_end(out);
}

static void write_entry(api_out *out, const api_entry *entry)
{
    api_out_object_begin(out);
    api_out_key_u64(out, "revision", entry->revision);
    api_out_key_string(out, "action", actions[entry->action]);
    if (entry->inverts != 0) {
        api_out_key_u64(out, "inverts", entry->inverts);
    }
    api_out_key(out, "ops");
    write_names(out, entry->ops);
    api_out_key_bool(out, "undoable", entry->undoable);
    api_out_key_u64(out, "bytes", entry->bytes);
    api_out_key_time(out, "time", entry->time);
    api_out_object_end(out);
}

/* Entries from the `first` newest on; what is after them goes to `*next`, 0 at the end. */
static void write_entries(api_exchange *x, uint64_t first, uint64_t limit, uint64_t *next)
{
    api_entry entry;
    uint64_t i = first;
    bool more = x->store->history(x->store->self, x->mesh, i, &entry);
    api_out_key(&x->out, "entries");
    api_out_array_begin(&x->out);
    for (; more && i < first + limit; i++) {
        write_entry(&x->out, &entry);
        more = x->store->history(x->store->self, x->mesh, i + 1, &entry);
    }
    api_out_array_end(&x->out);
    *next = more ? i : 0;
}

static void write_history(api_exchange *x, uint64_t first, uint64_t limit)
{
    api_out *out = &x->out;
    uint64_t next;
    api_out_object_begin(out);
    api_out_key_u64(out, "revision", x->info.revision);
    write_entries(x, first, limit, &next);
    api_out_key_u64(out, "undo", x->info.undo);
    api_out_key_u64(out, "redo", x->info.redo);
    api_out_key(out, "next");
    if (next != 0) {
        char cursor[API_CURSOR];
        api_cursor_write("edits", &x->info, next, cursor);
        api_out_string(out, cursor);
        api_answer_header_format(x, "Link",
                                 "</v1/meshes/%s/edits?limit=%llu&cursor=%s>; rel=\"next\"",
                                 x->mesh_id, (unsigned long long)limit, cursor);
    } else {
        api_out_null(out);
    }
    api_out_object_end(out);
}

void api_edits_list(api_exchange *x)
{
    uint64_t first = 0, limit = api_param_u64(x, "limit", API_DEFAULT_PAGE);
    const char *cursor = api_param_text(x, "cursor");
    if (api_read_begin(x) == NULL) {
        return;
    }
    if ((cursor == NULL || api_cursor_read(cursor, "edits", &x->info, &first, &x->problem)) &&
        !api_not_modified(x, "history")) {
        write_history(x, first, limit);
        api_answer_json(x, 200);
    }
    api_read_end(x);
}
