/* A client keeps the arrays of vertices and triangles and updates them by the answers of GET
 * .../geometry?since=. They must equal the arrays that a new client fetches.
 *  The environment gives EDITS, the number of random edits (default 3000), and SEED (default:
 * from the clock). A layout assigns elements to entries of the arrays; a client whose layout is
 * outdated gets an answer with all entries. */
#include "tests/api/arrays.h"
#include "tests/writing.h"

#include "draw/draw_arrays.h"
#include "mesh/walk.h"
#include "model/random.h"
#include "op/op.h"
#include "unit/fixture.h"
#include "tests/failing.h"

#include <inttypes.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

/* --- random edits --- */

typedef struct world {
    api_bench *b;
    st_store *store;
    st_mesh *mesh;
    md_random r;
    uint64_t done, refused, stepped;
} world;

enum { MANY = 5, ROOM = 600 };

static uint32_t any(world *w, const he_mesh *m, he_kind kind)
{
    uint32_t issued = he_mesh_issued(m, kind), id = 0;
    for (int i = 0; i < 20 && issued > 0; i++) {
        id = md_below(&w->r, issued);
        if (he_mesh_is_live(m, kind, id)) {
            break;
        }
    }
    return id;
}

/* Returns the mesh that the edit `append` adds: a single vertex. The first call makes this mesh. */
static const he_mesh *a_vertex(void)
{
    static he_mesh *made;
    he_soup soup;
    he_soup_init(&soup, NULL);
    if (made == NULL) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){0, 0, 0}, NULL), HE_OK);
        assert_int_equal(he_build(&soup, 0, &made, NULL, NULL), HE_OK);
    }
    he_soup_clear(&soup);
    return made;
}

static void fill_argument(world *w, const he_mesh *m, const he_param *p, he_arg *arg,
                          uint32_t ids[MANY], he_vec3 points[MANY])
{
    double span = md_chance(&w->r, 3) ? 40 : 0.7;
    arg->given = true;
    switch (p->type) {
    case HE_PARAM_ELEMENT:
        arg->id = (p->flags & HE_NULLABLE) && md_chance(&w->r, 30) ? HE_NONE : any(w, m, p->kind);
        break;
    case HE_PARAM_ELEMENTS:
    case HE_PARAM_CYCLE:
        arg->count = p->type == HE_PARAM_CYCLE ? md_from(&w->r, 3, MANY)
                                               : (md_chance(&w->r, 70) ? 1 : md_from(&w->r, 1, 3));
        arg->list = arg->count > 1;
        for (size_t i = 0; i < arg->count; i++) {
            ids[i] = any(w, m, p->kind);
        }
        arg->ids = ids;
        arg->id = ids[0];
        break;
    case HE_PARAM_NUMBER:
        arg->number = p->flags & HE_RANGE && p->max < 1e6
                          ? p->min + (0.1 + 0.8 * md_unit(&w->r)) * (p->max - p->min)
                          : 0.05 + md_unit(&w->r);
        /* a large number, such as of subdivision steps, would make the mesh large */
        if (p->flags & HE_WHOLE) {
            arg->number = p->min + (p->max < 1e6 ? 0 : md_below(&w->r, 200));
        }
        break;
    case HE_PARAM_POINT:
    case HE_PARAM_POINTS:
        points[0] = (he_vec3){span * (md_unit(&w->r) - 0.5), span * (md_unit(&w->r) - 0.5),
                              span * (md_unit(&w->r) - 0.5)};
        arg->points = points;
        arg->count = 1;
        break;
    case HE_PARAM_FLAG:
        arg->flag = md_chance(&w->r, 50);
        break;
    case HE_PARAM_CHOICE:
        arg->choice = 0;
        break;
    case HE_PARAM_POLYGON:
        for (size_t i = 0; i < 3; i++) {
            points[i] = (he_vec3){md_unit(&w->r), md_unit(&w->r), 0};
        }
        arg->points = points;
        arg->count = 3;
        break;
    case HE_PARAM_TEXT:
        arg->text = md_chance(&w->r, 50) ? "a" : "b";
        break;
    case HE_PARAM_COLOR:
        arg->count = 3;
        arg->color[0] = md_unit(&w->r);
        break;
    case HE_PARAM_MESH:
        arg->mesh = a_vertex();
        break;
    case HE_PARAM_MATRIX:
        for (int i = 0; i < 16; i++) {
            arg->matrix[i] = i % 5 == 0 ? 1 : 0;
        }
        arg->matrix[0] = md_chance(&w->r, 20) ? 0.01 : 0.9 + 0.2 * md_unit(&w->r);
        arg->matrix[3] = 0.2 * md_unit(&w->r) - 0.1;
        break;
    }
}

