/* The main uses of the API over a real connection: create a mesh, edit it, walk along it, query it,
 * undo edits, save it. Every route answers at least once. */
#include "tests/e2e/client.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static daemon_process *server;
static client *http;

static int start(void **state)
{
    (void)state;
    server = daemon_start(NULL);
    http = client_new(server);
    return 0;
}

static int stop(void **state)
{
    (void)state;
    client_free(http);
    return daemon_stop(server);
}

static void expect_counts(const reply *r, int vertices, int edges, int faces)
{
    assert_int_equal((int)reply_number(r, "counts.vertices"), vertices);
    assert_int_equal((int)reply_number(r, "counts.edges"), edges);
    assert_int_equal((int)reply_number(r, "counts.faces"), faces);
}

/* Creates a mesh; `path` becomes the path of the mesh in the API. */
static void create(const char *json, char path[128])
{
    reply r = reply_expect(201, client_post(http, "/v1/meshes", json));
    snprintf(path, 128, "/v1/meshes/%s", reply_string(&r, "id"));
    char location[128];
    assert_string_equal(reply_header(&r, "Location", location, sizeof location), path);
    reply_free(&r);
}

static const char *below(const char *path, const char *rest)
{
    static char text[512];
    snprintf(text, sizeof text, "%s%s", path, rest);
    return text;
}

static void a_mesh_is_created_edited_walked_undone_and_deleted(void **state)
{
    (void)state;
    char mesh[128];
    create("{\"name\":\"square\",\"vertices\":[[0,0,0],[1,0,0],[1,1,0],[0,1,0]],"
           "\"faces\":[[0,1,2],[0,2,3]]}",
           mesh);
    reply r = reply_expect(200, client_get(http, mesh));
    expect_counts(&r, 4, 5, 2);
    assert_string_equal(reply_string(&r, "name"), "square");
    assert_int_equal((int)reply_number(&r, "revision"), 1);
    assert_int_equal((int)reply_number(&r, "counts.boundary_loops"), 1);
    assert_true(reply_is_null(&r, "volume"));
    assert_true(reply_number(&r, "area") == 1);
    reply_free(&r);

    /* The square has the diagonal 2-0, edge 2; splitting this edge makes 4 triangles. */
    r = reply_expect(200, client_post(http, below(mesh, "/edits"),
                                      "{\"op\":\"edge_split\",\"edge\":2,\"t\":0.5}"));
    assert_int_equal((int)reply_number(&r, "revision"), 2);
    assert_int_equal((int)reply_number(&r, "results.0.vertex"), 4);
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "created.edges")), 3);
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "created.faces")), 2);
    reply_free(&r);
    r = reply_expect(200, client_get(http, mesh));
    expect_counts(&r, 5, 8, 4);
    reply_free(&r);

    r = reply_expect(200, client_get(http, below(mesh, "/vertices/4")));
    assert_int_equal((int)reply_number(&r, "degree"), 4);
    assert_true(reply_number(&r, "position.0") == 0.5);
    assert_true(cJSON_IsFalse(reply_find(&r, "boundary")));
    reply_free(&r);
    r = reply_expect(200, client_get(http, below(mesh, "/vertices/4/faces")));
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "ids")), 4);
    assert_string_equal(reply_string(&r, "relation"), "faces");
    reply_free(&r);

    /* Follows the `next` links around face 0, one request each. */
    r = reply_expect(200, client_get(http, below(mesh, "/faces/0")));
    int first = (int)reply_number(&r, "halfedge"), h = first, steps = 0;
    reply_free(&r);
    do {
        char path[64];
        snprintf(path, sizeof path, "/halfedges/%d", h);
        r = reply_expect(200, client_get(http, below(mesh, path)));
        assert_int_equal((int)reply_number(&r, "face"), 0);
        h = (int)reply_number(&r, "next");
        reply_free(&r);
    } while (h != first && ++steps < 10);
    assert_int_equal(steps, 2);

    r = reply_expect(200, client_post(http, below(mesh, "/undo"), NULL));
    assert_int_equal((int)reply_number(&r, "revision"), 3);
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "deleted.faces")), 2);
    reply_free(&r);
    r = reply_expect(200, client_get(http, mesh));
    expect_counts(&r, 4, 5, 2);
    reply_free(&r);
    reply_done(reply_expect(410, client_get(http, below(mesh, "/vertices/4"))));
    reply_done(reply_expect(404, client_get(http, below(mesh, "/vertices/5"))));
    reply_done(reply_expect(409, client_post(http, below(mesh, "/undo"), NULL)));
    r = reply_expect(200, client_post(http, below(mesh, "/redo"), NULL));
    assert_int_equal((int)reply_number(&r, "created.vertices.0"), 4);
    reply_free(&r);
    reply_done(reply_expect(409, client_post(http, below(mesh, "/redo"), "{}")));
    r = reply_expect(200, client_get(http, below(mesh, "/edits")));
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "entries")), 3);
    assert_int_equal((int)reply_number(&r, "undo"), 1);
    reply_free(&r);
    reply_done(reply_expect(204, client_send(http, "DELETE", mesh, NULL, NULL)));
    reply_done(reply_expect(404, client_get(http, mesh)));
}

