/* What a client has from a daemon must stay valid after the daemon was stopped or killed and
 * started again: jobs, idempotency keys, cursors, event ids and entity tags. */
#include "tests/e2e/client.h"
#include "tests/e2e/listener.h"
#include "tests/store_folder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define CUBE           "{\"shape\":\"cube\"}"
#define LONG           "{\"shape\":\"torus\",\"major_segments\":2000,\"minor_segments\":2000}"
#define ASYNC          "Prefer: respond-async"

static char folder[FOLDER_PATH], store[FOLDER_PATH + 16];
static daemon_process *server;
static client *http;
static bool kills; /* true: the daemon is killed; false: it is stopped */

static void begin(void)
{
    server = daemon_start(ARGUMENTS("--store", store, "--jobs", "1"));
    http = client_new(server);
}

static int setup(bool with_kills)
{
    kills = with_kills;
    folder_make(folder);
    snprintf(store, sizeof store, "sqlite:%s", folder);
    begin();
    return 0;
}

static int setup_kill(void **state)
{
    (void)state;
    return setup(true);
}

static int setup_stop(void **state)
{
    (void)state;
    return setup(false);
}

static int teardown(void **state)
{
    (void)state;
    client_free(http);
    int status = daemon_stop(server);
    folder_remove(folder);
    return status;
}

static void end_and_begin(void)
{
    client_free(http);
    if (kills) {
        daemon_kill(server);
    } else {
        assert_int_equal(daemon_stop(server), 0);
    }
    begin();
}

static reply ask(long status, const char *method, const char *path, const char *body,
                 const char *const *headers)
{
    return reply_expect(status, client_send(http, method, path, headers, body));
}

static void send(const char *method, const char *path, const char *body, long status)
{
    reply_done(ask(status, method, path, body, NULL));
}

enum { PATH = 80 };

static void submit(const char *method, const char *path, const char *body, const char *key,
                   char job[PATH])
{
    reply r = ask(202, method, path, body, ARGUMENTS(ASYNC, "Content-Type: application/json", key));
    (void)reply_header(&r, "Location", job, PATH);
    reply_free(&r);
}

/* Waits until the job has ended and returns it; the caller must free it. */
static char *await(const char *job)
{
    for (;;) {
        reply r = reply_expect(200, client_get(http, job));
        if (!reply_is_null(&r, "finished")) {
            char *text = strdup(r.body);
            reply_free(&r);
            return text;
        }
        reply_free(&r);
    }
}

static void expect_job(const char *job, const char *text)
{
    reply r = reply_expect(200, client_get(http, job));
    assert_string_equal(r.body, text);
    reply_free(&r);
}

static void expect_interrupted(const char *job)
{
    reply r = reply_expect(200, client_get(http, job));
    char path[PATH + 10];
    assert_string_equal(reply_string(&r, "state"), "failed");
    assert_string_equal(reply_string(&r, "problem.code"), "interrupted");
    assert_non_null(strstr(reply_string(&r, "problem.detail"), "can be sent again"));
    assert_true(reply_number(&r, "status") == 503);
    assert_false(reply_is_null(&r, "finished"));
    assert_true(reply_is_null(&r, "location"));
    reply_free(&r);
    snprintf(path, sizeof path, "%s/result", job);
    reply_done(reply_expect(404, client_get(http, path)));
}

/* --- jobs --- */

static void jobs_that_had_ended_are_told_as_before(void **state)
{
    (void)state;
    char edit[PATH], made[PATH], failed[PATH], read[PATH], gone[PATH], path[PATH + 10];
    char tag[200], again[200];
    send("PUT", "/v1/meshes/m", CUBE, 201);
    submit("POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}", NULL, edit);
    submit("POST", "/v1/meshes?id=n", CUBE, NULL, made);
    submit("POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":999}", NULL, failed);
    submit("GET", "/v1/meshes/m/content?format=obj", "", NULL, read);
    submit("POST", "/v1/meshes", CUBE, NULL, gone);
    free(await(gone));
    char *const told[] = {await(edit), await(made), await(failed), await(read)};
    const char *const jobs[] = {edit, made, failed, read};
    assert_non_null(strstr(told[0], "\"state\":\"done\""));
    assert_non_null(strstr(told[1], "\"location\":\"/v1/meshes/n\""));
    assert_non_null(strstr(told[2], "\"state\":\"failed\""));
    snprintf(path, sizeof path, "%s/result", edit);
    reply r = reply_expect(200, client_get(http, path));
    (void)reply_header(&r, "ETag", tag, sizeof tag);
    reply_free(&r);
    snprintf(path, sizeof path, "%s/result", read);
    r = reply_expect(200, client_get(http, path));
    char *file = strdup(r.body);
    reply_free(&r);
    /* A cursor of the list of jobs, taken before the restart, must lead to the next page
     * afterwards. */
    r = reply_expect(200, client_get(http, "/v1/jobs?limit=2"));
    char *next = strdup(reply_string(&r, "next")), list[200];
    reply_free(&r);
    send("DELETE", gone, "", 204);
    for (int end = 0; end < 2; end++) {
        end_and_begin();
        for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
            expect_job(jobs[i], told[i]);
        }
        reply_done(reply_expect(404, client_get(http, gone)));
        snprintf(path, sizeof path, "%s/result", edit);
        r = reply_expect(200, client_get(http, path));
        assert_string_equal(reply_header(&r, "ETag", again, sizeof again), tag);
        reply_free(&r);
        snprintf(path, sizeof path, "%s/result", read);
        r = reply_expect(200, client_get(http, path));
        assert_string_equal(r.body, file);
        assert_string_equal(reply_header(&r, "Content-Type", again, sizeof again), "model/obj");
        reply_free(&r);
        snprintf(list, sizeof list, "/v1/jobs?cursor=%s", next);
        r = reply_expect(200, client_get(http, list));
        assert_int_equal(cJSON_GetArraySize(reply_find(&r, "items")), 2);
        assert_string_equal(reply_string(&r, "items.1.id"), read + strlen("/v1/jobs/"));
        reply_free(&r);
    }
    /* A job submitted after the restart must be the last one in the list. */
    submit("POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":1}", NULL, edit);
    r = reply_expect(200, client_get(http, "/v1/jobs"));
    assert_string_equal(reply_string(&r, "items.4.id"), edit + strlen("/v1/jobs/"));
    reply_free(&r);
    for (size_t i = 0; i < sizeof told / sizeof *told; i++) {
        free(told[i]);
    }
    free(next);
    free(file);
}

