/* journal.h - where changes are made durable.
 *
 * The store hands each change of a mesh to the journal in order, under the mesh's write lock, and
 * goes on: writers build on the head. Changes are revisions, renames and the removal. A record is
 * numbered twice: by its mesh, from 1 without a gap, and by the journal, which gives it a position
 * in the order of all records of the store, from 1. The removal of a mesh comes before the first
 * record of another one of its id.
 *
 * An answer that shows a record is held back until the journal says that all records up to its
 * position are durable (D1: no answer shows a change that a crash could lose). A journal may be far
 * behind; whenever it gets further it calls its listener. */
#ifndef HE_JOURNAL_JOURNAL_H
#define HE_JOURNAL_JOURNAL_H

#include "mesh/delta.h"
#include "mesh/mesh.h"

#include <stdbool.h>

enum { ST_MESH_ID = 64, ST_MESH_NAME = 256, ST_JOB_ID = 22 };

/* How a call of the store or the journal went. */
typedef enum st_status {
    ST_OK,
    ST_ABSENT,
    ST_TAKEN, /* the id is in use */
    ST_NO_MEMORY,
    ST_BUDGET,    /* the configured memory budget */
    ST_TOO_MANY,  /* meshes, or jobs */
    ST_NOTHING,   /* to undo or redo */
    ST_LISTENERS, /* as many listen as may */
    ST_AHEAD,     /* no such revision yet */
    ST_GONE,      /* the revision is no longer in the history */
    ST_ELSEWHERE, /* the stack does not lead to the revision */
    ST_BUSY       /* a long edit has claimed the mesh */
} st_status;

/* What a revision did; kept in the log. */
typedef enum st_action { ST_EDIT, ST_UNDO, ST_REDO, ST_REPLACE } st_action;

/* How many elements a revision created, deleted and modified: vertices, edges, faces. */
typedef struct st_tally {
    bool known;
    uint32_t created[3], deleted[3], modified[3];
} st_tally;

/* A request with an Idempotency-Key, from st_keyed_begin to st_keyed_end. */
typedef struct st_keyed st_keyed;

/* A change as it is published. Everything is borrowed for the call. */
typedef struct st_record {
    const char *id;
    uint64_t incarnation;
    uint64_t number;   /* of the record, from 1 for each incarnation */
    uint64_t revision; /* the first of a mesh is 1; a rename and the removal repeat the last */
    const char *name;
    st_action action;          /* ST_REPLACE: `content` holds it all */
    const he_delta *delta;     /* NULL with ST_REPLACE and for a rename */
    bool undone;               /* the delta was applied backwards */
    const he_changes *changes; /* what the delta comes to; NULL: that was not found */
    bool removed;              /* the mesh was deleted; nothing follows */
    const he_mesh *content;    /* the mesh after the group of records, NULL when removed */
    /* The keyed request that made the change, NULL without a key: its key, digest, time, and
     * whether the key is the store's. The answer is written after the change is published; a
     * journal that brings a key back answers what is kept without a body, 201 or 204, with the
     * revision's tag. The digest is good with the secret of the store only, which is to be kept
     * beside it. */
    const st_keyed *keyed;
} st_record;

/* Records that will never be durable: those of one mesh, or of all, within an interval of
 * positions. What is lost of a mesh are its last records: those it appends later are lost too. */
typedef struct st_loss {
    uint64_t incarnation; /* of the mesh; 0: of all meshes */
    uint64_t from, to;    /* both are lost */
    const char *reason;   /* a literal, such as "the disk refused a write" */
} st_loss;

/* Called from any thread, without a lock that `append` takes. */
typedef struct st_journal_listener {
    void *context;
    /* Every record up to `position`, which never falls, is durable or was told as lost before. */
    void (*moved)(void *context, uint64_t position);
    void (*lost)(void *context, const st_loss *loss);
} st_journal_listener;

typedef struct st_journal {
    void *self;
    /* Takes a group of records of one mesh, at least one, which become durable together or not at
     * all. They get positions without a gap; returns the last one's. Neither fails nor waits. */
    uint64_t (*append)(void *self, const st_record *records, size_t count);
    /* Sets the one listener, and tells it how far the journal is if that is beyond 0. NULL stops;
     * once it returned, no call is under way. */
    void (*listen)(void *self, const st_journal_listener *listener);
    void (*close)(void *self);
} st_journal;

/* Keeps nothing: a revision is as durable as it will ever be the moment it is made. */
st_journal st_journal_memory(void);

#endif
