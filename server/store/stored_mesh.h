/* stored_mesh.h - one mesh of the store: what store.c, mesh_write.c and snapshot.c share. */
#ifndef HE_SERVER_STORE_STORED_MESH_H
#define HE_SERVER_STORE_STORED_MESH_H

#include "server/store/feed.h"
#include "server/store/held.h"
#include "server/store/idempotency.h"
#include "server/store/journal.h"
#include "server/store/revision_log.h"

#include <pthread.h>
#include <stdatomic.h>

/* A copy at a revision, counted by the cache and by each snapshot: it stays there while there is a
 * snapshot of it. */
typedef struct srv_copy {
    _Atomic uint32_t uses;
    uint64_t revision;
    he_replay *replay;
} srv_copy;

struct api_mesh {
    _Atomic uint32_t uses;
    const srv_journal *journal;
    struct srv_events *events;

    pthread_rwlock_t lock; /* of all down to `claimed` */
    api_mesh_info info;    /* but for undo and redo, which the log has */
    he_mesh *content;
    srv_revision_log log;
    he_savepoint mark;      /* where the writer began */
    he_mesh *discard;       /* freed when the writer has given the lock back */
    const api_claim *claim; /* whom the writer works for, NULL: for no keyed request */
    bool claimed;           /* the log's reserve is lent to a long edit, of info.job */

    /* See mesh_events.h. */
    srv_feed feed;
    srv_hold hold; /* of the newest message that is not yet durable */
    _Atomic bool holding;

    pthread_mutex_t snapshot_lock;
    srv_copy *copy; /* of the present, NULL: none cached */

    pthread_mutex_t past_lock;
    srv_copy *past; /* of an earlier revision, likewise */

    pthread_mutex_t cache_lock;
    void *cache;
    size_t cache_size;
    uint64_t cache_revision;

    srv_keys keys;
    struct {
        pthread_mutex_t lock;
        pthread_cond_t ended; /* somebody gave it back */
        api_derived place;
    } derived[API_DERIVED_COUNT];
};

/* Takes `content`. NULL when memory is out. */
api_mesh *srv_mesh_new(const char *id, const char *name, he_mesh *content, uint64_t undo_budget,
                       const srv_journal *journal, const uint64_t secret[2]);
void srv_mesh_release(api_mesh *mesh);
/* One use more, to be released. */
api_mesh *srv_mesh_retain(api_mesh *mesh);
/* Under its lock. */
void srv_mesh_info(const api_mesh *mesh, api_mesh_info *out);
/* Free the cached copies and the bodies of kept answers, unless somebody reads them, and what was
 * derived. */
void srv_mesh_shed(api_mesh *mesh);
/* Under the exclusive lock: number a change that was made and tell the journal about it. */
void srv_mesh_append(api_mesh *mesh, api_action action, const he_delta *delta, bool undone);

/* The members of api_store of the same names. */
const he_mesh *srv_read_begin(void *self, api_mesh *mesh, api_mesh_info *info);
void srv_read_end(void *self, api_mesh *mesh);
bool srv_cache_get(void *self, api_mesh *mesh, void *value, size_t size);
void srv_cache_put(void *self, api_mesh *mesh, const void *value, size_t size);
api_derived *srv_derived_begin(void *self, api_mesh *mesh, api_derived_kind kind);
void srv_derived_end(void *self, api_mesh *mesh, api_derived_kind kind);
void srv_derived_wait(void *self, api_mesh *mesh, api_derived_kind kind);
const he_delta *srv_revision_delta(void *self, api_mesh *mesh, uint64_t revision);
bool srv_history(void *self, api_mesh *mesh, size_t i, struct api_entry *out);
void srv_history_facts(void *self, api_mesh *mesh, struct api_history *out);

he_mesh *srv_write_begin(void *self, api_mesh *mesh, api_mesh_info *info, he_delta **delta);
void srv_write_keyed(void *self, api_mesh *mesh, const api_claim *claim);
void srv_write_commit(void *self, api_mesh *mesh, const char *ops, bool barrier,
                      api_mesh_info *info);
void srv_write_abort(void *self, api_mesh *mesh);
void srv_tally(void *self, api_mesh *mesh, const api_tally *tally);
bool srv_undoable(void *self, api_mesh *mesh);
api_store_status srv_steps_to(void *self, api_mesh *mesh, api_action which, uint64_t revision,
                              uint32_t *steps, uint64_t *bytes);
api_store_status srv_step_apply(void *self, api_mesh *mesh, api_action which, uint32_t steps,
                                const he_delta **deltas, api_mesh_info *info);
void srv_write_end(void *self, api_mesh *mesh);
api_store_status srv_claim(void *self, api_mesh *mesh, const he_mesh **content, he_delta **delta,
                           api_mesh_info *info);
api_store_status srv_publish(void *self, api_mesh *mesh, he_mesh *content, const char *ops,
                             bool barrier, const api_claim *keyed, api_mesh_info *info);
void srv_unclaim(void *self, api_mesh *mesh);
/* Who claimed the mesh is job `id`: said to those who find it busy. Without a lock. */
void srv_claimed_by(api_mesh *mesh, const char *id);
void srv_mesh_replace(void *self, api_mesh *mesh, he_mesh *content, api_mesh_info *info);
void srv_mesh_rename(void *self, api_mesh *mesh, const char *name, api_mesh_info *info);

api_store_status srv_snapshot(void *self, api_mesh *mesh, api_snapshot **out);
api_store_status srv_snapshot_at(void *self, api_mesh *mesh, uint64_t revision, api_snapshot **out);
api_store_status srv_snapshot_held(void *self, api_mesh *mesh, api_snapshot **out);
const he_mesh *srv_snapshot_content(const api_snapshot *snapshot, api_mesh_info *info);
void srv_snapshot_release(void *self, api_snapshot *snapshot);
void srv_copy_release(srv_copy *copy);
/* Free the cached copy, unless somebody reads it. */
void srv_copy_shed(api_mesh *mesh);

#endif
