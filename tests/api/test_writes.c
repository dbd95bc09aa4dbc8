/* Writes must be done completely or not at all, whichever allocation fails; they must be refused
 * before they cost too much; and the answer must tell whether they were done. */
#include "tests/api/request.h"
#include "store/write.h"
#include "tests/slow_journal.h"

#include "api/json/text.h"
#include "api/limits.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* --- memory --- */

typedef struct write {
    const char *method, *target;
    int status;
    const char *body;
    const char *headers[3];
    /* BEFORE: a request with the same idempotency key and body is sent before this one; DRY: a dry
     * run */
    enum { ONCE, BEFORE, DRY } how;
} write;

#define BATCH                                                           \
    "\"ops\":[{\"op\":\"face_poke\",\"face\":1,\"as\":\"a\"},"          \
    "{\"op\":\"vertex_move\",\"vertex\":\"$a.vertex\",\"by\":[0,0,1]}," \
    "{\"op\":\"edge_split\",\"edge\":\"$a.edges.0\",\"as\":\"b\"},"     \
    "{\"op\":\"face_delete\",\"faces\":[\"$b.faces\",5]}]}"
#define KEYED "Idempotency-Key", "a-key"

static const write writes[] = {
    {"POST", "/v1/meshes?id=new", 201, "{\"shape\":\"cube\"}", {NULL}, ONCE},
    {"POST", "/v1/meshes", 201, "{\"vertices\":[[0,0,0]],\"faces\":[]}", {NULL}, ONCE},
    {"POST",
     "/v1/meshes?repair=weld,drop_degenerate,drop_duplicates,orient,split,fill",
     201,
     "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0,0,1],[1,1,1]],\"faces\":[[0,1,2],[1,2,0],"
     "[3,3,1],[1,0,3],[0,1,5],[4,2,1]],\"attributes\":[{\"domain\":\"vertices\",\"name\":\"n\","
     "\"type\":\"uint32\",\"values\":[0,1,2,3,4,5]}]}",
     {NULL},
     ONCE},
    {"PUT", "/v1/meshes/new", 201, "{\"shape\":\"cube\"}", {NULL}, ONCE},
    {"PUT", "/v1/meshes/m", 200, "{\"shape\":\"octahedron\"}", {NULL}, ONCE},
    {"PUT", "/v1/meshes/m", 204, "{\"shape\":\"octahedron\"}", {"Prefer", "return=minimal"}, ONCE},
    {"PATCH", "/v1/meshes/m", 200, "{\"name\":\"other\"}", {NULL}, ONCE},
    {"PUT",
     "/v1/meshes/m/attributes/faces/a",
     201,
     "{\"type\":\"float\",\"value\":2}",
     {NULL},
     ONCE},
    {"PUT",
     "/v1/meshes/m/attributes/faces/a",
     204,
     "{\"type\":\"bool\"}",
     {"Prefer", "return=minimal"},
     ONCE},
    {"PUT",
     "/v1/meshes/m/attributes/faces/kind",
     200,
     "{\"type\":\"uint32\",\"labels\":[\"x\",\"y\"],\"values\":[0,1,0,1,0,1,1,1,1,1,1,1,1,1,0]}",
     {NULL},
     ONCE},
    {"PATCH",
     "/v1/meshes/m/attributes/faces/kind",
     200,
     "{\"ids\":[0,2,4],\"values\":[5,6,7]}",
     {NULL},
     ONCE},
    {"PATCH",
     "/v1/meshes/m/attributes/faces/kind",
     200,
     "{\"ids\":\"all\",\"value\":9}",
     {NULL},
     ONCE},
    {"DELETE", "/v1/meshes/m/attributes/faces/kind", 200, NULL, {NULL}, ONCE},
    {"POST",
     "/v1/meshes?id=new",
     201,
     "{\"vertices\":[[0,0,0]],\"faces\":[],\"attributes\":[{\"domain\":\"vertices\",\"name\":\"a\","
     "\"type\":\"uint32\",\"labels\":[\"x\",\"y\"],\"values\":[1]}]}",
     {NULL},
     ONCE},
    {"DELETE", "/v1/meshes/m", 204, NULL, {NULL}, ONCE},
    {"POST", "/v1/meshes/m/copy", 201, NULL, {NULL}, ONCE},
    {"POST", "/v1/meshes/m/edits", 200, "{\"op\":\"face_poke\",\"face\":1}", {NULL}, ONCE},
    {"POST", "/v1/meshes/m/edits", 204, "{" BATCH, {"Prefer", "return=minimal"}, ONCE},
    {"POST", "/v1/meshes/m/edits", 200, "{\"dry_run\":true," BATCH, {NULL}, DRY},
    {"POST", "/v1/meshes/m/edits", 200, "{\"dry_run\":true," BATCH, {KEYED}, DRY},
    {"POST", "/v1/meshes/m/edits", 200, "{" BATCH, {KEYED}, ONCE},
    {"POST", "/v1/meshes/m/edits", 200, "{" BATCH, {KEYED}, BEFORE},
    {"POST", "/v1/meshes", 201, "{\"shape\":\"cube\"}", {KEYED}, ONCE},
    {"POST", "/v1/meshes", 201, "{\"shape\":\"cube\"}", {KEYED}, BEFORE},
    {"POST", "/v1/meshes/m/copy", 201, NULL, {KEYED}, ONCE},
    {"PATCH", "/v1/meshes/m", 200, "{\"name\":\"other\"}", {KEYED}, ONCE},
    {"POST", "/v1/meshes/m/undo", 200, NULL, {KEYED}, ONCE},
    {"POST", "/v1/meshes/m/undo", 200, NULL, {KEYED}, BEFORE},
    {"POST", "/v1/meshes/m/redo", 200, NULL, {KEYED}, BEFORE},
    {"POST", "/v1/meshes/m/edits", 200, "{\"op\":\"compact\"}", {NULL}, ONCE},
    {"POST", "/v1/meshes/m/undo", 200, NULL, {NULL}, ONCE},
    {"POST", "/v1/meshes/m/undo", 200, "{\"steps\":2}", {NULL}, ONCE},
    {"POST", "/v1/meshes/m/undo", 200, "{\"to_revision\":1}", {NULL}, ONCE},
    {"POST", "/v1/meshes/m/redo", 200, "{}", {NULL}, ONCE},
    {"POST", "/v1/meshes/m/redo", 200, "{\"to_revision\":6}", {NULL}, ONCE},
};

