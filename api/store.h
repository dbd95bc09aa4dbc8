/* store.h - what api needs from above: meshes by id, locked, revised, and durable.
 *
 * The server fills this struct in (server/store/store.c). A handle is a counted reference to a
 * stored mesh; it stays valid after the mesh was removed from the store, reading `removed` true.
 *
 * Locks are held for as long as it takes to compute, never while a client is waited for. */
#ifndef HE_API_STORE_H
#define HE_API_STORE_H

#include "api/live.h"
#include "mesh/delta.h"
#include "mesh/mesh.h"

#include <stdbool.h>

typedef struct api_mesh api_mesh;         /* a stored mesh; the server defines it */
typedef struct api_snapshot api_snapshot; /* an immutable copy at one revision; likewise */
struct api_entry;                         /* one line of the history, below */
struct api_history;

enum { API_MESH_ID = 64, API_MESH_NAME = 256, API_JOB_ID = 22 };

/* Plain facts about a stored mesh, copied out under its lock. */
typedef struct api_mesh_info {
    char id[API_MESH_ID + 1];
    char name[API_MESH_NAME + 1]; /* UTF-8, may be empty */
    uint64_t incarnation;         /* random, new for each create of an id */
    uint64_t metadata;            /* counts changes of name and metadata, from 1 */
    uint64_t revision;            /* of the content, from 1 */
    uint64_t record;              /* counts every change: revisions, metadata, the removal */
    double created, modified;     /* seconds since 1970 UTC */
    uint32_t undo, redo;          /* steps on the stacks */
    bool removed;
    bool busy;                /* claimed by a long edit, see `claim` */
    char job[API_JOB_ID + 1]; /* the job whose edit that is, "" when it is none */
} api_mesh_info;

/* What handlers derive from a mesh and keep with it, one of each kind. */
typedef enum api_derived_kind {
    API_DERIVED_SLOTS, /* of GET .../geometry, brought forward as the mesh changes */
    API_DERIVED_TREE,  /* of rays and nearest points, of one revision: see tree.h */
    API_DERIVED_COUNT
} api_derived_kind;

/* How long who waits for one goes without hearing whether he is to go on. */
enum { API_DERIVED_MILLIS = 100 };

typedef struct api_derived {
    void *value; /* NULL: nothing is kept */
    void (*destroy)(void *value);
} api_derived;

/* What a revision did; kept in the log. */
typedef enum api_action { API_EDIT, API_UNDO, API_REDO, API_REPLACE } api_action;

/* How many elements a revision created, deleted and modified: vertices, edges, faces. */
typedef struct api_tally {
    bool known;
    uint32_t created[3], deleted[3], modified[3];
} api_tally;

typedef enum api_store_status {
    API_STORE_OK,
    API_STORE_ABSENT,
    API_STORE_TAKEN, /* the id is in use */
    API_STORE_NO_MEMORY,
    API_STORE_BUDGET,    /* the configured memory budget */
    API_STORE_TOO_MANY,  /* meshes */
    API_STORE_NOTHING,   /* to undo or redo */
    API_STORE_LISTENERS, /* as many listen as may */
    API_STORE_AHEAD,     /* no such revision yet */
    API_STORE_GONE,      /* the revision is no longer in the history */
    API_STORE_ELSEWHERE, /* the stack does not lead to the revision */
    API_STORE_BUSY       /* the mesh is claimed already */
} api_store_status;

/* A request with an Idempotency-Key, from claim_key to claim_end. */
typedef struct api_claim api_claim;

typedef struct api_key {
    const char *text;
    uint64_t digest[2]; /* of the request, by api_store.secret */
} api_key;

typedef enum api_claim_status {
    API_CLAIM_NEW,   /* go on */
    API_CLAIM_KEPT,  /* it was answered before */
    API_CLAIM_BUSY,  /* the same request is under way */
    API_CLAIM_OTHER, /* the key is that of another request */
    API_CLAIM_NO_MEMORY
} api_claim_status;

enum { API_KEPT_TAG = 96 };

/* The answer to a keyed request. */
typedef struct api_kept {
    int status;
    bool changed; /* something: then it is kept even where there is no room for its body */
    char etag[API_KEPT_TAG];  /* "" for none */
    char id[API_MESH_ID + 1]; /* of the mesh it shows, which Location names with 201 */
    uint64_t incarnation, record;
    const char *body; /* JSON; NULL with a length: left out */
    size_t length;
} api_kept;

/* Where a listener wants to go on. */
typedef struct api_since {
    bool given;
    bool has_incarnation;
    uint64_t incarnation, revision;
} api_since;

