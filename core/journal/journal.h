/* journal.h - makes changes durable.
 *
 * The store gives each change of a mesh to the journal in order, under the mesh's write lock, and
 * goes on: later writes build on it before it is durable. Changes are revisions, renames and the
 * removal (record.h). A record has two numbers: one of its mesh, from 1 without a gap, and a
 * position in the order of all records of the store, which the journal gives. The removal of a mesh
 * comes before the first record of another one with its id.
 *
 *     reserve ----> room ----> append ----> queued ----> durable    moved(position)
 *        |            +------> leave          +--------> lost       lost(interval), then moved
 *        +-> refused: nothing was written, the change is taken back
 *
 * An answer that shows a record is held back until the journal reports that all records up to its
 * position are durable (D1: no answer shows a change that a crash could lose). A journal may be far
 * behind; it calls its listener whenever it advances.
 *
 * LOSS. When the disk is full or a sync failed, everything queued is lost, and so is each room that
 * was reserved before: its records are still appended and get positions, but are lost. Nothing is
 * accepted until the last of those rooms came back and all losses were reported; so no record that
 * can become durable builds on one that cannot. */
#ifndef HE_JOURNAL_JOURNAL_H
#define HE_JOURNAL_JOURNAL_H

#include "journal/record.h"
#include "system/histogram.h"

/* The outcome of a call of the store or the journal. */
typedef enum st_status {
    ST_OK,
    ST_ABSENT,
    ST_TAKEN, /* a mesh has the id */
    ST_NO_MEMORY,
    ST_BUDGET,    /* the memory budget is used up */
    ST_TOO_MANY,  /* too many meshes, or jobs */
    ST_NOTHING,   /* nothing to undo or redo */
    ST_LISTENERS, /* the limit of listeners is reached */
    ST_AHEAD,     /* there is no such revision yet */
    ST_GONE,      /* the revision is no longer in the history */
    ST_ELSEWHERE, /* the undo or redo stack does not lead to the revision */
    ST_BUSY,      /* a long edit has claimed the mesh */
    ST_LOST,      /* the mesh has a change that was lost: it must be loaded again */
    ST_COLD,      /* not in memory; only the disk knows whether the mesh exists */
    ST_LOADING,   /* another thread has been loading it for too long */
    ST_DAMAGED,   /* the stored mesh is damaged */
    ST_NEWER,     /* a newer release has stored the mesh */
    ST_BEHIND,    /* the disk is slow: the queue is full */
    ST_FULL,      /* the disk is full */
    ST_FAILED,    /* the disk failed: no more changes until a restart */
    ST_TOO_LARGE, /* the change takes more than ST_MOST_BODY */
    ST_QUOTA      /* the holder of the mesh may not have more */
} st_status;

/* The most bytes of the bodies of a group, or of a coded edit in parts: SQLite refuses a row above
 * 10^9, and a thread that loads the mesh holds it as one block. */
enum { ST_MOST_BODY = 900000000 };

/* A room: memory for one group of records, and its place in the journal's queue. Each journal
 * appends fields of its own. */
typedef struct st_room {
    unsigned char *bytes; /* for bodies, which the caller writes before it appends the group */
    size_t size;
} st_room;

typedef struct st_room_need {
    size_t records; /* most records, at least one */
    size_t bytes;   /* most bytes of their bodies together */
    bool freeing;   /* a removal, which is accepted while the disk is full */
} st_room_need;

typedef struct st_reader st_reader; /* reads one mesh; each journal defines its own */

/* Records that will never be durable: those of one mesh, or of all, within an interval of
 * positions. It is always the last records of a mesh that are lost: later ones are lost too. */
typedef struct st_loss {
    uint64_t incarnation; /* the mesh; 0: all meshes */
    uint64_t from, to;    /* first and last position lost */
    st_status status;     /* ST_FULL or ST_FAILED, for the answer to the writer */
    const char *reason;   /* a literal, such as "the disk refused a write" */
} st_loss;