static void a_list_of_edits_is_done_as_a_whole_or_not_at_all(void **state)
{
    (void)state;
    char mesh[128];
    create("{\"shape\":\"cube\",\"size\":2}", mesh);
    reply r = reply_expect(200, client_post(http, below(mesh, "/edits"),
                                            "{\"expected_revision\":1,\"ops\":["
                                            "{\"op\":\"face_poke\",\"face\":3,\"as\":\"a\"},"
                                            "{\"op\":\"vertex_move\",\"vertex\":\"$a.vertex\","
                                            "\"to\":[0,0,3]}]}"));
    assert_int_equal((int)reply_number(&r, "revision"), 2);
    int apex = (int)reply_number(&r, "results.0.vertex");
    reply_free(&r);
    char path[64];
    snprintf(path, sizeof path, "/vertices/%d", apex);
    r = reply_expect(200, client_get(http, below(mesh, path)));
    assert_true(reply_number(&r, "position.2") == 3);
    reply_free(&r);

    /* The second operation of the list is refused, so the first one must not have been done
     * either. */
    reply before = reply_expect(200, client_get(http, below(mesh, "/content")));
    r = reply_expect(422, client_post(http, below(mesh, "/edits"),
                                      "{\"ops\":[{\"op\":\"face_poke\",\"face\":0},"
                                      "{\"op\":\"edge_flip\",\"edge\":999}]}"));
    assert_string_equal(reply_string(&r, "code"), "no_such_element");
    assert_string_equal(reply_string(&r, "pointer"), "/ops/1");
    assert_string_equal(reply_string(&r, "element.kind"), "edge");
    assert_int_equal((int)reply_number(&r, "element.id"), 999);
    reply_free(&r);
    reply after = reply_expect(200, client_get(http, below(mesh, "/content")));
    assert_string_equal(before.body, after.body);
    reply_free(&before);
    reply_free(&after);

    r = reply_expect(412, client_post(http, below(mesh, "/edits"),
                                      "{\"expected_revision\":1,\"op\":\"face_poke\",\"face\":0}"));
    assert_int_equal((int)reply_number(&r, "revision"), 2);
    reply_free(&r);
    r = reply_expect(200, client_post(http, below(mesh, "/edits"),
                                      "{\"dry_run\":true,\"op\":\"face_poke\",\"face\":0}"));
    int promised = (int)reply_number(&r, "results.0.vertex");
    reply_free(&r);
    r = reply_expect(200, client_get(http, mesh));
    assert_int_equal((int)reply_number(&r, "revision"), 2);
    reply_free(&r);
    r = reply_expect(200,
                     client_post(http, below(mesh, "/edits"), "{\"op\":\"face_poke\",\"face\":0}"));
    assert_int_equal((int)reply_number(&r, "results.0.vertex"), promised);
    reply_free(&r);
    r = reply_expect(200, client_get(http, below(mesh, "/check")));
    assert_true(cJSON_IsTrue(reply_find(&r, "valid")));
    reply_free(&r);
}

static void expect_no_effect(const char *mesh, const char *edit)
{
    static const char *const kinds[] = {"vertices", "edges", "faces"};
    static const char *const sets[] = {"created", "deleted", "modified", "parents", "merged"};
    reply r = reply_expect(200, client_post(http, below(mesh, "/edits"), edit));
    assert_int_equal((int)reply_number(&r, "revision"), 1);
    for (size_t i = 0; i < 5; i++) {
        for (size_t j = 0; j < 3; j++) {
            const cJSON *set = reply_find(&r, sets[i]);
            assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(set, kinds[j])), 0);
        }
    }
    reply_free(&r);
    r = reply_expect(200, client_get(http, below(mesh, "/edits")));
    assert_int_equal((int)reply_number(&r, "revision"), 1);
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "entries")), 0);
    reply_free(&r);
    reply_done(reply_expect(409, client_post(http, below(mesh, "/undo"), NULL)));
}

