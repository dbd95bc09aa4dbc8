/* store.h - the meshes a daemon holds: by id, locked, revised, and durable. They are changed by
 * what write.h declares.
 *
 * A handle is a counted reference to a stored mesh; it stays valid after the mesh was removed from
 * the store, reading `removed` true, and is given back by st_release. A mesh is freed with its last
 * handle, so a removed mesh is still there for those who were reading it.
 *
 * When the journal loses changes, each mesh whose newest one is among them leaves the store,
 * reading `lost` true: no write gets to it, its listeners are sent away, and what was read of it is
 * never sent. Who asks for its id finds the mesh anew, as it was before.
 *
 * Locks are held for as long as it takes to compute, never while a client is waited for. They are
 * taken in this order:
 *     past      the mesh's cached copy of an earlier revision; not on a worker
 *     mesh      one mesh, shared by readers or held by one writer; writers come first
 *     room      by the one thread that frees memory for others
 *     lookups   ids that are being looked for on the disk (lookup.h)
 *     table     the collection, for as long as a search takes
 *     snapshot  the mesh's cached copy
 *     cache     the mesh's cached value
 *     keys      answers kept for keyed requests, of a mesh or of the store
 *     derived   what a handler derived from it
 *     queue     messages for those who listen to it (broadcast_queue.h)
 *     waits     answers that wait until they are durable (durability_wait.h)
 *     holders   how much each holder of meshes has (holder/holders.h)
 * The table of jobs (api/job/job_table.h) has a lock that is taken after a mesh's, and connections
 * that wait for events (server/http/http_live.h) one that is taken after all others. A thread that
 * holds a mesh's lock takes no other mesh's, not even shared, and not the same one twice: a waiting
 * writer would stop both. To bring another mesh's content in, take its snapshot first. */
#ifndef HE_STORE_STORE_H
#define HE_STORE_STORE_H

#include "mesh/delta.h"
#include "store/durability_wait.h"
#include "store/holder/holders.h"
#include "store/store_counts.h"
#include "system/thread_pool.h"

typedef struct st_store st_store;
typedef struct st_mesh st_mesh;         /* a stored mesh */
typedef struct st_snapshot st_snapshot; /* an immutable copy at one revision */
typedef struct st_keyed st_keyed;       /* a request with an Idempotency-Key, begun and not ended */

/* What a change is made for: its records carry it. A NULL pointer to one stands for nothing. */
typedef struct st_cause {
    const st_keyed *keyed; /* a request with a key; NULL: none */
    const char *job;       /* the job whose work it is; NULL: none */
    const char *holder; /* whose a mesh is that it makes (holder/holders.h); "" or NULL: nobody's */
} st_cause;

/* Plain facts about a stored mesh, copied out under its lock. */
typedef struct st_mesh_info {
    char id[ST_MESH_ID + 1];
    char name[ST_MESH_NAME + 1]; /* UTF-8, may be empty */
    uint64_t incarnation;        /* random, new for each create of an id */
    uint64_t metadata;           /* counts changes of name and metadata, from 1 */
    uint64_t revision;           /* of the content, from 1 */
    uint64_t record;             /* counts every change: revisions, metadata, the removal */
    uint64_t position;           /* of the last of them in the order of all records */
    double created, modified;    /* seconds since 1970 UTC */
    uint32_t undo, redo;         /* steps on the stacks */
    bool removed;
    bool lost;               /* it stands on a change that will never be durable: the store has it
                                no more */
    st_status unreadable;    /* ST_OK, or ST_DAMAGED or ST_NEWER: it has no content, st_load */
    bool busy;               /* a long edit has claimed it: write.h */
    char job[ST_JOB_ID + 1]; /* the job whose edit that is, "" when it is none */
} st_mesh_info;

/* A revision, a rename or the removal, as it is told to those who listen. */
typedef struct st_change {
    st_action action;          /* ST_REPLACE: the whole content */
    const he_delta *delta;     /* NULL with ST_REPLACE and for a rename */
    bool undone;               /* the delta was applied backwards */
    const he_changes *changes; /* what the delta comes to; NULL: that was not found */
    const he_mesh *content;    /* after the change */
    bool removed;              /* the mesh was deleted; nothing follows */
} st_change;

