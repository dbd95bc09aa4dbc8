/* revision_log.h - the linear log of a mesh's revisions, and the undo and redo stacks over it.
 *
 * Each published change is one entry, in the order of revisions without a gap. An undo and a redo
 * are entries too: they name the revision they undid or did again and share its delta.
 *
 *     entries   [2 edit] [3 edit] [4 undo of 3] [5 edit] [6 undo of 5]
 *     steps        A        B          B           C          C
 *     state        2        3          2           5          2
 *     undo stack   A        (B was dropped from the redo stack by revision 5)
 *     redo stack                                   C
 *
 * A step is one delta, counted by the entries and the stack that use it. The state of an entry is
 * the revision whose edit was the last to be done and not undone: entries of equal state hold the
 * same content.
 *
 * Bytes of entries and deltas stay within a budget: the oldest entries go first. A step on the undo
 * stack leaves it with the entry that applied the step last; those entries are in the order of the
 * stack, so the oldest steps to undo go first. A step on the redo stack never goes to save memory:
 * when its last entry leaves the ring, the step keeps that entry, because the entry that will do
 * the step again is made from it. This always fits, because the budget is charged for a step what
 * the edit took, however often the step is undone and done again. What a delta then holds may be
 * more (undone, it holds the columns and contents that the edit had put into the mesh), but the
 * mesh holds as much less. Once a step can no longer be done again, it is charged as it is.
 *
 * An edit larger than the budget keeps its entry without a delta and ends both stacks. So do a
 * replace and a compact, which make deltas before them useless. A revision can be read for as long
 * as every delta after it is there.
 *
 * The log has no lock: it is read under the mesh's shared lock and written under its exclusive
 * one. Only the count of those who hold a step is shared beyond. */
#ifndef HE_STORE_REVISION_LOG_H
#define HE_STORE_REVISION_LOG_H

#include "mesh/replay.h"
#include "store/store.h"

typedef struct st_step st_step;
typedef struct st_revision st_revision;

/* What the log knows of a mesh at one revision. */
typedef struct st_point {
    uint64_t revision, state;
    uint32_t issued[HE_KIND_COUNT]; /* high-water marks */
    double time;
} st_point;

typedef struct st_revision_log {
    uint64_t budget;    /* bytes */
    uint64_t bytes;     /* of entries and steps, as charged */
    st_revision **ring; /* a power of two of places */
    size_t capacity, first, count;
    uint64_t dropped; /* entries, to stay within the budget */
    st_point before;  /* of the revision before the oldest entry */
    uint64_t oldest;  /* revision that can be read */
    uint64_t bottom;  /* state below the undo stack */
    st_step *undo_top, *undo_bottom, *redo_top;
    uint32_t undo_count, redo_count;
    /* Reserved for the next entry by st_log_reserve. */
    st_revision *spare;
    st_step *spare_step; /* with an empty delta */
    st_revision *steps;  /* reserved by st_log_reserve_steps, in the order of their use */
} st_revision_log;

/* The history of a mesh that begins with this revision (but for the marks) and content. */
void st_log_init(st_revision_log *log, uint64_t budget, const st_point *begin,
                 const he_mesh *content);
void st_log_clear(st_revision_log *log);

/* Make sure that one entry can be added without allocating, and lend the empty delta it would
 * have. NULL when memory is out. The functions below that add an entry need this first. */
he_delta *st_log_reserve(st_revision_log *log);
/* Puts a delta that was made elsewhere in the place of the one that is reserved. */
void st_log_lend(st_revision_log *log, he_delta *takes);
/* The reserved delta was used and emptied again: keep a small one, free a large one. */
void st_log_unreserve(st_revision_log *log);
/* Does what the reserved delta holds fit the budget, so that it can be undone? */
bool st_log_fits(const st_revision_log *log);

/* Add the reserved delta as an edit, with one step on the undo stack. `content` is the mesh after
 * it. */
void st_log_add_edit(st_revision_log *log, uint64_t revision, const char *ops, double time,
                     const he_mesh *content, const st_tally *tally);
