#include "server/revision_log.h"

#include <assert.h>
#include <string.h>

/* A reserved delta that grew beyond this is freed rather than kept for the next edit. */
enum { SPARE_BYTES = 64 * 1024 };

typedef enum place { NOWHERE, ON_UNDO, ON_REDO } place;

struct srv_step {
    he_delta *delta;
    size_t bytes;
    uint64_t revision; /* of the edit */
    uint64_t applied;  /* of the entry that applied it last */
    uint32_t uses;     /* by entries and a stack */
    place place;
    srv_step *below, *above; /* on its stack */
};

struct srv_revision {
    uint64_t revision, inverts;
    api_action action;
    bool forward; /* the delta was applied forwards */
    size_t delta_bytes;
    size_t size; /* of this block */
    double time;
    srv_step *step; /* NULL: its delta is not kept */
    char ops[];
};

void srv_log_init(srv_revision_log *log, uint64_t budget)
{
    *log = (srv_revision_log){.budget = budget};
}

static srv_revision *entry_at(const srv_revision_log *log, size_t i)
{
    return log->ring[(log->first + i) & (log->capacity - 1)];
}

static void release_step(srv_revision_log *log, srv_step *step)
{
    if (--step->uses == 0) {
        log->bytes -= step->bytes;
        he_delta_free(step->delta);
        he_mem_free(step);
    }
}

static void push_undo(srv_revision_log *log, srv_step *step)
{
    step->place = ON_UNDO;
    step->above = NULL;
    step->below = log->undo_top;
    if (log->undo_top != NULL) {
        log->undo_top->above = step;
    } else {
        log->undo_bottom = step;
    }
    log->undo_top = step;
    log->undo_count++;
}

static void push_redo(srv_revision_log *log, srv_step *step)
{
    step->place = ON_REDO;
    step->above = NULL;
    step->below = log->redo_top;
    log->redo_top = step;
    log->redo_count++;
}

static srv_step *pop_undo(srv_revision_log *log)
{
    srv_step *step = log->undo_top;
    log->undo_top = step->below;
    if (log->undo_top != NULL) {
        log->undo_top->above = NULL;
    } else {
        log->undo_bottom = NULL;
    }
    log->undo_count--;
    step->place = NOWHERE;
    return step;
}

static srv_step *pop_redo(srv_revision_log *log)
{
    srv_step *step = log->redo_top;
    log->redo_top = step->below;
    log->redo_count--;
    step->place = NOWHERE;
    return step;
}

static void forget_delta(srv_revision_log *log, srv_revision *entry)
{
    if (entry->step != NULL) {
        srv_step *step = entry->step;
        entry->step = NULL;
        release_step(log, step);
    }
}

/* A step that can no longer be done again still serves those who follow the log, unless it holds
 * objects (columns, contents): they are large and cannot be replayed from a borrowed delta. */
static void clear_redo(srv_revision_log *log)
{
    while (log->redo_top != NULL) {
        srv_step *step = pop_redo(log);
        if (step->delta->object_count > 0) {
            for (size_t i = log->count; i > 0 && step->uses > 1; i--) {
                if (entry_at(log, i - 1)->step == step) {
                    forget_delta(log, entry_at(log, i - 1));
                }
            }
        }
        release_step(log, step);
    }
}

static void clear_stacks(srv_revision_log *log)
{
    clear_redo(log);
    while (log->undo_top != NULL) {
        release_step(log, pop_undo(log));
    }
}

/* Entries stay as history; what they changed is gone. */
static void forget_deltas(srv_revision_log *log)
{
    clear_stacks(log);
    for (size_t i = 0; i < log->count; i++) {
        forget_delta(log, entry_at(log, i));
    }
}

/* An edit's entry is older than those that undid it or did it again, and edits below it on the
 * undo stack are older still: so the step of the oldest entry, if it is on the undo stack, is at
 * its bottom. On the redo stack it is at the top, and nothing above it can be reached without. */
