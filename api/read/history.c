/* history.c - GET .../edits: what each revision changed. */
#include "api/request/handlers.h"

#include "api/event/change_json.h"
#include "api/read/records.h"

#include <string.h>

/* Writes the names of an entry's operations, stored as "a,b,...", as a list ["a","b","..."]. */
static void write_ops(api_out *out, const void *value)
{
    const char *names = ((const st_entry *)value)->ops;
    api_out_array_begin(out);
    while (*names != '\0') {
        size_t length = strcspn(names, ",");
        api_out_string_length(out, names, length);
        names += length + (names[length] == ',');
    }
    api_out_array_end(out);
}

static void write_action(api_out *out, const void *value)
{
    api_out_string(out, api_action_name(((const st_entry *)value)->action));
}

typedef struct counted {
    uint32_t vertices, edges, faces;
} counted;

static const api_field counted_fields[] = {
    API_FIELD("vertices", "count", counted, vertices, .required = true),
    API_FIELD("edges", "count", counted, edges, .required = true),
    API_FIELD("faces", "count", counted, faces, .required = true),
};
const api_record api_counted_record = {"counted", counted_fields,
                                       sizeof counted_fields / sizeof *counted_fields};

static void write_counted(api_out *out, const uint32_t counts[3])
{
    const counted value = {counts[0], counts[1], counts[2]};
    api_record_write(out, &api_counted_record, &value);
}

static void write_created(api_out *out, const void *value)
{
    write_counted(out, ((const st_entry *)value)->tally.created);
}

static void write_deleted(api_out *out, const void *value)
{
    write_counted(out, ((const st_entry *)value)->tally.deleted);
}

static void write_modified(api_out *out, const void *value)
{
    write_counted(out, ((const st_entry *)value)->tally.modified);
}

static const api_field entry_fields[] = {
    API_FIELD("revision", "count", st_entry, revision, .required = true),
    API_FIELD_MADE("action", "#action", write_action, .required = true),
    API_FIELD(
        "inverts", "count", st_entry, inverts, .zero_is_none = true,
        .doc = "If the entry is an undo or a redo: the revision whose change it undid or redid."),
    API_FIELD_MADE("ops", "*text", write_ops, .required = true),
    API_FIELD_MADE("created", "#counted", write_created, .known = API_KNOWN(st_entry, tally.known),
                   .doc = "How many elements the edit created, if that is known."),
    API_FIELD_MADE("deleted", "#counted", write_deleted, .known = API_KNOWN(st_entry, tally.known)),
    API_FIELD_MADE("modified", "#counted", write_modified,
                   .known = API_KNOWN(st_entry, tally.known)),
    API_FIELD("undoable", "flag", st_entry, undoable, .required = true,
              .doc = "True if the edit can still be undone."),
    API_FIELD("bytes", "count", st_entry, bytes, .required = true,
              .doc = "Bytes of memory that are kept to undo the edit."),
    API_FIELD("time", "time", st_entry, time, .required = true),
};
const api_record api_entry_record = {"entry", entry_fields,
                                     sizeof entry_fields / sizeof *entry_fields};

/* A page of the history, newest entry first: at most `limit` entries from revision `first` down to
 * `last` + 1. */
typedef struct page {
    uint64_t first, last, limit;
} page;

/* Finds the entry of a revision. Returns false if the history has none, or if the revision is not
 * after `last` of the page. */
static bool find_entry(const api_exchange *x, const page *p, uint64_t revision, st_entry *out)
{
    return revision > p->last &&
           st_history_entry(x->mesh, (size_t)(x->info.revision - revision), out);
}

/* Writes the entries of the page. Sets `*next` to the revision with which the next page begins, or
 * to 0 if there is none. */
static void write_entries(api_exchange *x, const page *p, uint64_t *next)
{
    st_entry entry;
    uint64_t revision = p->first;
    bool more = find_entry(x, p, revision, &entry);
    api_out_key(&x->out, "entries");
    api_out_array_begin(&x->out);
    for (uint64_t i = 0; more && i < p->limit; i++) {
        api_record_write(&x->out, &api_entry_record, &entry);
        more = find_entry(x, p, --revision, &entry);
    }
    api_out_array_end(&x->out);
    *next = more ? revision : 0;
}

/* Writes the cursor of the next page. It contains a revision number, so edits that are made between
 * two requests do not change the pages. */
static void write_next(api_exchange *x, const page *p, uint64_t next)
{
    char cursor[API_CURSOR];
    api_out_key(&x->out, "next");
    if (next == 0) {
        api_out_null(&x->out);
        return;
    }
    api_cursor_write("edits", &x->info, next, cursor);
    api_out_string(&x->out, cursor);
    api_answer_header_format(
        x, "Link", "</v1/meshes/%s/edits?limit=%llu&since=%llu&cursor=%s>; rel=\"next\"",
        x->mesh_id, (unsigned long long)p->limit, (unsigned long long)p->last, cursor);
}

static void write_history(api_exchange *x, const page *p)
{
    api_out *out = &x->out;
    uint64_t next;
    st_history history;
    st_history_reach(x->mesh, &history);
    api_out_object_begin(out);
    api_out_key_u64(out, "revision", x->info.revision);
    write_entries(x, p, &next);
    api_out_key_u64(out, "undo", x->info.undo);
    api_out_key_u64(out, "redo", x->info.redo);
    api_out_key_u64(out, "oldest", history.oldest);
    api_out_key_u64(out, "dropped", history.dropped);
    api_out_key_u64(out, "bytes", history.bytes);
    api_out_key_u64(out, "budget", history.budget);
    write_next(x, p, next);
    api_out_object_end(out);
}

/* Reads the cursor of a page. Returns false if it is invalid. */
static bool read_cursor(api_exchange *x, const char *cursor, page *p)
{
    st_entry entry;
    p->first = x->info.revision;
    if (cursor == NULL) {
        return true;
    }
    if (!api_cursor_read(cursor, "edits", &x->info, &p->first, &x->problem)) {
        return false;
    }
    if (p->first > x->info.revision) {
        return api_fail(x, API_BAD_CURSOR, "the cursor does not belong to the list of edits");
    }
    return p->first <= p->last || find_entry(x, p, p->first, &entry) ||
           api_fail(x, API_REVISION_GONE, "the history does not reach back to revision %llu",
                    (unsigned long long)p->first);
}

void api_edits_list(api_exchange *x)
{
    page p = {.limit = api_param_u64(x, "limit", API_DEFAULT_PAGE),
              .last = api_param_u64(x, "since", 1)};
    const char *cursor = api_param_text(x, "cursor");
    if (read_cursor(x, cursor, &p) && !api_not_modified(x, "history")) {
        write_history(x, &p);
        api_answer_json(x, 200);
    }
}
