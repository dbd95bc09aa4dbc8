/* Tests of backups of a store, and of restoring them (core/journal/sqlite/sqlite_backup.h). */
#include "tests/pace.h"
#include "tests/store_sql.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "journal/sqlite/sqlite_backup.h"
#include "stored/stored.h"

#include <dirent.h>
#include <sched.h>
#include <stdatomic.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[FOLDER_PATH], aside[FOLDER_PATH], backup[2 * FOLDER_PATH];
static char message[ST_SQLITE_MESSAGE], before[ST_SQLITE_MESSAGE];
static he_mesh *content;

static int make_folders(void **state)
{
    (void)state;
    folder_make(folder);
    folder_make(aside);
    (void)snprintf(backup, sizeof backup, "%s/it %%? is#one.db", aside);
    content = script_mesh("012,023,034", NULL);
    return 0;
}

/* Removes the folders into which restores have moved the store that they replaced. */
static void remove_befores(void)
{
    DIR *dir = opendir(folder);
    struct dirent *entry;
    while (dir != NULL && (entry = readdir(dir)) != NULL) {
        if (strncmp(entry->d_name, "before-", 7) == 0) {
            char path[3 * FOLDER_PATH];
            (void)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            folder_remove(path);
        }
    }
    if (dir != NULL) {
        (void)closedir(dir);
    }
}

static int remove_folders(void **state)
{
    (void)state;
    remove_befores();
    folder_remove(folder);
    (void)unlink(backup);
    folder_remove(aside);
    he_mesh_free(content);
    return 0;
}

static kept_mesh new_mesh(const char *id)
{
    static uint64_t incarnations = 9000;
    kept_mesh mesh = {.name = "name", .content = content, .incarnation = ++incarnations};
    (void)snprintf(mesh.id, sizeof mesh.id, "%s", id);
    return mesh;
}

static st_status count_records(const st_journal *j, const char *id, unsigned *records,
                               st_card *card)
{
    st_reader *reader = NULL;
    st_piece piece = {.kind = ST_PIECE_BASE};
    *records = 0;
    st_status status = j->open(j->self, id, card, &reader);
    while (status == ST_OK && piece.kind != ST_PIECE_END) {
        status = j->read(reader, &piece);
        *records += status == ST_OK && piece.kind == ST_PIECE_RECORD;
    }
    j->shut(reader);
    return status;
}

/* Makes a store with a mesh "a" and this many edits, and closes it. */
static kept_mesh make_store(unsigned edits)
{
    told_journal told;
    kept_mesh mesh = new_mesh("a");
    told_open(&told, folder);
    kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0);
    for (unsigned i = 0; i < edits; i++) {
        kept_append(&told.journal, kept_edit(&mesh), &mesh, "x", 1);
    }
    told_end(&told);
    return mesh;
}

static void expect_records(unsigned records, uint64_t *incarnation)
{
    told_journal told;
    unsigned found;
    st_card card;
    told_open(&told, folder);
    assert_int_equal(count_records(&told.journal, "a", &found, &card), ST_OK);
    assert_int_equal(found, records);
    *incarnation = card.incarnation;
    told_end(&told);
}

static void a_restore_brings_back_the_state_under_new_incarnations(void **state)
{
    (void)state;
    kept_mesh mesh = make_store(5);
    if (!st_sqlite_backup(folder, backup, message)) {
        fail_msg("%s", message);
    }
    told_journal told;
    told_open(&told, folder);
    for (int i = 0; i < 3; i++) {
        kept_append(&told.journal, kept_edit(&mesh), &mesh, "y", 1);
    }
    kept_mesh other = new_mesh("b");
    told_wait(&told, kept_append(&told.journal, kept_content(&other), &other, NULL, 0));
    /* A restore must be refused while a daemon has the store open. */
    assert_false(st_sqlite_restore(folder, backup, before, message));
    assert_non_null(strstr(message, "in use by process"));
    told_end(&told);
    if (!st_sqlite_restore(folder, backup, before, message)) {
        fail_msg("%s", message);
    }
    uint64_t incarnation, again;
    expect_records(5, &incarnation);
    assert_true(incarnation != mesh.incarnation);
    st_sqlite_opened old;
    if (!st_sqlite_look(before, &old)) {
        fail_msg("%s", old.message);
    }
    assert_int_equal(old.journal.count(old.journal.self), 2);
    unsigned records;
    st_card card;
    assert_int_equal(count_records(&old.journal, "a", &records, &card), ST_OK);
    assert_int_equal(records, 8);
    old.journal.close(old.journal.self);
    expect_records(5, &again);
    assert_true(again == incarnation);
}