static void drop_oldest(srv_revision_log *log)
{
    srv_revision *entry = entry_at(log, 0);
    srv_step *step = entry->step;
    if (step != NULL && step->revision == entry->revision) {
        if (step->place == ON_UNDO) {
            assert(step == log->undo_bottom);
            log->undo_bottom = step->above;
            if (step->above != NULL) {
                step->above->below = NULL;
            } else {
                log->undo_top = NULL;
            }
            log->undo_count--;
            step->place = NOWHERE;
            release_step(log, step);
        } else if (step->place == ON_REDO) {
            clear_redo(log);
        }
    }
    forget_delta(log, entry);
    log->bytes -= entry->size;
    he_mem_free(entry);
    log->first = (log->first + 1) & (log->capacity - 1);
    log->count--;
}

void srv_log_settle(srv_revision_log *log)
{
    /* The newest entry stays, whatever the budget: it says what the present revision is. */
    while (log->bytes > log->budget && log->count > 1) {
        drop_oldest(log);
    }
}

static void drop_spare_step(srv_revision_log *log)
{
    if (log->spare_step != NULL) {
        he_delta_free(log->spare_step->delta);
        he_mem_free(log->spare_step);
        log->spare_step = NULL;
    }
}

void srv_log_clear(srv_revision_log *log)
{
    if (log->capacity > 0) {
        forget_deltas(log);
        while (log->count > 0) {
            drop_oldest(log);
        }
    }
    he_mem_free(log->ring);
    he_mem_free(log->spare);
    drop_spare_step(log);
    *log = (srv_revision_log){0};
}

static bool reserve_place(srv_revision_log *log)
{
    if (log->count < log->capacity) {
        return true;
    }
    size_t capacity = log->capacity == 0 ? 8 : 2 * log->capacity;
    srv_revision **ring = he_mem_array(NULL, capacity, sizeof(srv_revision *));
    if (ring == NULL) {
        return false;
    }
    for (size_t i = 0; i < log->count; i++) {
        ring[i] = entry_at(log, i);
    }
    he_mem_free(log->ring);
    log->ring = ring;
    log->capacity = capacity;
    log->first = 0;
    return true;
}

static srv_step *step_new(void)
{
    srv_step *step = he_mem_zero(1, sizeof *step);
    if (step == NULL) {
        return NULL;
    }
    step->delta = he_delta_new();
    if (step->delta == NULL) {
        he_mem_free(step);
        return NULL;
    }
    return step;
}

he_delta *srv_log_reserve(srv_revision_log *log)
{
    if (!reserve_place(log)) {
        return NULL;
    }
    if (log->spare == NULL) {
        log->spare = he_mem_alloc(sizeof *log->spare + API_ENTRY_OPS);
    }
    if (log->spare_step == NULL) {
        log->spare_step = step_new();
    }
    return log->spare == NULL || log->spare_step == NULL ? NULL : log->spare_step->delta;
}

void srv_log_unreserve(srv_revision_log *log)
{
    if (log->spare_step != NULL && he_delta_bytes(log->spare_step->delta) > SPARE_BYTES) {
        drop_spare_step(log);
    }
}

/* Cut at a name's end, so that the reader sees whole names and then "...". */
static void copy_ops(char out[API_ENTRY_OPS], const char *ops)
{
    size_t length = strlen(ops);
    if (length < API_ENTRY_OPS) {
        memcpy(out, ops, length + 1);
        return;
    }
    size_t end = API_ENTRY_OPS - sizeof ",...";
    while (end > 0 && ops[end] != ',') {
        end--;
    }
    memcpy(out, ops, end);
    memcpy(out + end, end == 0 ? "..." : ",...", end == 0 ? sizeof "..." : sizeof ",...");
}

/* The reserved entry becomes the newest one. */
static srv_revision *add_entry(srv_revision_log *log, uint64_t revision, api_action action,
                               const char *ops, double time)
{
    assert(log->spare != NULL && log->count < log->capacity);
    srv_revision *entry = log->spare;
    log->spare = NULL;
    *entry = (srv_revision){
        .revision = revision, .action = action, .forward = action != API_UNDO, .time = time};
    copy_ops(entry->ops, ops);
    entry->size = sizeof *entry + strlen(entry->ops) + 1;
    srv_revision *shrunk = he_mem_resize(entry, entry->size);
    if (shrunk != NULL) {
        entry = shrunk;
    }
    log->ring[(log->first + log->count) & (log->capacity - 1)] = entry;
    log->count++;
    log->bytes += entry->size;
    return entry;
}

