/* mesh_write.c - begins a write, which is a change of a mesh; prepares what the write commits; and
 * aborts the write. */
#include "store/mesh_commit.h"

#include "store/revision_name.h"
#include "store/table.h"
#include "system/lock.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

static void begin_recording(st_write *w)
{
    st_mesh *mesh = w->mesh;
    w->delta = st_log_reserve(&mesh->log);
    if (w->delta != NULL && !w->claimed) {
        w->content = mesh->content;
        he_mesh_record(mesh->content, w->delta);
        w->mark = he_delta_mark(mesh->content);
    }
}

/* Checks that a write of the mesh may begin. The caller holds the mesh's exclusive lock. */
static st_status begin(st_write *w)
{
    const st_mesh *mesh = w->mesh;
    st_mesh_facts(mesh, &w->info);
    if (w->info.removed || w->info.lost) {
        return w->info.lost ? ST_LOST : ST_ABSENT;
    }
    if (w->info.unreadable != ST_OK && w->claimed) {
        return w->info.unreadable;
    }
    if (!mesh->claimed) {
        begin_recording(w);
        return w->delta != NULL ? ST_OK : ST_NO_MEMORY;
    }
    w->content = mesh->content;
    return w->claimed ? ST_BUSY : ST_OK;
}

static st_cause cause_of(const st_cause *cause)
{
    return cause == NULL ? (st_cause){.keyed = NULL} : *cause;
}

st_status st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out)
{
    /* If memory is short, caches of meshes are freed before the request is refused for lack of
     * memory. */
    st_make_room(mesh->store, 0);
    *out = (st_write){.mesh = mesh, .cause = cause_of(cause)};
    st_lock_write(&mesh->lock);
    st_status status = begin(out);
    if (status != ST_OK) {
        pthread_rwlock_unlock(&mesh->lock);
        out->mesh = NULL;
    }
    return status;
}

st_status st_write_claim(st_mesh *mesh, const st_cause *cause, st_write *out)
{
    *out = (st_write){.mesh = mesh, .cause = cause_of(cause), .claimed = true};
    st_lock_write(&mesh->lock);
    st_status status = begin(out);
    if (status == ST_OK) {
        mesh->claimed = true;
    } else {
        out->mesh = NULL;
        out->claimed = false;
        out->content = NULL;
    }
    pthread_rwlock_unlock(&mesh->lock);
    return status;
}

void st_claimed_by(st_mesh *mesh, const char *id)
{
    st_lock_write(&mesh->lock);
    if (mesh->claimed) {
        snprintf(mesh->info.job, sizeof mesh->info.job, "%s", id);
    }
    pthread_rwlock_unlock(&mesh->lock);
}

/* Returns the data of a mesh that a long edit has claimed. The caller needs no lock, because no
 * other write can change the mesh until the claim ends. */
const he_mesh *st_write_claimed(const st_write *w)
{
    assert(w->claimed);
    return w->mesh->content;
}

he_status st_write_copy(st_write *w, he_progress *progress, he_error *err)
{
    st_write_discard_copy(w);
    he_status status = he_mesh_copy_with_progress(st_write_claimed(w), progress, &w->content, err);
    if (status == HE_OK) {
        he_mesh_expend(w->content);
        he_mesh_record(w->content, w->delta);
    }
    return status;
}

/* Frees the copy on which a long edit works. Also empties the delta of the edit (its recorded
 * changes), because the delta refers to arrays of the copy. */
void st_write_discard_copy(st_write *w)
{
    assert(w->claimed);
    he_mesh_free(w->content);
    w->content = NULL;
    he_delta_empty(w->delta);
    he_changes_clear(&w->changes);
    w->found = w->unread = false;
}

void st_write_from(st_write *w, const st_shown *shown, size_t count)
{
    w->from = shown;
    w->from_count = count;
}

he_status st_write_changes(st_write *w, he_error *err)
{
    assert(w->kind == ST_WRITE_EDIT && !w->found);
    he_status status =
        he_changes_find(w->content, w->delta, 0, w->delta->count, false, &w->changes, err);
    w->found = status == HE_OK;
    return status;
}

