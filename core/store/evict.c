/* evict.c - evicts unused meshes, which means that it removes them from memory, while memory is
 * short. A mesh is loaded from the journal again when a request needs it. */
#include "store/table.h"
#include "system/clock.h"
#include "system/memory.h"
#include "system/resident.h"

#include <time.h>

/* Times of last use are sorted into AGES classes to choose which meshes to evict (remove from
 * memory). */
enum { AGES = 256 };

/* Meshes are evicted (removed from memory) in batches of at most BATCH meshes, so that the lock of
 * the table of meshes is not held for long. */
enum { BATCH = 64 };

/* A mesh that was not used for COLD_MICROS may be evicted although no request needs its memory yet.
 * After an attempt that found no mesh to evict, the next attempt is made only after
 * BARREN_MICROS. */
enum { COLD_MICROS = 60 * 1000 * 1000, BARREN_MICROS = 50 * 1000 };

/* How long the copy of a mesh is kept after its last use. */
enum { COPY_MICROS = 1000 * 1000 };

/* LOCK_NANOS: how long a thread waits for the lock of the table of meshes. DISK_MICROS: how long it
 * waits for the disk if meshes can be evicted once their changes are durable. */
enum {
    LOCK_NANOS = 100 * 1000 * 1000,
    SECOND_NANOS = 1000 * 1000 * 1000,
    DISK_MICROS = 250 * 1000
};

void st_mesh_use(st_mesh *mesh)
{
    atomic_store_explicit(&mesh->used, st_clock_micros(), memory_order_relaxed);
}

/* Takes the lock of the table of meshes. Returns false after LOCK_NANOS. The wait is limited
 * because the calling thread may already have this lock, or may have a lock for which the owner of
 * this lock waits. */
static bool lock_table(st_store *store)
{
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += LOCK_NANOS;
    if (until.tv_nsec >= SECOND_NANOS) {
        until.tv_nsec -= SECOND_NANOS;
        until.tv_sec++;
    }
    return pthread_rwlock_timedwrlock(&store->lock, &until) == 0;
}

/* Returns true if the mesh can be evicted (removed from memory): all its changes are on the disk,
 * and only the table of meshes has a reference to it. A message that waits to be sent to listeners
 * also has a reference. The caller holds the exclusive lock of the table, so no thread can begin to
 * use the mesh. */
static bool is_cold(st_store *store, st_mesh *mesh)
{
    if (atomic_load_explicit(&mesh->uses, memory_order_acquire) > 1) {
        return false;
    }
    const st_shown shown = st_shown_of(&mesh->info);
    return st_waits_is_durable(store->followers.waits, &shown);
}

static uint64_t bytes_of(const st_mesh *mesh)
{
    return sizeof *mesh + he_mesh_bytes(mesh->content) + mesh->log.bytes + mesh->keys.bytes;
}

/* The bytes of the meshes in each class of times of last use. The sums tell which meshes must be
 * evicted to free a number of bytes: those last used before a limit. */
typedef struct ages {
    /* `first`: the earliest time of last use of any mesh; `span`: the time from `first` to the
     * latest time of last use */
    uint64_t first, span;
    uint64_t bytes[AGES];
} ages;

static size_t age_of(const ages *a, uint64_t used)
{
    return (size_t)((used - a->first) / (a->span / AGES + 1));
}

/* Returns a time such that evicting the meshes last used before it frees about `bytes` bytes. The
 * caller holds the lock of the table of meshes. */
static uint64_t find_limit(st_store *store, uint64_t bytes)
{
    ages a = {.first = UINT64_MAX};
    uint64_t last = 0, sum = 0;
    for (size_t i = 0; i < store->count; i++) {
        uint64_t used = atomic_load_explicit(&store->meshes[i]->used, memory_order_relaxed);
        a.first = used < a.first ? used : a.first;
        last = used > last ? used : last;
    }
    a.span = store->count == 0 ? 0 : last - a.first;
    for (size_t i = 0; i < store->count; i++) {
        st_mesh *mesh = store->meshes[i];
        if (is_cold(store, mesh)) {
            uint64_t used = atomic_load_explicit(&mesh->used, memory_order_relaxed);
            a.bytes[age_of(&a, used)] += bytes_of(mesh);
        }
    }
    size_t age = 0;
    while (age < AGES && sum < bytes) {
        sum += a.bytes[age++];
    }
    return a.first + age * (a.span / AGES + 1);
}

/* Takes at most BATCH meshes that were last used before `limit` out of the table of meshes. The
 * search begins at index *place, which is then set to where the next search must begin. */
static size_t take_out(st_store *store, uint64_t limit, size_t *place, st_mesh *batch[BATCH])
{
    size_t count = 0, to = *place, from = *place;
    if (!lock_table(store)) {
        return 0;
    }
    for (; from < store->count && count < BATCH; from++) {
        st_mesh *mesh = store->meshes[from];
        if (atomic_load_explicit(&mesh->used, memory_order_relaxed) < limit &&
            is_cold(store, mesh)) {
            batch[count++] = mesh;
        } else {
            store->meshes[to++] = mesh;
        }
    }
    *place = to;
    for (; from < store->count; from++) {
        store->meshes[to++] = store->meshes[from];
    }
    store->count -= count;
    pthread_rwlock_unlock(&store->lock);
    return count;
}

/* Evicts meshes that were last used before `newest`, least recently used first, until about `bytes`
 * bytes are free. Returns the number of evicted meshes. *locked is set to false if the lock of the
 * table of meshes could not be taken. */
