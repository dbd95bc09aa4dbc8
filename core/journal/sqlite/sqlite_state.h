/* sqlite_state.h - the journal of sqlite_journal.h from inside, for core/journal/sqlite only.
 *
 *     sqlite_queue.c    reserve, append: rooms on their way to the commit thread
 *     sqlite_commit.c   the commit thread: groups, checkpoints, what happens when the disk says no
 *     sqlite_rows.c     what a record changes in the tables
 *     sqlite_notes.c    jobs, and keys of requests that changed nothing
 *     sqlite_stage.c    contents in parts, and which of them a mesh is loaded from
 *     sqlite_purge.c    what is no longer needed is deleted by the slice
 *     sqlite_read.c     meshes are read again
 *     sqlite_salvage.c  also from a file whose structure is damaged
 *     sqlite_index.c    the table of meshes and its indexes are compared at the start
 *     sqlite_open.c     the start and the end
 *
 * One mutex guards what threads share (`shared` below); the writing connection and all that it
 * knows belongs to the commit thread. */
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

/* --- what is queued --- */

typedef enum st_item_kind {
    ST_ITEM_ROOM,    /* a group of records */
    ST_ITEM_REBASE,  /* a stage becomes a base */
    ST_ITEM_UNSTAGE, /* a stage that nobody wants */
    ST_ITEM_CONDEMN  /* a card says what is wrong */
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
    unsigned char *frame; /* but for chain and sum */
    size_t size;
    st_stage *stage;
    bool staged_edit;
} st_queued;

/* What a room says of a job. */
typedef enum st_job_word {
    ST_JOB_UNNAMED,
    ST_JOB_WORK,  /* that its records are the work of the job */
    ST_JOB_IS,    /* how it is */
    ST_JOB_LEAVES /* that it is kept no longer */
} st_job_word;

/* Allocated in one piece with entries, heads of frames and bytes. One without records is a note. */
typedef struct st_sqlite_room {
    st_room room; /* what others see of it */
    st_item item;
    uint64_t generation; /* in which it was reserved */
    size_t charge;       /* bytes of the queue that it takes */
    bool freeing;
    size_t most, count; /* records */
    uint64_t last;      /* position of the last of them, or of the note */
    uint64_t meshes;    /* that they make, less those that they remove */
    st_card card;       /* of the mesh after them */
    bool has_key;
    st_kept_row key; /* its texts are those here */
    char key_text[ST_KEY_TEXT + 1], key_holder[ST_KEY_HOLDER + 1];
    st_job_word job_word;
    st_job
        job; /* its texts and body lie in the room's bytes; of WORK what the records tell of it */
    unsigned char *heads; /* ST_FRAME_HEAD bytes for each record */
    st_queued entries[];
} st_sqlite_room;

/* What is wrong with a mesh as it is loaded from that base. */
typedef struct st_finding {
    uint64_t incarnation, base;
    char damage[ST_DAMAGE];
} st_finding;

typedef struct st_condemned {
    st_item item;
    st_finding finding;
} st_condemned;

/* Parts on their way to the disk, a slice at a time. */
enum { ST_SLICE_PARTS = 16 };

typedef struct st_slice {
    size_t count, written;
    size_t sizes[ST_SLICE_PARTS];
    unsigned char bytes[ST_SLICE_PARTS][ST_PART_HEAD + HE_STORED_PART_ROOM];
} st_slice;

struct st_stage {
    st_item item;
    int64_t key;    /* of the snapshot's row, 0 before there is one */
    uint64_t parts; /* that it has, and that were written */
    uint64_t written;
    st_slice *slice; /* NULL once all were */
    size_t writing;  /* parts of it in the transaction at hand, in which the key is new_key */
    int64_t new_key;
    bool waits; /* its slice is to be written */
    st_status status;
    st_stage *next; /* of those that wait */
    /* Set where the item is a rebase. */
    uint64_t incarnation, number, revision, needed;
    double time;
    unsigned char facts[ST_FRAME_HEAD];
    size_t facts_size;
};

/* --- what the commit thread knows of meshes --- */

/* A mesh that was written to, so that its row need not be read for each record. */
typedef struct st_head {
    st_mesh_row row; /* key 0: nothing is here */
    bool dirty;      /* the row on disk is older, */
    bool made;       /* or not there */
    bool listed;
    struct st_head *next; /* of those listed: all that are dirty, and others */
} st_head;

enum { ST_HEADS = 512 };

typedef struct st_heads {
    st_head slots[ST_HEADS]; /* by incarnation */
    st_head *dirty;
} st_heads;

typedef enum st_write_mode { ST_WRITES, ST_WRITES_FULL, ST_WRITES_FAILED } st_write_mode;

/* --- connections that read --- */

enum { ST_LOADS = 2 }; /* at once */

/* Of what was found wrong a mesh's row says so only once that was committed, and never where
 * nothing is written. The oldest are forgotten. */
enum { ST_FINDINGS = 64 };

/* A damaged file is walked by keys: the meshes that were listed last are found by theirs. */
enum { ST_SALVAGE_PAGE = 64 };

