#include "server/store/stored_mesh.h"

#include "server/store/mesh_events.h"
#include "server/system/clock.h"
#include "server/system/random.h"

#include <string.h>

static void copy_name(char *out, size_t size, const char *name)
{
    size_t length = strlen(name);
    if (length >= size) {
        length = size - 1;
        /* Not inside a UTF-8 sequence. */
        while (length > 0 && ((unsigned char)name[length] & 0xC0) == 0x80) {
            length--;
        }
    }
    memcpy(out, name, length);
    out[length] = '\0';
}

/* A steady stream of readers must not keep a writer out. */
static int init_lock(pthread_rwlock_t *lock)
{
    pthread_rwlockattr_t attributes;
    pthread_rwlockattr_init(&attributes);
#ifdef __GLIBC__
    pthread_rwlockattr_setkind_np(&attributes, PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP);
#endif
    int failed = pthread_rwlock_init(lock, &attributes);
    pthread_rwlockattr_destroy(&attributes);
    return failed;
}

api_mesh *srv_mesh_new(const char *id, const char *name, he_mesh *content, uint64_t undo_budget,
                       const srv_journal *journal, const uint64_t secret[2])
{
    api_mesh *mesh = he_mem_zero(1, sizeof *mesh);
    if (mesh == NULL || init_lock(&mesh->lock) != 0) {
        he_mem_free(mesh);
        return NULL;
    }
    pthread_mutex_init(&mesh->snapshot_lock, NULL);
    pthread_mutex_init(&mesh->past_lock, NULL);
    pthread_mutex_init(&mesh->cache_lock, NULL);
    srv_keys_init(&mesh->keys, secret);
    for (int kind = 0; kind < API_DERIVED_COUNT; kind++) {
        pthread_mutex_init(&mesh->derived[kind].lock, NULL);
        srv_clock_condition(&mesh->derived[kind].ended);
    }
    atomic_init(&mesh->uses, 1);
    mesh->journal = journal;
    copy_name(mesh->info.id, sizeof mesh->info.id, id);
    copy_name(mesh->info.name, sizeof mesh->info.name, name == NULL ? "" : name);
    mesh->info.incarnation = srv_random();
    mesh->info.metadata = 1;
    mesh->info.revision = 1;
    mesh->info.created = srv_clock_utc();
    mesh->info.modified = mesh->info.created;
    mesh->content = content;
    srv_log_init(&mesh->log, undo_budget, mesh->info.revision, content, mesh->info.created);
    srv_feed_init(&mesh->feed, (srv_place){.stamp = mesh->info.record, .key = mesh->info.revision});
    return mesh;
}

static void drop_derived(api_mesh *mesh)
{
    for (int kind = 0; kind < API_DERIVED_COUNT; kind++) {
        api_derived *place = srv_derived_begin(NULL, mesh, (api_derived_kind)kind);
        if (place->value != NULL) {
            place->destroy(place->value);
            *place = (api_derived){NULL, NULL};
        }
        srv_derived_end(NULL, mesh, (api_derived_kind)kind);
    }
}

void srv_mesh_release(api_mesh *mesh)
{
    if (mesh == NULL || atomic_fetch_sub_explicit(&mesh->uses, 1, memory_order_acq_rel) > 1) {
        return;
    }
    srv_log_clear(&mesh->log);
    srv_feed_clear(&mesh->feed);
    he_mesh_free(mesh->content);
    srv_copy_release(mesh->copy);
    srv_copy_release(mesh->past);
    he_mem_free(mesh->cache);
    srv_keys_clear(&mesh->keys);
    drop_derived(mesh);
    pthread_rwlock_destroy(&mesh->lock);
    pthread_mutex_destroy(&mesh->snapshot_lock);
    pthread_mutex_destroy(&mesh->past_lock);
    pthread_mutex_destroy(&mesh->cache_lock);
    for (int kind = 0; kind < API_DERIVED_COUNT; kind++) {
        pthread_mutex_destroy(&mesh->derived[kind].lock);
        pthread_cond_destroy(&mesh->derived[kind].ended);
    }
    he_mem_free(mesh);
}

