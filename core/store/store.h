/* store.h - the meshes of a daemon: by id, locked, with revisions, and durable. write.h declares
 * the functions that change them.
 *
 * A handle is a counted reference to a stored mesh. It stays valid after the mesh was removed from
 * the store, then reading `removed` true, until st_release. A mesh is freed with its last handle,
 * so threads that are reading a mesh can finish after its removal.
 *
 * When the journal loses changes, each mesh whose newest change is lost leaves the store, reading
 * `lost` true: no write changes it, its listeners are cut off, and answers made from it are never
 * sent. A request for its id then loads the mesh as it was before the lost changes.
 *
 * WORDS. A record is one change of a mesh in the journal, and a position its number among all
 * records of the store. A base is the content from which a mesh is loaded; the records after it are
 * then applied. A card has the facts of a mesh without its content. A content is staged when it is
 * written to the disk before it is published. A claim reserves a mesh for a long edit, which works
 * on a copy without the lock (write.h). A change is lost when the journal reports that it will
 * never be durable. A holder is the name of the token that made a mesh.
 *
 * Locks are held while computing, never while waiting for a client. They are taken in this order:
 *     past      the mesh's cached copy of an earlier revision; not on a worker
 *     mesh      one mesh, shared by readers or held by one writer; writers come first
 *     room      held by the one thread that frees memory for others
 *     lookups   ids that are being looked up on the disk (lookup.h)
 *     table     the collection, for as long as a search takes
 *     snapshot  the mesh's cached copy
 *     cache     the mesh's cached value
 *     keys      answers kept for keyed requests, of a mesh or of the store
 *     derived   objects that handlers derived from the mesh
 *     queue     messages for listeners of the mesh (publish/broadcast_queue.h)
 *     waits     answers that wait until they are durable (publish/durability_wait.h)
 *     holders   how much each holder of meshes has (holder/holders.h)
 * The table of jobs (api/job/job_table.h) has a lock that is taken after a mesh's, and connections
 * that wait for events (server/http/http_stream.h) one that is taken after all others. A thread
 * that holds a mesh's lock must not take another mesh's lock, not even shared, nor its own again: a
 * waiting writer would block both. To bring another mesh's content in, take its snapshot first. */
#ifndef HE_STORE_STORE_H
#define HE_STORE_STORE_H

#include "mesh/delta.h"
#include "store/holder/holders.h"
#include "store/publish/durability_wait.h"
#include "store/publish/store_counts.h"
#include "system/thread_pool.h"

typedef struct st_store st_store;
typedef struct st_mesh st_mesh;         /* a stored mesh */
typedef struct st_snapshot st_snapshot; /* an immutable copy at one revision */
typedef struct st_keyed st_keyed;       /* a request with an Idempotency-Key, begun and not ended */

/* The reason for a change, which its records store. NULL means no reason. */
typedef struct st_cause {
    const st_keyed *keyed; /* the request with an Idempotency-Key; NULL: none */
    const char *job;       /* the job that makes the change; NULL: none */
    /* The holder of a mesh that the change creates (holder/holders.h); "" or NULL: none. */
    const char *holder;
} st_cause;

/* Facts about a stored mesh as plain data, copied under its lock. */
typedef struct st_mesh_info {
    char id[ST_MESH_ID + 1];
    char name[ST_MESH_NAME + 1]; /* UTF-8, may be empty */
    uint64_t incarnation;        /* random, new for each create of an id */
    uint64_t metadata;           /* counts changes of name and metadata, from 1 */
    uint64_t revision;           /* counts changes of the content, from 1 */
    uint64_t record;             /* counts every change: revisions, metadata, the removal */
    uint64_t position;           /* position of the last change in the order of all records */
    double created, modified;    /* seconds since 1970 UTC */
    uint32_t undo, redo;         /* steps on the stacks */
    bool removed;
    /* Whether the mesh has a change that will never be durable: it is then no longer in the
     * store. */
    bool lost;
    st_status unreadable;    /* ST_OK, or ST_DAMAGED or ST_NEWER: it has no content, see st_load */
    bool busy;               /* a long edit has claimed it, see write.h */
    char job[ST_JOB_ID + 1]; /* the job that makes that edit, "" if none does */
} st_mesh_info;

/* A revision, a rename or a removal, for listeners. */
typedef struct st_change {
    st_action action;          /* ST_REPLACE: the whole content was replaced */
    const he_delta *delta;     /* NULL with ST_REPLACE and for a rename */
    bool undone;               /* the delta was applied backwards */
    const he_changes *changes; /* the net changes of the delta; NULL: not computed */
    const he_mesh *content;    /* the mesh after the change */
    bool removed;              /* the mesh was deleted; no further change follows */
} st_change;

