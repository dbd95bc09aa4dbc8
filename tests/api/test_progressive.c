/* Progressive meshes, which are sent from coarse to fine. This test decodes them with a decoder
 * that was written only from the published description of the format. In the decoder, faces are
 * lists of corners and edges are pairs of vertices. */
#include "tests/api/request.h"

#include "unit/fixture.h"

#include "edit/local/cut.h"
#include "tests/failing.h"

#include <malloc.h>

enum { HEADER = 104, VERTEX = 32, ROW = 16, SPLIT = 96 };

static uint32_t u32_at(const char *p)
{
    const unsigned char *b = (const unsigned char *)p;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static he_vec3 point_at(const char *p)
{
    double values[3];
    for (int i = 0; i < 3; i++) {
        uint64_t bits = u32_at(p + 8 * i) | (uint64_t)u32_at(p + 8 * i + 4) << 32;
        memcpy(&values[i], &bits, sizeof bits);
    }
    return (he_vec3){values[0], values[1], values[2]};
}

typedef struct level {
    uint32_t vertices, edges, faces; /* ids issued */
    he_vec3 *place;
    bool *vertex, *edge, *face;
    uint32_t (*end)[2], (*corner)[3];
    /* By vertex: 1 more than the latest vertex u to whose faces a split moved an edge from here. */
    uint32_t *fan;
    const char *next; /* position in the answer of the next vertex split */
    uint32_t left;    /* number of vertex splits still to be read */
} level;

static level first_level(const bench_reply *r)
{
    const char *p = r->body;
    assert_true(r->length >= HEADER);
    assert_memory_equal(p, "HEDP", 4);
    assert_int_equal(u32_at(p + 4), 1);
    level l = {.left = u32_at(p + 28),
               .vertices = u32_at(p + 40),
               .edges = u32_at(p + 44),
               .faces = u32_at(p + 48)};
    l.place = calloc(l.vertices + 1, sizeof *l.place);
    l.vertex = calloc(l.vertices + 1, sizeof *l.vertex);
    l.edge = calloc(l.edges + 1, sizeof *l.edge);
    l.face = calloc(l.faces + 1, sizeof *l.face);
    l.end = calloc(l.edges + 1, sizeof *l.end);
    l.corner = calloc(l.faces + 1, sizeof *l.corner);
    l.fan = calloc(l.vertices + 1, sizeof *l.fan);
    p += HEADER;
    for (uint32_t i = u32_at(r->body + 16); i > 0; i--, p += VERTEX) {
        l.vertex[u32_at(p)] = true;
        l.place[u32_at(p)] = point_at(p + 8);
    }
    for (uint32_t i = u32_at(r->body + 20); i > 0; i--, p += ROW) {
        l.edge[u32_at(p)] = true;
        l.end[u32_at(p)][0] = u32_at(p + 4);
        l.end[u32_at(p)][1] = u32_at(p + 8);
    }
    for (uint32_t i = u32_at(r->body + 24); i > 0; i--, p += ROW) {
        l.face[u32_at(p)] = true;
        for (unsigned k = 0; k < 3; k++) {
            l.corner[u32_at(p)][k] = u32_at(p + 4 + 4 * k);
        }
    }
    l.next = p;
    return l;
}

static void level_clear(level *l)
{
    free(l->place);
    free(l->vertex);
    free(l->edge);
    free(l->face);
    free(l->end);
    free(l->corner);
    free(l->fan);
}

static void add_edge(level *l, uint32_t halfedge, uint32_t from, uint32_t to)
{
    if (halfedge != HE_NONE) {
        assert_false(l->edge[halfedge / 2]);
        l->edge[halfedge / 2] = true;
        l->end[halfedge / 2][halfedge % 2] = from;
        l->end[halfedge / 2][1 - halfedge % 2] = to;
    }
}

static void add_face(level *l, uint32_t face, uint32_t a, uint32_t b, uint32_t c)
{
    if (face != HE_NONE) {
        assert_false(l->face[face]);
        l->face[face] = true;
        l->corner[face][0] = a;
        l->corner[face][1] = b;
        l->corner[face][2] = c;
    }
}

/* Replaces v by u in each edge between v and a vertex x with fan[x] == u + 1. */
static void move_edges(level *l, uint32_t v, uint32_t u)
{
    for (uint32_t e = 0; e < l->edges; e++) {
        uint32_t *end = l->end[e];
        if (end[0] == v && l->edge[e] && l->fan[end[1]] == u + 1) {
            end[0] = u;
        } else if (end[1] == v && l->edge[e] && l->fan[end[0]] == u + 1) {
            end[1] = u;
        }
    }
}

static void split(level *l)
{
    const char *p = l->next;
    uint32_t u = u32_at(p + 4), v = u32_at(p + 8), c = u32_at(p + 12), d = u32_at(p + 16);
    uint32_t moved = u32_at(p + 40);
    assert_int_equal(u32_at(p), SPLIT + (moved + 1) / 2 * 8);
    assert_false(l->vertex[u]);
    l->vertex[u] = true;
    l->place[u] = point_at(p + 48);
    l->place[v] = point_at(p + 72);
    for (uint32_t i = 0; i < moved; i++) {
        uint32_t f = u32_at(p + SPLIT + 4 * i);
        assert_true(l->face[f]);
        for (unsigned k = 0; k < 3; k++) {
            uint32_t x = l->corner[f][k];
            if (x == v) {
                l->corner[f][k] = u;
            } else if (x != c && x != d) {
                l->fan[x] = u + 1;
            }
        }
    }
    move_edges(l, v, u);
    add_edge(l, u32_at(p + 20), u, v);
    add_edge(l, u32_at(p + 24), u, c);
    add_edge(l, u32_at(p + 28), u, d);
    add_face(l, u32_at(p + 32), u, v, c);
    add_face(l, u32_at(p + 36), v, u, d);
    l->next += u32_at(p);
    l->left--;
}

/* Requires that the faces of the decoded mesh form a valid mesh, and that its edges are the sides
 * of these faces. */
static void assert_level(const level *l)
{
    uint32_t *name = calloc(l->vertices + 1, sizeof *name), edges = 0;
    he_soup soup;
    he_mesh *m = NULL;
    he_error err = {0};
    he_soup_init(&soup, NULL);
    for (uint32_t v = 0; v < l->vertices; v++) {
        if (l->vertex[v]) {
            name[v] = (uint32_t)soup.vertex_count;
            assert_int_equal(he_soup_add_vertex(&soup, l->place[v], NULL), HE_OK);
        }
    }
    for (uint32_t f = 0; f < l->faces; f++) {
        if (l->face[f]) {
            const uint32_t *c = l->corner[f];
            assert_true(l->vertex[c[0]] && l->vertex[c[1]] && l->vertex[c[2]]);
            const uint32_t corners[3] = {name[c[0]], name[c[1]], name[c[2]]};
            assert_int_equal(he_soup_add_face(&soup, corners, 3, NULL), HE_OK);
        }
    }
    if (he_build(&soup, 0, &m, NULL, &err) != HE_OK) {
        fail_msg("with %u splits left: %s", l->left, err.text);
    }
    fixture_check(m);
    for (uint32_t e = 0; e < l->edges; e++) {
        if (l->edge[e]) {
            const uint32_t *end = l->end[e];
            assert_true(l->vertex[end[0]] && l->vertex[end[1]]);
            he_halfedge h =
                he_find_halfedge(m, (he_vertex){name[end[0]]}, (he_vertex){name[end[1]]});
            assert_true(h.i != HE_NONE);
            edges++;
        }
    }
    assert_int_equal(he_mesh_edges(m), edges);
    he_mesh_free(m);
    he_soup_clear(&soup);
    free(name);
}

static void assert_same(const level *l, const he_mesh *m)
{
    assert_int_equal(l->vertices, he_mesh_issued(m, HE_VERTEX));
    assert_int_equal(l->edges, he_mesh_issued(m, HE_EDGE));
    assert_int_equal(l->faces, he_mesh_issued(m, HE_FACE));
    for (uint32_t v = 0; v < l->vertices; v++) {
        assert_int_equal(l->vertex[v], he_mesh_is_live(m, HE_VERTEX, v));
        he_vec3 p = he_position(m, (he_vertex){v});
        he_vec3 q = l->place[v];
        assert_true(!l->vertex[v] || (p.x == q.x && p.y == q.y && p.z == q.z));
    }
    for (uint32_t e = 0; e < l->edges; e++) {
        assert_int_equal(l->edge[e], he_mesh_is_live(m, HE_EDGE, e));
        for (unsigned k = 0; l->edge[e] && k < 2; k++) {
            assert_int_equal(l->end[e][k], he_origin(m, he_edge_halfedge((he_edge){e}, k)).i);
        }
    }
    for (uint32_t f = 0; f < l->faces; f++) {
        assert_int_equal(l->face[f], he_mesh_is_live(m, HE_FACE, f));
        if (l->face[f]) {
            he_halfedge h = he_face_corner(m, (he_face){f}, (he_vertex){l->corner[f][0]});
            assert_true(h.i != HE_NONE);
            assert_int_equal(he_target(m, h).i, l->corner[f][1]);
            assert_int_equal(he_target(m, he_next(m, h)).i, l->corner[f][2]);
        }
    }
}

/* Requires that the mesh `id` has the revision `revision` and equals the decoded mesh. */
static void assert_is(api_bench *b, const char *id, const level *l, uint64_t revision)
{
    st_store *store = bench_store(b);
    st_mesh *mesh = NULL;
    st_mesh_info info;
    assert_int_equal(st_find(store, id, &mesh), ST_OK);
    assert_same(l, st_read_begin(mesh, &info));
    assert_int_equal(info.revision, revision);
    st_read_end(mesh);
    st_release(mesh);
}

/* Decodes the answer and checks the mesh after each vertex split, or after some if there are
 * many. */
static void replay(api_bench *b, const char *id)
{
    char path[64];
    snprintf(path, sizeof path, "/v1/meshes/%s/progressive", id);
    bench_reply r = bench_expect(200, bench_send(b, "GET", path, NULL, NULL));
    assert_string_equal(bench_header(&r, "Content-Type"), "application/octet-stream");
    level l = first_level(&r);
    assert_int_equal(l.left, u32_at(r.body + 32));
    uint32_t step = l.left / 200 + 1;
    while (l.left > 0) {
        if (l.left % step == 0) {
            assert_level(&l);
        }
        split(&l);
    }
    assert_level(&l);
    assert_true(l.next == r.body + r.length);
    assert_is(b, id, &l, u32_at(r.body + 8));
    level_clear(&l);
    bench_reply_free(&r);
}

static void make(api_bench *b, const char *id, const char *body)
{
    char path[64];
    snprintf(path, sizeof path, "/v1/meshes/%s", id);
    bench_done(bench_expect(201, bench_send(b, "PUT", path, NULL, body)));
    snprintf(path, sizeof path, "/v1/meshes/%s/edits", id);
    bench_done(bench_expect(200, bench_post(b, path, "{\"op\":\"triangulate\"}")));
}

/* The mesh has a bow-tie (two triangles that share only a vertex), an isolated vertex, and a
 * separate triangle. */
static const char BOWTIE[] =
    "{\"vertices\":[[0,0,0],[1,0,0],[1,1,0],[-1,0,0],[-1,-1,0],[2,1,0],[9,9,9],[5,0,0],"
    "[6,0,0],[5,1,0]],\"faces\":[[0,1,2],[0,3,4],[1,5,2],[7,8,9]]}";

static void splits_lead_back_to_the_mesh(void **state)
{
    (void)state;
    static const char *const bodies[] = {
        "{\"shape\":\"icosphere\",\"subdivisions\":2}",
        "{\"shape\":\"grid\",\"columns\":9,\"rows\":7}",
        "{\"shape\":\"torus\"}",
        "{\"shape\":\"cylinder\"}",
        "{\"shape\":\"disk\"}",
        "{\"shape\":\"tetrahedron\"}",
        "{\"vertices\":[],\"faces\":[]}",
        BOWTIE,
        "{\"shape\":\"grid\",\"columns\":50,\"rows\":50}",
    };
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        char id[8];
        snprintf(id, sizeof id, "m%zu", i);
        make(b, id, bodies[i]);
        replay(b, id);
    }
    bench_free(b);
}

