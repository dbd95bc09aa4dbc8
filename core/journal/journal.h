/* journal.h - makes changes durable.
 *
 * The store gives each change of a mesh to the journal in order, under the mesh's write lock, and
 * does not wait: later writes build on the change before it is durable. Changes are revisions,
 * renames and the removal (record.h). A record has two numbers: the first counts the records of its
 * mesh, from 1 without a gap; the second, the record's position, counts all records of the store
 * and is assigned by the journal. The removal of a mesh comes before the first record of another
 * mesh with the same id.
 *
 *     reserve ----> room ----> append ----> queued ----> durable    moved(position)
 *        |            +------> leave          +--------> lost       lost(interval), then moved
 *        +-> refused: nothing was written, the change is taken back
 *
 * An answer that shows a record is sent only when the journal reports that all records up to its
 * position are durable (rule D1: no answer shows a change that a crash could lose). Appended
 * records may wait long until they are durable; the journal calls its listener whenever more
 * records are durable.
 *
 * LOSS. When the disk is full or a sync failed, all queued records are lost, and so will be all
 * records appended into rooms (st_room) that were reserved before: such records still get
 * positions, but are lost. The journal reserves no further room until all rooms that were reserved
 * before the loss were used or given back, and all losses were reported; so no record that can
 * become durable builds on one that cannot. */
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
    ST_TOO_MANY,  /* the limit of meshes, or of jobs, is reached */
    ST_NOTHING,   /* nothing to undo or redo */
    ST_LISTENERS, /* the limit of listeners is reached */
    ST_AHEAD,     /* the requested revision does not exist yet */
    ST_GONE,      /* the requested revision is no longer in the history */
    ST_ELSEWHERE, /* neither undo nor redo, however often, leads to the requested revision */
    ST_BUSY,      /* a long edit has claimed the mesh */
    ST_LOST,      /* a change of the mesh was lost: the mesh must be loaded again */
    ST_COLD,      /* the mesh is not in memory; only the disk knows whether it exists */
    ST_LOADING,   /* another thread has been loading the mesh for too long */
    ST_DAMAGED,   /* the stored mesh is damaged */
    ST_NEWER,     /* a newer release has stored the mesh */
    ST_BEHIND,    /* the journal's queue is full, because the disk is slow */
    ST_FULL,      /* the disk is full */
    ST_FAILED,    /* the disk failed: no more changes until a restart */
    ST_TOO_LARGE, /* the change takes more than ST_MOST_BODY bytes */
    ST_QUOTA      /* the holder (owner) of the mesh may not have more meshes or bytes */
} st_status;

/* The most bytes of the bodies of one group of records together, and of one encoded edit that is
 * stored in parts: SQLite refuses a row above 10^9 bytes, and a thread that loads the mesh holds
 * the encoded edit as one block of memory. */
enum { ST_MOST_BODY = 900000000 };

/* A room: memory reserved for one group of records, and its share of the journal's queue. Each kind
 * of journal (in memory, on disk) extends this struct by members of its own. */
typedef struct st_room {
    /* Memory for the bodies (encoded data) of the records, which the caller writes before it
     * appends the group. */
    unsigned char *bytes;
    size_t size;
} st_room;

typedef struct st_room_need {
    size_t records; /* most records, at least one */
    /* The most bytes that the bodies (encoded data) of all records of the group will have
     * together. */
    size_t bytes;
    /* True if the group is the removal of a mesh, which is accepted even if the disk is full. */
    bool freeing;
} st_room_need;

/* Reads one stored mesh; each kind of journal (in memory, on disk) defines its own struct. */
typedef struct st_reader st_reader;

/* Records that will never be durable: those of one mesh, or of all meshes, within an interval of
 * positions. If a record of a mesh is lost, all later ones are lost, too. */
typedef struct st_loss {
    /* incarnation (random number) of the mesh; 0: records of all meshes are lost */
    uint64_t incarnation;
    /* `from` and `to` are the positions of the first and of the last lost record */
    uint64_t from, to;
    st_status status;   /* ST_FULL or ST_FAILED, for the answer to the writer */
    const char *reason; /* `reason` is a string literal, such as "the disk refused a write" */
} st_loss;

/* The listener of a journal. It is called from the journal's own thread, without a lock that
 * `reserve` or `append` takes. `lost` takes the locks of meshes, so a thread that holds the lock of
 * a mesh must not wait for the journal. */
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

