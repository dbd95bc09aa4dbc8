/* A daemon is killed or stopped, and started again on its folder. Everything that it had
 * acknowledged must be there, including the history, and must be editable. */
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

static char folder[FOLDER_PATH], store[FOLDER_PATH + 16];
static daemon_process *server;
static client *http;

static void begin(void)
{
    server = daemon_start((const char *const[]){"--store", store, "--jobs", "2", NULL});
    http = client_new(server);
}

static int setup(void **state)
{
    (void)state;
    folder_make(folder);
    snprintf(store, sizeof store, "sqlite:%s", folder);
    begin();
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    client_free(http);
    int status = daemon_stop(server);
    folder_remove(folder);
    return status;
}

static void kill_and_start(void)
{
    client_free(http);
    daemon_kill(server);
    begin();
}

static void stop_and_start(void)
{
    client_free(http);
    assert_int_equal(daemon_stop(server), 0);
    begin();
}

static void send(const char *method, const char *path, const char *body, long status)
{
    reply_done(reply_expect(status, client_send(http, method, path, NULL, body)));
}

/* Replaces the values in an answer that may differ between two processes although the meshes are
 * equal, such as the bytes that a mesh takes in memory. */
static void blank(char *text)
{
    for (char *at = strstr(text, "\"memory_"); at != NULL; at = strstr(at + 1, "\"memory_")) {
        memset(at, ' ', strcspn(at, ",}"));
    }
}

/* Returns everything that clients can see of the meshes, including entity tags and histories. */
static char *state_of(void)
{
    static const char *const targets[] = {"/v1/meshes",
                                          "/v1/meshes?sort=name",
                                          "/v1/meshes?sort=modified",
                                          "/v1/meshes?sort=bytes",
                                          "/v1/meshes?sort=name&limit=1",
                                          "/v1/meshes?contains=S",
                                          "/v1/meshes/m",
                                          "/v1/meshes/m/edits?limit=1000",
                                          "/v1/meshes/m/content",
                                          "/v1/meshes/m/faces",
                                          "/v1/meshes/m/vertices",
                                          "/v1/meshes/m/edges",
                                          "/v1/meshes/m/attributes",
                                          "/v1/meshes/n",
                                          "/v1/meshes/n/content",
                                          "/v1/meshes/m/content?revision=2"};
    enum { MOST = 1 << 20 };
    char *state = calloc(1, MOST), tag[200];
    assert_non_null(state);
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        reply r = reply_expect(200, client_get(http, targets[i]));
        blank(r.body);
        size_t length = strlen(state);
        assert_true(length + r.length + 400 < MOST);
        snprintf(state + length, MOST - length, "%s %s\n%s\n", targets[i],
                 reply_header(&r, "ETag", tag, sizeof tag), r.body);
        reply_free(&r);
    }
    return state;
}

static char *content_of(const char *mesh)
{
    char path[100];
    snprintf(path, sizeof path, "/v1/meshes/%s/content", mesh);
    reply r = reply_expect(200, client_get(http, path));
    char *body = strdup(r.body);
    reply_free(&r);
    return body;
}

static void make_history(void)
{
    send("PUT", "/v1/meshes/m?name=first", "{\"shape\":\"cube\"}", 201);
    send("PUT", "/v1/meshes/n", "{\"shape\":\"octahedron\"}", 201);
    send("PUT", "/v1/meshes/gone", "{\"shape\":\"octahedron\"}", 201);
    send("POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}", 200);
    send("POST", "/v1/meshes/m/edits",
         "{\"ops\":[{\"op\":\"vertex_move\",\"vertex\":1,\"by\":[0.1,0,0.25]},"
         "{\"op\":\"edge_split\",\"edge\":3},{\"op\":\"face_delete\",\"faces\":[2]}]}",
         200);
    send("PUT", "/v1/meshes/m/attributes/faces/kind",
         "{\"type\":\"uint32\",\"default\":1,\"labels\":[\"a\",\"b\"]}", 201);
    send("POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":1}", 200);
    send("POST", "/v1/meshes/m/undo", "{\"steps\":3}", 200);
    send("POST", "/v1/meshes/m/redo", "{}", 200);
    send("PATCH", "/v1/meshes/m", "{\"name\":\"second\"}", 200);
    send("PATCH", "/v1/meshes/m/edits/2", "{\"name\":\"poked\"}", 200);
    send("PATCH", "/v1/meshes/m/edits/5", "{\"name\":\"for a while\"}", 200);
    send("PATCH", "/v1/meshes/m/edits/8", "{\"name\":\"an undo\"}", 200);
    send("PATCH", "/v1/meshes/m/edits/5", "{\"name\":null}", 200);
    send("DELETE", "/v1/meshes/gone", "", 204);
    send("PUT", "/v1/meshes/n?name=replaced", "{\"shape\":\"tetrahedron\"}", 200);
    send("POST", "/v1/meshes/n/edits", "{\"op\":\"face_delete\",\"face\":0}", 200);
    send("POST", "/v1/meshes/n/edits", "{\"op\":\"compact\"}", 200);
}