/* The mesh is curved, and edits have left gaps in the ids of its elements. */
static void ids_that_are_not_in_order_come_back(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    make(b, "m", "{\"shape\":\"grid\",\"columns\":12,\"rows\":12}");
    bench_done(bench_expect(
        200,
        bench_post(b, "/v1/meshes/m/edits",
                   "{\"ops\":[{\"op\":\"vertex_delete\",\"vertex\":40},{\"op\":\"vertex_move\","
                   "\"vertex\":100,\"by\":[0,0,0.3]},{\"op\":\"face_delete\",\"face\":3},"
                   "{\"op\":\"edge_flip\",\"edge\":200},{\"op\":\"edge_split\",\"edge\":90},"
                   "{\"op\":\"decimate\",\"ratio\":0.8}]}")));
    replay(b, "m");
    bench_free(b);
}

static void a_base_and_a_number_of_splits_can_be_chosen(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    make(b, "m", "{\"shape\":\"torus\"}");
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/progressive?faces=400&splits=5"));
    uint32_t faces = u32_at(r.body + 24);
    assert_in_range(faces, 399, 400);
    assert_int_equal(u32_at(r.body + 28), 5);
    assert_true(u32_at(r.body + 32) > 5);
    level l = first_level(&r);
    for (int i = 0; i < 5; i++) {
        split(&l);
        assert_level(&l);
    }
    assert_true(l.next == r.body + r.length);
    level_clear(&l);
    bench_reply_free(&r);
    bench_free(b);
}