/* A function that renders a change as a message for listeners of the mesh. `bytes` is allocated by
 * base/mem.h; the caller frees it. Returns false if memory is out. It is called under the mesh's
 * write lock. */
typedef bool st_render(const st_mesh_info *info, const st_change *change, char **bytes,
                       size_t *length);

typedef struct st_store_options {
    uint64_t undo_budget; /* bytes for each mesh */
    uint64_t max_meshes;
    st_journal journal; /* the store closes it */
    st_pool *pool; /* makes bases of meshes with many records (rebase.c); NULL: no bases are made */
    uint64_t base_bytes; /* bytes of records after which a base is due; 0: ST_BASE_BYTES */
    st_render *render;   /* NULL: there will be no listeners */
    size_t listeners;    /* most listeners at once in all, and to one mesh */
    size_t mesh_listeners;
} st_store_options;

/* Makes a store. Returns NULL if memory is out or the journal cannot be read; the caller then still
 * owns the journal. */
st_store *st_store_new(const st_store_options *options);
/* No handle may be left. */
void st_store_free(st_store *store);
/* Returns the two random words that the journal keeps. They key hashes of names in tables and of
 * requests that are remembered, so that clients cannot foresee these hashes. */
const uint64_t *st_secret(const st_store *store);
/* Returns the number of meshes, in memory or not. */
uint64_t st_store_count(st_store *store);
/* Returns true if meshes are kept on a disk. Then a request for a mesh that is not in memory, for
 * the list, or for a free id waits for the disk. */
bool st_store_waits_for_disk(const st_store *store);
/* Reports whether changes are accepted. Does not wait. */
void st_store_health(const st_store *store, st_health *out);
/* Sizes of the store now, and counts since its start. */
typedef struct st_store_measures {
    uint64_t meshes, most_meshes; /* on the disk or in memory */
    uint64_t meshes_in_memory, vertices, edges, faces;
    uint64_t content_bytes, history_bytes, snapshot_bytes, event_bytes; /* bytes in memory */
    uint64_t revisions;                                                 /* revisions made */
    uint64_t evicted;                   /* meshes that left memory to make room */
    uint64_t loads[ST_LOADED_COUNT];    /* loads, by their outcome */
    st_distribution load_time;          /* microseconds of the loads that found a mesh */
    uint64_t listeners, most_listeners; /* listeners to meshes */
    uint64_t events;                    /* events made for listeners */
    uint64_t listeners_behind;   /* how often a listener fell behind and had to fetch again */
    st_distribution event_lag;   /* microseconds from a change until a listener got it */
    st_journal_measures journal; /* zero if the journal keeps nothing */
} st_store_measures;

/* Measures the store. Takes the locks of the table and of the journal for a moment, and waits for
 * nothing else. */
void st_store_measure(st_store *store, st_store_measures *out);
/* Sets the store that this thread works for: before the thread is refused memory, unused meshes
 * that the journal can load again are evicted. NULL ends this. */
void st_store_serve(const st_store *store);
/* Must be called about once a second. While less than an eighth of the memory budget is free, it
 * evicts meshes that were not used for a minute, the least recently used first. */
void st_store_rest(st_store *store);
/* Returns true if memory is short (st_memory_is_short) although every mesh was evicted that can be.
 * Takes the locks of st_store_rest, and waits a quarter of a second for the disk if that may
 * help. */
bool st_store_is_full(st_store *store);
/* Frees memory that can be made again: the cached copies and the bodies of kept answers that no
 * thread reads, and objects derived from meshes. The caller must hold no lock. */
void st_store_shed(st_store *store);

/* --- holders of meshes --- (holder/holders.h) */

/* Sets how many meshes and bytes these holders may have; all others are unlimited. What exists
 * already stays; a change beyond a limit is refused with ST_QUOTA.
 * Returns ST_NO_MEMORY if memory is out; the limits are then as they were. */
st_status st_limit_holders(st_store *store, const st_holder_limit *limits, size_t count);
/* Returns the meshes and bytes that a holder has, in memory or not, and may have; zeros for an
 * unknown holder. */
void st_holder_usage(st_store *store, const char *name, st_usage *out);
/* Returns the holder of the mesh, "" if it has none. Valid as long as the mesh. */
const char *st_holder_of(const st_mesh *mesh);

