/* sqlite_open.c - opens and closes the store: locks the folder, opens and checks the database, and
 * compares it with the mark of the last commit. */
#include "base/mem.h"
#include "journal/sqlite/sqlite_journal.h"
#include "journal/sqlite/sqlite_state.h"
#include "system/clock.h"
#include "system/random.h"

#include <stdio.h>
#include <string.h>

/* Returns a message about damage of the database: SQLite's own message, or, if SQLite found no
 * error, that a checksum or a value in a row is wrong. */
static const char *damage_of(const st_db *db)
{
    const int code = db->handle == NULL ? SQLITE_OK : sqlite3_errcode(db->handle);
    return code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE
               ? "a table or a row of the store was changed or damaged"
               : st_db_message(db);
}

bool st_sqlite_explain(const st_db *db, const char *path, st_sql outcome,
                       char message[ST_SQLITE_MESSAGE])
{
    switch (outcome) {
    case ST_SQL_DAMAGED:
        return st_refuse(
            message,
            "%.300s is damaged (%s). `hedged --verify` says which meshes are whole, "
            "`hedged --dump` saves them; `hedged --restore` puts a backup in its place",
            path, damage_of(db));
    case ST_SQL_FULL:
        return st_refuse(message, "%.300s: the disk is full, and a store needs a few MiB to start",
                         path);
    case ST_SQL_BUSY:
        return st_refuse(message, "%.300s is locked by another program", path);
    case ST_SQL_NO_MEMORY:
        return st_refuse(message, "no memory to open %.300s", path);
    case ST_SQL_DONE:
    case ST_SQL_ROW:
    case ST_SQL_FAILED:
        break;
    }
    return st_refuse(message, "%.300s cannot be used: %s", path, st_db_message(db));
}

/* --- the database --- */

enum { CACHE_KIB = 8 << 10 };

static st_sql set_up(st_db *db)
{
    static const char *const pragmas[] = {
        /* The settings page_size and auto_vacuum take effect only before the first table is
         * made. */
        "PRAGMA page_size = 4096",
        "PRAGMA auto_vacuum = INCREMENTAL",
        "PRAGMA journal_mode = WAL",
        "PRAGMA synchronous = FULL",
        "PRAGMA wal_autocheckpoint = 0",
        "PRAGMA journal_size_limit = 67108864",
        "PRAGMA cell_size_check = ON",
        /* The file is not mapped into memory, because then a bad sector of the disk would raise
         * SIGBUS. */
        "PRAGMA mmap_size = 0",
    };
    st_sql outcome = st_db_set_cache(db, CACHE_KIB);
    for (size_t i = 0; i < sizeof pragmas / sizeof *pragmas && outcome == ST_SQL_DONE; i++) {
        outcome = st_db_run(db, pragmas[i]);
    }
    return outcome;
}

bool st_sqlite_check_version(st_db *db, const char *path, const char *release, bool *empty,
                             char message[ST_SQLITE_MESSAGE])
{
    int64_t application = 0, version = 0, tables = 0;
    st_sql outcome = st_db_number(db, "PRAGMA application_id", 0, &application);
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_number(db, "PRAGMA user_version", 0, &version);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_number(db, "SELECT count(*) FROM sqlite_schema", 0, &tables);
    }
    if (outcome != ST_SQL_DONE) {
        return st_sqlite_explain(db, path, outcome, message);
    }
    *empty = tables == 0 && application == 0 && version == 0;
    if (!*empty && application != ST_SCHEMA_APPLICATION) {
        return st_refuse(message, "%.300s is not a store of hedged", path);
    }
    return version <= ST_SCHEMA_VERSION ||
           st_refuse(
               message,
               "the tables of %.300s have version %lld, but this hedged%s%s supports them only up "
               "to version %d: start a newer hedged, or restore a backup made by this one",
               path, (long long)version, release[0] == '\0' ? "" : " ", release, ST_SCHEMA_VERSION);
}

static bool make_store(st_sqlite *self, const char *path, const char *release,
                       st_sqlite_opened *out)
{
    /* The file `fresh` is made before the database and says that the store is not complete yet, so
     * that no later start takes an incomplete store for an existing one. */
    if (!st_folder_make(&self->folder, "fresh") || !st_folder_sync(&self->folder)) {
        return st_refuse(out->message, "%s", self->folder.message);
    }
    self->identity = (st_identity){.store = st_random(), .secret = {st_random(), st_random()}};
    (void)snprintf(self->identity.made_by, sizeof self->identity.made_by, "%s", release);
    st_sql outcome = st_schema_make(&self->db, &self->identity);
    if (outcome != ST_SQL_DONE) {
        return st_sqlite_explain(&self->db, path, outcome, out->message);
    }
    return true;
}

