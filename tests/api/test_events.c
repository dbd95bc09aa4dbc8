/* The messages of an event stream, read without a socket. They must describe every operation
 * exactly, whether they come from the listener's queue or from the history, and whichever
 * allocation fails. */
#include "tests/api/stream.h"
#include "tests/random_edit.h"
#include "tests/writing.h"

#include "api/event/events.h"
#include "api/limits.h"
#include "mesh/column.h"
#include "mesh/write.h"
#include "op/op.h"
#include "store/publish/limits.h"
#include "tests/failing.h"
#include "tests/seed.h"
#include "tests/sanitized.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

/* --- the mesh --- */

static const char OBJ[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 3 0 1\nv 3 1 1\n"
                          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                          "g left\nusemtl red\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
                          "g right\nusemtl blue\nf 2/1/1 5/2/1 6/3/1 3/4/1\n"
                          "f 5/1/1 7/2/1 8/3/1 6/4/1\n";

/* Sends a request. If a job answers it, that job has run when the function returns. */
static int send(api_bench *b, const char *method, const char *target, const char *body)
{
    bench_reply r = bench_send(b, method, target, NULL, body);
    int status = r.status;
    bench_reply_free(&r);
    if (status == 202) {
        bench_run_jobs(b, 1);
    }
    return status;
}

/* An OBJ file of a mesh without boundary, which some operations need. */
static const char TETRAHEDRON[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\n"
                                  "g base\nf 1//1 3//1 2//1\n"
                                  "g sides\nf 1//1 2//1 4//1\nf 2//1 3//1 4//1\nf 3//1 1//1 4//1\n";

static void put(api_bench *b, const char *obj)
{
    static const char *const headers[] = {"Content-Type", "model/obj", NULL};
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", headers, obj);
    if (r.status != 200 && r.status != 201) {
        fail_msg("%d %s", r.status, r.body);
    }
    bench_reply_free(&r);
}

static void put_mesh(api_bench *b)
{
    put(b, OBJ);
}

/* --- tests --- */

enum { ROWS = 256 };

/* Returns the operation that has succeeded least often. */
static size_t rarest(const unsigned done[ROWS])
{
    size_t least = 0;
    for (size_t row = 1; row < he_op_count(); row++) {
        least = done[row] < done[least] ? row : least;
    }
    return least;
}

static void every_operation_undo_and_redo_is_told_exactly(void **state)
{
    (void)state;
    enum { EDITS = SANITIZED ? 2000 : 6000, MOST = 100000 };
    unsigned done[ROWS] = {0}, anew = 0, steps = 0;
    md_random random = {seed_of_run()};
    char text[RANDOM_EDIT_TEXT];
    mirror copy = {0};
    api_bench *b = bench_new();
    put_mesh(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    stream_dump(b, &copy);
    assert_true(copy.column_count > 0);
    int requests = 0;
    for (; requests < EDITS || done[rarest(done)] == 0; requests++) {
        if (requests == MOST) {
            fail_msg("%s never succeeded: does random_edit.c draw arguments for it?",
                     he_op_at(rarest(done))->name);
        }
        size_t faces = mirror_count(&copy, HE_FACE);
        if (faces == 0 || faces > 300 || md_chance(&random, 1)) {
            put_mesh(b);
            anew += stream_follow(b, l, &copy);
        }
        size_t row =
            md_chance(&random, 30) ? rarest(done) : md_below(&random, (uint32_t)he_op_count());
        if (strcmp(he_op_at(row)->name, "dual") == 0 && md_chance(&random, 10)) {
            put(b, TETRAHEDRON);
            anew += stream_follow(b, l, &copy);
        }
        if (md_chance(&random, 15)) {
            bool undo = md_chance(&random, 60);
            int status = send(b, "POST", undo ? "/v1/meshes/m/undo" : "/v1/meshes/m/redo", NULL);
            (void)snprintf(text, sizeof text, "%s", undo ? "undo" : "redo");
            steps += status == 200;
        } else {
            random_edit(&random, &copy, row, text);
            /* A remesh into many small triangles is a job, and is not counted here. */
            done[row] += send(b, "POST", "/v1/meshes/m/edits", text) == 200;
        }
        anew += stream_follow(b, l, &copy);
        stream_require(b, &copy, text);
    }
    printf("note: %d requests, %u undos and redos, taken anew %u times; least often %s, %u times\n",
           requests, steps, anew, he_op_at(rarest(done))->name, done[rarest(done)]);
    stream_close(l);
    mirror_clear(&copy);
    bench_free(b);
}

/* Number of calls of he_changes_find and he_changes_sum, which find what an edit changed. The
 * linker replaces these calls by calls of the wrappers below (see the Makefile). */
static unsigned finds;

he_status __real_he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from, size_t to,
                                 bool undone, he_changes *out, he_error *err);
he_status __wrap_he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from, size_t to,
                                 bool undone, he_changes *out, he_error *err);
he_status __real_he_changes_sum(const he_mesh *mesh, const he_change_part *parts, size_t count,
                                he_changes *out, he_error *err);
he_status __wrap_he_changes_sum(const he_mesh *mesh, const he_change_part *parts, size_t count,
                                he_changes *out, he_error *err);

he_status __wrap_he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from, size_t to,
                                 bool undone, he_changes *out, he_error *err)
{
    finds++;
    return __real_he_changes_find(mesh, delta, from, to, undone, out, err);
}

