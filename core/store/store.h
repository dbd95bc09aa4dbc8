/* store.h - the meshes of a daemon: found by id, guarded by locks, numbered by revisions, and kept
 * on the disk. write.h declares the functions that change them.
 *
 * A handle is a counted reference to a stored mesh. It stays valid until st_release, even after the
 * mesh was removed from the store; `removed` in its st_mesh_info is then true. A mesh is freed with
 * its last handle, so threads that are reading a mesh can finish after its removal.
 *
 * When the journal loses changes, each mesh whose newest change is lost leaves the store, and
 * `lost` in its st_mesh_info becomes true: no write changes it, the streams of its listeners are
 * closed, and answers made from it are never sent. A request for its id then loads the mesh as it
 * was before the lost changes.
 *
 * WORDS. A record is one change of a mesh in the journal; its position is its number among all
 * records of the store. A base is the content from which a mesh is loaded; the records after it are
 * then applied. A card is a short description of a mesh without the content: id, name, counts and
 * revision. A content is staged when it is written to the disk before it is published. A claim
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
 *     sorted    the lists of meshes by name, time and size (sorted_cards.h)
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
/* A request with an Idempotency-Key, from its begin to its end. */
typedef struct st_keyed st_keyed;

/* The reason why a mesh is changed: a request, a job, or the client that creates the mesh. The
 * records of the change store it. A NULL pointer to an st_cause gives no reason. */
typedef struct st_cause {
    /* The request with an Idempotency-Key that makes the change; NULL: none. */
    const st_keyed *keyed;
    const char *job; /* `job` is the id of the job that makes the change; NULL: no job makes it */
    /* `holder`: if the change creates a mesh, the name of the access token for which the mesh
     * counts (holder/holders.h); "" or NULL: the mesh counts for none. */
    const char *holder;
} st_cause;

/* The description of a stored mesh: its id, name, revision and counts, copied under the mesh's
 * lock. */
typedef struct st_mesh_info {
    char id[ST_MESH_ID + 1];
    char name[ST_MESH_NAME + 1]; /* UTF-8, may be empty */
    /* random number, which differs for each mesh that was created with this id */
    uint64_t incarnation;
    /* counter of the changes of names, of the mesh and of its revisions, from 1 */
    uint64_t metadata;
    uint64_t revision; /* counter of the changes of the mesh's content, from 1 */
    /* Counter of all changes of the mesh: of its content, its metadata, and the removal. */
    uint64_t record;
    /* position of the record of the last change in the order of all records of the store */
    uint64_t position;
    double created, modified; /* seconds since 1970 UTC */
    /* `undo` and `redo` are the numbers of steps that can be undone and redone */
    uint32_t undo, redo;
    bool removed;
    /* True if the mesh has a change that will never be durable. Such a mesh has left the store. */
    bool lost;
    /* ST_OK, or why the mesh has no content: ST_DAMAGED or ST_NEWER, see st_load. */
    st_status unreadable;
    bool busy;               /* true if a long edit has claimed the mesh, see write.h */
    char job[ST_JOB_ID + 1]; /* id of the job whose long edit has claimed the mesh, or "" */
} st_mesh_info;

/* A change about which listeners of a mesh are informed: a new revision, a rename, the name of a
 * revision or a removal. */
typedef struct st_change {
    st_action action; /* ST_REPLACE if the whole content was replaced */
    /* delta: what was changed; NULL if the action is ST_REPLACE, and for names. */
    const he_delta *delta;
    bool undone; /* the delta was applied backwards */
    /* `changes` are the net changes of the delta; NULL: they were not computed */
    const he_changes *changes;
    const he_mesh *content; /* the mesh after the change */
    bool removed;           /* true if the mesh was deleted; no further change follows */
    /* `named` is the revision that got the name `moment`, or lost its name if that is ""; 0: the
     * change names no revision. */
    uint64_t named;
    const char *moment;
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
    /* threads that make bases (contents to load from) of meshes with many records, see rebase.c;
     * NULL: no bases are made */
    st_pool *pool;
    /* When the records since a mesh's base exceed this number of bytes, the mesh may get a new
     * base; 0: ST_BASE_BYTES. */
    uint64_t base_bytes;
    st_render *render; /* makes the messages for listeners; NULL: the store has no listeners */
    /* `listeners` is the most listeners at the same time of all meshes, `mesh_listeners` those of
     * one mesh */
    size_t listeners;
    size_t mesh_listeners;
} st_store_options;

