#include "store/stored_mesh.h"

#include "system/clock.h"
#include "system/memory.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

he_mesh *st_write_begin(st_mesh *mesh, st_mesh_info *info, he_delta **delta)
{
    /* What is only kept for later makes room for what is done now. */
    if (st_memory_is_full()) {
        st_store_shed(mesh->store);
    }
    pthread_rwlock_wrlock(&mesh->lock);
    /* Of a claimed mesh nothing is written, so there is nothing to record. */
    he_delta *recording = mesh->claimed ? NULL : st_log_reserve(&mesh->log);
    if (recording == NULL && !mesh->claimed) {
        pthread_rwlock_unlock(&mesh->lock);
        return NULL;
    }
    if (recording != NULL) {
        he_mesh_record(mesh->content, recording);
        mesh->mark = he_delta_mark(mesh->content);
    }
    if (info != NULL) {
        st_mesh_facts(mesh, info);
    }
    if (delta != NULL) {
        *delta = recording;
    }
    return mesh->content;
}

void st_write_keyed(st_mesh *mesh, const st_keyed *keyed)
{
    mesh->keyed = keyed;
}

static void unlock(st_mesh *mesh)
{
    mesh->keyed = NULL;
    he_mesh *discard = mesh->discard;
    mesh->discard = NULL;
    pthread_rwlock_unlock(&mesh->lock);
    he_mesh_free(discard);
}

static double revise(st_mesh *mesh)
{
    mesh->info.revision++;
    mesh->info.modified = st_clock_utc();
    return mesh->info.modified;
}

/* The content is what the reserved delta leads to. */
static void commit(st_mesh *mesh, const he_delta *delta, const char *ops, bool barrier,
                   st_mesh_info *info)
{
    double now = revise(mesh);
    st_mesh_append(mesh, barrier ? ST_REPLACE : ST_EDIT, barrier ? NULL : delta, false);
    if (barrier) {
        st_log_add_barrier(&mesh->log, mesh->info.revision, ST_EDIT, ops, now, mesh->content);
    } else {
        st_log_add_edit(&mesh->log, mesh->info.revision, ops, now, mesh->content);
    }
    if (info != NULL) {
        st_mesh_facts(mesh, info);
    }
    unlock(mesh);
    if (barrier) {
        st_mesh_shed(mesh);
    }
}

void st_write_commit(st_mesh *mesh, const char *ops, bool barrier, st_mesh_info *info)
{
    he_delta *delta = he_mesh_record(mesh->content, NULL);
    commit(mesh, delta, ops, barrier, info);
}

st_status st_claim(st_mesh *mesh, const he_mesh **content, he_delta **delta, st_mesh_info *info)
{
    pthread_rwlock_wrlock(&mesh->lock);
    st_status status = mesh->info.removed ? ST_ABSENT : ST_OK;
    if (status == ST_OK && mesh->claimed) {
        status = ST_BUSY;
    }
    st_mesh_facts(mesh, info);
    if (status == ST_OK) {
        *content = mesh->content;
        *delta = st_log_reserve(&mesh->log);
        mesh->claimed = *delta != NULL;
        status = mesh->claimed ? ST_OK : ST_NO_MEMORY;
    }
    pthread_rwlock_unlock(&mesh->lock);
    return status;
}

void st_claimed_by(st_mesh *mesh, const char *id)
{
    pthread_rwlock_wrlock(&mesh->lock);
    if (mesh->claimed) {
        snprintf(mesh->info.job, sizeof mesh->info.job, "%s", id);
    }
    pthread_rwlock_unlock(&mesh->lock);
}

static void forget_claim(st_mesh *mesh)
{
    mesh->claimed = false;
    mesh->info.job[0] = '\0';
}

/* Under the lock. Objects in the reserved delta are the copy's old side. */
static void end_claim(st_mesh *mesh)
{
    forget_claim(mesh);
    he_delta_empty(st_log_reserve(&mesh->log));
    st_log_unreserve(&mesh->log);
}