typedef struct st_salvager {
    bool on;
    int64_t last; /* key that was listed */
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
    uint64_t process;     /* drawn at the start: who stages */
    uint64_t queue_bytes; /* at most */
    uint64_t most_keys;   /* rows of kept */
    pthread_t thread;
    bool has_thread;
    bool only_reads; /* nothing is written, by nobody */

    /* --- shared --- */
    pthread_mutex_t lock;
    pthread_cond_t work;  /* for the commit thread */
    pthread_cond_t moved; /* for those who wait for it */
    bool closing;
    st_write_mode mode;
    uint64_t fulls;               /* how often the disk was found full */
    uint64_t damaged_keys;        /* rows of `kept`, as often as they were found */
    char refusal[ST_HEALTH_TEXT]; /* what the disk said when it failed */
    bool losing;                  /* something was lost, and not all of it was told */
    uint64_t generation;
    size_t rooms, old_rooms; /* that are out; of them, of an older generation */
    uint64_t charged;        /* bytes of rooms, out or queued */
    st_item *first, **end;   /* the queue */
    st_stage *stages;        /* that wait, the oldest first */
    uint64_t newest;         /* position */
    uint64_t told;           /* up to here all is durable or was told as lost */
    uint64_t meshes;         /* there are, with what is queued */
    uint64_t lost;           /* records and notes */
    unsigned waiting;        /* on `moved` */
    bool idle;               /* the commit thread waits */
    bool log_is_long;        /* no load begins until the log was written back */
    st_load_slot loads[ST_LOADS];
    unsigned loads_taken;
    st_finding findings[ST_FINDINGS];
    unsigned last_finding;

    /* Added to by the commit thread, read by any. */
    st_histogram syncs, commits, groups, checkpoints;

    pthread_mutex_t telling; /* held while the listener is called */
    bool is_heard;
    st_journal_listener listener;

    pthread_mutex_t cards_lock;
    st_db cards; /* reads cards and lists */
    st_salvager salvage;

    /* --- the commit thread's --- */
    st_db db;
    st_heads heads;
    st_progress progress;             /* as committed */
    int64_t last_mesh, last_snapshot; /* keys that were given */
    _Atomic uint64_t log_pages;       /* of the -wal, after the last commit; others may read it */
    uint64_t log_tried;               /* pages at the last checkpoint that did not write all back */
    uint64_t keys;                    /* rows of kept, at most */
    bool purged;                      /* nothing is left to be purged */
    st_purge_row purging, stuck;      /* kind 0: none; stuck: what it names is damaged */
    bool purge_damaged;               /* so was what the last slice met */
    bool purge_ended;                 /* what keeps account of it is damaged */
};

/* --- sqlite_queue.c --- */
st_status st_sqlite_reserve(void *self, const st_room_need *need, st_room **out);
void st_sqlite_leave(void *self, st_room *room);
uint64_t st_sqlite_append(void *self, st_room *room, const st_record *records, size_t count);
uint64_t st_sqlite_count(void *self);
void st_sqlite_health(void *self, st_health *out);
void st_sqlite_measure(void *self, st_journal_measures *out);
void st_sqlite_listen(void *self, const st_journal_listener *listener);
/* Fills in what the room says of a key. */
void st_room_key(st_sqlite_room *room, const st_kept_key *key);
/* Queues the room, and gives it so many positions; returns the last. */
uint64_t st_room_push(st_sqlite *self, st_sqlite_room *room, uint64_t positions);
/* Put an item at the end of the queue. Under the lock. */
void st_queue_put(st_sqlite *self, st_item *item);
st_sqlite_room *st_room_of(st_item *item);
/* Frees a room that was committed or lost, and gives back its place. Under the lock. */
void st_room_done(st_sqlite *self, st_sqlite_room *room);
/* Waits until all that was appended before is durable or was told as lost. */
void st_queue_settle(st_sqlite *self);

/* --- sqlite_commit.c --- */
void *st_commit_thread(void *self);
/* The hook of SQLite that tells how long the log is. */
int st_commit_log_grew(void *self, sqlite3 *db, const char *name, int pages);

/* --- sqlite_rows.c: within a transaction --- */
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
/* *out is NULL where there is no such mesh. ST_SQL_DAMAGED where its row is. */
st_sql st_head_find(st_sqlite *self, uint64_t incarnation, st_head **out);
/* The row changed. */
void st_head_touch(st_sqlite *self, st_head *head);
void st_heads_forget(st_sqlite *self);
/* Writes the rows that changed. */
st_sql st_heads_flush(st_sqlite *self);
st_sql st_rows_add_room(st_sqlite *self, st_sqlite_room *room);
st_sql st_rows_condemn(st_sqlite *self, const st_condemned *condemned);

/* --- sqlite_notes.c --- */
st_status st_sqlite_note(void *self, const st_note *note, uint64_t *position);
st_status st_sqlite_jobs(void *self, st_take_job *take, void *context);
/* What the room says of a job. Within a transaction. */
st_sql st_notes_add_job(st_sqlite *self, const st_sqlite_room *room);

