/* Operations that run once for each item of a list: one revision and one undo step, results as
 * columns, refusals that point to the item, and the same effect as the operations one by one. */
#include "tests/api/cubes.h"
#include "tests/slow_journal.h"

#include "api/json/text.h"
#include "api/limits.h"
#include "api/write/edit_cost.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char EDITS[] = "/v1/meshes/m/edits";

static const cJSON *results_of(const bench_reply *r)
{
    return cJSON_GetObjectItem(r->json, "results");
}

static int number_of(const bench_reply *r, const char *member)
{
    return cJSON_GetObjectItem(r->json, member)->valueint;
}

/* A list, and the same operations in a list of operations. */
static const struct {
    const char *list, *singles;
} pairs[] = {
    {"{\"op\":\"edge_split\",\"edges\":[0,5],\"t\":[0.5,0.25]}",
     "{\"op\":\"edge_split\",\"edge\":0,\"t\":0.5},{\"op\":\"edge_split\",\"edge\":5,\"t\":0.25}"},
    {"{\"op\":\"edge_split\",\"edges\":[3,1],\"t\":0.25}",
     "{\"op\":\"edge_split\",\"edge\":3,\"t\":0.25},{\"op\":\"edge_split\",\"edge\":1,\"t\":0.25}"},
    {"{\"op\":\"edge_bisect\",\"edges\":[7]}", "{\"op\":\"edge_bisect\",\"edge\":7}"},
    {"{\"op\":\"vertex_add\",\"positions\":[[0,0,3],[0,1,3],[1,1,3]]}",
     "{\"op\":\"vertex_add\",\"position\":[0,0,3]},{\"op\":\"vertex_add\",\"position\":[0,1,3]},"
     "{\"op\":\"vertex_add\",\"position\":[1,1,3]}"},
    {"{\"op\":\"face_poke\",\"faces\":[2,0],\"position\":[[0,0,1],[0,0,2]]}",
     "{\"op\":\"face_poke\",\"face\":2,\"position\":[0,0,1]},"
     "{\"op\":\"face_poke\",\"face\":0,\"position\":[0,0,2]}"},
    {"{\"op\":\"face_poke\",\"faces\":[2,0],\"position\":[0,0,1]}",
     "{\"op\":\"face_poke\",\"face\":2,\"position\":[0,0,1]},"
     "{\"op\":\"face_poke\",\"face\":0,\"position\":[0,0,1]}"},
    {"{\"op\":\"vertex_delete\",\"vertices\":[0,6],\"keep_isolated\":[true,false]}",
     "{\"op\":\"vertex_delete\",\"vertex\":0,\"keep_isolated\":true},"
     "{\"op\":\"vertex_delete\",\"vertex\":6,\"keep_isolated\":false}"},
};

static void a_list_equals_its_operations_one_by_one(void **state)
{
    (void)state;
    char singles[1000];
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        api_bench *b = cubes_begin();
        he_mesh *before = cubes_copy(b, "m");
        snprintf(singles, sizeof singles, "{\"ops\":[%s]}", pairs[i].singles);
        bench_reply list = bench_expect(200, bench_post(b, EDITS, pairs[i].list));
        bench_reply ones = bench_expect(200, bench_post(b, "/v1/meshes/n/edits", singles));
        he_mesh *after = cubes_copy(b, "m");
        cubes_expect(b, after, "n");
        assert_int_equal(number_of(&list, "revision"), 2);
        /* Each column holds the results of the single operations. */
        const cJSON *columns = cJSON_GetObjectItem(results_of(&list)->child, "each"), *column;
        assert_non_null(columns);
        cJSON_ArrayForEach(column, columns)
        {
            assert_int_equal(cJSON_GetArraySize(column), cJSON_GetArraySize(results_of(&ones)));
            for (int k = 0; k < cJSON_GetArraySize(column); k++) {
                const cJSON *one = cJSON_GetArrayItem(results_of(&ones), k);
                assert_true(cJSON_Compare(cJSON_GetArrayItem(column, k),
                                          cJSON_GetObjectItem(one, column->string), true));
            }
        }
        /* Both edits created, deleted and modified equal elements. */
        static const char *const sets[] = {"created", "deleted", "modified", "parents", "merged"};
        for (size_t k = 0; k < sizeof sets / sizeof *sets; k++) {
            assert_true(cJSON_Compare(cJSON_GetObjectItem(list.json, sets[k]),
                                      cJSON_GetObjectItem(ones.json, sets[k]), true));
        }
        bench_done(list);
        bench_done(ones);
        bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
        he_mesh *undone = cubes_copy(b, "m");
        assert_true(he_mesh_equal_live(before, undone));
        bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/redo", NULL)));
        cubes_expect(b, after, "m");
        he_mesh_free(before);
        he_mesh_free(after);
        he_mesh_free(undone);
        bench_free(b);
    }
}

