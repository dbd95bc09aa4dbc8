/* revision_walk.c - reads a revision log: finds what the log keeps of a revision, and moves copies
 * of the mesh to a revision. */
#include "store/revision_entry.h"

#include <assert.h>
#include <string.h>

uint64_t st_log_head(const st_revision_log *log)
{
    return log->before.revision + log->count;
}

uint64_t st_log_top(const st_revision_log *log, st_action which)
{
    const st_step *step = which == ST_UNDO ? log->undo_top : log->redo_top;
    return step == NULL ? 0 : step->revision;
}

bool st_log_stands_on(const st_revision_log *log, uint64_t revision)
{
    return log->oldest >= revision &&
           (log->undo_bottom == NULL || log->undo_bottom->revision > revision) &&
           (log->redo_top == NULL || log->redo_top->revision > revision);
}

static const st_point *point_of(const st_revision_log *log, uint64_t revision)
{
    return revision == log->before.revision ? &log->before : &st_entry_of(log, revision)->point;
}

void st_log_fill_record(const st_revision_log *log, st_record *record)
{
    memcpy(record->issued, point_of(log, st_log_head(log))->issued, sizeof record->issued);
    const st_revision *entry;
    record->ops = "";
    record->reach = log->before.revision;
    switch (record->kind) {
    case ST_RECORD_EDIT:
        entry = st_entry_of(log, record->revision);
        record->barrier = entry->step == NULL;
        record->ops = entry->ops;
        record->tally = entry->tally;
        break;
    case ST_RECORD_UNDO:
    case ST_RECORD_REDO:
        entry = st_entry_of(log, record->revision);
        record->inverts = entry->inverts;
        break;
    case ST_RECORD_CONTENT:
        record->barrier = true;
        break;
    case ST_RECORD_RENAME:
    case ST_RECORD_REMOVE:
    case ST_RECORD_MOMENT:
        break;
    }
}

void st_log_point(const st_revision_log *log, uint64_t revision, st_point *out)
{
    assert(revision >= log->oldest && revision <= st_log_head(log));
    *out = *point_of(log, revision);
}

st_status st_log_steps_to(const st_revision_log *log, st_action which, uint64_t revision,
                          uint32_t *steps)
{
    if (revision > st_log_head(log)) {
        return ST_AHEAD;
    }
    /* Even if the entry of an edit was dropped, its step (the delta of the edit) may still be on a
     * stack, so that undo or redo leads to its revision. */
    bool has_entry = revision >= log->before.revision;
    uint64_t wanted = has_entry ? point_of(log, revision)->state : revision;
    bool undo = which == ST_UNDO;
    if (point_of(log, st_log_head(log))->state == wanted) {
        *steps = 0;
        return ST_OK;
    }
    /* Undo has led to the wanted revision when the step of that revision's edit is on top of the
     * undo stack; redo has, when that step was redone. */
    uint32_t count = undo ? 0 : 1;
    const st_step *step = undo ? log->undo_top : log->redo_top;
    for (; step != NULL && step->revision != wanted; step = step->below) {
        count++;
    }
    if (step == NULL && !(undo && wanted == log->bottom)) {
        return !has_entry || wanted < log->bottom ? ST_GONE : ST_ELSEWHERE;
    }
    *steps = count;
    return ST_OK;
}

uint64_t st_log_steps_bytes(const st_revision_log *log, st_action which, uint32_t steps)
{
    uint64_t bytes = 0;
    const st_step *step = which == ST_UNDO ? log->undo_top : log->redo_top;
    for (; step != NULL && steps > 0; steps--, step = step->below) {
        bytes += step->bytes;
    }
    return bytes;
}

uint64_t st_log_distance(const st_revision_log *log, uint64_t from, uint64_t to)
{
    uint64_t first = from < to ? from : to, last = from < to ? to : from, bytes = 0;
    if (first < log->oldest || last > st_log_head(log)) {
        return UINT64_MAX;
    }
    for (uint64_t r = first + 1; r <= last; r++) {
        bytes += st_entry_of(log, r)->step->bytes;
    }
    return bytes;
}

he_status st_log_walk(const st_revision_log *log, he_replay *copy, uint64_t *at, uint64_t to,
                      uint64_t most)
{
    uint64_t head = st_log_head(log), cost = 0;
    if (*at < log->oldest || to < log->oldest || *at > head || to > head) {
        return HE_UNSUPPORTED;
    }
    while (*at != to && cost <= most) {
        bool back = *at > to;
        uint64_t next = back ? *at - 1 : *at + 1;
        const st_revision *entry = st_entry_of(log, back ? *at : next);
        const st_step *step = entry->step;
        he_crossing crossing = {
            .key = step->revision,
            .delta = step->delta,
            .undo = entry->forward == back,
            /* The delta contains the arrays that the mesh had before the delta was last applied,
             * and this entry applied it last. */
            .held = back && step->applied == entry->point.revision,
            .issued = point_of(log, next)->issued,
        };
        he_status status = he_replay_cross(copy, &crossing, NULL);
        if (status != HE_OK) {
            return status;
        }
        *at = next;
        cost += step->bytes;
    }
    return HE_OK;
}

st_step *st_log_hold(const st_revision_log *log, uint64_t revision, st_action *action)
{
    const st_revision *entry = st_entry_of(log, revision);
    atomic_fetch_add_explicit(&entry->step->holders, 1, memory_order_relaxed);
    *action = entry->action;
    return entry->step;
}

const he_delta *st_step_delta(const st_step *step)
{
    return step->delta;
}

void st_step_release(st_step *step)
{
    if (step != NULL && atomic_fetch_sub_explicit(&step->holders, 1, memory_order_acq_rel) == 1) {
        he_delta_free(step->delta);
        he_mem_free(step);
    }
}