/* A journal for which the store encodes edits and meshes in advance, as it does for a journal on a
 * disk. The journal in memory needs no encoding, so with it the test could not let the allocations
 * of the encoder fail. */
static slow_journal journal;

/* Creates a mesh with steps to undo, steps to redo, and a deleted face. */
static api_bench *begin_over(const st_journal *over)
{
    api_bench *b = bench_new_over(over);
    bench_done(
        bench_expect(201, bench_post(b, "/v1/meshes?id=m&name=first", "{\"shape\":\"cube\"}")));
    for (int face = 2; face < 5; face++) {
        char body[64];
        snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%d}", face);
        bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/edits", body)));
    }
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m/attributes/faces/kind", NULL,
                                            "{\"type\":\"float\",\"default\":1}")));
    bench_done(bench_expect(
        200, bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":5}")));
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    return b;
}

static api_bench *begin(void)
{
    const st_journal kept = slow_journal_open_keeping(&journal);
    return begin_over(&kept);
}

/* Returns everything that a client can read about the mesh. */
static char *state_of(api_bench *b)
{
    static const char *const targets[] = {"/v1/meshes",         "/v1/meshes/m",
                                          "/v1/meshes/m/edits", "/v1/meshes/m/content",
                                          "/v1/meshes/m/faces", "/v1/meshes/m/attributes"};
    char *state = calloc(1, 1 << 16);
    assert_non_null(state);
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        bench_reply r = bench_get(b, targets[i]);
        /* The memory of a mesh includes capacity that a refused edit has reserved, so it is left
         * out of the comparison. */
        char *bytes = strstr(r.body, "\"memory_bytes\":");
        if (bytes != NULL) {
            memset(bytes, ' ', strcspn(bytes, ","));
        }
        strncat(state, r.body, (1 << 16) - strlen(state) - 1);
        bench_reply_free(&r);
    }
    return state;
}

/* The client got no complete answer because memory was out, and repeats the request with the same
 * key. The write must not be done a second time. */
