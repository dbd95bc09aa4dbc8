/* journal.h - where changes are made durable.
 *
 * The store hands each change of a mesh to the journal in order, under the mesh's write lock, and
 * goes on: writers build on the head. Changes are revisions, renames and the removal (record.h). A
 * record is numbered twice: by its mesh, from 1 without a gap, and by the journal, which gives it a
 * position in the order of all records of the store. The removal of a mesh comes before the first
 * record of another one of its id.
 *
 *     reserve ----> room ----> append ----> queued ----> durable    moved(position)
 *        |            +------> leave          +--------> lost       lost(interval), then moved
 *        +-> refused: nothing was written, the change is taken back
 *
 * An answer that shows a record is held back until the journal says that all records up to its
 * position are durable (D1: no answer shows a change that a crash could lose). A journal may be far
 * behind; whenever it gets further it calls its listener.
 *
 * LOSS. When the disk is full or a sync failed, what is queued is lost, and so is each room that
 * was reserved before: it is still appended and gets its position, but as one that is lost. Until
 * the last of those rooms came back, and everything lost was told, nothing is admitted; so no
 * record that can become durable builds on one that cannot. */
#ifndef HE_JOURNAL_JOURNAL_H
#define HE_JOURNAL_JOURNAL_H

#include "journal/record.h"
#include "system/histogram.h"

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
    ST_BUSY,      /* a long edit has claimed the mesh */
    ST_LOST,      /* the mesh has a change that was lost: find it anew */
    ST_COLD,      /* not in memory: whether there is one the disk must say */
    ST_LOADING,   /* another thread is loading it, for too long to be waited for */
    ST_DAMAGED,   /* what is kept of the mesh is not whole */
    ST_NEWER,     /* what is kept of the mesh a newer release has written */
    ST_BEHIND,    /* the disk is slow: as much is queued as may be */
    ST_FULL,      /* the disk is full */
    ST_FAILED,    /* the disk failed: no more writes until a restart */
    ST_TOO_LARGE, /* the change takes more than ST_MOST_BODY */
    ST_QUOTA      /* whose it is may have no more */
} st_status;

/* Bytes that the bodies of a group, or a coded edit in parts, may take: SQLite refuses a row above
 * 10^9, and who loads the mesh holds it as one block. */
enum { ST_MOST_BODY = 900000000 };

/* Memory and a place in the queue for one group of records. A journal's own facts follow. */
typedef struct st_room {
    unsigned char *bytes; /* for bodies, which the caller writes before the group is appended */
    size_t size;
} st_room;

typedef struct st_room_need {
    size_t records; /* at most, at least one */
    size_t bytes;   /* of their bodies together, at most */
    bool freeing;   /* a removal, which is admitted while the disk is full */
} st_room_need;

typedef struct st_reader st_reader; /* of one mesh; a journal's own */

/* Records that will never be durable: those of one mesh, or of all, within an interval of
 * positions. What is lost of a mesh are its last records: those it appends later are lost too. */
typedef struct st_loss {
    uint64_t incarnation; /* of the mesh; 0: of all meshes */
    uint64_t from, to;    /* both are lost */
    st_status status;     /* ST_FULL or ST_FAILED: what a writer is answered */
    const char *reason;   /* a literal, such as "the disk refused a write" */
} st_loss;

/* Called from the journal's own thread, without a lock that `reserve` or `append` takes. `lost`
 * waits for locks of meshes: nobody who holds one may wait for the journal. */
typedef struct st_journal_listener {
    void *context;
    /* Every record up to `position`, which never falls, is durable or was told as lost before. */
    void (*moved)(void *context, uint64_t position);
    void (*lost)(void *context, const st_loss *loss);
} st_journal_listener;

/* Takes a key, which is borrowed for the call. False without memory. */
typedef bool st_take_key(void *context, const st_kept_key *key);

/* Takes a mesh that is somebody's: whose, and the bytes of its card. False without memory. */
typedef bool st_take_holding(void *context, const char *holder, uint64_t bytes);

enum { ST_HEALTH_TEXT = 200 };

/* Are changes taken? */
typedef struct st_health {
    st_status status;      /* ST_OK; ST_FULL, ST_FAILED: not, and why */
    uint64_t fulls;        /* how often the disk was found full since the start */
    uint64_t damaged_keys; /* keys of requests that were found damaged, at the start or since */
    char reason[ST_HEALTH_TEXT]; /* of ST_FAILED: what the system said, "" where it said nothing */
} st_health;

/* Takes a job, which is borrowed for the call. False without memory. */
typedef bool st_take_job(void *context, const st_job *job);

/* One of three, borrowed for the call. */
typedef struct st_note {
    const st_job *job;       /* how it is */
    const char *forgotten;   /* a job that is kept no longer */
    const st_kept_key *kept; /* of a request that changed nothing */
} st_note;

/* What a journal measured since the start, and how it is at the moment. */
typedef struct st_journal_measures {
    st_distribution commits;      /* how long groups took to commit, sync included; microseconds */
    st_distribution syncs;        /* how long the sync of each, and writing to the log, took */
    st_distribution groups;       /* records and notes of each */
    st_distribution checkpoints;  /* how long the log took to be written back; microseconds */
    uint64_t behind;              /* records and notes that are queued or being committed */
    uint64_t lost;                /* that will never be durable */
    uint64_t queued, most_queued; /* bytes of the queue, with what is reserved */
    uint64_t log;                 /* bytes of the -wal that are in use */
} st_journal_measures;