/* Writes a change as a message for those who listen to the mesh. `bytes` is allocated by base/mem.h
 * and the caller's to free. False when memory is out. Called under the mesh's write lock. */
typedef bool st_render(const st_mesh_info *info, const st_change *change, char **bytes,
                       size_t *length);

typedef struct st_store_options {
    uint64_t undo_budget; /* bytes a mesh */
    uint64_t max_meshes;
    st_journal journal;  /* closed with the store */
    st_pool *pool;       /* for bases of meshes whose records are many (rebase.c); NULL: none */
    uint64_t base_bytes; /* that those take; 0: ST_BASE_BYTES */
    st_render *render;   /* NULL: nobody will listen */
    size_t listeners;    /* at once, and of one mesh */
    size_t mesh_listeners;
} st_store_options;

/* NULL when memory is out, or the journal cannot be read; the journal is the caller's then. */
st_store *st_store_new(const st_store_options *options);
/* Nobody may hold a handle. */
void st_store_free(st_store *store);
/* The journal's two random words. What is hashed with them cannot be foreseen from outside: names
 * in tables, requests that are remembered. */
const uint64_t *st_secret(const st_store *store);
/* Meshes there are, in memory or not. */
uint64_t st_store_count(st_store *store);
/* Are meshes kept on a disk? Then a request for a mesh that is not in memory, for the list, or for
 * a free id waits for it. */
bool st_store_waits_for_disk(const st_store *store);
/* Are changes taken? Does not wait. */
void st_store_health(const st_store *store, st_health *out);
/* What there is, and what happened since the start. */
typedef struct st_store_measures {
    uint64_t meshes, most_meshes; /* on the disk or in memory */
    uint64_t meshes_in_memory, vertices, edges, faces;
    uint64_t content_bytes, history_bytes, snapshot_bytes, event_bytes; /* of memory */
    uint64_t revisions;                                                 /* that were made */
    uint64_t evicted;                   /* meshes that left memory to make room */
    uint64_t loads[ST_LOADED_COUNT];    /* by how they went */
    st_distribution load_time;          /* of those that found a mesh, microseconds */
    uint64_t listeners, most_listeners; /* to meshes */
    uint64_t events;                    /* that were made for listeners */
    uint64_t listeners_behind;          /* how often one was told to fetch anew */
    st_distribution event_lag;          /* from a change to its reaching a listener, microseconds */
    st_journal_measures journal;        /* zero where nothing is kept */
} st_store_measures;

/* Does not wait, but for the locks of the table and the journal, which are held for moments. */
void st_store_measure(st_store *store, st_store_measures *out);
/* From now on this thread works for a request: before it is refused memory, meshes that nobody uses
 * and the journal brings back leave. NULL: no more. */
void st_store_serve(const st_store *store);
/* To be called about once a second: while less than an eighth of the memory budget is free, meshes
 * leave that were not used for a minute, the least recently used first. */
void st_store_rest(st_store *store);
/* Frees the cached copies and bodies of kept answers that nobody reads, and what was derived from
 * meshes. Called without a lock. */
void st_store_shed(st_store *store);

/* --- whose meshes are --- (holder/holders.h) */

/* From now on these holders may have so many meshes and bytes, and all others any number. What
 * would be more is refused with ST_QUOTA; what is there stays. ST_NO_MEMORY, and all stays. */
st_status st_limit_holders(st_store *store, const st_holder_limit *limits, size_t count);
/* What a holder has, in memory or not, and may have; nothing where it was never heard of. */
void st_holder_usage(st_store *store, const char *name, st_usage *out);
/* Whose the mesh is; "": nobody's. As long as the mesh is. */
const char *st_holder_of(const st_mesh *mesh);

/* Where answers wait until what they show is durable. */
st_waits *st_store_waits(st_store *store);
/* What an answer shows that shows one mesh with these facts. */
st_shown st_shown_of(const st_mesh_info *info);
/* What an answer shows that was begun when all up to `since` was durable (st_waits_durable), and
 * may show any mesh, or that there is none. */
