/* record.h - the data that the store gives to the journal, and gets back from it.
 *
 * A RECORD is one change of one mesh: a revision, a rename, the name of a revision or the removal.
 * A CONTENT is the whole data of a mesh: its elements and attributes. A CARD is a short description
 * of a mesh, without its content. A PIECE is what one step of loading a mesh reads: first parts of
 * its base, a content, then the records after the base in order. A NOTE is stored beside the
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
    ST_MOMENT_NAME = 200, /* most bytes of the name of a revision */
    ST_JOB_ID = 22,
    ST_DAMAGE = 160,
    ST_HOLDER = 64 /* most bytes of a holder's name */
};

/* The kind of change that a revision made, as the history of a mesh shows it. */
typedef enum st_action { ST_EDIT, ST_UNDO, ST_REDO, ST_REPLACE } st_action;

/* How many elements a revision created, deleted and modified; each array has the numbers of
 * vertices, edges and faces. `known` is false if they were not counted. */
typedef struct st_tally {
    bool known;
    uint32_t created[3], deleted[3], modified[3];
} st_tally;

/* A large content, or a large encoded edit, that was written to the disk before it is published.
 * Each kind of journal (in memory, on disk) defines its own struct. */
typedef struct st_stage st_stage;

/* The kind of a record. The numbers are stored and never change their meaning. */
typedef enum st_record_kind {
    ST_RECORD_EDIT =
        /* An edit of the mesh. The body, or the stage that replaces the body, is the encoded edit;
         * a stage may also be the whole content after the edit. */
    1,
    ST_RECORD_UNDO = 2, /* undoes the newest step of the undo stack; such a record has no body */
    ST_RECORD_REDO = 3, /* redoes the newest step of the redo stack; such a record has no body */
    /* Creation of the mesh, or replacement of its content (PUT): the body or the stage is the
     * encoded content. */
    ST_RECORD_CONTENT = 4,
    ST_RECORD_RENAME = 5,
    ST_RECORD_REMOVE = 6,
    ST_RECORD_MOMENT = 7 /* names a revision, or takes its name away */
} st_record_kind;

/* The Idempotency-Key of the request that made a change. The answer does not exist yet when the
 * change is published, so a repeated request, whose key was read back from the journal, is answered
 * 201 or 204 without a body, with the ETag of the record's revision. */
typedef struct st_record_key {
    const char *text;
    uint64_t digest[2]; /* hash of the request, keyed with the store's secret */
    double time;        /* time at which the request came, in seconds since 1970 */
    /* True if the key belongs to the store and not to the mesh, because the change created the
     * mesh. */
    bool of_store;
    /* `holder` is the client that sent the key: equal keys of different clients are different keys.
     * "" or NULL stands for clients without a name. */
    const char *holder;
} st_record_key;

/* ST_KEPT_SECONDS is how many seconds an Idempotency-Key is kept. ST_KEPT_KEYS is how many keys
 * are kept for one mesh or for the store: the oldest are deleted first. */
enum { ST_KEPT_SECONDS = 24 * 3600, ST_KEPT_KEYS = 16384 };

/* A stored Idempotency-Key, and the state of the mesh that the answer to its request showed. */
typedef struct st_kept_key {
    st_record_key key;
    const char *id; /* text: the key; id: id of the mesh that the answer shows */
    uint64_t incarnation, revision, metadata;
    /* True if the stored row is damaged. Then only `text` and `holder` may be used, and even they
     * may be wrong. */
    bool is_damaged;
} st_kept_key;

/* The stored state of a job. The numbers are stored and never change their meaning. */
typedef enum st_job_state {
    ST_JOB_ACCEPTED =
        /* The job waits or runs. A job that is found in this state when the daemon starts never
         * ended and changed nothing. */
    1,
    ST_JOB_DONE = 2,
    ST_JOB_FAILED = 3,
    ST_JOB_CANCELLED = 4
} st_job_state;

enum { ST_JOB_TYPE, ST_JOB_DISPOSITION, ST_JOB_TAG, ST_JOB_WARNINGS, ST_JOB_HEADERS };
enum { ST_JOB_SECONDS = 3600 }; /* for how many seconds a job is kept after it has ended */

/* A job: a request that outlives its connection. Texts are never NULL, but may be "". */
typedef struct st_job {
    char id[ST_JOB_ID + 1];
    uint64_t number; /* number of the job in the order of submission, from 1 */
    st_job_state state;
    const char *operation, *phase, *mesh, *location;
    const char *holder; /* `holder` is the name of the access token that the job belongs to */
    double progress;    /* 0 to 1 */
    /* The times when this happened, in seconds since 1970 UTC; 0: it has not happened yet. */
    double created, started, finished;
    int status;                          /* HTTP status of the job's answer; 0: there is none */
    bool shown;                          /* true if a GET of the job shows the body, too */
    const char *headers[ST_JOB_HEADERS]; /* headers of the job's answer */
    const void *body; /* `body` is the body of the job's answer; NULL: no body is kept */
    size_t length;
} st_job;