/* Makes a store that keeps its meshes in the journal of the options. Returns NULL if memory is out
 * or the journal cannot be read; the caller then still owns the journal. */
st_store *st_store_new(const st_store_options *options);
/* Frees the store. No handle of a mesh may be left. */
void st_store_free(st_store *store);
/* Returns two random words that the journal stores. They are the secret key with which names and
 * remembered requests are hashed, so that clients cannot choose values whose hashes collide. */
const uint64_t *st_secret(const st_store *store);
/* Returns the number of meshes of the store, in memory or not. */
uint64_t st_store_count(st_store *store);
/* Returns true if meshes are kept on a disk. Then a request for a mesh that is not in memory, for
 * the list of meshes, or for an unused id waits for the disk. */
bool st_store_waits_for_disk(const st_store *store);
/* Writes to `out` whether the store accepts changes. Does not wait. */
void st_store_health(const st_store *store, st_health *out);
/* Sizes of the store now, and counts since its start. */
typedef struct st_store_measures {
    /* `meshes` and `most_meshes` are the numbers of meshes, on the disk or in memory: now, and
     * allowed at most. */
    uint64_t meshes, most_meshes;
    uint64_t meshes_in_memory, vertices, edges, faces;
    uint64_t content_bytes, history_bytes, snapshot_bytes, event_bytes; /* bytes in memory */
    uint64_t revisions;                                                 /* revisions made */
    uint64_t evicted; /* number of meshes that were evicted: removed from memory to free it */
    uint64_t loads[ST_LOADED_COUNT]; /* loads, by their outcome */
    st_distribution load_time;       /* how many microseconds the loads that found a mesh took */
    /* `listeners` and `most_listeners` are the listeners of all meshes: now, and allowed at most */
    uint64_t listeners, most_listeners;
    uint64_t events; /* events made for listeners */
    /* how often a listener fell behind and had to fetch the mesh again */
    uint64_t listeners_behind;
    /* microseconds from each change until a listener got the message about it */
    st_distribution event_lag;
    /* measurements of the journal; zeros if the journal stores nothing */
    st_journal_measures journal;
} st_store_measures;

/* Measures the store. Takes the lock of the table of meshes and that of the journal for a moment;
 * does not wait for the disk. */
void st_store_measure(st_store *store, st_store_measures *out);
/* Sets the store that the calling thread works for. If memory for an allocation of this thread is
 * short, unused meshes of that store are evicted before the allocation is refused. A NULL store
 * means that the thread works for no store. */
void st_store_serve(const st_store *store);
/* Frees the copies of meshes that no thread is reading and that were last used before `before`
 * (st_clock_micros); copies of earlier revisions are kept ten seconds longer. The caller must hold
 * no lock. */
void st_store_expire_copies(st_store *store, uint64_t before);
/* Must be called about once a second. Frees copies of meshes that nobody has used for a second; a
 * copy takes as much memory as its mesh, and pages and exports that follow each other share it.
 * While less than an eighth of the memory budget is free, this
 * function evicts meshes (removes them from memory) that were not used for a minute, the least
 * recently used first. */
void st_store_rest(st_store *store);
/* Returns true if memory is short (st_memory_is_short) although every mesh was evicted that can be
 * evicted. Takes the locks that st_store_rest takes, and waits up to a quarter of a second if
 * meshes can be evicted once their changes are on the disk. */
bool st_store_is_full(st_store *store);
/* Frees caches: copies of meshes and bodies of remembered answers, except those that a thread is
 * reading, and objects derived from meshes. The caller must hold no lock. */
void st_store_shed(st_store *store);

/* --- holders of meshes --- (holder/holders.h) */

/* Sets how many meshes and bytes each holder in the array `limits` may have; all other holders are
 * unlimited. Existing meshes stay; a change beyond a limit is refused with ST_QUOTA.
 * Returns ST_NO_MEMORY if memory is out; the limits are then as they were. */
st_status st_limit_holders(st_store *store, const st_holder_limit *limits, size_t count);
/* Writes to `out` how many meshes and bytes the holder has, in memory or not, and its limits; zeros
 * for an unknown holder. */
void st_holder_usage(st_store *store, const char *name, st_usage *out);
/* Returns the name of the mesh's holder, "" if it has none. The text is valid as long as the
 * mesh. */