st_shown st_shown_all(st_store *store, uint64_t since);

/* --- the collection --- */

/* Adds a reference. Does not wait. ST_ABSENT; ST_COLD: it is not in memory, and st_load tells
 * whether there is such a mesh. */
st_status st_find(st_store *store, const char *id, st_mesh **out);
/* As st_find, but loads the mesh where it is not in memory, which is done once for all who ask for
 * it. Waits, on a thread that may and without a lock. A mesh that is damaged, or
 * that a newer release has written, is found, with info.unreadable: it has no content, can be
 * removed and replaced (st_create_over), and nothing else.
 * ST_ABSENT; ST_LOADING: another thread has been loading it for too long; ST_NO_MEMORY, ST_BUDGET,
 * ST_FAILED. */
st_status st_load(st_store *store, const char *id, st_mesh **out);
/* Why there is no content of a mesh, ST_DAMAGED or ST_NEWER, else ST_OK; and a sentence about that,
 * else "". Both are for as long as the mesh is. */
st_status st_unreadable(const st_mesh *mesh);
const char *st_damage(const st_mesh *mesh);
/* Reads a mesh as far as what is kept of it is whole, and does not put it into the store; the
 * journal is one that only reads. `damage` says what is wrong after the revision that the mesh is
 * at, "" where nothing is. ST_ABSENT; ST_DAMAGED, ST_NEWER, both with `damage`: nothing of it can
 * be read; ST_FAILED, ST_NO_MEMORY, ST_BUDGET. */
st_status st_salvage(st_store *store, const char *id, st_mesh **out, char damage[ST_DAMAGE]);
st_mesh *st_hold(st_mesh *mesh); /* adds a reference */
void st_release(st_mesh *mesh);  /* takes NULL */
/* Takes `content` on success. `id` NULL lets the store choose. `cause`, or NULL, goes into the
 * record of the new mesh. Not on a worker where st_store_waits_for_disk. ST_TAKEN, ST_TOO_MANY,
 * ST_QUOTA, ST_BUDGET, ST_NO_MEMORY, ST_LOADING, ST_BEHIND, ST_FULL, ST_FAILED. */
st_status st_create(st_store *store, const char *id, const char *name, he_mesh *content,
                    const st_cause *cause, st_mesh **out);
/* The same of a content that was made from what `from` shows, which is lost together: ST_LOST where
 * that is lost already. `from` may be NULL. */
st_status st_create_from(st_store *store, const char *id, const char *name, he_mesh *content,
                         const st_cause *cause, const st_shown *from, st_mesh **out);
/* Creates a mesh in the place of a damaged one of that id, which is removed: both happen or
 * neither. ST_ABSENT: it was removed before. */
st_status st_create_over(st_store *store, st_mesh *damaged, const char *name, he_mesh *content,
                         const st_cause *cause, st_mesh **out);
/* Before a large content takes the place of another (st_write_replace): brings it to the disk, so
 * that the write need not do that under its lock. Waits, on a thread that may, without a lock. *out
 * is NULL where there is nothing to be done. ST_NO_MEMORY, ST_BEHIND, ST_FULL, ST_FAILED. */
st_status st_store_stage(const st_store *store, const he_mesh *content, st_stage **out);
void st_store_unstage(const st_store *store, st_stage *stage); /* it was not taken; takes NULL */
/* Up to `limit` meshes that are in memory with ids after `after` ("" from the start), in the order
 * of ids, each with a reference. */
size_t st_list(st_store *store, const char *after, st_mesh **out, size_t limit);
/* The cards of all, likewise; none is loaded for it. Not on a worker where st_store_waits_for_disk.
 * ST_NO_MEMORY, ST_FAILED. */
st_status st_cards(st_store *store, const char *after, st_card *out, size_t limit, size_t *count);

/* --- a mesh that is not in memory, without loading it --- */

