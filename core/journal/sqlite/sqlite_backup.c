#include "journal/sqlite/sqlite_backup.h"

#include "journal/sqlite/sqlite_state.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

static bool exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

/* --- files that no process writes to --- */

/* Makes a URI by which SQLite opens the file as immutable, so that SQLite makes neither a lock nor
 * a -shm file. If there is a write-ahead log (-wal) beside the file, the URI does not say
 * immutable, because SQLite must read the log, too. */
static bool uri_of(const char *file, char *out, size_t size)
{
    static const char hex[] = "0123456789ABCDEF";
    char log[PATH_MAX];
    size_t at = (size_t)snprintf(out, size, "file:");
    for (const char *c = file; *c != '\0' && at + 4 < size; c++) {
        if (strchr("%?#", *c) != NULL) {
            out[at++] = '%';
            out[at++] = hex[(unsigned char)*c >> 4];
            out[at++] = hex[(unsigned char)*c & 15];
        } else {
            out[at++] = *c;
        }
    }
    int length = snprintf(log, sizeof log, "%s-wal", file);
    const char *end = exists(log) ? "" : "?immutable=1";
    if (length < 0 || (size_t)length >= sizeof log || at + strlen(end) + 4 >= size) {
        return false;
    }
    memcpy(out + at, end, strlen(end) + 1);
    return true;
}

static bool open_file(st_db *db, const char *file, char message[ST_SQLITE_MESSAGE])
{
    char uri[3 * PATH_MAX];
    *db = (st_db){.texts = NULL};
    if (!exists(file)) {
        return st_refuse(message, "%.300s: %s", file, strerror(errno));
    }
    if (!uri_of(file, uri, sizeof uri)) {
        return st_refuse(message, "the path of the file is too long");
    }
    st_sql outcome = st_db_open(db, uri, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, NULL, 0);
    return outcome == ST_SQL_DONE || st_sqlite_explain(db, file, outcome, message);
}

/* Checks the structure of a database. If SQLite finds faults, the first of them is described in
 * `message`. */
static bool check_structure(st_db *db, const char *file, char message[ST_SQLITE_MESSAGE])
{
    sqlite3_stmt *s = NULL;
    int code = sqlite3_prepare_v2(db->handle, "PRAGMA integrity_check(1)", -1, &s, NULL);
    if (code == SQLITE_OK) {
        code = sqlite3_step(s);
    }
    const char *said = code == SQLITE_ROW ? (const char *)sqlite3_column_text(s, 0) : NULL;
    bool good = said != NULL && strcmp(said, "ok") == 0;
    if (!good && said != NULL) {
        (void)st_refuse(message, "%.300s is damaged: %.200s", file, said);
    } else if (!good) {
        (void)st_sqlite_explain(db, file, st_db_outcome(db, code), message);
    }
    sqlite3_finalize(s);
    return good;
}

static bool check_store(st_db *db, const char *file, char message[ST_SQLITE_MESSAGE])
{
    bool empty;
    st_identity identity;
    st_progress progress;
    if (!st_sqlite_check_version(db, file, "", &empty, message)) {
        return false;
    }
    if (empty) {
        return st_refuse(message, "%.300s is not a store of hedged", file);
    }
    if (!check_structure(db, file, message)) {
        return false;
    }
    st_sql outcome = st_identity_read(db, &identity);
    if (outcome == ST_SQL_DONE) {
        outcome = st_progress_read(db, &progress);
    }
    return outcome == ST_SQL_DONE || st_sqlite_explain(db, file, outcome, message);
}

bool st_sqlite_check_file(const char *file, char message[ST_SQLITE_MESSAGE])
{
    st_db db;
    if (!st_db_prepare()) {
        return st_refuse(message, "no memory to open %.300s", file);
    }
    bool good = open_file(&db, file, message) && check_store(&db, file, message);
    (void)st_db_close(&db);
    return good;
}

/* --- backup --- */

bool st_sqlite_has_no_log(const char *file, const char *advice, char message[ST_SQLITE_MESSAGE])
{
    static const char *const ends[] = {"-wal", "-journal"};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        char log[PATH_MAX];
        struct stat status;
        int length = snprintf(log, sizeof log, "%s%s", file, ends[i]);
        if (length < 0 || (size_t)length >= sizeof log) {
            return st_refuse(message, "the path of the file is too long");
        }
        if (stat(log, &status) == 0 && status.st_size > 0) {
            return st_refuse(message,
                             "%.300s cannot be used, because SQLite left a log beside it (%s): %s",
                             file, ends[i], advice);
        }
    }
    return true;
}

