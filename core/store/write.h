/* write.h - changing a stored mesh: every change is one write.
 *
 *     st_write_begin --+-- the content is changed, st_write_changes ---+
 *     (the lock)       +-- st_write_step: undo, redo                   +-- st_write_commit
 *                      +-- st_write_replace, st_write_rename, or both  |   or
 *                      +-- st_write_remove ----------------------------+   st_write_abort
 *     st_write_claim --- st_write_copy, st_write_changes --------------+
 *     (no lock)
 *
 * What fails changes nothing. The commit books a place in the journal, which can be refused; then
 * it numbers what was done, puts it into the history, hands it to the journal as one group of
 * records, which become durable together or not at all, and tells the listeners. What changed is
 * found once, by st_write_changes or st_write_step, for the answer, the history and the listeners.
 *
 * A claim is for a long edit, which works without a lock on a copy of its own. Until the claim ends
 * no other write can change the mesh, so that its content stands still and may be copied; reads go
 * on, and the mesh may be removed. */
#ifndef HE_STORE_WRITE_H
#define HE_STORE_WRITE_H

#include "base/watch.h"
#include "store/booking.h"
#include "store/store.h"

typedef enum st_write_kind {
    ST_WRITE_EDIT,
    ST_WRITE_STEP,
    ST_WRITE_REPLACE,
    ST_WRITE_RENAME,
    ST_WRITE_REMOVE
} st_write_kind;

/* In the caller's storage, from a begin that succeeded to the commit or abort. */
typedef struct st_write {
    st_mesh *mesh;      /* NULL: none is under way */
    he_mesh *content;   /* to be changed, recording; of a claim the copy, NULL until it is made */
    he_delta *delta;    /* what was recorded; NULL where info.busy, and after a step or replace */
    he_changes changes; /* what it comes to, until the end */
    st_mesh_info info;  /* of the mesh as it was found; after the commit, as it is */

    /* --- the store's own --- */
    st_write_kind kind;
    bool claimed, found; /* found: `changes` was filled in */
    st_cause cause;
    he_savepoint mark; /* where the delta began */
    const char *name;  /* of a rename */
    st_action which;   /* of a step, with what it takes to commit it */
    uint32_t steps;
    he_delta **deltas;
    struct st_event *events;
    st_record *records;
    st_booking booking;   /* in the journal */
    const st_shown *from; /* what was read of other meshes */
    size_t from_count;
} st_write;

/* Takes the exclusive lock. `cause` is what the write is done for, or NULL: its records carry it.
 * Where info.busy a long edit has claimed the mesh: then it may only be removed. Without the lock:
 * ST_ABSENT, ST_LOST, ST_NO_MEMORY; `info` is filled in then too. */
st_status st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out);
/* Claims the mesh for a long edit. ST_ABSENT, ST_LOST, ST_DAMAGED, ST_NEWER, ST_BUSY, ST_NO_MEMORY;
 * `info` is filled in then too. */
st_status st_write_claim(st_mesh *mesh, const st_cause *cause, st_write *out);
/* The content of a claimed mesh, to be looked at until the claim ends. */
const he_mesh *st_write_claimed(const st_write *write);
/* Makes the copy that a claim works on, in place of one that was made before. */
HE_NODISCARD he_status st_write_copy(st_write *write, he_watch *watch, he_error *err);
/* Frees the copy with what was done to it; the claim goes on. */
void st_write_discard_copy(st_write *write);

/* The change is made from what these show, which outlive the write: it is lost together with each
 * of them, and is not committed where one is lost already. */
void st_write_from(st_write *write, const st_shown *shown, size_t count);
/* Finds what the recorded edit comes to. */
HE_NODISCARD he_status st_write_changes(st_write *write, he_error *err);
/* After st_write_changes: could the edit be undone if it were committed? False when it is larger
 * than the undo budget or gives ids another meaning: committing it ends the history. */
bool st_write_undoable(const st_write *write);
/* Takes that many steps, at least one, back or forward, and finds what they come to: each will be
 * a revision that applies the inverse of an edit. ST_NOTHING where the stack has fewer;
 * ST_NO_MEMORY. */
st_status st_write_step(st_write *write, st_action which, uint32_t steps);
/* PUT. Takes `stage` too, that of st_store_stage, or NULL. */
void st_write_replace(st_write *write, he_mesh *takes, st_stage *stage);
/* `name`, which outlives the write, is cut to ST_MESH_NAME bytes. */
void st_write_rename(st_write *write, const char *name);
void st_write_remove(st_write *write);

/* Makes it so and ends the write: the new facts are in `info`. `ops` names the operations of an
 * edit for the history, NULL for anything else. Where it is refused the write has ended with
 * nothing done: ST_DAMAGED, ST_NEWER (of such a mesh only the removal can be committed), ST_BEHIND,
 * ST_FULL, ST_FAILED, ST_NO_MEMORY, ST_TOO_LARGE; ST_QUOTA: the mesh would take more than its
 * holder may have (holder/holders.h); a claim whose mesh was removed or lost meanwhile:
 * ST_ABSENT, ST_LOST, which is also said where what it was made from is lost (st_write_from). A
 * claim may wait for the disk, and is not to be committed on a worker. */
st_status st_write_commit(st_write *write, const char *ops);
/* Ends the write with nothing done. */
void st_write_abort(st_write *write);

/* Names the job that has claimed the mesh, for those who find it busy. Without a lock. */
void st_claimed_by(st_mesh *mesh, const char *id);
/* How many steps undo (redo) takes to the content of a revision, 0 when it is there, and the bytes
 * of all their deltas. `revision` 0: for that many `steps`, which is read. Under either lock.
 * ST_NOTHING when the stack has fewer steps; ST_AHEAD, ST_GONE, ST_ELSEWHERE. */
st_status st_steps_to(st_mesh *mesh, st_action which, uint64_t revision, uint32_t *steps,
                      uint64_t *bytes);

#endif
