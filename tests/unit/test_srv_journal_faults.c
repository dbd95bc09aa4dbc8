/* Tests of the journal in a folder when the disk is full, slow or failing, and when memory is out:
 * records that were acknowledged must be on the disk, all other records must be reported as lost,
 * and nothing else may change. */
#include "tests/disk.h"
#include "tests/failing.h"
#include "tests/store_folder.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "stored/stored.h"
#include "system/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

static char folder[FOLDER_PATH];
static he_mesh *content;

static int make_folder(void **state)
{
    (void)state;
    folder_make(folder);
    content = script_mesh("012,023,034", NULL);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    disk_fill(false);
    disk_fail_at(0);
    folder_remove(folder);
    he_mesh_free(content);
    return 0;
}

static bool try_open(told_journal *told, size_t queue)
{
    st_sqlite_opened out;
    const st_sqlite_options options = {.folder = folder, .release = "test", .queue_bytes = queue};
    if (!st_sqlite_open(&options, &out)) {
        assert_true(out.message[0] != '\0');
        return false;
    }
    told_begin(told, &out.journal);
    return true;
}

static void open_store(told_journal *told, size_t queue)
{
    assert_true(try_open(told, queue));
}

static kept_mesh new_mesh(void)
{
    static uint64_t incarnations = 5000;
    return (kept_mesh){.id = "a", .name = "a", .content = content, .incarnation = ++incarnations};
}

/* Opens the store, makes a new mesh in it, and waits until the mesh is durable. */
static kept_mesh open_with_mesh(told_journal *told, size_t queue)
{
    kept_mesh mesh = new_mesh();
    open_store(told, queue);
    told_wait(told, kept_append(&told->journal, kept_content(&mesh), &mesh, NULL, 0));
    return mesh;
}

/* Reads a whole mesh, and counts the records after its base (the record with all mesh data). */
static st_status count_records(const st_journal *j, const char *id, unsigned *records)
{
    st_card card;
    st_reader *reader = NULL;
    st_piece piece = {.kind = ST_PIECE_BASE};
    *records = 0;
    st_status status = j->open(j->self, id, &card, &reader);
    while (status == ST_OK && piece.kind != ST_PIECE_END) {
        status = j->read(reader, &piece);
        *records += status == ST_OK && piece.kind == ST_PIECE_RECORD;
    }
    j->shut(reader);
    return status;
}

/* Tries again and again to reserve space for a record, until the journal no longer refuses with
 * `refusal`. The journal must come to this without help from the test. */
static st_room *reserve_after(const st_journal *j, st_status refusal, bool freeing)
{
    const st_room_need need = {.records = 1, .bytes = 16, .freeing = freeing};
    st_room *room = NULL;
    st_status status;
    while ((status = j->reserve(j->self, &need, &room)) == refusal) {
        sched_yield();
    }
    assert_int_equal(status, ST_OK);
    return room;
}

/* --- a full disk --- */

bool __real_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);
bool __wrap_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until);

/* Replaces the journal's wait by a wait that is a hundred times shorter: on a full disk, the
 * journal waits a second before each check for free space. */
bool __wrap_st_clock_wait(pthread_cond_t *condition, pthread_mutex_t *lock, uint64_t until)
{
    const uint64_t now = st_clock_micros();
    return __real_st_clock_wait(condition, lock, until > now ? now + (until - now) / 100 : until);
}