/* Returns the waits of answers that are not yet durable. */
st_waits *st_store_waits(st_store *store);
/* Returns the records that an answer shows if it shows one mesh with these facts. */
st_shown st_shown_of(const st_mesh_info *info);
/* Returns the records that an answer shows if it may show any mesh, or that one does not exist.
 * Everything up to `since` was durable when the answer was begun (st_waits_durable). */
st_shown st_shown_all(st_store *store, uint64_t since);

/* --- the collection --- */

/* Finds a mesh and adds a reference. Does not wait.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_COLD if it is not in memory; only st_load finds out whether it exists. */
st_status st_find(st_store *store, const char *id, st_mesh **out);
/* Finds a mesh like st_find, and loads one that is not in memory, once for all threads that request
 * it. Waits, so only threads that may wait can call it, without a lock. A mesh that is damaged, or
 * that a newer release has written, is found with info.unreadable: it has no content, and can only
 * be removed or replaced (st_create_over).
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_LOADING if another thread has been loading it for too long.
 * Returns ST_NO_MEMORY, ST_BUDGET or ST_FAILED if it cannot be loaded. */
st_status st_load(st_store *store, const char *id, st_mesh **out);
/* Returns why a mesh has no content, ST_DAMAGED or ST_NEWER, else ST_OK; st_damage returns a
 * sentence about that, else "". Both stay valid as long as the mesh. */
st_status st_unreadable(const st_mesh *mesh);
const char *st_damage(const st_mesh *mesh);
/* Reads as much of a mesh as is intact, without putting it into the store, whose journal must be
 * one that only reads. `damage` says what is wrong after the revision of the mesh, "" if nothing
 * is.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_DAMAGED or ST_NEWER with `damage` if no revision can be read.
 * Returns ST_FAILED, ST_NO_MEMORY or ST_BUDGET if it cannot be loaded. */
st_status st_salvage(st_store *store, const char *id, st_mesh **out, char damage[ST_DAMAGE]);
st_mesh *st_hold(st_mesh *mesh); /* adds a reference */
void st_release(st_mesh *mesh);  /* takes NULL */
/* Creates a mesh. Takes `content` on success. If `id` is NULL the store chooses one. `cause`, which
 * may be NULL, is stored in the first record. If st_store_waits_for_disk, a worker must not call
 * it.
 * Returns ST_TAKEN if a mesh has the id.
 * Returns ST_TOO_MANY if the store is full.
 * Returns ST_QUOTA if the holder would have more than it may.
 * Returns ST_LOADING if another thread's lookup of the id takes too long.
 * Returns ST_BUDGET, ST_NO_MEMORY, ST_BEHIND, ST_FULL or ST_FAILED if the mesh cannot be stored. */
st_status st_create(st_store *store, const char *id, const char *name, he_mesh *content,
                    const st_cause *cause, st_mesh **out);
/* A mesh that is created, without its content. */
typedef struct st_new_mesh {
    const char *id; /* NULL: the store chooses one */
    const char *name;
    const st_cause *cause; /* stored in the first record; may be NULL */
    const st_shown *from;  /* the records that the content was made from; NULL: none */
} st_new_mesh;

/* Creates a mesh like st_create, from a content that may have been made from the records of other
 * meshes; if those records are lost, so is the new mesh.
 * Returns ST_LOST if they are lost already. */
st_status st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content, st_mesh **out);
/* Creates a mesh in place of a damaged one of that id, which is removed; either both happen or
 * neither.
 * Returns ST_ABSENT if the damaged mesh was removed before. */
st_status st_create_over(st_store *store, st_mesh *damaged, const char *name, he_mesh *content,
                         const st_cause *cause, st_mesh **out);
/* Writes a large content to the disk before it replaces another (st_write_replace), so that the
 * write need not do that under its lock. Waits, so only threads that may wait can call it, without
 * a lock. *out is NULL if there is nothing to be done.
 * Returns ST_NO_MEMORY, ST_BEHIND, ST_FULL or ST_FAILED if the content cannot be written. */
st_status st_store_stage(const st_store *store, const he_mesh *content, st_stage **out);
void st_store_unstage(const st_store *store,
                      st_stage *stage); /* for a stage that no write took; takes NULL */
/* Is a record of so many bytes staged, so that a write which makes one had better claim its mesh?
 * Only the commit of a claim can stage an edit; any other encodes it under the lock. */
bool st_store_stages(const st_store *store, uint64_t bytes);
/* Lists up to `limit` meshes that are in memory with ids after `after` ("" for the start), in the
 * order of ids, each with a reference. */