static void expect_done_once(api_bench *b, const write *w, const char *const *headers,
                             const bench_reply *first)
{
    char *before = state_of(b);
    bench_reply again =
        bench_send_bytes(b, &(bench_request){w->method, w->target, headers, w->body,
                                             w->body == NULL ? 0 : strlen(w->body)});
    char *after = state_of(b);
    assert_string_equal(before, after);
    assert_true(again.status == w->status || again.status == first->status ||
                (again.status == 204 && w->status == 200));
    if (w->how != DRY) {
        assert_string_equal(bench_header(&again, "Idempotency-Replayed"), "true");
    }
    assert_string_equal(bench_header(&again, "Location"), bench_header(first, "Location"));
    bench_reply_free(&again);
    free(before);
    free(after);
}

/* Tries a write in one iteration of the loop over failing allocations; `f` is the state of that
 * loop. */
static void try_write(const write *w, failing *f)
{
    failing_pause();
    api_bench *b = begin();
    const char *question = strchr(w->target, '?');
    char path[64];
    snprintf(path, sizeof path, "%.*s",
             question == NULL ? (int)strlen(w->target) : (int)(question - w->target), w->target);
    const char *headers[] = {"Content-Type", "application/json", w->headers[0], w->headers[1],
                             NULL};
    size_t length = w->body == NULL ? 0 : strlen(w->body);
    if (w->how == BEFORE) {
        bench_done(
            bench_send_bytes(b, &(bench_request){w->method, w->target, headers, w->body, length}));
    }
    char *before = state_of(b);
    failing_resume();
    bench_reply r = {0};
    bool sent = bench_try(b, &(bench_request){w->method, w->target, headers, w->body, length}, &r);
    failing_end(f, sent && r.status < 300);
    char *after = state_of(b);
    bool same = strcmp(before, after) == 0;
    if (!sent || r.status >= 300) {
        if ((sent && r.status != 507) || !same) {
            fail_msg("%s %s, allocation %ld: %d, and the state is%s the same", w->method, w->target,
                     f->n, sent ? r.status : 0, same ? "" : " not");
        }
    } else {
        /* If there was no memory for the body of the answer, its status must still be correct. */
        bool bare = r.status == (w->status == 201 ? 201 : 204) && r.length == 0;
        if (same != (w->how != ONCE) || (r.status != w->status && !bare)) {
            fail_msg("%s %s, allocation %ld: %d", w->method, w->target, f->n, r.status);
        }
        if (w->headers[0] != NULL && strcmp(w->headers[0], "Idempotency-Key") == 0) {
            expect_done_once(b, w, headers, &r);
        }
        if (r.status == 201) {
            bench_done(bench_expect(200, bench_get(b, bench_header(&r, "Location"))));
        }
    }
    if (sent) {
        bench_reply_free(&r);
    }
    free(before);
    free(after);
    assert_int_equal(journal.out, 0);
    bench_free(b);
}

static void writes_are_whole_or_not_at_all(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof writes / sizeof *writes; i++) {
        for (int sticky = 0; sticky < 2; sticky++) {
            failing f = {.may_succeed = true, .lasts = sticky != 0, .what = writes[i].target};
            while (failing_next(&f)) {
                try_write(&writes[i], &f);
            }
            assert_true(f.n > 1);
            print_message("%s %s: %ld allocations failed%s\n", writes[i].method, writes[i].target,
                          f.n - 1, sticky ? " and all after" : "");
        }
    }
}

static void refuse_write(const write *w, st_status refusal, int status, const char *code)
{
    api_bench *b = begin();
    const char *headers[] = {"Content-Type", "application/json", w->headers[0], w->headers[1],
                             NULL};
    size_t length = w->body == NULL ? 0 : strlen(w->body);
    char *before = state_of(b);
    uint64_t groups = journal.groups;
    journal.refuse = refusal;
    bench_reply r =
        bench_send_bytes(b, &(bench_request){w->method, w->target, headers, w->body, length});
    char *after = state_of(b);
    if (r.status != status || strcmp(before, after) != 0) {
        fail_msg("%s %s: %d where the journal has no place", w->method, w->target, r.status);
    }
    assert_string_equal(bench_text(&r, "code"), code);
    assert_string_equal(bench_header(&r, "Retry-After"), status == 503 ? "1" : "");
    /* The refusal does not wait for the disk. If it waited, it could be replaced by another refusal
     * when the service notices a lost change. */
    assert_int_equal(api_answer_of(r.exchange)->shown.position, 0);
    assert_true(journal.groups == groups);
    assert_int_equal(journal.out, 0);
    bench_reply_free(&r);
    journal.refuse = ST_OK;
    bench_done(bench_expect(
        w->status,
        bench_send_bytes(b, &(bench_request){w->method, w->target, headers, w->body, length})));
    free(before);
    free(after);
    bench_free(b);
}

