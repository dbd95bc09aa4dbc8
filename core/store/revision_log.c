#include "store/revision_log.h"

#include "store/revision_entry.h"
#include "store/revision_name.h"

#include <assert.h>
#include <string.h>

/* If the memory that was reserved for recording an edit grows beyond SPARE_BYTES, it is freed
 * instead of used again for the next edit. */
enum { SPARE_BYTES = 64 * 1024 };

/* A ring with more than FEWEST_PLACES places is shrunk when less than a quarter of it is used. */
enum { FEWEST_PLACES = 8 };

static void note_marks(st_point *point, const he_mesh *content)
{
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        point->issued[kind] = he_mesh_issued(content, (he_kind)kind);
    }
}

void st_log_init(st_revision_log *log, uint64_t budget, const st_point *begin,
                 const he_mesh *content)
{
    *log = (st_revision_log){.budget = budget,
                             .dropped = begin->revision - 1,
                             .before = *begin,
                             .oldest = begin->revision,
                             .bottom = begin->state};
    note_marks(&log->before, content);
}

static void free_entry(st_revision *entry)
{
    he_mem_free(entry->name);
    he_mem_free(entry);
}

static void release_step(st_revision_log *log, st_step *step)
{
    if (--step->uses == 0) {
        log->bytes -= step->charged;
        st_step_release(step);
    }
}

static bool move_ring(st_revision_log *log, size_t capacity)
{
    st_revision **ring = he_mem_array(NULL, capacity, sizeof(st_revision *));
    if (ring == NULL) {
        return false;
    }
    for (size_t i = 0; i < log->count; i++) {
        ring[i] = st_entry_at(log, i);
    }
    he_mem_free(log->ring);
    log->ring = ring;
    log->capacity = capacity;
    log->first = 0;
    return true;
}

static bool reserve_places(st_revision_log *log, size_t more)
{
    size_t capacity = log->capacity == 0 ? FEWEST_PLACES : log->capacity;
    while (capacity < log->count + more) {
        capacity *= 2;
    }
    return capacity == log->capacity || move_ring(log, capacity);
}