void srv_log_add_edit(srv_revision_log *log, uint64_t revision, const char *ops, double time)
{
    srv_revision *entry = add_entry(log, revision, API_EDIT, ops, time);
    srv_step *step = log->spare_step;
    log->spare_step = NULL;
    he_delta_trim(step->delta);
    step->bytes = sizeof *step + he_delta_bytes(step->delta);
    step->revision = revision;
    step->applied = revision;
    entry->delta_bytes = step->bytes;
    clear_redo(log);
    if (step->bytes + entry->size > log->budget) {
        forget_deltas(log);
        he_delta_free(step->delta);
        he_mem_free(step);
    } else {
        step->uses = 2;
        entry->step = step;
        push_undo(log, step);
        log->bytes += step->bytes;
    }
    srv_log_settle(log);
}

void srv_log_add_barrier(srv_revision_log *log, uint64_t revision, api_action action,
                         const char *ops, double time)
{
    srv_revision *entry = add_entry(log, revision, action, ops, time);
    forget_deltas(log);
    if (log->spare_step != NULL) {
        entry->delta_bytes = he_delta_bytes(log->spare_step->delta);
        drop_spare_step(log);
    }
    srv_log_settle(log);
}

he_delta *srv_log_next(const srv_revision_log *log, api_action which)
{
    const srv_step *step = which == API_UNDO ? log->undo_top : log->redo_top;
    return step == NULL ? NULL : step->delta;
}

/* The text an undo shows is that of the edit, where the log still has it. */
static const char *ops_of(const srv_revision_log *log, uint64_t revision)
{
    uint64_t oldest = entry_at(log, 0)->revision;
    return revision < oldest ? "" : entry_at(log, (size_t)(revision - oldest))->ops;
}

void srv_log_add_step(srv_revision_log *log, uint64_t revision, api_action which, double time)
{
    srv_step *step = which == API_UNDO ? pop_undo(log) : pop_redo(log);
    srv_revision *entry = add_entry(log, revision, which, ops_of(log, step->revision), time);
    entry->inverts = step->revision;
    entry->delta_bytes = step->bytes;
    entry->step = step;
    step->uses++;
    step->applied = revision;
    if (which == API_UNDO) {
        push_redo(log, step);
    } else {
        push_undo(log, step);
    }
}

bool srv_log_entry(const srv_revision_log *log, size_t i, api_entry *out)
{
    if (i >= log->count) {
        return false;
    }
    const srv_revision *entry = entry_at(log, log->count - 1 - i);
    *out = (api_entry){
        .revision = entry->revision,
        .inverts = entry->inverts,
        .action = entry->action,
        .undoable = entry->step != NULL && entry->step->place == ON_UNDO &&
                    entry->step->applied == entry->revision,
        .bytes = entry->delta_bytes,
        .time = entry->time,
    };
    memcpy(out->ops, entry->ops, strlen(entry->ops) + 1);
    return true;
}

const he_delta *srv_log_delta(const srv_revision_log *log, uint64_t revision)
{
    uint64_t oldest = log->count == 0 ? UINT64_MAX : entry_at(log, 0)->revision;
    if (revision < oldest || revision - oldest >= log->count) {
        return NULL;
    }
    const srv_step *step = entry_at(log, (size_t)(revision - oldest))->step;
    return step == NULL ? NULL : step->delta;
}

he_status srv_log_replay(const srv_revision_log *log, uint64_t from, size_t most, he_mesh *copy,
                         const uint32_t issued[HE_KIND_COUNT])
{
    if (log->count == 0 || from + 1 < entry_at(log, 0)->revision) {
        return HE_UNSUPPORTED;
    }
    size_t start = (size_t)(from + 1 - entry_at(log, 0)->revision);
    size_t cost = 0;
    for (size_t i = start; i < log->count; i++) {
        const srv_step *step = entry_at(log, i)->step;
        if (step == NULL || step->delta->object_count > 0) {
            return HE_UNSUPPORTED;
        }
        cost += step->bytes;
        if (cost > most) {
            return HE_UNSUPPORTED;
        }
    }
    for (size_t i = start; i < log->count; i++) {
        const srv_revision *entry = entry_at(log, i);
        he_status status = he_delta_replay(entry->step->delta, copy, issued, !entry->forward, NULL);
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}