size_t st_list(st_store *store, const char *after, st_mesh **out, size_t limit);
/* Lists the cards of meshes in memory or not, in the order of ids after `after`, without loading
 * any. If st_store_waits_for_disk, a worker must not call it.
 * Returns ST_NO_MEMORY or ST_FAILED if the cards cannot be read. */
st_status st_cards(st_store *store, const char *after, st_card *out, size_t limit, size_t *count);

/* --- a mesh that is not in memory, without loading it --- */

/* A mesh that is not in memory: the facts on its card, of which entity tags and preconditions are
 * made. Whether the content can be read is not known. From st_cold_begin to st_cold_end the caller
 * has the lookup of the id: no thread loads the mesh, and the facts do not change. */
typedef struct st_cold {
    st_store *store;
    struct st_lookup *lookup;
    st_card card;
    st_mesh_info info; /* after st_cold_remove, the facts of the removed mesh */
} st_cold;

/* Reads the card of a mesh that is not in memory. If it is in memory by now, *mesh is the mesh with
 * a reference, and nothing was begun. Waits for the disk, so only threads that may wait can call
 * it, without a lock.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_DAMAGED if the card is damaged; st_load then gives a mesh that can be removed.
 * Returns ST_LOADING, ST_NO_MEMORY or ST_FAILED if the card cannot be read. */
st_status st_cold_begin(st_store *store, const char *id, st_mesh **mesh, st_cold *out);
/* Removes a mesh that is not in memory; may be called once. Does not wait.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if the journal refuses. */
st_status st_cold_remove(st_cold *cold);
void st_cold_end(st_cold *cold);

/* --- reading --- */

/* Takes the shared lock of a mesh and returns its content, never NULL. `info` may be NULL. */
const he_mesh *st_read_begin(st_mesh *mesh, st_mesh_info *info);
void st_read_end(st_mesh *mesh);
/* Copies the facts of the mesh without its content, under the shared lock for a moment. Returns how
 * many vertices, half-edges and faces were issued. */
uint64_t st_read_card(st_mesh *mesh, st_mesh_info *info);
/* Makes an immutable copy of the present revision, shared by all callers that ask for this
 * revision. May copy the mesh, so a worker must not call it for large ones.
 * Returns ST_NO_MEMORY or ST_BUDGET if there is no room for the copy. */
st_status st_snapshot_take(st_mesh *mesh, st_snapshot **out);
/* Makes a copy of an earlier revision. May replay the history, so a worker must not call it. The
 * info is the present one except for `revision` and `modified`.
 * Returns ST_AHEAD if there is no such revision yet.
 * Returns ST_GONE if neither the history nor the records on the disk reach back to it.
 * Returns ST_NO_MEMORY, ST_BUDGET or ST_FAILED if the copy cannot be made. */
st_status st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out);
/* Makes a copy like st_snapshot_take, for a caller that holds the shared lock. */
st_status st_snapshot_held(st_mesh *mesh, st_snapshot **out);
const he_mesh *st_snapshot_content(const st_snapshot *snapshot, st_mesh_info *info);
void st_snapshot_release(st_snapshot *snapshot); /* takes NULL */
/* These functions keep a value that was derived from one revision, such as its summary, until the
 * revision changes. st_cache_get copies it and returns false if there is none; st_cache_put
 * replaces it. The caller holds the read lock. */
bool st_cache_get(st_mesh *mesh, void *value, size_t size);
void st_cache_put(st_mesh *mesh, const void *value, size_t size);
/* Keeps a value like st_cache_put, without a lock: keeps nothing if the mesh has changed since it
 * had the facts `of`. */
void st_cache_put_of(st_mesh *mesh, const st_mesh_info *of, const void *value, size_t size);

/* Objects that handlers derive from a mesh and keep with it, one of each kind. */
typedef enum st_derived_kind {
    ST_DERIVED_SLOTS, /* for GET .../geometry, updated as the mesh changes */
    ST_DERIVED_BVH,   /* for rays and nearest points, for one revision: see api/ask/bvh_cache.h */
    ST_DERIVED_COUNT
} st_derived_kind;

/* The most milliseconds that st_derived_wait waits, so that its caller can check for
 * cancellation. */
enum { ST_DERIVED_MILLIS = 50 };

typedef struct st_derived {
    void *value; /* NULL: there is none */
    void (*destroy)(void *value);
} st_derived;

/* Takes the slot of an object derived from a mesh. One thread has the slot from begin to end. It is
 * taken after the read lock or without it, one slot at a time, and never for longer than a worker
 * may take. The store destroys the object when memory is short, and with the mesh. */