static void without_a_place_in_the_journal_nothing_is_written(void **state)
{
    (void)state;
    static const struct {
        st_status refusal;
        int status;
        const char *code;
    } refusals[] = {{ST_BEHIND, 503, "store_behind"},
                    {ST_FULL, 507, "store_full"},
                    {ST_FAILED, 503, "store_failed"}};
    for (size_t i = 0; i < sizeof writes / sizeof *writes; i++) {
        for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
            bool frees = strcmp(writes[i].method, "DELETE") == 0 &&
                         strstr(writes[i].target, "attributes") == NULL;
            if (writes[i].how == ONCE && !(frees && refusals[k].refusal == ST_FULL)) {
                refuse_write(&writes[i], refusals[k].refusal, refusals[k].status, refusals[k].code);
            }
        }
    }
}

static void a_full_disk_takes_removals(void **state)
{
    (void)state;
    api_bench *b = begin();
    journal.refuse = ST_FULL;
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
    assert_int_equal(journal.record.kind, ST_RECORD_REMOVE);
    bench_done(bench_expect(404, bench_get(b, "/v1/meshes/m")));
    bench_free(b);
}

/* --- preconditions --- */

/* `writing`: a write is in progress; `removed_under_lock`: the mesh was removed during a write. The
 * wrappers below set these variables; the linker replaces calls of the store's functions by calls
 * of the wrappers (see the Makefile). */
static bool writing, removed_under_lock;

st_status __real_st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out);
st_status __wrap_st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out);
st_status __real_st_write_commit(st_write *w, const char *ops);
st_status __wrap_st_write_commit(st_write *w, const char *ops);
void __real_st_write_abort(st_write *w);
void __wrap_st_write_abort(st_write *w);
void __real_st_write_remove(st_write *w);
void __wrap_st_write_remove(st_write *w);

st_status __wrap_st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out)
{
    writing = true;
    return __real_st_write_begin(mesh, cause, out);
}

st_status __wrap_st_write_commit(st_write *w, const char *ops)
{
    writing = false;
    return __real_st_write_commit(w, ops);
}

void __wrap_st_write_abort(st_write *w)
{
    writing = false;
    __real_st_write_abort(w);
}

void __wrap_st_write_remove(st_write *w)
{
    removed_under_lock = writing;
    __real_st_write_remove(w);
}

static void nothing_comes_between_if_match_and_delete(void **state)
{
    (void)state;
    api_bench *b = begin();
    removed_under_lock = false;
    api_service *service =
        api_service_new(bench_store(b), api_routes(), &(api_options){.version = "0"});
    assert_non_null(service);
    api_request request = {
        .method = "DELETE", .path = "/v1/meshes/m", .query = "", .request_id = "r"};
    api_exchange *x = api_handle(service, &request, NULL, 0);
    assert_non_null(x);
    assert_int_equal(api_answer_of(x)->status, 204);
    assert_true(removed_under_lock);
    api_free(x);
    api_service_free(service);
    bench_free(b);
}

static void a_put_that_must_fail_needs_no_body(void **state)
{
    (void)state;
    static const struct {
        const char *path, *match, *none;
    } cases[] = {{"/v1/meshes/m", NULL, "*"},
                 {"/v1/meshes/m", "\"x\"", NULL},
                 {"/v1/meshes/absent", "*", NULL}};
    /* a store with a journal in memory knows at once that no mesh has this id */
    const st_journal forgetful = st_journal_memory();
    api_bench *b = begin_over(&forgetful);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_step step;
        api_request request = {.method = "PUT",
                               .path = cases[i].path,
                               .query = "",
                               .request_id = "r",
                               .headers = {[API_HEADER_CONTENT_TYPE] = "application/json",
                                           [API_HEADER_IF_MATCH] = cases[i].match,
                                           [API_HEADER_IF_NONE_MATCH] = cases[i].none},
                               .has_length = true,
                               .length = 1 << 20,
                               .has_body = true};
        api_exchange *x = api_begin(bench_service(b), &request, &step);
        assert_non_null(x);
        assert_int_equal(step, API_READY);
        assert_int_equal(api_answer_of(x)->status, 412);
        assert_true(api_answer_of(x)->close);
        api_free(x);
    }
    bench_free(b);
}