/* A function that receives the name of the holder (owner) of one mesh, and the bytes of the mesh
 * that its card (short description) states. Returns false if memory is out. */
typedef bool st_take_holding(void *context, const char *holder, uint64_t bytes);

enum { ST_HEALTH_TEXT = 200 };

/* The state of the journal: whether changes are accepted. */
typedef struct st_health {
    st_status status; /* ST_OK if changes are accepted, else ST_FULL or ST_FAILED */
    uint64_t fulls;   /* how often the disk became full since the journal was opened */
    /* Number of stored idempotency keys that were found to be damaged, at the start or later. */
    uint64_t damaged_keys;
    /* If `status` is ST_FAILED, the system's message about the failure; "" if there was none. */
    char reason[ST_HEALTH_TEXT];
} st_health;

/* A function that receives a stored job, which is borrowed for the call. Returns false if memory is
 * out. */
typedef bool st_take_job(void *context, const st_job *job);

/* A note: data stored beside the records. One of the three members is set, and borrowed for the
 * call. */
typedef struct st_note {
    const st_job *job;       /* the state of a job */
    const char *forgotten;   /* `forgotten` is the id of a job to be removed */
    const st_kept_key *kept; /* the Idempotency-Key of a request that changed nothing */
} st_note;

/* Measurements since the journal was opened, and its present state. */
typedef struct st_journal_measures {
    /* microseconds that each commit of a group of records took, with its sync */
    st_distribution commits;
    /* Microseconds that it took to write the write-ahead log and sync it, for each group of
     * records. */
    st_distribution syncs;
    /* numbers of records and notes in each group that was committed together */
    st_distribution groups;
    /* microseconds that each copying of the write-ahead log into the database took */
    st_distribution checkpoints;
    uint64_t behind; /* number of records and notes that wait to be committed */
    uint64_t lost;   /* number of records and notes that will never be durable */
    /* The bytes of the queue, reserved rooms included: how many there are now (`queued`), and how
     * many are allowed (`most_queued`). */
    uint64_t queued, most_queued;
    uint64_t log; /* bytes of the write-ahead log (-wal) in use */
} st_journal_measures;