static void push_undo(st_revision_log *log, st_step *step)
{
    step->stack = ST_ON_UNDO;
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

static void push_redo(st_revision_log *log, st_step *step)
{
    step->stack = ST_ON_REDO;
    step->above = NULL;
    step->below = log->redo_top;
    log->redo_top = step;
    log->redo_count++;
}

static st_step *pop_undo(st_revision_log *log)
{
    st_step *step = log->undo_top;
    log->undo_top = step->below;
    if (log->undo_top != NULL) {
        log->undo_top->above = NULL;
    } else {
        log->undo_bottom = NULL;
    }
    log->undo_count--;
    step->stack = ST_ON_NEITHER;
    return step;
}

static st_step *pop_redo(st_revision_log *log)
{
    st_step *step = log->redo_top;
    log->redo_top = step->below;
    log->redo_count--;
    step->stack = ST_ON_NEITHER;
    if (step->kept != NULL) {
        log->bytes -= step->kept->size;
        free_entry(step->kept);
        step->kept = NULL;
    }
    return step;
}

static void charge(st_revision_log *log, st_step *step, size_t bytes)
{
    log->bytes += bytes;
    log->bytes -= step->charged;
    step->charged = bytes;
}

static void forget_delta(st_revision_log *log, st_revision *entry)
{
    if (entry->step != NULL) {
        st_step *step = entry->step;
        entry->step = NULL;
        release_step(log, step);
    }
}

/* Empties the redo stack. A step (the delta of one change) stays in memory as long as an entry of
 * the log uses it, so copies of the mesh can still be moved from revision to revision. */
static void clear_redo(st_revision_log *log)
{
    while (log->redo_top != NULL) {
        st_step *step = pop_redo(log);
        charge(log, step, step->bytes);
        release_step(log, step);
    }
}

static void clear_stacks(st_revision_log *log)
{
    clear_redo(log);
    while (log->undo_top != NULL) {
        release_step(log, pop_undo(log));
    }
}

/* Frees the deltas (recorded changes) of all entries. The entries stay in the history, but only the
 * newest revision can then be read. */
static void forget_deltas(st_revision_log *log)
{
    clear_stacks(log);
    for (size_t i = 0; i < log->count; i++) {
        forget_delta(log, st_entry_at(log, i));
    }
    if (log->count > 0) {
        const st_point *newest = &st_entry_at(log, log->count - 1)->point;
        log->oldest = newest->revision;
        log->bottom = newest->state;
    }
}

static void drop_undo_bottom(st_revision_log *log)
{
    st_step *step = log->undo_bottom;
    log->bottom = step->revision;
    log->undo_bottom = step->above;
    if (step->above != NULL) {
        step->above->below = NULL;
    } else {
        log->undo_top = NULL;
    }
    log->undo_count--;
    step->stack = ST_ON_NEITHER;
    release_step(log, step);
}

/* Drops the oldest entry of the log. If this entry was the last to apply its step (the delta of one
 * change) and the step is on the undo stack, the step is at the bottom of the stack, because steps
 * lie on it in the order in which they were last applied. */
static void drop_oldest(st_revision_log *log)
{
    st_revision *entry = st_entry_at(log, 0);
    st_step *step = entry->step;
    bool last = step != NULL && step->applied == entry->point.revision;
    bool keeps = last && step->stack == ST_ON_REDO;
    if (last && step->stack == ST_ON_UNDO) {
        assert(step == log->undo_bottom);
        drop_undo_bottom(log);
    }
    forget_delta(log, entry);
    log->before = entry->point;
    if (log->oldest < entry->point.revision) {
        log->oldest = entry->point.revision;
    }
    if (keeps) {
        st_log_unname(log, entry);
        step->kept = entry;
    } else {
        log->bytes -= entry->size;
        free_entry(entry);
    }
    log->first = (log->first + 1) & (log->capacity - 1);
    log->count--;
    log->dropped++;
}

/* Shrinks the ring of entries if it is mostly empty and there is memory for a smaller ring. */
static void shrink_ring(st_revision_log *log)
{
    if (log->capacity > FEWEST_PLACES && log->count < log->capacity / 4) {
        (void)move_ring(log, log->capacity / 2);
    }
}

void st_log_drop(st_revision_log *log, uint64_t reach)
{
    while (log->before.revision < reach && log->count > 0) {
        drop_oldest(log);
    }
    shrink_ring(log);
}

void st_log_settle(st_revision_log *log)
{
    /* The newest entry stays, even if it exceeds the budget, because it describes the present
     * revision. */
    while (log->bytes > log->budget && log->count > 1) {
        drop_oldest(log);
    }
    shrink_ring(log);
}

void st_log_limit(st_revision_log *log, uint64_t budget)
{
    log->budget = budget;
    if (log->bytes / 2 <= budget) {
        return;
    }
    st_log_settle(log);
    if (log->bytes > budget) {
        /* Only the newest entry is left, but steps on the redo stack still use too many bytes. So
         * all deltas and both stacks are dropped. */
        forget_deltas(log);
    }
}

static void drop_spare_step(st_revision_log *log)
{
    if (log->spare_step != NULL) {
        he_delta_free(log->spare_step->delta);
        he_mem_free(log->spare_step);
        log->spare_step = NULL;
    }
}

void st_log_unreserve_steps(st_revision_log *log)
{
    while (log->steps != NULL) {
        st_revision *entry = log->steps;
        log->steps = entry->next;
        he_mem_free(entry);
    }
}

void st_log_clear(st_revision_log *log)
{
    if (log->capacity > 0) {
        forget_deltas(log);
        while (log->count > 0) {
            drop_oldest(log);
        }
    }
    he_mem_free(log->ring);
    he_mem_free(log->spare);
    st_log_unreserve_steps(log);
    drop_spare_step(log);
    *log = (st_revision_log){0};
}

static st_step *step_new(void)
{
    st_step *step = he_mem_zero(1, sizeof *step);
    if (step == NULL) {
        return NULL;
    }
    step->delta = he_delta_new();
    if (step->delta == NULL) {
        he_mem_free(step);
        return NULL;
    }
    atomic_init(&step->holders, 1);
    return step;
}

he_delta *st_log_reserve(st_revision_log *log)
{
    if (!reserve_places(log, 1)) {
        return NULL;
    }
    if (log->spare == NULL) {
        log->spare = he_mem_alloc(sizeof *log->spare + ST_ENTRY_OPS);
    }
    if (log->spare_step == NULL) {
        log->spare_step = step_new();
    }
    return log->spare == NULL || log->spare_step == NULL ? NULL : log->spare_step->delta;
}

void st_log_lend(st_revision_log *log, he_delta *takes)
{
    he_delta_free(log->spare_step->delta);
    log->spare_step->delta = takes;
}

void st_log_unreserve(st_revision_log *log)
{
    if (log->spare_step != NULL && he_delta_bytes(log->spare_step->delta) > SPARE_BYTES) {
        drop_spare_step(log);
    }
}

/* Returns how many bytes the recorded edit would take in the log. */
static size_t spare_bytes(const st_revision_log *log)
{
    const he_delta *delta = log->spare_step->delta;
    size_t slack = (delta->capacity - delta->count) * sizeof *delta->records;
    return sizeof *log->spare_step + he_delta_bytes(delta) - slack;
}

static size_t entry_size(size_t ops)
{
    /* A ring that has just grown is half empty, so two pointers are counted for an entry. */
    return sizeof(st_revision) + ops + 1 + 2 * sizeof(st_revision *);
}

bool st_log_fits(const st_revision_log *log)
{
    return spare_bytes(log) + entry_size(ST_ENTRY_OPS) <= log->budget;
}

/* Copies a list of names of operations. A list that is too long is cut after a whole name and ends
 * with "...". */
static void copy_ops(char out[ST_ENTRY_OPS], const char *ops)
{
    size_t length = strlen(ops);
    if (length < ST_ENTRY_OPS) {
        memcpy(out, ops, length + 1);
        return;
    }
    size_t end = ST_ENTRY_OPS - sizeof ",...";
    while (end > 0 && ops[end] != ',') {
        end--;
    }
    memcpy(out, ops, end);
    memcpy(out + end, end == 0 ? "..." : ",...", end == 0 ? sizeof "..." : sizeof ",...");
}

/* Adds an entry to the log's ring as the newest entry. */
static void add_entry(st_revision_log *log, st_revision *entry)
{
    assert(log->count < log->capacity && entry->point.revision == st_log_head(log) + 1);
    log->ring[(log->first + log->count) & (log->capacity - 1)] = entry;
    log->count++;
    log->bytes += entry->size;
}

/* Adds the reserved entry for a change that is neither undo nor redo, so that the mesh is in a
 * state in which it never was before. */
static st_revision *add_spare(st_revision_log *log, const st_logged *change, const he_mesh *content)
{
    st_revision *entry = log->spare;
    assert(entry != NULL);
    log->spare = NULL;
    *entry = (st_revision){.action = change->action, .forward = true};
    entry->point =
        (st_point){.revision = change->revision, .state = change->revision, .time = change->time};
    note_marks(&entry->point, content);
    copy_ops(entry->ops, change->ops);
    entry->size = entry_size(strlen(entry->ops));
    entry = he_mem_shrink(entry, sizeof *entry + strlen(entry->ops) + 1);
    add_entry(log, entry);
    return entry;
}

st_step *st_log_hold_reserved(const st_revision_log *log)
{
    atomic_fetch_add_explicit(&log->spare_step->holders, 1, memory_order_relaxed);
    return log->spare_step;
}

void st_log_add_edit(st_revision_log *log, const st_logged *edit, const he_mesh *content)
{
    bool fits = st_log_fits(log);
    st_revision *entry = add_spare(log, edit, content);
    entry->tally = *edit->tally;
    st_step *step = log->spare_step;
    log->spare_step = NULL;
    he_delta_trim(step->delta);
    step->bytes = sizeof *step + he_delta_bytes(step->delta);
    step->charged = step->bytes;
    step->revision = edit->revision;
    step->applied = edit->revision;
    entry->delta_bytes = step->bytes;
    clear_redo(log);
    if (!fits) {
        forget_deltas(log);
        st_step_release(step);
    } else {
        step->uses = 2;
        entry->step = step;
        push_undo(log, step);
        log->bytes += step->charged;
    }
    st_log_settle(log);
    /* If memory was too short to trim the delta, it takes more bytes than st_log_fits has counted,
     * and may exceed the budget. */
    if (log->bytes > log->budget) {
        forget_deltas(log);
    }
}

void st_log_add_barrier(st_revision_log *log, const st_logged *change, const he_mesh *content)
{
    size_t bytes = spare_bytes(log);
    st_revision *entry = add_spare(log, change, content);
    entry->delta_bytes = bytes;
    drop_spare_step(log);
    if (change->tally != NULL) {
        entry->tally = *change->tally;
    }
    forget_deltas(log);
    st_log_settle(log);
}

void st_log_deltas(const st_revision_log *log, st_action which, uint32_t steps, he_delta **out)
{
    const st_step *step = which == ST_UNDO ? log->undo_top : log->redo_top;
    for (uint32_t i = 0; i < steps; i++, step = step->below) {
        out[i] = step->delta;
    }
}

/* Swaps the numbers of created and deleted elements, because an undo creates the elements that the
 * edit deleted. */
static void turn_tally(st_tally *tally)
{
    st_tally before = *tally;
    memcpy(tally->created, before.deleted, sizeof tally->created);
    memcpy(tally->deleted, before.created, sizeof tally->deleted);
}

/* Makes an entry for the undo or redo of a step (the delta of one change). The entry that applied
 * the step last still exists; the new entry copies the names of its operations, and its counts with
 * created and deleted exchanged. */
static st_revision *step_entry(const st_revision_log *log, const st_step *step)
{
    const st_revision *last = step->kept != NULL ? step->kept : st_entry_of(log, step->applied);
    size_t length = strlen(last->ops);
    st_revision *entry = he_mem_alloc(sizeof *entry + length + 1);
    if (entry == NULL) {
        return NULL;
    }
    *entry = (st_revision){.inverts = step->revision, .size = entry_size(length)};
    entry->tally = last->tally;
    turn_tally(&entry->tally);
    memcpy(entry->ops, last->ops, length + 1);
    return entry;
}

bool st_log_reserve_steps(st_revision_log *log, st_action which, uint32_t steps,
                          const he_mesh *content)
{
    assert(log->steps == NULL);
    st_revision **end = &log->steps;
    const st_step *step = which == ST_UNDO ? log->undo_top : log->redo_top;
    bool reserved = reserve_places(log, steps);
    for (uint32_t i = 0; i < steps && reserved; i++, step = step->below) {
        *end = step_entry(log, step);
        reserved = *end != NULL && he_delta_ready(step->delta, content, NULL) == HE_OK;
        end = *end != NULL ? &(*end)->next : end;
    }
    if (!reserved) {
        st_log_unreserve_steps(log);
    }
    return reserved;
}

void st_log_add_step(st_revision_log *log, uint64_t revision, st_action which, double time,
                     const he_mesh *content)
{
    st_revision *entry = log->steps;
    assert(entry != NULL);
    log->steps = entry->next;
    st_step *step = which == ST_UNDO ? pop_undo(log) : pop_redo(log);
    assert(step->revision == entry->inverts);
    /* Applying the delta has exchanged arrays between the delta and the mesh, so the step takes a
     * different number of bytes now. */
    step->bytes = sizeof *step + he_delta_bytes(step->delta);
    entry->action = which;
    entry->forward = which == ST_REDO;
    entry->delta_bytes = step->bytes;
    entry->step = step;
    step->uses++;
    step->applied = revision;
    if (which == ST_UNDO) {
        push_redo(log, step);
    } else {
        push_undo(log, step);
    }
    entry->point = (st_point){.revision = revision, .time = time};
    entry->point.state = log->undo_top == NULL ? log->bottom : log->undo_top->revision;
    note_marks(&entry->point, content);
    add_entry(log, entry);
}

bool st_log_entry(const st_revision_log *log, size_t i, st_entry *out)
{
    if (i >= log->count) {
        return false;
    }
    const st_revision *entry = st_entry_at(log, log->count - 1 - i);
    *out = (st_entry){
        .revision = entry->point.revision,
        .inverts = entry->inverts,
        .state = entry->point.state,
        .action = entry->action,
        .undoable = entry->step != NULL && entry->step->stack == ST_ON_UNDO &&
                    entry->step->applied == entry->point.revision,
        .bytes = entry->delta_bytes,
        .time = entry->point.time,
        .tally = entry->tally,
    };
    memcpy(out->ops, entry->ops, strlen(entry->ops) + 1);
    st_copy_text(out->name, entry->name == NULL ? "" : entry->name, ST_MOMENT_NAME);
    return true;
}

const he_delta *st_log_delta(const st_revision_log *log, uint64_t revision)
{
    if (log->count == 0 || revision <= log->oldest || revision > st_log_head(log)) {
        return NULL;
    }
    const st_step *step = st_entry_of(log, revision)->step;
    return step == NULL ? NULL : step->delta;
}