/* The names of the files that a store's folder may contain. */
static const char *const own_names[] = {
    "hedge.db",         "hedge.db-wal",    "hedge.db-shm",
    "hedge.db-journal", "hedge.mark",      "lock",
    "ballast",          "restoring",       "restored.db",
    "restored.db-wal",  "restored.db-shm", "restored.db-journal"};
enum { OWN_NAMES = sizeof own_names / sizeof *own_names };

static bool names_file_of(const char *folder, const char *own, const struct stat *status)
{
    char path[PATH_MAX];
    struct stat there;
    int length = snprintf(path, sizeof path, "%s/%s", folder, own);
    return length > 0 && length < PATH_MAX && stat(path, &there) == 0 &&
           there.st_dev == status->st_dev && there.st_ino == status->st_ino;
}

/* Returns false if the backup would overwrite a file of the store that is copied, even if `file`
 * names it by another path, or of another store in the folder of the backup. */
static bool may_be_backup(const char *store, const char *file, char message[ST_SQLITE_MESSAGE])
{
    char folder[PATH_MAX], database[PATH_MAX];
    struct stat status;
    const char *slash = strrchr(file, '/'), *name = slash == NULL ? file : slash + 1;
    st_folder_above(file, folder);
    const bool there = stat(file, &status) == 0;
    int length = snprintf(database, sizeof database, "%s/hedge.db", folder);
    const bool in_store = length > 0 && length < PATH_MAX && exists(database);
    for (size_t i = 0; i < OWN_NAMES; i++) {
        if ((in_store && strcmp(name, own_names[i]) == 0) ||
            (there && names_file_of(store, own_names[i], &status))) {
            return st_refuse(message,
                             "%.300s is the file %s of a store: give the backup another name", file,
                             own_names[i]);
        }
    }
    return st_sqlite_has_no_log(file,
                                "SQLite would write the changes in this log into the backup; "
                                "remove the log, or choose another file",
                                message);
}

/* The free disk space that must be left after a backup, because the daemon goes on writing to its
 * store. */
enum { SPARE_BYTES = 64 << 20 };

static bool has_space(st_db *from, const char *file, char message[ST_SQLITE_MESSAGE])
{
    char folder[PATH_MAX];
    struct statvfs system;
    int64_t pages = 0;
    st_folder_above(file, folder);
    if (st_db_number(from, "PRAGMA page_count", 0, &pages) != ST_SQL_DONE ||
        statvfs(folder, &system) != 0) {
        /* The free space is unknown, so the backup is tried; if the space is too small, writing
         * fails. */
        return true;
    }
    const uint64_t need = (uint64_t)pages * 4096 + SPARE_BYTES;
    const uint64_t there = (uint64_t)system.f_bavail * system.f_frsize;
    return there >= need ||
           st_refuse(message, "%.300s: a backup needs %llu MiB, and %llu MiB are free", file,
                     (unsigned long long)(need >> 20), (unsigned long long)(there >> 20));
}

static bool copy_pages(st_db *from, const char *part, char message[ST_SQLITE_MESSAGE])
{
    st_db to;
    st_sql outcome = st_db_open(&to, part, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, NULL, 0);
    /* If the backup fails, its file is deleted. So the file needs no rollback journal, and only one
     * sync at the end. */
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_run(&to, "PRAGMA journal_mode = OFF");
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_run(&to, "PRAGMA synchronous = OFF");
    }
    if (outcome == ST_SQL_DONE) {
        sqlite3_backup *backup = sqlite3_backup_init(to.handle, "main", from->handle, "main");
        /* All pages are copied in a single step, so that the copy shows the store at one moment
         * although other connections write to it. */
        (void)(backup != NULL && sqlite3_backup_step(backup, -1));
        outcome = st_db_outcome(&to, backup == NULL ? sqlite3_extended_errcode(to.handle)
                                                    : sqlite3_backup_finish(backup));
    }
    bool good = outcome == ST_SQL_DONE || st_sqlite_explain(&to, part, outcome, message);
    return st_db_close(&to) && good;
}

