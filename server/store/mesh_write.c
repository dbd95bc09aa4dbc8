#include "server/store/stored_mesh.h"

#include "server/store/store.h"
#include "server/system/clock.h"
#include "server/system/memory.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

he_mesh *srv_write_begin(void *self, api_mesh *mesh, api_mesh_info *info, he_delta **delta)
{
    /* What is only kept for later makes room for what is done now. */
    if (srv_memory_is_full()) {
        srv_store_shed(self);
    }
    pthread_rwlock_wrlock(&mesh->lock);
    /* Of a claimed mesh nothing is written, so there is nothing to record. */
    he_delta *recording = mesh->claimed ? NULL : srv_log_reserve(&mesh->log);
    if (recording == NULL && !mesh->claimed) {
        pthread_rwlock_unlock(&mesh->lock);
        return NULL;
    }
    if (recording != NULL) {
        he_mesh_record(mesh->content, recording);
        mesh->mark = he_delta_mark(mesh->content);
    }
    if (info != NULL) {
        srv_mesh_info(mesh, info);
    }
    if (delta != NULL) {
        *delta = recording;
    }
    return mesh->content;
}

void srv_write_keyed(void *self, api_mesh *mesh, const api_claim *claim)
{
    (void)self;
    mesh->claim = claim;
}

static void unlock(api_mesh *mesh)
{
    mesh->claim = NULL;
    he_mesh *discard = mesh->discard;
    mesh->discard = NULL;
    pthread_rwlock_unlock(&mesh->lock);
    he_mesh_free(discard);
}

static double revise(api_mesh *mesh)
{
    mesh->info.revision++;
    mesh->info.modified = srv_clock_utc();
    return mesh->info.modified;
}

/* The content is what the reserved delta leads to. */
static void commit(api_mesh *mesh, const he_delta *delta, const char *ops, bool barrier,
                   api_mesh_info *info)
{
    double now = revise(mesh);
    srv_mesh_append(mesh, barrier ? API_REPLACE : API_EDIT, barrier ? NULL : delta, false);
    if (barrier) {
        srv_log_add_barrier(&mesh->log, mesh->info.revision, API_EDIT, ops, now, mesh->content);
    } else {
        srv_log_add_edit(&mesh->log, mesh->info.revision, ops, now, mesh->content);
    }
    if (info != NULL) {
        srv_mesh_info(mesh, info);
    }
    unlock(mesh);
    if (barrier) {
        srv_mesh_shed(mesh);
    }
}

void srv_write_commit(void *self, api_mesh *mesh, const char *ops, bool barrier,
                      api_mesh_info *info)
{
    (void)self;
    he_delta *delta = he_mesh_record(mesh->content, NULL);
    commit(mesh, delta, ops, barrier, info);
}

api_store_status srv_claim(void *self, api_mesh *mesh, const he_mesh **content, he_delta **delta,
                           api_mesh_info *info)
{
    (void)self;
    pthread_rwlock_wrlock(&mesh->lock);
    api_store_status status = mesh->info.removed ? API_STORE_ABSENT : API_STORE_OK;
    if (status == API_STORE_OK && mesh->claimed) {
        status = API_STORE_BUSY;
    }
    srv_mesh_info(mesh, info);
    if (status == API_STORE_OK) {
        *content = mesh->content;
        *delta = srv_log_reserve(&mesh->log);
        mesh->claimed = *delta != NULL;
        status = mesh->claimed ? API_STORE_OK : API_STORE_NO_MEMORY;
    }
    pthread_rwlock_unlock(&mesh->lock);
    return status;
}

void srv_claimed_by(api_mesh *mesh, const char *id)
{
    pthread_rwlock_wrlock(&mesh->lock);
    if (mesh->claimed) {
        snprintf(mesh->info.job, sizeof mesh->info.job, "%s", id);
    }
    pthread_rwlock_unlock(&mesh->lock);
}

static void forget_claim(api_mesh *mesh)
{
    mesh->claimed = false;
    mesh->info.job[0] = '\0';
}

/* Under the lock. Objects in the reserved delta are the copy's old side. */
static void end_claim(api_mesh *mesh)
{
    forget_claim(mesh);
    he_delta_empty(srv_log_reserve(&mesh->log));
    srv_log_unreserve(&mesh->log);
}

