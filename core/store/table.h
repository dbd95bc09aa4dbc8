/* table.h - the collection of meshes by id, for store.c, lookup.c, cards.c and evict.c. */
#ifndef HE_STORE_TABLE_H
#define HE_STORE_TABLE_H

#include "store/lookup.h"
#include "store/stored_mesh.h"
#include "system/memory.h"

struct st_store {
    st_journal journal;
    uint64_t undo_budget;
    uint64_t max_meshes;
    st_pool *pool;       /* NULL: no bases are made */
    uint64_t base_bytes; /* bytes of records after which another base is due */
    st_followers followers;
    st_lookups lookups;
    st_memory_giver giver;
    _Atomic uint64_t barren; /* until this time no eviction is tried, because the last one found
                                nothing to evict */
    pthread_mutex_t
        room; /* held by the one thread that frees memory; taken before the table's lock */
    pthread_rwlock_t lock; /* guards the table */
    st_mesh **meshes;      /* meshes in memory, in the order of ids, each with a use */
    size_t count, capacity;
    st_keys keys; /* keys of requests that make a mesh */
    st_holders holders;
};

/* Returns the settings that the store gives to its meshes. */
st_mesh_options st_store_mesh_options(st_store *store);
/* Returns the index in the table of the first mesh whose id is not below `id`; *found says whether
 * it has that id. The caller holds the table's lock. */
size_t st_table_place(const st_store *store, const char *id, bool *found);
/* Adds a mesh to the table, which thereby uses it. The caller holds the table's exclusive lock.
 * Returns ST_TAKEN if a mesh has the id.
 * Returns ST_NO_MEMORY if memory is out. */
st_status st_table_insert(st_store *store, st_mesh *mesh);

/* Tries to make `bytes` and a sixteenth of the memory budget free: frees caches, then evicts unused
 * meshes that the journal can load again, the least recently used first. Frees nothing for more
 * than the budget could ever hold. The caller may hold no lock but `past`. */
void st_make_room(st_store *store, uint64_t bytes);
/* Makes a memory giver (memory.h) that evicts unused meshes, for a thread that may hold locks:
 * without it that thread would be refused memory which could be freed. */
void st_store_giver(st_store *store, st_memory_giver *out);

#endif
