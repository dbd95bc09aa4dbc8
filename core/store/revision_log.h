/* revision_log.h - the linear log of a mesh's revisions, and the undo and redo stacks over it.
 *
 * Each published change of the content is one entry; the entries are in the order of revisions,
 * without a gap. An undo or redo is an entry, too: it names the revision that it undid or redid,
 * and shares that revision's delta (recorded changes).
 *
 *     entries   [2 edit] [3 edit] [4 undo of 3] [5 edit] [6 undo of 5]
 *     steps        A        B          B           C          C
 *     state        2        3          2           5          2
 *     undo stack   A        (B was dropped from the redo stack by revision 5)
 *     redo stack                                   C
 *
 * A step is one delta, with a count of the entries and the stack that use it. The state of an entry
 * is the revision of the newest edit that is not undone when the entry was made: the mesh has equal
 * contents after entries of equal state.
 *
 * Bytes of entries and deltas stay within a budget: the oldest entries are dropped first. A step on
 * the undo stack is dropped with the entry that applied it last; those entries are in the order of
 * the stack, so the oldest steps to undo are dropped first. A step on the redo stack is never
 * dropped to save memory: when its last entry leaves the ring, the step keeps that entry, because
 * the entry that will redo the step is made from it. This always fits, because a step is charged
 * what its edit took, however often it is undone and redone. The step's delta may take more while
 * the step is undone, because the delta then owns the columns and contents that the edit had put
 * into the mesh, but the mesh then takes as much less. Once a step can no longer be redone, it is
 * charged its real size.
 *
 * An edit larger than the budget keeps its entry without a delta and clears both stacks. So do a
 * replace and a compact, which make deltas before them useless. A revision can be read as long as
 * the log has every delta after it.
 *
 * The log has no lock of its own: it is read under the mesh's shared lock and written under the
 * mesh's exclusive lock. Only the reference count of a step is used without these locks. */
#ifndef HE_STORE_REVISION_LOG_H
#define HE_STORE_REVISION_LOG_H

#include "mesh/replay.h"
#include "store/store.h"

typedef struct st_step st_step;
typedef struct st_revision st_revision;

/* The facts of a mesh at one revision that the log keeps. */
typedef struct st_point {
    uint64_t revision, state;
    /* how many ids of each kind of element the mesh has ever issued */
    uint32_t issued[HE_KIND_COUNT];
    double time;
} st_point;

typedef struct st_revision_log {
    uint64_t budget;    /* bytes */
    uint64_t bytes;     /* how many bytes entries and steps count against the budget */
    st_revision **ring; /* size: a power of two */
    size_t capacity, first, count;
    uint64_t dropped; /* number of entries dropped to stay within the budget */
    st_point before;  /* what the log keeps of the revision before the oldest entry */
    uint64_t oldest;  /* the oldest revision that can be read */
    /* state (newest edit not undone) of the mesh once everything on the undo stack is undone */
    uint64_t bottom;
    st_step *undo_top, *undo_bottom, *redo_top;
    uint32_t undo_count, redo_count;
    /* The entry that st_log_reserve reserved for the next change. */
    st_revision *spare;
    st_step *spare_step; /* the step for the reserved entry `spare`, with an empty delta */
    /* Entries that st_log_reserve_steps reserved for undo or redo, in the order of their use. */
    st_revision *steps;
} st_revision_log;

/* Begins a history with the revision `begin`, whose content is `content`; how many ids were ever
 * issued is taken from the content. */
void st_log_init(st_revision_log *log, uint64_t budget, const st_point *begin,
                 const he_mesh *content);
void st_log_clear(st_revision_log *log);

/* Makes sure that one entry can be added without allocating, and returns the empty delta of that
 * entry, which the caller may fill. Returns NULL if memory is out. This function must be called
 * before the functions below that add an entry. */
he_delta *st_log_reserve(st_revision_log *log);
/* Replaces the log's reserved delta by a delta that the caller has made. */
void st_log_lend(st_revision_log *log, he_delta *takes);
/* Empties the reserved delta, which was filled but not added to the log. A small delta is kept for
 * the next edit, a large delta is freed. */
void st_log_unreserve(st_revision_log *log);
/* Returns true if the reserved delta fits into the budget, so that its edit can be undone. */
bool st_log_fits(const st_revision_log *log);

/* Describes a change that is added to the log. */
typedef struct st_logged {
    uint64_t revision; /* the revision that the change led to */
    st_action action;  /* ST_EDIT or ST_REPLACE */
    const char *ops;   /* names joined by ',' */
    double time;
    /* the numbers of changed elements; NULL: not known, which is allowed only for a barrier (a
     * change that ends the history) */
    const st_tally *tally;
} st_logged;

/* Adds the reserved delta as an edit, with one step on the undo stack. `content` is the mesh after
 * the edit. */
void st_log_add_edit(st_revision_log *log, const st_logged *edit, const he_mesh *content);
/* Returns the step that the reserved delta will become, and adds a reference: the step may outlive
 * the log until st_step_release. */
