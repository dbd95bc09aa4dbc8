/* mesh_events.h - what happens to a mesh, told to those who listen.
 *
 * Each change is rendered once, under the mesh's write lock, when it gets its number, and put into
 * the mesh's feed under that number; who listens gets it when the journal has it (D1). While nobody
 * listens nothing is rendered. Who was cut off and comes back goes on from the feed, from the
 * history (catch_up.h), or, when neither reaches that far, after one `resync`. Jobs are told beside
 * the changes, and are not in the history. */
#ifndef HE_SERVER_STORE_MESH_EVENTS_H
#define HE_SERVER_STORE_MESH_EVENTS_H

#include "api/job/jobs.h"
#include "server/store/stored_mesh.h"

/* What the meshes of a store share. */
typedef struct srv_events {
    size_t most, most_of_mesh; /* listeners */
    struct srv_pool *pool;     /* brings listeners forward from the history */
    struct srv_held *held;
    _Atomic size_t count;     /* listeners */
    _Atomic size_t catch_ups; /* of them from the history */
} srv_events;

/* Under the mesh's write lock: this change has just been made. */
void srv_events_publish(api_mesh *mesh, const srv_record *record);

/* Without a lock: a job that is about the mesh has begun or ended. */
void srv_events_job(api_mesh *mesh, const api_job *job);

/* The member of api_store. */
api_store_status srv_follow(void *self, api_mesh *mesh, const api_since *since, api_mesh_info *info,
                            api_source *out);

#endif
