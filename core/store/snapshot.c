#include "store/stored_mesh.h"

#include "store/history_cursor.h"
#include "store/mesh_load.h"
#include "store/table.h"
#include "system/clock.h"
#include "system/lock.h"
#include "system/memory.h"

/* A snapshot: a reference to a copy of the mesh, which many snapshots may share, and the name,
 * revision and counts of the mesh when the snapshot was taken. */
struct st_snapshot {
    st_copy *copy;
    st_mesh_info info;
};

void st_copy_release(st_copy *copy)
{
    if (copy != NULL && atomic_fetch_sub_explicit(&copy->uses, 1, memory_order_acq_rel) == 1) {
        st_count(&copy->counts->copies, 0 - copy->bytes);
        he_replay_free(copy->replay);
        he_mem_free(copy);
    }
}

/* Counts the bytes of a cached copy of a mesh for monitoring, with the columns and positions that
 * the copy keeps to undo and redo edits. Must be called again after the copy was moved to another
 * revision. */
static void count_copy(st_copy *copy, const st_mesh *mesh)
{
    const uint64_t before = copy->bytes;
    copy->counts = &mesh->followers->counts;
    copy->bytes = he_replay_bytes(copy->replay);
    st_count(&copy->counts->copies, copy->bytes - before);
}

/* Adds a reference to a copy for a snapshot. The caller holds the lock of the cache of the copy. */
static void use(st_copy *copy)
{
    atomic_store_explicit(&copy->used, st_clock_micros(), memory_order_relaxed);
    atomic_fetch_add_explicit(&copy->uses, 1, memory_order_relaxed);
}

/* Returns true if only the cache has a reference to a copy. The caller holds the snapshot lock,
 * without which no other thread can get a reference. */
static bool is_cached_alone(const st_copy *copy)
{
    return atomic_load_explicit(&copy->uses, memory_order_acquire) == 1;
}

/* Decides whether the cached copy of a mesh is updated to the present revision or made anew.
 * Applying a delta takes about one random memory access for each record; copying is sequential. So
 * if the deltas have more than half as many bytes as the mesh, a new copy is cheaper. */
static bool is_near(const st_mesh *mesh, uint64_t from, uint64_t to)
{
    return st_log_distance(&mesh->log, from, to) <= he_mesh_bytes(mesh->content) / 2;
}

/* Returns true if the newest edit, undo or redo did nothing but write all positions. Its delta owns
 * the positions from before it, so a copy takes those from after it from the mesh. */
static bool moved_all(const st_revision_log *log)
{
    const he_delta *delta = st_log_delta(log, st_log_head(log));
    return delta != NULL && delta->count == 1 && delta->records[0].column == HE_COL_POSITIONS;
}

static bool bring_forward(const st_mesh *mesh, st_copy *copy)
{
    const uint64_t head = mesh->info.revision;
    const bool moved = moved_all(&mesh->log);
    if (!is_near(mesh, copy->revision, head) ||
        st_log_walk(&mesh->log, copy->replay, &copy->revision, moved ? head - 1 : head,
                    UINT64_MAX) != HE_OK) {
        return false;
    }
    if (moved) {
        he_replay_take_positions(copy->replay, mesh->content);
    }
    return true;
}

static st_copy *copy_new(const st_mesh *mesh)
{
    st_copy *copy = he_mem_zero(1, sizeof *copy);
    if (copy == NULL) {
        return NULL;
    }
    if (he_replay_new(mesh->content, &copy->replay, NULL) != HE_OK) {
        he_mem_free(copy);
        return NULL;
    }
    atomic_init(&copy->uses, 1);
    count_copy(copy, mesh);
    return copy;
}

/* Returns the cached copy if it shows the present revision, else NULL. The caller holds the mesh's
 * shared lock and the snapshot lock. */
static st_copy *present_copy(st_mesh *mesh)
{
    st_copy *copy = mesh->copy;
    if (copy != NULL && copy->revision == mesh->info.revision) {
        return copy;
    }
    if (copy != NULL && !(is_cached_alone(copy) && bring_forward(mesh, copy))) {
        mesh->copy = NULL;
        st_copy_release(copy);
    }
    if (mesh->copy == NULL) {
        mesh->copy = copy_new(mesh);
    } else {
        count_copy(mesh->copy, mesh);
    }
    if (mesh->copy != NULL) {
        mesh->copy->revision = mesh->info.revision;
    }
    return mesh->copy;
}

