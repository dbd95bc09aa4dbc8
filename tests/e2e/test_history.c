/* The history of a mesh in a real daemon, as a client sees it: each earlier revision is read back
 * to the byte after any number of later edits. */
#include "tests/e2e/client.h"

#include "tests/model/random.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { REVISIONS = 60, TEXT = 200 };

static daemon_process *server;
static client *http;

static int start(void **state)
{
    (void)state;
    server = daemon_start((const char *const[]){"--jobs", "2", "--workers", "2", NULL});
    http = client_new(server);
    return 0;
}

static int stop(void **state)
{
    (void)state;
    client_free(http);
    return daemon_stop(server);
}

/* Returns all half-edges with their links and all positions at the revision `revision`; 0 means the
 * present one. */
static char *dump(uint64_t revision)
{
    static const char *const lines[] = {"Accept: application/x-ndjson", NULL};
    char path[TEXT], which[40] = "";
    if (revision != 0) {
        snprintf(which, sizeof which, "?revision=%" PRIu64, revision);
    }
    snprintf(path, sizeof path, "/v1/meshes/m/halfedges%s", which);
    reply links = reply_expect(200, client_send(http, "GET", path, lines, NULL));
    snprintf(path, sizeof path, "/v1/meshes/m/content%s", which);
    reply content = reply_expect(200, client_get(http, path));
    char *text = malloc(links.length + content.length + 1);
    assert_non_null(text);
    memcpy(text, links.body, links.length);
    memcpy(text + links.length, content.body, content.length + 1);
    reply_free(&links);
    reply_free(&content);
    return text;
}

static uint64_t send(const char *what, const char *body)
{
    char path[TEXT];
    snprintf(path, sizeof path, "/v1/meshes/m/%s", what);
    reply r = client_post(http, path, body);
    uint64_t revision = r.status == 200 ? (uint64_t)reply_number(&r, "revision") : 0;
    assert_true(r.status == 200 || r.status == 409 || r.status == 422);
    reply_free(&r);
    return revision;
}

static uint64_t change(md_random *random)
{
    char body[TEXT];
    switch (md_below(random, 5)) {
    case 0:
        return send("undo", "{}");
    case 1:
        return send("redo", "{}");
    case 2:
        snprintf(body, sizeof body, "{\"op\":\"face_delete\",\"face\":%u}", md_below(random, 200));
        return send("edits", body);
    default:
        snprintf(body, sizeof body, "{\"op\":\"edge_split\",\"edge\":%u,\"t\":0.3}",
                 md_below(random, 200));
        return send("edits", body);
    }
}

static void every_depth_is_what_it_was(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    static const char ball[] = "{\"shape\":\"icosphere\",\"subdivisions\":1}";
    reply r = client_send(http, "PUT", "/v1/meshes/m", NULL, ball);
    r = reply_expect(201, r);
    reply_free(&r);
    char *dumps[REVISIONS + 1] = {NULL};
    uint64_t head = 1;
    dumps[1] = dump(0);
    while (head < REVISIONS) {
        uint64_t made = change(&random);
        if (made > head) {
            assert_int_equal(made, head + 1);
            dumps[head = made] = dump(0);
        }
    }
    for (uint64_t revision = head; revision >= 1; revision--) {
        char *then = dump(revision);
        assert_string_equal(then, dumps[revision]);
        free(then);
    }
    assert_true(send("undo", "{\"to_revision\":1}") >= head);
    char *first = dump(0);
    assert_string_equal(first, dumps[1]);
    free(first);
    while (send("redo", NULL) != 0) {
    }
    r = reply_expect(200, client_get(http, "/v1/meshes/m/edits"));
    assert_int_equal((int)reply_number(&r, "oldest"), 1);
    reply_free(&r);
    for (size_t i = 0; i <= REVISIONS; i++) {
        free(dumps[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_depth_is_what_it_was),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
