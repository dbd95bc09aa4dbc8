/* lookup.h - lookups of ids on the disk. After a lookup a thread loads the mesh of the id, or
 * creates a mesh with this id.
 *
 * A mesh that is not in memory may be on the disk, and to find out takes long. Meanwhile one thread
 * owns the lookup of the id, and other threads that need the id wait until that lookup ends; so a
 * mesh is loaded only once, and an id is not given to two meshes.
 *
 * The lock of the lookups is taken before that of the store's table of meshes. */
#ifndef HE_STORE_LOOKUP_H
#define HE_STORE_LOOKUP_H

#include "store/store.h"

#include <pthread.h>

typedef struct st_lookup st_lookup;

typedef struct st_lookups {
    pthread_mutex_t lock;
    pthread_cond_t ended; /* signalled when a lookup ends */
    st_lookup *first;
} st_lookups;

void st_lookups_init(st_lookups *lookups);
/* Frees the memory of all lookups; no lookup may be under way. */
void st_lookups_clear(st_lookups *lookups);

/* Finds a mesh in memory and adds a reference. If the mesh is not in memory, *mesh is NULL and *out
 * is the lookup of the id, which the caller owns until st_lookup_end; other threads that need the
 * id wait until then. The function waits, so only threads that may wait can call it.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_LOADING if another thread's lookup takes too long.
 * Returns ST_NO_MEMORY or ST_FAILED if the lookup cannot be made. */
st_status st_lookup_begin(st_store *store, const char *id, st_mesh **mesh, st_lookup **out);
/* Gives the caller the lookup of an id that names no mesh, neither in memory nor on the disk. *out
 * is NULL if the journal stores nothing, because all meshes are then in memory. The function waits,
 * so only threads that may wait can call it.
 * Returns ST_TAKEN if a mesh has the id.
 * Returns ST_LOADING if another thread's lookup takes too long.
 * Returns ST_NO_MEMORY or ST_FAILED if the lookup cannot be made. */
st_status st_lookup_free_id(st_store *store, const char *id, st_lookup **out);
/* Ends a lookup, which may be NULL. Threads that waited for it then search the store's table of
 * meshes for the id. */
void st_lookup_end(st_store *store, st_lookup *lookup);

#endif