/* Runs one random operation with random arguments. Many attempts are refused, because many
 * operations apply only to special places of a mesh. */
static bool run_one(world *w, he_mesh *m, bool *barrier)
{
    const he_op *op = he_op_at(md_below(&w->r, (uint32_t)he_op_count()));
    he_arg args[HE_OP_PARAMS];
    uint32_t ids[HE_OP_PARAMS][MANY];
    he_vec3 points[HE_OP_PARAMS][MANY];
    he_results results = {0};
    he_error err = {0};
    bool is_compact = strcmp(op->name, "compact") == 0;
    if ((is_compact && !md_chance(&w->r, 5)) ||
        (op->size == HE_OP_WHOLE && !is_compact &&
         (he_mesh_faces(m) > ROOM / 2 || !md_chance(&w->r, 15)))) {
        return false;
    }
    he_op_defaults(op, args);
    for (size_t i = 0; i < he_op_params(op); i++) {
        const he_param *p = &op->params[i];
        bool first = he_op_takes(op, args, i);
        for (size_t k = 0; k < i && p->group != 0; k++) {
            first = first && (op->params[k].group != p->group || !he_op_takes(op, args, k));
        }
        if (first && (he_op_needs(op, args, i) || md_chance(&w->r, 40))) {
            fill_argument(w, m, p, &args[i], ids[i], points[i]);
        }
    }
    he_status status = he_op_run(op, m, args, &results, &err);
    he_results_clear(&results);
    *barrier = *barrier || (status == HE_OK && is_compact);
    return status == HE_OK;
}

static void edit(world *w)
{
    bool barrier = false, claimed = md_chance(&w->r, 20);
    st_write write;
    if (claimed) {
        assert_int_equal(st_write_claim(w->mesh, NULL, &write), ST_OK);
        assert_int_equal(st_write_copy(&write, NULL, NULL), HE_OK);
    } else {
        assert_int_equal(st_write_begin(w->mesh, NULL, &write), ST_OK);
    }
    uint32_t batch = md_chance(&w->r, 70) ? 1 : md_from(&w->r, 2, 6);
    for (uint32_t i = 0; i < batch && !barrier; i++) {
        bool good = run_one(w, write.content, &barrier);
        w->done += good;
        w->refused += !good;
    }
    if (write.delta->count == 0) {
        st_write_abort(&write);
    } else {
        assert_true(writing_commit(&write, "random", NULL));
    }
}

static void step(world *w, st_action which)
{
    w->stepped += writing_step(w->mesh, which, 1) == ST_OK;
}

static void put(api_bench *b, const char *body)
{
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, body);
    if (r.status != 200 && r.status != 201) {
        fail_msg("%s: %d %s", body, r.status, r.body);
    }
    bench_reply_free(&r);
}

static const char *const starts[] = {
    "{\"shape\":\"cube\"}", "{\"shape\":\"torus\",\"major_segments\":12,\"minor_segments\":8}",
    "{\"shape\":\"grid\"}", "{\"shape\":\"dodecahedron\"}", "{\"shape\":\"disk\"}"};
enum { STARTS = sizeof starts / sizeof *starts };

static uint32_t faces_of(world *w)
{
    uint32_t faces = he_mesh_faces(st_read_begin(w->mesh, NULL));
    st_read_end(w->mesh);
    return faces;
}

static uint64_t from_environment(const char *name, uint64_t fallback)
{
    const char *text = getenv(name);
    return text == NULL ? fallback : strtoull(text, NULL, 10);
}

static world begin(uint64_t seed)
{
    world w = {.b = bench_new(), .r = {seed}};
    w.store = bench_store(w.b);
    put(w.b, starts[1]);
    assert_int_equal(st_find(w.store, "m", &w.mesh), ST_OK);
    return w;
}