static void jobs_that_had_not_ended_were_interrupted(void **state)
{
    (void)state;
    char running[PATH], waiting[PATH], again[PATH], tag[200], now[200];
    send("PUT", "/v1/meshes/m", CUBE, 201);
    reply r = reply_expect(200, client_get(http, "/v1/meshes/m"));
    (void)reply_header(&r, "ETag", tag, sizeof tag);
    reply_free(&r);
    submit("PUT", "/v1/meshes/long", LONG, NULL, running);
    client_await_running(http, running);
    submit("POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}", "Idempotency-Key: k",
           waiting);
    end_and_begin();
    expect_interrupted(running);
    expect_interrupted(waiting);
    reply_done(reply_expect(404, client_get(http, "/v1/meshes/long")));
    r = reply_expect(200, client_get(http, "/v1/meshes/m"));
    assert_string_equal(reply_header(&r, "ETag", now, sizeof now), tag);
    reply_free(&r);
    char *told = await(waiting);
    end_and_begin();
    expect_job(waiting, told);
    free(told);
    /* The job that had the idempotency key was interrupted, so the repeated request must be
     * executed. */
    submit("POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}", "Idempotency-Key: k",
           again);
    told = await(again);
    assert_non_null(strstr(told, "\"state\":\"done\""));
    free(told);
    send("DELETE", waiting, "", 204);
    end_and_begin();
    reply_done(reply_expect(404, client_get(http, waiting)));
    reply_done(reply_expect(200, client_get(http, again)));
}

/* --- keys --- */

static reply repeat(const char *path, const char *body, const char *key, const char *prefer,
                    long status)
{
    return ask(status, "POST", path, body,
               ARGUMENTS(prefer, "Content-Type: application/json", key));
}

static void keyed_requests_are_not_done_again(void **state)
{
    (void)state;
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":0}",
                      nothing[] = "{\"op\":\"vertex_move\",\"vertex\":0,\"by\":[0,0,0]}";
    char job[PATH], tag[200], dry[200], now[200], replayed[10];
    send("PUT", "/v1/meshes/m", CUBE, 201);
    reply r = repeat("/v1/meshes/m/edits", nothing, "Idempotency-Key: nothing", "X-None: 1", 200);
    (void)reply_header(&r, "ETag", dry, sizeof dry);
    reply_free(&r);
    submit("POST", "/v1/meshes/m/edits", poke, "Idempotency-Key: job", job);
    free(await(job));
    submit("POST", "/v1/meshes?id=n", CUBE, "Idempotency-Key: made", job);
    free(await(job));
    r = reply_expect(200, client_get(http, "/v1/meshes/m/edits"));
    (void)reply_header(&r, "ETag", tag, sizeof tag);
    reply_free(&r);
    for (int end = 0; end < 2; end++) {
        end_and_begin();
        r = repeat("/v1/meshes/m/edits", poke, "Idempotency-Key: job", ASYNC, 204);
        assert_string_equal(reply_header(&r, "Idempotency-Replayed", replayed, sizeof replayed),
                            "true");
        reply_free(&r);
        r = repeat("/v1/meshes?id=n", CUBE, "Idempotency-Key: made", ASYNC, 201);
        assert_string_equal(reply_header(&r, "Location", now, sizeof now), "/v1/meshes/n");
        reply_free(&r);
        r = repeat("/v1/meshes/m/edits", nothing, "Idempotency-Key: nothing", "X-None: 1", 204);
        assert_string_equal(reply_header(&r, "ETag", now, sizeof now), dry);
        reply_free(&r);
        r = reply_expect(200, client_get(http, "/v1/meshes/m/edits"));
        assert_string_equal(reply_header(&r, "ETag", now, sizeof now), tag);
        reply_free(&r);
    }
}

