/* sqlite_restore.c - replaces a store by a backup of it, in the steps that sqlite_backup.h
 * lists. */
#include "journal/sqlite/sqlite_backup.h"
#include "journal/sqlite/sqlite_state.h"
#include "system/clock.h"
#include "system/random.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { COPY_BYTES = 1 << 16, NAME_BYTES = 64 };

/* --- the copy of the backup --- */

static bool cannot_read(st_folder *folder, const char *file)
{
    return st_refuse(folder->message, "cannot read %.300s: %s", file, strerror(errno));
}

static bool copy_bytes(st_folder *folder, const char *file, int from, int to)
{
    unsigned char bytes[COPY_BYTES];
    ssize_t got;
    while ((got = read(from, bytes, sizeof bytes)) > 0) {
        for (ssize_t put = 0, n; put < got; put += n) {
            n = write(to, bytes + put, (size_t)(got - put));
            if (n <= 0) {
                return st_folder_fail(folder, "cannot write", "restored.db");
            }
        }
    }
    return got == 0 || cannot_read(folder, file);
}

/* Removes the copy of a backup that an interrupted restore has left. Otherwise SQLite would apply
 * the log of that copy to the next copy. */
static bool remove_copy(st_folder *folder)
{
    static const char *const names[] = {"restored.db-journal", "restored.db-wal", "restored.db-shm",
                                        "restored.db"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (unlinkat(folder->folder, names[i], 0) != 0 && errno != ENOENT) {
            return st_folder_fail(folder, "cannot remove", names[i]);
        }
    }
    return st_folder_sync(folder);
}

