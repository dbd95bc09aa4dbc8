/* moment.c - PATCH .../edits/{revision}: gives a revision a name, so that it is found again. */
#include "api/request/handlers.h"

#include "api/event/change_json.h"
#include "api/read/records.h"

#include <string.h>

static const char *const members[] = {"name", NULL};

/* Reads the new name; *out stays NULL if the document has none. By RFC 7396, null removes a member,
 * which takes the name of the revision away. */
static bool read_name(api_exchange *x, const char **out)
{
    api_in member;
    if (!api_in_only(&x->root, members)) {
        return false;
    }
    if (!api_in_find(&x->root, "name", &member)) {
        return true;
    }
    *out = "";
    return api_in_is_null(&member) || api_in_seen_name(&member, ST_MOMENT_NAME, out);
}

static bool refuse(api_exchange *x, st_status status)
{
    const unsigned long long revision = x->revision;
    if (status == ST_AHEAD) {
        return api_fail(x, API_NO_SUCH_REVISION,
                        "the mesh is at revision %llu and has no revision %llu yet",
                        (unsigned long long)x->info.revision, revision);
    }
    if (status == ST_GONE) {
        return api_fail(x, API_REVISION_GONE,
                        "revision %llu cannot have a name: it is the first revision, or it was "
                        "dropped from the history",
                        revision);
    }
    if (status == ST_TOO_LARGE) {
        return api_fail(x, HE_LIMIT,
                        "the undo budget has no room for the name: the history would have to drop "
                        "revision %llu itself",
                        revision);
    }
    return api_fail_store(x, status);
}

/* Finds the entry of the revision. The caller holds the lock of the mesh. */
static bool find_entry(api_exchange *x, st_entry *out)
{
    const uint64_t present = x->info.revision;
    if (x->revision > present) {
        return refuse(x, ST_AHEAD);
    }
    return st_history_entry(x->mesh, (size_t)(present - x->revision), out) || refuse(x, ST_GONE);
}

/* Makes the write name the revision, and writes the answer, before the commit, so that no failure
 * can follow the commit. Returns false with the problem filled. */
static bool prepare(api_exchange *x, const char *name, bool *changes)
{
    st_entry entry;
    if (!find_entry(x, &entry)) {
        return false;
    }
    *changes = name != NULL && strcmp(name, entry.name) != 0;
    if (*changes) {
        const st_status status = st_write_moment(&x->write, x->revision, name);
        if (status != ST_OK) {
            return refuse(x, status);
        }
        st_copy_text(entry.name, name, ST_MOMENT_NAME);
    }
    api_record_write(&x->out, &api_entry_record, &entry);
    return !x->text.failed || api_fail_memory(x);
}

void api_moment_patch(api_exchange *x)
{
    const char *name = NULL;
    bool changes = false;
    if (!read_name(x, &name) || !api_write_begin(x, NULL)) {
        return;
    }
    const bool good = prepare(x, name, &changes);
    if (!good || !changes) {
        st_write_abort(&x->write);
    }
    if (!good || (changes && !api_write_commit(x, NULL))) {
        return;
    }
    api_publish(x, 204);
    api_answer_etag(x, "entry");
    if (!api_answer_minimal(x)) {
        api_answer_json(x, 200);
    }
}