static bool count_key(void *context, const st_kept_key *key)
{
    unsigned *keys = context;
    ++*keys;
    assert_string_equal(key->key.text, "a key");
    assert_string_equal(key->id, "a");
    assert_true(key->key.digest[1] == 8);
    /* An Idempotency-Key in a restored store must not name the state that its request made, because
     * the restore may have removed that state. */
    assert_true(key->incarnation == 0 && key->revision == 0 && key->metadata == 0);
    return true;
}

static void a_restore_keeps_keys_without_their_tags(void **state)
{
    (void)state;
    static const st_record_key make = {
        .text = "a key", .digest = {7, 8}, .time = 1000, .of_store = true};
    static const st_record_key edit = {.text = "a key", .digest = {7, 8}, .time = 1001};
    told_journal told;
    kept_mesh mesh = new_mesh("a");
    told_open(&told, folder);
    st_record record = kept_content(&mesh);
    record.key = &make;
    kept_append(&told.journal, record, &mesh, NULL, 0);
    record = kept_edit(&mesh);
    record.key = &edit;
    told_wait(&told, kept_append(&told.journal, record, &mesh, "x", 1));
    told_end(&told);
    assert_true(st_sqlite_backup(folder, backup, message));
    if (!st_sqlite_restore(folder, backup, before, message)) {
        fail_msg("%s", message);
    }
    told_open(&told, folder);
    unsigned keys = 0;
    assert_int_equal(told.journal.keys(told.journal.self, NULL, count_key, &keys), ST_OK);
    assert_int_equal(told.journal.keys(told.journal.self, "a", count_key, &keys), ST_OK);
    assert_int_equal(keys, 2);
    told_end(&told);
}

static double restore_keys(const void *context, size_t size)
{
    char text[512];
    (void)context;
    (void)make_store(1);
    (void)snprintf(text, sizeof text,
                   "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < %zu) "
                   "INSERT INTO kept(mesh, text, digest, time, id, incarnation, revision, "
                   "metadata, position, made, sum) "
                   "SELECT 1, 'key ' || i, zeroblob(16), i, 'a', 5, 1, 1, i, 0, 0 FROM n",
                   size);
    store_sql_run(folder, text);
    if (!st_sqlite_backup(folder, backup, message)) {
        fail_msg("%s", message);
    }
    const double begun = pace_seconds();
    if (!st_sqlite_restore(folder, backup, before, message)) {
        fail_msg("%s", message);
    }
    const double took = pace_seconds() - begun;
    remove_befores();
    folder_remove(folder);
    (void)mkdir(folder, 0700);
    return took;
}

static void a_restore_takes_time_in_proportion_to_the_keys(void **state)
{
    (void)state;
    pace_require_linear("a restore of keys", restore_keys, NULL, 50000);
}

static void expect_no_backup(const char *file, const char *says)
{
    message[0] = '\0';
    assert_false(st_sqlite_backup(folder, file, message));
    if (strstr(message, says) == NULL) {
        fail_msg("%s: \"%s\" is not in \"%s\"", file, says, message);
    }
}

