/* lookup.h - ids that somebody is looking up on the disk, to load their mesh or to make one.
 *
 * A mesh that is not in memory may be on the disk, and whether it is takes long to find out. Until
 * that is known the id belongs to one thread, which has its lookup; others who want the id wait for
 * the end of that, so that a mesh is loaded once and an id is not taken twice.
 *
 * The lock is taken before that of the table. */
#ifndef HE_STORE_LOOKUP_H
#define HE_STORE_LOOKUP_H

#include "store/store.h"

#include <pthread.h>

typedef struct st_lookup st_lookup;

typedef struct st_lookups {
    pthread_mutex_t lock;
    pthread_cond_t ended; /* one of them */
    st_lookup *first;
} st_lookups;

void st_lookups_init(st_lookups *lookups);
void st_lookups_clear(st_lookups *lookups); /* none may be under way */

/* The mesh, with a reference, where it is in memory; or else *mesh is NULL and the id the caller's.
 * Waits, on a thread that may. ST_ABSENT; ST_LOADING, ST_NO_MEMORY, ST_FAILED. */
st_status st_lookup_begin(st_store *store, const char *id, st_mesh **mesh, st_lookup **out);
/* Makes an id the caller's that names no mesh, neither in memory nor on the disk. Waits, on a
 * thread that may. NULL where nothing is kept: then the table alone says what is there. ST_TAKEN,
 * ST_LOADING, ST_NO_MEMORY, ST_FAILED. */
st_status st_lookup_free_id(st_store *store, const char *id, st_lookup **out);
/* The id is found as the table has it from now on. Takes NULL. */
void st_lookup_end(st_store *store, st_lookup *lookup);

#endif