static void end(world *w)
{
    st_release(w->mesh);
    bench_free(w->b);
}

/* Two clients follow random edits. One requests the changes after nearly every edit, the other one
 * only after many edits. The arrays of both must equal those that a new client fetches. */
static void patched_arrays_equal_fresh_ones(void **state)
{
    (void)state;
    uint64_t seed = from_environment("SEED", (uint64_t)time(NULL));
    uint64_t edits = from_environment("EDITS", 3000);
    printf("note: SEED=%" PRIu64 "\n", seed);
    world w = begin(seed);
    arrays often = {0}, seldom = {0}, fresh = {0};
    while (w.done < edits) {
        uint32_t dice = md_below(&w.r, 100);
        if (dice < 75) {
            edit(&w);
        } else if (dice < 99) {
            for (uint32_t n = md_from(&w.r, 1, 4); n > 0; n--) {
                step(&w, dice < 90 ? ST_UNDO : ST_REDO);
            }
        }
        if (faces_of(&w) > ROOM || faces_of(&w) < 2) {
            put(w.b, starts[md_below(&w.r, STARTS)]);
        }
        if (md_chance(&w.r, 40)) {
            arrays_update(w.b, "m", &often);
        }
        if (md_chance(&w.r, 4)) {
            arrays_update(w.b, "m", &seldom);
            arrays_update(w.b, "m", &often);
            arrays_forget(&fresh);
            arrays_update(w.b, "m", &fresh);
            arrays_assert_same(&often, &fresh);
            arrays_assert_same(&seldom, &fresh);
            arrays_check(&fresh, st_read_begin(w.mesh, NULL));
            st_read_end(w.mesh);
        }
    }
    assert_true(often.changes > 2 * often.whole);
    assert_true(seldom.changes > 0);
    printf("note: %" PRIu64 " edits, %" PRIu64 " undone or redone: %" PRIu64 " changes of %" PRIu64
           " bytes, %" PRIu64 " fetched whole; seldom %" PRIu64 " and %" PRIu64 "\n",
           w.done, w.stepped, often.changes, often.bytes / often.changes, often.whole,
           seldom.changes, seldom.whole);
    arrays_forget(&often);
    arrays_forget(&seldom);
    arrays_forget(&fresh);
    end(&w);
}

/* --- single requests --- */

static void post(api_bench *b, const char *target, const char *body)
{
    bench_reply r = bench_send(b, "POST", target, NULL, body);
    if (r.status != 200) {
        fail_msg("%s %s: %d %s", target, body == NULL ? "" : body, r.status, r.body);
    }
    bench_reply_free(&r);
}

static void poke(api_bench *b, int face)
{
    char body[64];
    snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%d}", face);
    post(b, "/v1/meshes/m/edits", body);
}

static void an_answer_without_changes_is_only_a_header(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0};
    arrays_update(w.b, "m", &c);
    bench_reply r = arrays_ask(w.b, "m", &c);
    assert_int_equal(r.length, HEADER);
    assert_true(arrays_u64(r.body + 16) == c.revision);
    bench_reply_free(&r);
    arrays_forget(&c);
    end(&w);
}

static void an_answer_lists_only_the_rows_that_an_edit_touched(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0};
    arrays_update(w.b, "m", &c);
    post(w.b, "/v1/meshes/m/edits", "{\"op\":\"edge_split\",\"edge\":5}");
    bench_reply r = arrays_ask(w.b, "m", &c);
    /* The split added a vertex and made pentagons of two quadrilaterals, so six triangles instead
     * of four are needed to draw them. */
    assert_int_equal(arrays_u32(r.body + 88), 1);
    assert_true(arrays_u32(r.body + 92) <= 10);
    assert_true(r.length <= HEADER + 16 + 16 + 48 + 160);
    bench_reply_free(&r);
    arrays_forget(&c);
    end(&w);
}

/* The entity tag must contain the revision, the layout of the arrays, and the revision in ?since=,
 * after which the listed changes were made. */
