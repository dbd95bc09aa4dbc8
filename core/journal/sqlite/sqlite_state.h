/* sqlite_state.h - the private structs and functions of core/journal/sqlite. WORDS: a room is the
 * memory reserved for one group of records. A stage is a content that is written to the disk before
 * it is published. A slice is a piece of background work that is done together with a commit. A
 * head is a cached row of a mesh. To purge is to delete what is no longer needed.
 *
 *     sqlite_queue.c    reserve, append: rooms on their way to the commit thread
 *     sqlite_commit.c   the commit thread: groups, checkpoints, faults of the disk
 *     sqlite_rows.c     what a record changes in the tables
 *     sqlite_notes.c    jobs, and Idempotency-Keys of requests that changed nothing
 *     sqlite_stage.c    contents in parts, and which content a mesh is loaded from
 *     sqlite_purge.c    deletes what is no longer needed, in slices
 *     sqlite_read.c     reads meshes
 *     sqlite_salvage.c  reads meshes from a file whose structure is damaged
 *     sqlite_index.c    compares the table of meshes with its indexes at the start
 *     sqlite_open.c     opens and closes the store
 *
 * One mutex guards the members that threads share (`shared` below). The connection that writes and
 * its state belong to the commit thread. */
#ifndef HE_JOURNAL_SQLITE_STATE_H
#define HE_JOURNAL_SQLITE_STATE_H

#include "journal/journal.h"
#include "journal/record_bytes.h"
#include "journal/sqlite/sqlite_folder.h"
#include "journal/sqlite/sqlite_journal.h"
#include "journal/sqlite/sqlite_schema.h"
#include "stored/stored.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct st_sqlite st_sqlite;

enum { ST_LOG_PAGE_BYTES = 4096 };

/* --- the queue of the commit thread --- */

typedef enum st_item_kind {
    ST_ITEM_ROOM,    /* a group of records */
    ST_ITEM_REBASE,  /* the item asks that a stage becomes a base, from which its mesh is loaded */
    ST_ITEM_UNSTAGE, /* the item asks that mesh data is deleted that was written in advance */
    /* The item asks that the card (short description) of a mesh is marked as damaged. */
    ST_ITEM_CONDEMN
} st_item_kind;

typedef struct st_item {
    st_item_kind kind;
    struct st_item *next;
} st_item;

/* One record in a room. */
typedef struct st_queued {
    st_record_kind kind;
    bool barrier;
    uint64_t incarnation, number, revision;
    unsigned char *frame; /* the encoded record, without its chain and checksum (record_bytes.h) */
    size_t size;
    st_stage *stage;
    bool staged_edit;
} st_queued;

/* What the member `job` of a room (memory of a group of records, or of a note) means. */
typedef enum st_job_word {
    ST_JOB_UNNAMED,
    ST_JOB_WORK,  /* the room has the records of the changes that the job made */
    ST_JOB_IS,    /* the room is a note with the state of the job */
    ST_JOB_LEAVES /* the room is a note that deletes the job */
} st_job_word;

/* A room: one block of memory with an entry for each record, the encoded records (frames), and
 * their bodies. A room without records is a note. */
typedef struct st_sqlite_room {
    st_room room; /* the members that callers of the journal see */
    st_item item;
    uint64_t generation; /* value of `generation` of the journal when the room was reserved */
    size_t charge;       /* how many bytes the room counts against the limit of the queue */
    bool freeing;
    /* `most` is how many records fit into the room, `count` how many it has so far */
    size_t most, count;
    uint64_t last; /* position of the last record in the room, or of the note */
    /* Number of meshes that the records create, less the number that they remove. */
    uint64_t meshes;
    st_card card; /* card (short description) of the mesh after the records of the room */
    bool has_key;
    st_kept_row key; /* the Idempotency-Key, whose texts are in `key_text` and `key_holder` */
    char key_text[ST_KEY_TEXT + 1], key_holder[ST_KEY_HOLDER + 1];
    st_job_word job_word;
    /* The job, whose texts and body are in the room's bytes. If job_word is ST_JOB_WORK, only those
     * members are set that follow from the room's records. */
    st_job job;
    /* Space for the encoded records without bodies: ST_FRAME_HEAD bytes for each record. */
    unsigned char *heads;
    st_queued entries[];
} st_sqlite_room;

/* A finding: damage that was found while a mesh was loaded from the record `base`. */
typedef struct st_finding {
    uint64_t incarnation, base;
    char damage[ST_DAMAGE];
} st_finding;

