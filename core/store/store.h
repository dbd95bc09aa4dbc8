/* store.h - the meshes of a daemon: found by id, guarded by locks, numbered by revisions, and kept
 * on the disk. write.h declares the functions that change them.
 *
 * A handle is a counted reference to a stored mesh. It stays valid after the mesh was removed from
 * the store, then reading `removed` true, until st_release. A mesh is freed with its last handle,
 * so threads that are reading a mesh can finish after its removal.
 *
 * When the journal loses changes, each mesh whose newest change is lost leaves the store, reading
 * `lost` true: no write changes it, the streams of its listeners are closed, and answers made from
 * it are never sent. A request for its id then loads the mesh as it was before the lost changes.
 *
 * WORDS. A record is one change of a mesh in the journal; its position is its number among all
 * records of the store. A base is the content from which a mesh is loaded; the records after it are
 * then applied. A card is a short description of a mesh: id, name, counts and revision, without the
 * content. A content is staged when it is written to the disk before it is published. A claim
 * reserves a mesh for a long edit, which works on a copy without the lock (write.h). A change is
 * lost when the journal reports that it will never be durable. The holder of a mesh is the name of
 * the access token whose client created it.
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
typedef struct st_snapshot st_snapshot; /* an immutable copy of a mesh at one revision */
/* A request with an Idempotency-Key that has begun and not ended. */
typedef struct st_keyed st_keyed;

/* Why a mesh is changed, which the records of the change store. A NULL st_cause gives no reason. */
typedef struct st_cause {
    /* The request with an Idempotency-Key that makes the change; NULL: none. */
    const st_keyed *keyed;
    const char *job; /* id of the job that makes the change; NULL: none */
    /* If the change creates a mesh, the name of the access token it counts for (holder/holders.h);
     * "" or NULL: none. */
    const char *holder;
} st_cause;

/* Facts about a stored mesh as plain data, copied under its lock. */
typedef struct st_mesh_info {
    char id[ST_MESH_ID + 1];
    char name[ST_MESH_NAME + 1]; /* UTF-8, may be empty */
    uint64_t incarnation;        /* random number, new for each mesh created with this id */
    uint64_t metadata;           /* counts changes of name and metadata, from 1 */
    uint64_t revision;           /* counts changes of the content, from 1 */
    /* Counts every change of the mesh: of content or metadata, and the removal. */
    uint64_t record;
    uint64_t position;        /* position of the last change in the order of all records */
    double created, modified; /* seconds since 1970 UTC */
    uint32_t undo, redo;      /* numbers of steps that can be undone and redone */
    bool removed;
    /* True if the mesh has a change that will never be durable. Such a mesh has left the store. */
    bool lost;
    /* ST_OK, or why the mesh has no content: ST_DAMAGED or ST_NEWER, see st_load. */
    st_status unreadable;
    bool busy;               /* a long edit has claimed the mesh, see write.h */
    char job[ST_JOB_ID + 1]; /* id of the job whose long edit has claimed the mesh, or "" */
} st_mesh_info;

/* A change that listeners of a mesh are sent: a revision, a rename or a removal. */
typedef struct st_change {
    st_action action;          /* ST_REPLACE if the whole content was replaced */
    const he_delta *delta;     /* what was changed; NULL with ST_REPLACE and for a rename */
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
    uint64_t base_bytes; /* bytes of records after which a mesh gets a new base; 0: ST_BASE_BYTES */
    st_render *render;   /* makes the messages for listeners; NULL: the store has no listeners */
    size_t listeners;    /* most listeners at the same time of all meshes, and of one mesh */
    size_t mesh_listeners;
} st_store_options;

/* Makes a store. Returns NULL if memory is out or the journal cannot be read; the caller then still
 * owns the journal. */
st_store *st_store_new(const st_store_options *options);
/* Frees the store. No handle of a mesh may be left. */
void st_store_free(st_store *store);
/* Returns the two random words that the journal keeps. They are the secret key of the hashes of
 * names and of remembered requests, so that clients cannot choose values whose hashes collide. */