typedef struct st_journal {
    void *self;
    /* True if the journal stores records on a disk. If not, every room is NULL, so bodies are not
     * encoded, and the functions from `note` to `begun` are NULL. */
    bool keeps;
    /* Two random words, stored with the meshes. They are the secret key with which requests are
     * hashed. */
    uint64_t secret[2];

    /* Reserves a room: memory for a group of records, and a share of the queue. Never waits. A
     * group larger than the whole queue is accepted when the queue is empty.
     * Returns ST_BEHIND if the queue is full.
     * Returns ST_FULL or ST_FAILED if the disk is full or failed.
     * Returns ST_NO_MEMORY if memory is out.
     * Returns ST_TOO_LARGE if the group can never be stored. */
    st_status (*reserve)(void *self, const st_room_need *need, st_room **out);
    /* Gives back a room that no records will use; does not wait. */
    void (*leave)(void *self, st_room *room);
    /* Appends a group of records of one mesh, at least one, which become durable together or not at
     * all; takes the room. The records get positions without a gap; returns the position of the
     * last one. Never fails and never waits. */
    uint64_t (*append)(void *self, st_room *room, const st_record *records, size_t count);

    /* Stores a note, which has a position like a record and becomes durable, or is lost, as a
     * record does. Never waits. A note that removes a job is accepted even if the disk is full.
     * Returns ST_BEHIND, ST_FULL, ST_FAILED or ST_NO_MEMORY as `reserve` does. */
    st_status (*note)(void *self, const st_note *note, uint64_t *position);

    /* Writes large mesh data (a content) to the disk before it is published; what was written is
     * called a stage. The function waits, so only threads that may wait can call it, without a
     * lock. No other thread may change the content meanwhile: only the caller has it, or it belongs
     * to a snapshot. Returns ST_FULL, ST_FAILED, ST_BEHIND or ST_NO_MEMORY if it cannot be
     * written. */
    st_status (*stage)(void *self, const he_mesh *content, st_stage **out);
    /* Writes an encoded edit to the disk before it is published. The edit is written in parts, like
     * a content, so that other commits wait for one part at a time and not for the whole edit.
     * Unlike a staged content, a staged edit cannot become a base (a content from which the mesh is
     * loaded). */
    st_status (*stage_edit)(void *self, const unsigned char *bytes, size_t size, st_stage **out);
    /* Deletes a stage (a content written in advance) that was not published. Does not wait. */
    void (*unstage)(void *self, st_stage *stage);
    /* Makes the staged content a base, from which the mesh can be loaded; the journal then owns the
     * stage. `facts` describes the record after which the mesh had this content. The newest base
     * whose revision is not after `needed` is kept; the bases and records before it are deleted. */
    void (*rebase)(void *self, st_stage *stage, const st_record *facts, uint64_t needed);

    /* Opens the stored mesh of an id, in the state after the newest record that was appended before
     * this call. Waits until that record is durable or lost, so only threads that may wait can call
     * it. If `reader` is NULL only the card is read.
     * Returns ST_ABSENT if there is no such mesh.
     * Returns ST_DAMAGED with the card filled in if the card is damaged or says that the mesh is
     * damaged.
     * Returns ST_FAILED or ST_NO_MEMORY if it cannot be read. */
    st_status (*open)(void *self, const char *id, st_card *card, st_reader **reader);
    /* Reads the next piece of a stored mesh. If the piece is wrong, its member `why` says what is
     * wrong.
     * Returns ST_DAMAGED if a checksum, or the chain of hashes that connects the records, is wrong.
     * Returns ST_NEWER if a newer release wrote the piece.
     * Returns ST_FAILED or ST_NO_MEMORY if it cannot be read. */
    st_status (*read)(st_reader *reader, st_piece *out);
    void (*shut)(st_reader *reader); /* takes NULL */
    /* Marks the card of the mesh as damaged, because its pieces do not make a mesh; `damage` says
     * why. Does nothing if the mesh was stored anew as another base, or was removed, since the
     * reader was opened. */
    void (*condemn)(st_reader *reader, const char *damage);
    /* Lists the cards (short descriptions) of up to `limit` meshes, in the order of ids, beginning
     * after the id `after` ("" for the start). The cards describe the meshes after their newest
     * durable records. Waits for the disk.
     * Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*list)(void *self, const char *after, st_card *out, size_t limit, size_t *count);
    /* Lists cards as `list` does, but those of `page`, in its order. One call sees the meshes of
     * one moment. Waits for the disk; a change that is not durable yet is not seen. Returns
     * ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*list_by)(void *self, const st_card_page *page, st_card *out, size_t *count);
    /* Passes to `take` the Idempotency-Keys of the last day that durable records of the mesh `id`
     * have stored, or, if `id` is NULL, the keys of requests that created a mesh. The oldest key
     * comes first, damaged keys are included. Waits for the disk.
     * Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*keys)(void *self, const char *id, st_take_key *take, void *context);
    /* Passes to `take` the jobs that durable notes have stored, in the order of their numbers.
     * Waits for the disk.
     * Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*jobs)(void *self, st_take_job *take, void *context);
    /* Passes to `take`, for each mesh that has a holder, the holder and the bytes of the mesh after
     * its newest durable record. Waits for the disk. The function pointer is NULL in a journal that
     * stores no holders. Returns ST_FAILED or ST_NO_MEMORY if they cannot be read. */
    st_status (*holdings)(void *self, st_take_holding *take, void *context);
    /* Returns the number of stored meshes, counting the creations and removals in the queue as
     * done. Never waits. */
    uint64_t (*count)(void *self);
    /* Reports the state of the disk (st_health). Never waits. */
    void (*health)(void *self, st_health *out);
    /* Copies the measurements of the journal. Never waits. The function pointer is NULL in a
     * journal that measures nothing. */
    void (*measure)(void *self, st_journal_measures *out);

    /* Must be called when the start of the daemon is complete. Waits until the meshes that the
     * start has put into a new store are durable; from then on the store counts as an existing
     * one. */
    void (*begun)(void *self);

    /* Sets the journal's only listener, and calls it at once if a record was appended already. NULL
     * removes the listener; when this function returns, no call of the old listener is under
     * way. */
    void (*listen)(void *self, const st_journal_listener *listener);
    /* Commits all queued records and closes the journal. The caller must have used or given back
     * each room and shut each reader. */
    void (*close)(void *self);
} st_journal;

/* Makes a journal that stores nothing: a record counts as durable as soon as it is appended. */
st_journal st_journal_memory(void);

#endif
