/* record.h - the data that the store gives to the journal, and gets back.
 *
 * A RECORD is one change of one mesh: a revision, a rename or the removal. A CARD is a short
 * description of a mesh, without its content. A PIECE is one step of loading a mesh: first its
 * base, a whole content in parts, then the records after it in order. A NOTE is stored beside the
 * records: a job, or the key of a request that changed nothing.
 *
 * Bodies and contents are bytes as core/stored writes them; the journal never reads them. */
#ifndef HE_JOURNAL_RECORD_H
#define HE_JOURNAL_RECORD_H

#include "mesh/mesh.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    ST_MESH_ID = 64,
    ST_MESH_NAME = 256,
    ST_JOB_ID = 22,
    ST_DAMAGE = 160,
    ST_HOLDER = 64 /* most bytes of a holder's name */
};

/* What a revision did, as the history of a mesh shows it. */
typedef enum st_action { ST_EDIT, ST_UNDO, ST_REDO, ST_REPLACE } st_action;

/* How many elements a revision created, deleted and modified; each array has the numbers of
 * vertices, edges and faces. `known` is false if they were not counted. */
typedef struct st_tally {
    bool known;
    uint32_t created[3], deleted[3], modified[3];
} st_tally;

/* A large content, or a large encoded edit, that was written to the disk before it is published.
 * Each journal defines its own. */
typedef struct st_stage st_stage;

/* The kind of a record. The numbers are stored and never change their meaning. */
typedef enum st_record_kind {
    ST_RECORD_EDIT =
        /* The body is the encoded edit; if there is a stage, that is the encoded edit or the
         * content after the edit. */
    1,
    ST_RECORD_UNDO = 2, /* undoes the newest step of the undo stack; no body */
    ST_RECORD_REDO = 3, /* redoes the newest step of the redo stack; no body */
    /* Creation of the mesh or PUT: the body or the stage is the encoded content. */
    ST_RECORD_CONTENT = 4,
    ST_RECORD_RENAME = 5,
    ST_RECORD_REMOVE = 6
} st_record_kind;

/* The Idempotency-Key of the request that made a change. The answer does not exist yet when the
 * change is published, so a request whose key was read back from the journal is answered 201 or 204
 * without a body, with the tag of the record's revision. */
typedef struct st_record_key {
    const char *text;
    uint64_t digest[2]; /* hash of the request, keyed with the store's secret */
    double time;        /* when the request came, seconds since 1970 */
    bool of_store;      /* the key belongs to the store, because the change created the mesh */
    /* The client that sent the key: equal keys of different clients are different keys. "" or NULL
     * stands for clients without a name. */
    const char *holder;
} st_record_key;

/* How many seconds a key is kept, and how many keys of a mesh or of the store are kept: the oldest
 * are deleted first. */
enum { ST_KEPT_SECONDS = 24 * 3600, ST_KEPT_KEYS = 16384 };

/* A stored key, and the state that the answer to its request had. */
typedef struct st_kept_key {
    st_record_key key;
    const char *id; /* the mesh that the answer shows */
    uint64_t incarnation, revision, metadata;
    /* True if the stored row is damaged. Then only `text` and `holder` may be used, and even they
     * may be wrong. */
    bool is_damaged;
} st_kept_key;

/* The stored state of a job. The numbers are stored and never change their meaning. */
typedef enum st_job_state {
    ST_JOB_ACCEPTED =
        /* The job waits or runs; if it is found when the daemon starts, it never ended and changed
         * nothing. */
    1,
    ST_JOB_DONE = 2,
    ST_JOB_FAILED = 3,
    ST_JOB_CANCELLED = 4
} st_job_state;

enum { ST_JOB_TYPE, ST_JOB_DISPOSITION, ST_JOB_TAG, ST_JOB_WARNINGS, ST_JOB_HEADERS };
enum { ST_JOB_SECONDS = 3600 }; /* how long a job is kept after it has ended */

/* A job: a request that outlives its connection. Texts are never NULL, but may be "". */
typedef struct st_job {
    char id[ST_JOB_ID + 1];
    uint64_t number; /* counts the jobs in the order of submission, from 1 */
    st_job_state state;
    const char *operation, *phase, *mesh, *location;
    const char *holder;                  /* name of the access token that the job belongs to */
    double progress;                     /* 0 to 1 */
    double created, started, finished;   /* seconds since 1970 UTC; 0: not yet */
    int status;                          /* HTTP status of the job's answer; 0: there is none */
    bool shown;                          /* the job's representation contains the body */
    const char *headers[ST_JOB_HEADERS]; /* headers of the job's answer */
    const void *body;                    /* body of the job's answer; NULL: none is kept */
    size_t length;
} st_job;