he_status __wrap_he_changes_sum(const he_mesh *mesh, const he_change_part *parts, size_t count,
                                he_changes *out, he_error *err)
{
    finds++;
    return __real_he_changes_sum(mesh, parts, count, out, err);
}

/* The sets of elements that a request changed must be computed only once, and then be used for the
 * answer, the history and all listeners. */
static void what_a_request_changes_is_found_once(void **state)
{
    (void)state;
    static const struct {
        const char *method, *path, *body;
    } rows[] = {
        {"POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}"},
        {"PUT", "/v1/meshes/m/attributes/faces/group", "{\"type\":\"int32\",\"value\":1}"},
        {"POST", "/v1/meshes/m/undo", NULL},
        {"POST", "/v1/meshes/m/redo", NULL},
    };
    api_bench *b = bench_new();
    put_mesh(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        finds = 0;
        int status = send(b, rows[i].method, rows[i].path, rows[i].body);
        assert_true(status == 200 || status == 201);
        assert_int_equal(finds, 1);
        assert_string_equal(stream_next(l, false), "edit");
    }
    stream_close(l);
    bench_free(b);
}

/* Adds and removes attributes directly through the store, because no request adds one attribute and
 * removes another in a single edit, and requires events about them. */
static void columns_that_come_and_go_are_told(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    mirror copy = {0};
    put_mesh(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    stream_dump(b, &copy);
    size_t before = copy.column_count;
    st_mesh *stored = stream_mesh(b);
    st_write w;
    he_mesh *mesh = writing_begin(stored, &w);
    he_column *weight = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){"weight", HE_VERTEX, HE_FLOAT, 2, HE_INTERPOLATE},
                      &weight, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(weight, he_mesh_issued(mesh, HE_VERTEX), NULL), HE_OK);
    const float value[] = {0.1F, -2.5F};
    memcpy(he_column_row(weight, 3), value, sizeof value);
    assert_int_equal(he_mesh_add_column(mesh, weight, NULL), HE_OK);
    assert_int_equal(he_mesh_drop_column(mesh, 0, NULL), HE_OK);
    assert_true(writing_commit(&w, "attributes", NULL));
    st_release(stored);
    assert_string_equal(stream_next(l, false), "edit");
    assert_non_null(cJSON_GetObjectItem(l->data, "attributes_added"));
    assert_non_null(cJSON_GetObjectItem(l->data, "attributes_dropped"));
    assert_int_equal(mirror_apply(&copy, l->data), MIRROR_APPLIED);
    assert_int_equal(copy.column_count, before);
    stream_require(b, &copy, "a column for another");
    static const char *const steps[] = {"undo", "redo", "undo"};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        char target[64];
        (void)snprintf(target, sizeof target, "/v1/meshes/m/%s", steps[i]);
        assert_int_equal(send(b, "POST", target, NULL), 200);
        assert_string_equal(stream_next(l, false), "edit");
        assert_string_equal(stream_text(l, "action"), steps[i]);
        assert_int_equal(mirror_apply(&copy, l->data), MIRROR_APPLIED);
        stream_require(b, &copy, steps[i]);
    }
    stream_close(l);
    mirror_clear(&copy);
    bench_free(b);
}

/* An attribute is replaced by another one of the same name. After the event, the listener's copy
 * must have no values of the old attribute. */
