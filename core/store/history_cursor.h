/* history_cursor.h - following a mesh through its history, one revision after the other.
 *
 * A cursor owns a copy of the mesh at a revision that the history still reaches, in memory or on
 * the disk, and brings it forward on demand: after each step the copy is the mesh as that revision
 * left it, links, attributes and high-water marks included, whatever the mesh has become since.
 *
 *     st_cursor *cursor;
 *     st_cursor_begin(mesh, 41, &cursor);
 *     while (st_cursor_next(cursor, &step) == ST_OK) {
 *         ... step.content is revision step.revision, which step.delta led to ...
 *     }
 *     st_cursor_end(cursor);
 *
 * The mesh's shared lock is taken inside, for no longer than a copy or a replay takes, and none is
 * held between calls. A cursor is for one thread at a time, and not for a worker: it may copy. */
#ifndef HE_STORE_HISTORY_CURSOR_H
#define HE_STORE_HISTORY_CURSOR_H

#include "mesh/replay.h"
#include "store/store.h"

typedef struct st_cursor st_cursor;

typedef struct st_cursor_step {
    uint64_t revision;
    st_action action;
    const he_delta *delta; /* its words, for he_changes_find; its objects are another's */
    bool undone;           /* the delta was applied backwards */
    const he_mesh *content;
} st_cursor_step;

/* Keeps a use of the mesh; may load it once more from the disk. ST_AHEAD when there is no such
 * revision yet, ST_GONE when the history does not reach back to it, ST_NO_MEMORY, ST_BUDGET,
 * ST_FAILED. */
st_status st_cursor_begin(st_mesh *mesh, uint64_t revision, st_cursor **out);
/* Where it is, before the first step too. */
const he_mesh *st_cursor_content(const st_cursor *cursor);
uint64_t st_cursor_revision(const st_cursor *cursor);
/* One revision further; what `out` lends is valid until the next call. ST_NOTHING at the
 * newest revision. ST_GONE when the history was cut off between (a replace, an edit beyond
 * the budget, or so many edits that the next one was dropped): begin anew. After any other failure
 * the cursor can only be ended. */
st_status st_cursor_next(st_cursor *cursor, st_cursor_step *out);
void st_cursor_end(st_cursor *cursor); /* takes NULL */

/* Bring a copy of `mesh` that is at *at to `revision`, or make one where *replay is NULL; what
 * st_cursor_begin and snapshots of earlier revisions are made with. On failure there is none. */
st_status st_replay_to(st_mesh *mesh, he_replay **replay, uint64_t *at, uint64_t revision);

#endif