static void a_full_disk_loses_what_is_queued_and_recovers(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = new_mesh();
    open_store(&told, 0);
    const st_journal *j = &told.journal;
    kept_append(j, kept_content(&mesh), &mesh, NULL, 0);
    uint64_t last = kept_append(j, kept_edit(&mesh), &mesh, "1", 1);
    told_wait(&told, last);
    disk_fill(true);
    kept_mesh lost = mesh;
    last = kept_append(j, kept_edit(&lost), &lost, "2", 1);
    told_wait(&told, last);
    assert_int_equal(told_losses(&told), 1);
    assert_true(told.loss.from == last && told.loss.to == last);
    assert_int_equal(told.loss.status, ST_FULL);
    assert_int_equal(told.loss.incarnation, 0);
    kept_mesh refused = mesh;
    assert_int_equal(kept_append(j, kept_edit(&refused), &refused, "3", 1), 0);
    assert_int_equal(kept_status(), ST_FULL);
    st_stage *stage;
    assert_int_equal(j->stage(j->self, content, &stage), ST_FULL);
    unsigned records;
    assert_int_equal(count_records(j, "a", &records), ST_OK);
    assert_int_equal(records, 1);
    disk_fill(false);
    j->leave(j->self, reserve_after(j, ST_FULL, false));
    /* The lost record had a number: the next record must get this number again. */
    told_wait(&told, kept_append(j, kept_edit(&mesh), &mesh, "4", 1));
    assert_int_equal(count_records(j, "a", &records), ST_OK);
    assert_int_equal(records, 2);
    assert_int_equal(told_losses(&told), 1);
    told_end(&told);
}

/* If `no_space` is set, the disk has no space for files that do not belong to SQLite. */
static _Atomic bool no_space;
static _Atomic unsigned
    asked_for_space; /* number of requests for disk space that did not come from SQLite */

int __real_fstatvfs(int file, struct statvfs *out);
int __wrap_fstatvfs(int file, struct statvfs *out);
int __real_posix_fallocate(int file, off_t from, off_t size);
int __wrap_posix_fallocate(int file, off_t from, off_t size);

int __wrap_fstatvfs(int file, struct statvfs *out)
{
    int failed = __real_fstatvfs(file, out);
    asked_for_space++;
    out->f_bavail = no_space ? 0 : out->f_bavail;
    return failed;
}

int __wrap_posix_fallocate(int file, off_t from, off_t size)
{
    return no_space ? ENOSPC : __real_posix_fallocate(file, from, size);
}

/* Identifies a folder: the test counts the syncs of this folder, and can make them fail. */
static struct stat watched;
static bool watched_fails;
static unsigned watched_syncs;

int __real_fsync(int file);
int __wrap_fsync(int file);

int __wrap_fsync(int file)
{
    struct stat status;
    if (fstat(file, &status) != 0 || status.st_dev != watched.st_dev ||
        status.st_ino != watched.st_ino) {
        return __real_fsync(file);
    }
    watched_syncs++;
    errno = EIO;
    return watched_fails ? -1 : __real_fsync(file);
}

/* After a new folder is made, the folder that contains it must be synced. Otherwise a power loss
 * could remove the new folder with all acknowledged records in it. */
static void the_folder_above_a_new_one_is_synced(void **state)
{
    (void)state;
    static const char *const ends[] = {"", "/", "//"};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        char path[2 * FOLDER_PATH];
        st_sqlite_opened out;
        const st_sqlite_options options = {.folder = path, .release = "test"};
        (void)snprintf(path, sizeof path, "%s/new%s", folder, ends[i]);
        assert_int_equal(stat(folder, &watched), 0);
        watched_syncs = 0;
        watched_fails = true;
        assert_false(st_sqlite_open(&options, &out));
        assert_non_null(strstr(out.message, "the parent folder cannot be synced"));
        assert_int_equal(access(path, F_OK), -1);
        watched_fails = false;
        assert_true(st_sqlite_open(&options, &out));
        out.journal.close(out.journal.self);
        assert_int_equal(watched_syncs, 2);
        /* A second start must not sync the folder that contains the store again. */
        assert_true(st_sqlite_open(&options, &out));
        out.journal.close(out.journal.self);
        assert_int_equal(watched_syncs, 2);
        folder_remove(path);
    }
    watched = (struct stat){.st_ino = 0};
}

static bool has_ballast(void)
{
    size_t size = 0;
    free(folder_read(folder, "ballast", &size));
    return size > 0;
}