/* The listener of a journal. It is called from the journal's own thread, without a lock that
 * `reserve` or `append` takes. `lost` takes the locks of meshes, so a thread that holds one must
 * not wait for the journal. */
typedef struct st_journal_listener {
    void *context;
    /* Every record up to `position`, which never falls, is durable or was reported as lost
     * before. */
    void (*moved)(void *context, uint64_t position);
    void (*lost)(void *context, const st_loss *loss);
} st_journal_listener;

/* A function that receives a stored key (the Idempotency-Key of a request), which is borrowed for
 * the call. Returns false if memory is out. */
typedef bool st_take_key(void *context, const st_kept_key *key);

/* A function that receives the holder of a mesh, and the bytes on its card. Returns false if memory
 * is out. */
typedef bool st_take_holding(void *context, const char *holder, uint64_t bytes);

enum { ST_HEALTH_TEXT = 200 };

/* The state of the journal: whether changes are accepted. */
typedef struct st_health {
    st_status status;            /* ST_OK; ST_FULL or ST_FAILED if they are not */
    uint64_t fulls;              /* how often the disk was full since the start */
    uint64_t damaged_keys;       /* keys of requests found damaged, at the start or since */
    char reason[ST_HEALTH_TEXT]; /* with ST_FAILED: the system's message, "" if there was none */
} st_health;

/* A function that receives a stored job, which is borrowed for the call. Returns false if memory is
 * out. */
typedef bool st_take_job(void *context, const st_job *job);

/* What is stored beside records. One of the three members is set, borrowed for the call. */
typedef struct st_note {
    const st_job *job;       /* the state of a job */
    const char *forgotten;   /* a job to be removed */
    const st_kept_key *kept; /* the key of a request that changed nothing */
} st_note;

/* Measurements since the journal was opened, and its present state. */
typedef struct st_journal_measures {
    st_distribution commits;      /* microseconds to commit a group, with its sync */
    st_distribution syncs;        /* microseconds to write the log and sync it, for each group */
    st_distribution groups;       /* records and notes of each group */
    st_distribution checkpoints;  /* microseconds to write the log back into the database */
    uint64_t behind;              /* records and notes queued or being committed */
    uint64_t lost;                /* records and notes that will never be durable */
    uint64_t queued, most_queued; /* bytes of the queue, reserved ones included */
    uint64_t log;                 /* bytes of the -wal in use */
} st_journal_measures;

