/* store.h - the meshes a daemon holds: by id, locked, revised. Fills in api/store.h.
 *
 * Locks, in the order in which they are taken:
 *     past      the mesh's cached copy of an earlier revision; not on a worker
 *     mesh      one mesh, shared by readers or held by one writer; writers come first
 *     table     the collection, for as long as a search takes
 *     snapshot  the mesh's cached copy
 *     cache     the mesh's cached value
 *     keys      answers kept for keyed requests, of a mesh or of the store
 *     derived   what a handler derived from it
 *     feed      messages for those who listen to it
 *     held      answers that wait until they are durable
 * The board of jobs (job_board.h) has a lock that is taken after a mesh's, and those who are to be
 * woken (http_live.h) one that is taken after all others.
 * Whoever holds a mesh's lock takes no other mesh's, not even shared and not the same one twice:
 * a waiting writer would stop both. To bring another mesh's content in, take its snapshot first.
 *
 * A mesh is counted: by the table, and by each handle given out. It is freed with the last one, so
 * a removed mesh is still there for those who were reading it. */
#ifndef HE_SERVER_STORE_STORE_H
#define HE_SERVER_STORE_STORE_H

#include "api/job/jobs.h"
#include "server/store/journal.h"
#include "server/system/thread_pool.h"

typedef struct srv_store srv_store;

typedef struct srv_store_options {
    uint64_t undo_budget; /* bytes a mesh */
    uint64_t max_meshes;
    srv_journal journal; /* closed with the store */
    size_t listeners;    /* at once, and of one mesh */
    size_t mesh_listeners;
    srv_pool *pool; /* brings listeners forward from the history; freed before the store is */
} srv_store_options;

/* NULL when memory is out; the journal is the caller's then. */
srv_store *srv_store_new(const srv_store_options *options);
/* Nobody may hold a handle. */
void srv_store_free(srv_store *store);
/* The functions of api/store.h over this store. */
api_store srv_store_interface(srv_store *store);

/* May an answer that shows the mesh at this record be sent? */
bool srv_store_is_durable(const srv_store *store, const api_mesh *mesh, uint64_t record);
/* Call `notify` whenever that may have become true for some mesh; see journal.h. */
void srv_store_listen(srv_store *store, void (*notify)(void *context), void *context);
/* Where to wait for that. */
struct srv_held *srv_store_held(srv_store *store);

size_t srv_store_count(srv_store *store);
/* Free the cached copies and bodies of kept answers that nobody reads, and what was derived from
 * meshes. Without a lock. */
void srv_store_shed(srv_store *store);

#endif