static void a_backup_takes_the_place_of_no_file_of_a_store(void **state)
{
    (void)state;
    static const char *const names[] = {"hedge.db", "hedge.db-wal", "hedge.db-shm", "hedge.mark",
                                        "lock",     "ballast",      "restored.db",  "restoring"};
    char path[3 * FOLDER_PATH], linked[2 * FOLDER_PATH];
    told_journal told;
    kept_mesh mesh = make_store(2);
    told_open(&told, folder);
    told_wait(&told, kept_append(&told.journal, kept_edit(&mesh), &mesh, "y", 1));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        (void)snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        expect_no_backup(path, names[i]);
        (void)snprintf(path, sizeof path, "%s/../%s/%s", folder, strrchr(folder, '/') + 1,
                       names[i]);
        expect_no_backup(path, "of a store");
    }
    /* The path of the backup is a symbolic link to the database of the store, so it must be
     * refused. */
    (void)snprintf(path, sizeof path, "%s/hedge.db", folder);
    (void)snprintf(linked, sizeof linked, "%s/linked", aside);
    assert_int_equal(symlink(path, linked), 0);
    expect_no_backup(linked, "hedge.db of a store");
    assert_int_equal(unlink(linked), 0);
    /* A backup may be in the folder of the store if its name differs from the store's own files. */
    (void)snprintf(path, sizeof path, "%s/of today.db", folder);
    for (int again = 0; again < 2; again++) {
        if (!st_sqlite_backup(folder, path, message)) {
            fail_msg("%s", message);
        }
    }
    assert_int_equal(unlink(path), 0);
    told_end(&told);
    uint64_t incarnation;
    expect_records(3, &incarnation);
}

static void a_backup_goes_under_no_log(void **state)
{
    (void)state;
    char log[sizeof backup + 8];
    static const char *const ends[] = {"-wal", "-journal"};
    (void)make_store(2);
    for (size_t i = 0; i < 2; i++) {
        (void)snprintf(log, sizeof log, "%s%s", strrchr(backup, '/') + 1, ends[i]);
        folder_write(aside, log, (const unsigned char *)"a log", 5);
        expect_no_backup(backup, ends[i]);
        assert_int_equal(access(backup, F_OK), -1);
        (void)snprintf(log, sizeof log, "%s%s", backup, ends[i]);
        assert_int_equal(unlink(log), 0);
    }
}

/* If a store was killed by kill -9, its write-ahead log (hedge.db-wal) stays. It must not be
 * applied to a database that is later restored in the place of the old one. */
static void a_log_left_behind_stays_with_its_database(void **state)
{
    (void)state;
    kept_mesh mesh = make_store(2);
    assert_true(st_sqlite_backup(folder, backup, message));
    told_journal told;
    told_open(&told, folder);
    for (int i = 0; i < 30; i++) {
        told_wait(&told, kept_append(&told.journal, kept_edit(&mesh), &mesh, "y", 1));
    }
    char killed[FOLDER_PATH];
    folder_make(killed);
    folder_copy(folder, killed);
    told_end(&told);
    folder_remove(folder);
    assert_int_equal(rename(killed, folder), 0);
    size_t size;
    unsigned char *log = folder_read(folder, "hedge.db-wal", &size);
    assert_true(log != NULL && size > 0);
    free(log);
    if (!st_sqlite_restore(folder, backup, before, message)) {
        fail_msg("%s", message);
    }
    uint64_t incarnation;
    expect_records(2, &incarnation);
}

static void move(const char *from, const char *to)
{
    char a[2 * FOLDER_PATH], b[2 * FOLDER_PATH];
    (void)snprintf(a, sizeof a, "%s/%s", folder, from);
    (void)snprintf(b, sizeof b, "%s/%s", folder, to);
    (void)rename(a, b);
}

/* A restore may be interrupted between any two of its steps. This test makes the state after each
 * step itself; the next start of the store must complete the restore. */
