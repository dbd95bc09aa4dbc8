/* The history of a mesh: undo, redo and steps to a revision, and what the API answers when the
 * memory budget of the history has removed old entries. */
#include "tests/api/history.h"

#include "mesh/walk.h"
#include "tests/model/random.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { MOST = 400, BODY = 160 };

static uint64_t head_of(api_bench *b)
{
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits?limit=1"));
    uint64_t revision = (uint64_t)history_number(r.json, "revision");
    bench_done(r);
    return revision;
}

/* Returns every element with all its links and values, and the mesh as a JSON document, at the
 * revision `revision`; a `revision` of 0 means the present one. */
static char *dump(api_bench *b, uint64_t revision)
{
    static const char *const parts[] = {"vertices", "halfedges", "edges", "faces", "content"};
    static const char *const lines[] = {"Accept", "application/x-ndjson", NULL};
    static const char *const document[] = {"Accept", "application/json", NULL};
    char *text = calloc(1, 1);
    size_t length = 0;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        char target[TARGET];
        snprintf(target, sizeof target, "/v1/meshes/m/%s", parts[i]);
        if (revision != 0) {
            snprintf(target, sizeof target, "/v1/meshes/m/%s?revision=%" PRIu64, parts[i],
                     revision);
        }
        const char *const *accept = i == 4 ? document : lines;
        bench_reply r = bench_expect(200, bench_send(b, "GET", target, accept, NULL));
        text = realloc(text, length + r.length + 1);
        assert_non_null(text);
        memcpy(text + length, r.body, r.length + 1);
        length += r.length;
        bench_done(r);
    }
    return text;
}

static he_mesh *content_of(api_bench *b)
{
    st_store *store = bench_store(b);
    st_mesh *mesh;
    he_mesh *copy;
    assert_int_equal(st_find(store, "m", &mesh), ST_OK);
    const he_mesh *content = st_read_begin(mesh, NULL);
    assert_int_equal(he_mesh_copy(content, &copy, NULL), HE_OK);
    st_read_end(mesh);
    st_release(mesh);
    return copy;
}

static uint32_t some(const he_mesh *mesh, md_random *random, he_kind kind)
{
    return md_below(random, he_mesh_issued(mesh, kind) + 1);
}

static void random_op(const he_mesh *m, md_random *random, char body[BODY])
{
    switch (md_below(random, 6)) {
    case 0:
        snprintf(body, BODY, "{\"op\":\"face_poke\",\"face\":%u}", some(m, random, HE_FACE));
        return;
    case 1:
        snprintf(body, BODY, "{\"op\":\"edge_split\",\"edge\":%u,\"t\":0.3}",
                 some(m, random, HE_EDGE));
        return;
    case 2:
        snprintf(body, BODY, "{\"op\":\"face_delete\",\"face\":%u}", some(m, random, HE_FACE));
        return;
    case 3:
        snprintf(body, BODY, "{\"op\":\"edge_collapse\",\"edge\":%u}", some(m, random, HE_EDGE));
        return;
    case 4:
        snprintf(body, BODY, "{\"op\":\"edge_flip\",\"edge\":%u}", some(m, random, HE_EDGE));
        return;
    default:
        snprintf(body, BODY, "{\"op\":\"vertex_move\",\"vertex\":%u,\"to\":[0.1,%u,7]}",
                 some(m, random, HE_VERTEX), md_below(random, 1000));
        return;
    }
}

/* --- sets of created, deleted and modified elements --- */

static bool holds(const cJSON *list, uint32_t id)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, list)
    {
        if (item->valuedouble == id) {
            return true;
        }
    }
    return false;
}

static const cJSON *set_of(const bench_reply *r, const char *set, he_kind kind)
{
    const cJSON *sets = cJSON_GetObjectItemCaseSensitive(r->json, set);
    return cJSON_GetObjectItemCaseSensitive(sets, he_kind_plural(kind));
}

/* The set `created` of the answer must be exactly the elements that are live after the request but
 * not before, the set `deleted` those that are live before but not after. A vertex that moved must
 * be in `modified`. */