static void a_column_written_over_is_told(void **state)
{
    (void)state;
    static const struct {
        const char *method, *target, *body;
    } steps[] = {
        {"PUT", "attributes/faces/a", "{\"type\":\"bool\",\"default\":false}"},
        {"PATCH", "attributes/faces/a", "{\"ids\":[1],\"value\":true}"},
        {"PUT", "attributes/faces/a", "{\"type\":\"bool\"}"},
        {"PUT", "attributes/faces/a", "{\"type\":\"float\",\"value\":0.5}"},
        {"DELETE", "attributes/faces/a", NULL},
        {"POST", "undo", NULL},
        {"POST", "undo", "{\"steps\":3}"},
        {"POST", "redo", "{\"steps\":2}"},
        {"POST", "redo", "{\"steps\":2}"},
    };
    api_bench *b = bench_new();
    mirror copy = {0};
    put_mesh(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    stream_dump(b, &copy);
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        char target[64];
        (void)snprintf(target, sizeof target, "/v1/meshes/m/%s", steps[i].target);
        int status = send(b, steps[i].method, target, steps[i].body);
        assert_true(status == 200 || status == 201);
        assert_int_equal(stream_follow(b, l, &copy), 0);
        stream_require(b, &copy, steps[i].method);
    }
    stream_close(l);
    mirror_clear(&copy);
    bench_free(b);
}

#define POKE "{\"op\":\"face_poke\",\"face\":0}"

static void what_is_no_edit_has_events_of_its_own(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put_mesh(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    assert_string_equal(stream_next(l, false), "");
    assert_int_equal(l->events.blocks, 1);
    assert_int_equal(strlen(l->events.id), 16 + 2);
    assert_string_equal(l->events.id + 16, ".1");
    assert_int_equal(send(b, "PATCH", "/v1/meshes/m", "{\"name\":\"a\\\"b\"}"), 200);
    assert_string_equal(stream_next(l, false), "metadata");
    assert_string_equal(stream_text(l, "name"), "a\"b");
    put_mesh(b);
    assert_string_equal(stream_next(l, false), "resync");
    assert_string_equal(stream_text(l, "reason"), "replaced");
    assert_int_equal(stream_number(l, "revision"), 2);
    assert_string_equal(l->events.id + 16, ".2");
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", "{\"op\":\"compact\"}"), 200);
    const char *name = stream_next(l, false);
    assert_true(strcmp(name, "resync") == 0 || strcmp(name, "edit") == 0);
    assert_int_equal(send(b, "DELETE", "/v1/meshes/m", NULL), 204);
    assert_string_equal(stream_next(l, true), "bye");
    assert_string_equal(stream_text(l, "reason"), "deleted");
    assert_string_equal(stream_next(l, true), "");
    stream_close(l);
    bench_free(b);
}

static void the_list_of_meshes_counts_listeners(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put_mesh(b);
    listener *l[2];
    for (int i = 0; i <= 2; i++) {
        bench_reply r = bench_send(b, "GET", "/v1/meshes", NULL, NULL);
        assert_int_equal(cJSON_GetObjectItem(r.json, "listeners")->valueint, i);
        bench_reply_free(&r);
        if (i < 2) {
            l[i] = stream_open(b, "/v1/meshes/m/events", "", NULL);
        }
    }
    stream_close(l[0]);
    stream_close(l[1]);
    bench_free(b);
}

static void a_large_edit_is_only_announced(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    assert_int_equal(
        send(b, "PUT", "/v1/meshes/m", "{\"shape\":\"grid\",\"columns\":200,\"rows\":200}"), 201);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits",
                          "{\"op\":\"transform\",\"matrix\":[2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1]}"),
                     200);
    assert_string_equal(stream_next(l, false), "edit");
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(l->data, "stale")));
    assert_null(cJSON_GetObjectItem(l->data, "values"));
    assert_int_equal(stream_number(l, "base"), 1);
    assert_int_equal(stream_number(l, "revision"), 2);
    assert_true(strlen(l->event.data) < API_MAX_EVENT);
    stream_close(l);
    bench_free(b);
}