st_step *st_log_hold_reserved(const st_revision_log *log);
/* Adds an edit that cannot be undone (a barrier) or a replace: no delta is kept of this change or
 * of earlier ones, and both stacks are cleared. */
void st_log_add_barrier(st_revision_log *log, const st_logged *change, const he_mesh *content);

/* Finds how many undos (redos) lead to the content of `revision`; 0 if the mesh has that content
 * now.
 * Returns ST_AHEAD if the revision does not exist yet.
 * Returns ST_GONE if the log has dropped the revision.
 * Returns ST_ELSEWHERE if no number of undos (redos) leads to the revision. */
st_status st_log_steps_to(const st_revision_log *log, st_action which, uint64_t revision,
                          uint32_t *steps);
/* Returns the bytes of the deltas that `steps` undos (redos) apply, as a measure of their work. */
uint64_t st_log_steps_bytes(const st_revision_log *log, st_action which, uint32_t steps);
/* Makes sure that `steps` undos (redos) can be added without allocating; that many must be
 * possible. Returns false if memory is out; nothing is reserved then. `content` is the mesh before
 * the steps. */
bool st_log_reserve_steps(st_revision_log *log, st_action which, uint32_t steps,
                          const he_mesh *content);
void st_log_unreserve_steps(st_revision_log *log);
/* Returns the revision whose edit the next undo (redo) would undo (redo); 0 if the stack is
 * empty. */
uint64_t st_log_top(const st_revision_log *log, st_action which);
/* Lists the deltas that `steps` undos (redos) apply, in the order of applying them. That many undos
 * (redos) must be possible. */
void st_log_deltas(const st_revision_log *log, st_action which, uint32_t steps, he_delta **out);
/* Moves the step whose undo (redo) is next to the other stack, and adds an entry for that undo
 * (redo). It must be called after the step's delta was applied. */
void st_log_add_step(st_revision_log *log, uint64_t revision, st_action which, double time,
                     const he_mesh *content);
/* Brings the log back within its budget after steps were added. The deltas of these steps stay
 * valid until the next change of the mesh. */
void st_log_settle(st_revision_log *log);
/* Sets the budget of a log that was filled without a budget. A delta that was loaded from the disk
 * can take slightly more memory than when it was made. So entries are dropped here only if the log
 * takes more than twice the budget, which means that the budget was reduced; a smaller excess ends
 * when the next entries are added. */
void st_log_limit(st_revision_log *log, uint64_t budget);
/* Returns true if no revision before this one is needed any more, neither for undo and redo nor for
 * reading. */
bool st_log_stands_on(const st_revision_log *log, uint64_t revision);
/* Drops the entries of revisions up to `reach`. */
void st_log_drop(st_revision_log *log, uint64_t reach);

/* Copies the entry of the i-th newest revision. Returns false if the log has fewer entries. */
bool st_log_entry(const st_revision_log *log, size_t i, st_entry *out);
/* Fills in the record of the newest revision from its entry: its facts, and whether the history
 * ends with it. The record borrows the texts of the entry. A record that makes no revision, such as
 * a rename, gets only the numbers of ids ever issued and the oldest revision that can be read. */
void st_log_fill_record(const st_revision_log *log, st_record *record);
/* Returns the newest revision of the log. */
uint64_t st_log_head(const st_revision_log *log);
/* Copies what the log keeps of a revision (st_point); the log must have the revision. */
void st_log_point(const st_revision_log *log, uint64_t revision, st_point *out);

/* Returns the bytes of the deltas between two revisions, as a measure of the work to bring a copy
 * of the mesh from one revision to the other; UINT64_MAX if the log does not reach back to the
 * older revision. */
uint64_t st_log_distance(const st_revision_log *log, uint64_t from, uint64_t to);
/* Brings `copy`, a copy of the mesh, from revision *at towards revision `to`, until more than
 * `most` bytes of deltas are applied; *at is then the revision where the copy has arrived.
 * Returns HE_UNSUPPORTED if the log does not reach back that far, or a delta holds columns or
 * contents from the wrong side of its change; a new copy of the newest revision can then be brought
 * to `to`.
 * Returns HE_NO_MEMORY if memory is out; he_replay_cross says in which state the copy then is. */
HE_NODISCARD he_status st_log_walk(const st_revision_log *log, he_replay *copy, uint64_t *at,
                                   uint64_t to, uint64_t most);

/* Returns the step that led to a revision, which must be newer than log->oldest, and adds a
 * reference: the step may outlive the log until st_step_release. */
st_step *st_log_hold(const st_revision_log *log, uint64_t revision, st_action *action);
/* Returns the delta of a step. Without the mesh's lock only the ids and numbers in the delta may be
 * read, not what its pointers point to. */
const he_delta *st_step_delta(const st_step *step);
void st_step_release(st_step *step); /* takes NULL */
/* Returns the delta whose application, forwards or backwards, led to a revision; NULL if the delta
 * is not kept. */
const he_delta *st_log_delta(const st_revision_log *log, uint64_t revision);

#endif
