#include "server/store/replay_walk.h"

#include "server/system/memory.h"

/* Bytes of deltas that are replayed before writers get their turn: some milliseconds. */
enum { TURN_BYTES = 8 << 20 };

struct srv_walk {
    api_mesh *mesh;
    he_replay *replay;
    uint64_t at;
    srv_step *held; /* what the last step lends */
};

static api_store_status no_memory(void)
{
    return srv_memory_is_full() ? API_STORE_BUDGET : API_STORE_NO_MEMORY;
}

static api_store_status bounds(const srv_revision_log *log, uint64_t revision)
{
    if (revision > srv_log_head(log)) {
        return API_STORE_AHEAD;
    }
    return revision < log->oldest ? API_STORE_GONE : API_STORE_OK;
}

/* Under the shared lock: towards the revision, from the head where there is no copy yet. */
static he_status one_turn(const api_mesh *mesh, he_replay **replay, uint64_t *at, uint64_t revision,
                          uint64_t most)
{
    if (*replay == NULL) {
        he_status status = he_replay_new(mesh->content, replay, NULL);
        if (status != HE_OK) {
            return status;
        }
        *at = srv_log_head(&mesh->log);
    }
    return srv_log_walk(&mesh->log, *replay, at, revision, most);
}

api_store_status srv_replay_to(api_mesh *mesh, he_replay **replay, uint64_t *at, uint64_t revision)
{
    api_store_status status;
    uint64_t most = TURN_BYTES;
    do {
        pthread_rwlock_rdlock(&mesh->lock);
        he_status walked = HE_OK;
        status = bounds(&mesh->log, revision);
        if (status == API_STORE_OK) {
            walked = one_turn(mesh, replay, at, revision, most);
        }
        pthread_rwlock_unlock(&mesh->lock);
        if (walked == HE_NO_MEMORY) {
            status = no_memory();
        } else if (walked != HE_OK) {
            /* The mesh has gone back and forth meanwhile: from its head all is at hand, if it
             * stands still. */
            he_replay_free(*replay);
            *replay = NULL;
            most = UINT64_MAX;
        }
    } while (status == API_STORE_OK && (*replay == NULL || *at != revision));
    if (status != API_STORE_OK) {
        he_replay_free(*replay);
        *replay = NULL;
    }
    return status;
}

api_store_status srv_walk_begin(api_mesh *mesh, uint64_t revision, srv_walk **out)
{
    srv_walk *walk = he_mem_zero(1, sizeof *walk);
    if (walk == NULL) {
        return API_STORE_NO_MEMORY;
    }
    api_store_status status = srv_replay_to(mesh, &walk->replay, &walk->at, revision);
    if (status != API_STORE_OK) {
        he_mem_free(walk);
        return status;
    }
    walk->mesh = mesh;
    atomic_fetch_add_explicit(&mesh->uses, 1, memory_order_relaxed);
    *out = walk;
    return API_STORE_OK;
}

const he_mesh *srv_walk_content(const srv_walk *walk)
{
    return he_replay_mesh(walk->replay);
}

uint64_t srv_walk_revision(const srv_walk *walk)
{
    return walk->at;
}

/* Under the shared lock. */
static api_store_status advance(srv_walk *walk, api_action *action)
{
    const srv_revision_log *log = &walk->mesh->log;
    uint64_t next = walk->at + 1;
    if (walk->replay == NULL || walk->at < log->oldest) {
        return API_STORE_GONE;
    }
    if (next > srv_log_head(log)) {
        return API_STORE_NOTHING;
    }
    he_status walked = one_turn(walk->mesh, &walk->replay, &walk->at, next, UINT64_MAX);
    if (walked == HE_UNSUPPORTED) {
        he_replay_free(walk->replay);
        walk->replay = NULL;
        walked = one_turn(walk->mesh, &walk->replay, &walk->at, next, UINT64_MAX);
    }
    if (walked != HE_OK) {
        he_replay_free(walk->replay);
        walk->replay = NULL;
        return no_memory();
    }
    walk->held = srv_log_hold(log, next, action);
    return API_STORE_OK;
}

api_store_status srv_walk_next(srv_walk *walk, srv_walk_step *out)
{
    api_action action = API_EDIT;
    srv_step_release(walk->held);
    walk->held = NULL;
    pthread_rwlock_rdlock(&walk->mesh->lock);
    api_store_status status = advance(walk, &action);
    pthread_rwlock_unlock(&walk->mesh->lock);
    if (status == API_STORE_OK) {
        *out = (srv_walk_step){
            .revision = walk->at,
            .action = action,
            .delta = srv_step_delta(walk->held),
            .undone = action == API_UNDO,
            .content = he_replay_mesh(walk->replay),
        };
    }
    return status;
}

void srv_walk_end(srv_walk *walk)
{
    if (walk != NULL) {
        srv_step_release(walk->held);
        he_replay_free(walk->replay);
        srv_mesh_release(walk->mesh);
        he_mem_free(walk);
    }
}
