#include "server/stored_mesh.h"

#include "server/memory.h"

/* What one caller holds: a copy that many may share, and the facts as they were when it asked. */
struct api_snapshot {
    srv_copy *copy;
    api_mesh_info info;
};

void srv_copy_release(srv_copy *copy)
{
    if (copy != NULL && atomic_fetch_sub_explicit(&copy->uses, 1, memory_order_acq_rel) == 1) {
        he_mesh_free(copy->content);
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
static bool bring_forward(const api_mesh *mesh, srv_copy *copy)
{
    uint32_t issued[HE_KIND_COUNT];
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        issued[kind] = he_mesh_issued(mesh->content, (he_kind)kind);
    }
    return srv_log_replay(&mesh->log, copy->revision, he_mesh_bytes(mesh->content) / 2,
                          copy->content, issued) == HE_OK;
}

static srv_copy *copy_new(const api_mesh *mesh)
{
    srv_copy *copy = he_mem_zero(1, sizeof *copy);
    if (copy == NULL) {
        return NULL;
    }
    if (he_mesh_copy(mesh->content, &copy->content, NULL) != HE_OK) {
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

api_store_status srv_snapshot(void *self, api_mesh *mesh, api_snapshot **out)
{
    (void)self;
    api_snapshot *snapshot = he_mem_zero(1, sizeof *snapshot);
    if (snapshot == NULL) {
        return API_STORE_NO_MEMORY;
    }
    pthread_rwlock_rdlock(&mesh->lock);
    pthread_mutex_lock(&mesh->snapshot_lock);
    snapshot->copy = present_copy(mesh);
    if (snapshot->copy != NULL) {
        atomic_fetch_add_explicit(&snapshot->copy->uses, 1, memory_order_relaxed);
        srv_mesh_info(mesh, &snapshot->info);
    }
    pthread_mutex_unlock(&mesh->snapshot_lock);
    pthread_rwlock_unlock(&mesh->lock);
    if (snapshot->copy == NULL) {
        he_mem_free(snapshot);
        return srv_memory_is_full() ? API_STORE_BUDGET : API_STORE_NO_MEMORY;
    }
    *out = snapshot;
    return API_STORE_OK;
}

const he_mesh *srv_snapshot_content(const api_snapshot *snapshot, api_mesh_info *info)
{
    if (info != NULL) {
        *info = snapshot->info;
    }
    return snapshot->copy->content;
}

void srv_snapshot_release(void *self, api_snapshot *snapshot)
{
    (void)self;
    if (snapshot != NULL) {
        srv_copy_release(snapshot->copy);
        he_mem_free(snapshot);
    }
}

void srv_mesh_shed(api_mesh *mesh)
{
    pthread_mutex_lock(&mesh->snapshot_lock);
    if (mesh->copy != NULL && is_cached_alone(mesh->copy)) {
        srv_copy_release(mesh->copy);
        mesh->copy = NULL;
    }
    pthread_mutex_unlock(&mesh->snapshot_lock);
    srv_feed_shed(&mesh->feed);
}
