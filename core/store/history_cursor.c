#include "store/history_cursor.h"

#include "store/mesh_load.h"
#include "store/stored_mesh.h"
#include "system/lock.h"
#include "system/memory.h"

/* Moving a copy of a mesh to another revision by TURN_BYTES bytes of deltas (recorded changes)
 * takes some milliseconds. Then the lock of the mesh is released, so that writers can take it. */
enum { TURN_BYTES = 8 << 20 };

struct st_cursor {
    st_mesh *mesh;
    he_replay *replay;
    uint64_t at;
    /* the step (one change of the mesh) that st_cursor_next returned last; the cursor has a
     * reference to it */
    st_step *held;
};

static st_status no_memory(void)
{
    return st_memory_is_full() ? ST_BUDGET : ST_NO_MEMORY;
}

static st_status bounds(const st_revision_log *log, uint64_t revision)
{
    if (revision > st_log_head(log)) {
        return ST_AHEAD;
    }
    return revision < log->oldest ? ST_GONE : ST_OK;
}

/* Moves a copy of the mesh towards the wanted revision by at most `most` bytes of deltas (recorded
 * changes). If there is no copy yet, copies the mesh at its newest revision first. The caller holds
 * the shared lock of the mesh. */
static he_status one_turn(const st_mesh *mesh, he_replay **replay, uint64_t *at, uint64_t revision,
                          uint64_t most)
{
    if (*replay == NULL) {
        he_status status = he_replay_new(mesh->content, replay, NULL);
        if (status != HE_OK) {
            return status;
        }
        *at = st_log_head(&mesh->log);
    }
    return st_log_walk(&mesh->log, *replay, at, revision, most);
}

st_status st_replay_to(st_mesh *mesh, he_replay **replay, uint64_t *at, uint64_t revision)
{
    st_status status;
    uint64_t most = TURN_BYTES;
    do {
        st_lock_read(&mesh->lock);
        he_status walked = HE_OK;
        status = bounds(&mesh->log, revision);
        if (status == ST_OK) {
            walked = one_turn(mesh, replay, at, revision, most);
        }
        pthread_rwlock_unlock(&mesh->lock);
        if (walked == HE_NO_MEMORY) {
            status = no_memory();
        } else if (walked != HE_OK) {
            /* In the meantime changes were undone and redone, so that this copy cannot be moved to
             * the wanted revision. It is replaced by a new copy of the newest revision. */
            he_replay_free(*replay);
            *replay = NULL;
            most = UINT64_MAX;
        }
    } while (status == ST_OK && (*replay == NULL || *at != revision));
    if (status != ST_OK) {
        he_replay_free(*replay);
        *replay = NULL;
    }
    return status;
}

/* Begins at a revision that is no longer in the history in memory. The records on the disk may
 * still lead to it, so the mesh is loaded a second time from the disk with its whole history. */
static st_status begin_on_disk(st_cursor *cursor, st_mesh *mesh, uint64_t revision)
{
    st_status status = st_mesh_load_apart(mesh, 0, &cursor->mesh);
    return status == ST_OK ? st_replay_to(cursor->mesh, &cursor->replay, &cursor->at, revision)
                           : status;
}

st_status st_cursor_begin(st_mesh *mesh, uint64_t revision, st_cursor **out)
{
    st_cursor *cursor = he_mem_zero(1, sizeof *cursor);
    if (cursor == NULL) {
        return ST_NO_MEMORY;
    }
    cursor->mesh = st_hold(mesh);
    st_status status = st_replay_to(mesh, &cursor->replay, &cursor->at, revision);
    if (status == ST_GONE && revision > 0) {
        cursor->mesh = NULL;
        status = begin_on_disk(cursor, mesh, revision);
        st_release(mesh);
    }
    if (status != ST_OK) {
        st_cursor_end(cursor);
        return status;
    }
    *out = cursor;
    return ST_OK;
}

const he_mesh *st_cursor_content(const st_cursor *cursor)
{
    return he_replay_mesh(cursor->replay);
}

uint64_t st_cursor_revision(const st_cursor *cursor)
{
    return cursor->at;
}

/* Moves the cursor to the next revision. The caller holds the shared lock of the mesh. */
static st_status advance(st_cursor *cursor, st_action *action)
{
    const st_revision_log *log = &cursor->mesh->log;
    uint64_t next = cursor->at + 1;
    if (cursor->replay == NULL || cursor->at < log->oldest) {
        return ST_GONE;
    }
    if (next > st_log_head(log)) {
        return ST_NOTHING;
    }
    he_status walked = one_turn(cursor->mesh, &cursor->replay, &cursor->at, next, UINT64_MAX);
    if (walked == HE_UNSUPPORTED) {
        he_replay_free(cursor->replay);
        cursor->replay = NULL;
        walked = one_turn(cursor->mesh, &cursor->replay, &cursor->at, next, UINT64_MAX);
    }
    if (walked != HE_OK) {
        he_replay_free(cursor->replay);
        cursor->replay = NULL;
        return no_memory();
    }
    cursor->held = st_log_hold(log, next, action);
    return ST_OK;
}

st_status st_cursor_next(st_cursor *cursor, st_cursor_step *out)
{
    st_action action = ST_EDIT;
    st_step_release(cursor->held);
    cursor->held = NULL;
    st_lock_read(&cursor->mesh->lock);
    st_status status = advance(cursor, &action);
    pthread_rwlock_unlock(&cursor->mesh->lock);
    if (status == ST_OK) {
        *out = (st_cursor_step){
            .revision = cursor->at,
            .action = action,
            .delta = st_step_delta(cursor->held),
            .undone = action == ST_UNDO,
            .content = he_replay_mesh(cursor->replay),
        };
    }
    return status;
}

void st_cursor_end(st_cursor *cursor)
{
    if (cursor != NULL) {
        st_step_release(cursor->held);
        he_replay_free(cursor->replay);
        st_release(cursor->mesh);
        he_mem_free(cursor);
    }
}