const char *st_holder_of(const st_mesh *mesh);

/* Returns the set of answers that wait until the changes they show are durable. */
st_waits *st_store_waits(st_store *store);
/* Returns the records that an answer about one mesh shows; `info` is the mesh's description from
 * which the answer is made. */
st_shown st_shown_of(const st_mesh_info *info);
/* Returns the records that are shown by an answer that may show any mesh, or that says that a mesh
 * does not exist. `since` is the durable position (st_waits_durable) when the answer was begun. */
st_shown st_shown_all(st_store *store, uint64_t since);

/* --- the collection --- */

/* Finds a mesh by its id and adds a reference to it. Does not wait.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_COLD if no such mesh is in memory; only st_load finds out whether it exists. */
st_status st_find(st_store *store, const char *id, st_mesh **out);
/* Finds a mesh like st_find, and loads a mesh that is not in memory, once for all threads that
 * request it. The function waits, so only threads that may wait can call it, and without holding a
 * lock. A mesh that is damaged, or that a newer release has written, is found, too, and
 * `unreadable` in its st_mesh_info is set: such a mesh has no content, and can only be removed or
 * replaced (st_create_over).
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_LOADING if another thread has been loading the mesh for too long.
 * Returns ST_NO_MEMORY, ST_BUDGET or ST_FAILED if it cannot be loaded. */
st_status st_load(st_store *store, const char *id, st_mesh **out);
/* Returns ST_DAMAGED or ST_NEWER if the mesh has no content, else ST_OK. The next function,
 * st_damage, returns a sentence that says why the mesh has no content, or "" if it has. The
 * sentence stays valid as long as the mesh. */
st_status st_unreadable(const st_mesh *mesh);
const char *st_damage(const st_mesh *mesh);
/* Reads as much of a mesh as is intact, without putting it into the store, whose journal must be
 * one that only reads. *out is the mesh at the last revision that can be read. `damage` says what
 * prevents reading later revisions; "" if nothing does.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_DAMAGED or ST_NEWER with `damage` if no revision can be read.
 * Returns ST_FAILED, ST_NO_MEMORY or ST_BUDGET if it cannot be loaded. */
st_status st_salvage(st_store *store, const char *id, st_mesh **out, char damage[ST_DAMAGE]);
st_mesh *st_hold(st_mesh *mesh); /* adds a reference to the mesh and returns `mesh` */
void st_release(st_mesh *mesh);  /* releases a reference; takes NULL */
/* Creates a mesh, which owns `content` on success. If `id` is NULL the store chooses one. `cause`,
 * which may be NULL, is stored in the first record. A worker must not call it if
 * st_store_waits_for_disk returns true.
 * Returns ST_TAKEN if a mesh has the id.
 * Returns ST_TOO_MANY if the store is full.
 * Returns ST_QUOTA if the holder (owner) would have more meshes or bytes than it may.
 * Returns ST_LOADING if another thread's lookup of the id takes too long.
 * Returns ST_BUDGET, ST_NO_MEMORY, ST_BEHIND, ST_FULL or ST_FAILED if the mesh cannot be stored. */
st_status st_create(st_store *store, const char *id, const char *name, he_mesh *content,
                    const st_cause *cause, st_mesh **out);
/* What the store needs to know about a new mesh beside its content. */
typedef struct st_new_mesh {
    const char *id; /* NULL: the store chooses one */
    const char *name;
    /* `cause` is the reason for creating the mesh, stored in its first record; may be NULL */
    const st_cause *cause;
    /* `from` are the records of other meshes that the content was made from; NULL: there are
     * none */
    const st_shown *from;
} st_new_mesh;

/* Creates a mesh like st_create, from a content that may have been made from other meshes. If a
 * record named by `made->from` is lost, so is the new mesh.
 * Returns ST_LOST if these records are lost already. */
st_status st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content, st_mesh **out);
/* Replaces a damaged mesh by a new mesh with its id: the removal and the creation happen both or
 * not at all.
 * Returns ST_ABSENT if the damaged mesh was removed before. */
st_status st_create_over(st_store *store, st_mesh *damaged, const char *name, he_mesh *content,
                         const st_cause *cause, st_mesh **out);
