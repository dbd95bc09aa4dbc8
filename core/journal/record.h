/* record.h - what the journal is given, and what it gives back.
 *
 * A RECORD is one change of one mesh: a revision, a rename or the removal. A CARD is what is known
 * of a mesh without its content. A PIECE is one step of loading a mesh: first its base, a whole
 * content in parts, then the records after it in their order. A NOTE is kept beside the records: a
 * job, or the key of a request that changed nothing.
 *
 * Bodies and contents are bytes as core/stored writes them; the journal looks into neither. */
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
    ST_HOLDER = 64 /* of the name of whose a mesh is */
};

/* What a revision did; kept in the history. */
typedef enum st_action { ST_EDIT, ST_UNDO, ST_REDO, ST_REPLACE } st_action;

/* How many elements a revision created, deleted and modified: vertices, edges, faces. */
typedef struct st_tally {
    bool known;
    uint32_t created[3], deleted[3], modified[3];
} st_tally;

/* A large content, or a large coded edit, that was brought to the disk before it is published; what
 * else it is belongs to the journal. */
typedef struct st_stage st_stage;

/* What a record is. The numbers are written down and keep their meaning for ever. */
typedef enum st_record_kind {
    ST_RECORD_EDIT = 1,    /* the body is the coded edit; or a stage, that or the content after */
    ST_RECORD_UNDO = 2,    /* of the newest step on the undo stack, with no body */
    ST_RECORD_REDO = 3,    /* of the newest step on the redo stack, with no body */
    ST_RECORD_CONTENT = 4, /* creation or PUT: the body is the coded content; or a stage */
    ST_RECORD_RENAME = 5,
    ST_RECORD_REMOVE = 6
} st_record_kind;

/* The Idempotency-Key of the request that made a change. The answer is written after the change is
 * published, so that a journal which brings a key back answers 201 or 204 without a body, with the
 * tag of the record's revision. */
typedef struct st_record_key {
    const char *text;
    uint64_t digest[2]; /* of the request; good with the store's secret only */
    double time;        /* when the request came, seconds since 1970 */
    bool of_store;      /* the key is the store's: the change made the mesh */
    const char *holder; /* whose key it is: another one's of the same text is another. "" or NULL
                           for that of nobody in particular */
} st_record_key;

/* How long a key is kept, and how many of a mesh or of the store: the oldest go first. */
enum { ST_KEPT_SECONDS = 24 * 3600, ST_KEPT_KEYS = 16384 };

/* A key that is kept, and the state that the answer to its request had. */
typedef struct st_kept_key {
    st_record_key key;
    const char *id; /* of the mesh */
    uint64_t incarnation, revision, metadata;
    bool is_damaged; /* what was kept is not what it was: of all this only `text` and `holder` are
                        to be believed, and they may be other ones */
} st_kept_key;

/* How a job is kept. The numbers are written down and keep their meaning for ever. */
typedef enum st_job_state {
    ST_JOB_ACCEPTED =
        1, /* it waits or runs; after a restart: it never ended, and changed nothing */
    ST_JOB_DONE = 2,
    ST_JOB_FAILED = 3,
    ST_JOB_CANCELLED = 4
} st_job_state;

enum { ST_JOB_TYPE, ST_JOB_DISPOSITION, ST_JOB_TAG, ST_JOB_WARNINGS, ST_JOB_HEADERS };
enum { ST_JOB_SECONDS = 3600 }; /* that one which has ended is kept */

/* A job: a request that outlives its connection. Texts are never NULL, "" where there is none. */
typedef struct st_job {
    char id[ST_JOB_ID + 1];
    uint64_t number; /* in the order of submission, from 1 */
    st_job_state state;
    const char *operation, *phase, *mesh, *location;
    const char *holder;                  /* name of the token that it belongs to */
    double progress;                     /* 0 to 1 */
    double created, started, finished;   /* seconds since 1970 UTC; 0: not yet */
    int status;                          /* HTTP, of its answer; 0: there is none */
    bool shown;                          /* the body is told with the job */
    const char *headers[ST_JOB_HEADERS]; /* of the answer */
    const void *body;                    /* NULL: none is kept */
    size_t length;
} st_job;