static void expect_state(const char *before)
{
    char *after = state_of();
    assert_string_equal(before, after);
    free(after);
}

static void what_was_answered_is_there_after_a_kill(void **state)
{
    (void)state;
    make_history();
    char *before = state_of();
    kill_and_start();
    reply_done(reply_expect(404, client_get(http, "/v1/meshes/gone")));
    expect_state(before);
    /* The state must also survive a stop by a signal and another start. The list of meshes is
     * requested before any mesh is loaded from the disk. */
    stop_and_start();
    expect_state(before);
    free(before);
}

static void undo_and_redo_lead_where_they_would_have_led(void **state)
{
    (void)state;
    static const char *const steps[] = {"undo", "undo", "redo", "redo", "redo", "redo", "redo"};
    enum { STEPS = sizeof steps / sizeof *steps };
    char *would[STEPS], path[64];
    make_history();
    send("PUT", "/v1/meshes/again", "{\"shape\":\"cube\"}", 201);
    /* The folder is copied after a stop, so that two daemons can start from the same state. One of
     * them undoes and redoes without interruption, the other one is killed after each step. Both
     * must show the same meshes. */
    char other[FOLDER_PATH];
    folder_make(other);
    client_free(http);
    assert_int_equal(daemon_stop(server), 0);
    folder_copy(folder, other);
    begin();
    for (size_t i = 0; i < STEPS; i++) {
        snprintf(path, sizeof path, "/v1/meshes/m/%s", steps[i]);
        send("POST", path, "{}", i < STEPS - 1 ? 200 : 409);
        would[i] = content_of("m");
    }
    client_free(http);
    daemon_kill(server);
    snprintf(store, sizeof store, "sqlite:%s", other);
    begin();
    for (size_t i = 0; i < STEPS; i++) {
        snprintf(path, sizeof path, "/v1/meshes/m/%s", steps[i]);
        send("POST", path, "{}", i < STEPS - 1 ? 200 : 409);
        char *is = content_of("m");
        assert_string_equal(would[i], is);
        free(is);
        free(would[i]);
        kill_and_start();
    }
    folder_remove(folder);
    snprintf(folder, sizeof folder, "%s", other);
}

/* The entity tags of a state that was replaced or removed must never name another state. */
static void a_tag_names_one_state_for_ever(void **state)
{
    (void)state;
    enum { TIMES = 4 };
    char tags[TIMES][200];
    for (int i = 0; i < TIMES; i++) {
        send("PUT", "/v1/meshes/m",
             i % 2 == 0 ? "{\"shape\":\"cube\"}" : "{\"shape\":\"octahedron\"}", 201);
        kill_and_start();
        reply r = reply_expect(200, client_get(http, "/v1/meshes/m"));
        (void)reply_header(&r, "ETag", tags[i], sizeof tags[i]);
        reply_free(&r);
        for (int k = 0; k < i; k++) {
            assert_string_not_equal(tags[i], tags[k]);
        }
        send("DELETE", "/v1/meshes/m", "", 204);
        kill_and_start();
        reply_done(reply_expect(404, client_get(http, "/v1/meshes/m")));
    }
}

/* A request that was answered before the kill must not be executed again when it is repeated
 * afterwards. */
static void a_key_is_good_after_a_restart(void **state)
{
    (void)state;
    static const char shape[] = "{\"shape\":\"cube\"}",
                      poke[] = "{\"op\":\"face_poke\",\"face\":0}";
    static const struct {
        const char *method, *path, *body, *key;
        long status, again;
    } rows[] = {
        {"POST", "/v1/meshes?id=m", shape, "Idempotency-Key: a", 201, 201},
        {"POST", "/v1/meshes/m/edits", poke, "Idempotency-Key: b", 200, 204},
        {"POST", "/v1/meshes/m/undo", "{}", "Idempotency-Key: c", 200, 204},
        {"PATCH", "/v1/meshes/m", "{\"name\":\"n\"}", "Idempotency-Key: d", 200, 204},
        {"POST", "/v1/meshes/m/copy", "{\"id\":\"o\"}", "Idempotency-Key: e", 201, 201},
    };
    enum { ROWS = sizeof rows / sizeof *rows };
    char tags[ROWS][200], tag[200];
    for (int again = 0; again < 2; again++) {
        for (size_t i = 0; i < ROWS; i++) {
            const char *const headers[] = {rows[i].key, NULL};
            reply r = reply_expect(
                again ? rows[i].again : rows[i].status,
                client_send(http, rows[i].method, rows[i].path, headers, rows[i].body));
            assert_string_equal(reply_header(&r, "Idempotency-Replayed", tag, sizeof tag),
                                again ? "true" : "");
            (void)reply_header(&r, "ETag", again ? tag : tags[i], sizeof tag);
            if (again) {
                assert_string_equal(tag, tags[i]);
            }
            reply_free(&r);
        }
        kill_and_start();
    }
    static const char *const other[] = {"Idempotency-Key: b", NULL};
    reply_done(reply_expect(422, client_send(http, "POST", "/v1/meshes/m/edits", other, "{}")));
    reply r = reply_expect(200, client_get(http, "/v1/meshes/m"));
    assert_true(reply_number(&r, "revision") == 3);
    reply_free(&r);
}