/* The step that the reserved delta is to become, held: it outlives the log until it is released. */
st_step *st_log_hold_reserved(const st_revision_log *log);
/* Add an edit that cannot be undone (a barrier) or a replace: no delta is kept before or with it,
 * and both stacks end. `tally` NULL: it is not known. */
void st_log_add_barrier(st_revision_log *log, uint64_t revision, st_action action, const char *ops,
                        double time, const he_mesh *content, const st_tally *tally);

/* How many steps undo (redo) takes to the content of `revision`; none when it is there already.
 * ST_AHEAD when there is no such revision yet, ST_GONE when the log has dropped it,
 * ST_ELSEWHERE when the stack does not lead to it. */
st_status st_log_steps_to(const st_revision_log *log, st_action which, uint64_t revision,
                          uint32_t *steps);
/* The bytes of that many steps' deltas: what taking them costs. */
uint64_t st_log_steps_bytes(const st_revision_log *log, st_action which, uint32_t steps);
/* Make sure that this many steps, which the stack has, can be added without allocating. False when
 * memory is out; nothing is reserved then. `content` is what they will be taken on. */
bool st_log_reserve_steps(st_revision_log *log, st_action which, uint32_t steps,
                          const he_mesh *content);
void st_log_unreserve_steps(st_revision_log *log);
/* The revision whose edit the next step back or forward would undo or do again, 0: there is none.
 */
uint64_t st_log_top(const st_revision_log *log, st_action which);
/* The deltas that so many steps, which the stack has, apply, in their order. */
void st_log_deltas(const st_revision_log *log, st_action which, uint32_t steps, he_delta **out);
/* The next of them was applied: move its step to the other stack and add the entry. */
void st_log_add_step(st_revision_log *log, uint64_t revision, st_action which, double time,
                     const he_mesh *content);
/* Bring the log back within its budget after steps were added. Their deltas stay valid until the
 * next change. */
void st_log_settle(st_revision_log *log);
/* Begin to keep a budget after the log was filled without one. What a delta takes can be a little
 * more than when it was made, so that only a log of more than twice the budget, which was smaller
 * then, is cut here, and any other by what is added next. */
void st_log_limit(st_revision_log *log, uint64_t budget);
/* Is nothing before a revision needed, neither to be undone or done again nor to be read? */
bool st_log_stands_on(const st_revision_log *log, uint64_t revision);
/* Drop the entries of revisions up to `reach`. */
void st_log_drop(st_revision_log *log, uint64_t reach);

/* The i-th newest entry; false past the end. */
bool st_log_entry(const st_revision_log *log, size_t i, st_entry *out);
/* Fills the record of a revision from the newest entry: its facts, and whether the history ends
 * with it; the texts are borrowed while the entry lives. A record of another kind gets only the
 * marks and the reach. */
void st_log_fill_record(const st_revision_log *log, st_record *record);
/* The newest revision. */
uint64_t st_log_head(const st_revision_log *log);
/* Of a revision from log->oldest to the head. */
void st_log_point(const st_revision_log *log, uint64_t revision, st_point *out);

/* Bytes of the deltas between two revisions: what bringing a copy from one to the other costs.
 * UINT64_MAX when the log does not reach back to the older. */
uint64_t st_log_distance(const st_revision_log *log, uint64_t from, uint64_t to);
/* Bring `copy` from revision *at towards `to`, in steps until they have cost more than `most`
 * bytes; *at is where it arrived. HE_UNSUPPORTED when the log does not reach back that far, or a
 * step holds columns or contents of another side: then a fresh copy can get there from the head.
 * HE_NO_MEMORY; see he_replay_cross. */
HE_NODISCARD he_status st_log_walk(const st_revision_log *log, he_replay *copy, uint64_t *at,
                                   uint64_t to, uint64_t most);

/* The step that led to a revision after log->oldest, held: it outlives the log until it is
 * released. */
st_step *st_log_hold(const st_revision_log *log, uint64_t revision, st_action *action);
/* Only its words may be read without the mesh's lock. */
const he_delta *st_step_delta(const st_step *step);
void st_step_release(st_step *step); /* takes NULL */
/* The delta that led to a revision, forwards or backwards; NULL when it is not kept. */
const he_delta *st_log_delta(const st_revision_log *log, uint64_t revision);

#endif