/* A refusal that names the present revision must, like any other answer, wait until that revision
 * is durable. */
static void a_stale_write_shows_a_state(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply r =
        bench_expect(412, bench_post(b, "/v1/meshes/m/undo", "{\"expected_revision\":2}"));
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 7);
    assert_non_null(strstr(bench_text(&r, "detail"), "not at revision 2"));
    assert_true(api_answer_of(r.exchange)->shown.incarnation != 0);
    assert_true(api_answer_of(r.exchange)->shown.position >= 7);
    bench_reply_free(&r);
    bench_free(b);
}

/* A client may guess the entity tag that a write will make and send it as If-None-Match; the write
 * must not be answered with 304. */
static void a_write_is_never_not_modified(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    char next[128];
    snprintf(next, sizeof next, "%s", bench_header(&r, "ETag"));
    bench_reply_free(&r);
    char *metadata = strchr(next, '-') + 1;
    *metadata = (char)(*metadata + 1);
    bench_done(bench_expect(200, bench_send(b, "PATCH", "/v1/meshes/m",
                                            (const char *const[]){"If-None-Match", next, NULL},
                                            "{\"name\":\"second\"}")));
    r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_string_equal(bench_header(&r, "ETag"), next);
    bench_reply_free(&r);
    bench_free(b);
}

/* --- the cost of writes --- */

/* Sends a request whose client waits, so that it does not become a job. */
static bench_reply post_and_wait(api_bench *b, const char *target, const char *body)
{
    return bench_send(b, "POST", target, (const char *const[]){"Prefer", "wait=3600", NULL}, body);
}

static void lists_of_operations_have_a_price(void **state)
{
    (void)state;
    enum { SIDE = 100, TRANSFORMS = 3000, REFERENCES = 2000 };
    api_text body = {0};
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m",
                                            "{\"shape\":\"grid\",\"columns\":100,\"rows\":100}")));

    api_text_add_string(&body, "{\"ops\":[");
    for (int i = 0; i < TRANSFORMS; i++) {
        api_text_add_format(&body,
                            "%s{\"op\":\"transform\",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}",
                            i == 0 ? "" : ",");
    }
    api_text_add(&body, "]}", sizeof "]}");
    bench_reply r = bench_expect(413, post_and_wait(b, "/v1/meshes/m/edits", body.bytes));
    assert_string_equal(bench_text(&r, "code"), "limit_exceeded");
    int at_most = API_MAX_EDITS_ELEMENTS / (SIDE * SIDE * 4);
    int refused = 0;
    assert_int_equal(sscanf(bench_text(&r, "pointer"), "/ops/%d", &refused), 1);
    assert_true(refused > at_most - 100 && refused <= at_most + 1);
    bench_reply_free(&r);

    api_text_empty(&body);
    api_text_add_string(&body, "{\"ops\":[{\"op\":\"face_triangulate\",\"as\":\"a\",\"faces\":[0");
    for (int i = 1; i < SIDE * SIDE; i++) {
        api_text_add_format(&body, ",%d", i);
    }
    api_text_add_string(&body, "]},{\"op\":\"face_delete\",\"faces\":[\"$a.faces\"");
    for (int i = 1; i < REFERENCES; i++) {
        api_text_add_string(&body, ",\"$a.faces\"");
    }
    api_text_add(&body, "]}]}", sizeof "]}]}");
    assert_false(body.failed);
    r = bench_expect(413, post_and_wait(b, "/v1/meshes/m/edits", body.bytes));
    assert_string_equal(bench_text(&r, "code"), "limit_exceeded");
    bench_reply_free(&r);

    r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
    bench_reply_free(&r);
    bench_free(b);
    api_text_clear(&body);
}

/* The number of triangles of the mesh, a disk. They share the vertex SPOKES, the hub. */
enum { SPOKES = 20000 };