/* Live elements and boundary half-edges. */
typedef struct st_counts {
    uint32_t vertices, edges, faces, boundary;
} st_counts;

/* One change. Texts and what is pointed to are borrowed for the call. */
typedef struct st_record {
    st_record_kind kind;
    /* The history ends with it: nothing before can be undone, or read as a revision. Always with
     * ST_RECORD_CONTENT; of an edit where ids changed their meaning or the edit is larger than the
     * undo budget. */
    bool barrier;
    const char *id, *name;          /* the name after it */
    const char *holder;             /* whose the mesh is; "" or NULL: nobody's in particular */
    uint64_t incarnation;           /* of the mesh: random, new for each creation of an id */
    uint64_t number;                /* of the record, from 1 for each incarnation */
    uint64_t revision;              /* of the content after it, from 1 */
    uint64_t metadata;              /* counts changes of the name, from 1; after it */
    uint64_t inverts;               /* the revision that an undo or redo inverts; of a base the one
                                       whose content it has again, where it is another; else 0 */
    uint64_t reach;                 /* the history after it begins behind this revision: what was
                                       before is dropped, to stay within the undo budget */
    double created, time;           /* of the mesh; of the change: seconds since 1970 UTC */
    const char *ops;                /* of an edit, for the history; never NULL */
    st_tally tally;                 /* of an edit */
    uint32_t issued[HE_KIND_COUNT]; /* high-water marks after it */
    st_counts counts;               /* after its group */
    uint64_t bytes;                 /* that the content takes in memory then */
    const st_record_key *key;       /* NULL without one */
    const char *job;                /* whose work it is, NULL for none: the job is done with it */
    const unsigned char *body;      /* within the room's bytes; NULL where nothing is kept */
    size_t body_size;               /* of a staged edit its bytes, without a body */
    st_stage *stage;                /* instead of a body, taken with the record; else NULL */
    bool staged_edit;               /* the stage is the coded edit, not the content after it */
} st_record;

/* What is known of a mesh without its content: as its newest record left it. */
typedef struct st_card {
    char id[ST_MESH_ID + 1], name[ST_MESH_NAME + 1];
    uint64_t incarnation, metadata, revision, record;
    double created, modified;
    st_counts counts;
    uint64_t bytes;             /* that the content takes in memory */
    char holder[ST_HOLDER + 1]; /* whose it is; "": nobody's in particular */
    char damage[ST_DAMAGE];     /* "", or a sentence: what is wrong with what is kept of it */
} st_card;

/* Copies a text, cut after `most` bytes. */
void st_copy_text(char *to, const char *from, size_t most);
/* What the mesh is after the record; `damage` is left alone. */
void st_card_of_record(const st_record *record, st_card *card);

typedef enum st_piece_kind {
    ST_PIECE_BASE,   /* facts of the mesh at the base, which its parts follow */
    ST_PIECE_PART,   /* of the base's content, or of what the record before had staged */
    ST_PIECE_RECORD, /* one with `stage` not NULL has no body: what it staged follows in parts */
    ST_PIECE_END
} st_piece_kind;

/* What a reader gives; borrowed until the next is read. */
typedef struct st_piece {
    st_piece_kind kind;
    st_record record; /* of BASE and RECORD */
    uint64_t parts;   /* of BASE, and of RECORD with a stage: how many follow */
    unsigned coding;  /* of PART, as he_stored_reader_part wants it: packing is taken off. Parts of
                         a coded edit are HE_CODING_PLAIN */
    const unsigned char *bytes;
    size_t size;
    const char *why; /* where there is none: a sentence */
} st_piece;

#endif