static void check_sets(const bench_reply *r, const he_mesh *before, const he_mesh *after)
{
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    for (size_t k = 0; k < 3; k++) {
        he_kind kind = kinds[k];
        uint32_t issued = he_mesh_issued(after, kind);
        for (uint32_t id = 0; id < issued; id++) {
            bool was = id < he_mesh_issued(before, kind) && he_mesh_is_live(before, kind, id);
            bool is = he_mesh_is_live(after, kind, id);
            assert_int_equal(holds(set_of(r, "created", kind), id), is && !was);
            assert_int_equal(holds(set_of(r, "deleted", kind), id), was && !is);
            if (holds(set_of(r, "modified", kind), id)) {
                assert_true(was && is);
            }
            if (kind == HE_VERTEX && was && is) {
                he_vec3 p = he_position(before, (he_vertex){id});
                he_vec3 q = he_position(after, (he_vertex){id});
                bool moved = p.x != q.x || p.y != q.y || p.z != q.z;
                assert_true(!moved || holds(set_of(r, "modified", kind), id));
            }
        }
    }
}

/* --- random histories --- */

/* The state that the test expects of the server. The edits in `done` can be undone, those in
 * `undone` can be redone; each edit is represented by the revision that it made. */
typedef struct model {
    uint64_t head;
    uint64_t done[MOST], undone[MOST];
    size_t done_count, undone_count;
    /* for each revision, the newest edit in `done` when the revision was made; 1 if `done` was
     * empty */
    uint64_t state[MOST];
    char *dumps[MOST];
} model;

static uint64_t top(const model *m)
{
    return m->done_count == 0 ? 1 : m->done[m->done_count - 1];
}

static void note_head(api_bench *b, model *m)
{
    m->state[m->head] = top(m);
    m->dumps[m->head] = dump(b, 0);
}

static void undo_one(model *m)
{
    m->undone[m->undone_count++] = m->done[--m->done_count];
    m->state[++m->head] = top(m);
}

static void redo_one(model *m)
{
    m->done[m->done_count++] = m->undone[--m->undone_count];
    m->state[++m->head] = top(m);
}

/* Returns the number of undo or redo steps that lead to a state; -1 if they cannot lead to it. */
static int steps_to(const model *m, bool undo, uint64_t state)
{
    if (state == top(m)) {
        return 0;
    }
    for (size_t i = 0; undo && i < m->done_count; i++) {
        uint64_t below = m->done_count - 1 - i == 0 ? 1 : m->done[m->done_count - 2 - i];
        if (below == state) {
            return (int)i + 1;
        }
    }
    for (size_t i = 0; !undo && i < m->undone_count; i++) {
        if (m->undone[m->undone_count - 1 - i] == state) {
            return (int)i + 1;
        }
    }
    return -1;
}

/* Takes several undo or redo steps in the model `m` and compares the model with the answer `r`.
 * Each step makes a revision, which must read like the earlier revision with the same state. */
static void take_steps(api_bench *b, model *m, bool undo, int steps, bench_reply r,
                       const he_mesh *before)
{
    uint64_t from = m->head;
    for (int i = 0; i < steps; i++) {
        if (undo) {
            undo_one(m);
        } else {
            redo_one(m);
        }
    }
    assert_int_equal(history_number(r.json, "revision"), m->head);
    assert_int_equal(history_number(r.json, "undo"), m->done_count);
    assert_int_equal(history_number(r.json, "redo"), m->undone_count);
    for (uint64_t revision = from + 1; revision <= m->head; revision++) {
        m->dumps[revision] = dump(b, revision);
        assert_string_equal(m->dumps[revision], m->dumps[m->state[revision]]);
    }
    he_mesh *after = content_of(b);
    check_sets(&r, before, after);
    he_mesh_free(after);
    bench_done(r);
}

static void step_by_count(api_bench *b, model *m, md_random *random, bool undo)
{
    char body[BODY];
    size_t left = undo ? m->done_count : m->undone_count;
    uint32_t steps = md_from(random, 1, 4);
    he_mesh *before = content_of(b);
    snprintf(body, sizeof body, "{\"steps\":%u}", steps);
    bench_reply r = history_post(b, undo ? "undo" : "redo", steps == 1 ? NULL : body);
    if (steps > left) {
        assert_int_equal(r.status, 409);
        assert_string_equal(history_code(&r), undo ? "nothing_to_undo" : "nothing_to_redo");
        bench_done(r);
    } else {
        take_steps(b, m, undo, (int)steps, bench_expect(200, r), before);
    }
    he_mesh_free(before);
}