/* Writes a list of edits around the hub. The second operation names an element that the first one
 * made. Each later operation visits all half-edges at the hub and leaves one fewer of them
 * there. */
static void write_hub_list(api_bench *b, api_text *body, int operations)
{
    char path[100];
    (void)snprintf(path, sizeof path, "/v1/meshes/m/vertices/%d/outgoing", (int)SPOKES);
    bench_reply r = bench_expect(200, bench_get(b, path));
    cJSON *spoke = cJSON_GetObjectItem(r.json, "ids")->child;
    api_text_add_string(body, "{\"ops\":[{\"op\":\"face_poke\",\"face\":0,\"as\":\"a\"},"
                              "{\"op\":\"vertex_move\",\"vertex\":\"$a.vertex\",\"by\":[0,0,1]}");
    for (int i = 0; i < operations; i++) {
        api_text_add_format(body, ",{\"op\":\"vertex_split_corners\",\"a\":%d,\"b\":%d}",
                            spoke->valueint, spoke->next->valueint);
        spoke = spoke->next->next;
    }
    api_text_add(body, "]}", sizeof "]}");
    assert_false(body->failed);
    bench_reply_free(&r);
}

static void a_list_about_one_hub_becomes_a_job(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    char shape[100];
    (void)snprintf(shape, sizeof shape, "{\"shape\":\"disk\",\"segments\":%d}", (int)SPOKES);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=waited", shape)));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", shape)));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=short", shape)));
    api_text body = {0};
    write_hub_list(b, &body, 100);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/short/edits", body.bytes)));
    api_text_clear(&body);

    write_hub_list(b, &body, 8000);
    bench_done(bench_expect(200, post_and_wait(b, "/v1/meshes/waited/edits", body.bytes)));
    bench_reply r = bench_expect(202, bench_post(b, "/v1/meshes/m/edits", body.bytes));
    char job[100];
    (void)snprintf(job, sizeof job, "%s", bench_header(&r, "Location"));
    bench_reply_free(&r);
    /* The request had begun the edit, but was refused and undid it; the edit then became a job.
     * Other requests read the mesh as it was before, but cannot write until the job has ended. */
    r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
    bench_reply_free(&r);
    bench_done(bench_expect(409, bench_post(b, "/v1/meshes/m/undo", "{}")));
    bench_run_jobs(b, 1);
    r = bench_expect(200, bench_get(b, job));
    assert_string_equal(bench_text(&r, "state"), "done");
    bench_reply_free(&r);
    bench_reply one = bench_expect(200, bench_get(b, "/v1/meshes/waited/content?format=obj"));
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/content?format=obj"));
    assert_true(one.length > 0 && one.length == r.length);
    assert_memory_equal(one.body, r.body, r.length);
    bench_reply_free(&one);
    bench_reply_free(&r);
    bench_free(b);
    api_text_clear(&body);
}

static api_step step_of(api_bench *b, const char *path, const char *body)
{
    api_step step;
    api_request request = {.method = "POST",
                           .path = path,
                           .query = "",
                           .request_id = "r",
                           .headers = {[API_HEADER_ACCEPT] = "application/json",
                                       [API_HEADER_CONTENT_TYPE] = "application/json"},
                           .has_length = true,
                           .length = strlen(body),
                           .has_body = true};
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    assert_non_null(x);
    assert_int_equal(step, API_MORE);
    size_t used;
    assert_int_equal(api_body(x, body, strlen(body), &used), API_MORE);
    step = api_end(x);
    if (step == API_WORK) {
        api_work(x);
    }
    if (api_answer_of(x)->status != 200) {
        fail_msg("%s: %d", body, api_answer_of(x)->status);
    }
    api_free(x);
    return step;
}

/* Creates two rows of points with long thin triangles between them, for which the number of
 * Delaunay flips grows with the square of the number of points. */
static void put_rows(api_bench *b, int row)
{
    api_text body = {0};
    api_text_add_string(&body, "{\"vertices\":[");
    for (int i = 0; i < 2 * row; i++) {
        api_text_add_format(&body, "%s[%d,%d,0]", i == 0 ? "" : ",", i % row, i / row);
    }
    api_text_add_string(&body, "],\"faces\":[");
    for (int i = 0; i + 1 < row; i++) {
        api_text_add_format(&body, "%s[%d,%d,%d],[%d,%d,%d]", i == 0 ? "" : ",", i, i + 1, row,
                            row + i + 1, row + i, row - 1);
    }
    api_text_add(&body, "]}", sizeof "]}");
    assert_false(body.failed);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=rows", body.bytes)));
    api_text_clear(&body);
}