static void tags_depend_on_the_revision_and_on_since(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0};
    bench_reply whole = arrays_ask(w.b, "m", &c);
    arrays_apply(&c, whole.body, whole.length);
    bench_reply none = arrays_ask(w.b, "m", &c);
    assert_string_not_equal(bench_header(&whole, "ETag"), bench_header(&none, "ETag"));
    const char *const headers[] = {"If-None-Match", bench_header(&whole, "ETag"), NULL};
    bench_reply same = bench_send(w.b, "GET", "/v1/meshes/m/geometry", headers, NULL);
    assert_int_equal(same.status, 304);
    poke(w.b, 3);
    bench_reply other = bench_send(w.b, "GET", "/v1/meshes/m/geometry", headers, NULL);
    assert_int_equal(other.status, 200);
    char target[200];
    snprintf(target, sizeof target, "/v1/meshes/m/geometry?since=%" PRIu64 "&layout=%" PRIu64,
             c.revision, c.layout);
    bench_reply changes = bench_send(w.b, "GET", target, headers, NULL);
    assert_int_equal(changes.status, 200);
    const char *const again[] = {"If-None-Match", bench_header(&changes, "ETag"), NULL};
    bench_reply unchanged = bench_send(w.b, "GET", target, again, NULL);
    assert_int_equal(unchanged.status, 304);
    bench_reply *all[] = {&whole, &none, &same, &other, &changes, &unchanged};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        bench_reply_free(all[i]);
    }
    arrays_forget(&c);
    end(&w);
}

static void bad_parameters_are_refused_and_old_layouts_get_all_rows(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0};
    arrays_update(w.b, "m", &c);
    char target[200];
    static const char *const bad[] = {"since=1",
                                      "layout=1",
                                      "since=0&layout=1",
                                      "since=1&layout=0",
                                      "since=-1&layout=1",
                                      "since=1&layout=18014398509481984",
                                      "since=18446744073709551616&layout=1",
                                      "since=&layout=",
                                      "since=1&layout=x",
                                      "since=1&since=1&layout=1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        snprintf(target, sizeof target, "/v1/meshes/m/geometry?%s", bad[i]);
        bench_reply r = bench_send(w.b, "GET", target, NULL, NULL);
        assert_int_equal(r.status, 400);
        bench_reply_free(&r);
    }
    /* A request with a `since` later than the newest revision is refused. If the request names
     * another layout, its `since` is ignored and the answer has the whole arrays. */
    arrays ahead = {.revision = c.revision + 1, .layout = c.layout};
    bench_reply r = arrays_ask(w.b, "m", &ahead);
    assert_int_equal(r.status, 400);
    bench_reply_free(&r);
    ahead.layout ^= 2;
    r = arrays_ask(w.b, "m", &ahead);
    assert_int_equal(r.status, 200);
    assert_true(arrays_u64(r.body + 16) == 0 && arrays_u64(r.body + 80) == c.layout);
    bench_reply_free(&r);
    /* The service records changes only after the first request for arrays. A client that names an
     * earlier revision must get the whole arrays. */
    poke(w.b, 0);
    poke(w.b, 1);
    put(w.b, starts[1]);
    arrays before = {0};
    arrays_update(w.b, "m", &before);
    assert_true(before.layout != c.layout);
    before.revision--;
    r = arrays_ask(w.b, "m", &before);
    assert_true(r.status == 200 && arrays_u64(r.body + 16) == 0);
    assert_true(arrays_u64(r.body + 80) == before.layout);
    bench_reply_free(&r);
    arrays_forget(&before);
    arrays_forget(&c);
    end(&w);
}

/* --- when a layout ends --- */

static uint64_t layout_after(world *w, arrays *c, const char *body)
{
    post(w->b, "/v1/meshes/m/edits", body);
    arrays_update(w->b, "m", c);
    return c->layout;
}