static void an_interrupted_restore_is_finished_by_the_next_start(void **state)
{
    (void)state;
    static const char *const moved[] = {"hedge.db", "hedge.db-wal", "hedge.mark"};
    for (unsigned step = 0; step <= 5; step++) {
        (void)make_store(1);
        assert_true(st_sqlite_backup(folder, backup, message));
        uint64_t incarnation;
        told_journal told;
        told_open(&told, folder);
        kept_mesh other = new_mesh("b");
        told_wait(&told, kept_append(&told.journal, kept_content(&other), &other, NULL, 0));
        told_end(&told);
        size_t size;
        unsigned char *bytes = folder_read(aside, strrchr(backup, '/') + 1, &size);
        folder_write(folder, "restored.db", bytes, size);
        free(bytes);
        if (step > 0) {
            folder_write(folder, "restoring", (const unsigned char *)"before-then", 11);
            char path[2 * FOLDER_PATH];
            (void)snprintf(path, sizeof path, "%s/before-then", folder);
            (void)mkdir(path, 0700);
        }
        for (unsigned i = 0; i + 1 < step && i < 3; i++) {
            char to[64];
            (void)snprintf(to, sizeof to, "before-then/%s", moved[i]);
            move(moved[i], to);
        }
        if (step == 5) {
            move("restored.db", "hedge.db");
        }
        expect_records(1, &incarnation);
        told_open(&told, folder);
        /* If a restore was interrupted before it wrote the file "restoring", the next start must
         * keep the old store. */
        assert_int_equal(told.journal.count(told.journal.self), step == 0 ? 2 : 1);
        told_end(&told);
        char path[2 * FOLDER_PATH];
        (void)snprintf(path, sizeof path, "%s/restored.db", folder);
        (void)unlink(path);
        (void)snprintf(path, sizeof path, "%s/restoring", folder);
        assert_int_equal(access(path, F_OK), -1);
        remove_befores();
        folder_remove(folder);
        (void)mkdir(folder, 0700);
    }
}

/* A killed restore has left a rollback journal of SQLite, which contains a first page of zeros. If
 * this journal stayed, SQLite would write the page into the next copy of a database. */
static void what_a_killed_restore_left_is_not_played_into_the_next(void **state)
{
    (void)state;
    enum { SECTOR = 512, PAGE = 4096 };
    static const unsigned char head[] = {0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7, 0, 0,
                                         0,    1,    0,    0,    0,    0,    0,    0,    0, 1,
                                         0,    0,    2,    0,    0,    0,    0x10, 0};
    static unsigned char journal[SECTOR + 4 + PAGE + 4];
    memcpy(journal, head, sizeof head);
    journal[SECTOR + 3] = 1;
    (void)make_store(5);
    if (!st_sqlite_backup(folder, backup, message)) {
        fail_msg("%s", message);
    }
    folder_write(folder, "restored.db-journal", journal, sizeof journal);
    if (!st_sqlite_restore(folder, backup, before, message)) {
        fail_msg("%s", message);
    }
    uint64_t incarnation;
    expect_records(5, &incarnation);
}

static void a_file_with_a_log_beside_it_is_not_restored(void **state)
{
    (void)state;
    char log[sizeof backup + 8];
    (void)make_store(5);
    if (!st_sqlite_backup(folder, backup, message)) {
        fail_msg("%s", message);
    }
    (void)snprintf(log, sizeof log, "%s-wal", backup);
    FILE *file = fopen(log, "w");
    assert_non_null(file);
    assert_true(fputs("a log", file) >= 0);
    assert_int_equal(fclose(file), 0);
    assert_false(st_sqlite_restore(folder, backup, before, message));
    assert_non_null(strstr(message, "SQLite left a log beside it (-wal)"));
    assert_int_equal(unlink(log), 0);
    uint64_t incarnation;
    expect_records(5, &incarnation);
}

static void what_is_no_whole_store_is_not_restored(void **state)
{
    (void)state;
    uint64_t incarnation;
    (void)make_store(40);
    assert_false(st_sqlite_restore(folder, "/proc/1/none", before, message));
    assert_true(st_sqlite_backup(folder, backup, message));
    size_t size;
    const char *name = strrchr(backup, '/') + 1;
    unsigned char *bytes = folder_read(aside, name, &size);
    folder_write(aside, name, bytes, size / 2);
    assert_false(st_sqlite_restore(folder, backup, before, message));
    assert_non_null(strstr(message, "damaged"));
    folder_write(aside, name, (const unsigned char *)"", 0);
    assert_false(st_sqlite_restore(folder, backup, before, message));
    assert_non_null(strstr(message, "is not a store of hedged"));
    bytes[5000] ^= 0xff;
    memset(bytes + 8192, 0xaa, 100);
    folder_write(aside, name, bytes, size);
    assert_false(st_sqlite_check_file(backup, message));
    assert_false(st_sqlite_restore(folder, backup, before, message));
    free(bytes);
    expect_records(40, &incarnation);
}