st_status st_publish(st_mesh *mesh, he_mesh *content, const char *ops, bool barrier,
                     const st_keyed *keyed, st_mesh_info *info)
{
    pthread_rwlock_wrlock(&mesh->lock);
    if (mesh->info.removed) {
        end_claim(mesh);
        unlock(mesh);
        return ST_ABSENT;
    }
    he_delta *delta = he_mesh_record(content, NULL);
    assert(mesh->claimed && mesh->discard == NULL);
    forget_claim(mesh);
    mesh->keyed = keyed;
    mesh->discard = mesh->content;
    mesh->content = content;
    commit(mesh, delta, ops, barrier, info);
    return ST_OK;
}

void st_unclaim(st_mesh *mesh)
{
    pthread_rwlock_wrlock(&mesh->lock);
    end_claim(mesh);
    unlock(mesh);
}

/* Back to where the writer began; what it recorded is forgotten. */
static void roll_back(st_mesh *mesh)
{
    he_delta_rollback(mesh->content, mesh->mark);
    he_mesh_record(mesh->content, NULL);
    st_log_unreserve(&mesh->log);
}

void st_write_abort(st_mesh *mesh)
{
    roll_back(mesh);
    unlock(mesh);
}

void st_write_tally(st_mesh *mesh, const st_tally *tally)
{
    mesh->log.tally = *tally;
}

bool st_write_undoable(st_mesh *mesh)
{
    return st_log_fits(&mesh->log);
}

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

static const he_delta *take_step(st_mesh *mesh, st_action which)
{
    he_delta *delta = st_log_next(&mesh->log, which);
    if (which == ST_UNDO) {
        he_delta_undo(delta, mesh->content);
    } else {
        he_delta_redo(delta, mesh->content);
    }
    double now = revise(mesh);
    st_log_add_step(&mesh->log, mesh->info.revision, which, now, mesh->content);
    st_mesh_append(mesh, which, delta, which == ST_UNDO);
    return delta;
}

st_status st_write_step(st_mesh *mesh, st_action which, uint32_t steps, const he_delta **deltas,
                        st_mesh_info *info)
{
    assert((which == ST_UNDO || which == ST_REDO) && steps > 0);
    if (steps > (which == ST_UNDO ? mesh->log.undo_count : mesh->log.redo_count)) {
        return ST_NOTHING;
    }
    if (!st_log_reserve_steps(&mesh->log, which, steps, mesh->content)) {
        return ST_NO_MEMORY;
    }
    /* A step makes a revision by itself: it may not be recorded into another. */
    roll_back(mesh);
    for (uint32_t i = 0; i < steps; i++) {
        deltas[i] = take_step(mesh, which);
    }
    /* Before anybody is told what is left to undo and redo. */
    st_log_settle(&mesh->log);
    if (info != NULL) {
        st_mesh_facts(mesh, info);
    }
    return ST_OK;
}

void st_write_replace(st_mesh *mesh, he_mesh *content, st_mesh_info *info)
{
    roll_back(mesh);
    assert(mesh->discard == NULL);
    mesh->discard = mesh->content;
    mesh->content = content;
    he_mesh_record(content, NULL);
    double now = revise(mesh);
    st_log_add_barrier(&mesh->log, mesh->info.revision, ST_REPLACE, "replace", now, content);
    st_mesh_append(mesh, ST_REPLACE, NULL, false);
    if (info != NULL) {
        st_mesh_facts(mesh, info);
    }
}

void st_write_rename(st_mesh *mesh, const char *name, st_mesh_info *info)
{
    size_t length = strnlen(name, ST_MESH_NAME);
    memcpy(mesh->info.name, name, length);
    mesh->info.name[length] = '\0';
    mesh->info.metadata++;
    mesh->info.modified = st_clock_utc();
    st_mesh_append(mesh, ST_EDIT, NULL, false);
    if (info != NULL) {
        st_mesh_facts(mesh, info);
    }
}

void st_write_end(st_mesh *mesh)
{
    /* After a step or replace nothing records any more. */
    he_delta *recording = he_mesh_record(mesh->content, NULL);
    if (recording != NULL) {
        he_mesh_record(mesh->content, recording);
        roll_back(mesh);
    }
    bool cut_off = mesh->discard != NULL;
    unlock(mesh);
    /* No copy can travel across a replace. */
    if (cut_off) {
        st_mesh_shed(mesh);
    }
}