/* The ballast is a file that only reserves disk space. If the disk is full, the start must free a
 * part of the ballast, and deletions may use the rest. */
static void a_store_starts_from_a_full_disk(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = new_mesh();
    open_store(&told, 0);
    told_wait(&told, kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0));
    told_end(&told);
    assert_true(has_ballast());
    no_space = true;
    open_store(&told, 0);
    const st_journal *j = &told.journal;
    assert_false(has_ballast());
    unsigned records;
    assert_int_equal(count_records(j, "a", &records), ST_OK);
    kept_mesh refused = mesh;
    assert_int_equal(kept_append(j, kept_edit(&refused), &refused, "1", 1), 0);
    assert_int_equal(kept_status(), ST_FULL);
    told_wait(&told, kept_append(j, kept_remove(&mesh), &mesh, NULL, 0));
    assert_int_equal(told_losses(&told), 0);
    assert_int_equal(count_records(j, "a", &records), ST_ABSENT);
    no_space = false;
    j->leave(j->self, reserve_after(j, ST_FULL, false));
    assert_true(has_ballast());
    told_end(&told);
}

static st_health health_of(const st_journal *j)
{
    st_health health;
    j->health(j->self, &health);
    return health;
}

/* On a full disk, SQLite can still write into reused space of its log, so a successful write does
 * not show that there is free space again. The journal must check for free space itself. */
static void a_full_disk_stays_full_until_there_is_space(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = new_mesh();
    open_store(&told, 0);
    const st_journal *j = &told.journal;
    told_wait(&told, kept_append(j, kept_content(&mesh), &mesh, NULL, 0));
    assert_int_equal(health_of(j).status, ST_OK);
    no_space = true;
    disk_fill(true);
    kept_mesh lost = mesh;
    told_wait(&told, kept_append(j, kept_edit(&lost), &lost, "2", 1));
    disk_fill(false);
    const unsigned asked = asked_for_space;
    while (asked_for_space < asked + 3) {
        const st_health health = health_of(j);
        assert_int_equal(health.status, ST_FULL);
        assert_int_equal(health.fulls, 1);
        assert_int_equal(kept_append(j, kept_edit(&lost), &lost, "3", 1), 0);
        sched_yield();
    }
    no_space = false;
    j->leave(j->self, reserve_after(j, ST_FULL, false));
    assert_int_equal(health_of(j).status, ST_OK);
    assert_int_equal(health_of(j).fulls, 1);
    assert_true(has_ballast());
    told_wait(&told, kept_append(j, kept_edit(&mesh), &mesh, "4", 1));
    assert_int_equal(told_losses(&told), 1);
    told_end(&told);
}

static void rooms_from_before_are_lost_too_and_nothing_is_admitted_meanwhile(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = open_with_mesh(&told, 0);
    const st_journal *j = &told.journal;
    st_room *early = reserve_after(j, ST_OK + ST_FULL, false);
    st_room *left = reserve_after(j, ST_OK + ST_FULL, false);
    disk_fill(true);
    kept_mesh head = mesh;
    told_wait(&told, kept_append(j, kept_edit(&head), &head, "2", 1));
    disk_fill(false);
    const st_room_need removal = {.records = 1, .bytes = 0, .freeing = true};
    st_room *room;
    assert_int_equal(j->reserve(j->self, &removal, &room), ST_FULL);
    st_record record = kept_edit(&head);
    uint64_t last = j->append(j->self, early, &record, 1);
    told_wait(&told, last);
    assert_int_equal(told_losses(&told), 2);
    assert_true(told.loss.from == last && told.loss.to == last);
    assert_int_equal(j->reserve(j->self, &removal, &room), ST_FULL);
    j->leave(j->self, left);
    /* After some space is freed, the journal must first accept only deletions, and later all other
     * records again. */
    room = reserve_after(j, ST_FULL, true);
    record = kept_remove(&mesh);
    told_wait(&told, j->append(j->self, room, &record, 1));
    assert_int_equal(told_losses(&told), 2);
    j->leave(j->self, reserve_after(j, ST_FULL, false));
    st_card card;
    assert_int_equal(j->open(j->self, "a", &card, NULL), ST_ABSENT);
    assert_int_equal(j->count(j->self), 0);
    size_t size;
    unsigned char *ballast = folder_read(folder, "ballast", &size);
    assert_non_null(ballast);
    assert_int_equal(size, 8 << 20);
    free(ballast);
    told_end(&told);
}

