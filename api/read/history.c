/* history.c - GET .../edits: what each revision changed. */
#include "api/request/handlers.h"

#include "api/event/change_json.h"
#include "api/read/records.h"

#include <assert.h>
#include <string.h>

/* Writes the names of operations "a,b,..." as a list ["a","b","..."]. */
static void write_ops(api_out *out, const void *ops)
{
    const char *names = ops;
    api_out_array_begin(out);
    while (*names != '\0') {
        size_t length = strcspn(names, ",");
        api_out_string_length(out, names, length);
        names += length + (names[length] == ',');
    }
    api_out_array_end(out);
}

static void write_action(api_out *out, const void *action)
{
    api_out_string(out, api_action_name(*(const st_action *)action));
}

/* Names the items of an array in st_tally, from which the table below writes an object. */
typedef struct counted {
    uint32_t vertices, edges, faces;
} counted;
static_assert(sizeof(counted) == sizeof(((const st_tally *)NULL)->created),
              "three counts without a gap");

static const api_field counted_fields[] = {
    API_FIELD("vertices", "count", counted, vertices, .required = true),
    API_FIELD("edges", "count", counted, edges, .required = true),
    API_FIELD("faces", "count", counted, faces, .required = true),
};
const api_record api_counted_record = API_RECORD("counted", counted_fields);

static const api_field entry_fields[] = {
    API_FIELD("revision", "count", st_entry, revision, .required = true),
    API_FIELD_MADE_OF("action", "#action", st_entry, action, write_action, .required = true),
    API_FIELD(
        "inverts", "count", st_entry, inverts, .zero_is_none = true,
        .doc = "If the entry is an undo or a redo: the revision whose change it undid or redid."),
    API_FIELD("state", "count", st_entry, state, .required = true,
              .doc = "The oldest revision with the same content: the mesh has equal contents at "
                     "revisions of equal state."),
    API_FIELD_MADE_OF("ops", "*text", st_entry, ops, write_ops, .required = true),
    API_FIELD("name", "text", st_entry, name, .zero_is_none = true,
              .doc = "The name that a client gave to this revision, if it has one."),
    API_FIELD_RECORD("created", "#counted", st_entry, tally.created, &api_counted_record,
                     .known = API_KNOWN(st_entry, tally.known),
                     .doc = "How many elements the edit created, if that is known."),
    API_FIELD_RECORD("deleted", "#counted", st_entry, tally.deleted, &api_counted_record,
                     .known = API_KNOWN(st_entry, tally.known)),
    API_FIELD_RECORD("modified", "#counted", st_entry, tally.modified, &api_counted_record,
                     .known = API_KNOWN(st_entry, tally.known)),
    API_FIELD("undoable", "flag", st_entry, undoable, .required = true,
              .doc = "True if the edit can still be undone."),
    API_FIELD("bytes", "count", st_entry, bytes, .required = true,
              .doc = "Bytes of memory that are kept to undo the edit."),
    API_FIELD("time", "time", st_entry, time, .required = true),
};
const api_record api_entry_record = API_RECORD("entry", entry_fields);

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

/* The answer: the values of its members, and the page whose entries it lists. */
typedef struct answer {
    const api_exchange *x;
    const page *page;
    uint64_t revision, undo, redo;
    st_history reach;
    char next[API_CURSOR]; /* "" on the last page */
} answer;

static void write_entries(api_out *out, const void *value)
{
    const answer *a = value;
    st_entry entry;
    uint64_t revision = a->page->first;
    api_out_array_begin(out);
    for (uint64_t i = 0; i < a->page->limit && find_entry(a->x, a->page, revision, &entry); i++) {
        api_record_write(out, &api_entry_record, &entry);
        revision--;
    }
    api_out_array_end(out);
}

static const api_field history_fields[] = {
    API_FIELD("revision", "count", answer, revision, .required = true),
    API_FIELD_MADE("entries", "*#entry", write_entries, .required = true,
                   .doc = "The entries, the newest first."),
    API_FIELD("undo", "count", answer, undo, .required = true,
              .doc = "How many steps can be undone."),
    API_FIELD("redo", "count", answer, redo, .required = true,
              .doc = "How many steps can be redone."),
    API_FIELD("oldest", "count", answer, reach.oldest, .required = true,
              .doc = "The oldest revision that can still be read."),
    API_FIELD("dropped", "count", answer, reach.dropped, .required = true,
              .doc = "How many entries were removed to keep within the undo budget."),
    API_FIELD("bytes", "count", answer, reach.bytes, .required = true,
              .doc = "Memory that the history uses."),
    API_FIELD("budget", "count", answer, reach.budget, .required = true,
              .doc = "Memory that the history may use: the option --undo-budget."),
    API_FIELD("next", "text?", answer, next, .required = true, .zero_is_none = true,
              .doc = "The cursor of the next page."),
};
const api_record api_history_record = API_RECORD("history", history_fields);

/* Writes the cursor of the next page, or "" if there is none. The cursor contains a revision
 * number, so edits that are made between two requests do not change the pages. */
static void find_next(api_exchange *x, const page *p, char next[API_CURSOR])
{
    st_entry entry;
    next[0] = '\0';
    if (p->first <= p->limit || !find_entry(x, p, p->first - p->limit, &entry)) {
        return;
    }
    api_cursor_write("edits", &x->info, p->first - p->limit, next);
    api_answer_header_format(
        x, "Link", "</v1/meshes/%s/edits?limit=%llu&since=%llu&cursor=%s>; rel=\"next\"",
        x->mesh_id, (unsigned long long)p->limit, (unsigned long long)p->last, next);
}

static void write_history(api_exchange *x, const page *p)
{
    answer value = {.x = x,
                    .page = p,
                    .revision = x->info.revision,
                    .undo = x->info.undo,
                    .redo = x->info.redo};
    st_history_reach(x->mesh, &value.reach);
    find_next(x, p, value.next);
    api_record_write(&x->out, &api_history_record, &value);
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
