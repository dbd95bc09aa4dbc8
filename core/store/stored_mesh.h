/* stored_mesh.h - one mesh of the store, for the files store.c, mesh_write.c and snapshot.c. */
#ifndef HE_STORE_STORED_MESH_H
#define HE_STORE_STORED_MESH_H

#include "store/holder/holders.h"
#include "store/idempotency.h"
#include "store/publish/booking.h"
#include "store/publish/broadcast_queue.h"
#include "store/publish/store_counts.h"
#include "store/revision_log.h"
#include "store/sorted_cards.h"

#include <pthread.h>
#include <stdatomic.h>

/* A copy of a mesh at one revision. The cache and each snapshot of that revision hold a reference
 * to it; while a snapshot exists, the copy does not change. */
typedef struct st_copy {
    _Atomic uint32_t uses;
    _Atomic uint64_t used; /* st_clock_micros when a snapshot of it was last taken or released */
    uint64_t revision;
    /* Time at which the revision of the copy was made; set only if it is not the present
     * revision. */
    double time;
    he_replay *replay;
    /* the counters of the store to which the bytes of the copy were added */
    st_store_counts *counts;
    uint64_t bytes;
} st_copy;

typedef struct st_next_base st_next_base;

struct st_mesh {
    _Atomic uint32_t uses;
    /* When the mesh was last found or created, by st_clock_micros; matters only if meshes can be
     * evicted. */
    _Atomic uint64_t used;
    char *damage; /* why the mesh cannot be loaded; NULL if it can */
    st_store *store;
    const st_journal *journal;
    struct st_followers *followers;
    st_holders *holders;
    /* the mesh in the sorted lists of the store; NULL: the journal stores meshes and lists them */
    st_sorted_entry *sorted;

    pthread_rwlock_t lock; /* guards the members from here down to `next_base` */
    /* description of the mesh (id, name, revision, ...); its members undo and redo are not set
     * here, because `log` has these numbers */
    st_mesh_info info;
    he_mesh *content;
    st_revision_log log;
    /* the mesh's holder (owner), and the bytes by which the mesh counts for the holder */
    st_holding holding;
    /* true if a long edit has claimed the mesh; it then uses the delta that the log has reserved */
    bool claimed;

    /* The sizes of the mesh that were last added to the counters of the store; also written,
     * without the lock, while the mesh is made and other threads do not know it. */
    uint64_t weights[ST_WEIGHT_COUNT];

    /* The revision of the mesh's base (content from which it is loaded) on the disk: this revision
     * and later ones can be loaded. */
    uint64_t base;
    /* bytes of records that were appended since the last snapshot that rebase.c made */
    uint64_t appended;
    /* A snapshot that may become the new base of the mesh, see rebase.c; NULL: there is none. */
    st_next_base *next_base;

    /* Messages for listeners, see followers.h. */
    st_queue queue;
    /* The wait until the newest change is durable; `waiting` says whether this wait is under
     * way. */
    st_wait wait;
    _Atomic bool waiting;

    pthread_mutex_t snapshot_lock;
    st_copy *copy; /* copy of the present revision; NULL: not cached */

    pthread_mutex_t past_lock;
    st_copy *past; /* copy of an earlier revision; NULL: not cached */

    pthread_mutex_t cache_lock;
    void *cache;
    size_t cache_size;
    uint64_t cache_revision;

    st_keys keys;
    struct {
        pthread_mutex_t lock;
        /* signalled when a thread ends its use of the slot for a derived object */
        pthread_cond_t ended;
        st_derived place;
    } derived[ST_DERIVED_COUNT];
};

/* The limits and counts of listeners, shared by the meshes of a store. */
typedef struct st_followers {
    st_render *render;
    /* `most` is the most listeners of all meshes, `most_of_mesh` those of one mesh */
    size_t most, most_of_mesh;
    struct st_waits *waits;
    _Atomic size_t count; /* listeners in all */
    st_store_counts counts;
} st_followers;

/* The settings of the store that a mesh needs. */
typedef struct st_mesh_options {
    st_store *store;
    const st_journal *journal;
    st_followers *followers;
    st_holders *holders;
    uint64_t undo_budget;
    const uint64_t *secret;
} st_mesh_options;

/* Makes a mesh from a card (its description) but without content and history, which the caller
 * adds. Returns NULL if memory is out. */
st_mesh *st_mesh_bare(const st_mesh_options *options, const st_card *card);
/* Makes a mesh at its first revision, which owns `content`; `cause`, which may be NULL, names its
 * holder. Returns NULL if memory is out. The count of the holder does not include the new mesh
 * yet. */