api_store_status srv_publish(void *self, api_mesh *mesh, he_mesh *content, const char *ops,
                             bool barrier, const api_claim *keyed, api_mesh_info *info)
{
    (void)self;
    pthread_rwlock_wrlock(&mesh->lock);
    if (mesh->info.removed) {
        end_claim(mesh);
        unlock(mesh);
        return API_STORE_ABSENT;
    }
    he_delta *delta = he_mesh_record(content, NULL);
    assert(mesh->claimed && mesh->discard == NULL);
    forget_claim(mesh);
    mesh->claim = keyed;
    mesh->discard = mesh->content;
    mesh->content = content;
    commit(mesh, delta, ops, barrier, info);
    return API_STORE_OK;
}

void srv_unclaim(void *self, api_mesh *mesh)
{
    (void)self;
    pthread_rwlock_wrlock(&mesh->lock);
    end_claim(mesh);
    unlock(mesh);
}

/* Back to where the writer began; what it recorded is forgotten. */
static void roll_back(api_mesh *mesh)
{
    he_delta_rollback(mesh->content, mesh->mark);
    he_mesh_record(mesh->content, NULL);
    srv_log_unreserve(&mesh->log);
}

void srv_write_abort(void *self, api_mesh *mesh)
{
    (void)self;
    roll_back(mesh);
    unlock(mesh);
}

void srv_tally(void *self, api_mesh *mesh, const api_tally *tally)
{
    (void)self;
    mesh->log.tally = *tally;
}

bool srv_undoable(void *self, api_mesh *mesh)
{
    (void)self;
    return srv_log_fits(&mesh->log);
}

api_store_status srv_steps_to(void *self, api_mesh *mesh, api_action which, uint64_t revision,
                              uint32_t *steps, uint64_t *bytes)
{
    (void)self;
    const srv_revision_log *log = &mesh->log;
    api_store_status status = API_STORE_OK;
    if (revision != 0) {
        status = srv_log_steps_to(log, which, revision, steps);
    } else if (*steps > (which == API_UNDO ? log->undo_count : log->redo_count)) {
        status = API_STORE_NOTHING;
    }
    if (status == API_STORE_OK) {
        *bytes = srv_log_steps_bytes(log, which, *steps);
    }
    return status;
}

static const he_delta *take_step(api_mesh *mesh, api_action which)
{
    he_delta *delta = srv_log_next(&mesh->log, which);
    if (which == API_UNDO) {
        he_delta_undo(delta, mesh->content);
    } else {
        he_delta_redo(delta, mesh->content);
    }
    double now = revise(mesh);
    srv_log_add_step(&mesh->log, mesh->info.revision, which, now, mesh->content);
    srv_mesh_append(mesh, which, delta, which == API_UNDO);
    return delta;
}

api_store_status srv_step_apply(void *self, api_mesh *mesh, api_action which, uint32_t steps,
                                const he_delta **deltas, api_mesh_info *info)
{
    (void)self;
    assert((which == API_UNDO || which == API_REDO) && steps > 0);
    if (steps > (which == API_UNDO ? mesh->log.undo_count : mesh->log.redo_count)) {
        return API_STORE_NOTHING;
    }
    if (!srv_log_reserve_steps(&mesh->log, which, steps, mesh->content)) {
        return API_STORE_NO_MEMORY;
    }
    /* A step makes a revision by itself: it may not be recorded into another. */
    roll_back(mesh);
    for (uint32_t i = 0; i < steps; i++) {
        deltas[i] = take_step(mesh, which);
    }
    /* Before anybody is told what is left to undo and redo. */
    srv_log_settle(&mesh->log);
    if (info != NULL) {
        srv_mesh_info(mesh, info);
    }
    return API_STORE_OK;
}

void srv_mesh_replace(void *self, api_mesh *mesh, he_mesh *content, api_mesh_info *info)
{
    (void)self;
    roll_back(mesh);
    assert(mesh->discard == NULL);
    mesh->discard = mesh->content;
    mesh->content = content;
    he_mesh_record(content, NULL);
    double now = revise(mesh);
    srv_log_add_barrier(&mesh->log, mesh->info.revision, API_REPLACE, "replace", now, content);
    srv_mesh_append(mesh, API_REPLACE, NULL, false);
    if (info != NULL) {
        srv_mesh_info(mesh, info);
    }
}

void srv_mesh_rename(void *self, api_mesh *mesh, const char *name, api_mesh_info *info)
{
    (void)self;
    size_t length = strnlen(name, API_MESH_NAME);
    memcpy(mesh->info.name, name, length);
    mesh->info.name[length] = '\0';
    mesh->info.metadata++;
    mesh->info.modified = srv_clock_utc();
    srv_mesh_append(mesh, API_EDIT, NULL, false);
    if (info != NULL) {
        srv_mesh_info(mesh, info);
    }
}

void srv_write_end(void *self, api_mesh *mesh)
{
    (void)self;
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
        srv_mesh_shed(mesh);
    }
}
