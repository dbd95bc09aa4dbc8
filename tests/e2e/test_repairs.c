/* A large broken file is sent to a real daemon. Its job must be refused and name the repairs that
 * would help; with these repairs the file must be accepted, and the job must report its
 * progress. */
#include "tests/e2e/client.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 250, LINE = 64 };

/* Returns a grid in which each row has vertices of its own, every third triangle is reversed, and
 * the first triangle is there twice. */
static char *broken_file(size_t *length)
{
    size_t room = (size_t)LINE * SIDE * SIDE * 5 + 1000, used = 0;
    char *text = malloc(room);
    assert_non_null(text);
    for (int row = 0; row < SIDE; row++) {
        for (int i = 0; i < 2 * SIDE; i++) {
            used += (size_t)snprintf(text + used, room - used, "v %d %d 0.5\n", i % SIDE,
                                     row + i / SIDE);
        }
    }
    int count = 0;
    used += (size_t)snprintf(text + used, room - used, "f 1 2 %d\n", SIDE + 1);
    for (int row = 0; row < SIDE; row++) {
        for (int i = 1; i < SIDE; i++) {
            int a = 2 * SIDE * row + i, b = a + SIDE;
            const int corners[2][3] = {{a, a + 1, b}, {b, a + 1, b + 1}};
            for (int t = 0; t < 2; t++) {
                int turned = ++count % 3 == 0;
                used += (size_t)snprintf(text + used, room - used, "f %d %d %d\n", corners[t][0],
                                         corners[t][1 + turned], corners[t][2 - turned]);
            }
        }
    }
    *length = used;
    return text;
}

/* Uploads the file as a job and reads the job's events until it has ended; returns the ended
 * job. */
static reply run(client *c, const char *target, const char *body, size_t length, reply *events)
{
    static const char *const headers[] = {"Prefer: respond-async", "Content-Type: model/obj", NULL};
    char job[80], path[100];
    reply r = client_send_bytes(c, &(client_request){"POST", target, headers, body, length});
    if (r.status != 202) {
        fail_msg("%s: %ld %s", target, r.status, r.body);
    }
    reply_header(&r, "Location", job, sizeof job);
    reply_free(&r);
    snprintf(path, sizeof path, "%s/events", job);
    *events = client_get(c, path);
    assert_int_equal(events->status, 200);
    return client_get(c, job);
}

static void a_job_is_refused_and_then_repairs(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(NULL);
    client *c = client_new(d);
    size_t length;
    char *text = broken_file(&length), target[120];
    reply events;
    reply r = run(c, "/v1/meshes", text, length, &events);
    assert_string_equal(reply_string(&r, "state"), "failed");
    assert_string_equal(reply_string(&r, "problem.repair.0"), "drop_duplicates");
    assert_string_equal(reply_string(&r, "problem.repair.1"), "orient");
    reply_free(&events);
    reply_free(&r);

    snprintf(target, sizeof target, "/v1/meshes?repair=drop_duplicates,orient,weld,split");
    r = run(c, target, text, length, &events);
    assert_string_equal(reply_string(&r, "state"), "done");
    assert_int_equal((int)reply_number(&r, "result.counts.vertices"), SIDE * (SIDE + 1));
    assert_int_equal((int)reply_number(&r, "result.counts.faces"), 2 * SIDE * (SIDE - 1));
    assert_int_equal((int)reply_number(&r, "result.counts.components"), 1);
    assert_string_equal(reply_string(&r, "result.import.repairs.0.repair"), "weld");
    assert_int_equal((int)reply_number(&r, "result.import.repairs.0.count"), SIDE * (SIDE - 1));
    assert_int_equal((int)reply_number(&r, "result.import.repairs.1.count"), 1);
    assert_int_equal((int)reply_number(&r, "result.import.repairs.2.components"), 1);
    snprintf(target, sizeof target, "/v1/meshes/%s/check", reply_string(&r, "result.id"));
    reply_free(&events);
    reply_free(&r);
    r = client_get(c, target);
    assert_true(cJSON_IsTrue(reply_find(&r, "valid")));
    reply_free(&r);
    free(text);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_job_is_refused_and_then_repairs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