/* --- cursors, tags, event ids --- */

static char *next_page(const char *path)
{
    reply r = reply_expect(200, client_get(http, path));
    char *next = strdup(reply_string(&r, "next"));
    reply_free(&r);
    return next;
}

/* Returns a page of a list, without the last members of a list of meshes: the numbers of listeners
 * and of bytes that the whole server uses, which differ after a restart. */
static char *page(const char *format, const char *cursor)
{
    char path[400];
    snprintf(path, sizeof path, format, cursor);
    reply r = reply_expect(200, client_get(http, path));
    char *body = strdup(r.body), *totals = strstr(body, ",\"listeners\"");
    if (totals != NULL) {
        *totals = '\0';
    }
    reply_free(&r);
    return body;
}

static void cursors_tags_and_event_ids_go_on(void **state)
{
    (void)state;
    static const char *const lists[][2] = {
        {"/v1/meshes?limit=1", "/v1/meshes?limit=1&cursor=%s"},
        {"/v1/meshes?sort=name&limit=1", "/v1/meshes?sort=name&limit=1&cursor=%s"},
        {"/v1/meshes?sort=modified&limit=1", "/v1/meshes?sort=modified&limit=1&cursor=%s"},
        {"/v1/meshes?sort=bytes&limit=1", "/v1/meshes?sort=bytes&limit=1&cursor=%s"},
        {"/v1/meshes/m/edits?limit=1", "/v1/meshes/m/edits?limit=1&cursor=%s"},
        {"/v1/meshes/m/faces?limit=3", "/v1/meshes/m/faces?limit=3&cursor=%s"},
        {"/v1/meshes/m/vertices?limit=3", "/v1/meshes/m/vertices?limit=3&cursor=%s"},
    };
    static const char *const tagged[] = {"/v1/meshes/m", "/v1/meshes/m/edits", "/v1/meshes/m/faces",
                                         "/v1/meshes/m/content"};
    enum { LISTS = sizeof lists / sizeof *lists, TAGGED = sizeof tagged / sizeof *tagged };
    char tags[TAGGED][220], last[64];
    char *cursors[LISTS], *pages[LISTS];
    send("PUT", "/v1/meshes/m", CUBE, 201);
    send("PUT", "/v1/meshes/n", CUBE, 201);
    for (int face = 0; face < 3; face++) {
        char body[64];
        snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%d}", face);
        send("POST", "/v1/meshes/m/edits", body, 200);
    }
    for (size_t i = 0; i < LISTS; i++) {
        cursors[i] = next_page(lists[i][0]);
        pages[i] = page(lists[i][1], cursors[i]);
    }
    for (size_t i = 0; i < TAGGED; i++) {
        char tag[200];
        reply r = reply_expect(200, client_get(http, tagged[i]));
        snprintf(tags[i], sizeof tags[i], "If-None-Match: %s",
                 reply_header(&r, "ETag", tag, sizeof tag));
        reply_free(&r);
    }
    snprintf(last, sizeof last, "%.*s.2", (int)strcspn(tags[0] + strlen("If-None-Match: \""), "-"),
             tags[0] + strlen("If-None-Match: \""));
    for (int end = 0; end < 2; end++) {
        end_and_begin();
        listener *l = listener_open(server, "/v1/meshes/m/events", last, 0);
        assert_string_equal(listener_next(l, true), "metadata");
        for (int revision = 3; revision <= 4; revision++) {
            assert_string_equal(listener_next(l, true), "edit");
            assert_int_equal(listener_number(l, "revision"), revision);
        }
        listener_close(l);
        for (size_t i = 0; i < LISTS; i++) {
            char *again = page(lists[i][1], cursors[i]);
            assert_string_equal(again, pages[i]);
            free(again);
        }
        for (size_t i = 0; i < TAGGED; i++) {
            reply_done(ask(304, "GET", tagged[i], "", ARGUMENTS(tags[i])));
        }
    }
    for (size_t i = 0; i < LISTS; i++) {
        free(cursors[i]);
        free(pages[i]);
    }
}

int main(void)
{
#define BOTH_WAYS(name)                                          \
    cmocka_unit_test_setup_teardown(name, setup_kill, teardown), \
        cmocka_unit_test_setup_teardown(name, setup_stop, teardown)
    const struct CMUnitTest tests[] = {
        BOTH_WAYS(jobs_that_had_ended_are_told_as_before),
        BOTH_WAYS(jobs_that_had_not_ended_were_interrupted),
        BOTH_WAYS(keyed_requests_are_not_done_again),
        BOTH_WAYS(cursors_tags_and_event_ids_go_on),
    };
#undef BOTH_WAYS
    return cmocka_run_group_tests(tests, NULL, NULL);
}