static void who_was_cut_off_goes_on_where_it_was(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    mirror copy = {0};
    char id[64];
    put_mesh(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    stream_dump(b, &copy);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", POKE), 200);
    assert_int_equal(stream_follow(b, l, &copy), 0);
    (void)snprintf(id, sizeof id, "%s", l->events.id);
    stream_close(l);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", POKE), 200);
    assert_int_equal(send(b, "PATCH", "/v1/meshes/m", "{\"name\":\"x\"}"), 200);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/undo", NULL), 200);
    /* The header Last-Event-ID names a later revision than `since` in the URL and must win, because
     * a browser that reconnects sends the URL of its first connection again. */
    l = stream_open(b, "/v1/meshes/m/events", "since=1", id);
    assert_string_equal(stream_next(l, false), "edit");
    assert_int_equal(stream_number(l, "base"), 2);
    assert_int_equal(mirror_apply(&copy, l->data), MIRROR_APPLIED);
    assert_string_equal(stream_next(l, false), "metadata");
    assert_string_equal(stream_next(l, false), "edit");
    assert_int_equal(mirror_apply(&copy, l->data), MIRROR_APPLIED);
    assert_string_equal(stream_next(l, false), "");
    stream_require(b, &copy, "a cut");
    stream_close(l);
    mirror_clear(&copy);
    bench_free(b);
}

/* The listener is behind by more events than its queue holds. It gets the older events from the
 * history, in batches, and the rest from the queue. */
static void who_is_far_behind_is_told_from_the_history(void **state)
{
    (void)state;
    enum { EDITS = ST_QUEUE_MESSAGES + 500 };
    md_random random = {seed_of_run()};
    char text[RANDOM_EDIT_TEXT];
    api_bench *b = bench_new();
    mirror now = {0}, copy = {0};
    put_mesh(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    stream_dump(b, &now);
    stream_dump(b, &copy);
    while (now.revision < EDITS) {
        /* The random edits leave out `compact`, which deletes the history, and two kinds of edits
         * that the history does not describe in detail: refinements of the mesh, and edits that add
         * an attribute. The mesh stays so small that a change of all its elements fits
         * into one message; an edit that emptied the mesh is undone. */
        size_t row = md_below(&random, (uint32_t)he_op_count());
        const char *name = he_op_at(row)->name;
        size_t faces = mirror_count(&now, HE_FACE);
        bool back = faces == 0 || faces > 60 || md_chance(&random, 20);
        if (back) {
            (void)send(b, "POST", "/v1/meshes/m/undo", NULL);
        } else if (strcmp(name, "compact") != 0 && strcmp(name, "subdivide") != 0 &&
                   strcmp(name, "remesh") != 0 && strcmp(name, "fill_holes") != 0 &&
                   strcmp(name, "material_set") != 0 && strcmp(name, "select") != 0 &&
                   strcmp(name, "segment") != 0 && strcmp(name, "deviation") != 0 &&
                   (faces < 20 || strcmp(name, "append") != 0)) {
            random_edit(&random, &now, row, text);
            (void)send(b, "POST", "/v1/meshes/m/edits", text);
        }
        assert_int_equal(stream_follow(b, l, &now), 0);
    }
    stream_close(l);
    l = stream_open(b, "/v1/meshes/m/events", "since=1", NULL);
    assert_string_equal(stream_next(l, true), "metadata");
    while (copy.revision < now.revision) {
        assert_string_equal(stream_next(l, true), "edit");
        assert_int_equal(mirror_apply(&copy, l->data), MIRROR_APPLIED);
    }
    stream_require(b, &copy, "the history");
    (void)send(b, "POST", "/v1/meshes/m/undo", NULL);
    assert_string_equal(stream_next(l, true), "edit");
    assert_int_equal(mirror_apply(&copy, l->data), MIRROR_APPLIED);
    stream_require(b, &copy, "the history and an undo");
    stream_close(l);
    /* The listener `l` begins in the middle of the history and disconnects before it has read all
     * of it. */
    l = stream_open(b, "/v1/meshes/m/events", "since=2", NULL);
    assert_string_equal(stream_next(l, true), "metadata");
    assert_string_equal(stream_next(l, true), "edit");
    assert_int_equal(stream_number(l, "base"), 2);
    stream_close(l);
    l = stream_open(b, "/v1/meshes/m/events", "since=2", NULL);
    l->source->finish(l->source->self);
    while (strcmp(stream_next(l, true), "bye") != 0) {
    }
    assert_string_equal(stream_text(l, "reason"), "stopping");
    assert_string_equal(stream_next(l, true), "");
    stream_close(l);
    mirror_clear(&now);
    mirror_clear(&copy);
    bench_free(b);
}

static void require_resync(api_bench *b, const char *query, const char *last, const char *reason)
{
    listener *l = stream_open(b, "/v1/meshes/m/events", query, last);
    const char *name = stream_next(l, true);
    if (strcmp(name, "metadata") == 0) {
        name = stream_next(l, true);
    }
    assert_string_equal(name, "resync");
    assert_string_equal(stream_text(l, "reason"), reason);
    assert_int_equal(stream_number(l, "revision"), 4);
    assert_string_equal(l->events.id + 16, ".4");
    assert_string_equal(stream_next(l, false), "");
    assert_int_equal(send(b, "POST", "/v1/meshes/m/undo", NULL), 200);
    assert_string_equal(stream_next(l, true), "edit");
    assert_int_equal(stream_number(l, "base"), 4);
    stream_close(l);
}

static void make_four_revisions(api_bench *b)
{
    (void)send(b, "DELETE", "/v1/meshes/m", NULL);
    put_mesh(b);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", POKE), 200);
    put_mesh(b);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", POKE), 200);
}

static void what_cannot_be_told_is_one_resync(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    make_four_revisions(b);
    require_resync(b, "since=1", NULL, "gap"); /* revision 1 belongs to the mesh that was replaced,
                                                  so no events lead from it to the present mesh */
    make_four_revisions(b);
    require_resync(b, "since=5", NULL, "future");
    make_four_revisions(b);
    require_resync(b, "", "0123456789abcdef.4", "incarnation");
    make_four_revisions(b);
    require_resync(b, "since=4", "nonsense", "incarnation");
    make_four_revisions(b);
    require_resync(b, "since=0", NULL, "gap");
    static const char *const bad[] = {"since=",
                                      "since=x",
                                      "since=1.2",
                                      "since=0123456789abcdef.",
                                      "since=-1",
                                      "since=18446744073709551616",
                                      "since=0123456789ABCDEF.1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char target[128];
        (void)snprintf(target, sizeof target, "/v1/meshes/m/events?%s", bad[i]);
        assert_int_equal(send(b, "GET", target, NULL), 400);
    }
    bench_free(b);
}

/* The listener reads nothing until its queue overflows. It must then get one `resync`, and after it
 * the events from the newest one on. */
static void a_slow_listener_is_told_to_fetch_anew(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    mirror copy = {0};
    put_mesh(b);
    listener *slow = stream_open(b, "/v1/meshes/m/events", "", NULL);
    stream_dump(b, &copy);
    for (int i = 0; i < ST_QUEUE_MESSAGES + 50; i++) {
        const char *target = i % 2 == 0 ? "/v1/meshes/m/edits" : "/v1/meshes/m/undo";
        assert_int_equal(send(b, "POST", target, i % 2 == 0 ? POKE : NULL), 200);
    }
    assert_int_equal(stream_follow(b, slow, &copy), 1);
    stream_require(b, &copy, "a resync");
    bench_reply page = bench_expect(200, bench_get(b, "/metrics"));
    assert_non_null(strstr(page.body, "\nhedge_event_streams_behind_total 1\n"));
    bench_done(page);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", POKE), 200);
    assert_int_equal(stream_follow(b, slow, &copy), 0);
    stream_require(b, &copy, "the edit after it");
    stream_close(slow);
    mirror_clear(&copy);
    bench_free(b);
}

static void a_name_of_a_revision_is_told(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put_mesh(b);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}"),
                     200);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    assert_int_equal(send(b, "PATCH", "/v1/meshes/m/edits/2", "{\"name\":\"poked\"}"), 200);
    assert_string_equal(stream_next(l, false), "moment");
    assert_int_equal(stream_number(l, "revision"), 2);
    assert_string_equal(stream_text(l, "name"), "poked");
    /* A name that is the present one already is no change. */
    assert_int_equal(send(b, "PATCH", "/v1/meshes/m/edits/2", "{\"name\":\"poked\"}"), 200);
    assert_int_equal(send(b, "PATCH", "/v1/meshes/m/edits/2", "{\"name\":null}"), 200);
    assert_string_equal(stream_next(l, false), "moment");
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(l->data, "name")));
    assert_string_equal(stream_next(l, false), "");
    stream_close(l);
    bench_free(b);
}