const uint64_t *st_secret(const st_store *store);
/* Returns the number of meshes, in memory or not. */
uint64_t st_store_count(st_store *store);
/* Returns true if meshes are kept on a disk. Then a request for a mesh that is not in memory, for
 * the list of meshes, or for an unused id waits for the disk. */
bool st_store_waits_for_disk(const st_store *store);
/* Reports in `out` whether the store accepts changes. Does not wait. */
void st_store_health(const st_store *store, st_health *out);
/* Sizes of the store now, and counts since its start. */
typedef struct st_store_measures {
    /* Numbers of meshes, on the disk or in memory: now, and allowed at most. */
    uint64_t meshes, most_meshes;
    uint64_t meshes_in_memory, vertices, edges, faces;
    uint64_t content_bytes, history_bytes, snapshot_bytes, event_bytes; /* bytes in memory */
    uint64_t revisions;                                                 /* revisions made */
    uint64_t evicted;                   /* meshes that were removed from memory to free it */
    uint64_t loads[ST_LOADED_COUNT];    /* loads, by their outcome */
    st_distribution load_time;          /* microseconds of the loads that found a mesh */
    uint64_t listeners, most_listeners; /* listeners of all meshes: now, and allowed at most */
    uint64_t events;                    /* events made for listeners */
    uint64_t listeners_behind;   /* how often a listener fell behind and had to fetch again */
    st_distribution event_lag;   /* microseconds from a change until a listener got it */
    st_journal_measures journal; /* zero if the journal keeps nothing */
} st_store_measures;

/* Measures the store. Takes the lock of the table of meshes and that of the journal for a moment;
 * does not wait for the disk. */
void st_store_measure(st_store *store, st_store_measures *out);
/* Sets the store that this thread works for. When an allocation of the thread would be refused,
 * unused meshes of that store are evicted first. NULL means that the thread works for no store. */
void st_store_serve(const st_store *store);
/* Must be called about once a second. While less than an eighth of the memory budget is free, it
 * evicts meshes that were not used for a minute, the least recently used first. */
void st_store_rest(st_store *store);
/* Returns true if memory is short (st_memory_is_short) although every mesh was evicted that can be.
 * Takes the locks that st_store_rest takes, and waits up to a quarter of a second if meshes can be
 * evicted once their changes are on the disk. */
bool st_store_is_full(st_store *store);
/* Frees caches: copies of meshes and bodies of remembered answers, unless a thread is reading them,
 * and objects derived from meshes. The caller must hold no lock. */
void st_store_shed(st_store *store);

/* --- holders of meshes --- (holder/holders.h) */

/* Sets how many meshes and bytes each of these holders may have; all other holders are unlimited.
 * Existing meshes stay; a change beyond a limit is refused with ST_QUOTA.
 * Returns ST_NO_MEMORY if memory is out; the limits are then as they were. */
st_status st_limit_holders(st_store *store, const st_holder_limit *limits, size_t count);
/* Returns the meshes and bytes that the holder has, in memory or not, and its limits; zeros for an
 * unknown holder. */
void st_holder_usage(st_store *store, const char *name, st_usage *out);
/* Returns the holder of the mesh, "" if it has none. Valid as long as the mesh. */
const char *st_holder_of(const st_mesh *mesh);

/* Returns the set of answers that wait until the changes they show are durable. */
st_waits *st_store_waits(st_store *store);
/* Returns which records an answer shows that shows one mesh, with the facts `info`. */
st_shown st_shown_of(const st_mesh_info *info);
/* Returns which records an answer shows that may show any mesh, or that says a mesh does not exist.
 * `since` is the durable position (st_waits_durable) when the answer was begun. */
st_shown st_shown_all(st_store *store, uint64_t since);

/* --- the collection --- */

/* Finds a mesh and adds a reference to it. Does not wait.
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
/* Returns ST_DAMAGED or ST_NEWER if the mesh has no content, else ST_OK. st_damage returns a
 * sentence that says why it has none, else "". The sentence stays valid as long as the mesh. */
