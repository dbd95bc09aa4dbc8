/* Eight writers edit at the same time: no edit is lost, and none is applied twice. The environment
 * gives EDITS for each writer; make proof takes 10000. */
#include "tests/e2e/client.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

/* TOGETHER: after this number of edits, two writers that send the same edits wait for each other.
 * Otherwise the daemon might forget the idempotency keys of the faster writer before the slower
 * writer uses them. */
enum { WRITERS = 8, MESHES = 3, DEFAULT_EDITS = 400, TOGETHER = 500 };

typedef enum condition { NONE, EXPECTED, IF_MATCH, KEYED } condition;

static int edits_each(void)
{
    const char *text = getenv("EDITS");
    int edits = text == NULL ? 0 : (int)strtol(text, NULL, 10);
    return edits > 0 ? edits : DEFAULT_EDITS;
}

typedef struct writer {
    const daemon_process *daemon;
    condition condition;
    int index, meshes, edits;
    int *revisions[MESHES]; /* for each mesh, the revisions that the edits of this writer made */
    int made[MESHES];
    long stale;
    char strange[200]; /* the first answer that was not expected */
    pthread_barrier_t *pair;
} writer;

static void note_strange(writer *w, const reply *r)
{
    if (w->strange[0] == '\0') {
        snprintf(w->strange, sizeof w->strange, "%ld: %.150s", r->status, r->body);
    }
}

/* The newest state of a mesh that a writer knows. */
typedef struct known {
    int revision;
    char etag[128];
} known;

static void look(client *c, int mesh, known *k)
{
    char path[64];
    snprintf(path, sizeof path, "/v1/meshes/m%d/vertices/0", mesh);
    reply r = client_get(c, path);
    reply_header(&r, "ETag", k->etag, sizeof k->etag);
    reply_free(&r);
}

static int revision_of(const reply *r)
{
    const cJSON *revision = cJSON_GetObjectItem(r->json, "revision");
    return cJSON_IsNumber(revision) ? revision->valueint : -1;
}

/* Tries to move vertex 0 by one, with the writer's kind of precondition; returns true if the edit
 * was done. */
static bool try_edit(writer *w, client *c, int mesh, int number, known *k)
{
    char path[64], body[160], header[200];
    snprintf(path, sizeof path, "/v1/meshes/m%d/edits", mesh);
    int used = snprintf(body, sizeof body, "{");
    if (w->condition == EXPECTED) {
        used += snprintf(body + used, sizeof body - (size_t)used, "\"expected_revision\":%d,",
                         k->revision);
    }
    snprintf(body + used, sizeof body - (size_t)used,
             "\"op\":\"vertex_move\",\"vertex\":0,\"by\":[1,0,0]}");
    const char *headers[2] = {NULL, NULL};
    if (w->condition == IF_MATCH) {
        snprintf(header, sizeof header, "If-Match: %s", k->etag);
        headers[0] = header;
    } else if (w->condition == KEYED) {
        snprintf(header, sizeof header, "Idempotency-Key: %d-%d", w->index / 2, number);
        headers[0] = header;
    }
    reply r = client_send(c, "POST", path, headers, body);
    bool good = r.status == 200,
         retry = r.status == 412 || (w->condition == KEYED && r.status == 409);
    int revision = good || r.status == 412 ? revision_of(&r) : 0;
    if (good && w->made[mesh] < w->edits) {
        w->revisions[mesh][w->made[mesh]++] = revision;
        reply_header(&r, "ETag", k->etag, sizeof k->etag);
    }
    if ((!good && !retry) || revision < 0) {
        note_strange(w, &r);
        good = true;
    }
    k->revision = revision;
    w->stale += r.status == 412;
    if (r.status == 412 && w->condition == IF_MATCH) {
        look(c, mesh, k);
    }
    reply_free(&r);
    return good;
}

static void *write_all(void *context)
{
    writer *w = context;
    client *c = client_new(w->daemon);
    known k[MESHES];
    for (int i = 0; i < MESHES; i++) {
        k[i].revision = 1;
        look(c, i, &k[i]);
    }
    for (int i = 0; i < w->edits; i++) {
        int mesh = (w->index + i) % w->meshes;
        if (w->condition == KEYED && i % TOGETHER == 0) {
            pthread_barrier_wait(w->pair);
        }
        while (!try_edit(w, c, mesh, i, &k[mesh])) {
        }
    }
    client_free(c);
    return NULL;
}

static double position_of(client *c, int mesh)
{
    char path[64];
    snprintf(path, sizeof path, "/v1/meshes/m%d/vertices/0", mesh);
    reply r = client_get(c, path);
    double x = reply_number(&r, "position.0");
    reply_free(&r);
    return x;
}

/* Each revision must have been acknowledged to exactly one writer, or to both writers of a pair,
 * which send the same edits with the same keys. Vertex 0 must be where the sum of all edits puts
 * it. */