static void too_many_listeners_are_503(void **state)
{
    (void)state;
    api_bench *b = bench_new(); /* the service allows 2 listeners of one mesh, and 3 in total */
    put_mesh(b);
    assert_int_equal(send(b, "PUT", "/v1/meshes/n", "{\"shape\":\"cube\"}"), 201);
    listener *first = stream_open(b, "/v1/meshes/m/events", "", NULL);
    listener *second = stream_open(b, "/v1/meshes/m/events", "", NULL);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/events", NULL, NULL);
    assert_int_equal(r.status, 503);
    assert_string_equal(bench_header(&r, "Retry-After"), "1");
    bench_reply_free(&r);
    listener *third = stream_open(b, "/v1/meshes/n/events", "", NULL);
    assert_int_equal(send(b, "GET", "/v1/meshes/n/events", NULL), 503);
    stream_close(second);
    assert_int_equal(send(b, "GET", "/v1/meshes/n/events", NULL), 200);
    assert_int_equal(send(b, "GET", "/v1/meshes/m/events", NULL), 200);
    stream_close(first);
    stream_close(third);
    bench_free(b);
}

/* --- when an allocation fails --- */

/* The N-th allocation for an event and all later ones fail, for each N. The edit must succeed, and
 * the listener must get either the event or a `resync`. */