typedef struct st_condemned {
    st_item item;
    st_finding finding;
} st_condemned;

/* The parts of a stage (a content written in advance) are written to the disk in slices of this
 * many parts. */
enum { ST_SLICE_PARTS = 16 };

typedef struct st_slice {
    size_t count, written;
    size_t sizes[ST_SLICE_PARTS];
    unsigned char bytes[ST_SLICE_PARTS][ST_PART_HEAD + HE_STORED_PART_ROOM];
} st_slice;

struct st_stage {
    st_item item;
    int64_t key; /* key of the stage's row in the table of snapshots; 0 before that row exists */
    /* parts: number of all parts of the stage; written: how many of them are on the disk */
    uint64_t parts;
    uint64_t written;
    /* the slice (group of parts) that is being filled or written; NULL after the last slice */
    st_slice *slice;
    /* How many parts of the slice are written by the transaction in progress, in which the row of
     * the stage has the key `new_key`. */
    size_t writing;
    int64_t new_key;
    bool waits; /* true if the slice is full and waits for the commit thread */
    st_status status;
    st_stage *next; /* the next stage whose slice waits */
    /* The members from `incarnation` on are set only if the item is a rebase, which makes a staged
     * content the base of a mesh. */
    uint64_t incarnation, number, revision, needed;
    double time;
    unsigned char facts[ST_FRAME_HEAD];
    size_t facts_size;
};

/* --- the commit thread's cache of mesh rows --- */

/* The cached row of a mesh, so that the row need not be read for each record. */
typedef struct st_head {
    st_mesh_row row; /* the row; if its key is 0, this slot of the cache is empty */
    bool dirty;      /* true if the row on the disk is older than this cached row */
    bool made;       /* true if the mesh has no row on the disk yet */
    bool listed;
    /* next head in the list of heads to be written; the list has all dirty heads, and some that are
     * no longer dirty */
    struct st_head *next;
} st_head;

enum { ST_HEADS = 512 };

typedef struct st_heads {
    st_head slots[ST_HEADS]; /* a hash table by incarnation */
    st_head *dirty;
} st_heads;

typedef enum st_write_mode { ST_WRITES, ST_WRITES_FULL, ST_WRITES_FAILED } st_write_mode;

/* --- connections that read --- */

/* Number of connections that load meshes, and so the most meshes that are loaded at the same
 * time. */
enum { ST_LOADS = 2 };

/* How many findings of damage are remembered; the oldest are dropped. While a finding is
 * remembered, the mesh's card shows the damage even before the damage is committed to the mesh's
 * row. A journal that only reads never commits findings. */
enum { ST_FINDINGS = 64 };

/* When a damaged file is searched for meshes by the keys of their rows, the keys of the last
 * ST_SALVAGE_PAGE listed meshes are remembered. */
enum { ST_SALVAGE_PAGE = 64 };

typedef struct st_salvager {
    bool on;
    int64_t last; /* key of the mesh that was listed last */
    size_t count;
    struct {
        int64_t key;
        char id[ST_MESH_ID + 1];
    } page[ST_SALVAGE_PAGE];
} st_salvager;

typedef struct st_load_slot {
    st_db db;
    bool taken;
} st_load_slot;

struct st_sqlite {
    st_folder folder;
    st_identity identity;
    /* Random number of this process. Rows of contents that the process writes in advance contain
     * this number. */
    uint64_t process;
    uint64_t queue_bytes; /* most bytes of the queue */
    uint64_t most_keys;   /* most rows of the table `kept`, which has the Idempotency-Keys */
    pthread_t thread;
    bool has_thread;
    bool only_reads; /* the journal only reads */

