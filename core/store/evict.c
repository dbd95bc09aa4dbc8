/* Meshes that nobody uses leave memory while it is short, and come back from the journal when they
 * are asked for. */
#include "store/table.h"
#include "system/clock.h"
#include "system/memory.h"

/* Ages are told apart in so many classes, from the mesh that was used last to the one that was not
 * for longest. */
enum { AGES = 256 };

/* Meshes are freed in batches, so that the table is not locked for longer. */
enum { BATCH = 64 };

void st_mesh_use(st_mesh *mesh)
{
    atomic_store_explicit(&mesh->used, st_clock_micros(), memory_order_relaxed);
}

/* Does only the table hold it, and does the disk have all of it? Under the table's exclusive lock
 * nobody can begin to use it. A message for listeners that waits holds a use. */
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
    return sizeof *mesh + he_mesh_bytes(mesh->content) + mesh->log.bytes;
}

/* The age from which on meshes go, so that about `bytes` come free. */
typedef struct ages {
    uint64_t first, span; /* of the time of use */
    uint64_t bytes[AGES];
} ages;

static size_t age_of(const ages *a, uint64_t used)
{
    return (size_t)((used - a->first) / (a->span / AGES + 1));
}

/* Under the table's lock. */
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

/* Takes out meshes that were used before `limit`, at most a batch, from *place on. */
static size_t take_out(st_store *store, uint64_t limit, size_t *place, st_mesh *batch[BATCH])
{
    size_t count = 0, to = *place, from = *place;
    pthread_rwlock_wrlock(&store->lock);
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

static void evict(st_store *store, uint64_t bytes)
{
    st_mesh *batch[BATCH];
    size_t place = 0, count;
    pthread_rwlock_wrlock(&store->lock);
    uint64_t limit = find_limit(store, bytes);
    pthread_rwlock_unlock(&store->lock);
    do {
        count = take_out(store, limit, &place, batch);
        for (size_t i = 0; i < count; i++) {
            st_release(batch[i]);
        }
    } while (count == BATCH);
}

void st_make_room(st_store *store, uint64_t bytes)
{
    uint64_t budget = st_memory_budget(), share = budget / 16;
    if (budget == 0 || bytes > budget - share || st_memory_has(bytes + share)) {
        return;
    }
    /* Who waited here finds the room that was made meanwhile. */
    pthread_mutex_lock(&store->room);
    if (!st_memory_has(bytes + share)) {
        st_store_shed(store);
    }
    if (store->journal.keeps && !st_memory_has(bytes + share)) {
        /* Twice the share, so that it is not to be done again at once. */
        uint64_t wanted = st_memory_used() + bytes + 2 * share;
        if (wanted > budget) { /* others free memory between the two looks at it */
            evict(store, wanted - budget);
        }
    }
    pthread_mutex_unlock(&store->room);
}