static void the_mesh_is_not_changed(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    make(b, "m", "{\"shape\":\"torus\"}");
    bench_reply before = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    bench_done(bench_expect(200, bench_get(b, "/v1/meshes/m/progressive")));
    bench_reply after = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_string_equal(before.body, after.body);
    bench_reply_free(&before);
    bench_reply_free(&after);
    bench_free(b);
}

static void a_large_mesh_is_decimated_in_a_job(void **state)
{
    (void)state;
    static const char *const patient[] = {"Prefer", "wait=60", NULL};
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", patient,
                                            "{\"shape\":\"icosphere\",\"subdivisions\":7}")));
    bench_reply r = bench_expect(202, bench_get(b, "/v1/meshes/m/progressive"));
    char path[128];
    snprintf(path, sizeof path, "%s", bench_header(&r, "Location"));
    bench_reply_free(&r);
    bench_done(bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/progressive", patient, NULL)));
    bench_run_jobs(b, 1);
    r = bench_expect(200, bench_get(b, path));
    assert_string_equal(cJSON_GetObjectItem(r.json, "state")->valuestring, "done");
    bench_reply_free(&r);
    bench_free(b);
}

/* --- cancelling, failing allocations, and the memory of an answer --- */

#define LARGE "{\"shape\":\"icosphere\",\"subdivisions\":4}"