api_mesh *srv_mesh_retain(api_mesh *mesh)
{
    atomic_fetch_add_explicit(&mesh->uses, 1, memory_order_relaxed);
    return mesh;
}

void srv_mesh_info(const api_mesh *mesh, api_mesh_info *out)
{
    *out = mesh->info;
    out->undo = mesh->log.undo_count;
    out->redo = mesh->log.redo_count;
    out->busy = mesh->claimed;
}

void srv_mesh_append(api_mesh *mesh, api_action action, const he_delta *delta, bool undone)
{
    mesh->info.record++;
    srv_record record = {
        .id = mesh->info.id,
        .incarnation = mesh->info.incarnation,
        .number = mesh->info.record,
        .revision = mesh->info.revision,
        .name = mesh->info.name,
        .action = action,
        .delta = delta,
        .undone = undone,
        .removed = mesh->info.removed,
        .content = mesh->info.removed ? NULL : mesh->content,
        .claim = mesh->claim,
    };
    mesh->journal->append(mesh->journal->self, &record);
    srv_events_publish(mesh, &record);
}

const he_mesh *srv_read_begin(void *self, api_mesh *mesh, api_mesh_info *info)
{
    (void)self;
    pthread_rwlock_rdlock(&mesh->lock);
    if (info != NULL) {
        srv_mesh_info(mesh, info);
    }
    return mesh->content;
}

void srv_read_end(void *self, api_mesh *mesh)
{
    (void)self;
    pthread_rwlock_unlock(&mesh->lock);
}

bool srv_history(void *self, api_mesh *mesh, size_t i, struct api_entry *out)
{
    (void)self;
    return srv_log_entry(&mesh->log, i, out);
}

void srv_history_facts(void *self, api_mesh *mesh, struct api_history *out)
{
    (void)self;
    const srv_revision_log *log = &mesh->log;
    *out = (api_history){
        .oldest = log->oldest, .dropped = log->dropped, .bytes = log->bytes, .budget = log->budget};
}

bool srv_cache_get(void *self, api_mesh *mesh, void *value, size_t size)
{
    (void)self;
    pthread_mutex_lock(&mesh->cache_lock);
    bool found = mesh->cache != NULL && mesh->cache_size == size &&
                 mesh->cache_revision == mesh->info.revision;
    if (found) {
        memcpy(value, mesh->cache, size);
    }
    pthread_mutex_unlock(&mesh->cache_lock);
    return found;
}

/* Without memory nothing is kept, and the value is computed again the next time. */
void srv_cache_put(void *self, api_mesh *mesh, const void *value, size_t size)
{
    (void)self;
    pthread_mutex_lock(&mesh->cache_lock);
    if (mesh->cache_size != size) {
        he_mem_free(mesh->cache);
        mesh->cache = he_mem_alloc(size);
        mesh->cache_size = mesh->cache == NULL ? 0 : size;
    }
    if (mesh->cache != NULL) {
        memcpy(mesh->cache, value, size);
        mesh->cache_revision = mesh->info.revision;
    }
    pthread_mutex_unlock(&mesh->cache_lock);
}

api_derived *srv_derived_begin(void *self, api_mesh *mesh, api_derived_kind kind)
{
    (void)self;
    pthread_mutex_lock(&mesh->derived[kind].lock);
    return &mesh->derived[kind].place;
}

void srv_derived_end(void *self, api_mesh *mesh, api_derived_kind kind)
{
    (void)self;
    pthread_cond_broadcast(&mesh->derived[kind].ended);
    pthread_mutex_unlock(&mesh->derived[kind].lock);
}

void srv_derived_wait(void *self, api_mesh *mesh, api_derived_kind kind)
{
    (void)self;
    (void)srv_clock_wait(&mesh->derived[kind].ended, &mesh->derived[kind].lock,
                         srv_clock_micros() + API_DERIVED_MILLIS * 1000);
}

const he_delta *srv_revision_delta(void *self, api_mesh *mesh, uint64_t revision)
{
    (void)self;
    return srv_log_delta(&mesh->log, revision);
}

void srv_mesh_shed(api_mesh *mesh)
{
    srv_copy_shed(mesh);
    srv_keys_shed(&mesh->keys);
    drop_derived(mesh);
}