/* A mesh of 20,000 elements is small enough to be edited on a worker, but not by a long list of
 * operations, and not by flips whose number is not known in advance. */
static void long_work_with_a_small_mesh_leaves_the_worker(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_done(bench_expect(
        201, bench_post(b, "/v1/meshes?id=d", "{\"shape\":\"disk\",\"segments\":3000}")));
    put_rows(b, 100);
    assert_int_equal(step_of(b, "/v1/meshes/d/edits", "{\"op\":\"delaunay\",\"dry_run\":true}"),
                     API_READY);
    assert_int_equal(step_of(b, "/v1/meshes/rows/edits", "{\"op\":\"delaunay\",\"dry_run\":true}"),
                     API_WORK);
    api_text body = {0};
    api_text_add_string(&body, "{\"dry_run\":true,\"ops\":[{\"op\":\"weld\",\"tolerance\":0}");
    for (int i = 1; i < 20; i++) {
        api_text_add_string(&body, ",{\"op\":\"weld\",\"tolerance\":0}");
    }
    api_text_add(&body, "]}", sizeof "]}");
    assert_false(body.failed);
    assert_int_equal(step_of(b, "/v1/meshes/d/edits", body.bytes), API_WORK);
    api_text_empty(&body);
    /* Each operation of the list in `body` welds two vertices on the rim, for which it visits all
     * elements around the hub. */
    api_text_add_string(&body, "{\"dry_run\":true,\"ops\":[");
    for (int i = 0; i < 1000; i++) {
        api_text_add_format(&body, "%s{\"op\":\"vertex_weld\",\"vertices\":[%d,%d]}",
                            i == 0 ? "" : ",", 2 * i, 2 * i + 1);
    }
    api_text_add(&body, "]}", sizeof "]}");
    assert_false(body.failed);
    assert_int_equal(step_of(b, "/v1/meshes/d/edits", body.bytes), API_WORK);
    api_text_clear(&body);
    bench_free(b);
}

static void huge_elements_are_no_work_for_a_worker(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *body;
        api_step step;
    } cases[] = {
        {"p", "{\"op\":\"face_triangulate\",\"face\":0,\"dry_run\":true}", API_WORK},
        {"p", "{\"ops\":[{\"op\":\"face_poke\",\"face\":0}],\"dry_run\":true}", API_WORK},
        {"p", "{\"op\":\"hole_fill\",\"halfedge\":1,\"method\":\"fan\",\"dry_run\":true}",
         API_WORK},
        {"p", "{\"op\":\"edge_split\",\"edge\":7,\"dry_run\":true}", API_WORK},
        {"p", "{\"op\":\"vertex_move\",\"vertex\":7,\"to\":[0,0,1],\"dry_run\":true}", API_READY},
        {"g", "{\"op\":\"face_triangulate\",\"faces\":[0,7],\"dry_run\":true}", API_READY},
        {"g", "{\"op\":\"edge_split\",\"edge\":0,\"dry_run\":true}", API_READY},
        {"g", "{\"op\":\"transform\",\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}", API_WORK},
    };
    api_bench *b = bench_new();
    bench_done(bench_expect(
        201, bench_post(b, "/v1/meshes?id=p", "{\"shape\":\"polygon\",\"sides\":30000}")));
    bench_done(bench_expect(
        201, bench_post(b, "/v1/meshes?id=g", "{\"shape\":\"grid\",\"columns\":9000,\"rows\":1}")));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char path[64];
        snprintf(path, sizeof path, "/v1/meshes/%s/edits", cases[i].mesh);
        if (step_of(b, path, cases[i].body) != cases[i].step) {
            fail_msg("%s of %s", cases[i].body, cases[i].mesh);
        }
    }
    bench_free(b);
}

/* --- refusals that help --- */

static void has_supported(bench_reply r, const char *type)
{
    const cJSON *list = cJSON_GetObjectItem(r.json, "supported"), *item;
    bool found = false;
    assert_true(cJSON_IsArray(list));
    cJSON_ArrayForEach(item, list)
    {
        found = found || strcmp(item->valuestring, type) == 0;
    }
    assert_true(found);
    bench_reply_free(&r);
}