/* Writes large mesh data to the disk before it replaces the data of a mesh (st_write_replace), so
 * that st_write_commit need not write it while it holds the mesh's lock. The function waits for the
 * disk, so the caller must be a thread that may wait, and must hold no lock. *out is NULL if the
 * data is small or the journal stores nothing.
 * Returns ST_NO_MEMORY, ST_BEHIND, ST_FULL or ST_FAILED if the data cannot be written. */
st_status st_store_stage(const st_store *store, const he_mesh *content, st_stage **out);
void st_store_unstage(const st_store *store,
                      /* frees a stage (mesh data that was written in advance) that no write has
                       * used; `stage` may be NULL */
                      st_stage *stage);
/* Returns true if an encoded edit of `bytes` bytes is too large for the body of a record. The edit
 * should then claim its mesh: only the commit of a claim can write the encoded edit to the disk in
 * advance, any other commit encodes it while it holds the lock. */
bool st_store_stages(const st_store *store, uint64_t bytes);
/* Lists up to `limit` meshes that are in memory, in the order of ids, beginning after the id
 * `after` ("" for the start). Adds a reference to each of these meshes. */
size_t st_list(st_store *store, const char *after, st_mesh **out, size_t limit);
/* Lists the cards of up to `limit` meshes, in memory or not, in the order of ids, beginning after
 * the id `after`, without loading a mesh. A worker must not call this function if
 * st_store_waits_for_disk returns true.
 * Returns ST_NO_MEMORY or ST_FAILED if the cards cannot be read. */
st_status st_cards(st_store *store, const char *after, st_card *out, size_t limit, size_t *count);
/* Lists the cards of meshes, in memory or not, in the order of `page`, without loading a mesh and
 * without locking one. The cards are those of one moment, in which each mesh is listed once. A
 * change that is not durable yet is not seen, so its answer is not sent yet either. A worker must
 * not call this function if st_store_waits_for_disk returns true.
 * Returns ST_NO_MEMORY or ST_FAILED if the cards cannot be read. */
st_status st_cards_by(st_store *store, const st_card_page *page, st_card *out, size_t *count);

/* --- a mesh that is not in memory, without loading it --- */

/* A mesh that is not in memory, described by its card (id, name, revision, counts), which suffices
 * for entity tags and preconditions. Whether the content can be read is not known. From
 * st_cold_begin to st_cold_end the caller owns the lookup of the id: no thread loads the mesh, and
 * its description does not change. */
typedef struct st_cold {
    st_store *store;
    struct st_lookup *lookup;
    st_card card;
    /* description of the mesh from its card; after st_cold_remove, that of the removed mesh */
    st_mesh_info info;
} st_cold;

/* Reads the card of a mesh that is not in memory. If the mesh has come into memory meanwhile, *mesh
 * is that mesh with a reference, and st_cold_end must not be called. The function waits for the
 * disk, so only threads that may wait can call it, without a lock.
 * Returns ST_ABSENT if there is no such mesh.
 * Returns ST_DAMAGED if the card is damaged; st_load then returns a mesh without content, which can
 * be removed.
 * Returns ST_LOADING, ST_NO_MEMORY or ST_FAILED if the card cannot be read. */
st_status st_cold_begin(st_store *store, const char *id, st_mesh **mesh, st_cold *out);
/* Removes the mesh that st_cold_begin has found; may be called once. Does not wait.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if the journal refuses. */
st_status st_cold_remove(st_cold *cold);
void st_cold_end(st_cold *cold);

/* --- reading --- */

/* Takes the shared lock of a mesh and returns its content, which is never NULL. Copies the mesh's
 * description to `info`, which may be NULL. */
const he_mesh *st_read_begin(st_mesh *mesh, st_mesh_info *info);
void st_read_end(st_mesh *mesh);
/* Copies the mesh's description to `info`; holds the shared lock only for that. Returns how many
 * ids of vertices, half-edges and faces the mesh has ever issued. */
uint64_t st_read_card(st_mesh *mesh, st_mesh_info *info);
/* Returns how many ids of vertices, half-edges and faces the mesh had issued at a revision; if the
 * history in memory does not have this revision, how many it has issued now. */
uint64_t st_elements_at(st_mesh *mesh, uint64_t revision);
/* Makes an immutable copy of the present revision, shared by all callers that ask for this
 * revision. The function may copy the mesh, so a worker must not call it for large meshes.
 * Returns ST_NO_MEMORY or ST_BUDGET if there is no room for the copy. */