static api_exchange *ask(api_bench *b, const char *query,
                         bool (*tell)(void *context, const char *phase, double done), void *context)
{
    const api_request request = {
        .method = "GET", .path = "/v1/meshes/m/progressive", .query = query, .request_id = "test"};
    api_step step;
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    if (x == NULL) {
        return NULL;
    }
    step = step == API_MORE ? api_end(x) : step;
    if (step == API_WORK) {
        api_set_progress(x, tell, context);
        step = api_work(x);
    }
    assert_int_equal(step, API_READY);
    return x;
}

/* Returns false, which cancels the request, in the n-th call and in all later ones. `context`
 * points to n. If n is 0, it always returns true. */
static bool count_down(void *context, const char *phase, double done)
{
    (void)phase;
    assert_true(done >= 0 && done <= 1);
    return *(int *)context == 0 || --*(int *)context > 0;
}

static void it_can_be_given_up_at_any_time(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    make(b, "m", LARGE);
    int given_up = 0;
    for (int n = 1;; n++) {
        int left = n;
        api_exchange *x = ask(b, "", count_down, &left);
        int status = api_answer_of(x)->status;
        api_free(x);
        if (left > 0) {
            /* the request was finished before count_down() was called n times */
            assert_int_equal(status, 200);
            break;
        }
        assert_int_equal(status, 503);
        given_up++;
    }
    assert_true(given_up > 5);
    replay(b, "m");
    bench_free(b);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    make(b, "m", "{\"shape\":\"icosphere\",\"subdivisions\":2}");
    int never = 0;
    /* if only the shrinking of a block of memory fails, the request succeeds */
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        api_exchange *x = ask(b, "splits=50", count_down, &never);
        int status = x == NULL ? 507 : api_answer_of(x)->status;
        api_free(x);
        failing_end(&f, status == 200);
        assert_true(status == 507 || status == 200);
    }
    replay(b, "m");
    bench_free(b);
}

/* The number of bytes that are allocated now, as malloc counts them. */
static size_t held;

static void *count_resize(void *context, void *memory, size_t size)
{
    (void)context;
    held -= memory == NULL ? 0 : malloc_usable_size(memory);
    if (size == 0) {
        free(memory);
        return NULL;
    }
    void *resized = realloc(memory, size);
    assert_non_null(resized);
    held += malloc_usable_size(resized);
    return resized;
}