static void a_refused_list_changes_nothing_and_points_to_its_item(void **state)
{
    (void)state;
    static const struct {
        const char *body;
        int status;
        const char *code, *pointer;
    } cases[] = {
        {"{\"op\":\"edge_split\",\"edges\":[0,1,2,99]}", 422, "no_such_element", "/edges/3"},
        {"{\"ops\":[{\"op\":\"edge_split\",\"edges\":[3,5]},"
         "{\"op\":\"edge_split\",\"edges\":[0,1,99,2]}]}",
         422, "no_such_element", "/ops/1/edges/2"},
        {"{\"ops\":[{\"op\":\"vertex_delete\",\"vertices\":[0,1]},"
         "{\"op\":\"vertex_delete\",\"vertices\":[2,1]}]}",
         422, "deleted_element", "/ops/1/vertices/1"},
        {"{\"op\":\"edge_split\",\"edges\":[0,1,2,1]}", 400, "repeated", "/edges/3"},
        {"{\"ops\":[{\"op\":\"face_poke\",\"faces\":[4,4]}]}", 400, "repeated", "/ops/0/faces/1"},
        {"{\"ops\":[{\"op\":\"face_poke\",\"face\":0,\"as\":\"a\"},"
         "{\"op\":\"face_poke\",\"faces\":[1,\"$a.faces.0\",6]}]}",
         400, "repeated", "/ops/1/faces/2"},
        {"{\"ops\":[{\"op\":\"face_poke\",\"face\":0,\"as\":\"a\"},"
         "{\"op\":\"face_poke\",\"faces\":[7,\"$a.faces\"]}]}",
         400, "repeated", "/ops/1/faces"},
        {"{\"op\":\"edge_split\",\"edges\":[0,1],\"t\":[0.5]}", 400, "bad_value", "/t"},
        {"{\"op\":\"edge_split\",\"edges\":[0,1],\"t\":[0.5,0.5,0.5]}", 400, "bad_value", "/t"},
        {"{\"op\":\"edge_split\",\"edges\":[0,1],\"t\":[0.5,1]}", 400, "bad_value", "/t/1"},
        {"{\"op\":\"edge_split\",\"edges\":[0,1],\"t\":[0.5,\"1\"]}", 400, "wrong_type", "/t/1"},
        {"{\"op\":\"edge_split\",\"edges\":[0,1],\"t\":[]}", 400, "bad_value", "/t"},
        {"{\"op\":\"edge_split\",\"edges\":[]}", 400, "bad_value", "/edges"},
        {"{\"op\":\"edge_split\",\"edges\":7}", 400, "wrong_type", "/edges"},
        {"{\"op\":\"edge_split\",\"edges\":[0,null]}", 400, "wrong_type", "/edges/1"},
        {"{\"op\":\"edge_split\",\"edge\":0,\"t\":[0.5]}", 400, "wrong_type", "/t"},
        {"{\"op\":\"edge_split\",\"edge\":0,\"edges\":[1]}", 400, "conflicting_members", "/edges"},
        {"{\"op\":\"edge_collapse\",\"halfedges\":[0],\"edges\":[5]}", 400, "conflicting_members",
         "/edges"},
        {"{\"op\":\"edge_collapse\",\"halfedges\":[0],\"edge\":5}", 400, "conflicting_members",
         "/edge"},
        {"{\"op\":\"edge_split\",\"t\":[0.5]}", 400, "wrong_type", "/t"},
        {"{\"op\":\"edge_split\"}", 400, "missing_member", ""},
        {"{\"op\":\"edge_weld\",\"a\":[0,1],\"b\":[2]}", 400, "bad_value", "/b"},
        {"{\"ops\":[{\"op\":\"face_delete\",\"face\":0},"
         "{\"op\":\"edge_weld\",\"a\":[0],\"b\":[99999]}]}",
         422, "no_such_element", "/ops/1/b/0"},
        {"{\"op\":\"edge_weld\",\"a\":[99999],\"b\":[4]}", 422, "no_such_element", "/a/0"},
        {"{\"op\":\"vertex_add\",\"positions\":[]}", 400, "bad_value", "/positions"},
        {"{\"op\":\"vertex_add\",\"positions\":[[0,0,0],[0,0]]}", 400, "bad_value", "/positions/1"},
        {"{\"op\":\"vertex_add\",\"positions\":[0,0,0]}", 400, "wrong_type", "/positions/0"},
        {"{\"op\":\"face_add\",\"faces\":[[0,1,2],7]}", 400, "wrong_type", "/faces/1"},
        {"{\"op\":\"face_add\",\"faces\":[[0,1,2],[]]}", 422, "interior_vertex", "/faces/0"},
        {"{\"op\":\"vertex_delete\",\"vertices\":[0],\"keep_isolated\":[1]}", 400, "wrong_type",
         "/keep_isolated/0"},
        {"{\"op\":\"face_poke\",\"faces\":{\"chosen\":true}}", 422, "no_such_attribute", "/faces"},
    };
    api_bench *b = cubes_begin();
    he_mesh *before = cubes_copy(b, "m");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bench_reply r = bench_post(b, EDITS, cases[i].body);
        if (r.status != cases[i].status || strcmp(bench_text(&r, "code"), cases[i].code) != 0 ||
            (cases[i].pointer[0] != '\0' &&
             strcmp(bench_text(&r, "pointer"), cases[i].pointer) != 0)) {
            fail_msg("%s: %s", cases[i].body, r.body);
        }
        bench_done(r);
        cubes_expect(b, before, "m");
    }
    he_mesh_free(before);
    bench_free(b);
}