static void a_failed_allocation_loses_no_listener(void **state)
{
    (void)state;
    unsigned lost = 0, told = 0;
    failing f = {.may_succeed = true, .lasts = true, .threads = FAILING_THIS_THREAD};
    while (failing_next(&f)) {
        failing_pause();
        bool is_told = false;
        api_bench *b = bench_new();
        mirror copy = {0};
        put_mesh(b);
        failing_resume();
        listener *l = stream_try(b, "/v1/meshes/m/events", "", NULL);
        failing_pause();
        if (l != NULL) {
            stream_dump(b, &copy);
            failing_resume();
            bench_reply r = {0};
            bool sent = bench_try(
                b, &(bench_request){"POST", "/v1/meshes/m/edits", NULL, POKE, sizeof POKE - 1}, &r);
            failing_pause();
            if (sent) {
                bench_reply_free(&r);
            }
            unsigned anew = stream_follow(b, l, &copy);
            lost += anew;
            is_told = copy.revision == 2 && anew == 0;
            told += is_told;
            stream_require(b, &copy, "a failed allocation");
            stream_close(l);
        }
        mirror_clear(&copy);
        bench_free(b);
        failing_end(&f, is_told);
        assert_true(f.n < 2000);
    }
    assert_true(lost > 0);
    assert_true(told > 0);
}

/* The N-th allocation of the thread that reads events from the history and all later ones fail, for
 * each N. The listener must get the events in order, possibly followed by a `resync`. */
static void a_failed_allocation_in_the_history_is_a_resync(void **state)
{
    (void)state;
    unsigned lost = 0;
    failing f = {.may_succeed = true, .lasts = true, .threads = FAILING_OTHER_THREADS};
    while (failing_next(&f)) {
        failing_pause();
        api_bench *b = bench_new();
        put_mesh(b);
        assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", POKE), 200);
        assert_int_equal(send(b, "POST", "/v1/meshes/m/undo", NULL), 200);
        failing_resume();
        bool is_told = true;
        listener *l = stream_open(b, "/v1/meshes/m/events", "since=1", NULL);
        assert_string_equal(stream_next(l, true), "metadata");
        const char *name = "";
        for (uint64_t at = 1; at < 3; at++) {
            name = stream_next(l, true);
            if (strcmp(name, "edit") != 0 || cJSON_GetObjectItem(l->data, "stale") != NULL) {
                is_told = false;
                lost++;
                break;
            }
            assert_int_equal(stream_number(l, "base"), at);
        }
        if (strcmp(name, "resync") == 0) {
            assert_int_equal(stream_number(l, "revision"), 3);
            assert_string_equal(stream_next(l, false), "");
        }
        failing_pause();
        stream_close(l);
        bench_free(b);
        failing_end(&f, is_told);
        assert_true(f.n < 2000);
    }
    assert_true(lost > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_operation_undo_and_redo_is_told_exactly),
        cmocka_unit_test(what_a_request_changes_is_found_once),
        cmocka_unit_test(columns_that_come_and_go_are_told),
        cmocka_unit_test(a_column_written_over_is_told),
        cmocka_unit_test(what_is_no_edit_has_events_of_its_own),
        cmocka_unit_test(the_list_of_meshes_counts_listeners),
        cmocka_unit_test(a_large_edit_is_only_announced),
        cmocka_unit_test(who_was_cut_off_goes_on_where_it_was),
        cmocka_unit_test(who_is_far_behind_is_told_from_the_history),
        cmocka_unit_test(what_cannot_be_told_is_one_resync),
        cmocka_unit_test(a_slow_listener_is_told_to_fetch_anew),
        cmocka_unit_test(a_name_of_a_revision_is_told),
        cmocka_unit_test(too_many_listeners_are_503),
        cmocka_unit_test(a_failed_allocation_loses_no_listener),
        cmocka_unit_test(a_failed_allocation_in_the_history_is_a_resync),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