/* How many vertices, edges, faces and boundary half-edges a mesh has, not counting deleted ones. */
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
    const char *id, *name; /* `id` is the id of the mesh, `name` its name after the change */
    const char *holder;    /* `holder` is the holder (owner) of the mesh; "" or NULL: it has none */
    uint64_t incarnation;  /* random, new for each creation of a mesh with this id */
    uint64_t number;       /* number of this record among the records of the incarnation, from 1 */
    uint64_t revision;     /* revision of the mesh after the change, from 1 */
    /* counter of the changes of names, of the mesh and of its revisions, from 1, after this
     * change */
    uint64_t metadata;
    /* The revision that an undo or redo inverts; for a base (whole content), the earlier revision
     * with an equal content, if there is one; else 0. */
    uint64_t inverts;
    /* If the record is an ST_RECORD_MOMENT: the revision that it names (`named`), and the name in
     * UTF-8 (`moment`), which is "" if the revision loses its name; else 0 and NULL. */
    uint64_t named;
    const char *moment;
    /* The revisions from the oldest up to this one are dropped from the history after the change,
     * to stay within the undo budget. */
    uint64_t reach;
    /* `created` is when the mesh was created, `time` when this change was made, in seconds since
     * 1970 UTC. */
    double created, time;
    /* the names of the operations of an edit, which the history shows; never NULL */
    const char *ops;
    st_tally tally; /* elements that an edit changed */
    /* How many ids of each kind of element the mesh has ever issued, after the change. */
    uint32_t issued[HE_KIND_COUNT];
    /* numbers of elements after the whole group of records that the record belongs to */
    st_counts counts;
    uint64_t bytes; /* bytes of memory that the content of the mesh takes after the change */
    /* The Idempotency-Key of the request that made the change; NULL: the request had none. */
    const st_record_key *key;
    /* `job` is the id of the job that made the change and ends with it; NULL: no job */
    const char *job;
    /* The body (encoded data) of the record, which lies in the member `bytes` of an st_room; NULL
     * in a journal that stores nothing. */
    const unsigned char *body;
    /* Number of bytes of the body. An edit that was written to the disk in advance has no body;
     * then it is the number of bytes of the encoded edit. */
    size_t body_size;
    /* The data that was written to the disk in advance, in place of the body; NULL: there is none.
     * The journal owns the stage once the record is appended. */
    st_stage *stage;
    /* True if the stage is the encoded edit, false if it is the whole content after the edit. */
    bool staged_edit;
} st_record;

/* A short description of a mesh after its newest record, without the content. */
typedef struct st_card {
    char id[ST_MESH_ID + 1], name[ST_MESH_NAME + 1];
    uint64_t incarnation, metadata, revision, record;
    double created, modified;
    st_counts counts;
    uint64_t bytes;             /* bytes of memory that the content takes */
    char holder[ST_HOLDER + 1]; /* holder (owner) of the mesh; "": it has none */
    /* A sentence that says how the stored mesh is damaged; "": the mesh is not damaged. */
    char damage[ST_DAMAGE];
} st_card;

/* The orders in which meshes can be listed by their cards (short descriptions). */
typedef enum st_card_order {
    /* The names ascending, compared byte by byte but with the letters A to Z as a to z; meshes with
     * equal names are in the order of their ids. */
    ST_BY_NAME,
    /* the times of the last change, the newest first; equal times are in the reverse order of
     * ids */
    ST_BY_MODIFIED,
    /* the bytes of memory, the largest first; equal sizes are in the reverse order of ids */
    ST_BY_BYTES,
    ST_CARD_ORDERS
} st_card_order;

/* A part of the list of all meshes in one of the orders above. */
typedef struct st_card_page {
    st_card_order order;
    /* The part begins after the place of this card; only its id and the member by which the list is
     * ordered are used, and the mesh need not exist. NULL: the part begins with the first mesh. */
    const st_card *after;
    size_t limit; /* the most cards in the part */
} st_card_page;

/* Returns a negative number if the mesh with the card `a` is listed before that with the card `b`,
 * a positive number if it is listed after it, and 0 if the order and the ids are equal. */
int st_card_compare(st_card_order order, const st_card *a, const st_card *b);

/* Copies a text; it is cut after `most` bytes. */
void st_copy_text(char *to, const char *from, size_t most);
/* Fills in the card of a mesh as it is after this record; card->damage stays as it is. */
void st_card_of_record(const st_record *record, st_card *card);

typedef enum st_piece_kind {
    /* The base, which is the mesh data with which a load begins: this piece has the id, name and
     * counts of the mesh. The next pieces are the parts of the mesh data. */
    ST_PIECE_BASE,
    /* a part of the base's content, or of the stage of the record that was read before */
    ST_PIECE_PART,
    /* A record; if it has a stage, it has no body, and the parts of the stage follow. */
    ST_PIECE_RECORD,
    ST_PIECE_END
} st_piece_kind;

/* What one step of reading a stored mesh returns; borrowed until the next step. */
typedef struct st_piece {
    st_piece_kind kind;
    st_record record; /* for BASE and RECORD */
    uint64_t parts;   /* for a base, or a record with a stage: the number of parts that follow it */
    /* How the bytes of an ST_PIECE_PART are coded; he_stored_reader_part takes this value. The
     * journal has decompressed the part already; the parts of an encoded edit have
     * HE_CODING_PLAIN. */
    unsigned coding;
    const unsigned char *bytes;
    size_t size;
    const char *why; /* `why`: if reading failed, a sentence that says why */
} st_piece;

#endif