static void the_lengths_of_a_column_and_its_list_are_named(void **state)
{
    (void)state;
    api_bench *b = cubes_begin();
    bench_reply r = bench_expect(
        400, bench_post(b, EDITS, "{\"op\":\"edge_split\",\"edges\":[0,1,2],\"t\":[0.5,0.5]}"));
    assert_string_equal(bench_text(&r, "detail"), "\"t\" has 2 values, but \"edges\" has 3: give "
                                                  "one value, or one for each");
    bench_done(r);
    bench_free(b);
}

static void alternatives_are_named_as_they_were_given(void **state)
{
    (void)state;
    api_bench *b = cubes_begin();
    bench_reply r = bench_expect(
        400, bench_post(b, EDITS, "{\"op\":\"edge_collapse\",\"edges\":[5],\"halfedges\":[0]}"));
    assert_string_equal(bench_text(&r, "detail"),
                        "give either \"halfedges\" or \"edges\", not both");
    bench_done(r);
    bench_free(b);
}

static void results_of_a_list_can_be_referred_to(void **state)
{
    (void)state;
    api_bench *b = cubes_begin();
    bench_reply r = bench_expect(
        200, bench_post(b, EDITS,
                        "{\"ops\":[{\"op\":\"vertex_add\",\"positions\":[[0,0,3],[0,1,3],[1,1,3]],"
                        "\"as\":\"v\"},{\"op\":\"face_add\",\"faces\":[[\"$v.vertex\"]],"
                        "\"as\":\"f\"},{\"op\":\"face_poke\",\"face\":\"$f.face.0\",\"as\":\"p\"},"
                        "{\"op\":\"face_join\",\"edges\":[\"$p.edges.0\"]},"
                        "{\"op\":\"edge_bisect\",\"edges\":[\"$f.edges\"]}]}"));
    assert_int_equal(cJSON_GetArraySize(results_of(&r)), 5);
    bench_done(r);
    r = bench_expect(
        422, bench_post(b, EDITS,
                        "{\"ops\":[{\"op\":\"vertex_add\",\"positions\":[[0,0,3]],\"as\":\"v\"},"
                        "{\"op\":\"vertex_delete\",\"vertex\":\"$v.vertex.1\"}]}"));
    assert_string_equal(bench_text(&r, "pointer"), "/ops/1/vertex");
    bench_done(r);
    r = bench_expect(
        400, bench_post(b, EDITS,
                        "{\"ops\":[{\"op\":\"vertex_add\",\"positions\":[[0,0,3]],\"as\":\"v\"},"
                        "{\"op\":\"vertex_delete\",\"vertex\":\"$v.vertex\"}]}"));
    assert_string_equal(bench_text(&r, "code"), "bad_reference");
    bench_done(r);
    bench_free(b);
}