/* The mark is a file with the number of the last commit. Checks that the database has every commit
 * up to that number. */
static bool compare_mark(st_sqlite *self, st_sqlite_opened *out)
{
    st_mark mark;
    if (!st_mark_read(&self->folder, &mark)) {
        return true;
    }
    if (mark.store != self->identity.store) {
        return st_refuse(
            out->message,
            "%.300s/hedge.mark does not belong to the hedge.db beside it, but to another store: "
            "put back the two files that belong together, or use `hedged --restore`",
            self->folder.path);
    }
    return mark.commits <= self->progress.commits ||
           st_refuse(
               out->message,
               "%.300s/hedge.db lacks the last %llu of %llu commits: hedge.db-wal is damaged or "
               "missing. Put it back, or restore a backup with `hedged --restore`; to go on "
               "without these commits remove hedge.mark",
               self->folder.path, (unsigned long long)(mark.commits - self->progress.commits),
               (unsigned long long)mark.commits);
}

static bool check_meshes(st_sqlite *self, const char *path, st_sqlite_opened *out)
{
    const st_sql outcome = st_index_check(self);
    return outcome == ST_SQL_DONE || st_sqlite_explain(&self->db, path, outcome, out->message);
}

/* The tables that all meshes share are checked when the store is opened. A mesh whose entry in an
 * index is damaged would seem not to exist, and damage in another shared table would make the first
 * change fail. Records and parts belong to single meshes and are checked when a mesh is loaded. A
 * table with more than CHECKED_ROWS rows is not checked, because that would take too long. */
enum { CHECKED_ROWS = 200000 };

static bool check_table(st_sqlite *self, const char *table, const char *path, st_sqlite_opened *out)
{
    char text[96];
    sqlite3_stmt *s = NULL;
    int64_t rows = 0;
    (void)snprintf(text, sizeof text, "SELECT count(*) FROM (SELECT 1 FROM %s LIMIT %d)", table,
                   CHECKED_ROWS + 1);
    st_sql outcome = st_db_number(&self->db, text, 0, &rows);
    if (outcome != ST_SQL_DONE) {
        return st_sqlite_explain(&self->db, path, outcome, out->message);
    }
    if (rows > CHECKED_ROWS) {
        return true;
    }
    (void)snprintf(text, sizeof text, "PRAGMA integrity_check('%s')", table);
    int code = sqlite3_prepare_v2(self->db.handle, text, -1, &s, NULL);
    code = code == SQLITE_OK ? sqlite3_step(s) : code;
    const char *said = code == SQLITE_ROW ? (const char *)sqlite3_column_text(s, 0) : NULL;
    bool good = said != NULL && strcmp(said, "ok") == 0;
    if (!good) {
        (void)st_sqlite_explain(&self->db, path,
                                said != NULL ? ST_SQL_DAMAGED : st_db_outcome(&self->db, code),
                                out->message);
    }
    sqlite3_finalize(s);
    return good;
}

static bool check_tables(st_sqlite *self, const char *path, st_sqlite_opened *out)
{
    static const char *const names[] = {"meta", "state", "sqlite_sequence", "snapshot", "kept",
                                        "job",  "purge"};
    bool good = true;
    for (size_t i = 0; i < sizeof names / sizeof *names && good; i++) {
        good = check_table(self, names[i], path, out);
    }
    return good;
}

/* Checks the stored Idempotency-Keys. If a key is damaged, a repeated request may be executed
 * twice, so the daemon warns about it when it starts. */
static bool check_keys(st_sqlite *self, const char *path, st_sqlite_opened *out)
{
    const st_sql outcome = st_kept_count_damaged(&self->db, &self->damaged_keys);
    return outcome == ST_SQL_DONE || st_sqlite_explain(&self->db, path, outcome, out->message);
}

/* Finds the highest key that any row of a table ever had. New rows get higher keys, because keys
 * must never be used twice. */
static st_sql last_key(st_db *db, const char *table, int64_t *out)
{
    char text[96];
    int64_t most = 0;
    (void)snprintf(text, sizeof text, "SELECT seq FROM sqlite_sequence WHERE name = '%s'", table);
    st_sql outcome = st_db_number(db, text, 0, out);
    if (outcome == ST_SQL_DONE) {
        (void)snprintf(text, sizeof text, "SELECT max(key) FROM %s", table);
        outcome = st_db_number(db, text, 0, &most);
    }
    return outcome == ST_SQL_DONE && *out < most ? ST_SQL_DAMAGED : outcome;
}

/* Reads the counters with which the commit thread continues: the highest keys of rows, and the
 * number of stored Idempotency-Keys. */