    /* --- shared by threads, guarded by `lock` --- */
    pthread_mutex_t lock;
    pthread_cond_t work; /* signalled when the commit thread has work */
    /* signalled when the commit thread has done something that other threads wait for */
    pthread_cond_t moved;
    bool closing;
    st_write_mode mode;
    uint64_t fulls; /* how often the disk became full */
    /* Number of damaged rows of the table `kept`, counted each time one is found. */
    uint64_t damaged_keys;
    char refusal[ST_HEALTH_TEXT]; /* the system's message about the failure, if the disk failed */
    /* true if records or notes were lost, and not all losses are reported to the listener yet */
    bool losing;
    uint64_t generation;
    /* rooms: how many rooms are reserved; old_rooms: how many of these were reserved before the
     * last loss, in an older generation. */
    size_t rooms, old_rooms;
    uint64_t charged;      /* bytes of all rooms that are reserved or queued */
    st_item *first, **end; /* the queue */
    st_stage *stages;      /* list of stages that wait to be written, the oldest first */
    uint64_t newest;       /* the highest position that was assigned to a record or note */
    /* Position up to which every record is durable or was reported to the listener as lost. */
    uint64_t told;
    uint64_t meshes;  /* number of meshes, creations and removals in the queue included */
    uint64_t lost;    /* number of records and notes that were lost */
    unsigned waiting; /* number of threads that wait for the condition `moved` */
    bool idle;        /* true if the commit thread waits for work */
    /* True if loads must wait until the write-ahead log was copied into the database. */
    bool log_is_long;
    st_load_slot loads[ST_LOADS];
    unsigned loads_taken;
    st_finding findings[ST_FINDINGS];
    unsigned last_finding;

    /* Measurements that the commit thread writes and any thread may read. */
    st_histogram syncs, commits, groups, checkpoints;

    pthread_mutex_t telling; /* a mutex that is locked while the listener is called */
    bool is_heard;
    st_journal_listener listener;

    pthread_mutex_t cards_lock;
    st_db cards; /* the connection that reads cards of single meshes and lists of cards */
    st_salvager salvage;

    /* --- used by the commit thread only --- */
    st_db db;
    st_heads heads;
    /* the row of the last commit: number of commits, newest position and number of meshes */
    st_progress progress;
    /* `last_mesh` and `last_snapshot` are the highest keys of rows in the tables of meshes and
     * snapshots */
    int64_t last_mesh, last_snapshot;
    /* The number of pages of the write-ahead log after the last commit. Other threads may read
     * it. */
    _Atomic uint64_t log_pages;
    /* Number of pages of the write-ahead log at the last checkpoint, even if that did not copy all
     * of them; 0 once the log is written from its start again. */
    uint64_t log_tried;
    /* An upper bound of the present number of rows of the table `kept` (Idempotency-Keys). */
    uint64_t keys;
    bool purged; /* true if nothing is left to be purged (deleted) */
    /* `purging` is the row of the table `purge` that is worked on, `stuck` the row whose deletions
     * met damaged rows; a kind of 0 means that there is no such row. */
    st_purge_row purging, stuck;
    bool purge_damaged; /* true if the last slice of deletions (purge) met damaged rows */
    /* True if the table `purge` itself is damaged, so that nothing more is purged. */
    bool purge_ended;
};

/* --- sqlite_queue.c --- */
st_status st_sqlite_reserve(void *self, const st_room_need *need, st_room **out);
void st_sqlite_leave(void *self, st_room *room);
uint64_t st_sqlite_append(void *self, st_room *room, const st_record *records, size_t count);
uint64_t st_sqlite_count(void *self);
void st_sqlite_health(void *self, st_health *out);
void st_sqlite_measure(void *self, st_journal_measures *out);
void st_sqlite_listen(void *self, const st_journal_listener *listener);
/* Copies the Idempotency-Key of a request, with the state of its answer, into the room. */
void st_room_key(st_sqlite_room *room, const st_kept_key *key);
/* Queues the room for the commit thread, and assigns it the next `positions` positions. Returns the
 * last of these positions. */
uint64_t st_room_push(st_sqlite *self, st_sqlite_room *room, uint64_t positions);
/* Appends an item to the queue of the commit thread. The caller holds self->lock. */
void st_queue_put(st_sqlite *self, st_item *item);
st_sqlite_room *st_room_of(st_item *item);
/* Frees a room that was committed or lost, and subtracts its bytes from those of the queue. The
 * caller holds self->lock. */
void st_room_done(st_sqlite *self, st_sqlite_room *room);
/* Waits until every record and note that was appended before this call is durable or was reported
 * as lost. */
void st_queue_settle(st_sqlite *self);

/* --- sqlite_commit.c --- */
void *st_commit_thread(void *self);
/* A function that SQLite calls after each commit with the number of pages of the write-ahead
 * log. */
int st_commit_log_grew(void *self, sqlite3 *db, const char *name, int pages);

