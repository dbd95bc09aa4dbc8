/* stored_mesh.h - one mesh of the store: what store.c, mesh_write.c and snapshot.c share. */
#ifndef HE_STORE_STORED_MESH_H
#define HE_STORE_STORED_MESH_H

#include "store/booking.h"
#include "store/broadcast_queue.h"
#include "store/holder/holders.h"
#include "store/idempotency.h"
#include "store/revision_log.h"
#include "store/store_counts.h"

#include <pthread.h>
#include <stdatomic.h>

/* A copy at a revision, counted by the cache and by each snapshot: it stays there while there is a
 * snapshot of it. */
typedef struct st_copy {
    _Atomic uint32_t uses;
    uint64_t revision;
    double time; /* when that was made; of a past copy */
    he_replay *replay;
    st_store_counts *counts; /* to which `bytes` were added */
    uint64_t bytes;
} st_copy;

typedef struct st_next_base st_next_base;

struct st_mesh {
    _Atomic uint32_t uses;
    _Atomic uint64_t used; /* when it was found last, st_clock_micros; 0 where nothing is evicted */
    char *damage;          /* of one that stands for a mesh that cannot be loaded; NULL else */
    st_store *store;
    const st_journal *journal;
    struct st_followers *followers;
    st_holders *holders;

    pthread_rwlock_t lock; /* of all down to `next_base` */
    st_mesh_info info;     /* but for undo and redo, which the log has */
    he_mesh *content;
    st_revision_log log;
    st_holding holding; /* whose it is, and the bytes that it counts with */
    bool claimed;       /* the log's reserve is lent to a long edit */

    uint64_t weights[ST_WEIGHT_COUNT]; /* as they were counted last; also before it is shared */

    uint64_t base;           /* revision of the base on the disk: it can be read from there on */
    uint64_t appended;       /* bytes of records since the last snapshot: rebase.c */
    st_next_base *next_base; /* likewise; NULL: there is none */

    /* See followers.h. */
    st_queue queue;
    st_wait wait; /* until the newest change is durable */
    _Atomic bool waiting;

    pthread_mutex_t snapshot_lock;
    st_copy *copy; /* of the present, NULL: none cached */

    pthread_mutex_t past_lock;
    st_copy *past; /* of an earlier revision, likewise */

    pthread_mutex_t cache_lock;
    void *cache;
    size_t cache_size;
    uint64_t cache_revision;

    st_keys keys;
    struct {
        pthread_mutex_t lock;
        pthread_cond_t ended; /* somebody gave it back */
        st_derived place;
    } derived[ST_DERIVED_COUNT];
};

/* What the meshes of a store share for those who listen to them. */
typedef struct st_followers {
    st_render *render;
    size_t most, most_of_mesh; /* listeners */
    struct st_waits *waits;
    _Atomic size_t count; /* listeners */
    st_store_counts counts;
} st_followers;

/* What a mesh takes over from its store. */
typedef struct st_mesh_options {
    st_store *store;
    const st_journal *journal;
    st_followers *followers;
    st_holders *holders;
    uint64_t undo_budget;
    const uint64_t *secret;
} st_mesh_options;

/* A mesh with the facts of a card, but neither content nor history: those are the caller's to put
 * in. NULL when memory is out. */
st_mesh *st_mesh_bare(const st_mesh_options *options, const st_card *card);
/* A mesh at its first revision, whose is said by `cause`, or NULL. Takes `content`. NULL when
 * memory is out. It counts for nobody yet. */
st_mesh *st_mesh_new(const st_mesh_options *options, const char *id, const char *name,
                     const st_cause *cause, he_mesh *content);
/* It was asked for now. */
void st_mesh_use(st_mesh *mesh);
st_counts st_counts_of(const he_mesh *content);
/* Under its lock. */
void st_mesh_facts(const st_mesh *mesh, st_mesh_info *out);
/* Frees the cached copies and the bodies of kept answers, unless somebody reads them, and what was
 * derived. */
void st_mesh_shed(st_mesh *mesh);
/* Counts what the mesh has in memory now. Under the exclusive lock, or while nobody knows it. */
void st_mesh_weigh(st_mesh *mesh);
/* A change as it is told to listeners. */
typedef struct st_event {
    char *bytes; /* NULL: nobody listens, or memory is out */
    size_t length;
} st_event;

/* Records that become durable together, each with its event: a change, which is written as an event
 * if anyone listens, or an event that was written before, whose bytes are taken. */
typedef struct st_group {
    st_booking *booking; /* for them, which is taken and cleared */
    st_record *records;
    size_t count;
    const st_change *changes; /* one for each, or NULL */
    st_event *events;         /* likewise */
} st_group;

/* Under the exclusive lock: the next record of the mesh, of what it is now. A revision is in the
 * log already. */
st_record st_mesh_record(st_mesh *mesh, st_record_kind kind, const st_cause *cause);
/* Under either lock: what the newest record of the mesh says, as a record of this kind. */
st_record st_mesh_facts_record(const st_mesh *mesh, st_record_kind kind);
/* Under the exclusive lock: it takes so many bytes from now on. ST_QUOTA, and nothing is changed.
 */
st_status st_mesh_grow(st_mesh *mesh, uint64_t bytes);
/* Under the exclusive lock: hands a group of records to the journal and tells the listeners. */
void st_mesh_publish(st_mesh *mesh, const st_group *group);
/* What st_mesh_publish does for the listeners, when the position is known. */
void st_mesh_tell(st_mesh *mesh, const st_group *group);
void st_event_write(const st_mesh *mesh, const st_mesh_info *info, const st_change *change,
                    st_event *out);
/* Takes the mesh out of the store where its newest change lies in the loss: it is lost. */
void st_mesh_lose(st_mesh *mesh, const st_loss *loss);
/* Under the mesh's exclusive lock: the store has it no more. */
void st_store_take_out(st_store *store, st_mesh *mesh);

/* Under the exclusive lock: a group of records was appended, which may ask for a younger base
 * (rebase.c). */
void st_rebase_note(st_mesh *mesh, const st_group *group);
/* About so many bytes of the record are on the disk. */
uint64_t st_rebase_bytes(const st_record *record);
/* Forgets a base that is not one yet. */
void st_rebase_drop(st_mesh *mesh);

void st_copy_release(st_copy *copy);
/* Frees the cached copy, unless somebody reads it. */
void st_copy_shed(st_mesh *mesh);

#endif
