/* history_cursor.h - iterates over a mesh's history, one revision after another.
 *
 * A cursor owns a copy of the mesh at a revision that the history, in memory or on the disk, still
 * has, and brings the copy forward step by step: after each step the copy equals the mesh at that
 * revision, links, attributes and issued ids included, even if the mesh has changed since.
 *
 *     st_cursor *cursor;
 *     st_cursor_begin(mesh, 41, &cursor);
 *     while (st_cursor_next(cursor, &step) == ST_OK) {
 *         ... step.content is revision step.revision, which step.delta led to ...
 *     }
 *     st_cursor_end(cursor);
 *
 * The functions take the mesh's shared lock only while they copy the mesh or replay changes, and
 * hold no lock between calls. One thread at a time may use a cursor; a worker must not, because a
 * call may copy the mesh. */
#ifndef HE_STORE_HISTORY_CURSOR_H
#define HE_STORE_HISTORY_CURSOR_H

#include "mesh/replay.h"
#include "store/store.h"

typedef struct st_cursor st_cursor;

typedef struct st_cursor_step {
    uint64_t revision;
    st_action action;
    /* `delta` is the delta (recorded changes) that led to the revision. The caller may pass the
     * delta to he_changes_find, which reads its ids and numbers, but must not follow the delta's
     * pointers to names and columns, because these belong to the mesh as it is at another
     * revision. */
    const he_delta *delta;
    bool undone; /* the delta was applied backwards */
    const he_mesh *content;
} st_cursor_step;

/* Makes a cursor at a revision. The cursor holds a reference to the mesh and may load a second copy
 * of it from the disk.
 * Returns ST_AHEAD if the revision does not exist yet.
 * Returns ST_GONE if the history does not reach back to the revision.
 * Returns ST_NO_MEMORY, ST_BUDGET or ST_FAILED if the copy cannot be made. */
st_status st_cursor_begin(st_mesh *mesh, uint64_t revision, st_cursor **out);
/* Returns the cursor's copy of the mesh, even before the first step. */
const he_mesh *st_cursor_content(const st_cursor *cursor);
uint64_t st_cursor_revision(const st_cursor *cursor);
/* Moves the cursor one revision further; `out` is valid until the next call. After any failure,
 * other than the results ST_NOTHING and ST_GONE, the caller can only end the cursor.
 * Returns ST_NOTHING at the newest revision.
 * Returns ST_GONE if the next revision is not in the history any more: the content was replaced, an
 * edit exceeded the undo budget, or so many edits followed that the revision was dropped. The
 * caller must begin a new cursor. */
st_status st_cursor_next(st_cursor *cursor, st_cursor_step *out);
void st_cursor_end(st_cursor *cursor); /* takes NULL */

/* Brings *replay, a copy of `mesh` at the revision *at, to the revision `revision`; makes the copy
 * first if *replay is NULL. Cursors and snapshots of earlier revisions are made by this function.
 * On failure *replay is freed and set to NULL. */
st_status st_replay_to(st_mesh *mesh, he_replay **replay, uint64_t *at, uint64_t revision);

#endif