/* --- sqlite_rows.c: functions to be called within a transaction --- */
extern const char *const st_writer_texts[];
enum st_writer_statement {
    ST_SQL_BEGIN,
    ST_SQL_COMMIT,
    ST_SQL_ROLLBACK,
    ST_SQL_MESH,
    ST_SQL_MESH_MAKE,
    ST_SQL_MESH_PUT,
    ST_SQL_MESH_DELETE,
    ST_SQL_RECORD,
    ST_SQL_RECORD_MAKE,
    ST_SQL_RECORDS_FIRST,
    ST_SQL_RECORDS_DELETE,
    ST_SQL_SNAPSHOT_MAKE,
    ST_SQL_SNAPSHOT_DELETE,
    ST_SQL_SNAPSHOTS_BEFORE,
    ST_SQL_SNAPSHOTS_FROM,
    ST_SQL_PART_MAKE,
    ST_SQL_PARTS_DELETE,
    ST_SQL_PURGE_MAKE,
    ST_SQL_PURGE_ALL,
    ST_SQL_PURGE_DELETE,
    ST_SQL_KEPT_MAKE,
    ST_SQL_KEPT_DELETE,
    ST_SQL_KEPT_TRIM,
    ST_SQL_KEPT_OLDEST,
    ST_SQL_KEPT_CUT,
    ST_SQL_JOB,
    ST_SQL_JOB_MAKE,
    ST_SQL_JOB_DONE,
    ST_SQL_JOB_DELETE,
    ST_SQL_JOBS_TRIM,
    ST_SQL_STATE_PUT,
    ST_WRITER_STATEMENTS
};
/* Finds the head (the cached row) of a mesh, or reads the row; *out is NULL if there is no such
 * mesh.
 * Returns ST_SQL_DAMAGED if the row of the mesh is damaged. */
st_sql st_head_find(st_sqlite *self, uint64_t incarnation, st_head **out);
/* Marks the head (the cached row of a mesh) as changed, so that it will be written to the
 * database. */
void st_head_touch(st_sqlite *self, st_head *head);
void st_heads_forget(st_sqlite *self);
/* Writes all heads (cached rows of meshes) that have changed. */
st_sql st_heads_flush(st_sqlite *self);
st_sql st_rows_add_room(st_sqlite *self, st_sqlite_room *room);
st_sql st_rows_condemn(st_sqlite *self, const st_condemned *condemned);

/* --- sqlite_notes.c --- */
st_status st_sqlite_note(void *self, const st_note *note, uint64_t *position);
st_status st_sqlite_jobs(void *self, st_take_job *take, void *context);
/* Stores what the room says about its job (st_job_word). It must be called within a transaction. */
st_sql st_notes_add_job(st_sqlite *self, const st_sqlite_room *room);

/* --- sqlite_stage.c --- */
st_status st_sqlite_stage(void *self, const he_mesh *content, st_stage **out);
st_status st_sqlite_stage_edit(void *self, const unsigned char *bytes, size_t size, st_stage **out);
void st_sqlite_unstage(void *self, st_stage *stage);
void st_sqlite_rebase(void *self, st_stage *stage, const st_record *facts, uint64_t needed);
/* Makes a staged content the content of a record: the row of the stage, which has the key of `row`
 * and belongs to no mesh, is replaced by `row`, which belongs to a mesh. It must be called within a
 * transaction. */
st_sql st_stage_adopt(st_sqlite *self, const st_snapshot_row *row);
st_sql st_stage_rebase(st_sqlite *self, const st_stage *stage);
st_sql st_stage_drop(st_sqlite *self, const st_stage *stage);
/* Writes up to `most` parts of the stage's present slice (group of parts), at least one part. */
st_sql st_stage_write(st_sqlite *self, st_stage *stage, size_t most);
/* Counts the parts that the last transaction wrote; must be called after it was committed. */
void st_stage_written(st_stage *stage);

/* --- sqlite_purge.c: functions to be called within a transaction --- */
st_sql st_purge_add(st_sqlite *self, st_purge_kind kind, int64_t key, uint64_t before);
/* Purges the records and snapshots of a mesh that are before record `base`, from which the mesh is
 * loaded from now on. `is_inline` is true if record `base` itself contains the whole content. */
st_sql st_purge_before(st_sqlite *self, int64_t mesh, uint64_t base, bool is_inline);
/* Purges everything that belongs to a mesh that was removed. */
st_sql st_purge_mesh(st_sqlite *self, int64_t mesh);
/* Deletes about `bytes` bytes of rows that the table `purge` lists. Sets *done when nothing is left
 * to be deleted. */
