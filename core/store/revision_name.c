#include "store/revision_name.h"

#include "store/revision_entry.h"

#include <string.h>

/* How many bytes a name of `length` bytes counts against the undo budget. */
static size_t name_bytes(size_t length)
{
    return length == 0 ? 0 : length + 1;
}

static size_t bytes_of(const st_revision *entry)
{
    return entry->name == NULL ? 0 : name_bytes(strlen(entry->name));
}

static bool has_entry(const st_revision_log *log, uint64_t revision)
{
    return revision > log->before.revision && revision <= st_log_head(log);
}

/* Returns how many bytes are freed when the entry is dropped after all entries before it. Its step
 * is freed with it if no later entry applied the step and the step cannot be redone; a step that
 * can be redone keeps its entry without the name. */
static size_t freed_with(const st_revision *entry)
{
    const st_step *step = entry->step;
    if (step == NULL || step->applied != entry->point.revision) {
        return entry->size;
    }
    return step->stack == ST_ON_REDO ? bytes_of(entry) : entry->size + step->charged;
}

st_status st_log_can_name(const st_revision_log *log, uint64_t revision, size_t length)
{
    if (revision > st_log_head(log)) {
        return ST_AHEAD;
    }
    if (!has_entry(log, revision)) {
        return ST_GONE;
    }
    const st_revision *entry = st_entry_of(log, revision);
    uint64_t bytes = log->bytes + name_bytes(length) - bytes_of(entry);
    if (revision == st_log_head(log) || name_bytes(length) <= bytes_of(entry)) {
        return ST_OK;
    }
    for (size_t i = 0; bytes > log->budget; i++) {
        const st_revision *oldest = st_entry_at(log, i);
        if (oldest == entry) {
            return ST_TOO_LARGE;
        }
        bytes -= freed_with(oldest);
    }
    return ST_OK;
}

const char *st_log_name_of(const st_revision_log *log, uint64_t revision)
{
    const char *name = has_entry(log, revision) ? st_entry_of(log, revision)->name : NULL;
    return name == NULL ? "" : name;
}

char *st_log_name_new(const char *name)
{
    const size_t length = strnlen(name, ST_MOMENT_NAME);
    char *copy = he_mem_alloc(length + 1);
    if (copy != NULL) {
        memcpy(copy, name, length);
        copy[length] = '\0';
    }
    return copy;
}

void st_log_unname(st_revision_log *log, st_revision *entry)
{
    const size_t bytes = bytes_of(entry);
    log->bytes -= bytes;
    entry->size -= bytes;
    he_mem_free(entry->name);
    entry->name = NULL;
}

void st_log_name(st_revision_log *log, uint64_t revision, char *takes)
{
    st_revision *entry = st_entry_of(log, revision);
    st_log_unname(log, entry);
    if (takes[0] == '\0') {
        he_mem_free(takes);
        return;
    }
    entry->name = takes;
    entry->size += bytes_of(entry);
    log->bytes += bytes_of(entry);
}
