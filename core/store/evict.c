/* evict.c - evicts unused meshes (removes them from memory) while memory is short; they are loaded
 * from the journal again when a request needs them. */
#include "store/table.h"
#include "system/clock.h"
#include "system/memory.h"
#include "system/resident.h"

#include <time.h>

/* The number of classes into which the times of last use of meshes are sorted to choose which
 * meshes to evict (remove from memory). */
enum { AGES = 256 };

/* Meshes are evicted (removed from memory) in batches of BATCH meshes, so that the store's table of
 * meshes is not locked for long. */
enum { BATCH = 64 };

/* A mesh that was not used for COLD_MICROS may be evicted before a request needs its memory; after
 * an attempt that found no mesh to evict, no further attempt is made for BARREN_MICROS. */
enum { COLD_MICROS = 60 * 1000 * 1000, BARREN_MICROS = 50 * 1000 };

/* LOCK_NANOS is how long a thread waits for the lock of the store's table of meshes; DISK_MICROS,
 * how long it waits for the disk if meshes can be evicted as soon as their changes are durable. */
enum {
    LOCK_NANOS = 100 * 1000 * 1000,
    SECOND_NANOS = 1000 * 1000 * 1000,
    DISK_MICROS = 250 * 1000
};

void st_mesh_use(st_mesh *mesh)
{
    atomic_store_explicit(&mesh->used, st_clock_micros(), memory_order_relaxed);
}

/* Takes the lock of the store's table of meshes. Returns false if that takes longer than
 * LOCK_NANOS. A thread that asks for memory may hold locks that the owner of the table's lock waits
 * for, or may own the table's lock itself, so that thread must not wait for ever. */
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

/* Returns true if the mesh can be evicted: only the table of meshes has a reference to the mesh,
 * and the disk has all its changes. The caller holds the table's exclusive lock, under which no
 * thread can begin to use the mesh. A message that waits to be sent to listeners holds a reference,
 * too. */
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

/* The bytes of meshes, summed up by classes of their time of last use. These sums tell up to which
 * time of last use meshes must be evicted to free a number of bytes. */
typedef struct ages {
    /* first: the earliest time of last use of any mesh; span: the time from it to the latest one */
    uint64_t first, span;
    uint64_t bytes[AGES];
} ages;

static size_t age_of(const ages *a, uint64_t used)
{
    return (size_t)((used - a->first) / (a->span / AGES + 1));
}

/* Returns the time of last use before which meshes are evicted to free about `bytes` bytes. The
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

/* Takes up to BATCH meshes that were last used before `limit` out of the table of meshes, beginning
 * at index *place. */
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

/* Evicts meshes that were last used before `newest`, as many as it takes to free `bytes` bytes.
 * Returns the number of evicted meshes. *locked says whether the lock of the table of meshes could
 * be taken. */
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
 * free. */
static uint64_t missing(uint64_t bytes, uint64_t share)
{
    const uint64_t held = st_memory_used() + st_resident_beside();
    const uint64_t wanted = held + bytes + share, budget = st_memory_budget();
    return wanted > budget ? wanted - budget : 0; /* other threads free memory meanwhile */
}

static void make_room(st_store *store, uint64_t bytes)
{
    const uint64_t budget = st_memory_budget();
    uint64_t share = budget / 16;
    bool locked;
    /* While this thread waited for the lock, another one may have freed memory. */
    pthread_mutex_lock(&store->room);
    if (missing(bytes, share) > 0) {
        st_resident_measure();
    }
    /* If meshes must be evicted at all, more than `share` bytes are made free, so that the next
     * requests need not measure memory and evict again. */
    share += share / 4;
    if (missing(bytes, share) > 0) {
        st_store_shed(store);
    }
    if (store->journal.keeps && missing(bytes, share) > 0) {
        /* More bytes are evicted than are missing, so that the next eviction is not due at once. */
        (void)evict(store, missing(bytes, 2 * budget / 16), UINT64_MAX, &locked);
    }
    pthread_mutex_unlock(&store->room);
}

/* Returns the position of the newest record if records are being written to the disk, else 0.
 * Meshes whose records are not durable cannot be evicted. */
static uint64_t on_its_way(const st_store *store)
{
    const uint64_t newest = st_waits_newest(store->followers.waits);
    return newest > st_waits_durable(store->followers.waits) ? newest : 0;
}

/* Waits until the record at position `newest` and all records before it are durable. Returns true
 * if another eviction may then find more meshes. */
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
        /* If `bytes` is 0, the caller is an edit. It does not wait for the disk, because the memory
         * that is free may suffice for the edit. */
    } while (bytes > 0 && !st_memory_has(bytes + share) && await_disk(store, newest, until));
}

/* Frees memory for a thread whose allocation would be refused (a memory giver, see memory.h). That
 * thread may hold any lock except the lock of the table of meshes and the locks that st_store_shed
 * takes. */
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