static void step_to_revision(api_bench *b, model *m, md_random *random, bool undo)
{
    char body[BODY];
    uint64_t revision = md_from(random, 1, (uint32_t)m->head);
    int steps = steps_to(m, undo, m->state[revision]);
    he_mesh *before = content_of(b);
    snprintf(body, sizeof body, "{\"to_revision\":%" PRIu64 "}", revision);
    bench_reply r = history_post(b, undo ? "undo" : "redo", body);
    if (steps < 0) {
        assert_int_equal(r.status, 409);
        assert_string_equal(history_code(&r), "unreachable_revision");
        bench_done(r);
    } else {
        take_steps(b, m, undo, steps, bench_expect(200, r), before);
    }
    he_mesh_free(before);
    char *now = dump(b, 0);
    assert_string_equal(now, m->dumps[steps < 0 ? m->head : revision]);
    free(now);
}

static void edit_once(api_bench *b, model *m, md_random *random)
{
    char body[BODY];
    he_mesh *before = content_of(b);
    random_op(before, random, body);
    bench_reply r = history_post(b, "edits", body);
    assert_true(r.status == 200 || r.status == 422);
    if (r.status == 200 && history_number(r.json, "revision") > (double)m->head) {
        m->done[m->done_count++] = ++m->head;
        m->undone_count = 0;
        note_head(b, m);
        he_mesh *after = content_of(b);
        check_sets(&r, before, after);
        he_mesh_free(after);
    }
    bench_done(r);
    he_mesh_free(before);
}

static void random_step(api_bench *b, model *m, md_random *random)
{
    uint32_t what = md_below(random, 24);
    bool undo = md_below(random, 2) == 0;
    if (what < 18) {
        edit_once(b, m, random);
    } else if (what < 23) {
        step_by_count(b, m, random, undo);
    } else {
        step_to_revision(b, m, random, undo);
    }
}

static void every_revision_stays_what_it_was(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    api_bench *b = bench_new();
    model *m = calloc(1, sizeof *m);
    assert_non_null(m);
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL,
                                            "{\"shape\":\"icosphere\",\"subdivisions\":1}")));
    m->head = 1;
    note_head(b, m);
    while (m->head < MOST - 60) {
        random_step(b, m, &random);
    }
    while (m->done_count == 0) {
        edit_once(b, m, &random);
    }
    /* Undoes all steps and then redoes all of them. After each step, the mesh must equal what it
     * was in that state before. */
    he_mesh *end = content_of(b);
    size_t deepest = m->done_count + m->undone_count;
    while (m->undone_count > 0 && m->head < MOST - 40) {
        step_by_count(b, m, &random, false);
    }
    char *last = dump(b, 0);
    bench_done(bench_expect(200, history_post(b, "undo", "{\"to_revision\":1}")));
    char *first = dump(b, 0);
    assert_string_equal(first, m->dumps[1]);
    uint64_t steps = m->done_count;
    char body[BODY];
    snprintf(body, sizeof body, "{\"steps\":%" PRIu64 "}", steps);
    bench_done(bench_expect(200, history_post(b, "redo", body)));
    char *again = dump(b, 0);
    assert_string_equal(again, last);
    printf("note: %" PRIu64 " revisions, %zu steps deep\n", m->head, deepest);
    /* Reads the earlier revisions in a mixed order. Each answer must equal the one that the mesh
     * gave when the revision was the newest. */
    for (uint64_t i = 0; i < m->head; i++) {
        uint64_t revision = 1 + (i * 37 + 11) % m->head;
        char *then = dump(b, revision);
        assert_string_equal(then, m->dumps[revision]);
        free(then);
    }
    for (uint64_t revision = 1; revision <= m->head; revision++) {
        free(m->dumps[revision]);
    }
    he_mesh_free(end);
    free(first);
    free(again);
    free(last);
    free(m);
    bench_free(b);
}

/* --- a small memory budget --- */