static st_sql read_counts(st_sqlite *self)
{
    int64_t keys = 0;
    st_sql outcome = last_key(&self->db, "mesh", &self->last_mesh);
    if (outcome == ST_SQL_DONE) {
        outcome = last_key(&self->db, "snapshot", &self->last_snapshot);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_number(&self->db, "SELECT count(*) FROM kept", 0, &keys);
    }
    self->keys = (uint64_t)keys;
    return outcome;
}

static bool open_database(st_sqlite *self, const char *release, const char *path,
                          st_sqlite_opened *out)
{
    bool empty = false;
    st_mark mark;
    if (!st_folder_has(&self->folder, "hedge.db") && st_mark_read(&self->folder, &mark)) {
        return st_refuse(
            out->message,
            "%.300s has a hedge.mark but no hedge.db: put it back, or restore a backup with "
            "`hedged --restore`; to begin an empty store remove hedge.mark",
            self->folder.path);
    }
    /* The database file is made first, with the right permissions, because SQLite gives the files
     * -wal and -shm the permissions of the database file. */
    if (!st_folder_has(&self->folder, "hedge.db") && !st_folder_make(&self->folder, "hedge.db")) {
        return st_refuse(out->message, "%s", self->folder.message);
    }
    st_sql outcome =
        st_db_open(&self->db, path, SQLITE_OPEN_READWRITE, st_writer_texts, ST_WRITER_STATEMENTS);
    if (outcome != ST_SQL_DONE) {
        return st_sqlite_explain(&self->db, path, outcome, out->message);
    }
    if (!st_sqlite_check_version(&self->db, path, release, &empty, out->message)) {
        return false;
    }
    outcome = set_up(&self->db);
    if (outcome != ST_SQL_DONE) {
        return st_sqlite_explain(&self->db, path, outcome, out->message);
    }
    if (empty && !make_store(self, path, release, out)) {
        return false;
    }
    outcome = st_schema_check(&self->db);
    if (outcome == ST_SQL_DONE) {
        outcome = st_schema_raise(&self->db);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_identity_read(&self->db, &self->identity);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_progress_read(&self->db, &self->progress);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = read_counts(self);
    }
    return (outcome == ST_SQL_DONE || st_sqlite_explain(&self->db, path, outcome, out->message)) &&
           compare_mark(self, out) && check_meshes(self, path, out) &&
           check_tables(self, path, out) && check_keys(self, path, out);
}

/* Cleans up after the last process that had opened the store: copies its write-ahead log into the
 * database, and deletes mesh data that it had written for records that were never published. */
static bool clean_up(st_sqlite *self, const char *path, st_sqlite_opened *out)
{
    int code =
        sqlite3_wal_checkpoint_v2(self->db.handle, NULL, SQLITE_CHECKPOINT_PASSIVE, NULL, NULL);
    st_sql outcome = st_db_outcome(&self->db, code);
    if (outcome == ST_SQL_DONE || outcome == ST_SQL_FULL || outcome == ST_SQL_BUSY) {
        outcome = st_db_do(&self->db, ST_SQL_BEGIN, "");
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_purge_dead_stages(self);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_do(&self->db, ST_SQL_COMMIT, "");
    }
    if (outcome != ST_SQL_DONE) {
        return st_sqlite_explain(&self->db, path, outcome, out->message);
    }
    const st_mark mark = {self->identity.store, self->progress.commits, self->progress.position};
    /* The folder and its files may be new, so the folder is synced. */
    return (st_mark_write(&self->folder, &mark) && st_mark_sync(&self->folder) &&
            st_folder_sync(&self->folder)) ||
           st_refuse(out->message, "%s", self->folder.message);
}

/* --- the journal --- */

static bool start_thread(st_sqlite *self, st_sqlite_opened *out)
{
    self->newest = self->told = self->progress.position;
    self->meshes = self->progress.meshes;
    sqlite3_wal_hook(self->db.handle, st_commit_log_grew, self);
    self->has_thread = pthread_create(&self->thread, NULL, st_commit_thread, self) == 0;
    if (!self->has_thread) {
        return st_refuse(out->message, "the threads of the store cannot be started");
    }
    return true;
}

void st_sqlite_free(st_sqlite *self)
{
    (void)st_readers_close(self);
    (void)st_db_close(&self->db);
    st_folder_close(&self->folder);
    pthread_mutex_destroy(&self->lock);
    pthread_mutex_destroy(&self->telling);
    pthread_mutex_destroy(&self->cards_lock);
    pthread_cond_destroy(&self->work);
    pthread_cond_destroy(&self->moved);
    he_mem_free(self);
}