static void refusals_name_the_value_and_the_limit(void **state)
{
    (void)state;
    api_bench *b = begin();
    char target[400] = "/v1/meshes?name=";
    memset(target + strlen(target), 'n', 257);
    bench_reply r = bench_expect(400, bench_post(b, target, "{\"shape\":\"cube\"}"));
    assert_string_equal(bench_text(&r, "code"), "bad_parameter");
    assert_non_null(strstr(bench_text(&r, "detail"), "256"));
    bench_reply_free(&r);
    r = bench_expect(400, bench_get(b, "/v1/meshes/m/vertices?limit=10001"));
    assert_string_equal(bench_text(&r, "detail"),
                        "\"limit\" cannot be \"10001\": a whole number from 1 to 10000");
    bench_reply_free(&r);
    r = bench_expect(400, bench_get(b, "/v1/meshes/m/components?by=face"));
    assert_string_equal(bench_text(&r, "detail"), "\"by\" cannot be \"face\": vertex, edge");
    bench_reply_free(&r);
    r = bench_expect(422,
                     bench_post(b, "/v1/meshes", "{\"vertices\":[[0,0,0]],\"faces\":[[0,1,2]]}"));
    assert_string_equal(bench_text(&r, "pointer"), "/faces/0/1");
    bench_reply_free(&r);
    has_supported(
        bench_expect(406, bench_send(b, "GET", "/v1/meshes/m/content",
                                     (const char *const[]){"Accept", "text/plain", NULL}, NULL)),
        "model/obj");
    has_supported(
        bench_expect(
            415, bench_send(b, "POST", "/v1/meshes",
                            (const char *const[]){"Content-Type", "application/octet-stream", NULL},
                            "?")),
        "model/x-off");
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits?limit=1"));
    assert_non_null(strstr(bench_header(&r, "Link"), "rel=\"next\""));
    assert_non_null(strstr(bench_header(&r, "Link"), bench_text(&r, "next")));
    bench_reply_free(&r);
    bench_free(b);
}

/* The server's description of an operation says which parameters are whole numbers; each of them
 * must refuse a fraction. */
static void whole_numbers_have_no_fraction(void **state)
{
    (void)state;
    static const char *const refused[][2] = {
        {"{\"op\":\"subdivide\",\"steps\":1.5}", "/steps"},
        {"{\"op\":\"subdivide\",\"steps\":13}", "/steps"},
        {"{\"op\":\"subdivide\",\"steps\":0}", "/steps"},
        {"{\"ops\":[{\"op\":\"decimate\",\"faces\":0.5}]}", "/ops/0/faces"},
        {"{\"ops\":[{\"op\":\"decimate\",\"faces\":-1}]}", "/ops/0/faces"},
    };
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        bench_reply r = bench_expect(400, bench_post(b, "/v1/meshes/m/edits", refused[i][0]));
        assert_string_equal(bench_text(&r, "code"), "bad_value");
        assert_string_equal(bench_text(&r, "pointer"), refused[i][1]);
        bench_reply_free(&r);
    }
    bench_reply r = bench_expect(200, bench_get(b, "/v1/operations"));
    assert_non_null(strstr(r.body, "\"name\":\"steps\",\"type\":\"integer\""));
    bench_reply_free(&r);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writes_are_whole_or_not_at_all),
        cmocka_unit_test(without_a_place_in_the_journal_nothing_is_written),
        cmocka_unit_test(a_full_disk_takes_removals),
        cmocka_unit_test(nothing_comes_between_if_match_and_delete),
        cmocka_unit_test(a_put_that_must_fail_needs_no_body),
        cmocka_unit_test(a_stale_write_shows_a_state),
        cmocka_unit_test(a_write_is_never_not_modified),
        cmocka_unit_test(lists_of_operations_have_a_price),
        cmocka_unit_test(a_list_about_one_hub_becomes_a_job),
        cmocka_unit_test(huge_elements_are_no_work_for_a_worker),
        cmocka_unit_test(long_work_with_a_small_mesh_leaves_the_worker),
        cmocka_unit_test(refusals_name_the_value_and_the_limit),
        cmocka_unit_test(whole_numbers_have_no_fraction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