void st_write_unread(st_write *w)
{
    assert(w->kind == ST_WRITE_EDIT && !w->found && w->delta->object_count == 0);
    w->unread = true;
}

bool st_write_undoable(const st_write *w)
{
    assert(w->found || w->unread);
    return !w->changes.renumbered && st_log_fits(&w->mesh->log);
}

/* Undoes all changes that the write has made to the mesh data, empties the delta in which they were
 * recorded, and stops recording. */
static void roll_back(st_write *w)
{
    if (w->delta != NULL) {
        he_delta_rollback(w->content, w->mark);
        he_mesh_record(w->content, NULL);
        st_log_unreserve(&w->mesh->log);
        w->delta = NULL;
    }
}

/* --- undo and redo --- */

st_status st_steps_to(st_mesh *mesh, st_action which, uint64_t revision, uint32_t *steps,
                      uint64_t *bytes)
{
    const st_revision_log *log = &mesh->log;
    st_status status = ST_OK;
    if (revision != 0) {
        status = st_log_steps_to(log, which, revision, steps);
    } else if (*steps > (which == ST_UNDO ? log->undo_count : log->redo_count)) {
        status = ST_NOTHING;
    }
    if (status == ST_OK) {
        *bytes = st_log_steps_bytes(log, which, *steps);
    }
    return status;
}

static void apply(st_write *w, uint32_t i, bool back)
{
    he_delta *delta = w->deltas[i];
    if ((w->which == ST_UNDO) != back) {
        he_delta_undo(delta, w->content);
    } else {
        he_delta_redo(delta, w->content);
    }
}

static void free_steps(st_write *w)
{
    for (uint32_t i = 0; i < w->steps && w->events != NULL; i++) {
        he_mem_free(w->events[i].bytes);
    }
    he_mem_free(w->deltas);
    he_mem_free(w->events);
    he_mem_free(w->records);
    w->deltas = NULL;
    w->events = NULL;
    w->records = NULL;
}

static bool reserve_steps(st_write *w)
{
    st_revision_log *log = &w->mesh->log;
    w->deltas = he_mem_zero(w->steps, sizeof(he_delta *));
    w->events = he_mem_zero(w->steps, sizeof *w->events);
    w->records = he_mem_zero(w->steps, sizeof *w->records);
    if (w->deltas == NULL || w->events == NULL || w->records == NULL ||
        !st_log_reserve_steps(log, w->which, w->steps, w->content)) {
        return false;
    }
    st_log_deltas(log, w->which, w->steps, w->deltas);
    return true;
}

/* Renders the message to listeners about the i-th undo or redo of this write. The message shows
 * values after this undo or redo, so it must be rendered before the next one is applied. If there
 * is only one, its net changes are already known, because the answer needs them. */
static void write_event(st_write *w, uint32_t i)
{
    const st_mesh *mesh = w->mesh;
    st_mesh_info info = mesh->info;
    info.revision += i + 1;
    const st_change change = {
        .action = w->which,
        .delta = w->deltas[i],
        .undone = w->which == ST_UNDO,
        .content = w->content,
        .changes = w->steps == 1 ? &w->changes : NULL,
    };
    st_event_write(mesh, &info, &change, &w->events[i]);
}

/* Computes the net changes of all undos or redos of this write together. */
static bool find_sum(st_write *w)
{
    he_change_part *parts = he_mem_array(NULL, w->steps, sizeof *parts);
    if (parts == NULL) {
        return false;
    }
    for (uint32_t i = 0; i < w->steps; i++) {
        const he_delta *delta = w->deltas[i];
        parts[i] = (he_change_part){delta, 0, delta->count, w->which == ST_UNDO};
    }
    w->found = he_changes_sum(w->content, parts, w->steps, &w->changes, NULL) == HE_OK;
    he_mem_free(parts);
    return w->found;
}

