/* The arrays in the answers of GET .../geometry, from which a viewer draws, are compared with the
 * polygons of the mesh. */
#include "tests/api/specimens.h"

#include "unit/fixture.h"
#include "tests/failing.h"

enum { HEADER = 96, ROW = 16 };

static const char PATH[] = "/v1/meshes/m/geometry";

static uint32_t u32_at(const char *p)
{
    const unsigned char *b = (const unsigned char *)p;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static uint64_t u64_at(const char *p)
{
    return u32_at(p) | (uint64_t)u32_at(p + 4) << 32;
}

static double double_at(const char *p)
{
    uint64_t bits = u64_at(p);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float float_at(const char *p)
{
    uint32_t bits = u32_at(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* An answer to GET .../geometry: the numbers in its header, and its arrays of vertices and
 * triangles. */
typedef struct arrays {
    bench_reply reply;
    uint64_t revision, layout;
    uint32_t vertices, triangles;
    double origin[3], scale;
    const char *vertex, *triangle;
} arrays;

static arrays fetch(api_bench *b)
{
    arrays a = {.reply = bench_send(b, "GET", PATH, NULL, NULL)};
    const char *body = a.reply.body;
    assert_int_equal(a.reply.status, 200);
    assert_string_equal(bench_header(&a.reply, "Content-Type"), "application/octet-stream");
    assert_true(a.reply.length >= HEADER);
    assert_memory_equal(body, "HEDG", 4);
    assert_int_equal(u32_at(body + 4), 2);
    a.revision = u64_at(body + 8);
    assert_true(u64_at(body + 16) == 0);
    a.vertices = u32_at(body + 40);
    a.triangles = u32_at(body + 44);
    assert_true(u64_at(body + 24) == (uint64_t)a.vertices * ROW);
    assert_true(u64_at(body + 32) == (uint64_t)a.triangles * ROW);
    assert_true(a.reply.length == HEADER + ((size_t)a.vertices + a.triangles) * ROW);
    for (int i = 0; i < 3; i++) {
        a.origin[i] = double_at(body + 48 + 8 * i);
    }
    a.scale = double_at(body + 72);
    a.layout = u64_at(body + 80);
    assert_true(a.layout > 0 && a.layout < (uint64_t)1 << 53);
    assert_true(u32_at(body + 88) == a.vertices && u32_at(body + 92) == a.triangles);
    a.vertex = body + HEADER;
    a.triangle = a.vertex + (size_t)a.vertices * ROW;
    return a;
}

static unsigned corner_of(const arrays *a, unsigned triangle, unsigned i)
{
    return u32_at(a->triangle + (size_t)triangle * ROW + 4 * i);
}

static unsigned face_of(const arrays *a, unsigned triangle)
{
    return corner_of(a, triangle, 3) & ((1u << 29) - 1);
}

/* Returns the index of the side of face `f` that goes from the vertex `from` to the vertex `to`. */
static unsigned side_of(const pg_mesh *pg, unsigned f, unsigned from, unsigned to)
{
    for (unsigned h = 0; h < pg->halfedges; h++) {
        if (pg->face[h] == f && pg->origin[h] == from && pg->origin[h ^ 1u] == to) {
            return h;
        }
    }
    return PG_NONE;
}

/* Adds to `sum` the area vector of a triangle, half of the cross product of two of its sides, in
 * the coordinates of the mesh. */
static void add_area(const pg_mesh *pg, const arrays *a, unsigned triangle, double sum[3])
{
    const double *p = pg->position[corner_of(a, triangle, 0)];
    const double *q = pg->position[corner_of(a, triangle, 1)];
    const double *r = pg->position[corner_of(a, triangle, 2)];
    for (int i = 0; i < 3; i++) {
        int u = (i + 1) % 3, v = (i + 2) % 3;
        sum[i] += ((q[u] - p[u]) * (r[v] - p[v]) - (q[v] - p[v]) * (r[u] - p[u])) / 2;
    }
}

static void check_triangles(const pg_mesh *pg, const arrays *a)
{
    bool marked[PG_HALFEDGES] = {false};
    unsigned triangle = 0, edges = 0, corners = 0;
    for (unsigned f = 0; f < pg->faces; f++) {
        double sum[3] = {0, 0, 0}, wanted[3];
        unsigned begin = triangle;
        for (; triangle < a->triangles && face_of(a, triangle) == f; triangle++) {
            add_area(pg, a, triangle, sum);
            for (unsigned i = 0; i < 3; i++) {
                unsigned from = corner_of(a, triangle, i), to = corner_of(a, triangle, (i + 1) % 3);
                unsigned h = side_of(pg, f, from, to);
                bool mark = (corner_of(a, triangle, 3) >> (29 + i) & 1) != 0;
                assert_int_equal(mark, h != PG_NONE);
                if (mark) {
                    assert_false(marked[h]);
                    marked[h] = true;
                    edges++;
                }
            }
        }
        assert_int_equal(triangle - begin, pg->degree[f] - 2);
        pg_area(pg, f, wanted);
        for (int i = 0; i < 3; i++) {
            assert_true(fabs(sum[i] - wanted[i]) < 1e-9);
        }
        corners += pg->degree[f];
    }
    assert_int_equal(triangle, a->triangles);
    assert_int_equal(edges, corners);
}

static void check_vertices(const pg_mesh *pg, const arrays *a)
{
    assert_int_equal(a->vertices, pg->vertices);
    for (unsigned v = 0; v < a->vertices; v++) {
        const char *row = a->vertex + (size_t)v * ROW;
        double length = 0;
        for (int i = 0; i < 3; i++) {
            double view = float_at(row + 4 * i);
            length += view * view;
            assert_true(fabs(view / a->scale + a->origin[i] - pg->position[v][i]) * a->scale <
                        1e-6);
        }
        assert_true(length <= 1);
        assert_true(float_at(row + 12) == (pg_is_isolated(pg, v) ? 2 : 1));
    }
}

static void try_arrays(api_bench *b, const pg_mesh *pg)
{
    arrays a = fetch(b);
    assert_true(a.revision == 1);
    check_vertices(pg, &a);
    check_triangles(pg, &a);
    bench_reply_free(&a.reply);
}

static void the_arrays_hold_all_positions_sides_and_areas_of_the_mesh(void **state)
{
    (void)state;
    for_each_specimen(try_arrays);
}

static void edit(api_bench *b, const char *body)
{
    bench_reply r = bench_send(b, "POST", "/v1/meshes/m/edits", NULL, body);
    if (r.status != 200) {
        fail_msg("%s: %d %s", body, r.status, r.body);
    }
    bench_reply_free(&r);
}

/* The array of vertices has an entry for each vertex id, so the entries of the remaining vertices
 * must not move when elements are deleted. The array of triangles must stay without gaps. */
static void rows_of_vertices_keep_their_ids_when_others_are_deleted(void **state)
{
    (void)state;
    pg_mesh pg;
    api_bench *b = specimen_begin("0123,7654,1045,2156,3267,0374", &pg);
    edit(b, "{\"ops\":[{\"op\":\"face_delete\",\"face\":2},{\"op\":\"vertex_delete\","
            "\"vertex\":8}]}");
    arrays a = fetch(b);
    assert_true(a.revision == 2);
    assert_int_equal(a.vertices, 9);
    assert_int_equal(a.triangles, 10);
    static const char zeros[ROW];
    assert_memory_equal(a.vertex + 8 * ROW, zeros, ROW);
    static const unsigned faces[] = {0, 0, 1, 1, 3, 3, 4, 4, 5, 5};
    for (unsigned i = 0; i < 10; i++) {
        assert_int_equal(face_of(&a, i), faces[i]);
    }
    bench_reply_free(&a.reply);
    bench_free(b);
}

/* An edit followed by its undo must give the same arrays as before; only the revision may
 * differ. */
static void an_undo_brings_back_the_same_rows(void **state)
{
    (void)state;
    pg_mesh pg;
    api_bench *b = specimen_begin("0123,7654,1045,2156,3267,0374", &pg);
    arrays before = fetch(b);
    edit(b, "{\"op\":\"vertex_delete\",\"vertex\":8}");
    bench_reply undone = bench_send(b, "POST", "/v1/meshes/m/undo", NULL, NULL);
    assert_int_equal(undone.status, 200);
    arrays after = fetch(b);
    assert_true(after.revision == 3);
    assert_int_equal(before.reply.length, after.reply.length);
    assert_memory_equal(before.reply.body + 16, after.reply.body + 16, before.reply.length - 16);
    bench_reply_free(&undone);
    bench_reply_free(&before.reply);
    bench_reply_free(&after.reply);
    bench_free(b);
}

/* The arrays of an earlier revision are those of a copy of the mesh at that revision, but for the
 * numbers of revision and layout. */
static void an_earlier_revision_is_sent_as_it_was(void **state)
{
    (void)state;
    enum { EDITS = 5, AT_REVISION = 8, AT_LAYOUT = 80 };
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    for (unsigned i = 0; i < EDITS; i++) {
        edit(b, i % 2 == 0 ? "{\"op\":\"face_poke\",\"face\":0}"
                           : "{\"op\":\"vertex_move\",\"vertex\":1,\"by\":[2,0,0]}");
        bench_done(bench_expect(200, bench_send(b, "GET", PATH, NULL, NULL)));
    }
    for (unsigned revision = 1; revision <= EDITS; revision++) {
        char target[80], copy[80], tag[100];
        (void)snprintf(target, sizeof target, "%s?revision=%u", PATH, revision);
        (void)snprintf(copy, sizeof copy, "/v1/meshes/m/copy?revision=%u", revision);
        bench_reply made = bench_expect(201, bench_send(b, "POST", copy, NULL, NULL));
        (void)snprintf(copy, sizeof copy, "%s/geometry", bench_header(&made, "Location"));
        bench_reply was = bench_expect(200, bench_send(b, "GET", copy, NULL, NULL));
        bench_reply r = bench_expect(200, bench_send(b, "GET", target, NULL, NULL));
        (void)snprintf(tag, sizeof tag, "%s", bench_header(&r, "ETag"));
        assert_int_equal(u64_at(r.body + AT_REVISION), revision);
        assert_int_equal(r.length, was.length);
        memset(r.body + AT_REVISION, 0, 8);
        memset(r.body + AT_LAYOUT, 0, 8);
        memset(was.body + AT_REVISION, 0, 8);
        memset(was.body + AT_LAYOUT, 0, 8);
        assert_memory_equal(r.body, was.body, r.length);
        bench_done(made);
        bench_done(was);
        bench_done(r);
        const char *const headers[] = {"If-None-Match", tag, NULL};
        bench_done(bench_expect(304, bench_send(b, "GET", target, headers, NULL)));
    }
    /* The layout of an earlier revision is that of no mesh: its changes cannot be told. */
    bench_reply all = bench_expect(
        200, bench_send(b, "GET", "/v1/meshes/m/geometry?since=2&layout=2", NULL, NULL));
    assert_true(u64_at(all.body + 16) == 0);
    bench_done(all);
    bench_free(b);
}

/* Read as an earlier one, a revision has another tag than when it was the present one, also if the
 * slots that are kept are still its own and the request becomes a job. */
static void an_earlier_revision_has_a_tag_of_its_own(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    bench_reply present = bench_expect(200, bench_send(b, "GET", PATH, NULL, NULL));
    edit(b, "{\"op\":\"face_poke\",\"face\":0}");
    const char *const job[] = {"Prefer", "respond-async", "If-None-Match",
                               bench_header(&present, "ETag"), NULL};
    bench_done(
        bench_expect(202, bench_send(b, "GET", "/v1/meshes/m/geometry?revision=1", job, NULL)));
    bench_done(present);
    bench_run_jobs(b, BENCH_JOBS);
    bench_free(b);
}

static void a_tag_holds_until_the_mesh_changes(void **state)
{
    (void)state;
    pg_mesh pg;
    api_bench *b = specimen_begin("012,023", &pg);
    arrays a = fetch(b);
    char etag[128];
    snprintf(etag, sizeof etag, "%s", bench_header(&a.reply, "ETag"));
    assert_true(strlen(etag) > 2);
    bench_reply_free(&a.reply);
    const char *const none[] = {"If-None-Match", etag, NULL};
    bench_reply same = bench_send(b, "GET", PATH, none, NULL);
    assert_int_equal(same.status, 304);
    assert_int_equal(same.length, 0);
    bench_reply_free(&same);
    edit(b, "{\"op\":\"face_poke\",\"face\":0}");
    bench_reply other = bench_send(b, "GET", PATH, none, NULL);
    assert_int_equal(other.status, 200);
    assert_string_not_equal(bench_header(&other, "ETag"), etag);
    bench_reply_free(&other);
    bench_free(b);
}

static void a_wrong_type_parameter_or_mesh_is_refused(void **state)
{
    (void)state;
    pg_mesh pg;
    api_bench *b = specimen_begin("012", &pg);
    const char *const json[] = {"Accept", "application/json", NULL};
    bench_reply r = bench_send(b, "GET", PATH, json, NULL);
    assert_int_equal(r.status, 406);
    bench_reply_free(&r);
    static const char *const wrong[] = {"/v1/meshes/m/geometry?since=1", "/v1/meshes/m/geometry?x"};
    for (int i = 0; i < 2; i++) {
        r = bench_send(b, "GET", wrong[i], NULL, NULL);
        assert_int_equal(r.status, 400);
        bench_reply_free(&r);
    }
    r = bench_send(b, "GET", "/v1/meshes/gone/geometry", NULL, NULL);
    assert_int_equal(r.status, 404);
    bench_reply_free(&r);
    bench_free(b);
}

/* --- memory --- */

/* Each allocation fails in turn: the service must give the complete answer or a refusal. */
static void arrays_without_memory_are_complete_or_refused(void **state)
{
    (void)state;
    pg_mesh pg;
    api_bench *b = bench_new();
    /* The polygon is a concave star, which a fan of triangles from one corner would not fill
     * correctly. */
    pg_make(&pg, "01234567", 0);
    for (unsigned v = 0; v < 8; v++) {
        double radius = v % 2 == 0 ? 4 : 1, angle = v * acos(-1) / 4;
        pg.position[v][0] = radius * cos(angle);
        pg.position[v][1] = radius * sin(angle);
        pg.position[v][2] = 0;
    }
    specimen_put(b, &pg);
    arrays whole = fetch(b);
    unsigned refused = 0;
    failing f = {0};
    while (failing_next(&f)) {
        bench_reply r = {0};
        bool answered = bench_try(b, &(bench_request){"GET", PATH, NULL, NULL, 0}, &r);
        if (failing_end(&f, answered && r.status == 200)) {
            assert_int_equal(r.length, whole.reply.length);
            assert_memory_equal(r.body, whole.reply.body, r.length);
        } else {
            assert_true(!answered || r.status == 507 || r.status == 500);
            refused++;
        }
        if (answered) {
            bench_reply_free(&r);
        }
    }
    assert_true(refused > 3);
    bench_reply_free(&whole.reply);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_arrays_hold_all_positions_sides_and_areas_of_the_mesh),
        cmocka_unit_test(rows_of_vertices_keep_their_ids_when_others_are_deleted),
        cmocka_unit_test(an_undo_brings_back_the_same_rows),
        cmocka_unit_test(an_earlier_revision_is_sent_as_it_was),
        cmocka_unit_test(an_earlier_revision_has_a_tag_of_its_own),
        cmocka_unit_test(a_tag_holds_until_the_mesh_changes),
        cmocka_unit_test(a_wrong_type_parameter_or_mesh_is_refused),
        cmocka_unit_test(arrays_without_memory_are_complete_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