st_status st_unreadable(const st_mesh *mesh);
const char *st_damage(const st_mesh *mesh);
/* Reads as much of a mesh as is intact, without putting it into the store, whose journal must be
 * one that only reads. `damage` says what prevents reading the revisions after that of *out, "" if
 * nothing does.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_DAMAGED or ST_NEWER with `damage` if no revision can be read.
 * Returns ST_FAILED, ST_NO_MEMORY or ST_BUDGET if it cannot be loaded. */
st_status st_salvage(st_store *store, const char *id, st_mesh **out, char damage[ST_DAMAGE]);
st_mesh *st_hold(st_mesh *mesh); /* adds a reference and returns `mesh` */
void st_release(st_mesh *mesh);  /* releases a reference; takes NULL */
/* Creates a mesh. Takes `content` on success. If `id` is NULL the store chooses one. `cause`, which
 * may be NULL, is stored in the first record. A worker must not call it if st_store_waits_for_disk
 * returns true.
 * Returns ST_TAKEN if a mesh has the id.
 * Returns ST_TOO_MANY if the store is full.
 * Returns ST_QUOTA if the holder would have more than it may.
 * Returns ST_LOADING if another thread's lookup of the id takes too long.
 * Returns ST_BUDGET, ST_NO_MEMORY, ST_BEHIND, ST_FULL or ST_FAILED if the mesh cannot be stored. */
st_status st_create(st_store *store, const char *id, const char *name, he_mesh *content,
                    const st_cause *cause, st_mesh **out);
/* What the store is told about a new mesh beside its content. */
typedef struct st_new_mesh {
    const char *id; /* NULL: the store chooses one */
    const char *name;
    const st_cause *cause; /* stored in the first record; may be NULL */
    const st_shown *from;  /* the records that the content was made from; NULL: none */
} st_new_mesh;

/* Creates a mesh like st_create, from a content that may have been made from other meshes. If the
 * records of those meshes that `made->from` names are lost, so is the new mesh.
 * Returns ST_LOST if they are lost already. */
st_status st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content, st_mesh **out);
/* Creates a mesh in place of a damaged one of that id, which is removed; either both happen or
 * neither.
 * Returns ST_ABSENT if the damaged mesh was removed before. */
st_status st_create_over(st_store *store, st_mesh *damaged, const char *name, he_mesh *content,
                         const st_cause *cause, st_mesh **out);
/* Writes a large content to the disk before it replaces another (st_write_replace), so that
 * st_write_commit need not write it while it holds the mesh's lock. Waits, so only threads that may
 * wait can call it, without a lock. *out is NULL if the content is small, or the journal keeps
 * nothing.
 * Returns ST_NO_MEMORY, ST_BEHIND, ST_FULL or ST_FAILED if the content cannot be written. */
st_status st_store_stage(const st_store *store, const he_mesh *content, st_stage **out);
void st_store_unstage(const st_store *store,
                      st_stage *stage); /* frees a stage that no write took; takes NULL */
/* Returns true if a record of so many bytes is too large for a record's body, so that an edit which
 * makes it should claim its mesh: only the commit of a claim can write it to the disk in advance,
 * any other commit encodes it while it holds the lock. */
bool st_store_stages(const st_store *store, uint64_t bytes);
/* Lists up to `limit` meshes that are in memory, in the order of ids, beginning after the id
 * `after` ("" for the start). Adds a reference to each. */
size_t st_list(st_store *store, const char *after, st_mesh **out, size_t limit);
/* Lists the cards of up to `limit` meshes, in memory or not, in the order of ids, beginning after
 * the id `after`, and loads none. A worker must not call it if st_store_waits_for_disk returns
 * true.
 * Returns ST_NO_MEMORY or ST_FAILED if the cards cannot be read. */
st_status st_cards(st_store *store, const char *after, st_card *out, size_t limit, size_t *count);

/* --- a mesh that is not in memory, without loading it --- */

/* A mesh that is not in memory, described by the facts on its card, of which entity tags and
 * preconditions are made. Whether the content can be read is not known. From st_cold_begin to
 * st_cold_end the caller owns the lookup of the id: no thread loads the mesh, and the facts do not
 * change. */
typedef struct st_cold {
    st_store *store;
    struct st_lookup *lookup;
    st_card card;
    st_mesh_info info; /* after st_cold_remove, the facts of the removed mesh */
} st_cold;

