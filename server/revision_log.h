/* revision_log.h - the linear log of a mesh's revisions, and the undo and redo stacks over it.
 *
 * Each published change is one entry, in the order of revisions without a gap. An undo and a redo
 * are entries too: they name the revision they undid or did again and share its delta.
 *
 *     entries   [2 edit] [3 edit] [4 undo of 3] [5 edit] [6 undo of 5]
 *     steps        A        B          B           C          C
 *     undo stack   A        (B was dropped from the redo stack by revision 5)
 *     redo stack                                   C
 *
 * A step is one delta, counted by the entries and the stack that use it. Bytes of entries and
 * deltas stay within a budget: the oldest entries go first, and with an edit's entry its step
 * leaves the stacks. An edit larger than the budget keeps its entry without a delta and ends both
 * stacks. So do a replace and a compact, which make deltas before them useless.
 *
 * The log has no lock: it is read under the mesh's shared lock and written under its exclusive
 * one. */
#ifndef HE_SERVER_REVISION_LOG_H
#define HE_SERVER_REVISION_LOG_H

#include "api/store.h"

typedef struct srv_step srv_step;
typedef struct srv_revision srv_revision;

typedef struct srv_revision_log {
    uint64_t budget;     /* bytes */
    uint64_t bytes;      /* of entries and steps */
    srv_revision **ring; /* a power of two of places */
    size_t capacity, first, count;
    srv_step *undo_top, *undo_bottom, *redo_top;
    uint32_t undo_count, redo_count;
    /* Reserved for the next entry by srv_log_reserve. */
    srv_revision *spare;
    srv_step *spare_step; /* with an empty delta */
} srv_revision_log;

void srv_log_init(srv_revision_log *log, uint64_t budget);
void srv_log_clear(srv_revision_log *log);

/* Make sure that one entry can be added without allocating, and lend the empty delta it would
 * have. NULL when memory is out. The functions below that add an entry need this first. */
he_delta *srv_log_reserve(srv_revision_log *log);
/* The reserved delta was used and emptied again: keep a small one, free a large one. */
void srv_log_unreserve(srv_revision_log *log);

/* Add the reserved delta as an edit, with one step on the undo stack. */
void srv_log_add_edit(srv_revision_log *log, uint64_t revision, const char *ops, double time);
/* Add an edit that cannot be undone (a barrier) or a replace: no delta is kept before or with it,
 * and both stacks end. */
void srv_log_add_barrier(srv_revision_log *log, uint64_t revision, api_action action,
                         const char *ops, double time);

/* The delta that undo or redo would apply, NULL when there is none. */
he_delta *srv_log_next(const srv_revision_log *log, api_action which);
/* It was applied: move its step to the other stack and add the entry. The delta stays valid until
 * srv_log_settle, which brings the log back within its budget. */
void srv_log_add_step(srv_revision_log *log, uint64_t revision, api_action which, double time);
void srv_log_settle(srv_revision_log *log);

/* The i-th newest entry; false past the end. */
bool srv_log_entry(const srv_revision_log *log, size_t i, api_entry *out);

/* The delta that led to a revision, forwards or backwards; NULL when it is not kept. */
const he_delta *srv_log_delta(const srv_revision_log *log, uint64_t revision);

/* Bring `copy` from revision `from` to the newest one, whose high-water marks are `issued`.
 * HE_UNSUPPORTED when the log does not reach back that far or holds more than row changes, or when
 * the records would cost more than `most` bytes to replay; HE_NO_MEMORY. Then the copy may have
 * been brought forward in part and is good for nothing. */
HE_NODISCARD he_status srv_log_replay(const srv_revision_log *log, uint64_t from, size_t most,
                                      he_mesh *copy, const uint32_t issued[HE_KIND_COUNT]);

#endif