st_sql st_purge_slice(st_sqlite *self, size_t bytes, bool *done);
/* Must be called after a transaction that met damaged rows. Returns true if these were rows to be
 * purged; the next slice then skips them. */
bool st_purge_gives_up(st_sqlite *self);
/* Deletes contents that an earlier process was writing in advance when it ended. */
st_sql st_purge_dead_stages(st_sqlite *self);

/* --- sqlite_read.c --- */
st_status st_sqlite_open_mesh(void *self, const char *id, st_card *card, st_reader **reader);
st_status st_sqlite_read(st_reader *reader, st_piece *out);
void st_sqlite_shut(st_reader *reader);
void st_sqlite_condemn(st_reader *reader, const char *damage);
st_status st_sqlite_list(void *self, const char *after, st_card *out, size_t limit, size_t *count);
st_status st_sqlite_list_by(void *self, const st_card_page *page, st_card *out, size_t *count);
st_status st_sqlite_holdings(void *self, st_take_holding *take, void *context);
/* Reads the row of a mesh as a card.
 * Returns ST_DAMAGED if the card says that the mesh is damaged, or if the checksum of the row is
 * wrong. */
st_status st_sqlite_read_card(sqlite3_stmt *s, st_mesh_row *row);
/* --- sqlite_salvage.c: functions whose caller must hold cards_lock --- */
/* Lists the next meshes of a damaged file whose rows can be read, at most `limit` and at most
 * ST_SALVAGE_PAGE; lists none after the last mesh. */
st_sql st_salvage_list(st_sqlite *self, bool from_start, st_card *out, size_t limit, size_t *count);
/* Finds the row of one of the meshes that st_salvage_list listed last.
 * Returns ST_SQL_DONE if the mesh is none of these. */
st_sql st_salvage_find(st_sqlite *self, st_db *reader, const char *id, st_mesh_row *out);
/* --- sqlite_keys.c --- */
/* Reads the row of a stored Idempotency-Key into *row; the texts are copied to *texts. Returns
 * false if the checksum is wrong: the key then counts as damaged. */
bool st_kept_row_read(sqlite3_stmt *statement, st_kept_texts *texts, st_kept_row *row);
/* Checks all stored Idempotency-Keys and counts the damaged keys in *out. */
st_sql st_kept_count_damaged(st_db *db, uint64_t *out);
st_status st_sqlite_keys(void *self, const char *id, st_take_key *take, void *context);
/* The next functions open and close the connections to the database that read. */
st_sql st_readers_open(st_sqlite *self, const char *path);
bool st_readers_close(st_sqlite *self);

/* --- sqlite_open.c --- */
void st_sqlite_begun(void *self);
void st_sqlite_close(void *self);
/* Makes the state of an open journal. Returns NULL if memory is out. Freeing the state closes
 * everything that was opened for it. */
st_sqlite *st_sqlite_new(const st_sqlite_options *options);
void st_sqlite_free(st_sqlite *self);
/* Returns a journal that consists of the state `self` and the functions of this folder. */
st_journal st_sqlite_filled(st_sqlite *self);
/* Checks that the database is a store of a version that the program `release` knows. If not, writes
 * a sentence about `path` to `message`. Sets *empty to true if the database has no tables yet. */
bool st_sqlite_check_version(st_db *db, const char *path, const char *release, bool *empty,
                             char message[ST_SQLITE_MESSAGE]);
/* Writes a sentence about a statement that failed on the database at `path` to `message`. Returns
 * false. */
bool st_sqlite_explain(const st_db *db, const char *path, st_sql outcome,
                       char message[ST_SQLITE_MESSAGE]);

/* --- sqlite_backup.c --- */
/* Checks that there is no -wal or -journal file beside the database file, which SQLite would replay
 * into the database. If there is one, the function returns false, and `message` says so and ends
 * with `advice`. */
bool st_sqlite_has_no_log(const char *file, const char *advice, char message[ST_SQLITE_MESSAGE]);

/* --- sqlite_index.c --- */
/* Compares the table of meshes with its indexes; reads the table and each index once.
 * Returns ST_SQL_DAMAGED if the table or an index is damaged, or if they differ. */
st_sql st_index_check(st_sqlite *self);

/* --- sqlite_restore.c --- */
/* Finishes a restore that was interrupted. The caller has locked the folder. */
bool st_sqlite_finish_restore(st_folder *folder);

#endif