static void the_history_stays_within_its_budget_and_says_so(void **state)
{
    (void)state;
    enum { BUDGET = 6000, EDITS = 300 };
    md_random random = {seed_of_run()};
    api_bench *b = bench_new_within(BUDGET, 0);
    char *dumps[10 * EDITS] = {NULL}, body[BODY], target[TARGET];
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL,
                                            "{\"shape\":\"icosphere\",\"subdivisions\":1}")));
    dumps[1] = dump(b, 0);
    uint64_t head = 1, dropped = 0;
    for (int i = 0; i < EDITS; i++) {
        bool step = md_below(&random, 4) == 0;
        he_mesh *mesh = content_of(b);
        random_op(mesh, &random, body);
        he_mesh_free(mesh);
        bench_done(step ? history_post(b, md_below(&random, 2) ? "undo" : "redo", NULL)
                        : history_post(b, "edits", body));
        uint64_t now = head_of(b);
        if (now == head) {
            continue;
        }
        head = now;
        dumps[head] = dump(b, 0);
        bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits"));
        assert_true(history_number(r.json, "bytes") <= BUDGET);
        assert_int_equal(history_number(r.json, "budget"), BUDGET);
        assert_true(history_number(r.json, "dropped") >= (double)dropped);
        dropped = (uint64_t)history_number(r.json, "dropped");
        uint64_t oldest = (uint64_t)history_number(r.json, "oldest");
        const cJSON *entries = cJSON_GetObjectItemCaseSensitive(r.json, "entries");
        assert_int_equal(cJSON_GetArraySize(entries) + (int)dropped, head - 1);
        assert_true(oldest >= 1 + dropped);
        bench_done(r);
        char *then = dump(b, oldest);
        assert_string_equal(then, dumps[oldest]);
        free(then);
        if (oldest > 1) {
            snprintf(target, sizeof target, "/v1/meshes/m?revision=%" PRIu64, oldest - 1);
            r = bench_expect(410, bench_get(b, target));
            assert_string_equal(history_code(&r), "revision_gone");
            bench_done(r);
            snprintf(body, sizeof body, "{\"to_revision\":%" PRIu64 "}", oldest - 1);
            r = history_post(b, "undo", body);
            assert_true(r.status == 410 || r.status == 200);
            /* undo succeeds (200) if it can reach another revision at which the mesh was the
             * same */
            if (r.status == 200) {
                char *same = dump(b, 0);
                assert_string_equal(same, dumps[oldest - 1]);
                free(same);
                while (head < head_of(b)) {
                    assert_true(++head < sizeof dumps / sizeof *dumps);
                    dumps[head] = dump(b, head);
                }
            }
            bench_done(r);
        }
    }
    assert_true(dropped > 0);
    printf("note: %" PRIu64 " of %" PRIu64 " entries were dropped\n", dropped, head - 1);
    for (size_t i = 0; i < sizeof dumps / sizeof *dumps; i++) {
        free(dumps[i]);
    }
    bench_free(b);
}

/* Makes `edits` edits, each of which adds a vertex; returns how many of them can be undone. */
static uint32_t fill_history(api_bench *b, int edits)
{
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    for (int i = 0; i < edits; i++) {
        bench_done(bench_expect(
            200, history_post(b, "edits", "{\"op\":\"edge_split\",\"edge\":0,\"t\":0.5}")));
    }
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits"));
    assert_true(history_number(r.json, "dropped") > 0);
    uint32_t left = (uint32_t)history_number(r.json, "undo");
    bench_done(r);
    return left;
}

/* Requests undo or redo steps. The answer must say that `undo` and `redo` more steps are possible,
 * and the history that is read right afterwards must say the same. */