static void edits_without_effect_make_no_revision(void **state)
{
    (void)state;
    char mesh[128];
    create("{\"shape\":\"tetrahedron\"}", mesh);
    /* Edits that have nothing to do: the plane misses the mesh, and no edge has to be flipped. */
    expect_no_effect(mesh, "{\"op\":\"plane_split\",\"point\":[0,0,9],\"normal\":[0,0,1]}");
    expect_no_effect(mesh, "{\"op\":\"delaunay\"}");
    expect_no_effect(mesh, "{\"ops\":[{\"op\":\"delaunay\"},{\"op\":\"plane_split\","
                           "\"point\":[0,0,-9],\"normal\":[1,1,1]}]}");
}

/* Checks the neighbours of elements of a sphere of triangles, in which each vertex from the twelfth
 * on has six neighbours. */
static void expect_adjacency(const char *mesh)
{
    static const struct {
        const char *path;
        int count;
    } rows[] = {
        {"/vertices/100/vertices", 6}, {"/vertices/100/outgoing", 6}, {"/vertices/100/incoming", 6},
        {"/vertices/100/edges", 6},    {"/vertices/100/faces", 6},    {"/halfedges/17/loop", 3},
        {"/halfedges/1000/loop", 3},   {"/edges/17/vertices", 2},     {"/edges/17/halfedges", 2},
        {"/edges/17/faces", 2},        {"/faces/17/vertices", 3},     {"/faces/17/halfedges", 3},
        {"/faces/17/edges", 3},        {"/faces/17/faces", 3},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        reply r = reply_expect(200, client_get(http, below(mesh, rows[i].path)));
        assert_int_equal(cJSON_GetArraySize(reply_find(&r, "ids")), rows[i].count);
        reply_free(&r);
    }
    static const char *const lists[] = {"/vertices?limit=3", "/edges?limit=3"};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        reply r = reply_expect(200, client_get(http, below(mesh, lists[i])));
        assert_int_equal(cJSON_GetArraySize(reply_find(&r, "items")), 3);
        reply_free(&r);
    }
}