/* --- a backup while a thread writes to the store --- */

static _Atomic bool stops;
static told_journal writing;

static void *write_on(void *context)
{
    kept_mesh *mesh = context;
    while (!atomic_load(&stops)) {
        kept_mesh next = *mesh;
        uint64_t position =
            kept_append(&writing.journal, kept_edit(&next), &next, "some bytes of an edit", 21);
        if (position != 0) {
            *mesh = next;
        }
        sched_yield();
    }
    return NULL;
}

static void a_backup_beside_a_writer_is_the_state_of_one_moment(void **state)
{
    (void)state;
    pthread_t thread;
    kept_mesh mesh = new_mesh("a");
    told_open(&writing, folder);
    kept_append(&writing.journal, kept_content(&mesh), &mesh, NULL, 0);
    atomic_store(&stops, false);
    assert_int_equal(pthread_create(&thread, NULL, write_on, &mesh), 0);
    unsigned last = 0;
    for (int i = 0; i < 5; i++) {
        st_sqlite_opened out;
        st_card card;
        unsigned records;
        if (!st_sqlite_backup(folder, backup, message)) {
            fail_msg("%s", message);
        }
        assert_true(st_sqlite_look(backup, &out));
        st_status status = count_records(&out.journal, "a", &records, &card);
        assert_true(status == ST_OK || (status == ST_ABSENT && last == 0));
        assert_true(records >= last);
        last = records;
        out.journal.close(out.journal.self);
    }
    atomic_store(&stops, true);
    pthread_join(thread, NULL);
    told_end(&writing);
    uint64_t incarnation;
    expect_records((unsigned)mesh.number - 1, &incarnation);
}

static void who_looks_changes_nothing(void **state)
{
    (void)state;
    st_sqlite_opened out;
    (void)make_store(3);
    assert_true(st_sqlite_look(folder, &out));
    const st_journal *j = &out.journal;
    const st_room_need need = {.records = 1, .bytes = 1};
    st_room *room;
    st_stage *stage;
    st_card card;
    unsigned records;
    assert_int_equal(j->reserve(j->self, &need, &room), ST_FAILED);
    assert_int_equal(j->stage(j->self, content, &stage), ST_FAILED);
    st_reader *reader;
    assert_int_equal(count_records(j, "a", &records, &card), ST_OK);
    assert_int_equal(j->open(j->self, "a", &card, &reader), ST_OK);
    j->condemn(reader, "it is only said so");
    j->shut(reader);
    j->close(j->self);
    uint64_t incarnation;
    expect_records(3, &incarnation);
    assert_false(st_sqlite_look(aside, &out));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define STORE_TEST(name) cmocka_unit_test_setup_teardown(name, make_folders, remove_folders)
        STORE_TEST(a_restore_brings_back_the_state_under_new_incarnations),
        STORE_TEST(a_restore_keeps_keys_without_their_tags),
        STORE_TEST(a_restore_takes_time_in_proportion_to_the_keys),
        STORE_TEST(a_backup_takes_the_place_of_no_file_of_a_store),
        STORE_TEST(a_backup_goes_under_no_log),
        STORE_TEST(a_log_left_behind_stays_with_its_database),
        STORE_TEST(an_interrupted_restore_is_finished_by_the_next_start),
        STORE_TEST(what_a_killed_restore_left_is_not_played_into_the_next),
        STORE_TEST(a_file_with_a_log_beside_it_is_not_restored),
        STORE_TEST(what_is_no_whole_store_is_not_restored),
        STORE_TEST(a_backup_beside_a_writer_is_the_state_of_one_moment),
        STORE_TEST(who_looks_changes_nothing),
#undef STORE_TEST
    };
    return cmocka_run_group_tests_name("backup", tests, NULL, NULL);
}