/* Numbers of live elements and of boundary half-edges. */
typedef struct st_counts {
    uint32_t vertices, edges, faces, boundary;
} st_counts;

/* One change of a mesh. Texts and pointers are borrowed for the call. */
typedef struct st_record {
    st_record_kind kind;
    /* True if the history ends with this record: nothing before it can be undone, or read as a
     * revision. It is set for every ST_RECORD_CONTENT, and for an edit that renumbers elements or
     * is larger than the undo budget. */
    bool barrier;
    const char *id, *name; /* id of the mesh, and its name after the change */
    const char *holder;    /* holder of the mesh; "" or NULL: none */
    uint64_t incarnation;  /* random, new for each creation of a mesh with this id */
    uint64_t number;       /* counts the records of this incarnation, from 1 */
    uint64_t revision;     /* revision after the change, from 1 */
    uint64_t metadata;     /* number of changes of the name, from 1, after this one */
    /* The revision that an undo or redo inverts; for a base, the earlier revision with an equal
     * content, if there is one; else 0. */
    uint64_t inverts;
    /* The revisions up to this one are dropped from the history after the change, to stay within
     * the undo budget. */
    uint64_t reach;
    /* When the mesh was created, and when this change was made; seconds since 1970 UTC. */
    double created, time;
    const char *ops; /* names of the operations of an edit, for the history; never NULL */
    st_tally tally;  /* elements that an edit changed */
    /* Number of ids issued of each kind of element, after the change. */
    uint32_t issued[HE_KIND_COUNT];
    st_counts counts; /* numbers of elements after the whole group of records */
    uint64_t bytes;   /* bytes of memory that the content takes after the change */
    /* The key of the request that made the change; NULL: it had no key. */
    const st_record_key *key;
    const char *job; /* id of the job that made the change, and is done with it; NULL: none */
    /* The body, in the bytes of an st_room; NULL in a journal that stores nothing. */
    const unsigned char *body;
    /* Bytes of the body; of a staged edit, which has no body, the bytes of the encoded edit. */
    size_t body_size;
    /* What was written to the disk in place of the body; taken with the record; NULL: nothing. */
    st_stage *stage;
    bool staged_edit; /* the stage is the encoded edit, not the content after it */
} st_record;

/* A short description of a mesh after its newest record, without the content. */
typedef struct st_card {
    char id[ST_MESH_ID + 1], name[ST_MESH_NAME + 1];
    uint64_t incarnation, metadata, revision, record;
    double created, modified;
    st_counts counts;
    uint64_t bytes;             /* bytes of memory that the content takes */
    char holder[ST_HOLDER + 1]; /* holder of the mesh; "": none */
    char damage[ST_DAMAGE];     /* "", or a sentence that says how the stored mesh is damaged */
} st_card;

/* Copies a text, cut to `most` bytes. */
void st_copy_text(char *to, const char *from, size_t most);
/* Fills in the card of a mesh as it is after this record; card->damage stays as it is. */
void st_card_of_record(const st_record *record, st_card *card);

typedef enum st_piece_kind {
    ST_PIECE_BASE, /* the facts of the mesh at its base; the parts of the content follow */
    ST_PIECE_PART, /* a part of the base's content, or of the stage of the record before */
    /* A record; if it has a stage, it has no body, and the parts of the stage follow. */
    ST_PIECE_RECORD,
    ST_PIECE_END
} st_piece_kind;

/* What one step of reading a stored mesh returns; borrowed until the next step. */
typedef struct st_piece {
    st_piece_kind kind;
    st_record record; /* for BASE and RECORD */
    uint64_t parts;   /* number of parts that follow a base, or a record with a stage */
    /* How a PART is coded; he_stored_reader_part takes this value. Parts are decompressed already;
     * the parts of an encoded edit have HE_CODING_PLAIN. */
    unsigned coding;
    const unsigned char *bytes;
    size_t size;
    const char *why; /* if reading failed, a sentence that says why */
} st_piece;

#endif