/* A hole that is filled by one face has no new vertex. */
static void a_result_that_was_not_produced_is_no_id(void **state)
{
    (void)state;
    static const struct {
        const char *op, *pointer, *detail;
    } cases[] = {
        {"{\"op\":\"vertex_delete\",\"vertices\":[1,\"$x.vertex\"]}", "/ops/2/vertices/1",
         "\"$x.vertex\" stands for results that its operation did not all produce: item 0 is null"},
        {"{\"op\":\"vertex_delete\",\"vertices\":[1,\"$x.vertex.0\"]}", "/ops/2/vertices/1",
         "\"$x.vertex.0\" stands for a result that its operation did not produce"},
        {"{\"op\":\"face_add\",\"faces\":[[\"$x.vertex\",0,1]]}", "/ops/2/faces/0/0", NULL},
        {"{\"op\":\"face_add\",\"vertices\":[0,1,\"$x.vertex\"]}", "/ops/2/vertices/2", NULL},
        {"{\"op\":\"vertex_move\",\"vertices\":[\"$x.vertex\"],\"by\":[0,0,1]}",
         "/ops/2/vertices/0", NULL},
    };
    api_bench *b = cubes_begin();
    he_mesh *before = cubes_copy(b, "m");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char body[400];
        snprintf(body, sizeof body,
                 "{\"ops\":[{\"op\":\"face_delete\",\"face\":0},"
                 "{\"op\":\"hole_fill\",\"as\":\"x\",\"halfedges\":[0]},%s]}",
                 cases[i].op);
        bench_reply r = bench_expect(422, bench_post(b, EDITS, body));
        assert_string_equal(bench_text(&r, "code"), "no_such_element");
        assert_string_equal(bench_text(&r, "pointer"), cases[i].pointer);
        assert_string_equal(bench_text(&r, "detail"),
                            cases[i].detail != NULL ? cases[i].detail : cases[0].detail);
        bench_done(r);
        cubes_expect(b, before, "m");
    }
    he_mesh_free(before);
    bench_free(b);
}

static void a_set_may_be_the_list(void **state)
{
    (void)state;
    api_bench *b = cubes_begin();
    bench_done(bench_expect(
        200,
        bench_post(b, EDITS, "{\"op\":\"select\",\"by\":\"region\",\"faces\":[1],\"angle\":0.1}")));
    bench_done(bench_expect(
        200, bench_post(b, EDITS, "{\"op\":\"face_poke\",\"faces\":{\"selected\":true}}")));
    /* An empty set makes no runs and no revision. */
    bench_done(bench_expect(200, bench_post(b, EDITS,
                                            "{\"op\":\"face_poke\",\"faces\":{\"selected\":true},"
                                            "\"dry_run\":true}")));
    bench_free(b);
}

/* Writes a list of `count` splits of the edges of a torus, the last of which is `last`. */
static void write_splits(api_text *body, const char *before, size_t count, uint32_t last)
{
    api_text_empty(body);
    api_text_add_format(body, "{%s\"op\":\"edge_split\",\"edges\":[", before);
    for (size_t i = 0; i < count; i++) {
        api_text_add_format(body, "%s%zu", i > 0 ? "," : "", i + 1 == count ? (size_t)last : i);
    }
    api_text_add_string(body, "],\"t\":[");
    for (size_t i = 0; i < count; i++) {
        api_text_add_format(body, "%s0.%zu", i > 0 ? "," : "", i % 9 + 1);
    }
    api_text_add(body, "]}", sizeof "]}");
    assert_false(body->failed);
}

static void begin_torus(api_bench *b)
{
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m",
                                            "{\"shape\":\"torus\",\"major_segments\":100,"
                                            "\"minor_segments\":100}")));
}