st_status st_snapshot_take(st_mesh *mesh, st_snapshot **out);
/* Makes a copy of an earlier revision. The function may replay the history, so a worker must not
 * call it. In the description that st_snapshot_content returns, only `revision` and `modified` are
 * those of the copy; all else (name, counts of undo and redo, ...) is that of the present mesh.
 * Returns ST_AHEAD if there is no such revision yet.
 * Returns ST_GONE if neither the history nor the records on the disk reach back to it.
 * Returns ST_NO_MEMORY, ST_BUDGET or ST_FAILED if the copy cannot be made. */
st_status st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out);
/* Makes a copy like st_snapshot_take, for a caller that holds the shared lock of the mesh. */
st_status st_snapshot_held(st_mesh *mesh, st_snapshot **out);
const he_mesh *st_snapshot_content(const st_snapshot *snapshot, st_mesh_info *info);
void st_snapshot_release(st_snapshot *snapshot); /* takes NULL */
/* st_cache_put keeps a value that was derived from the present revision, such as its summary, until
 * the revision changes, and replaces the value kept before. st_cache_get copies the kept value, or
 * returns false if there is none. The caller holds the shared lock of the mesh. */
bool st_cache_get(st_mesh *mesh, void *value, size_t size);
void st_cache_put(st_mesh *mesh, const void *value, size_t size);
/* Keeps a derived value like st_cache_put, for a caller that holds no lock. `of` describes the
 * mesh, at the revision from which the value was made; if the mesh has changed since then, the
 * value is not kept. */
void st_cache_put_of(st_mesh *mesh, const st_mesh_info *of, const void *value, size_t size);

/* Objects that handlers derive from a mesh and that the store keeps with it, one of each kind. */
typedef enum st_derived_kind {
    /* The arrays with which GET .../geometry is answered, updated as the mesh changes. */
    ST_DERIVED_SLOTS,
    /* The tree of boxes (BVH) by which rays and nearest points are found, made for one revision:
     * see api/ask/bvh_cache.h. */
    ST_DERIVED_BVH,
    /* The system of equations of a deformation: see api/write/deformer_cache.h. */
    ST_DERIVED_DEFORMER,
    ST_DERIVED_COUNT
} st_derived_kind;

/* The most milliseconds that st_derived_wait waits, so that its caller can check whether the
 * request was cancelled. */
enum { ST_DERIVED_MILLIS = 50 };

typedef struct st_derived {
    void *value; /* the derived object; NULL: no object is kept */
    void (*destroy)(void *value);
} st_derived;

/* Locks the slot that keeps an object derived from a mesh, until st_derived_end. A thread that also
 * takes the mesh's shared lock must take that lock first. A thread may lock only one slot at a
 * time, and never for longer than a worker may take for a request. The store destroys the object
 * when memory is short, and with the mesh. */
st_derived *st_derived_begin(st_mesh *mesh, st_derived_kind kind);
void st_derived_end(st_mesh *mesh, st_derived_kind kind);
/* Unlocks the slot (st_derived_begin) until another thread has ended its use of the slot, or for
 * ST_DERIVED_MILLIS, then locks the slot again. A worker must not call this function, nor a thread
 * with a lock that another user of the slot may need. */
void st_derived_wait(st_mesh *mesh, st_derived_kind kind);
/* Returns the delta (recorded changes) that led to a revision, which may have been applied forwards
 * or backwards (undone); NULL if the delta is not kept. The caller holds the shared lock of the
 * mesh. */
const he_delta *st_revision_delta(st_mesh *mesh, uint64_t revision);

/* --- keyed requests --- (idempotency.h) */

typedef struct st_key {
    const char *text;
    uint64_t digest[2]; /* hash of the request, made with the secret key that st_secret returns */
    /* `holder` is the client that sent the key; "" or NULL: clients without a name */
    const char *holder;
} st_key;

typedef enum st_keyed_status {
    ST_KEYED_NEW,   /* the key was not seen before: the request is executed */
    ST_KEYED_KEPT,  /* the request was answered before */
    ST_KEYED_BUSY,  /* an equal request with the key is being executed now */
    ST_KEYED_OTHER, /* a different request has already used the key */
    /* A request with the key was executed, but the stored data that says which request it was is
     * damaged. */
    ST_KEYED_DAMAGED,
    ST_KEYED_NO_MEMORY
} st_keyed_status;