void st_sqlite_begun(void *context)
{
    st_sqlite *self = context;
    st_queue_settle(self);
    pthread_mutex_lock(&self->lock);
    const bool kept = self->mode == ST_WRITES;
    pthread_mutex_unlock(&self->lock);
    if (kept && st_folder_finds(&self->folder, "fresh")) {
        (void)st_folder_drop(&self->folder, "fresh");
    }
}

void st_sqlite_close(void *context)
{
    st_sqlite *self = context;
    pthread_mutex_lock(&self->lock);
    self->closing = true;
    pthread_cond_signal(&self->work);
    pthread_mutex_unlock(&self->lock);
    if (self->has_thread) {
        pthread_join(self->thread, NULL);
    }
    st_sqlite_free(self);
}

st_sqlite *st_sqlite_new(const st_sqlite_options *options)
{
    st_sqlite *self = he_mem_zero(1, sizeof *self);
    if (self == NULL) {
        return NULL;
    }
    self->folder = (st_folder){.folder = -1, .lock = -1, .mark = -1};
    self->queue_bytes = options->queue_bytes == 0 ? ST_SQLITE_QUEUE : options->queue_bytes;
    self->most_keys = options->keys == 0 ? ST_SQLITE_KEYS : options->keys;
    self->process = st_random();
    self->end = &self->first;
    pthread_mutex_init(&self->lock, NULL);
    pthread_mutex_init(&self->telling, NULL);
    pthread_mutex_init(&self->cards_lock, NULL);
    st_clock_condition(&self->work);
    pthread_cond_init(&self->moved, NULL);
    return self;
}

static bool open_all(st_sqlite *self, const st_sqlite_options *options, st_sqlite_opened *out)
{
    char path[PATH_MAX];
    if (!st_folder_open(&self->folder, options->folder)) {
        return st_refuse(out->message, "%s", self->folder.message);
    }
    const bool full = st_ballast_drop_for_start(&self->folder);
    if (!st_sqlite_finish_restore(&self->folder) || !st_mark_open(&self->folder)) {
        return st_refuse(out->message, "%s", self->folder.message);
    }
    if (!st_folder_path(&self->folder, "hedge.db", path)) {
        return st_refuse(out->message, "the path of the store is too long");
    }
    if (!open_database(self, options->release, path, out) || !clean_up(self, path, out)) {
        return false;
    }
    /* The store also works without the ballast, a file that reserves disk space. But if a user
     * removed the ballast so that the daemon can start, the disk counts as full: only removals of
     * meshes may use the freed space. */
    if (!st_ballast_make(&self->folder) && full) {
        self->mode = ST_WRITES_FULL;
        self->fulls = 1;
    }
    st_sql outcome = st_readers_open(self, path);
    return outcome == ST_SQL_DONE ? start_thread(self, out)
                                  : st_sqlite_explain(&self->db, path, outcome, out->message);
}

st_journal st_sqlite_filled(st_sqlite *self)
{
    return (st_journal){.self = self,
                        .keeps = true,
                        .secret = {self->identity.secret[0], self->identity.secret[1]},
                        .reserve = st_sqlite_reserve,
                        .leave = st_sqlite_leave,
                        .append = st_sqlite_append,
                        .note = st_sqlite_note,
                        .stage = st_sqlite_stage,
                        .stage_edit = st_sqlite_stage_edit,
                        .unstage = st_sqlite_unstage,
                        .rebase = st_sqlite_rebase,
                        .open = st_sqlite_open_mesh,
                        .read = st_sqlite_read,
                        .shut = st_sqlite_shut,
                        .condemn = st_sqlite_condemn,
                        .list = st_sqlite_list,
                        .list_by = st_sqlite_list_by,
                        .keys = st_sqlite_keys,
                        .jobs = st_sqlite_jobs,
                        .holdings = st_sqlite_holdings,
                        .count = st_sqlite_count,
                        .health = st_sqlite_health,
                        .measure = st_sqlite_measure,
                        .begun = st_sqlite_begun,
                        .listen = st_sqlite_listen,
                        .close = st_sqlite_close};
}

bool st_sqlite_open(const st_sqlite_options *options, st_sqlite_opened *out)
{
    *out = (st_sqlite_opened){.made = false};
    st_sqlite *self = st_db_prepare() ? st_sqlite_new(options) : NULL;
    if (self == NULL) {
        return st_refuse(out->message, "no memory to open %s", options->folder);
    }
    if (!open_all(self, options, out)) {
        st_sqlite_free(self);
        return false;
    }
    (void)snprintf(out->message, sizeof out->message, "%s", st_folder_doubt(&self->folder));
    out->made = st_folder_finds(&self->folder, "fresh");
    out->journal = st_sqlite_filled(self);
    return true;
}

const char *st_sqlite_library(void)
{
    return sqlite3_libversion();
}