/* The Last-Event-ID of a listener is from before the restart: the listener must get the later
 * events from the history on the disk. If its mesh has been replaced by another one with the same
 * id, the listener must be told to fetch the mesh anew. */
static void listeners_go_on_where_they_were(void **state)
{
    (void)state;
    char tag[200], last[64];
    send("PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}", 201);
    for (int face = 0; face < 3; face++) {
        char body[64];
        snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%d}", face);
        send("POST", "/v1/meshes/m/edits", body, 200);
    }
    reply r = reply_expect(200, client_get(http, "/v1/meshes/m"));
    (void)reply_header(&r, "ETag", tag, sizeof tag);
    reply_free(&r);
    tag[strcspn(tag, "-")] = '\0';
    snprintf(last, sizeof last, "%.32s.2", tag + 1);
    kill_and_start();
    listener *l = listener_open(server, "/v1/meshes/m/events", last, 0);
    assert_string_equal(listener_next(l, true), "metadata");
    for (int revision = 3; revision <= 4; revision++) {
        assert_string_equal(listener_next(l, true), "edit");
        assert_int_equal(listener_number(l, "revision"), revision);
    }
    send("POST", "/v1/meshes/m/undo", "{}", 200);
    assert_string_equal(listener_next(l, true), "edit");
    assert_int_equal(listener_number(l, "revision"), 5);
    assert_string_equal(listener_string(l, "action"), "undo");
    listener_close(l);

    send("DELETE", "/v1/meshes/m", "", 204);
    send("PUT", "/v1/meshes/m", "{\"shape\":\"octahedron\"}", 201);
    kill_and_start();
    l = listener_open(server, "/v1/meshes/m/events", last, 0);
    assert_string_equal(listener_next(l, true), "resync");
    assert_string_equal(listener_string(l, "reason"), "incarnation");
    listener_close(l);
}

static double meshes_there(void)
{
    reply r = reply_expect(200, client_get(http, "/v1/meshes"));
    double count = cJSON_GetArraySize(reply_find(&r, "items"));
    reply_free(&r);
    return count;
}

/* The first start of a daemon on a folder adds sample meshes. If the daemon is killed before all of
 * them are there, the next start must add the rest. A sample that was deleted must not come
 * back. */
static void samples_come_to_a_store_until_they_were_all_there(void **state)
{
    (void)state;
    char fresh[FOLDER_PATH], output[4096];
    folder_make(fresh);
    client_free(http);
    assert_int_equal(daemon_stop(server), 0);
    snprintf(store, sizeof store, "sqlite:%s", fresh);
    const char *const full[] = {"--listen",  "127.0.0.1:0",  "--store", store,
                                "--samples", "--max-meshes", "2",       NULL};
    assert_int_equal(daemon_run(full, output, sizeof output), 1);
    assert_non_null(strstr(output, "sample torus"));
    const char *const samples[] = {"--store", store, "--samples", NULL};
    for (int start = 0; start < 3; start++) {
        server = daemon_start(samples);
        http = client_new(server);
        assert_true(meshes_there() == (start == 0 ? 3 : 2));
        if (start == 0) {
            send("DELETE", "/v1/meshes/torus", "", 204);
        }
        client_free(http);
        assert_int_equal(daemon_stop(server), 0);
    }
    folder_remove(folder);
    snprintf(folder, sizeof folder, "%s", fresh);
    begin();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_was_answered_is_there_after_a_kill, setup, teardown),
        cmocka_unit_test_setup_teardown(undo_and_redo_lead_where_they_would_have_led, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(a_tag_names_one_state_for_ever, setup, teardown),
        cmocka_unit_test_setup_teardown(a_key_is_good_after_a_restart, setup, teardown),
        cmocka_unit_test_setup_teardown(samples_come_to_a_store_until_they_were_all_there, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(listeners_go_on_where_they_were, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