st_mesh *st_mesh_new(const st_mesh_options *options, const char *id, const char *name,
                     const st_cause *cause, he_mesh *content);
/* Records that the mesh is used now, because the least recently used meshes are evicted first. */
void st_mesh_use(st_mesh *mesh);
st_counts st_counts_of(const he_mesh *content);
/* Copies the description of a mesh. The caller holds the mesh's lock. */
void st_mesh_facts(const st_mesh *mesh, st_mesh_info *out);
/* Frees the caches of a mesh: its cached copies, the bodies of remembered answers, unless a thread
 * is reading these, and derived objects. */
void st_mesh_shed(st_mesh *mesh);
/* Updates the counters of the store after the mesh's memory has changed. The caller holds the
 * exclusive lock, or is the only thread that knows the mesh. */
void st_mesh_weigh(st_mesh *mesh);
/* A change, rendered as a message for listeners. */
typedef struct st_event {
    char *bytes; /* bytes of the message; NULL: there are no listeners, or memory was out */
    size_t length;
} st_event;

/* Records that become durable together, each with a message for listeners: either `changes`, which
 * are rendered if there are listeners, or `events`, which are rendered already and whose bytes are
 * taken. */
typedef struct st_group {
    /* reserved space in the journal for the records; publishing the group uses it up and clears
     * it */
    st_booking *booking;
    st_record *records;
    size_t count;
    /* `changes` is an array of changes, one for each record, or NULL */
    const st_change *changes;
    st_event *events; /* an array of rendered messages, one for each record, or NULL */
} st_group;

/* Returns the next record of the mesh, filled with the mesh's present name, revision and counts. If
 * the record is of a revision, that revision must be in the log already. The caller holds the
 * exclusive lock. */
st_record st_mesh_record(st_mesh *mesh, st_record_kind kind, const st_cause *cause);
/* Returns a record of the kind `kind` that describes the mesh as it is after its newest record. The
 * caller holds the shared or the exclusive lock. */
st_record st_mesh_facts_record(const st_mesh *mesh, st_record_kind kind);
/* Sets the bytes by which the mesh counts for its holder. The caller holds the exclusive lock.
 * Returns ST_QUOTA if the holder may not have so much; then nothing is changed. */
st_status st_mesh_grow(st_mesh *mesh, uint64_t bytes);
/* Appends a group of records to the journal and informs the listeners. The caller holds the
 * exclusive lock. */
void st_mesh_publish(st_mesh *mesh, const st_group *group);
/* Sends the messages of a group of records to the listeners, after the records have their
 * positions: the last part of st_mesh_publish. */
void st_mesh_tell(st_mesh *mesh, const st_group *group);
void st_event_write(const st_mesh *mesh, const st_mesh_info *info, const st_change *change,
                    st_event *out);
/* Removes the mesh from the store and marks it as lost, if its newest change is lost. */
void st_mesh_lose(st_mesh *mesh, const st_loss *loss);
/* Moves the mesh to its places in the sorted lists of the store, after the change that `record`
 * describes. A mesh that is removed leaves the lists with the table (st_store_take_out). The caller
 * holds the mesh's exclusive lock, or is the only thread that knows the mesh. */
void st_store_sort(st_store *store, const st_mesh *mesh, const st_record *record);
/* Removes the mesh from the store's table of meshes and sorted lists. The caller holds the mesh's
 * exclusive lock. */
void st_store_take_out(st_store *store, st_mesh *mesh);

/* Adds the bytes of a group of records to the mesh's member `appended`, and begins to make a new
 * base if one is due (rebase.c). The caller holds the exclusive lock. */
void st_rebase_note(st_mesh *mesh, const st_group *group);
/* Returns about how many bytes a record takes on the disk, by which rebase.c decides when a new
 * base is due. */
uint64_t st_rebase_bytes(const st_record *record);
/* Drops the snapshot of the mesh that was to become its new base. */
void st_rebase_drop(st_mesh *mesh);

void st_copy_release(st_copy *copy);
/* Frees the cached copy of a mesh, unless a thread is reading the copy. */
void st_copy_shed(st_mesh *mesh);
/* Frees the cached copies of a mesh that no thread is reading and that were last used before
 * `before`, or ten seconds earlier if they show an earlier revision. Does not wait for a thread
 * that is making a copy. */
void st_copy_expire(st_mesh *mesh, uint64_t before);

#endif