/* What its card says: the facts that entity tags and preconditions are made of. Whether the content
 * can be read is not known. From st_cold_begin to st_cold_end the id is the caller's: nobody loads
 * the mesh, and what the card says stays so. */
typedef struct st_cold {
    st_store *store;
    struct st_lookup *lookup;
    st_card card;
    st_mesh_info info; /* after st_cold_remove, of the mesh that was removed */
} st_cold;

/* Waits for the disk, on a thread that may, without a lock. Where the mesh is in memory by now,
 * *mesh is that, with a reference, and nothing was begun. ST_ABSENT; ST_DAMAGED, which only st_load
 * makes something of; ST_LOADING, ST_NO_MEMORY, ST_FAILED. */
st_status st_cold_begin(st_store *store, const char *id, st_mesh **mesh, st_cold *out);
/* Once. Does not wait. ST_BEHIND, ST_FULL, ST_FAILED, ST_NO_MEMORY. */
st_status st_cold_remove(st_cold *cold);
void st_cold_end(st_cold *cold);

/* --- reading --- */

/* Takes the shared lock; the content is never NULL. `info` may be NULL. */
const he_mesh *st_read_begin(st_mesh *mesh, st_mesh_info *info);
void st_read_end(st_mesh *mesh);
/* The facts of the mesh without its content; takes the shared lock for a moment. Returns how many
 * vertices, half-edges and faces were issued. */
uint64_t st_read_card(st_mesh *mesh, st_mesh_info *info);
/* An immutable copy of the present revision, shared with everybody who asks for the same one. May
 * copy the mesh: not on a worker thread for large ones. ST_NO_MEMORY, ST_BUDGET. */
st_status st_snapshot_take(st_mesh *mesh, st_snapshot **out);
/* A copy of an earlier revision. May replay the history: not on a worker thread. The info is that
 * of the present but for `revision` and `modified`. ST_AHEAD; ST_GONE when the history does not
 * reach back to it, nor do the records on the disk; ST_NO_MEMORY, ST_BUDGET, ST_FAILED. */
st_status st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out);
/* As st_snapshot_take, for a caller that holds the shared lock: at the revision that it sees. */
st_status st_snapshot_held(st_mesh *mesh, st_snapshot **out);
const he_mesh *st_snapshot_content(const st_snapshot *snapshot, st_mesh_info *info);
void st_snapshot_release(st_snapshot *snapshot); /* takes NULL */
/* A value derived from one revision, such as its summary, kept until the revision changes. get
 * copies it out and is false when there is none; put replaces it. Under the read lock. */
bool st_cache_get(st_mesh *mesh, void *value, size_t size);
void st_cache_put(st_mesh *mesh, const void *value, size_t size);
/* As st_cache_put, without a lock: keeps nothing where the mesh is no longer what `of` says. */
void st_cache_put_of(st_mesh *mesh, const st_mesh_info *of, const void *value, size_t size);

/* What handlers derive from a mesh and keep with it, one of each kind. */
typedef enum st_derived_kind {
    ST_DERIVED_SLOTS, /* of GET .../geometry, brought forward as the mesh changes */
    ST_DERIVED_TREE,  /* of rays and nearest points, of one revision: see api/ask/tree.h */
    ST_DERIVED_COUNT
} st_derived_kind;

/* The longest that st_derived_wait waits, so that its caller can look whether it was cancelled. */
enum { ST_DERIVED_MILLIS = 50 };

typedef struct st_derived {
    void *value; /* NULL: nothing is kept */
    void (*destroy)(void *value);
} st_derived;

/* The place of a derived object, for its holder alone until st_derived_end: taken after the read
 * lock or without it, one at a time, and never for longer than a worker may take. The store
 * destroys what is in it when memory is short, and with the mesh. */
st_derived *st_derived_begin(st_mesh *mesh, st_derived_kind kind);
void st_derived_end(st_mesh *mesh, st_derived_kind kind);
/* The holder gives the place to others until one of them ended, or for ST_DERIVED_MILLIS, then has
 * it again. Not on a worker, nor under a lock that another holder may want. */
