/* Jobs of a real daemon: progress as a client sees it, cancelling, a full queue, a mesh that can be
 * read but not written while a job edits it, undo afterwards, and a stop of the daemon while jobs
 * run. */
#include "tests/e2e/client.h"
#include "tests/sanitized.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define TORUS(side)    "{\"shape\":\"torus\",\"major_segments\":" side ",\"minor_segments\":" side "}"
#define TRANSFORM      "{\"op\":\"transform\",\"matrix\":[2,0,0,1,0,3,0,0,0,0,1,0,0,0,0,1]}"

static const char *const async[] = {"Prefer: respond-async", "Content-Type: application/json",
                                    NULL};

/* A file of this many quads is imported. */
#define IMPORTED (SANITIZED ? TORUS("500") : TORUS("1000"))
enum { IMPORTED_QUADS = SANITIZED ? 250000 : 1000000 };

/* Submits a job; `path` becomes the path of the job in the API. */
static void submit(client *c, const char *method, const char *target, const char *body,
                   char path[80])
{
    reply r = client_send(c, method, target, async, body);
    if (r.status != 202) {
        fail_msg("%s %s: %ld %s", method, target, r.status, r.body);
    }
    reply_header(&r, "Location", path, 80);
    reply_free(&r);
}

/* Requests the job again and again until it has ended; the caller must free the reply. */
static reply await(client *c, const char *path)
{
    for (;;) {
        reply r = client_get(c, path);
        assert_int_equal(r.status, 200);
        const char *state = reply_string(&r, "state");
        if (strcmp(state, "queued") != 0 && strcmp(state, "running") != 0) {
            return r;
        }
        reply_free(&r);
    }
}

/* Returns how many different values of progress a listener gets while a file is imported. The
 * import waits behind another job, so that the listener can connect before the import begins. */
static int hear_an_import(client *c, const reply *file)
{
    char first[80], second[80], events[100];
    submit(c, "PUT", "/v1/meshes/before", TORUS("700"), first);
    reply r = client_send_bytes(
        c, &(client_request){"PUT", "/v1/meshes/copy",
                             ARGUMENTS("Prefer: respond-async", "Content-Type: model/ply"),
                             file->body, file->length});
    assert_int_equal(r.status, 202);
    reply_header(&r, "Location", second, sizeof second);
    reply_free(&r);
    snprintf(events, sizeof events, "%s/events", second);
    r = client_get(c, events);
    assert_int_equal(r.status, 200);
    double last = -1;
    int values = 0;
    for (const char *at = r.body; (at = strstr(at, "\"progress\":")) != NULL;) {
        at += strlen("\"progress\":");
        double value = strtod(at, NULL);
        assert_true(value >= last);
        values += value > last;
        last = value;
    }
    assert_true(last == 1);
    assert_non_null(strstr(r.body, "event: bye"));
    reply_free(&r);
    r = await(c, second);
    assert_int_equal((int)reply_number(&r, "result.counts.faces"), IMPORTED_QUADS);
    reply_free(&r);
    return values;
}

/* On a busy machine the listener may connect too late for the progress; then the import is
 * repeated. */
static void an_import_tells_how_far_it_is(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off", "--jobs", "1"));
    client *c = client_new(d);
    reply r = client_send(c, "PUT", "/v1/meshes/t", NULL, IMPORTED);
    assert_int_equal(r.status, 201);
    reply_free(&r);
    reply file = client_get(c, "/v1/meshes/t/content?format=ply");
    assert_int_equal(file.status, 200);
    int values = 0;
    for (int tries = 0; tries < 5 && values < 20; tries++) {
        values = hear_an_import(c, &file);
    }
    assert_true(values >= 20);
    print_message("note: %d values of progress for %d quads\n", values, IMPORTED_QUADS);
    reply_free(&file);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_job_is_cancelled(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off"));
    client *c = client_new(d);
    char path[80];
    submit(c, "PUT", "/v1/meshes/huge", TORUS("4000"), path);
    reply r = client_send(c, "DELETE", path, NULL, NULL);
    assert_int_equal(r.status, 202);
    reply_free(&r);
    r = await(c, path);
    assert_string_equal(reply_string(&r, "state"), "cancelled");
    reply_free(&r);
    r = client_get(c, "/v1/meshes/huge");
    assert_int_equal(r.status, 404);
    reply_free(&r);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_full_queue_refuses(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off", "--jobs", "1", "--job-queue", "1"));
    client *c = client_new(d);
    int taken = 0;
    reply r;
    while ((r = client_send(c, "POST", "/v1/meshes", async, TORUS("4000"))).status == 202) {
        taken++;
        reply_free(&r);
    }
    char after[16];
    assert_int_equal(r.status, 503);
    assert_string_equal(reply_string(&r, "code"), "too_many_jobs");
    assert_string_not_equal(reply_header(&r, "Retry-After", after, sizeof after), "");
    assert_true(taken >= 1);
    reply_free(&r);
    client_free(c);
    /* the daemon stops while one job runs and another one waits */
    assert_int_equal(daemon_stop(d), 0);
}

static void a_long_edit_is_busy_readable_and_undone(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off", "--jobs", "2"));
    client *c = client_new(d);
    char path[80];
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":0}";
    reply r = client_send(c, "PUT", "/v1/meshes/m", NULL, TORUS("600"));
    assert_int_equal(r.status, 201);
    reply_free(&r);
    reply before = client_get(c, "/v1/meshes/m/content?format=ply");
    submit(c, "POST", "/v1/meshes/m/edits", TRANSFORM, path);
    /* Until the job has ended, the mesh must refuse edits but answer reads. */
    int refused = 0;
    for (;;) {
        r = client_post(c, "/v1/meshes/m/edits", poke);
        if (r.status != 409) {
            break;
        }
        assert_string_equal(reply_string(&r, "code"), "mesh_busy");
        refused++;
        reply_free(&r);
        r = client_get(c, "/v1/meshes/m/vertices/5");
        assert_int_equal(r.status, 200);
        reply_free(&r);
    }
    assert_int_equal(r.status, 200);
    assert_int_equal((int)reply_number(&r, "revision"), 3);
    print_message("note: refused %d times while it was busy\n", refused);
    reply_free(&r);
    r = await(c, path);
    assert_int_equal((int)reply_number(&r, "result.revision"), 2);
    reply_free(&r);
    for (int i = 0; i < 2; i++) {
        r = client_send(c, "POST", "/v1/meshes/m/undo", NULL, NULL);
        assert_int_equal(r.status, 200);
        reply_free(&r);
    }
    reply after = client_get(c, "/v1/meshes/m/content?format=ply");
    assert_int_equal(before.length, after.length);
    assert_memory_equal(before.body, after.body, before.length);
    reply_free(&before);
    reply_free(&after);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_import_tells_how_far_it_is),
        cmocka_unit_test(a_job_is_cancelled),
        cmocka_unit_test(a_full_queue_refuses),
        cmocka_unit_test(a_long_edit_is_busy_readable_and_undone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