static bool copy_file(st_folder *folder, const char *file)
{
    int from = open(file, O_RDONLY | O_CLOEXEC);
    if (from < 0) {
        return cannot_read(folder, file);
    }
    int to = openat(folder->folder, "restored.db", O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    bool good = to >= 0 ? copy_bytes(folder, file, from, to)
                        : st_folder_fail(folder, "cannot make", "restored.db");
    (void)close(from);
    if (to >= 0) {
        (void)close(to);
    }
    return good;
}

/* --- new incarnations --- */

enum { MESHES, MESH_PUT, KEPT, KEPT_PUT, JOB, JOB_PUT, STATEMENTS };
static const char *const texts[STATEMENTS] = {
    [MESHES] = "SELECT " ST_MESH_COLUMNS " FROM mesh WHERE key > ?1 ORDER BY key LIMIT 1",
    [MESH_PUT] = "UPDATE mesh SET incarnation = ?2, sum = ?3 WHERE key = ?1",
    [KEPT] = "SELECT " ST_KEPT_COLUMNS " FROM kept "
             "WHERE (mesh, holder, text) > (?1, ?2, ?3) ORDER BY mesh, holder, text LIMIT 1",
    [KEPT_PUT] = "UPDATE kept SET incarnation = 0, revision = 0, metadata = 0, sum = ?4 "
                 "WHERE mesh = ?1 AND holder = ?2 AND text = ?3",
    [JOB] = "SELECT " ST_JOB_COLUMNS " FROM job WHERE tag <> '' AND id > ?1 ORDER BY id LIMIT 1",
    [JOB_PUT] = "UPDATE job SET tag = '', sum = ?2 WHERE id = ?1",
};

static st_sql draw_incarnations(st_db *db)
{
    int64_t last = 0;
    for (;;) {
        sqlite3_stmt *s;
        st_mesh_row row;
        st_sql outcome = st_db_find(db, MESHES, &s, "i", last);
        if (outcome != ST_SQL_ROW) {
            return outcome;
        }
        const bool good = st_mesh_row_read(s, &row);
        st_db_reset(s);
        row.card.incarnation = st_random();
        /* If the checksum of the row was wrong before this change, it must be wrong afterwards, so
         * that the row still counts as damaged. */
        const uint32_t sum = st_mesh_row_sum(&row) ^ (good ? 0 : 1);
        outcome = st_db_do(db, MESH_PUT, "iii", row.key, row.card.incarnation, (uint64_t)sum);
        if (outcome != ST_SQL_DONE) {
            return outcome;
        }
        last = row.key;
    }
}

/* Removes the ETags from stored answers to requests with an Idempotency-Key, because the revisions
 * that the ETags name may not exist after the restore. */
static st_sql take_tags_of_keys(st_db *db)
{
    st_kept_texts row_texts;
    st_kept_row row = {.mesh = INT64_MIN, .holder = "", .text = ""};
    for (;;) {
        sqlite3_stmt *s;
        st_sql outcome = st_db_find(db, KEPT, &s, "itt", row.mesh, row.holder, row.text);
        if (outcome != ST_SQL_ROW) {
            return outcome;
        }
        const bool good = st_kept_row_read(s, &row_texts, &row);
        st_db_reset(s);
        row.incarnation = row.revision = row.metadata = 0;
        /* If the checksum of the row was wrong before this change, it must be wrong afterwards, so
         * that the row still counts as damaged. */
        const uint32_t sum = st_kept_row_sum(&row) ^ (good ? 0 : 1);
        outcome = st_db_do(db, KEPT_PUT, "itti", row.mesh, row.holder, row.text, (uint64_t)sum);
        if (outcome == ST_SQL_DONE && sqlite3_changes(db->handle) == 0) {
            outcome = ST_SQL_DAMAGED;
        }
        if (outcome != ST_SQL_DONE) {
            return outcome;
        }
    }
}

/* Removes the ETags from the answers of jobs, because the revisions that the ETags name may not
 * exist after the restore. */
static st_sql take_tags_of_jobs(st_db *db)
{
    char last[ST_JOB_ID + 1] = "";
    for (;;) {
        sqlite3_stmt *s;
        st_job job;
        st_sql outcome = st_db_find(db, JOB, &s, "t", last);
        if (outcome != ST_SQL_ROW) {
            return outcome;
        }
        const bool good = st_job_read(s, &job);
        job.headers[ST_JOB_TAG] = "";
        /* If the checksum of the row was wrong before this change, it must be wrong afterwards, so
         * that the row still counts as damaged. */
        const uint32_t sum = st_job_sum(&job) ^ (good ? 0 : 1);
        st_db_reset(s);
        outcome = st_db_do(db, JOB_PUT, "ti", job.id, (uint64_t)sum);
        if (outcome == ST_SQL_DONE && sqlite3_changes(db->handle) == 0) {
            outcome = ST_SQL_DAMAGED;
        }
        if (outcome != ST_SQL_DONE) {
            return outcome;
        }
        memcpy(last, job.id, sizeof last);
    }
}

static st_sql renew(st_db *db)
{
    /* The copy of the backup is taken out of SQLite's WAL mode, so that all its data is in one
     * file. */
    st_sql outcome = st_db_run(db, "PRAGMA journal_mode = DELETE");
    if (outcome == ST_SQL_DONE) {
        outcome = st_schema_raise(db);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = st_db_run(db, "BEGIN IMMEDIATE");
    }
    if (outcome == ST_SQL_DONE) {
        outcome = draw_incarnations(db);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = take_tags_of_keys(db);
    }
    if (outcome == ST_SQL_DONE) {
        outcome = take_tags_of_jobs(db);
    }
    return outcome == ST_SQL_DONE ? st_db_run(db, "COMMIT") : outcome;
}

static bool renew_copy(st_folder *folder)
{
    char path[PATH_MAX];
    st_db db;
    if (!st_folder_path(folder, "restored.db", path)) {
        return st_refuse(folder->message, "the path of the store is too long");
    }
    st_sql outcome = st_db_open(&db, path, SQLITE_OPEN_READWRITE, texts, STATEMENTS);
    if (outcome == ST_SQL_DONE) {
        outcome = renew(&db);
    }
    bool good = outcome == ST_SQL_DONE || st_sqlite_explain(&db, path, outcome, folder->message);
    (void)st_db_close(&db);
    return good && st_sqlite_check_file(path, folder->message);
}

/* --- putting the copy in place of the store --- */

static bool sync_name(st_folder *folder, const char *name, int flags)
{
    int file = openat(folder->folder, name, flags | O_RDONLY | O_CLOEXEC);
    bool good = file >= 0 && fsync(file) == 0;
    if (!good) {
        (void)st_folder_fail(folder, "cannot sync", name);
    }
    if (file >= 0) {
        (void)close(file);
    }
    return good;
}

static bool write_note(st_folder *folder, char before[NAME_BYTES])
{
    char time[ST_TIMESTAMP];
    st_clock_format(st_clock_utc(), time);
    int length = snprintf(before, NAME_BYTES, "before-%s", time);
    int file = openat(folder->folder, "restoring", O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    bool good = file >= 0 && write(file, before, (size_t)length) == length && fsync(file) == 0;
    if (!good) {
        (void)st_folder_fail(folder, "cannot write", "restoring");
    }
    if (file >= 0) {
        (void)close(file);
    }
    return good && st_folder_sync(folder);
}

static bool read_note(st_folder *folder, char before[NAME_BYTES])
{
    int file = openat(folder->folder, "restoring", O_RDONLY | O_CLOEXEC);
    ssize_t got = file < 0 ? -1 : read(file, before, NAME_BYTES - 1);
    if (file >= 0) {
        (void)close(file);
    }
    before[got < 0 ? 0 : got] = '\0';
    return strncmp(before, "before-", 7) == 0 && strchr(before, '/') == NULL;
}

static bool move_old(st_folder *folder, const char *before)
{
    static const char *const names[] = {"hedge.db", "hedge.db-wal", "hedge.db-shm", "hedge.mark",
                                        "fresh"};
    if (mkdirat(folder->folder, before, 0700) != 0 && errno != EEXIST) {
        return st_folder_fail(folder, "cannot make", before);
    }
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char to[2 * NAME_BYTES];
        (void)snprintf(to, sizeof to, "%s/%s", before, names[i]);
        if (renameat(folder->folder, names[i], folder->folder, to) != 0 && errno != ENOENT) {
            return st_folder_fail(folder, "cannot move", names[i]);
        }
    }
    return sync_name(folder, before, O_DIRECTORY) && st_folder_sync(folder);
}

bool st_sqlite_finish_restore(st_folder *folder)
{
    char before[NAME_BYTES];
    if (!st_folder_finds(folder, "restoring")) {
        return true;
    }
    /* If restored.db does not exist, it was renamed to hedge.db before the restore was
     * interrupted. */
    if (st_folder_finds(folder, "restored.db")) {
        if (!read_note(folder, before)) {
            return st_refuse(folder->message,
                             "%.300s has an incomplete file `restoring`, which an interrupted "
                             "restore left: run the restore again",
                             folder->path);
        }
        if (!move_old(folder, before)) {
            return false;
        }
        if (renameat(folder->folder, "restored.db", folder->folder, "hedge.db") != 0) {
            return st_folder_fail(folder, "cannot rename", "restored.db");
        }
        if (!st_folder_sync(folder)) {
            return false;
        }
    }
    if (unlinkat(folder->folder, "restoring", 0) != 0) {
        return st_folder_fail(folder, "cannot remove", "restoring");
    }
    return st_folder_sync(folder);
}

static bool restore(st_folder *folder, const char *path, const char *file, char before[NAME_BYTES])
{
    /* An interrupted restore is finished first. It has left the file `restoring`, which says that
     * the file restored.db is complete and would be wrong about the new restored.db. */
    bool good = st_folder_open(folder, path);
    if (good && st_folder_finds(folder, "restoring") && st_folder_finds(folder, "restored.db") &&
        !read_note(folder, before)) {
        /* The file `restoring` is incomplete, so the interrupted restore has not replaced any file
         * yet and can be abandoned. */
        good = unlinkat(folder->folder, "restoring", 0) == 0 && st_folder_sync(folder);
    }
    /* Only the file of the backup is copied. If SQLite's log is beside the file, the backup is
     * refused, because the changes in the log would be lost. */
    good = good && st_sqlite_finish_restore(folder) &&
           st_sqlite_has_no_log(file,
                                "this log has changes that the file does not have yet; restore a "
                                "file that --backup made",
                                folder->message) &&
           st_sqlite_check_file(file, folder->message) && remove_copy(folder);
    if (good && !(copy_file(folder, file) && renew_copy(folder) &&
                  sync_name(folder, "restored.db", 0) && write_note(folder, before))) {
        char why[ST_SQLITE_MESSAGE];
        memcpy(why, folder->message, sizeof why);
        (void)remove_copy(folder);
        memcpy(folder->message, why, sizeof why);
        return false;
    }
    return good && st_sqlite_finish_restore(folder);
}

bool st_sqlite_restore(const char *path, const char *file, char before[ST_SQLITE_MESSAGE],
                       char message[ST_SQLITE_MESSAGE])
{
    st_folder folder;
    char name[NAME_BYTES] = "";
    bool good = restore(&folder, path, file, name);
    memcpy(message, folder.message, ST_SQLITE_MESSAGE);
    (void)snprintf(before, ST_SQLITE_MESSAGE, "%.300s/%s", folder.path, name);
    st_folder_close(&folder);
    return good;
}