/* --- sqlite_stage.c --- */
st_status st_sqlite_stage(void *self, const he_mesh *content, st_stage **out);
st_status st_sqlite_stage_edit(void *self, const unsigned char *bytes, size_t size, st_stage **out);
void st_sqlite_unstage(void *self, st_stage *stage);
void st_sqlite_rebase(void *self, st_stage *stage, const st_record *facts, uint64_t needed);
/* These run within a transaction. What was staged becomes that of a record: its row, whose key is
 * that of the stage, replaces the row that belonged to no mesh. */
st_sql st_stage_adopt(st_sqlite *self, const st_snapshot_row *row);
st_sql st_stage_rebase(st_sqlite *self, const st_stage *stage);
st_sql st_stage_drop(st_sqlite *self, const st_stage *stage);
/* Writes up to `most` parts of the slice, at least one. */
st_sql st_stage_write(st_sqlite *self, st_stage *stage, size_t most);
/* The transaction was committed. */
void st_stage_written(st_stage *stage);

/* --- sqlite_purge.c: within a transaction --- */
st_sql st_purge_add(st_sqlite *self, st_purge_kind kind, int64_t key, uint64_t before);
/* The mesh is loaded from record `base` on: what is before is forgotten. `is_inline`: the record
 * holds the content itself. */
st_sql st_purge_before(st_sqlite *self, int64_t mesh, uint64_t base, bool is_inline);
/* The mesh was removed. */
st_sql st_purge_mesh(st_sqlite *self, int64_t mesh);
/* Deletes about so many bytes; *done when nothing is left. */
st_sql st_purge_slice(st_sqlite *self, size_t bytes, bool *done);
/* After a transaction that met damage: was it in the slice? Then the next one passes it over. */
bool st_purge_gives_up(st_sqlite *self);
/* Deletes contents that were being staged when the process before this one ended. */
st_sql st_purge_dead_stages(st_sqlite *self);

/* --- sqlite_read.c --- */
st_status st_sqlite_open_mesh(void *self, const char *id, st_card *card, st_reader **reader);
st_status st_sqlite_read(st_reader *reader, st_piece *out);
void st_sqlite_shut(st_reader *reader);
void st_sqlite_condemn(st_reader *reader, const char *damage);
st_status st_sqlite_list(void *self, const char *after, st_card *out, size_t limit, size_t *count);
st_status st_sqlite_holdings(void *self, st_take_holding *take, void *context);
/* ST_DAMAGED where the card says so, or its row's sum is wrong. */
st_status st_sqlite_read_card(sqlite3_stmt *s, st_mesh_row *row);
/* --- sqlite_salvage.c, under the lock of cards --- */
/* The next meshes that can be reached, up to `limit` or ST_SALVAGE_PAGE; none after the last. */
st_sql st_salvage_list(st_sqlite *self, bool from_start, st_card *out, size_t limit, size_t *count);
/* One of those that were listed last. ST_SQL_DONE where it is none of them. */
st_sql st_salvage_find(st_sqlite *self, st_db *reader, const char *id, st_mesh_row *out);
/* --- sqlite_keys.c --- */
/* The row's texts lie in `texts`. False where the sum is wrong: such a key is as good as
 * none. */
bool st_kept_row_read(sqlite3_stmt *statement, st_kept_texts *texts, st_kept_row *row);
/* Looks at all keys that are kept: how many are damaged. */
st_sql st_kept_count_damaged(st_db *db, uint64_t *out);
st_status st_sqlite_keys(void *self, const char *id, st_take_key *take, void *context);
/* Opens the connections that read; closes them. */
st_sql st_readers_open(st_sqlite *self, const char *path);
bool st_readers_close(st_sqlite *self);

/* --- sqlite_open.c --- */
void st_sqlite_begun(void *self);
void st_sqlite_close(void *self);
/* NULL when memory is out. Freed with all that was opened for it. */
st_sqlite *st_sqlite_new(const st_sqlite_options *options);
void st_sqlite_free(st_sqlite *self);
st_journal st_sqlite_filled(st_sqlite *self); /* with its functions */
/* Is it a store of a version that `release` knows? Else a sentence about `path`. *empty: it has no
 * tables yet. */
bool st_sqlite_check_version(st_db *db, const char *path, const char *release, bool *empty,
                             char message[ST_SQLITE_MESSAGE]);
/* Writes a sentence about a statement that failed on the database of that name; returns false. */
bool st_sqlite_explain(const st_db *db, const char *path, st_sql outcome,
                       char message[ST_SQLITE_MESSAGE]);

/* --- sqlite_backup.c --- */
/* Has the file nothing of SQLite's beside it that would be played into it? Else says so, with
 * advice. */
bool st_sqlite_has_no_log(const char *file, const char *advice, char message[ST_SQLITE_MESSAGE]);

/* --- sqlite_index.c --- */
/* ST_SQL_DAMAGED where the table of meshes or one of its indexes is, or they differ. Reads each of
 * them once. */
st_sql st_index_check(st_sqlite *self);

/* --- sqlite_restore.c --- */
/* Ends a restore that was interrupted. The folder is locked. */
bool st_sqlite_finish_restore(st_folder *folder);

#endif
