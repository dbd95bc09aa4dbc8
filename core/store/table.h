/* table.h - the store's table, which finds meshes by id; for store.c, lookup.c, cards.c and
 * evict.c. */
#ifndef HE_STORE_TABLE_H
#define HE_STORE_TABLE_H

#include "store/lookup.h"
#include "store/stored_mesh.h"
#include "system/memory.h"

struct st_store {
    st_journal journal;
    uint64_t undo_budget;
    uint64_t max_meshes;
    /* the threads that make new bases (contents from which meshes are loaded); NULL: no bases are
     * made */
    st_pool *pool;
    /* A mesh may get a new base, from which it is loaded, when the records since its present base
     * have more bytes than this. */
    uint64_t base_bytes;
    st_followers followers;
    st_lookups lookups;
    st_memory_giver giver;
    /* Time until which no eviction is tried, because the last try found no mesh to evict. */
    _Atomic uint64_t barren;
    pthread_mutex_t
        /* A mutex held by the one thread that frees memory for requests; taken before `lock`. */
        room;
    pthread_rwlock_t lock; /* guards the table of meshes */
    /* The table: an array of the meshes in memory, in the order of ids; the table counts as one
     * reference to each mesh. */
    st_mesh **meshes;
    size_t count, capacity;
    st_keys keys; /* the Idempotency-Keys of requests that create a mesh */
    st_holders holders;
    st_sorted sorted; /* empty if the journal stores meshes */
};

/* Returns the settings that the store gives to its meshes. */
st_mesh_options st_store_mesh_options(st_store *store);
/* Returns the index of the first mesh in the table whose id is not below `id`; *found says whether
 * that mesh has the id `id`. The caller holds the table's lock. */
size_t st_table_place(const st_store *store, const char *id, bool *found);
/* Adds a mesh to the table, which adds a reference to it. The caller holds the table's exclusive
 * lock.
 * Returns ST_TAKEN if a mesh has the id.
 * Returns ST_NO_MEMORY if memory is out. */
st_status st_table_insert(st_store *store, st_mesh *mesh);

/* Tries to make `bytes` and a sixteenth of the memory budget free: frees caches, then evicts unused
 * meshes that the journal can load again, the least recently used first. Frees nothing if even an
 * empty store would not leave `bytes` of the budget free. The caller may hold no lock but the one
 * named `past` (store.h). */
void st_make_room(st_store *store, uint64_t bytes);
/* Makes a memory giver (memory.h): a function that evicts unused meshes when an allocation would be
 * refused. The thread that allocates may hold locks. */
void st_store_giver(st_store *store, st_memory_giver *out);

#endif