typedef struct st_journal {
    void *self;
    /* True if the journal stores what is appended beyond memory. If not, a room is NULL, so that
     * nothing is coded, and the functions from `note` to `begun` are NULL. */
    bool keeps;
    /* Two random words, stored with the meshes: hashes of requests are keyed with them. */
    uint64_t secret[2];

    /* Reserves a room: memory for a group of records, and a place in the queue. Never waits. A
     * group larger than the queue is accepted when the queue is empty.
     * Returns ST_BEHIND if the queue is full.
     * Returns ST_FULL or ST_FAILED if the disk is full or failed.
     * Returns ST_NO_MEMORY if memory is out.
     * Returns ST_TOO_LARGE if the group can never be stored. */
    st_status (*reserve)(void *self, const st_room_need *need, st_room **out);
    void (*leave)(void *self, st_room *room); /* gives a room back; does not wait */
    /* Appends a group of records of one mesh, at least one, which become durable together or not at
     * all; takes the room. They get positions without a gap; returns the last one's. Neither fails
     * nor waits. */
    uint64_t (*append)(void *self, st_room *room, const st_record *records, size_t count);

    /* Stores a note, which has a position like a record and is durable or lost with it. Never
     * waits. A note that removes a job is accepted when a removal is.
     * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY as `reserve` does. */
    st_status (*note)(void *self, const st_note *note, uint64_t *position);

    /* Writes a large content to the disk before it is published; the result is called a stage. It
     * waits, so only threads that may wait can call it, without a lock. No other thread may change
     * the content: it is private or a snapshot's.
     * Returns ST_FULL, ST_FAILED, ST_BEHIND or ST_NO_MEMORY if it cannot be written. */
    st_status (*stage)(void *self, const he_mesh *content, st_stage **out);
    /* Stages a coded edit, in parts that are written one by one like those of a content, so that
     * other commits wait for a part and not for the whole. The stage cannot become a base. */
    st_status (*stage_edit)(void *self, const unsigned char *bytes, size_t size, st_stage **out);
    /* Deletes a stage (a content written in advance) that was not published. Does not wait. */
    void (*unstage)(void *self, st_stage *stage);
    /* Makes the staged content, which it takes, a base: it is the mesh after the record `facts`,
     * and the mesh can be loaded from it. Older bases are deleted with the records before them,
     * except the newest one whose revision is not after `needed`. */
    void (*rebase)(void *self, st_stage *stage, const st_record *facts, uint64_t needed);

    /* Opens the mesh of an id, as the newest record appended before left it: waits until that is
     * durable or lost, so only threads that may wait can call it. If `reader` is NULL only the card
     * is read.
     * Returns ST_ABSENT if there is no such mesh.
     * Returns ST_DAMAGED with the card filled in if the card is damaged or says that the mesh is.
     * Returns ST_FAILED or ST_NO_MEMORY if it cannot be read. */
    st_status (*open)(void *self, const char *id, st_card *card, st_reader **reader);
    /* Reads the next piece of a mesh. The member `why` of the piece says what is wrong with it.
     * Returns ST_DAMAGED if a checksum or the chain is wrong.
     * Returns ST_NEWER if a newer release wrote it.
     * Returns ST_FAILED or ST_NO_MEMORY if it cannot be read. */
    st_status (*read)(st_reader *reader, st_piece *out);
    void (*shut)(st_reader *reader); /* takes NULL */
    /* Marks the card of the mesh with `damage`, because the pieces do not make a mesh; unless the
     * mesh has got another base or was removed since the reader was opened. */
    void (*condemn)(st_reader *reader, const char *damage);
    /* Lists up to `limit` cards of ids after `after` ("" for the start), in the order of ids, as
     * durable records left them; waits for the disk.
     * Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*list)(void *self, const char *after, st_card *out, size_t limit, size_t *count);
    /* Passes the keys of the last day that durable records of a mesh carry (`id` NULL: those of
     * requests that made a mesh) to `take`, the oldest first, damaged ones included; waits for the
     * disk.
     * Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*keys)(void *self, const char *id, st_take_key *take, void *context);
    /* Passes the jobs that durable notes left to `take`, in the order of their numbers; waits for
     * the disk.
     * Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*jobs)(void *self, st_take_job *take, void *context);
    /* Passes the holder and bytes of each mesh that has one to `take`, as durable records left
     * them; waits for the disk. NULL in a journal that stores none.
     * Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*holdings)(void *self, st_take_holding *take, void *context);
    /* Returns the number of meshes, changes in the queue included. Never waits. */
    uint64_t (*count)(void *self);
    /* Reports the state of the disk. Never waits. */
    void (*health)(void *self, st_health *out);
    /* Copies the measurements. Never waits. NULL in a journal that measures nothing. */
    void (*measure)(void *self, st_journal_measures *out);

    /* Ends the start of the daemon: what it put into a new store is now durable, and the next start
     * will find an existing store. Waits. */
    void (*begun)(void *self);

    /* Sets the one listener, and calls it at once if the journal is beyond position 0. NULL removes
     * it; when the call returns, no call of the listener is under way. */
    void (*listen)(void *self, const st_journal_listener *listener);
    /* Commits what is queued and closes the journal. The caller must have appended or given back
     * each room (memory reserved for records, above) and ended each reader. */
    void (*close)(void *self);
} st_journal;

/* Makes a journal that stores nothing: a revision counts as durable as soon as it is made. */
st_journal st_journal_memory(void);

#endif
