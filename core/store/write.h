/* write.h - changes a stored mesh: every change is one write (st_write).
 *
 *     st_write_begin --+-- the content is changed, st_write_changes ---+
 *     (the lock)       +-- st_write_step: undo, redo                   +-- st_write_commit
 *                      +-- st_write_replace, st_write_rename, or both  |   or
 *                      +-- st_write_moment                             |
 *                      +-- st_write_remove ----------------------------+   st_write_abort
 *     st_write_claim --- st_write_copy, st_write_changes --------------+
 *     (no lock)
 *
 * A write that fails changes nothing. The commit reserves space in the journal, which can be
 * refused; then it numbers the change, puts it into the history, appends it to the journal as one
 * group of records, which become durable together or not at all, and informs the listeners. The net
 * changes are found once, by st_write_changes or st_write_step, for the answer, the history and the
 * listeners.
 *
 * A claim reserves a mesh for a long edit, which works without a lock on its own copy. Until the
 * claim ends no other write can change the mesh, so its content can be read and copied without a
 * lock. Other threads can still read the mesh, and remove it. */
#ifndef HE_STORE_WRITE_H
#define HE_STORE_WRITE_H

#include "base/progress.h"
#include "store/publish/booking.h"
#include "store/store.h"

typedef enum st_write_kind {
    ST_WRITE_EDIT,
    ST_WRITE_STEP,
    ST_WRITE_REPLACE,
    ST_WRITE_RENAME,
    ST_WRITE_MOMENT,
    ST_WRITE_REMOVE
} st_write_kind;

/* A write (change of a mesh) that has begun. The struct is in the caller's storage, from a
 * successful st_write_begin or st_write_claim to the commit or abort. */
typedef struct st_write {
    st_mesh *mesh; /* the mesh that is changed; NULL: no write is under way */
    /* The content to be changed; every change made to it is recorded. In a claim this is the copy,
     * NULL until the copy is made. */
    he_mesh *content;
    /* `delta` has the recorded changes; NULL if a long edit has claimed the mesh (info.busy), and
     * after an undo, redo or replacement */
    he_delta *delta;
    he_changes changes; /* the net changes of the write, valid until it ends */
    /* Description of the mesh when the write began; after the commit, its new description. */
    st_mesh_info info;

    /* --- the members below are private to core/store --- */
    st_write_kind kind;
    /* `claimed` is true if the write is a claim, `found` if `changes` is filled in, `unread` if
     * nobody reads `changes` */
    bool claimed, found, unread;
    st_cause cause;
    he_savepoint mark; /* position in `delta` at which the changes of this write begin */
    const char *name;  /* `name` is the new name, if the write is a rename */
    uint64_t named;    /* the revision that the write names, and its name; used only then */
    char *moment;
    /* ST_UNDO or ST_REDO, if the write undoes or redoes steps; the next four members are used only
     * then. */
    st_action which;
    uint32_t steps;
    he_delta **deltas;
    struct st_event *events;
    st_record *records;
    st_booking booking;   /* room in the journal */
    const st_shown *from; /* `from` are the records of other meshes that the change is made from */
    size_t from_count;
} st_write;

/* Begins a write and takes the exclusive lock of the mesh. `cause` is the reason for the write, or
 * NULL; the records of the write store the reason. If the member info.busy of the write is true, a
 * long edit has claimed the mesh, which can then only be removed. The member `info` is filled in on
 * failure, too, and the lock is then not held.
 * Returns ST_ABSENT if the mesh was removed.
 * Returns ST_LOST if the mesh has a change that was lost.
 * Returns ST_NO_MEMORY if memory is out. */
st_status st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out);
/* Claims the mesh for a long edit, which then works on a copy without the lock. The member `info`
 * of the write is filled in on failure, too.
 * Returns ST_ABSENT or ST_LOST if the store no longer has the mesh.
 * Returns ST_DAMAGED if the content of the mesh is damaged on the disk.
 * Returns ST_NEWER if a newer release of hedge wrote the content.
 * Returns ST_BUSY if another long edit has claimed the mesh.
 * Returns ST_NO_MEMORY if memory is out. */