st_derived *st_derived_begin(st_mesh *mesh, st_derived_kind kind);
void st_derived_end(st_mesh *mesh, st_derived_kind kind);
/* Lends the slot to other threads until one of them has ended, or for ST_DERIVED_MILLIS, then takes
 * it back. It must not be called on a worker, nor under a lock that another user of the slot may
 * need. */
void st_derived_wait(st_mesh *mesh, st_derived_kind kind);
/* Returns the delta of a revision, in either direction; NULL if it is not kept. The caller holds
 * the read lock. */
const he_delta *st_revision_delta(st_mesh *mesh, uint64_t revision);

/* --- keyed requests --- (idempotency.h) */

typedef struct st_key {
    const char *text;
    uint64_t digest[2]; /* hash of the request, keyed by st_secret */
    const char *holder; /* the client that sent it; "" or NULL: clients without a name */
} st_key;

typedef enum st_keyed_status {
    ST_KEYED_NEW,     /* not seen before: go on */
    ST_KEYED_KEPT,    /* it was answered before */
    ST_KEYED_BUSY,    /* an equal request is under way */
    ST_KEYED_OTHER,   /* another request used the key */
    ST_KEYED_DAMAGED, /* a request with the key was done, but it is not known any more which one */
    ST_KEYED_NO_MEMORY
} st_keyed_status;

enum { ST_KEPT_TAG = 96 };

/* The answer to a keyed request. */
typedef struct st_kept {
    int status;
    bool changed; /* it changed something: then it is kept even if there is no room for its body */
    char etag[ST_KEPT_TAG];  /* "" for none */
    char id[ST_MESH_ID + 1]; /* the mesh it shows, which Location names with 201 */
    uint64_t incarnation, position;
    /* The state that the answer's ETag names, if the answer was given before the server was last
     * started, so that its tag is not kept; else 0. */
    uint64_t revision, metadata;
    const char *body; /* JSON; NULL with a length: omitted */
    size_t length;
} st_kept;

/* Begins a keyed request, before it is tried, without a lock. If `mesh` is NULL the key is among
 * those of the store. With ST_KEYED_NEW all memory for the answer is allocated, so st_keyed_keep
 * cannot fail; with ST_KEYED_KEPT st_keyed_answer gives the answer. In both cases st_keyed_end ends
 * it, and forgets the key unless the answer was kept. Keys of a mesh are deleted with the mesh, and
 * every key after a day or when newer ones need the room. */
st_keyed_status st_keyed_begin(st_store *store, st_mesh *mesh, const st_key *key, st_keyed **out);
const st_kept *st_keyed_answer(const st_keyed *keyed);
void st_keyed_keep(st_keyed *keyed, const st_kept *answer);
void st_keyed_end(st_keyed *keyed);

/* Makes a request that changed nothing survive a restart; one that changed something is in its
 * records already. It must be called before st_keyed_keep, with the facts of the mesh that the
 * answer shows. *position is what the answer must wait for, 0 for nothing. If the journal refuses,
 * the answer is kept in memory only. */
void st_keyed_note(st_store *store, const st_keyed *keyed, const st_mesh_info *info,
                   uint64_t *position);

/* --- jobs --- (api/job/job_table.h runs them) */

/* Stores the state of a job, or removes it. *position is the position of that note in the journal,
 * 0 if the journal keeps nothing.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if the journal refuses. */
st_status st_job_keep(st_store *store, const st_job *job, uint64_t *position);
st_status st_job_forget(st_store *store, const char *id, uint64_t *position);
/* Passes the stored jobs to `take`, at the start.
 * Returns ST_NO_MEMORY or ST_FAILED if they cannot be read. */
st_status st_jobs_kept(st_store *store, st_take_job *take, void *context);

/* --- the history, under the read lock --- */

enum { ST_ENTRY_OPS = 256 };

typedef struct st_entry {
    uint64_t revision;
    uint64_t inverts; /* revision that it undid or redid, 0 for an edit */
    st_action action;
    char ops[ST_ENTRY_OPS]; /* names joined by ',', cut with "..." */
    bool undoable;
    size_t bytes;
    double time;
    st_tally tally;
} st_entry;

typedef struct st_history {
    uint64_t oldest;        /* the oldest revision that can be read, from memory or the disk */
    uint64_t dropped;       /* entries dropped to stay within the budget */
    uint64_t bytes, budget; /* bytes that entries and deltas take, and may take */
} st_history;

/* Copies the i-th newest entry of a mesh's history. Returns false past the end. */
bool st_history_entry(st_mesh *mesh, size_t i, st_entry *out);
void st_history_reach(st_mesh *mesh, st_history *out);

#endif
