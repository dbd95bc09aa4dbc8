/* table.h - the collection by id: what store.c, lookup.c, cards.c and evict.c share of it. */
#ifndef HE_STORE_TABLE_H
#define HE_STORE_TABLE_H

#include "store/lookup.h"
#include "store/stored_mesh.h"
#include "system/memory.h"

struct st_store {
    st_journal journal;
    uint64_t undo_budget;
    uint64_t max_meshes;
    st_pool *pool;       /* NULL: nothing is rebased */
    uint64_t base_bytes; /* of records, before another base is due */
    st_followers followers;
    st_lookups lookups;
    st_memory_giver giver;
    _Atomic uint64_t barren; /* until then giving is not tried: nothing was found to be freed */
    pthread_mutex_t room;    /* one thread at a time makes room; taken before the table's */
    pthread_rwlock_t lock;   /* of the table */
    st_mesh **meshes;        /* in memory, in the order of ids, each with a use */
    size_t count, capacity;
    st_keys keys; /* of what makes a mesh */
    st_holders holders;
};

/* What the store's meshes take over from it. */
st_mesh_options st_store_mesh_options(st_store *store);
/* The first mesh whose id is not below `id`; *found when it is that id. Under the table's lock. */
size_t st_table_place(const st_store *store, const char *id, bool *found);
/* Puts a mesh in, with its use. ST_TAKEN, ST_NO_MEMORY. Under the table's exclusive lock. */
st_status st_table_insert(st_store *store, st_mesh *mesh);

/* Tries to have `bytes` more and a sixteenth of the memory budget free: frees caches, then meshes
 * that nobody uses and that the journal brings back, the least recently used first. Frees nothing
 * for more than the budget could ever hold. Without a lock but `past`. */
void st_make_room(st_store *store, uint64_t bytes);
/* One that has such meshes leave, for a thread that may hold locks: without it what others could
 * give would be refused. */
void st_store_giver(st_store *store, st_memory_giver *out);

#endif