/* 20,000 splits exceed what may be done while the mesh is locked, so the edit is started again on a
 * copy. */
static void a_long_list_is_one_revision_and_one_step(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    api_text body = {0};
    begin_torus(b);
    he_mesh *before = cubes_copy(b, "m");
    write_splits(&body, "\"dry_run\":true,", 20000, 19999);
    bench_reply dry = bench_expect(200, bench_post(b, EDITS, body.bytes));
    cubes_expect(b, before, "m");
    cJSON_DeleteItemFromObject(dry.json, "dry_run");
    write_splits(&body, "", 20000, 19999);
    bench_reply r = bench_expect(200, bench_post(b, EDITS, body.bytes));
    assert_true(cJSON_Compare(dry.json, r.json, true));
    const cJSON *each = cJSON_GetObjectItem(results_of(&r)->child, "each");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(each, "vertex")), 20000);
    assert_int_equal(number_of(&r, "revision"), 2);
    bench_done(dry);
    bench_done(r);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    he_mesh *undone = cubes_copy(b, "m");
    assert_true(he_mesh_equal_live(before, undone));
    he_mesh_free(undone);
    he_mesh_free(before);
    api_text_clear(&body);
    bench_free(b);
}

static void the_last_of_a_long_list_undoes_all_before_it(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    api_text body = {0};
    begin_torus(b);
    he_mesh *before = cubes_copy(b, "m");
    static const size_t counts[] = {100, 3000, 20000};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        char pointer[40];
        write_splits(&body, "", counts[i], 4000000);
        bench_reply r = bench_expect(422, bench_post(b, EDITS, body.bytes));
        snprintf(pointer, sizeof pointer, "/edges/%zu", counts[i] - 1);
        assert_string_equal(bench_text(&r, "pointer"), pointer);
        bench_done(r);
        write_splits(&body, "", counts[i], 7);
        r = bench_expect(400, bench_post(b, EDITS, body.bytes));
        assert_string_equal(bench_text(&r, "code"), "repeated");
        assert_string_equal(bench_text(&r, "pointer"), pointer);
        bench_done(r);
        cubes_expect(b, before, "m");
    }
    he_mesh_free(before);
    api_text_clear(&body);
    bench_free(b);
}

/* The history does not count what nobody read; everything else is as after a full answer. */
static void a_minimal_answer_to_a_long_list_leaves_an_equal_mesh(void **state)
{
    (void)state;
    static const char *const minimal[] = {"Prefer", "return=minimal", NULL};
    api_bench *b = bench_new();
    api_text body = {0};
    begin_torus(b);
    he_mesh *before = cubes_copy(b, "m");
    write_splits(&body, "", 20000, 19999);
    bench_done(bench_expect(204, bench_send(b, "POST", EDITS, minimal, body.bytes)));
    he_mesh *after = cubes_copy(b, "m");
    bench_reply r = bench_expect(200, bench_get(b, EDITS));
    const cJSON *entry = cJSON_GetObjectItem(r.json, "entries")->child;
    assert_string_equal(cJSON_GetObjectItem(entry, "ops")->child->valuestring, "edge_split");
    assert_null(cJSON_GetObjectItem(entry, "created"));
    bench_done(r);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    he_mesh *undone = cubes_copy(b, "m");
    assert_true(he_mesh_equal_live(before, undone));
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/redo", NULL)));
    cubes_expect(b, after, "m");
    write_splits(&body, "", 20000, 4000000);
    r = bench_expect(422, bench_send(b, "POST", EDITS, minimal, body.bytes));
    assert_string_equal(bench_text(&r, "pointer"), "/edges/19999");
    bench_done(r);
    cubes_expect(b, after, "m");
    he_mesh_free(undone);
    he_mesh_free(before);
    he_mesh_free(after);
    api_text_clear(&body);
    bench_free(b);
}

/* --- the cost of a list --- */

/* Makes a mesh of a polygon with a triangle at each of its edges. Edge 3 * i is an edge of the
 * polygon. */