static void what_was_made_and_lost_was_never_there(void **state)
{
    (void)state;
    told_journal told;
    open_store(&told, 0);
    const st_journal *j = &told.journal;
    for (long n = 1; n <= 6; n++) {
        kept_mesh mesh = new_mesh();
        const unsigned losses = told_losses(&told);
        disk_fill_at(n);
        uint64_t last = kept_append(j, kept_content(&mesh), &mesh, NULL, 0);
        told_wait(&told, last);
        st_card card;
        const bool lost = told_losses(&told) > losses;
        assert_int_equal(j->open(j->self, "a", &card, NULL), lost ? ST_ABSENT : ST_OK);
        assert_int_equal(j->count(j->self), lost ? 0 : 1);
        disk_fill_at(0);
        j->leave(j->self, reserve_after(j, ST_FULL, false));
        if (!lost) {
            told_wait(&told, kept_append(j, kept_remove(&mesh), &mesh, NULL, 0));
        }
    }
    assert_true(told_losses(&told) > 0);
    told_end(&told);
}

/* --- a sync fails --- */

enum { EDITS = 12 };

/* Appends one record after another, the first of which creates the mesh, while a sync of the disk
 * that the caller has chosen fails. Returns how many records were acknowledged. */
static unsigned append_while_failing(told_journal *told, kept_mesh *mesh)
{
    const st_journal *j = &told->journal;
    unsigned acknowledged = 0;
    for (unsigned i = 0; i <= EDITS; i++) {
        st_record record = i == 0 ? kept_content(mesh) : kept_edit(mesh);
        uint64_t position = kept_append(j, record, mesh, "x", 1);
        if (position == 0) {
            assert_int_equal(kept_status(), ST_FAILED);
            break;
        }
        told_wait(told, position);
        if (told_losses(told) > 0) {
            assert_int_equal(told->loss.status, ST_FAILED);
            assert_true(told->loss.from <= position && told->loss.to >= position);
            continue;
        }
        acknowledged++;
    }
    return acknowledged;
}

static void after_a_failed_sync_nothing_is_acknowledged(void **state)
{
    (void)state;
    bool fired = true;
    unsigned runs = 0, opened = 0;
    for (long n = 1; fired; n++, runs++) {
        told_journal told;
        kept_mesh mesh = new_mesh();
        disk_fail_at(n);
        unsigned acknowledged = 0;
        if (try_open(&told, 0)) {
            acknowledged = append_while_failing(&told, &mesh);
            unsigned records;
            if (acknowledged > 0) {
                assert_int_equal(count_records(&told.journal, "a", &records), ST_OK);
                assert_int_equal(records, acknowledged - 1);
            }
            told_end(&told);
            opened++;
        }
        fired = disk_syncs() >= n;
        assert_true(fired || acknowledged == EDITS + 1);
        disk_fail_at(0);
        open_store(&told, 0);
        unsigned records = 0;
        st_status status = count_records(&told.journal, "a", &records);
        /* There may be one record that was not acknowledged: it was written before the sync
         * failed. */
        assert_true(status == ST_OK ? records + 1 >= acknowledged && records <= acknowledged
                                    : status == ST_ABSENT && acknowledged == 0);
        told_end(&told);
        folder_remove(folder);
        folder_make(folder);
    }
    printf("note: each of %u syncs failed once; %u runs got beyond the start\n", runs - 1, opened);
    assert_true(runs > EDITS && opened > EDITS);
}