static void expect_stacks(api_bench *b, const char *which, uint32_t steps, uint32_t undo,
                          uint32_t redo)
{
    char body[BODY];
    snprintf(body, sizeof body, "{\"steps\":%u}", steps);
    bench_reply r = bench_expect(200, history_post(b, which, body));
    assert_int_equal(history_number(r.json, "redo"), redo);
    assert_int_equal(history_number(r.json, "undo"), undo);
    bench_done(r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits"));
    assert_int_equal(history_number(r.json, "redo"), redo);
    assert_int_equal(history_number(r.json, "undo"), undo);
    assert_true(history_number(r.json, "bytes") <= history_number(r.json, "budget"));
    bench_done(r);
}

static void all_that_was_undone_in_a_full_history_can_be_done_again(void **state)
{
    (void)state;
    api_bench *b = bench_new_within(20 * 1024, 0);
    uint32_t all = fill_history(b, 60);
    assert_true(all > 10);
    char *before = dump(b, 0);
    for (int round = 0; round < 3; round++) {
        expect_stacks(b, "undo", all, 0, all);
        expect_stacks(b, "redo", all, all, 0);
        char *after = dump(b, 0);
        assert_string_equal(after, before);
        free(after);
    }
    free(before);
    bench_free(b);
}

/* Each undo adds an entry to the history. When its memory budget is full, new entries displace the
 * oldest ones, so that fewer steps can be undone. They must never displace a step that can be
 * redone. */
static void an_undo_never_costs_a_redo(void **state)
{
    (void)state;
    api_bench *b = bench_new_within(20 * 1024, 0);
    uint32_t all = fill_history(b, 60), redo = 0, undo = all;
    while (undo > 0) {
        bench_reply r = bench_expect(200, history_post(b, "undo", NULL));
        redo++;
        assert_int_equal(history_number(r.json, "redo"), redo);
        assert_true(history_number(r.json, "undo") < undo);
        undo = (uint32_t)history_number(r.json, "undo");
        bench_done(r);
    }
    assert_true(redo >= all / 2);
    for (int i = 0; i < 100; i++) {
        expect_stacks(b, "redo", 1, 1, redo - 1);
        expect_stacks(b, "undo", 1, 0, redo);
    }
    expect_stacks(b, "redo", redo, redo, 0);
    bench_free(b);
}

/* After a subdivision is undone, the history keeps the fine mesh for a redo. The fine mesh alone
 * exceeds the memory budget, but must be kept. */
static void what_an_edit_made_does_not_count_against_its_redo(void **state)
{
    (void)state;
    api_bench *b = bench_new_within(20 * 1024, 0);
    fill_history(b, 60);
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/c", NULL, "{\"shape\":\"cube\"}")));
    bench_reply r = bench_expect(200, bench_post(b, "/v1/meshes/c/edits",
                                                 "{\"op\":\"subdivide\",\"scheme\":\"linear\","
                                                 "\"steps\":4}"));
    assert_null(cJSON_GetObjectItem(r.json, "undoable"));
    bench_done(r);
    for (int i = 0; i < 3; i++) {
        r = bench_expect(200, bench_post(b, "/v1/meshes/c/undo", NULL));
        assert_int_equal(history_number(r.json, "redo"), 1);
        bench_done(r);
        r = bench_expect(200, bench_post(b, "/v1/meshes/c/redo", NULL));
        assert_int_equal(history_number(r.json, "undo"), 1);
        bench_done(r);
    }
    /* After a new edit nothing can be redone, so the fine mesh counts toward the budget and must be
     * dropped. */
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/c/undo", NULL)));
    bench_done(bench_expect(
        200, bench_post(b, "/v1/meshes/c/edits", "{\"op\":\"face_poke\",\"face\":0}")));
    r = bench_expect(200, bench_get(b, "/v1/meshes/c/edits"));
    assert_true(history_number(r.json, "dropped") >= 2);
    assert_int_equal(history_number(r.json, "undo"), 1);
    bench_done(r);
    bench_free(b);
}

static void an_edit_beyond_the_budget_says_that_the_history_ends(void **state)
{
    (void)state;
    api_bench *b = bench_new_within(4000, 0);
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL,
                                            "{\"shape\":\"icosphere\",\"subdivisions\":2}")));
    bench_reply r =
        bench_expect(200, history_post(b, "edits", "{\"op\":\"face_poke\",\"face\":1}"));
    assert_null(cJSON_GetObjectItem(r.json, "undoable"));
    bench_done(r);
    static const char large[] =
        "{\"op\":\"transform\",\"matrix\":[2,0,0,0,0,2,0,0,0,0,2,0,0,0,0,1]%s}";
    char body[BODY];
    snprintf(body, sizeof body, large, ",\"dry_run\":true");
    r = bench_expect(200, history_post(b, "edits", body));
    assert_true(cJSON_IsFalse(cJSON_GetObjectItem(r.json, "undoable")));
    bench_done(r);
    bench_done(bench_expect(200, bench_get(b, "/v1/meshes/m?revision=1")));
    snprintf(body, sizeof body, large, "");
    r = bench_expect(200, history_post(b, "edits", body));
    assert_true(cJSON_IsFalse(cJSON_GetObjectItem(r.json, "undoable")));
    bench_done(r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits"));
    assert_int_equal(history_number(r.json, "oldest"), 3);
    assert_int_equal(history_number(r.json, "undo"), 0);
    const cJSON *newest = cJSON_GetObjectItem(r.json, "entries")->child;
    assert_true(cJSON_IsFalse(cJSON_GetObjectItem(newest, "undoable")));
    assert_true(history_number(newest, "bytes") > 4000);
    bench_done(r);
    bench_done(bench_expect(410, bench_get(b, "/v1/meshes/m?revision=2")));
    bench_done(bench_expect(409, history_post(b, "undo", NULL)));
    bench_free(b);
}

/* --- refusals of undo and redo --- */

