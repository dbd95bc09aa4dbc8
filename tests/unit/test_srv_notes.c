/* Tests of the jobs that the journal of a folder keeps. A start must restore a job in one of three
 * ways: as it was recorded last; as done, if the change that the job made was recorded; or not at
 * all. */
#include "tests/store_sql.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "journal/sqlite/sqlite_backup.h"

#include <unistd.h>

static char folder[FOLDER_PATH];
static he_mesh *content;
static told_journal told;

static void restart(void)
{
    told_end(&told);
    told_open(&told, folder);
}

static int setup(void **state)
{
    (void)state;
    folder_make(folder);
    content = script_mesh("012,023,034", NULL);
    told_open(&told, folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    told_end(&told);
    folder_remove(folder);
    he_mesh_free(content);
    return 0;
}

/* --- jobs --- */

enum { MOST = 8, BODY = 64 };

typedef struct seen {
    st_job jobs[MOST]; /* copies of the jobs; the strings of the copies are in `texts` */
    char texts[MOST][600], bodies[MOST][BODY];
    size_t count, most;
} seen;

static bool take(void *context, const st_job *job)
{
    seen *s = context;
    if (s->count == s->most) {
        return false;
    }
    snprintf(s->texts[s->count], sizeof s->texts[0], "%s|%s|%s|%s|%s|%s|%s|%s|%s", job->operation,
             job->phase, job->mesh, job->location, job->holder, job->headers[0], job->headers[1],
             job->headers[2], job->headers[3]);
    assert_true(job->length < BODY);
    if (job->body != NULL) {
        memcpy(s->bodies[s->count], job->body, job->length);
    }
    s->jobs[s->count++] = *job;
    return true;
}

static seen jobs_kept(void)
{
    seen s = {.most = MOST};
    assert_int_equal(told.journal.jobs(told.journal.self, take, &s), ST_OK);
    return s;
}

static st_job accepted(const char *id, uint64_t number)
{
    st_job job = {.number = number,
                  .state = ST_JOB_ACCEPTED,
                  .operation = "apply_edits",
                  .phase = "",
                  .mesh = "m",
                  .location = "",
                  .holder = "token",
                  .created = 100 + (double)number,
                  .headers = {"", "", "", ""}};
    snprintf(job.id, sizeof job.id, "%s", id);
    return job;
}

static void note(const st_note *what)
{
    uint64_t position = 0;
    assert_int_equal(told.journal.note(told.journal.self, what, &position), ST_OK);
    assert_true(position > 0);
    told_wait(&told, position);
}

static void note_job(const st_job *job)
{
    note(&(st_note){.job = job});
}

static void a_job_comes_back_as_it_was_noted_last(void **state)
{
    (void)state;
    st_job a = accepted("a", 2), b = accepted("b", 1), none = accepted("none", 3);
    note_job(&a);
    note_job(&b);
    note_job(&none);
    a.state = ST_JOB_FAILED;
    a.phase = "welding";
    a.location = "/v1/meshes/n";
    a.progress = 0.25;
    a.started = 103;
    a.finished = 104;
    a.status = 422;
    a.shown = true;
    a.headers[ST_JOB_TYPE] = "text/plain";
    a.headers[ST_JOB_TAG] = "\"tag\"";
    a.body = "with\0in";
    a.length = 7;
    note_job(&a);
    note(&(st_note){.forgotten = "none"});
    for (int again = 0; again < 2; again++) {
        const seen s = jobs_kept();
        assert_int_equal(s.count, 2);
        assert_string_equal(s.jobs[0].id, "b"); /* jobs are sorted by number */
        assert_int_equal(s.jobs[0].state, ST_JOB_ACCEPTED);
        assert_null(s.jobs[0].body);
        assert_string_equal(s.texts[0], "apply_edits||m||token||||");
        const st_job *is = &s.jobs[1];
        assert_string_equal(s.texts[1],
                            "apply_edits|welding|m|/v1/meshes/n|token|text/plain||\"tag\"|");
        assert_int_equal(is->state, ST_JOB_FAILED);
        assert_int_equal(is->status, 422);
        assert_true(is->shown && is->number == 2 && is->progress == 0.25);
        assert_true(is->created == 102 && is->started == 103 && is->finished == 104);
        assert_int_equal(is->length, 7);
        assert_memory_equal(s.bodies[1], "with\0in", 7);
        restart();
    }
    seen few = {.most = 1};
    assert_int_equal(told.journal.jobs(told.journal.self, take, &few), ST_NO_MEMORY);
}

static void append(kept_mesh *mesh, st_record record, const char *job)
{
    record.job = job;
    record.time = 200;
    const bool first = record.number == 1;
    told_wait(&told, kept_append(&told.journal, record, mesh, first ? NULL : "x", first ? 0 : 1));
}

static void a_job_is_done_with_its_record(void **state)
{
    (void)state;
    kept_mesh mesh = {.id = "m", .name = "", .content = content, .incarnation = 11};
    const st_job makes = accepted("makes", 1), edits = accepted("edits", 2);
    note_job(&makes);
    note_job(&edits);
    append(&mesh, kept_content(&mesh), "makes");
    append(&mesh, kept_edit(&mesh), "edits");
    append(&mesh, kept_edit(&mesh), "of which nothing is kept");
    restart();
    const seen s = jobs_kept();
    assert_int_equal(s.count, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(s.jobs[i].state, ST_JOB_DONE);
        assert_true(s.jobs[i].progress == 1 && s.jobs[i].finished == 200);
        assert_int_equal(s.jobs[i].status, i == 0 ? 201 : 204);
        assert_string_equal(s.texts[i], "apply_edits||m||token||||");
    }
}

static void old_jobs_go_when_new_ones_come(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 4; i++) {
        char id[2] = {(char)('a' + i), '\0'};
        st_job job = accepted(id, i + 1);
        job.state = ST_JOB_DONE;
        job.finished = 1000 + (double)i;
        note_job(&job);
    }
    st_job late = accepted("late", 5);
    late.created = 1001 + ST_JOB_SECONDS;
    note_job(&late); /* at this time only the job "a" is old enough to be deleted */
    assert_int_equal(jobs_kept().count, 4);
    late.created = 5000 + ST_JOB_SECONDS;
    note_job(&late);
    note_job(&late); /* each call deletes at most two old jobs, so a second call is needed */
    const seen s = jobs_kept();
    assert_int_equal(s.count, 1);
    assert_string_equal(s.jobs[0].id, "late");
}