st_status st_write_claim(st_mesh *mesh, const st_cause *cause, st_write *out);
/* Returns the content of a claimed mesh, which may be read until the claim ends. */
const he_mesh *st_write_claimed(const st_write *write);
/* Makes the copy that a claim works on; a copy made before is replaced. */
HE_NODISCARD he_status st_write_copy(st_write *write, he_progress *progress, he_error *err);
/* Frees the copy that the claim works on, with its changes; the mesh stays claimed. */
void st_write_discard_copy(st_write *write);

/* Declares that the change is made from the records that `shown` names; `shown` must outlive the
 * write. If one of these records is lost, the change is lost, too, or is refused if it is not
 * committed yet. */
void st_write_from(st_write *write, const st_shown *shown, size_t count);
/* Computes the net changes of the edit that the write has recorded. */
HE_NODISCARD he_status st_write_changes(st_write *write, he_error *err);
/* May be called instead of st_write_changes if the caller reads no changes and the edit has changed
 * the mesh without adding, dropping or replacing columns, materials or contents. The history then
 * does not say how many elements changed, and listeners that need the changes find them. */
void st_write_unread(st_write *write);
/* Returns true if the edit could be undone if it were committed; must be called after
 * st_write_changes or st_write_unread. Returns false if the edit is larger than the undo budget or
 * renumbers elements; the commit of such an edit clears the history. */
bool st_write_undoable(const st_write *write);
/* Undoes or redoes `steps` steps, at least one, and computes the net changes of all of them. Each
 * step becomes a revision of its own.
 * Returns ST_NOTHING if the stack has fewer steps.
 * Returns ST_NO_MEMORY if memory is out. */
st_status st_write_step(st_write *write, st_action which, uint32_t steps);
/* Makes the write replace the whole content of the mesh (PUT). The write then owns the new content
 * and `stage`, which is NULL or the stage to which st_store_stage has written this content in
 * advance. */
void st_write_replace(st_write *write, he_mesh *takes, st_stage *stage);
/* Makes the write rename the mesh. `name` must outlive the write; it is cut to ST_MESH_NAME
 * bytes. */
void st_write_rename(st_write *write, const char *name);
/* Makes the write give a revision the name `name`, at most ST_MOMENT_NAME bytes of UTF-8; "" takes
 * its name away. The history keeps the name with the entry of the revision.
 * Returns ST_AHEAD if the revision does not exist yet.
 * Returns ST_GONE if the history has no entry of the revision.
 * Returns ST_TOO_LARGE if the undo budget has no room for the name.
 * Returns ST_NO_MEMORY if memory is out. */
st_status st_write_moment(st_write *write, uint64_t revision, const char *name);
void st_write_remove(st_write *write);

/* Commits the write and ends it: its member `info` then has the new facts of the mesh. `ops` names
 * the operations of an edit for the history, NULL for anything else. On failure the write has ended
 * and the mesh is as it was. The commit of a claim may wait for the disk, so a worker must not call
 * it.
 * Returns ST_DAMAGED or ST_NEWER if the mesh has no content and the write does not remove it.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED, ST_NO_MEMORY or ST_TOO_LARGE if the journal refuses.
 * Returns ST_QUOTA if the mesh would take more than its holder may have (holder/holders.h).
 * Returns ST_ABSENT if a claimed mesh was removed meanwhile.
 * Returns ST_LOST if the mesh was lost meanwhile, or if records that the change was made from are
 * lost (st_write_from). */
st_status st_write_commit(st_write *write, const char *ops);
/* Ends the write without a change; the mesh is as it was. */
void st_write_abort(st_write *write);

/* Sets the id of the job that has claimed the mesh; other requests find this id in the member `job`
 * of the mesh's st_mesh_info. Takes no lock. */
void st_claimed_by(st_mesh *mesh, const char *id);
/* Finds `steps`, the number of undos (redos) that lead to the content of a revision, 0 if the mesh
 * has this content now, and `bytes`, the bytes of all their deltas (recorded changes). If
 * `revision` is 0, the caller sets `steps`, and only `bytes` is found. The caller holds the shared
 * or the exclusive lock.
 * Returns ST_NOTHING if the stack has fewer steps.
 * Returns ST_AHEAD, ST_GONE or ST_ELSEWHERE as st_log_steps_to does. */
st_status st_steps_to(st_mesh *mesh, st_action which, uint64_t revision, uint32_t *steps,
                      uint64_t *bytes);

#endif