/* While a slow client reads the answer, the request must hold only the bytes that are still to be
 * sent, and not the mesh. */
static void an_answer_holds_little_more_than_its_bytes(void **state)
{
    (void)state;
    static const char *const queries[] = {"", "splits=10", "faces=2000", "faces=1000&splits=0",
                                          "faces=5120"};
    static const he_mem_hook hook = {count_resize, NULL};
    he_mem_set_hook(&hook);
    held = 0;
    api_bench *b = bench_new();
    make(b, "m", LARGE);
    /* the first request makes a snapshot of the mesh, which stays in memory */
    bench_done(bench_expect(200, bench_get(b, "/v1/meshes/m/progressive")));
    int never = 0;
    for (size_t i = 0; i < sizeof queries / sizeof *queries; i++) {
        size_t before = held;
        api_exchange *x = ask(b, queries[i], count_down, &never);
        const api_answer *answer = api_answer_of(x);
        assert_int_equal(answer->status, 200);
        size_t most = (size_t)answer->length * 5 / 4 + 16384;
        if (held - before > most) {
            fail_msg("?%s: %zu bytes for %zu", queries[i], held - before, (size_t)answer->length);
        }
        api_free(x);
    }
    bench_free(b);
    assert_int_equal(held, 0);
    he_mem_set_hook(NULL);
}

/* The history keeps the sequence of edge collapses of a decimation as long as it keeps the edit,
 * whether it stores the edit as changes of single elements or as a replacement of the mesh. */
static void the_history_keeps_the_record_of_a_decimation(void **state)
{
    (void)state;
    static const struct {
        const char *mesh, *edit, *query;
    } cases[] = {
        {"{\"shape\":\"torus\"}", "{\"op\":\"decimate\",\"faces\":300,\"boundary_weight\":3}",
         "faces=300&boundary_weight=3"},
        {"{\"shape\":\"grid\",\"columns\":20,\"rows\":20}",
         "{\"op\":\"decimate\",\"faces\":0,\"max_error\":0}", "max_error=0"},
        {"{\"shape\":\"torus\",\"major_segments\":120,\"minor_segments\":100}",
         "{\"op\":\"decimate\",\"faces\":1000}", "faces=1000"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char path[160];
        api_bench *b = bench_new();
        make(b, "m", cases[i].mesh);
        bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/edits", cases[i].edit)));
        snprintf(path, sizeof path, "/v1/meshes/m/progressive?revision=2&%s", cases[i].query);
        bench_reply r = bench_expect(200, bench_get(b, path));
        level l = first_level(&r);
        assert_true(l.left > 0);
        assert_is(b, "m", &l, 3);
        while (l.left > 0) {
            split(&l);
        }
        bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", "{}")));
        assert_is(b, "m", &l, 4);
        assert_int_equal(u32_at(r.body + 8), 2);
        level_clear(&l);
        bench_reply_free(&r);
        bench_free(b);
    }
}

static void a_limit_is_said_as_it_is(void **state)
{
    (void)state;
    static const char *const bad[] = {"nan", "-1", "1e999"};
    api_bench *b = bench_new();
    make(b, "m", "{\"shape\":\"icosphere\"}");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char path[80], expected[160];
        snprintf(path, sizeof path, "/v1/meshes/m/progressive?max_error=%s", bad[i]);
        snprintf(expected, sizeof expected,
                 "\"max_error\" cannot be \"%s\": a number from 0 to 1.7976931348623157e308",
                 bad[i]);
        bench_reply r = bench_expect(400, bench_get(b, path));
        assert_string_equal(
            cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(r.json, "detail")), expected);
        bench_reply_free(&r);
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splits_lead_back_to_the_mesh),
        cmocka_unit_test(ids_that_are_not_in_order_come_back),
        cmocka_unit_test(a_base_and_a_number_of_splits_can_be_chosen),
        cmocka_unit_test(the_mesh_is_not_changed),
        cmocka_unit_test(a_large_mesh_is_decimated_in_a_job),
        cmocka_unit_test(it_can_be_given_up_at_any_time),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(an_answer_holds_little_more_than_its_bytes),
        cmocka_unit_test(a_limit_is_said_as_it_is),
        cmocka_unit_test(the_history_keeps_the_record_of_a_decimation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
