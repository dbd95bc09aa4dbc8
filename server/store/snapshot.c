#include "server/store/stored_mesh.h"

#include "server/store/replay_walk.h"
#include "server/system/memory.h"

/* What one caller holds: a copy that many may share, and the facts as they were when it asked. */
struct api_snapshot {
    srv_copy *copy;
    api_mesh_info info;
};

void srv_copy_release(srv_copy *copy)
{
    if (copy != NULL && atomic_fetch_sub_explicit(&copy->uses, 1, memory_order_acq_rel) == 1) {
        he_replay_free(copy->replay);
        he_mem_free(copy);
    }
}

/* Under the snapshot lock nobody else can begin to use the cached copy. */
static bool is_cached_alone(const srv_copy *copy)
{
    return atomic_load_explicit(&copy->uses, memory_order_acquire) == 1;
}

/* Replaying costs about a random access a record, copying a stream: above half the mesh's bytes
 * the copy is cheaper. */
static bool is_near(const api_mesh *mesh, uint64_t from, uint64_t to)
{
    return srv_log_distance(&mesh->log, from, to) <= he_mesh_bytes(mesh->content) / 2;
}

static bool bring_forward(const api_mesh *mesh, srv_copy *copy)
{
    uint64_t head = mesh->info.revision;
    return is_near(mesh, copy->revision, head) &&
           srv_log_walk(&mesh->log, copy->replay, &copy->revision, head, UINT64_MAX) == HE_OK;
}

static srv_copy *copy_new(const api_mesh *mesh)
{
    srv_copy *copy = he_mem_zero(1, sizeof *copy);
    if (copy == NULL) {
        return NULL;
    }
    if (he_replay_new(mesh->content, &copy->replay, NULL) != HE_OK) {
        he_mem_free(copy);
        return NULL;
    }
    atomic_init(&copy->uses, 1);
    return copy;
}

/* The cached copy at the present revision, or NULL. Under both locks. */
static srv_copy *present_copy(api_mesh *mesh)
{
    srv_copy *copy = mesh->copy;
    if (copy != NULL && copy->revision == mesh->info.revision) {
        return copy;
    }
    if (copy != NULL && !(is_cached_alone(copy) && bring_forward(mesh, copy))) {
        mesh->copy = NULL;
        srv_copy_release(copy);
    }
    if (mesh->copy == NULL) {
        mesh->copy = copy_new(mesh);
    }
    if (mesh->copy != NULL) {
        mesh->copy->revision = mesh->info.revision;
    }
    return mesh->copy;
}

api_store_status srv_snapshot_held(void *self, api_mesh *mesh, api_snapshot **out)
{
    (void)self;
    api_snapshot *snapshot = he_mem_zero(1, sizeof *snapshot);
    if (snapshot == NULL) {
        return API_STORE_NO_MEMORY;
    }
    pthread_mutex_lock(&mesh->snapshot_lock);
    snapshot->copy = present_copy(mesh);
    if (snapshot->copy != NULL) {
        atomic_fetch_add_explicit(&snapshot->copy->uses, 1, memory_order_relaxed);
        srv_mesh_info(mesh, &snapshot->info);
    }
    pthread_mutex_unlock(&mesh->snapshot_lock);
    if (snapshot->copy == NULL) {
        he_mem_free(snapshot);
        return srv_memory_is_full() ? API_STORE_BUDGET : API_STORE_NO_MEMORY;
    }
    *out = snapshot;
    return API_STORE_OK;
}

api_store_status srv_snapshot(void *self, api_mesh *mesh, api_snapshot **out)
{
    pthread_rwlock_rdlock(&mesh->lock);
    api_store_status status = srv_snapshot_held(self, mesh, out);
    pthread_rwlock_unlock(&mesh->lock);
    return status;
}

/* The cached copy of an earlier revision, made or moved there. Under the past lock. */
static api_store_status past_copy(api_mesh *mesh, uint64_t revision)
{
    srv_copy *copy = mesh->past;
    if (copy != NULL && copy->revision == revision) {
        return API_STORE_OK;
    }
    mesh->past = NULL;
    if (copy != NULL) {
        pthread_rwlock_rdlock(&mesh->lock);
        bool near = is_near(mesh, copy->revision, revision);
        pthread_rwlock_unlock(&mesh->lock);
        if (!is_cached_alone(copy) || !near) {
            srv_copy_release(copy);
            copy = NULL;
        }
    }
    if (copy == NULL) {
        copy = he_mem_zero(1, sizeof *copy);
        if (copy == NULL) {
            return API_STORE_NO_MEMORY;
        }
        atomic_init(&copy->uses, 1);
    }
    api_store_status status = srv_replay_to(mesh, &copy->replay, &copy->revision, revision);
    if (status != API_STORE_OK) {
        srv_copy_release(copy);
        return status;
    }
    mesh->past = copy;
    return API_STORE_OK;
}

/* The facts of now, but for the revision and its time. */
static api_store_status past_info(api_mesh *mesh, uint64_t revision, api_mesh_info *out)
{
    srv_point point;
    pthread_rwlock_rdlock(&mesh->lock);
    bool there = revision >= mesh->log.oldest;
    if (there) {
        srv_mesh_info(mesh, out);
        srv_log_point(&mesh->log, revision, &point);
        out->revision = revision;
        out->modified = point.time;
    }
    pthread_rwlock_unlock(&mesh->lock);
    return there ? API_STORE_OK : API_STORE_GONE;
}

api_store_status srv_snapshot_at(void *self, api_mesh *mesh, uint64_t revision, api_snapshot **out)
{
    (void)self;
    api_snapshot *snapshot = he_mem_zero(1, sizeof *snapshot);
    if (snapshot == NULL) {
        return API_STORE_NO_MEMORY;
    }
    pthread_mutex_lock(&mesh->past_lock);
    api_store_status status = past_copy(mesh, revision);
    if (status == API_STORE_OK) {
        status = past_info(mesh, revision, &snapshot->info);
    }
    if (status == API_STORE_OK) {
        snapshot->copy = mesh->past;
        atomic_fetch_add_explicit(&snapshot->copy->uses, 1, memory_order_relaxed);
    } else {
        srv_copy_release(mesh->past);
        mesh->past = NULL;
    }
    pthread_mutex_unlock(&mesh->past_lock);
    if (status != API_STORE_OK) {
        he_mem_free(snapshot);
        return status;
    }
    *out = snapshot;
    return API_STORE_OK;
}

const he_mesh *srv_snapshot_content(const api_snapshot *snapshot, api_mesh_info *info)
{
    if (info != NULL) {
        *info = snapshot->info;
    }
    return he_replay_mesh(snapshot->copy->replay);
}

void srv_snapshot_release(void *self, api_snapshot *snapshot)
{
    (void)self;
    if (snapshot != NULL) {
        srv_copy_release(snapshot->copy);
        he_mem_free(snapshot);
    }
}

static void shed(srv_copy **copy)
{
    if (*copy != NULL && is_cached_alone(*copy)) {
        srv_copy_release(*copy);
        *copy = NULL;
    }
}

void srv_copy_shed(api_mesh *mesh)
{
    pthread_mutex_lock(&mesh->snapshot_lock);
    shed(&mesh->copy);
    pthread_mutex_unlock(&mesh->snapshot_lock);
    srv_feed_shed(&mesh->feed);
    /* Held for as long as a copy is being made; that one is wanted. */
    if (pthread_mutex_trylock(&mesh->past_lock) == 0) {
        shed(&mesh->past);
        pthread_mutex_unlock(&mesh->past_lock);
    }
}