static void take_back(st_write *w)
{
    for (uint32_t i = w->steps; i > 0; i--) {
        apply(w, i - 1, true);
    }
    st_log_unreserve_steps(&w->mesh->log);
    free_steps(w);
}

st_status st_write_step(st_write *w, st_action which, uint32_t steps)
{
    const st_revision_log *log = &w->mesh->log;
    assert(w->kind == ST_WRITE_EDIT && (which == ST_UNDO || which == ST_REDO) && steps > 0);
    if (steps > (which == ST_UNDO ? log->undo_count : log->redo_count)) {
        return ST_NOTHING;
    }
    /* Each undo or redo becomes a revision with a delta of its own. The delta that was reserved for
     * the write would record all of them as one change, so it is emptied and not used. */
    roll_back(w);
    w->which = which;
    w->steps = steps;
    if (!reserve_steps(w)) {
        free_steps(w);
        return ST_NO_MEMORY;
    }
    bool followed = st_queue_is_followed(&w->mesh->queue);
    for (uint32_t i = 0; i < steps; i++) {
        apply(w, i, false);
        if (followed && steps > 1) {
            write_event(w, i);
        }
    }
    if (!find_sum(w)) {
        take_back(w);
        return ST_NO_MEMORY;
    }
    if (followed && steps == 1) {
        write_event(w, 0);
    }
    w->kind = ST_WRITE_STEP;
    return ST_OK;
}

/* --- replace, names, remove, end --- */

void st_write_replace(st_write *w, he_mesh *takes, st_stage *stage)
{
    assert(w->kind == ST_WRITE_EDIT && w->delta != NULL);
    roll_back(w);
    he_mesh_record(takes, NULL);
    w->kind = ST_WRITE_REPLACE;
    w->content = takes;
    w->booking.stage = stage;
}

void st_write_rename(st_write *w, const char *name)
{
    assert(w->kind == ST_WRITE_EDIT || w->kind == ST_WRITE_REPLACE);
    if (w->kind == ST_WRITE_EDIT) {
        roll_back(w);
        w->kind = ST_WRITE_RENAME;
    }
    w->name = name;
}

st_status st_write_moment(st_write *w, uint64_t revision, const char *name)
{
    assert(w->kind == ST_WRITE_EDIT && !w->claimed);
    const st_status status =
        st_log_can_name(&w->mesh->log, revision, strnlen(name, ST_MOMENT_NAME));
    char *copy = status == ST_OK ? st_log_name_new(name) : NULL;
    if (copy == NULL) {
        return status == ST_OK ? ST_NO_MEMORY : status;
    }
    roll_back(w);
    w->kind = ST_WRITE_MOMENT;
    w->named = revision;
    w->moment = copy;
    return ST_OK;
}

void st_write_remove(st_write *w)
{
    assert(w->kind == ST_WRITE_EDIT && !w->claimed);
    roll_back(w);
    w->kind = ST_WRITE_REMOVE;
}

static void end_claim(st_write *w)
{
    st_write_discard_copy(w);
    st_log_unreserve(&w->mesh->log);
    st_mesh_unclaim(w->mesh);
}

void st_write_end(st_write *w, he_mesh *discard)
{
    st_mesh *mesh = w->mesh;
    free_steps(w);
    he_mem_free(w->moment);
    w->moment = NULL;
    he_changes_clear(&w->changes);
    st_booking_leave(mesh->journal, &w->booking);
    w->mesh = NULL;
    w->content = NULL;
    w->claimed = false;
    pthread_rwlock_unlock(&mesh->lock);
    he_mesh_free(discard);
}

void st_write_give_up(st_write *w)
{
    he_mesh *discard = NULL;
    if (w->claimed) {
        end_claim(w);
    } else if (w->kind == ST_WRITE_STEP) {
        take_back(w);
    } else if (w->kind == ST_WRITE_REPLACE) {
        discard = w->content;
    } else {
        roll_back(w);
    }
    st_write_end(w, discard);
}

void st_write_abort(st_write *w)
{
    if (w->claimed) {
        st_lock_write(&w->mesh->lock);
    }
    st_write_give_up(w);
}