static void exported_files_come_back_and_a_bad_line_is_named(void **state)
{
    (void)state;
    static const char obj[] = "# two triangles\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                              "f 1 2 3\nf 1 3 4\n";
    static const char *const type[] = {"Content-Type: model/obj", NULL};
    reply r = reply_expect(201, client_send(http, "POST", "/v1/meshes?name=file", type, obj));
    expect_counts(&r, 4, 5, 2);
    assert_string_equal(reply_string(&r, "import.format"), "obj");
    char mesh[128];
    snprintf(mesh, sizeof mesh, "/v1/meshes/%s", reply_string(&r, "id"));
    reply_free(&r);
    static const char *const formats[] = {"obj", "off", "json"};
    for (size_t i = 0; i < 3; i++) {
        char path[64];
        snprintf(path, sizeof path, "/content?format=%s", formats[i]);
        reply file = reply_expect(200, client_get(http, below(mesh, path)));
        static const char *const octets[] = {"Content-Type: application/octet-stream", NULL};
        reply again = reply_expect(
            201, client_send_bytes(http, &(client_request){"POST", "/v1/meshes", octets, file.body,
                                                           file.length}));
        expect_counts(&again, 4, 5, 2);
        assert_string_equal(reply_string(&again, "import.format"), formats[i]);
        reply_free(&file);
        reply_free(&again);
    }
    static const char bad[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n";
    r = reply_expect(422, client_send(http, "POST", "/v1/meshes", type, bad));
    assert_non_null(strstr(reply_string(&r, "detail"), "line 4"));
    reply_free(&r);
}

static void every_other_route_answers(void **state)
{
    (void)state;
    char mesh[128], value[256];
    create("{\"shape\":\"icosphere\",\"subdivisions\":3}", mesh);
    reply r = reply_expect(200, client_get(http, mesh));
    expect_counts(&r, 642, 1920, 1280);
    assert_true(reply_number(&r, "volume") > 4 && reply_number(&r, "volume") < 4.19);
    const char *tag = reply_header(&r, "ETag", value, sizeof value);
    char condition[300];
    snprintf(condition, sizeof condition, "If-None-Match: %s", tag);
    reply_done(reply_expect(
        304, client_send(http, "GET", mesh, (const char *const[]){condition, NULL}, NULL)));
    reply_free(&r);
    r = reply_expect(200, client_send(http, "HEAD", mesh, NULL, NULL));
    assert_int_equal(r.length, 0);
    reply_free(&r);
    r = reply_expect(200, client_get(http, "/v1/meshes?limit=2"));
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "items")), 2);
    char next[300];
    snprintf(next, sizeof next, "/v1/meshes?cursor=%s", reply_string(&r, "next"));
    reply_free(&r);
    reply_done(reply_expect(200, client_get(http, next)));

    static const char *const patch[] = {"Content-Type: application/merge-patch+json", NULL};
    r = reply_expect(200, client_send(http, "PATCH", mesh, patch, "{\"name\":\"ball\"}"));
    assert_string_equal(reply_string(&r, "name"), "ball");
    reply_free(&r);
    r = reply_expect(201, client_post(http, below(mesh, "/copy"), "{\"id\":\"twin-1\"}"));
    expect_counts(&r, 642, 1920, 1280);
    reply_free(&r);
    reply_done(reply_expect(409, client_post(http, below(mesh, "/copy"), "{\"id\":\"twin-1\"}")));

    const char *cube = "{\"shape\":\"cube\"}";
    r = reply_expect(200, client_send(http, "PUT", "/v1/meshes/twin-1", NULL, cube));
    expect_counts(&r, 8, 12, 6);
    reply_free(&r);
    static const char *const absent[] = {"If-None-Match: *", NULL};
    reply_done(reply_expect(412, client_send(http, "PUT", "/v1/meshes/twin-1", absent, cube)));
    reply_done(reply_expect(201, client_send(http, "PUT", "/v1/meshes/new", absent, cube)));

    expect_adjacency(mesh);
    r = reply_expect(200, client_get(http, below(mesh, "/faces?limit=100")));
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "items")), 100);
    reply_free(&r);
    static const char *const lines[] = {"Accept: application/x-ndjson", NULL};
    r = reply_expect(200, client_send(http, "GET", below(mesh, "/halfedges"), lines, NULL));
    assert_non_null(strstr(r.body, "{\"end\":true,\"count\":3840}"));
    reply_free(&r);
    reply_done(reply_expect(200, client_get(http, below(mesh, "/edges/17"))));
    r = reply_expect(200, client_get(http, below(mesh, "/halfedges/17/ring?cw=true")));
    assert_int_equal((int)reply_number(&r, "ids.0"), 17);
    reply_free(&r);
    r = reply_expect(200, client_post(http, below(mesh, "/traverse"),
                                      "{\"walk\":\"rings\",\"from\":{\"vertex\":5},\"depth\":2}"));
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "rings")), 3);
    reply_free(&r);
    r = reply_expect(200,
                     client_post(http, below(mesh, "/query"),
                                 "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"vertex\":5}},"
                                 "{\"get\":{\"edge\":3}},{\"find\":\"halfedge\","
                                 "\"vertices\":[0,1]}]}"));
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "results")), 3);
    reply_free(&r);
    r = reply_expect(200, client_get(http, below(mesh, "/boundaries")));
    assert_int_equal(cJSON_GetArraySize(reply_find(&r, "loops")), 0);
    reply_free(&r);
    r = reply_expect(200, client_get(http, below(mesh, "/components?by=edge")));
    assert_int_equal((int)reply_number(&r, "components.0.faces"), 1280);
    reply_free(&r);
    r = reply_expect(200, client_get(http, "/v1/operations"));
    assert_true(cJSON_GetArraySize(reply_find(&r, "operations")) >= 18);
    reply_free(&r);
    r = reply_expect(200, client_get(http, "/v1/openapi.json"));
    assert_string_equal(reply_string(&r, "openapi"), "3.1.0");
    reply_free(&r);
    reply_done(reply_expect(200, client_get(http, "/livez")));
    reply_done(reply_expect(200, client_get(http, "/readyz")));
    r = reply_expect(200, client_get(http, "/version"));
    assert_true(strlen(reply_string(&r, "version")) > 0);
    reply_free(&r);
    reply_done(reply_expect(200, client_get(http, "/")));
    /* a page of the manual, which only the daemon that is built with it has */
    r = client_get(http, "/problems/link_condition");
    assert_true(r.status == 200 || r.status == 303);
    assert_string_equal(reply_header(&r, "Location", value, sizeof value),
                        r.status == 303 ? "../docs/problems/link_condition" : "");
    reply_free(&r);
    reply_done(reply_expect(404, client_get(http, "/problems/none")));
    r = reply_expect(405, client_send(http, "DELETE", "/v1/meshes", NULL, NULL));
    assert_non_null(strstr(reply_header(&r, "Allow", value, sizeof value), "POST"));
    reply_free(&r);
    reply_done(reply_expect(404, client_get(http, "/nothing")));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_is_created_edited_walked_undone_and_deleted),
        cmocka_unit_test(a_list_of_edits_is_done_as_a_whole_or_not_at_all),
        cmocka_unit_test(edits_without_effect_make_no_revision),
        cmocka_unit_test(exported_files_come_back_and_a_bad_line_is_named),
        cmocka_unit_test(every_other_route_answers),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