st_status st_snapshot_held(st_mesh *mesh, st_snapshot **out)
{
    st_snapshot *snapshot = he_mem_zero(1, sizeof *snapshot);
    if (snapshot == NULL) {
        return ST_NO_MEMORY;
    }
    st_lock_mutex(&mesh->snapshot_lock);
    snapshot->copy = present_copy(mesh);
    if (snapshot->copy != NULL) {
        use(snapshot->copy);
        st_mesh_facts(mesh, &snapshot->info);
    }
    pthread_mutex_unlock(&mesh->snapshot_lock);
    if (snapshot->copy == NULL) {
        he_mem_free(snapshot);
        return st_memory_is_full() ? ST_BUDGET : ST_NO_MEMORY;
    }
    *out = snapshot;
    return ST_OK;
}

st_status st_snapshot_take(st_mesh *mesh, st_snapshot **out)
{
    st_lock_read(&mesh->lock);
    st_status status = st_snapshot_held(mesh, out);
    pthread_rwlock_unlock(&mesh->lock);
    return status;
}

/* Makes `replay`, which shows an earlier revision of the mesh, the cached copy of an earlier
 * revision; the cache then owns it. The caller holds the past lock (store.h). */
static st_status cache_past(st_mesh *mesh, he_replay *replay, uint64_t revision, double time)
{
    st_copy *copy = he_mem_zero(1, sizeof *copy);
    if (copy == NULL) {
        he_replay_free(replay);
        return ST_NO_MEMORY;
    }
    atomic_init(&copy->uses, 1);
    copy->replay = replay;
    count_copy(copy, mesh);
    copy->revision = revision;
    copy->time = time;
    st_copy_release(mesh->past);
    mesh->past = copy;
    return ST_OK;
}

/* Decides whether the history in memory reaches back to the wanted revision, and whether the cached
 * copy of an earlier revision can be moved to this revision. */
static st_status find_past(st_mesh *mesh, uint64_t revision, double *time, bool *movable)
{
    const st_copy *copy = mesh->past;
    st_point point;
    st_lock_read(&mesh->lock);
    st_status status = revision > st_log_head(&mesh->log) ? ST_AHEAD
                       : revision < mesh->log.oldest      ? ST_GONE
                                                          : ST_OK;
    if (status == ST_OK) {
        st_log_point(&mesh->log, revision, &point);
        *time = point.time;
        *movable = copy != NULL && is_cached_alone(copy) && is_near(mesh, copy->revision, revision);
    }
    pthread_rwlock_unlock(&mesh->lock);
    return status;
}

uint64_t st_elements_at(st_mesh *mesh, uint64_t revision)
{
    st_point point;
    st_lock_read(&mesh->lock);
    const st_revision_log *log = &mesh->log;
    const uint64_t head = st_log_head(log);
    st_log_point(log, revision >= log->oldest && revision <= head ? revision : head, &point);
    pthread_rwlock_unlock(&mesh->lock);
    return (uint64_t)point.issued[HE_VERTEX] + point.issued[HE_HALFEDGE] + point.issued[HE_FACE];
}

/* Makes the copy of an earlier revision by the history in memory. The caller holds the past lock
 * (store.h). */
static st_status copy_from_history(st_mesh *mesh, uint64_t revision)
{
    he_replay *replay = NULL;
    uint64_t at = 0;
    double time = 0;
    bool movable = false;
    st_status status = find_past(mesh, revision, &time, &movable);
    if (status != ST_OK) {
        return status;
    }
    if (movable) {
        replay = mesh->past->replay;
        at = mesh->past->revision;
        mesh->past->replay = NULL;
        st_copy_release(mesh->past);
        mesh->past = NULL;
    }
    status = st_replay_to(mesh, &replay, &at, revision);
    return status == ST_OK ? cache_past(mesh, replay, revision, time) : status;
}

/* Makes the copy of a revision that is no longer in the history in memory. The mesh is loaded a
 * second time from the disk, up to this revision, and becomes the cached copy. The caller holds the
 * past lock (store.h). */