/* On a full disk, the journal checks for free space. If the sync of such a check fails, the journal
 * must stop writing, as after any other failed sync. */
static void a_failed_sync_on_a_full_disk_ends_writing(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = open_with_mesh(&told, 0);
    const st_journal *j = &told.journal;
    disk_fill(true);
    kept_mesh lost = mesh;
    told_wait(&told, kept_append(j, kept_edit(&lost), &lost, "1", 1));
    assert_int_equal(told.loss.status, ST_FULL);
    st_journal_measures measures;
    j->measure(j->self, &measures);
    assert_int_equal(measures.lost, 1);
    assert_string_equal(health_of(j).reason, "");
    disk_fail_at(1);
    disk_fill(false);
    const st_room_need need = {.records = 1, .bytes = 16};
    st_room *room = NULL;
    st_status status = ST_FULL;
    while ((status = j->reserve(j->self, &need, &room)) == ST_FULL) {
        sched_yield();
    }
    j->leave(j->self, room);
    assert_int_equal(status, ST_FAILED);
    assert_int_equal(health_of(j).status, ST_FAILED);
    assert_true(health_of(j).reason[0] != '\0');
    assert_true(disk_syncs() >= 1);
    disk_fail_at(0);
    told_end(&told);
}

static void what_no_row_can_hold_is_refused_at_once(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = new_mesh();
    open_store(&told, 0);
    const st_journal *j = &told.journal;
    const st_room_need need = {.records = 1, .bytes = ST_MOST_BODY + 1};
    st_room *room = NULL;
    assert_int_equal(j->reserve(j->self, &need, &room), ST_TOO_LARGE);
    assert_null(room);
    told_wait(&told, kept_append(j, kept_content(&mesh), &mesh, NULL, 0));
    assert_int_equal(told_losses(&told), 0);
    told_end(&told);
}

/* --- a slow disk --- */

static void a_slow_disk_bounds_the_queue(void **state)
{
    (void)state;
    enum { QUEUE = 64 << 10 };
    told_journal told;
    kept_mesh mesh = open_with_mesh(&told, QUEUE);
    const st_journal *j = &told.journal;
    disk_hold(true);
    uint64_t last = 0;
    unsigned queued = 0;
    for (;;) {
        kept_mesh next = mesh;
        uint64_t position = kept_append(j, kept_edit(&next), &next, "x", 1);
        if (position == 0) {
            break;
        }
        mesh = next;
        last = position;
        queued++;
    }
    assert_int_equal(kept_status(), ST_BEHIND);
    assert_true(queued > 8 && queued < QUEUE / 500);
    st_journal_measures measures;
    j->measure(j->self, &measures);
    assert_int_equal(measures.behind, queued);
    assert_true(measures.queued > QUEUE / 2 && measures.queued <= QUEUE);
    assert_int_equal(measures.most_queued, QUEUE);
    const st_room_need large = {.records = 1, .bytes = (size_t)4 * QUEUE};
    st_room *room = NULL;
    assert_int_equal(j->reserve(j->self, &large, &room), ST_BEHIND);
    disk_hold(false);
    told_wait(&told, last);
    /* A record that is larger than the limit on the queue must be accepted as soon as the queue is
     * empty. */
    st_status status;
    while ((status = j->reserve(j->self, &large, &room)) == ST_BEHIND) {
        sched_yield();
    }
    assert_int_equal(status, ST_OK);
    j->leave(j->self, room);
    unsigned records;
    assert_int_equal(count_records(j, "a", &records), ST_OK);
    assert_int_equal(records, queued);
    told_end(&told);
}