static void a_layout_outlives_small_edits_and_ends_when_it_does_not_fit(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0};
    arrays_update(w.b, "m", &c);
    uint64_t first = c.layout;
    /* These edits keep the layout: faces added and removed, undo and redo, and a vertex moved
     * within the sphere around the mesh. */
    assert_true(layout_after(&w, &c, "{\"op\":\"face_delete\",\"faces\":[1,2,3,4,5]}") == first);
    post(w.b, "/v1/meshes/m/undo", NULL);
    arrays_update(w.b, "m", &c);
    assert_true(c.layout == first);
    assert_true(layout_after(&w, &c, "{\"op\":\"vertex_move\",\"vertex\":3,\"by\":[0,0,0.01]}") ==
                first);
    assert_true(c.whole == 1);
    /* A new layout begins when a vertex leaves the bounding sphere of the mesh, because coordinates
     * are relative to that sphere. */
    uint64_t second =
        layout_after(&w, &c, "{\"op\":\"vertex_move\",\"vertex\":3,\"by\":[0,0,100]}");
    assert_true(second != first);
    /* A new layout begins when more than half of the vertices move: its coordinates are relative to
     * the new extent of the mesh. */
    uint64_t third = layout_after(
        &w, &c, "{\"op\":\"transform\",\"matrix\":[0.01,0,0,0,0,0.01,0,0,0,0,0.01,0,0,0,0,1]}");
    assert_true(third != second);
    /* A new layout begins at `compact`, which renumbers the elements, and when the mesh is
     * replaced. */
    uint64_t fourth = layout_after(&w, &c, "{\"op\":\"compact\"}");
    assert_true(fourth != third);
    put(w.b, starts[1]);
    arrays_update(w.b, "m", &c);
    uint64_t fifth = c.layout;
    assert_true(fifth != fourth);
    /* A new layout begins when more than half of the entries of the array of triangles are
     * unused. */
    for (int face = 0; face < 48; face += 12) {
        char body[200];
        int used = snprintf(body, sizeof body, "{\"op\":\"face_delete\",\"faces\":[%d", face);
        for (int i = 1; i < 12; i++) {
            used += snprintf(body + used, sizeof body - (size_t)used, ",%d", face + i);
        }
        snprintf(body + used, sizeof body - (size_t)used, "]}");
        assert_true(layout_after(&w, &c, body) == fifth);
    }
    assert_true(layout_after(&w, &c, "{\"op\":\"face_delete\",\"face\":50}") != fifth);
    assert_int_equal(c.count[TRIANGLE_PART], 2 * 47);
    arrays_forget(&c);
    end(&w);
}

/* The mesh is so large that a thread of the job pool, and not a worker, makes the answer. The
 * answer must be the same. */
static void the_pool_answers_a_large_mesh_with_changes(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0}, fresh = {0};
    put(w.b, "{\"shape\":\"torus\",\"major_segments\":100,\"minor_segments\":60}");
    arrays_update(w.b, "m", &c);
    poke(w.b, 77);
    arrays_update(w.b, "m", &c);
    assert_true(c.whole == 1 && c.changes == 1 && c.bytes < 300);
    /* The transform changes many vertices, but not most of them, so the answer must still consist
     * of changes. */
    post(w.b, "/v1/meshes/m/edits",
         "{\"op\":\"transform\",\"matrix\":[1,0,0,0.001,0,1,0,0,0,0,1,0,0,0,0,1]}");
    arrays_update(w.b, "m", &c);
    arrays_update(w.b, "m", &fresh);
    arrays_assert_same(&c, &fresh);
    arrays_forget(&c);
    arrays_forget(&fresh);
    end(&w);
}

/* A face with many corners takes long to triangulate, so a thread of the job pool does it from a
 * snapshot of the mesh. */
static void changes_of_a_face_of_400_corners_equal_fresh_rows(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0}, fresh = {0};
    size_t capacity = 400 * 30, used = 0;
    char *body = malloc(capacity);
    assert_non_null(body);
    used += (size_t)snprintf(body, capacity, "{\"vertices\":[[400,0,0]");
    for (int i = 398; i >= 0; i--) {
        used +=
            (size_t)snprintf(body + used, capacity - used, ",[%d,%d,0]", i, i % 2 == 0 ? 1 : 50);
    }
    used += (size_t)snprintf(body + used, capacity - used, "],\"faces\":[[0");
    for (int i = 1; i < 400; i++) {
        used += (size_t)snprintf(body + used, capacity - used, ",%d", i);
    }
    snprintf(body + used, capacity - used, "]]}");
    put(w.b, body);
    free(body);
    arrays_update(w.b, "m", &c);
    post(w.b, "/v1/meshes/m/edits", "{\"op\":\"vertex_move\",\"vertex\":7,\"by\":[0,0.5,0]}");
    arrays_update(w.b, "m", &c);
    arrays_update(w.b, "m", &fresh);
    arrays_assert_same(&c, &fresh);
    arrays_check(&c, st_read_begin(w.mesh, NULL));
    st_read_end(w.mesh);
    arrays_forget(&c);
    arrays_forget(&fresh);
    end(&w);
}