static void steps_that_cannot_be_taken_change_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *what, *body;
        int status;
        const char *code;
    } rows[] = {
        {"undo", "{\"to_revision\":9}", 422, "no_such_revision"},
        {"redo", "{\"to_revision\":9}", 422, "no_such_revision"},
        /* undo cannot lead to revision 3, only redo can */
        {"undo", "{\"to_revision\":3}", 409, "unreachable_revision"},
        {"redo", "{\"to_revision\":1}", 409, "unreachable_revision"},
        {"undo", "{\"steps\":2}", 409, "nothing_to_undo"},
        {"redo", "{\"steps\":2}", 409, "nothing_to_redo"},
        {"undo", "{\"steps\":0}", 400, NULL},
        {"undo", "{\"steps\":4294967296}", 400, NULL},
        {"undo", "{\"steps\":1,\"to_revision\":1}", 400, "conflicting_members"},
        {"undo", "{\"to_revision\":0}", 400, NULL},
        {"undo", "{\"to_revision\":1,\"expected_revision\":3}", 412, "stale_revision"},
        {"undo", "{\"to\":1}", 400, "unknown_member"},
    };
    api_bench *b = history_begin();
    char *before = dump(b, 0);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        bench_reply r = bench_expect(rows[i].status, history_post(b, rows[i].what, rows[i].body));
        if (rows[i].code != NULL) {
            assert_string_equal(history_code(&r), rows[i].code);
        }
        bench_done(r);
        assert_int_equal(head_of(b), 4);
    }
    char *after = dump(b, 0);
    assert_string_equal(before, after);
    free(before);
    free(after);
    /* Undo to a revision with the present state makes no step and no new revision. */
    bench_reply r = bench_expect(200, history_post(b, "undo", "{\"to_revision\":2}"));
    assert_int_equal(history_number(r.json, "revision"), 4);
    bench_done(r);
    /* A state that was left by undo, after which another edit was made, can be read, but neither
     * undo nor redo leads to it. */
    bench_done(bench_expect(200, history_post(b, "edits", "{\"op\":\"face_poke\",\"face\":2}")));
    r = bench_expect(409, history_post(b, "undo", "{\"to_revision\":3}"));
    assert_string_equal(history_code(&r), "unreachable_revision");
    bench_done(r);
    bench_done(bench_expect(200, bench_get(b, "/v1/meshes/m?revision=3")));
    bench_free(b);
}

static void a_finer_mesh_is_one_step_of_the_history(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(200, history_post(b, "edits", "{\"op\":\"face_poke\",\"face\":2}")));
    char *before = dump(b, 0);
    bench_reply r =
        bench_expect(200, history_post(b, "edits", "{\"op\":\"subdivide\",\"steps\":2}"));
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(r.json, "replaced")));
    assert_null(cJSON_GetObjectItem(r.json, "undoable"));
    bench_done(r);
    bench_done(bench_expect(200, history_post(b, "edits", "{\"op\":\"face_delete\",\"face\":60}")));
    char *after = dump(b, 0), *then = dump(b, 2);
    assert_string_equal(then, before);
    free(then);
    bench_done(bench_expect(200, history_post(b, "undo", "{\"steps\":2}")));
    char *undone = dump(b, 0), *past = dump(b, 4);
    assert_string_equal(undone, before);
    assert_string_equal(past, after);
    bench_done(bench_expect(200, history_post(b, "redo", "{\"steps\":2}")));
    char *again = dump(b, 0);
    assert_string_equal(again, after);
    /* Later edits must not issue the ids of elements that an undone edit made. */
    bench_done(bench_expect(200, history_post(b, "undo", "{\"steps\":3}")));
    r = bench_expect(200, history_post(b, "edits", "{\"op\":\"face_poke\",\"face\":2}"));
    const cJSON *results = cJSON_GetObjectItem(r.json, "results");
    assert_true(history_number(cJSON_GetArrayItem(results, 0), "vertex") > 100);
    bench_done(r);
    free(before);
    free(after);
    free(undone);
    free(past);
    free(again);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_revision_stays_what_it_was),
        cmocka_unit_test(the_history_stays_within_its_budget_and_says_so),
        cmocka_unit_test(all_that_was_undone_in_a_full_history_can_be_done_again),
        cmocka_unit_test(an_undo_never_costs_a_redo),
        cmocka_unit_test(what_an_edit_made_does_not_count_against_its_redo),
        cmocka_unit_test(an_edit_beyond_the_budget_says_that_the_history_ends),
        cmocka_unit_test(steps_that_cannot_be_taken_change_nothing),
        cmocka_unit_test(a_finer_mesh_is_one_step_of_the_history),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