static void begin_flower(api_bench *b, size_t corners)
{
    api_text body = {0};
    api_text_add_string(&body, "{\"vertices\":[");
    for (size_t i = 0; i < 2 * corners; i++) {
        const double half = i < corners ? 0 : 0.5, radius = i < corners ? 1 : 1.1;
        const double angle = 2 * acos(-1.0) * ((double)i + half) / (double)corners;
        api_text_add_format(&body, "%s[%.12f,%.12f,0]", i > 0 ? "," : "", radius * cos(angle),
                            radius * sin(angle));
    }
    api_text_add_string(&body, "],\"faces\":[");
    for (size_t i = 0; i < corners; i++) {
        api_text_add_format(&body, "[%zu,%zu,%zu],", (i + 1) % corners, i, corners + i);
    }
    for (size_t i = 0; i < corners; i++) {
        api_text_add_format(&body, "%s%zu", i > 0 ? "," : "[", i);
    }
    api_text_add(&body, "]]}", sizeof "]]}");
    assert_false(body.failed);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", body.bytes)));
    api_text_clear(&body);
}

/* Flipping an edge walks around its faces. For 8,000 edges of a polygon of 16,000 corners that is
 * too much to hold the mesh's lock, so the edit is started again as a job, on a copy. */
static void a_list_around_a_large_face_becomes_a_job(void **state)
{
    (void)state;
    enum { CORNERS = 16000 };
    api_bench *b = bench_new();
    api_text body = {0};
    begin_flower(b, CORNERS);
    he_mesh *before = cubes_copy(b, "m");
    api_text_add_string(&body, "{\"op\":\"edge_flip\",\"edges\":[");
    for (size_t i = 0; i < CORNERS; i += 2) {
        api_text_add_format(&body, "%s%zu", i > 0 ? "," : "", 3 * i);
    }
    api_text_add(&body, "]}", sizeof "]}");
    assert_false(body.failed);
    bench_reply job = bench_expect(202, bench_post(b, EDITS, body.bytes));
    cubes_expect(b, before, "m");
    bench_run_jobs(b, 1);
    bench_reply r = bench_expect(200, bench_get(b, bench_header(&job, "Location")));
    assert_string_equal(bench_text(&r, "state"), "done");
    bench_done(job);
    bench_done(r);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    he_mesh *undone = cubes_copy(b, "m");
    assert_true(he_mesh_equal_live(before, undone));
    he_mesh_free(undone);
    he_mesh_free(before);
    api_text_clear(&body);
    bench_free(b);
}

/* Makes a mesh of one polygon. */
static void begin_polygon(api_bench *b, size_t corners)
{
    api_text body = {0};
    api_text_add_string(&body, "{\"vertices\":[");
    for (size_t i = 0; i < corners; i++) {
        const double angle = 2 * acos(-1.0) * (double)i / (double)corners;
        api_text_add_format(&body, "%s[%.12f,%.12f,0]", i > 0 ? "," : "", cos(angle), sin(angle));
    }
    api_text_add_string(&body, "],\"faces\":[");
    for (size_t i = 0; i < corners; i++) {
        api_text_add_format(&body, "%s%zu", i > 0 ? "," : "[", i);
    }
    api_text_add(&body, "]]}", sizeof "]]}");
    assert_false(body.failed);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", body.bytes)));
    api_text_clear(&body);
}

/* Counts the copies of a mesh that are begun. */
typedef struct copies {
    const char *phase;
    size_t count;
} copies;

static bool count_copies(void *context, const char *phase, double done)
{
    copies *c = context;
    assert_true(done >= 0 && done <= 1);
    c->count += strcmp(phase, "copying") == 0 && (c->phase == NULL || strcmp(c->phase, phase) != 0);
    c->phase = phase;
    return true;
}

/* Cuts `count` triangles off a polygon by an operation on a list, of which each run gives the rest
 * of the polygon to the new face. Returns how often a mesh was copied. */
