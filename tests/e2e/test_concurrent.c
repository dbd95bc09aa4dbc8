/* Clients that read, write and delete one mesh at the same time. */
#include "tests/e2e/client.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { CLIENTS = 4, REQUESTS = 300, MESHES = 3 };

typedef struct visitor {
    const daemon_process *daemon;
    bool removes;
    int strange; /* the first status that is not allowed in this test */
} visitor;

static void *come_and_go(void *context)
{
    static const char cube[] = "{\"shape\":\"cube\"}";
    visitor *v = context;
    client *c = client_new(v->daemon);
    for (int i = 0; i < REQUESTS; i++) {
        char path[64];
        snprintf(path, sizeof path, "/v1/meshes/x%d", i % MESHES);
        reply r = v->removes ? client_send(c, "DELETE", path, NULL, NULL)
                             : client_send(c, "PUT", path, NULL, cube);
        bool good =
            v->removes ? r.status == 204 || r.status == 404 : r.status == 200 || r.status == 201;
        if (!good && v->strange == 0) {
            v->strange = (int)r.status;
        }
        reply_free(&r);
    }
    client_free(c);
    return NULL;
}

/* A PUT must replace or create the mesh even if other clients delete the mesh meanwhile. */
static void put_succeeds_while_others_delete_the_mesh(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", NULL});
    visitor visitors[CLIENTS];
    pthread_t threads[CLIENTS];
    for (int i = 0; i < CLIENTS; i++) {
        visitors[i] = (visitor){d, i % 2 == 1, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, come_and_go, &visitors[i]), 0);
    }
    for (int i = 0; i < CLIENTS; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(visitors[i].strange, 0);
    }
    assert_int_equal(daemon_stop(d), 0);
}

static void *poke(void *context)
{
    visitor *v = context;
    client *c = client_new(v->daemon);
    for (int i = 0; i < REQUESTS; i++) {
        reply r = client_post(c, "/v1/meshes/shared/edits", "{\"op\":\"face_poke\",\"face\":0}");
        if (r.status != 200 && v->strange == 0) {
            v->strange = (int)r.status;
        }
        reply_free(&r);
    }
    client_free(c);
    return NULL;
}

/* Moves a vertex of one of two meshes, or compares both, again and again. */
static void *move_or_compare(void *context)
{
    static const char *const paths[2] = {"/v1/meshes/a", "/v1/meshes/b"};
    static const char *const others[2] = {"{\"with\":\"b\"}", "{\"with\":\"a\"}"};
    visitor *v = context;
    client *c = client_new(v->daemon);
    for (int i = 0; i < REQUESTS; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/%s", paths[i % 2], v->removes ? "edits" : "compare");
        reply r = client_post(c, path,
                              v->removes ? "{\"op\":\"vertex_move\",\"vertex\":0,\"by\":[0,0,1]}"
                                         : others[i % 3 == 0 ? 1 - i % 2 : i % 2]);
        if (r.status != 200 && v->strange == 0) {
            v->strange = (int)r.status;
        }
        reply_free(&r);
    }
    client_free(c);
    return NULL;
}

/* A comparison reads two meshes, in either order or twice the same one, and must never wait for a
 * writer that waits for it. */
static void comparisons_and_writers_do_not_block_each_other(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", NULL});
    client *c = client_new(d);
    for (int i = 0; i < 2; i++) {
        reply r = client_send(c, "PUT", i == 0 ? "/v1/meshes/a" : "/v1/meshes/b", NULL,
                              "{\"shape\":\"icosphere\",\"subdivisions\":1}");
        assert_int_equal(r.status, 201);
        reply_free(&r);
    }
    client_free(c);
    visitor visitors[2 * CLIENTS];
    pthread_t threads[2 * CLIENTS];
    for (int i = 0; i < 2 * CLIENTS; i++) {
        visitors[i] = (visitor){d, i % 2 == 1, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, move_or_compare, &visitors[i]), 0);
    }
    for (int i = 0; i < 2 * CLIENTS; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(visitors[i].strange, 0);
    }
    assert_int_equal(daemon_stop(d), 0);
}

/* Every edit of every writer must be applied exactly once. */
static void each_edit_of_concurrent_writers_is_applied_once(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", NULL});
    client *c = client_new(d);
    reply r = client_send(c, "PUT", "/v1/meshes/shared", NULL, "{\"shape\":\"cube\"}");
    assert_int_equal(r.status, 201);
    reply_free(&r);
    visitor visitors[CLIENTS];
    pthread_t threads[CLIENTS];
    for (int i = 0; i < CLIENTS; i++) {
        visitors[i] = (visitor){d, false, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, poke, &visitors[i]), 0);
    }
    for (int i = 0; i < CLIENTS; i++) {
        pthread_join(threads[i], NULL);
        assert_int_equal(visitors[i].strange, 0);
    }
    r = client_get(c, "/v1/meshes/shared");
    assert_int_equal((int)reply_number(&r, "revision"), 1 + CLIENTS * REQUESTS);
    assert_int_equal((int)reply_number(&r, "counts.vertices"), 8 + CLIENTS * REQUESTS);
    reply_free(&r);
    r = client_get(c, "/v1/meshes/shared/check");
    assert_true(cJSON_IsTrue(reply_find(&r, "valid")));
    reply_free(&r);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(put_succeeds_while_others_delete_the_mesh),
        cmocka_unit_test(comparisons_and_writers_do_not_block_each_other),
        cmocka_unit_test(each_edit_of_concurrent_writers_is_applied_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