static bool sync_path(const char *path, int flags, char message[ST_SQLITE_MESSAGE])
{
    int file = open(path, flags | O_RDONLY | O_CLOEXEC);
    bool good = file >= 0 && fsync(file) == 0;
    if (!good) {
        (void)st_refuse(message, "cannot sync %.300s: %s", path, strerror(errno));
    }
    if (file >= 0) {
        (void)close(file);
    }
    return good;
}

static bool finish(const char *part, const char *file, char message[ST_SQLITE_MESSAGE])
{
    char folder[PATH_MAX];
    st_folder_above(file, folder);
    if (rename(part, file) != 0) {
        return st_refuse(message, "cannot rename %.300s: %s", part, strerror(errno));
    }
    return sync_path(folder, O_DIRECTORY, message);
}

/* Makes an empty file that only its owner may read. */
static bool begin_part(const char *part, char message[ST_SQLITE_MESSAGE])
{
    int file = open(part, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (file < 0) {
        return st_refuse(message, "cannot make %.300s: %s", part, strerror(errno));
    }
    (void)close(file);
    return true;
}

bool st_sqlite_backup(const char *folder, const char *file, char message[ST_SQLITE_MESSAGE])
{
    char path[PATH_MAX], part[PATH_MAX];
    st_db from;
    bool empty;
    int length = snprintf(path, sizeof path, "%s/hedge.db", folder);
    int part_length = snprintf(part, sizeof part, "%s.part", file);
    if (length >= PATH_MAX || part_length >= PATH_MAX || !st_db_prepare()) {
        return st_refuse(message, "a path is too long, or there is no memory");
    }
    if (!exists(path)) {
        return st_refuse(message, "%.300s: %s", path, strerror(errno));
    }
    if (!may_be_backup(folder, file, message)) {
        return false;
    }
    st_sql outcome = st_db_open(&from, path, SQLITE_OPEN_READONLY, NULL, 0);
    bool good = (outcome == ST_SQL_DONE || st_sqlite_explain(&from, path, outcome, message)) &&
                st_sqlite_check_version(&from, path, "", &empty, message) &&
                has_space(&from, file, message) && begin_part(part, message) &&
                copy_pages(&from, part, message);
    (void)st_db_close(&from);
    good = good && sync_path(part, 0, message) && st_sqlite_check_file(part, message) &&
           finish(part, file, message);
    if (!good) {
        (void)unlink(part);
    }
    return good;
}

/* --- journals that only read a store --- */

static bool open_readers(st_sqlite *self, const char *path, st_sqlite_opened *out)
{
    char file[PATH_MAX], uri[3 * PATH_MAX];
    struct stat status;
    bool empty;
    if (stat(path, &status) != 0) {
        return st_refuse(out->message, "%.300s: %s", path, strerror(errno));
    }
    const bool is_folder = S_ISDIR(status.st_mode);
    int length = snprintf(file, sizeof file, is_folder ? "%s/hedge.db" : "%s", path);
    if (length >= PATH_MAX || !uri_of(file, uri, sizeof uri)) {
        return st_refuse(out->message, "the path of the store is too long");
    }
    st_sql outcome = st_readers_open(self, is_folder ? file : uri);
    if (outcome != ST_SQL_DONE) {
        return st_sqlite_explain(&self->cards, file, outcome, out->message);
    }
    if (!st_sqlite_check_version(&self->cards, file, "", &empty, out->message)) {
        return false;
    }
    if (empty) {
        return st_refuse(out->message, "%.300s is not a store of hedged", file);
    }
    if (st_progress_read(&self->cards, &self->progress) == ST_SQL_DONE) {
        self->meshes = self->progress.meshes;
    }
    return true;
}

bool st_sqlite_look(const char *path, st_sqlite_opened *out)
{
    *out = (st_sqlite_opened){.made = false};
    st_sqlite *self = st_db_prepare() ? st_sqlite_new(&(st_sqlite_options){.folder = path}) : NULL;
    if (self == NULL) {
        return st_refuse(out->message, "no memory to open %.300s", path);
    }
    self->only_reads = true;
    self->mode = ST_WRITES_FAILED;
    if (!open_readers(self, path, out)) {
        st_sqlite_free(self);
        return false;
    }
    out->journal = st_sqlite_filled(self);
    return true;
}