static size_t cut_off(api_bench *b, size_t count)
{
    static const char *const members[] = {"{\"op\":\"face_split\",\"faces\":[", "],\"from\":[",
                                          "],\"to\":["};
    api_text body = {0};
    copies c = {NULL, 0};
    for (size_t k = 0; k < 3; k++) {
        api_text_add_string(&body, members[k]);
        for (size_t i = 0; i < count; i++) {
            const size_t values[] = {i, 2 * i + 2, 2 * i};
            api_text_add_format(&body, "%s%zu", i > 0 ? "," : "", values[k]);
        }
    }
    api_text_add_string(&body, "]}");
    assert_false(body.failed);
    const api_request request = {.method = "POST",
                                 .path = EDITS,
                                 .query = "",
                                 .request_id = "test",
                                 .headers = {[API_HEADER_CONTENT_TYPE] = "application/json"},
                                 .has_length = true,
                                 .length = body.length,
                                 .has_body = true};
    api_step step;
    size_t used = 0;
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    assert_non_null(x);
    for (size_t at = 0; step == API_MORE && at < body.length; at += used) {
        step = api_body(x, body.bytes + at, body.length - at, &used);
    }
    api_set_progress(x, count_copies, &c);
    step = step == API_MORE ? api_end(x) : step;
    while (step == API_WORK) {
        step = api_work(x);
    }
    assert_int_equal(step, API_READY);
    assert_int_equal(api_answer_of(x)->status, 200);
    api_free(x);
    api_text_clear(&body);
    return c.count;
}

/* Each cut changes all half-edges of a polygon of 20,000 corners. Three cuts may be done while the
 * mesh is locked. 20 change too many rows for that, so the edit is started again on a copy. */
static void few_runs_with_many_rows_work_on_a_copy(void **state)
{
    (void)state;
    static const size_t counts[] = {3, 20};
    for (size_t i = 0; i < 2; i++) {
        slow_journal journal;
        const st_journal kept = slow_journal_open_keeping(&journal);
        api_bench *b = bench_new_over(&kept);
        slow_journal_advance(&journal, UINT64_MAX);
        begin_polygon(b, 20000);
        he_mesh *before = cubes_copy(b, "m");
        assert_int_equal(cut_off(b, counts[i]), i);
        bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
        he_mesh *undone = cubes_copy(b, "m");
        assert_true(he_mesh_equal_live(before, undone));
        he_mesh_free(undone);
        he_mesh_free(before);
        bench_free(b);
    }
}

/* A value that is the same in all runs takes as many steps as a column of this value. */
static void one_value_costs_as_much_as_its_column(void **state)
{
    (void)state;
    static const uint32_t a[] = {0, 1, 2, 3}, same[] = {5, 5, 5, 5};
    const uint64_t most = UINT64_MAX / 2;
    api_bench *b = cubes_begin();
    he_mesh *mesh = cubes_copy(b, "m");
    api_hubs hubs = {.slots = {{0}}};
    api_call call = {.op = he_op_find("edge_weld", strlen("edge_weld"))};
    he_op_defaults(call.op, call.args);
    call.args[0] = (he_arg){.given = true, .list = true, .ids = a, .count = 4};
    call.args[1] = (he_arg){.given = true, .id = 5};
    const uint64_t one = api_edit_cost_steps(&call, mesh, most, &hubs);
    call.args[1] = (he_arg){.given = true, .list = true, .ids = same, .count = 4};
    assert_int_equal(one, api_edit_cost_steps(&call, mesh, most, &hubs));
    assert_true(api_edit_cost_steps(&call, mesh, 3, &hubs) > 3);
    call.args[1] = (he_arg){.given = true, .id = 5};
    assert_true(api_edit_cost_steps(&call, mesh, one - 1, &hubs) > one - 1);
    he_mesh_free(mesh);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_list_equals_its_operations_one_by_one),
        cmocka_unit_test(a_refused_list_changes_nothing_and_points_to_its_item),
        cmocka_unit_test(the_lengths_of_a_column_and_its_list_are_named),
        cmocka_unit_test(alternatives_are_named_as_they_were_given),
        cmocka_unit_test(results_of_a_list_can_be_referred_to),
        cmocka_unit_test(a_result_that_was_not_produced_is_no_id),
        cmocka_unit_test(a_set_may_be_the_list),
        cmocka_unit_test(a_long_list_is_one_revision_and_one_step),
        cmocka_unit_test(a_minimal_answer_to_a_long_list_leaves_an_equal_mesh),
        cmocka_unit_test(the_last_of_a_long_list_undoes_all_before_it),
        cmocka_unit_test(a_list_around_a_large_face_becomes_a_job),
        cmocka_unit_test(few_runs_with_many_rows_work_on_a_copy),
        cmocka_unit_test(one_value_costs_as_much_as_its_column),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