typedef struct st_journal {
    void *self;
    /* Is what is appended kept beyond memory? Without it a room is NULL, so that nothing is coded,
     * and the functions from `note` to `begun` are NULL. */
    bool keeps;
    /* Two random words, which are kept with the store: what is remembered of requests is hashed
     * with them. */
    uint64_t secret[2];

    /* Never waits. ST_BEHIND: the queue is full; what is larger than the queue is admitted when it
     * is empty. ST_FULL, ST_FAILED, ST_NO_MEMORY; ST_TOO_LARGE, which no time helps. */
    st_status (*reserve)(void *self, const st_room_need *need, st_room **out);
    void (*leave)(void *self, st_room *room); /* nothing is appended; does not wait */
    /* Takes the room, and a group of records of one mesh, at least one, which become durable
     * together or not at all. They get positions without a gap; returns the last one's. Neither
     * fails nor waits. */
    uint64_t (*append)(void *self, st_room *room, const st_record *records, size_t count);

    /* Keeps a note, which has a position like a record: it is durable or lost with that. Never
     * waits. Of a forgotten job it is taken like a removal. ST_BEHIND, ST_FULL, ST_FAILED,
     * ST_NO_MEMORY. */
    st_status (*note)(void *self, const st_note *note, uint64_t *position);

    /* Brings a large content to the disk before it is published. Waits: only on a thread that may,
     * without a lock, the content private or a snapshot's. ST_FULL, ST_FAILED, ST_BEHIND,
     * ST_NO_MEMORY. */
    st_status (*stage)(void *self, const he_mesh *content, st_stage **out);
    /* Stages a coded edit, in parts that are written one by one like those of a content, so that
     * others wait for a part and not for the whole. Not for a base. */
    st_status (*stage_edit)(void *self, const unsigned char *bytes, size_t size, st_stage **out);
    /* It is not published. Does not wait. */
    void (*unstage)(void *self, st_stage *stage);
    /* The staged content, which it takes, is that of the mesh after the record `facts`: from now on
     * the mesh can be loaded from it. Bases are let go, with the records before them, down to the
     * newest whose revision is not after `needed`. */
    void (*rebase)(void *self, st_stage *stage, const st_record *facts, uint64_t needed);

    /* The mesh of an id, as the newest record left it that was appended before: waits until that is
     * durable or lost, on a thread that may. `reader` NULL: the card alone. ST_ABSENT; ST_DAMAGED
     * with the card filled in; ST_FAILED, ST_NO_MEMORY. */
    st_status (*open)(void *self, const char *id, st_card *card, st_reader **reader);
    /* The next piece. ST_DAMAGED: sums or chain are wrong; ST_NEWER: of a version that is not
     * known; `why` of the piece says what. ST_FAILED, ST_NO_MEMORY. */
    st_status (*read)(st_reader *reader, st_piece *out);
    void (*shut)(st_reader *reader); /* takes NULL */
    /* What was read is no mesh: its card says `damage` from now on, unless the mesh has got another
     * base or was removed since the reader was opened. */
    void (*condemn)(st_reader *reader, const char *damage);
    /* Up to `limit` cards of ids after `after` ("" from the start), in the order of ids, as durable
     * records left them; waits for the disk. ST_FAILED, ST_NO_MEMORY. */
    st_status (*list)(void *self, const char *after, st_card *out, size_t limit, size_t *count);
    /* Gives the keys of the last day that durable records of a mesh carry (`id` NULL: those that
     * made a mesh), the oldest first, damaged ones among them; waits for the disk. ST_FAILED,
     * ST_NO_MEMORY. */
    st_status (*keys)(void *self, const char *id, st_take_key *take, void *context);
    /* Gives the jobs that durable notes left, in the order of their numbers; waits for the disk.
     * ST_FAILED, ST_NO_MEMORY. */
    st_status (*jobs)(void *self, st_take_job *take, void *context);
    /* Gives the meshes of every holder, as durable records left them; waits for the disk. NULL:
     * none is kept. ST_FAILED, ST_NO_MEMORY. */
    st_status (*holdings)(void *self, st_take_holding *take, void *context);
    /* How many meshes there are, with what is queued. Never waits. */
    uint64_t (*count)(void *self);
    /* How the disk is. Never waits. */
    void (*health)(void *self, st_health *out);
    /* Never waits. NULL: nothing is measured. */
    void (*measure)(void *self, st_journal_measures *out);

    /* The start is over: what it put into a store that was just made is durable from now on, and
     * the next start finds an old store. Waits. */
    void (*begun)(void *self);

    /* Sets the one listener, and tells it how far the journal is if that is beyond 0. NULL stops;
     * once it returned, no call is under way. */
    void (*listen)(void *self, const st_journal_listener *listener);
    /* Commits what is queued. No room or reader may be out. */
    void (*close)(void *self);
} st_journal;

/* Keeps nothing: a revision is as durable as it will ever be the moment it is made. */
st_journal st_journal_memory(void);

#endif