typedef struct api_store {
    void *self;
    /* Random. What is hashed with it cannot be foreseen from outside: names in tables, requests
     * that are remembered. It is kept as long as those are. */
    uint64_t secret[2];

    /* --- the collection --- */
    api_store_status (*find)(void *self, const char *id, api_mesh **out); /* adds a reference */
    void (*release)(void *self, api_mesh *mesh);
    /* Takes `content` on success. `id` NULL lets the store choose. `claim` of a keyed request, or
     * NULL, goes into the record of it. */
    api_store_status (*create)(void *self, const char *id, const char *name, he_mesh *content,
                               const api_claim *claim, api_mesh **out);
    /* Under the write lock, so that what the caller looked at is what goes. */
    api_store_status (*remove)(void *self, api_mesh *mesh, api_mesh_info *info);
    /* Up to `limit` meshes with ids after `after` ("" from the start), in the order of ids, each
     * with a reference. */
    size_t (*list)(void *self, const char *after, api_mesh **out, size_t limit);

    /* --- reading --- shared lock; NULL content is never given. */
    const he_mesh *(*read_begin)(void *self, api_mesh *mesh, api_mesh_info *info);
    void (*read_end)(void *self, api_mesh *mesh);
    /* An immutable copy of the present revision, shared with everybody who asks for the same one.
     * May copy the mesh: not on a worker thread for large ones. */
    api_store_status (*snapshot)(void *self, api_mesh *mesh, api_snapshot **out);
    /* The same of an earlier revision: API_STORE_AHEAD, or API_STORE_GONE when the history does not
     * reach back to it. May replay the history: not on a worker thread. The info is that of now but
     * for `revision` and `modified`. */
    api_store_status (*snapshot_at)(void *self, api_mesh *mesh, uint64_t revision,
                                    api_snapshot **out);
    /* The same under the read lock: at the revision that its holder sees. */
    api_store_status (*snapshot_held)(void *self, api_mesh *mesh, api_snapshot **out);
    const he_mesh *(*snapshot_content)(const api_snapshot *snapshot, api_mesh_info *info);
    void (*snapshot_release)(void *self, api_snapshot *snapshot);
    /* A value derived from one revision, such as its summary: kept until the revision changes.
     * get copies it out and is false when there is none; put replaces it. Under the read lock. */
    bool (*cache_get)(void *self, api_mesh *mesh, void *value, size_t size);
    void (*cache_put)(void *self, api_mesh *mesh, const void *value, size_t size);

    /* The place of a derived object, for its holder alone until derived_end: taken after the read
     * lock or without it, one at a time, and never for longer than a worker may take. The store
     * destroys what is in it when memory is short, and with the mesh. */
    api_derived *(*derived_begin)(void *self, api_mesh *mesh, api_derived_kind kind);
    void (*derived_end)(void *self, api_mesh *mesh, api_derived_kind kind);
    /* From its holder: give the place to others until one of them ended, or for API_DERIVED_MILLIS,
     * then have it again. Not on a worker, nor under a lock that who is waited for may want. */
    void (*derived_wait)(void *self, api_mesh *mesh, api_derived_kind kind);
    /* What the revision changed, in either direction; NULL when that is not kept. Under the read
     * lock. */
    const he_delta *(*revision_delta)(void *self, api_mesh *mesh, uint64_t revision);
    uint64_t (*random)(void *self);

    /* --- writing --- exclusive lock with a recording delta attached, which is lent through
     * `delta` for he_changes_find. NULL when memory is out. Every begin is ended by exactly one of
     * write_commit, write_abort and write_end, which give the lock back. Where info->busy only
     * remove may be called, and write_end. */
    he_mesh *(*write_begin)(void *self, api_mesh *mesh, api_mesh_info *info, he_delta **delta);
    /* What follows, up to the end of writing, is done for this claim: its record carries it. */
    void (*write_keyed)(void *self, api_mesh *mesh, const api_claim *claim);
    /* Make what was recorded a revision with one undo step. `ops` names the operations for the
     * history. `barrier` ends the undo stack (compact). The new facts go to `info`. Cannot fail
     * once begin gave the lock: what it needs was reserved there. */
    void (*write_commit)(void *self, api_mesh *mesh, const char *ops, bool barrier,
                         api_mesh_info *info);
    void (*write_abort)(void *self, api_mesh *mesh); /* rolls back */
    /* For the history: what the change did that will be committed, or nothing is said there. */
    void (*tally)(void *self, api_mesh *mesh, const api_tally *tally);
    /* Could what was recorded so far be undone if it were committed? False when it is larger than
     * the undo budget: committing it ends the history. */
    bool (*undoable)(void *self, api_mesh *mesh);
    /* How many steps undo (redo) takes to the content of a revision, 0 when it is there, and the
     * bytes of all their deltas. `revision` 0: for that many `steps`, which is read. Under either
     * lock. API_STORE_NOTHING when the stack has fewer steps; AHEAD, GONE, ELSEWHERE. */
    api_store_status (*steps_to)(void *self, api_mesh *mesh, api_action which, uint64_t revision,
                                 uint32_t *steps, uint64_t *bytes);
    /* Take that many steps, at least one, back or forward, under the write lock: each applies an
     * inverse as a new revision. Their deltas are lent until write_end through `deltas`, which has
     * a place for each, in the order they were applied. API_STORE_NOTHING or API_STORE_NO_MEMORY,
     * and nothing has changed. */
    api_store_status (*step)(void *self, api_mesh *mesh, api_action which, uint32_t steps,
                             const he_delta **deltas, api_mesh_info *info);
    /* After step, replace, rename, remove or nothing. */
    void (*write_end)(void *self, api_mesh *mesh);
    /* PUT and PATCH, under the write lock. replace takes `content`. */
    void (*replace)(void *self, api_mesh *mesh, he_mesh *content, api_mesh_info *info);
    void (*rename)(void *self, api_mesh *mesh, const char *name, api_mesh_info *info);

    /* --- keyed requests ---
     * claim_key is called before a request is tried, without a lock; `mesh` NULL: the key is among
     * those of the store. With API_CLAIM_NEW all memory that remembering takes is there, so that
     * keep cannot fail, and with API_CLAIM_KEPT `kept` gives the answer. Both are ended by
     * claim_end, which forgets the key again unless its answer was kept. Keys of a mesh go with the
     * mesh, and all after a day or when newer ones need the room. */
    api_claim_status (*claim_key)(void *self, api_mesh *mesh, const api_key *key, api_claim **out);
    const api_kept *(*kept)(const api_claim *claim);
    void (*keep)(void *self, api_claim *claim, const api_kept *answer);
    void (*claim_end)(void *self, api_claim *claim);

    /* --- a long edit --- works without a lock on a copy of its own, which takes the place of the
     * content at once. Before that it claims the mesh: until the claim ends nobody else can write,
     * so that the content stands still and is lent, to be copied. `delta` is for all that is then
     * done to the copy. API_STORE_BUSY, API_STORE_ABSENT, API_STORE_NO_MEMORY. */
    api_store_status (*claim)(void *self, api_mesh *mesh, const he_mesh **content, he_delta **delta,
                              api_mesh_info *info);
    /* Ends the claim as write_commit does, with the copy as the content: it is taken. `keyed` is
     * the claim of a keyed request, or NULL. Or ends it with API_STORE_ABSENT, where the mesh was
     * removed meanwhile: it is not. */
    api_store_status (*publish)(void *self, api_mesh *mesh, he_mesh *takes, const char *ops,
                                bool barrier, const api_claim *keyed, api_mesh_info *info);
    /* Ends the claim with nothing done; what was recorded is forgotten. */
    void (*unclaim)(void *self, api_mesh *mesh);

    /* --- listening --- The changes of a mesh as messages of events.h, from after `since`, or from
     * the present revision, whose facts go to `info`. The caller frees the source. */
    api_store_status (*follow)(void *self, api_mesh *mesh, const api_since *since,
                               api_mesh_info *info, api_source *out);
    /* How many follow a mesh of the store. */
    size_t (*listeners)(void *self);

    /* --- the history, under the read lock: newest first; false past the end --- */
    bool (*history)(void *self, api_mesh *mesh, size_t i, struct api_entry *out);
    void (*history_facts)(void *self, api_mesh *mesh, struct api_history *out);
} api_store;

enum { API_ENTRY_OPS = 256 };

typedef struct api_entry {
    uint64_t revision;
    uint64_t inverts; /* revision it undid or did again, 0 for an edit */
    api_action action;
    char ops[API_ENTRY_OPS]; /* names joined by ',', cut with "..." */
    bool undoable;
    size_t bytes;
    double time;
    api_tally tally;
} api_entry;

typedef struct api_history {
    uint64_t oldest;        /* revision that can be read */
    uint64_t dropped;       /* entries, to stay within the budget */
    uint64_t bytes, budget; /* that entries and deltas take, and may take */
} api_history;

#endif