/* Reads the card of a mesh that is not in memory. If the mesh is in memory by now, *mesh is the
 * mesh with a reference, and st_cold_end must not be called. Waits for the disk, so only threads
 * that may wait can call it, without a lock.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_DAMAGED if the card is damaged; st_load then returns a mesh without content, which can
 * be removed.
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
 * many ids of vertices, half-edges and faces the mesh has ever issued. */
uint64_t st_read_card(st_mesh *mesh, st_mesh_info *info);
/* Makes an immutable copy of the present revision, shared by all callers that ask for this
 * revision. May copy the mesh, so a worker must not call it for large ones.
 * Returns ST_NO_MEMORY or ST_BUDGET if there is no room for the copy. */
st_status st_snapshot_take(st_mesh *mesh, st_snapshot **out);
/* Makes a copy of an earlier revision. May replay the history, so a worker must not call it. The
 * facts that st_snapshot_content returns for it are the present ones except for `revision` and
 * `modified`.
 * Returns ST_AHEAD if there is no such revision yet.
 * Returns ST_GONE if neither the history nor the records on the disk reach back to it.
 * Returns ST_NO_MEMORY, ST_BUDGET or ST_FAILED if the copy cannot be made. */
st_status st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out);
/* Makes a copy like st_snapshot_take, for a caller that holds the shared lock. */
st_status st_snapshot_held(st_mesh *mesh, st_snapshot **out);
const he_mesh *st_snapshot_content(const st_snapshot *snapshot, st_mesh_info *info);
void st_snapshot_release(st_snapshot *snapshot); /* takes NULL */
/* These two functions keep a value that was derived from one revision, such as its summary, until
 * the revision changes. st_cache_get copies it and returns false if no value is kept; st_cache_put
 * replaces it. The caller holds the read lock. */
bool st_cache_get(st_mesh *mesh, void *value, size_t size);
void st_cache_put(st_mesh *mesh, const void *value, size_t size);
/* Keeps a value like st_cache_put, but without a lock. `of` are the facts of the mesh from which
 * the value was made; if the mesh has changed since, nothing is kept. */
void st_cache_put_of(st_mesh *mesh, const st_mesh_info *of, const void *value, size_t size);

/* Objects that handlers derive from a mesh and that the store keeps with it, one of each kind. */
typedef enum st_derived_kind {
    ST_DERIVED_SLOTS, /* arrays for GET .../geometry, updated as the mesh changes */
    /* The tree of boxes for rays and nearest points, for one revision: see api/ask/bvh_cache.h. */
    ST_DERIVED_BVH,
    ST_DERIVED_COUNT
} st_derived_kind;

/* The most milliseconds that st_derived_wait waits, so that its caller can check for
 * cancellation. */
enum { ST_DERIVED_MILLIS = 50 };

typedef struct st_derived {
    void *value; /* the object; NULL: none is kept */
    void (*destroy)(void *value);
} st_derived;

/* Locks the slot that keeps an object derived from a mesh, until st_derived_end. If the thread also
 * takes the mesh's read lock, it takes that first; it locks one slot at a time, and never for
 * longer than a worker may take for a request. The store destroys the object when memory is short,
 * and with the mesh. */
st_derived *st_derived_begin(st_mesh *mesh, st_derived_kind kind);
void st_derived_end(st_mesh *mesh, st_derived_kind kind);
/* Unlocks the slot until another thread has ended its use of it, or for ST_DERIVED_MILLIS, then
 * locks it again. It must not be called on a worker, nor under a lock that another user of the slot
 * may need. */
void st_derived_wait(st_mesh *mesh, st_derived_kind kind);
/* Returns the delta of a revision, which may have been applied forwards or backwards (undone); NULL
 * if it is not kept. The caller holds the read lock. */
const he_delta *st_revision_delta(st_mesh *mesh, uint64_t revision);

/* --- keyed requests --- (idempotency.h) */

typedef struct st_key {
    const char *text;
    uint64_t digest[2]; /* hash of the request, keyed by st_secret */
    const char *holder; /* the client that sent it; "" or NULL: clients without a name */
} st_key;