static size_t evict(st_store *store, uint64_t bytes, uint64_t newest, bool *locked)
{
    st_mesh *batch[BATCH];
    size_t place = 0, count, all = 0;
    *locked = lock_table(store);
    if (!*locked) {
        return 0;
    }
    uint64_t limit = find_limit(store, bytes);
    pthread_rwlock_unlock(&store->lock);
    limit = limit < newest ? limit : newest;
    do {
        count = take_out(store, limit, &place, batch);
        all += count;
        for (size_t i = 0; i < count; i++) {
            st_release(batch[i]);
        }
        st_count(&store->followers.counts.evicted, count);
    } while (count == BATCH);
    return all;
}

/* Returns how many bytes must be freed so that `bytes + share` bytes of the memory budget are
 * available. */
static uint64_t missing(uint64_t bytes, uint64_t share)
{
    const uint64_t held = st_memory_used() + st_resident_beside();
    const uint64_t wanted = held + bytes + share, budget = st_memory_budget();
    /* the amount of used memory may change during the calculation */
    return wanted > budget ? wanted - budget : 0;
}

static void make_room(st_store *store, uint64_t bytes)
{
    const uint64_t budget = st_memory_budget();
    uint64_t share = budget / 16;
    bool locked;
    /* Another thread may have freed memory while this thread waited for the lock. */
    pthread_mutex_lock(&store->room);
    if (missing(bytes, share) > 0) {
        st_resident_measure();
    }
    /* If meshes must be evicted, more bytes than `share` are made free, so that the next requests
     * need not evict meshes again. */
    share += share / 4;
    if (missing(bytes, share) > 0) {
        st_store_shed(store);
    }
    if (store->journal.keeps && missing(bytes, share) > 0) {
        /* More bytes are evicted than necessary, so that the next eviction need not follow soon. */
        (void)evict(store, missing(bytes, 2 * budget / 16), UINT64_MAX, &locked);
    }
    pthread_mutex_unlock(&store->room);
}

/* Returns the position of the newest record if some records are not on the disk yet, else 0. A mesh
 * cannot be evicted before its records are durable. */
static uint64_t on_its_way(const st_store *store)
{
    const uint64_t newest = st_waits_newest(store->followers.waits);
    return newest > st_waits_durable(store->followers.waits) ? newest : 0;
}

/* Waits until all records up to position `newest` are durable. Returns true if more meshes can then
 * be evicted. */
static bool await_disk(st_store *store, uint64_t newest, uint64_t until)
{
    return store->journal.keeps && newest != 0 &&
           st_waits_block(store->followers.waits, newest, until);
}

void st_make_room(st_store *store, uint64_t bytes)
{
    const uint64_t budget = st_memory_budget(), share = budget / 16;
    if (budget == 0 || bytes > budget - share || missing(bytes, share) == 0) {
        return;
    }
    const uint64_t until = st_clock_micros() + DISK_MICROS;
    uint64_t newest;
    do {
        newest = on_its_way(store);
        make_room(store, bytes);
        /* If `bytes` is 0, memory is needed for an edit. An edit does not wait for the disk,
         * because the memory that is free may suffice. */
    } while (bytes > 0 && !st_memory_has(bytes + share) && await_disk(store, newest, until));
}

/* Frees memory for a thread whose allocation would otherwise be refused (memory.h calls such a
 * function a giver). The thread may hold any lock except that of the table of meshes and those that
 * st_store_shed takes. */
static bool give_room(void *context, uint64_t bytes)
{
    st_store *store = context;
    const uint64_t budget = st_memory_budget(), share = budget / 16;
    const uint64_t now = st_clock_micros();
    if (!store->journal.keeps || bytes > budget - share || now < atomic_load(&store->barren)) {
        return false;
    }
    bool locked, freed = false;
    uint64_t newest;
    do {
        newest = on_its_way(store);
        freed = evict(store, missing(bytes, 2 * share), UINT64_MAX, &locked) > 0 || freed;
    } while (locked && !st_memory_has(bytes + share) &&
             await_disk(store, newest, now + DISK_MICROS));
    if (!freed && locked) {
        atomic_store(&store->barren, st_clock_micros() + BARREN_MICROS);
    }
    return freed;
}

bool st_store_is_full(st_store *store)
{
    if (st_memory_is_short()) {
        st_make_room(store, st_memory_budget() / ST_MEMORY_SHORT_SHARE);
    }
    return st_memory_is_short();
}

void st_store_giver(st_store *store, st_memory_giver *out)
{
    *out = (st_memory_giver){give_room, store};
}

void st_store_serve(const st_store *store)
{
    st_memory_ask(store == NULL ? NULL : &store->giver);
}

void st_store_rest(st_store *store)
{
    const uint64_t share = st_memory_budget() / 16, now = st_clock_micros();
    bool locked;
    st_store_expire_copies(store, now > COPY_MICROS ? now - COPY_MICROS : 0);
    if (!store->journal.keeps || share == 0) {
        return;
    }
    const bool beyond = st_resident_is_beyond();
    pthread_mutex_lock(&store->room);
    if (beyond || missing(0, 2 * share) > 0) {
        st_resident_measure();
    }
    if (beyond) {
        (void)evict(store, missing(0, 2 * share), UINT64_MAX, &locked);
    } else if (now > COLD_MICROS && missing(0, 2 * share) > 0) {
        (void)evict(store, missing(0, 2 * share), now - COLD_MICROS, &locked);
    }
    pthread_mutex_unlock(&store->room);
}