static void check_mesh(client *c, const writer *writers, int mesh, double start, int share)
{
    char path[64];
    int total = 0;
    for (int i = 0; i < WRITERS; i++) {
        total += writers[i].made[mesh];
    }
    int edits = total / share;
    assert_int_equal(edits * share, total);
    char *seen = calloc((size_t)total + 2, 1);
    assert_non_null(seen);
    for (int i = 0; i < WRITERS; i++) {
        for (int j = 0; j < writers[i].made[mesh]; j++) {
            int revision = writers[i].revisions[mesh][j];
            assert_true(revision >= 2 && revision <= 1 + edits);
            seen[revision]++;
            assert_true(j == 0 || share > 1 || revision > writers[i].revisions[mesh][j - 1]);
        }
    }
    for (int i = 2; i <= 1 + edits; i++) {
        assert_int_equal(seen[i], share);
    }
    free(seen);
    assert_true(position_of(c, mesh) == start + edits);
    snprintf(path, sizeof path, "/v1/meshes/m%d", mesh);
    reply r = client_get(c, path);
    assert_int_equal((int)reply_number(&r, "revision"), 1 + edits);
    reply_free(&r);
    snprintf(path, sizeof path, "/v1/meshes/m%d/check", mesh);
    r = client_get(c, path);
    assert_true(cJSON_IsTrue(reply_find(&r, "valid")));
    reply_free(&r);
}

static void write_at_once(const char *what, int meshes, condition first, condition second)
{
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", NULL});
    client *c = client_new(d);
    double start[MESHES];
    for (int i = 0; i < MESHES; i++) {
        char path[64];
        snprintf(path, sizeof path, "/v1/meshes/m%d", i);
        reply r = client_send(c, "PUT", path, NULL, "{\"shape\":\"cube\"}");
        assert_int_equal(r.status, 201);
        reply_free(&r);
        start[i] = position_of(c, i);
    }
    writer writers[WRITERS];
    pthread_t threads[WRITERS];
    pthread_barrier_t pairs[WRITERS / 2];
    struct timespec begin, end;
    clock_gettime(CLOCK_MONOTONIC, &begin);
    for (int i = 0; i < WRITERS / 2; i++) {
        pthread_barrier_init(&pairs[i], NULL, 2);
    }
    for (int i = 0; i < WRITERS; i++) {
        writer *w = &writers[i];
        *w = (writer){.daemon = d,
                      .condition = i % 2 == 0 ? first : second,
                      .index = i,
                      .meshes = meshes,
                      .edits = edits_each(),
                      .pair = &pairs[i / 2]};
        for (int j = 0; j < MESHES; j++) {
            w->revisions[j] = calloc((size_t)w->edits, sizeof(int));
            assert_non_null(w->revisions[j]);
        }
        assert_int_equal(pthread_create(&threads[i], NULL, write_all, w), 0);
    }
    long stale = 0;
    for (int i = 0; i < WRITERS; i++) {
        pthread_join(threads[i], NULL);
        assert_string_equal(writers[i].strange, "");
        stale += writers[i].stale;
    }
    clock_gettime(CLOCK_MONOTONIC, &end);
    for (int i = 0; i < meshes; i++) {
        check_mesh(c, writers, i, start[i], first == KEYED ? 2 : 1);
    }
    print_message("note: %s: %d x %d edits acknowledged, %ld refused as stale, %.1f s\n", what,
                  WRITERS, edits_each(), stale,
                  (double)(end.tv_sec - begin.tv_sec) +
                      (double)(end.tv_nsec - begin.tv_nsec) / 1e9);
    for (int i = 0; i < WRITERS; i++) {
        for (int j = 0; j < MESHES; j++) {
            free(writers[i].revisions[j]);
        }
    }
    for (int i = 0; i < WRITERS / 2; i++) {
        pthread_barrier_destroy(&pairs[i]);
    }
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void conditional_edits_of_several_meshes_add_up(void **state)
{
    (void)state;
    write_at_once("conditional, three meshes", MESHES, EXPECTED, IF_MATCH);
}

static void conditional_edits_of_one_mesh_add_up(void **state)
{
    (void)state;
    write_at_once("conditional, one mesh", 1, EXPECTED, IF_MATCH);
}

static void edits_of_one_mesh_without_conditions_add_up(void **state)
{
    (void)state;
    write_at_once("unconditional, one mesh", 1, NONE, NONE);
}

static void edits_sent_twice_with_a_key_are_made_once(void **state)
{
    (void)state;
    write_at_once("each sent by two with one key", 1, KEYED, KEYED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conditional_edits_of_several_meshes_add_up),
        cmocka_unit_test(conditional_edits_of_one_mesh_add_up),
        cmocka_unit_test(edits_of_one_mesh_without_conditions_add_up),
        cmocka_unit_test(edits_sent_twice_with_a_key_are_made_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