static void a_damaged_job_is_as_good_as_none(void **state)
{
    (void)state;
    const st_job a = accepted("a", 1), b = accepted("b", 2);
    note_job(&a);
    note_job(&b);
    store_sql_run(folder, "UPDATE job SET number = 9 WHERE id = 'a'");
    store_sql_run(folder, "UPDATE job SET state = 7 WHERE id = 'b'");
    assert_int_equal(jobs_kept().count, 0);
    /* The damaged record of a job must be dropped, but the change that the job made must stay. */
    kept_mesh mesh = {.id = "m", .name = "", .content = content, .incarnation = 11};
    append(&mesh, kept_content(&mesh), "a");
    assert_int_equal(told_losses(&told), 0);
    assert_int_equal(told.journal.count(told.journal.self), 1);
}

/* A database of version 1 has no table of jobs. The first start with this release must upgrade the
 * database, and so must a restore. */
static void an_older_file_is_raised(void **state)
{
    (void)state;
    char backup[2 * FOLDER_PATH], message[ST_SQLITE_MESSAGE], before[ST_SQLITE_MESSAGE];
    (void)snprintf(backup, sizeof backup, "%s.db", folder);
    kept_mesh mesh = {.id = "m", .name = "", .content = content, .incarnation = 11};
    append(&mesh, kept_content(&mesh), NULL);
    told_end(&told);
    store_sql_run(folder, "DROP TABLE job; DROP INDEX mesh_by_name; DROP INDEX mesh_by_modified; "
                          "DROP INDEX mesh_by_bytes; PRAGMA user_version = 1");
    assert_true(st_sqlite_backup(folder, backup, message));
    st_sqlite_opened look;
    assert_true(st_sqlite_look(backup, &look));
    assert_int_equal(look.journal.count(look.journal.self), 1);
    look.journal.close(look.journal.self);
    for (int way = 0; way < 2; way++) {
        told_open(&told, folder);
        const st_job a = accepted("a", 1);
        note_job(&a);
        assert_int_equal(jobs_kept().count, 1);
        assert_int_equal(told.journal.count(told.journal.self), 1);
        told_end(&told);
        if (way == 0 && !st_sqlite_restore(folder, backup, before, message)) {
            fail_msg("%s", message);
        }
    }
    folder_remove(before);
    (void)unlink(backup);
    told_open(&told, folder);
}

/* The entity tag of a job names a state that may not exist after a restore, so a restore must
 * remove the tag. */
static void a_restore_takes_the_tags(void **state)
{
    (void)state;
    char backup[2 * FOLDER_PATH], message[ST_SQLITE_MESSAGE], before[ST_SQLITE_MESSAGE];
    (void)snprintf(backup, sizeof backup, "%s.db", folder);
    st_job a = accepted("a", 1);
    a.state = ST_JOB_DONE;
    a.headers[ST_JOB_TAG] = "\"tag\"";
    a.body = "{}";
    a.length = 2;
    note_job(&a);
    assert_true(st_sqlite_backup(folder, backup, message));
    told_end(&told);
    if (!st_sqlite_restore(folder, backup, before, message)) {
        fail_msg("%s", message);
    }
    folder_remove(before);
    (void)unlink(backup);
    told_open(&told, folder);
    const seen s = jobs_kept();
    assert_int_equal(s.count, 1);
    assert_string_equal(s.texts[0], "apply_edits||m||token||||");
    assert_memory_equal(s.bodies[0], "{}", 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define STORE_TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
        STORE_TEST(a_job_comes_back_as_it_was_noted_last),
        STORE_TEST(a_job_is_done_with_its_record),
        STORE_TEST(old_jobs_go_when_new_ones_come),
        STORE_TEST(a_damaged_job_is_as_good_as_none),
        STORE_TEST(an_older_file_is_raised),
        STORE_TEST(a_restore_takes_the_tags),
#undef STORE_TEST
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