static void one_connection_writes(void **state)
{
    (void)state;
    told_journal told;
    (void)open_with_mesh(&told, 0);
    const st_journal *j = &told.journal;
    st_card card;
    st_reader *readers[2];
    st_stage *stage;
    assert_int_equal(j->open(j->self, "a", &card, &readers[0]), ST_OK);
    assert_int_equal(j->open(j->self, "a", &card, &readers[1]), ST_OK);
    assert_int_equal(j->stage(j->self, content, &stage), ST_OK);
    assert_int_equal(disk_writers(), 1);
    j->unstage(j->self, stage);
    j->shut(readers[0]);
    j->shut(readers[1]);
    told_end(&told);
    assert_int_equal(disk_writers(), 0);
}

/* --- memory is out --- */

/* Tries to make one change of each kind. Each attempt may fail, so the caller must check which
 * changes were made. */
static void use_all(told_journal *told, kept_mesh *mesh, unsigned *acknowledged)
{
    const st_journal *j = &told->journal;
    st_card cards[2];
    st_stage *stage = NULL;
    size_t count;
    unsigned records;
    kept_mesh next = *mesh;
    uint64_t position = kept_append(j, kept_content(&next), &next, NULL, 0);
    if (position != 0) {
        *mesh = next;
        told_wait(told, position);
        ++*acknowledged;
    } else {
        assert_int_equal(kept_status(), ST_NO_MEMORY);
        return;
    }
    st_status status = j->stage(j->self, content, &stage);
    assert_true(status == ST_OK || status == ST_NO_MEMORY);
    j->unstage(j->self, stage);
    next = *mesh;
    position = kept_append(j, kept_edit(&next), &next, "x", 1);
    if (position != 0) {
        *mesh = next;
        told_wait(told, position);
        ++*acknowledged;
    }
    status = count_records(j, "a", &records);
    assert_true(status == ST_OK || status == ST_NO_MEMORY);
    status = j->list(j->self, "", cards, 2, &count);
    assert_true(status == ST_OK || status == ST_NO_MEMORY);
}

static void without_memory_nothing_is_lost(void **state)
{
    (void)state;
    unsigned runs = 0;
    failing f = {.may_succeed = true, .sparse = 8};
    while (failing_next(&f)) {
        told_journal told;
        kept_mesh mesh = new_mesh();
        unsigned acknowledged = 0, records = 0;
        if (try_open(&told, 0)) {
            use_all(&told, &mesh, &acknowledged);
            assert_int_equal(told_losses(&told), 0);
            told_end(&told);
        }
        failing_end(&f, acknowledged == 2);
        runs++;
        open_store(&told, 0);
        st_status status = count_records(&told.journal, "a", &records);
        assert_int_equal(status, acknowledged == 0 ? ST_ABSENT : ST_OK);
        assert_true(acknowledged == 0 || records + 1 == acknowledged);
        told_end(&told);
        folder_remove(folder);
        folder_make(folder);
    }
    printf("note: %u of the requests for memory failed, each alone\n", runs - 1);
    assert_true(runs > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define STORE_TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        STORE_TEST(a_full_disk_loses_what_is_queued_and_recovers),
        STORE_TEST(a_store_starts_from_a_full_disk),
        STORE_TEST(a_full_disk_stays_full_until_there_is_space),
        STORE_TEST(the_folder_above_a_new_one_is_synced),
        STORE_TEST(rooms_from_before_are_lost_too_and_nothing_is_admitted_meanwhile),
        STORE_TEST(what_was_made_and_lost_was_never_there),
        STORE_TEST(after_a_failed_sync_nothing_is_acknowledged),
        STORE_TEST(a_failed_sync_on_a_full_disk_ends_writing),
        STORE_TEST(what_no_row_can_hold_is_refused_at_once),
        STORE_TEST(a_slow_disk_bounds_the_queue),
        STORE_TEST(one_connection_writes),
        STORE_TEST(without_memory_nothing_is_lost),
#undef STORE_TEST
    };
    disk_install();
    return cmocka_run_group_tests_name("journal_faults", tests, NULL, NULL);
}