static st_status copy_from_disk(st_mesh *mesh, uint64_t revision)
{
    st_mesh *loaded;
    he_replay *replay = NULL;
    st_point point;
    st_status status = st_mesh_load_apart(mesh, revision, &loaded);
    if (status != ST_OK) {
        return status;
    }
    st_log_point(&loaded->log, revision, &point);
    if (he_replay_new(loaded->content, &replay, NULL) == HE_OK) {
        status = cache_past(mesh, replay, revision, point.time);
    } else {
        status = st_memory_is_full() ? ST_BUDGET : ST_NO_MEMORY;
    }
    st_release(loaded);
    return status;
}

/* Makes the cached copy show the wanted earlier revision: moves it there, or makes a new copy. The
 * caller holds the past lock (store.h). */
static st_status seek_past(st_mesh *mesh, uint64_t revision)
{
    if (mesh->past != NULL && mesh->past->revision == revision) {
        return ST_OK;
    }
    st_status status = copy_from_history(mesh, revision);
    return status == ST_GONE && revision > 0 ? copy_from_disk(mesh, revision) : status;
}

st_status st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out)
{
    st_snapshot *snapshot = he_mem_zero(1, sizeof *snapshot);
    if (snapshot == NULL) {
        return ST_NO_MEMORY;
    }
    st_lock_mutex(&mesh->past_lock);
    st_status status = seek_past(mesh, revision);
    if (status == ST_OK) {
        /* The snapshot states the revision and time of the copy, and the present name and counts of
         * the mesh. */
        snapshot->copy = mesh->past;
        use(snapshot->copy);
        (void)st_read_begin(mesh, &snapshot->info);
        st_read_end(mesh);
        snapshot->info.revision = revision;
        snapshot->info.modified = snapshot->copy->time;
    }
    pthread_mutex_unlock(&mesh->past_lock);
    if (status != ST_OK) {
        he_mem_free(snapshot);
        return status;
    }
    *out = snapshot;
    return ST_OK;
}

const he_mesh *st_snapshot_content(const st_snapshot *snapshot, st_mesh_info *info)
{
    if (info != NULL) {
        *info = snapshot->info;
    }
    return he_replay_mesh(snapshot->copy->replay);
}

void st_snapshot_release(st_snapshot *snapshot)
{
    if (snapshot != NULL) {
        atomic_store_explicit(&snapshot->copy->used, st_clock_micros(), memory_order_relaxed);
        st_copy_release(snapshot->copy);
        he_mem_free(snapshot);
    }
}

static void shed(st_copy **copy)
{
    if (*copy != NULL && is_cached_alone(*copy)) {
        st_copy_release(*copy);
        *copy = NULL;
    }
}

/* Takes a copy that no thread is reading, and that was last used before `before`, out of its cache,
 * so that it can be freed without the lock of the cache, which freeing many bytes would hold long.
 */
static st_copy *take_expired(st_copy **copy, pthread_mutex_t *lock, uint64_t before)
{
    st_copy *taken = NULL;
    if (pthread_mutex_trylock(lock) != 0) {
        return NULL;
    }
    if (*copy != NULL && is_cached_alone(*copy) &&
        atomic_load_explicit(&(*copy)->used, memory_order_relaxed) < before) {
        taken = *copy;
        *copy = NULL;
    }
    pthread_mutex_unlock(lock);
    return taken;
}

/* How much longer the copy of an earlier revision is kept: it takes many deltas, or reading the
 * mesh from the disk, to make it again. */
enum { PAST_MICROS = 10 * 1000 * 1000 };

void st_copy_expire(st_mesh *mesh, uint64_t before)
{
    const uint64_t past = before > PAST_MICROS ? before - PAST_MICROS : 0;
    st_copy_release(take_expired(&mesh->copy, &mesh->snapshot_lock, before));
    st_copy_release(take_expired(&mesh->past, &mesh->past_lock, past));
}

void st_copy_shed(st_mesh *mesh)
{
    st_lock_mutex(&mesh->snapshot_lock);
    shed(&mesh->copy);
    pthread_mutex_unlock(&mesh->snapshot_lock);
    st_queue_shed(&mesh->queue);
    /* A thread that holds this lock is making a copy, so the copy must not be freed. */
    if (pthread_mutex_trylock(&mesh->past_lock) == 0) {
        shed(&mesh->past);
        pthread_mutex_unlock(&mesh->past_lock);
    }
}