enum { ST_KEPT_TAG = 96 };

/* The answer to a keyed request. */
typedef struct st_kept {
    int status;
    /* True if the request changed something; the answer is then kept even if there is no memory for
     * its body. */
    bool changed;
    char etag[ST_KEPT_TAG]; /* ETag of the answer; "": the answer had none */
    /* Id of the mesh that the answer shows; if the status is 201, the header Location names this
     * mesh. */
    char id[ST_MESH_ID + 1];
    uint64_t incarnation, position;
    /* The state of the mesh from which the answer's ETag can be made again, if the ETag itself is
     * not kept because the answer was given before the last start of the server; else 0. */
    uint64_t revision, metadata;
    /* `body` is the body of the answer; if NULL although `length` is not 0, the body was not kept
     */
    const char *body;
    size_t length;
    const char *media; /* media type of the body; a text that is never freed */
} st_kept;

/* Begins a request with an Idempotency-Key, before the request is executed; the caller holds no
 * lock. If `mesh` is NULL, the key belongs to the store. If it returns ST_KEYED_NEW, all memory for
 * the answer is allocated, so that st_keyed_keep cannot fail. If it returns ST_KEYED_KEPT,
 * st_keyed_answer gives the answer. In both cases st_keyed_end ends the request, and forgets the
 * key unless the answer was kept. Keys of a mesh are deleted with the mesh; every key is deleted
 * after a day, or earlier if newer keys need the memory. */
st_keyed_status st_keyed_begin(st_store *store, st_mesh *mesh, const st_key *key, st_keyed **out);
const st_kept *st_keyed_answer(const st_keyed *keyed);
void st_keyed_keep(st_keyed *keyed, const st_kept *answer);
void st_keyed_end(st_keyed *keyed);

/* Writes a note to the journal, so that the key of a request that changed nothing survives a
 * restart; the key of a change is in the records of that change. The function must be called before
 * st_keyed_keep; `info` describes the mesh that the answer shows. *position is the position of the
 * note, which must be durable before the answer is sent; 0: there is no note. If the journal
 * refuses, the answer is kept in memory only. */
void st_keyed_note(st_store *store, const st_keyed *keyed, const st_mesh_info *info,
                   uint64_t *position);

/* --- jobs --- (api/job/job_table.h runs them) */

/* Stores the state of a job (st_job_keep) or removes it (st_job_forget), by a note in the journal;
 * *position is the position of the note, 0 if the journal stores nothing.
 * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY if the journal refuses. */
st_status st_job_keep(st_store *store, const st_job *job, uint64_t *position);
st_status st_job_forget(st_store *store, const char *id, uint64_t *position);
/* Passes each job that the journal has stored to `take`. This function is called when the daemon
 * starts.
 * Returns ST_NO_MEMORY or ST_FAILED if the jobs cannot be read. */
st_status st_jobs_kept(st_store *store, st_take_job *take, void *context);

/* --- the history of a mesh; the caller holds the mesh's shared lock --- */

enum { ST_ENTRY_OPS = 256 };

typedef struct st_entry {
    uint64_t revision;
    uint64_t inverts; /* the revision that this revision undid or redid; 0 for an edit */
    /* The newest edit that was not undone at this revision: the mesh has equal contents at
     * revisions of equal state. */
    uint64_t state;
    st_action action;
    /* Names of the operations, joined by ','; a long list is cut and ends with "...". */
    char ops[ST_ENTRY_OPS];
    char name[ST_MOMENT_NAME + 1]; /* the name of the revision, UTF-8; "": it has none */
    bool undoable;
    size_t bytes;
    double time;
    st_tally tally;
} st_entry;

typedef struct st_history {
    /* The oldest revision whose content can be read, from memory or the disk. */
    uint64_t oldest;
    uint64_t dropped; /* number of entries dropped to keep the history within its budget */
    /* bytes: how many bytes entries and deltas take now; budget: how many they may take */
    uint64_t bytes, budget;
} st_history;

/* Copies the entry of the i-th newest revision of a mesh. Returns false if the history has fewer
 * revisions. */
bool st_history_entry(st_mesh *mesh, size_t i, st_entry *out);
void st_history_reach(st_mesh *mesh, st_history *out);

#endif