/* --- memory --- */

/* Each allocation fails in turn: the service must give the complete answer or a refusal, and all
 * later answers must be right. */
static void changes_without_memory_are_complete_or_refused(void **state)
{
    (void)state;
    world w = begin(1);
    arrays c = {0}, fresh = {0};
    unsigned refused = 0;
    arrays_update(w.b, "m", &c);
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        post(w.b, "/v1/meshes/m/edits", "{\"op\":\"edge_split\",\"edge\":7}");
        post(w.b, "/v1/meshes/m/undo", NULL);
        poke(w.b, (int)f.n);
        char target[200];
        snprintf(target, sizeof target, "/v1/meshes/m/geometry?since=%" PRIu64 "&layout=%" PRIu64,
                 c.revision, c.layout);
        bench_reply r = {0};
        failing_resume();
        bool answered = bench_try(w.b, &(bench_request){"GET", target, NULL, NULL, 0}, &r);
        if (failing_end(&f, answered && r.status == 200)) {
            arrays_apply(&c, r.body, r.length);
        } else {
            assert_true(!answered || r.status == 507 || r.status == 500);
            refused++;
        }
        if (answered) {
            bench_reply_free(&r);
        }
        arrays_update(w.b, "m", &c);
        arrays_forget(&fresh);
        arrays_update(w.b, "m", &fresh);
        arrays_assert_same(&c, &fresh);
    }
    assert_true(refused > 5);
    assert_true(c.whole == 1);
    arrays_forget(&c);
    arrays_forget(&fresh);
    end(&w);
}

/* --- threads --- */

typedef struct crowd {
    world *w;
    atomic_int writing;
} crowd;

static void *follow(void *context)
{
    crowd *all = context;
    arrays c = {0};
    do {
        arrays_update(all->w->b, "m", &c);
    } while (atomic_load(&all->writing));
    arrays_update(all->w->b, "m", &c);
    arrays *last = malloc(sizeof *last);
    assert_non_null(last);
    *last = c;
    return last;
}

static void concurrent_readers_end_with_the_rows_of_a_new_client(void **state)
{
    (void)state;
    enum { READERS = 3, WRITES = 300 };
    world w = begin(5);
    crowd all = {.w = &w};
    pthread_t reader[READERS];
    arrays fresh = {0};
    atomic_init(&all.writing, 1);
    for (int i = 0; i < READERS; i++) {
        assert_int_equal(pthread_create(&reader[i], NULL, follow, &all), 0);
    }
    for (int i = 0; i < WRITES; i++) {
        edit(&w);
        if (i % 3 == 0) {
            step(&w, ST_UNDO);
        }
        if (i % 100 == 50) {
            put(w.b, starts[1]);
        }
    }
    atomic_store(&all.writing, 0);
    arrays_update(w.b, "m", &fresh);
    for (int i = 0; i < READERS; i++) {
        void *last = NULL;
        assert_int_equal(pthread_join(reader[i], &last), 0);
        arrays_assert_same(last, &fresh);
        arrays_forget(last);
        free(last);
    }
    arrays_forget(&fresh);
    end(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patched_arrays_equal_fresh_ones),
        cmocka_unit_test(an_answer_without_changes_is_only_a_header),
        cmocka_unit_test(an_answer_lists_only_the_rows_that_an_edit_touched),
        cmocka_unit_test(tags_depend_on_the_revision_and_on_since),
        cmocka_unit_test(bad_parameters_are_refused_and_old_layouts_get_all_rows),
        cmocka_unit_test(a_layout_outlives_small_edits_and_ends_when_it_does_not_fit),
        cmocka_unit_test(the_pool_answers_a_large_mesh_with_changes),
        cmocka_unit_test(changes_of_a_face_of_400_corners_equal_fresh_rows),
        cmocka_unit_test(changes_without_memory_are_complete_or_refused),
        cmocka_unit_test(concurrent_readers_end_with_the_rows_of_a_new_client),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