void st_derived_wait(st_mesh *mesh, st_derived_kind kind);
/* What the revision changed, in either direction; NULL when that is not kept. Under the read
 * lock. */
const he_delta *st_revision_delta(st_mesh *mesh, uint64_t revision);

/* --- keyed requests --- (idempotency.h) */

typedef struct st_key {
    const char *text;
    uint64_t digest[2]; /* of the request, by st_secret */
    const char *holder; /* whose it is; "" or NULL for that of nobody in particular */
} st_key;

typedef enum st_keyed_status {
    ST_KEYED_NEW,     /* go on */
    ST_KEYED_KEPT,    /* it was answered before */
    ST_KEYED_BUSY,    /* the same request is under way */
    ST_KEYED_OTHER,   /* the key is that of another request */
    ST_KEYED_DAMAGED, /* a request with the key was done, but which one is not known any more */
    ST_KEYED_NO_MEMORY
} st_keyed_status;

enum { ST_KEPT_TAG = 96 };

/* The answer to a keyed request. */
typedef struct st_kept {
    int status;
    bool changed; /* something: then it is kept even where there is no room for its body */
    char etag[ST_KEPT_TAG];  /* "" for none */
    char id[ST_MESH_ID + 1]; /* of the mesh it shows, which Location names with 201 */
    uint64_t incarnation, position;
    /* The state that the answer's ETag names, where the answer came before the server started and
     * its tag is not kept. Else 0. */
    uint64_t revision, metadata;
    const char *body; /* JSON; NULL with a length: left out */
    size_t length;
} st_kept;

/* Called before a request is tried, without a lock; `mesh` NULL: the key is among those of the
 * store. With ST_KEYED_NEW all memory that remembering takes is there, so that st_keyed_keep cannot
 * fail, and with ST_KEYED_KEPT st_keyed_answer gives the answer. Both are ended by st_keyed_end,
 * which forgets the key again unless its answer was kept. Keys of a mesh go with the mesh, and all
 * after a day or when newer ones need the room. */
st_keyed_status st_keyed_begin(st_store *store, st_mesh *mesh, const st_key *key, st_keyed **out);
const st_kept *st_keyed_answer(const st_keyed *keyed);
void st_keyed_keep(st_keyed *keyed, const st_kept *answer);
void st_keyed_end(st_keyed *keyed);

/* Remembers a request that changed nothing beyond a restart, as its records do one that changed
 * something: before it is kept, with the mesh's facts that its answer shows. *position is what that
 * answer is to wait for, 0 for nothing. Where the journal refuses, memory alone has it. */
void st_keyed_note(st_store *store, const st_keyed *keyed, const st_mesh_info *info,
                   uint64_t *position);

/* --- jobs --- (api/job/job_table.h runs them) */

/* Keep how a job is; forget it. *position is that of the note, 0 where
 * nothing is kept. ST_BEHIND, ST_FULL, ST_FAILED, ST_NO_MEMORY. */
st_status st_job_keep(st_store *store, const st_job *job, uint64_t *position);
st_status st_job_forget(st_store *store, const char *id, uint64_t *position);
/* Gives the jobs that are kept, at the start. ST_NO_MEMORY, ST_FAILED. */
st_status st_jobs_kept(st_store *store, st_take_job *take, void *context);

/* --- the history, under the read lock --- */

enum { ST_ENTRY_OPS = 256 };

typedef struct st_entry {
    uint64_t revision;
    uint64_t inverts; /* revision it undid or did again, 0 for an edit */
    st_action action;
    char ops[ST_ENTRY_OPS]; /* names joined by ',', cut with "..." */
    bool undoable;
    size_t bytes;
    double time;
    st_tally tally;
} st_entry;

typedef struct st_history {
    uint64_t oldest;        /* revision that can be read, from memory or the disk */
    uint64_t dropped;       /* entries, to stay within the budget */
    uint64_t bytes, budget; /* that entries and deltas take, and may take */
} st_history;

/* The i-th newest entry; false past the end. */
bool st_history_entry(st_mesh *mesh, size_t i, st_entry *out);
void st_history_reach(st_mesh *mesh, st_history *out);

#endif