typedef enum st_keyed_status {
    ST_KEYED_NEW,   /* the key was not seen before: the request is executed */
    ST_KEYED_KEPT,  /* the request was answered before */
    ST_KEYED_BUSY,  /* an equal request with the key is under way */
    ST_KEYED_OTHER, /* a different request has used the key */
    /* A request with the key was executed, but the record of which one is damaged. */
    ST_KEYED_DAMAGED,
    ST_KEYED_NO_MEMORY
} st_keyed_status;

enum { ST_KEPT_TAG = 96 };

/* The answer to a keyed request. */
typedef struct st_kept {
    int status;
    /* The request changed something, so the answer is kept even if there is no memory for its
     * body. */
    bool changed;
    char etag[ST_KEPT_TAG]; /* ETag of the answer; "": it had none */
    /* Id of the mesh that the answer shows, which Location names with status 201. */
    char id[ST_MESH_ID + 1];
    uint64_t incarnation, position;
    /* The state that the answer's ETag names, if the answer was given before the server was last
     * started, so that its tag is not kept; else 0. */
    uint64_t revision, metadata;
    const char *body; /* JSON; NULL although `length` is not 0: the body was not kept */
    size_t length;
} st_kept;

/* Begins a keyed request, before it is tried, without a lock. If `mesh` is NULL the key is among
 * those of the store. With ST_KEYED_NEW all memory for the answer is allocated, so st_keyed_keep
 * cannot fail; with ST_KEYED_KEPT st_keyed_answer gives the answer. In both cases st_keyed_end ends
 * the request, and forgets the key unless the answer was kept. Keys of a mesh are deleted with the
 * mesh, and every key after a day or when newer keys need the memory. */
st_keyed_status st_keyed_begin(st_store *store, st_mesh *mesh, const st_key *key, st_keyed **out);
const st_kept *st_keyed_answer(const st_keyed *keyed);
void st_keyed_keep(st_keyed *keyed, const st_kept *answer);
void st_keyed_end(st_keyed *keyed);

/* Writes a note to the journal, so that the key of a request that changed nothing survives a
 * restart; the key of a change is in the records of that change. The function must be called before
 * st_keyed_keep; `info` are the facts of the mesh that the answer shows. *position is the position
 * of the note, which must be durable before the answer is sent; 0: there is none. If the journal
 * refuses, the answer is kept in memory only. */
void st_keyed_note(st_store *store, const st_keyed *keyed, const st_mesh_info *info,
                   uint64_t *position);

/* --- jobs --- (api/job/job_table.h runs them) */

/* Stores the state of a job (st_job_keep) or removes it (st_job_forget), by a note in the journal,
 * whose position is *position; 0 if the journal keeps nothing.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if the journal refuses. */
st_status st_job_keep(st_store *store, const st_job *job, uint64_t *position);
st_status st_job_forget(st_store *store, const char *id, uint64_t *position);
/* Passes each job that the journal has stored to `take`. It is called when the daemon starts.
 * Returns ST_NO_MEMORY or ST_FAILED if they cannot be read. */
st_status st_jobs_kept(st_store *store, st_take_job *take, void *context);

/* --- the history, under the read lock --- */

enum { ST_ENTRY_OPS = 256 };

typedef struct st_entry {
    uint64_t revision;
    uint64_t inverts; /* the revision that this one undid or redid, 0 for an edit */
    st_action action;
    /* Names of the operations, joined by ','; a long list is cut and ends with "...". */
    char ops[ST_ENTRY_OPS];
    bool undoable;
    size_t bytes;
    double time;
    st_tally tally;
} st_entry;

typedef struct st_history {
    /* The oldest revision whose content can be read, from memory or the disk. */
    uint64_t oldest;
    uint64_t dropped;       /* number of entries dropped to keep the history within its budget */
    uint64_t bytes, budget; /* bytes of entries and deltas: now, and allowed at most */
} st_history;

/* Copies the entry of the i-th newest revision of a mesh. Returns false if there are fewer. */
bool st_history_entry(st_mesh *mesh, size_t i, st_entry *out);
void st_history_reach(st_mesh *mesh, st_history *out);

#endif
