/* journal.h - where changes are made durable.
 *
 * The store hands each change of a mesh to the journal in order, under the mesh's write lock, and
 * goes on: writers build on the head. Changes are revisions, renames and the removal, numbered
 * together without a gap. What shows a change is held back until the journal says it is durable
 * (D1: no answer shows a change that a crash could lose). The removal of a mesh comes before the
 * first record of another one of its id. A journal may be far behind,
 * and says so each time it gets further by calling the listener, from any thread and without
 * holding a lock that `append` or `durable` take. */
#ifndef HE_SERVER_STORE_JOURNAL_H
#define HE_SERVER_STORE_JOURNAL_H

#include "api/store.h"

/* A change as it is published. Everything is borrowed for the call. */
typedef struct srv_record {
    const char *id;
    uint64_t incarnation;
    uint64_t number;   /* of the record, from 1 for each incarnation */
    uint64_t revision; /* the first of a mesh is 1; a rename and the removal repeat the last */
    const char *name;
    api_action action;      /* API_REPLACE: `content` holds it all */
    const he_delta *delta;  /* NULL with API_REPLACE and for a rename */
    bool undone;            /* the delta was applied backwards */
    bool removed;           /* the mesh was deleted; nothing follows */
    const he_mesh *content; /* the mesh after it, NULL when removed */
    /* Of the Idempotency-Key it was made for, NULL without one: key, digest, time, and whether the
     * key is the store's. The answer is written after the change is published; a journal that
     * brings a key back answers what is kept without a body, 201 or 204, with the revision's tag.
     * Its digest is good with the secret of api_store only, which is to be kept beside it. */
    const api_claim *claim;
} srv_record;

typedef struct srv_journal {
    void *self;
    /* Takes note of a change. Neither fails nor waits. */
    void (*append)(void *self, const srv_record *record);
    /* The number of the last durable record of a mesh; UINT64_MAX when every one is. */
    uint64_t (*durable)(void *self, const char *id, uint64_t incarnation);
    /* Call `notify` whenever a mesh became durable further. NULL stops; once it returned, no call
     * is under way. */
    void (*listen)(void *self, void (*notify)(void *context), void *context);
    void (*close)(void *self);
} srv_journal;

/* Keeps nothing: a revision is as durable as it will ever be the moment it is made. */
srv_journal srv_journal_memory(void);

#endif
