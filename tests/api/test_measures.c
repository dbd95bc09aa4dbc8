/* The questions of POST .../query about measures, rays, nearest points and self-intersections. */
#include "tests/api/specimens.h"

static const double PI = 3.14159265358979323846;

static const char QUERY[] = "/v1/meshes/m/query";

/* Creates the mesh "m". */
static void put(api_bench *b, const char *body)
{
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, body);
    assert_true(r.status == 201 || r.status == 200);
    bench_reply_free(&r);
}

/* Returns the answer to one question, which is freed together with the reply `r`. */
static const cJSON *ask(api_bench *b, const char *question, bench_reply *r)
{
    char body[2048];
    snprintf(body, sizeof body, "{\"queries\":[%s]}", question);
    *r = bench_send(b, "POST", QUERY, NULL, body);
    assert_int_equal(r->status, 200);
    return cJSON_GetArrayItem(cJSON_GetObjectItem(r->json, "results"), 0);
}

static const cJSON *in(const cJSON *object, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, name);
    assert_non_null(value);
    return value;
}

static void expect_answer(api_bench *b, const char *question, const char *wanted)
{
    bench_reply r;
    char *text = cJSON_PrintUnformatted(ask(b, question, &r));
    assert_string_equal(text, wanted);
    cJSON_free(text);
    bench_reply_free(&r);
}

/* --- measures --- */

static void each_measure_of_a_cube(void **state)
{
    (void)state;
    static const struct {
        const char *kind, *plural, *measure;
        double value;
    } rows[] = {
        {"edge", "edges", "length", 2},
        {"edge", "edges", "dihedral", 1.5707963267948966},
        {"edge", "edges", "cotangent", 1},
        {"halfedge", "halfedges", "angle", 1.5707963267948966},
        {"face", "faces", "area", 4},
        {"face", "faces", "degree", 4},
        {"face", "faces", "smallest_angle", 1.5707963267948966},
        {"vertex", "vertices", "angle_defect", 1.5707963267948966},
        {"vertex", "vertices", "degree", 3},
    };
    api_bench *b = bench_new();
    put(b, "{\"shape\":\"cube\",\"size\":2}");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char question[256];
        bench_reply r;
        snprintf(question, sizeof question, "{\"measure\":\"%s\",\"of\":{\"%s\":3}}",
                 rows[i].measure, rows[i].kind);
        const cJSON *one = ask(b, question, &r);
        assert_string_equal(in(one, "measure")->valuestring, rows[i].measure);
        assert_int_equal(in(in(one, "of"), rows[i].kind)->valueint, 3);
        assert_true(fabs(in(one, "value")->valuedouble - rows[i].value) < 1e-12);
        bench_reply_free(&r);
        snprintf(question, sizeof question, "{\"measure\":\"%s\",\"of\":{\"%s\":\"all\"}}",
                 rows[i].measure, rows[i].plural);
        const cJSON *all = ask(b, question, &r);
        assert_int_equal(in(all, "components")->valueint, 1);
        int count = 0;
        for (const cJSON *v = in(all, "values")->child; v != NULL; v = v->next, count++) {
            assert_true(fabs(v->valuedouble - rows[i].value) < 1e-12);
        }
        assert_int_equal(count, i < 3 ? 12 : i == 3 ? 24 : i < 7 ? 6 : 8);
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void vectors_have_three_components(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, "{\"vertices\":[[0,0,0],[2,0,0],[2,2,0],[0,2,0]],\"faces\":[[0,1,2,3]]}");
    expect_answer(b, "{\"measure\":\"normal\",\"of\":{\"faces\":[0,0]}}",
                  "{\"measure\":\"normal\",\"components\":3,\"values\":[[0,0,1],[0,0,1]]}");
    expect_answer(
        b, "{\"measure\":\"centroid\",\"of\":{\"face\":0}}",
        "{\"revision\":1,\"of\":{\"face\":0},\"measure\":\"centroid\",\"value\":[1,1,0]}");
    expect_answer(b,
                  "{\"measure\":\"normal\",\"of\":{\"vertices\":\"all\"},\"weights\":\"uniform\"}",
                  "{\"measure\":\"normal\",\"components\":3,\"elements\":[0,1,2,3],"
                  "\"values\":[[0,0,1],[0,0,1],[0,0,1],[0,0,1]]}");
    /* Half-edge 1 is on the boundary, so it is not the corner of a face and has the normal 0. */
    expect_answer(b, "{\"measure\":\"normal\",\"of\":{\"halfedges\":[0,1]},\"crease\":0}",
                  "{\"measure\":\"normal\",\"components\":3,\"values\":[[0,0,1],[0,0,0]]}");
    expect_answer(b, "{\"measure\":\"area\",\"of\":{\"faces\":[]}}",
                  "{\"measure\":\"area\",\"components\":1,\"values\":[]}");
    bench_free(b);
}

static void what_has_no_value_is_null(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, "{\"vertices\":[[0,0,0],[1,0,0],[2,0,0],[5,5,5]],\"faces\":[[0,1,2]]}");
    expect_answer(b, "{\"measure\":\"dihedral\",\"of\":{\"edges\":\"all\"}}",
                  "{\"measure\":\"dihedral\",\"components\":1,\"elements\":[0,1,2],"
                  "\"values\":[null,null,null]}");
    expect_answer(b, "{\"measure\":\"cotangent\",\"of\":{\"edge\":0}}",
                  "{\"revision\":1,\"of\":{\"edge\":0},\"measure\":\"cotangent\",\"value\":null}");
    expect_answer(b, "{\"measure\":\"mean_curvature\",\"of\":{\"vertices\":[0,3]}}",
                  "{\"measure\":\"mean_curvature\",\"components\":1,\"values\":[null,null]}");
    expect_answer(
        b, "{\"measure\":\"angle_defect\",\"of\":{\"vertex\":3}}",
        "{\"revision\":1,\"of\":{\"vertex\":3},\"measure\":\"angle_defect\",\"value\":null}");
    expect_answer(b, "{\"measure\":\"normal\",\"of\":{\"face\":0}}",
                  "{\"revision\":1,\"of\":{\"face\":0},\"measure\":\"normal\",\"value\":[0,0,0]}");
    bench_free(b);
}

static double octet_double(const char *bytes)
{
    uint64_t bits = 0;
    double value;
    for (int k = 7; k >= 0; k--) {
        bits = bits << 8 | (unsigned char)bytes[k];
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t octet_word(const char *bytes)
{
    const unsigned char *p = (const unsigned char *)bytes;
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static void octets_are_doubles_and_null_is_nan(void **state)
{
    (void)state;
    static const char *const octets[] = {"Accept", "application/octet-stream", NULL};
    api_bench *b = bench_new();
    put(b, "{\"shape\":\"grid\",\"columns\":2,\"rows\":2}");
    bench_reply r = bench_send(b, "POST", QUERY, octets,
                               "{\"queries\":[{\"measure\":\"gaussian_curvature\","
                               "\"of\":{\"vertices\":\"all\"}}]}");
    assert_int_equal(r.status, 200);
    assert_int_equal(r.length, 9 * 8 + 9 * 4 + 4);
    for (uint32_t i = 0; i < 9; i++) {
        assert_int_equal(octet_word(r.body + 9 * 8 + (size_t)4 * i), i);
    }
    assert_int_equal(octet_word(r.body + 9 * 8 + 9 * 4), 9);
    int numbers = 0;
    for (size_t i = 0; i < 9; i++) {
        double value = octet_double(r.body + 8 * i);
        numbers += !isnan(value);
        assert_true(isnan(value) || fabs(value) < 1e-12);
    }
    /* only one vertex is not on the boundary and so has a curvature; the value of each other vertex
     * is NaN */
    assert_int_equal(numbers, 1);
    bench_reply_free(&r);
    r = bench_send(b, "POST", QUERY, octets,
                   "{\"queries\":[{\"measure\":\"normal\",\"of\":{\"faces\":[0,3]}}]}");
    assert_int_equal(r.length, 2 * 3 * 8);
    for (size_t i = 0; i < 6; i++) {
        assert_true(octet_double(r.body + 8 * i) == (i % 3 == 2 ? 1 : 0));
    }
    bench_reply_free(&r);
    bench_free(b);
}

static void defects_of_a_sphere_sum_to_two_pi_euler(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, "{\"shape\":\"icosphere\",\"subdivisions\":3}");
    bench_reply r;
    double sum = 0;
    const cJSON *all = ask(b, "{\"measure\":\"angle_defect\",\"of\":{\"vertices\":\"all\"}}", &r);
    for (const cJSON *v = in(all, "values")->child; v != NULL; v = v->next) {
        sum += v->valuedouble;
    }
    assert_true(fabs(sum - 4 * PI) < 1e-9);
    bench_reply_free(&r);
    bench_free(b);
}

static void quality_and_degree_differ_between_elements(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    /* A right triangle with two sides of length 1, a quad beside it, and an isolated vertex. */
    put(b, "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0],[-1,1,0],[-1,0,0],[9,9,9]],"
           "\"faces\":[[0,1,2],[0,2,3,4]]}");
    expect_answer(b, "{\"measure\":\"degree\",\"of\":{\"vertices\":\"all\"}}",
                  "{\"measure\":\"degree\",\"components\":1,\"elements\":[0,1,2,3,4,5],"
                  "\"values\":[3,2,3,2,2,0]}");
    expect_answer(b, "{\"measure\":\"degree\",\"of\":{\"faces\":\"all\"}}",
                  "{\"measure\":\"degree\",\"components\":1,\"elements\":[0,1],\"values\":[3,4]}");
    bench_reply r;
    const cJSON *both = ask(b, "{\"measure\":\"smallest_angle\",\"of\":{\"faces\":\"all\"}}", &r);
    const cJSON *values = in(both, "values");
    assert_true(fabs(cJSON_GetArrayItem(values, 0)->valuedouble - PI / 4) < 1e-12);
    assert_true(fabs(cJSON_GetArrayItem(values, 1)->valuedouble - PI / 2) < 1e-12);
    bench_reply_free(&r);
    bench_free(b);
}

/* --- space --- */

static void rays_hit_once_and_name_where(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, "{\"vertices\":[[0,0,0],[2,0,0],[2,2,0],[0,2,0]],\"faces\":[[0,1,2],[0,2,3]]}");
    expect_answer(b, "{\"ray\":{\"origin\":[1.5,0.5,3],\"direction\":[0,0,-9]}}",
                  "{\"hit\":{\"face\":0,\"distance\":3,\"point\":[1.5,0.5,0],\"barycentric\":["
                  "{\"vertex\":0,\"weight\":0.25},{\"vertex\":1,\"weight\":0.5},"
                  "{\"vertex\":2,\"weight\":0.25}]}}");
    expect_answer(b, "{\"ray\":{\"origin\":[1,1,-3],\"direction\":[0,0,1e-300]}}",
                  "{\"hit\":{\"face\":0,\"distance\":3,\"point\":[1,1,0],\"barycentric\":["
                  "{\"vertex\":0,\"weight\":0.5},{\"vertex\":2,\"weight\":0.5}]}}");
    expect_answer(b, "{\"ray\":{\"origin\":[2,2,0],\"direction\":[0,0,1]}}",
                  "{\"hit\":{\"face\":0,\"distance\":0,\"point\":[2,2,0],\"barycentric\":["
                  "{\"vertex\":2,\"weight\":1}]}}");
    expect_answer(b, "{\"ray\":{\"origin\":[1,1,3],\"direction\":[0,0,1]}}", "{\"hit\":null}");
    expect_answer(b, "{\"ray\":{\"origin\":[1,1,3],\"direction\":[0,0,-1],\"max\":2.5}}",
                  "{\"hit\":null}");
    expect_answer(b, "{\"closest\":[3,2,0]}",
                  "{\"closest\":{\"face\":0,\"distance\":1,\"point\":[2,2,0],\"barycentric\":["
                  "{\"vertex\":2,\"weight\":1}]}}");
    expect_answer(b, "{\"closest\":[3,2,0],\"max\":0.5}", "{\"closest\":null}");
    expect_answer(b, "{\"self_intersections\":{}}", "{\"pairs\":[],\"total\":0,\"complete\":true}");
    bench_free(b);
}

static void an_empty_mesh_is_nowhere(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, "{\"vertices\":[[1,2,3]],\"faces\":[]}");
    expect_answer(b, "{\"ray\":{\"origin\":[0,0,0],\"direction\":[1,2,3]}}", "{\"hit\":null}");
    expect_answer(b, "{\"closest\":[1,2,3]}", "{\"closest\":null}");
    expect_answer(b, "{\"self_intersections\":{}}", "{\"pairs\":[],\"total\":0,\"complete\":true}");
    bench_free(b);
}

static void a_mesh_that_changes_is_asked_anew(void **state)
{
    (void)state;
    static const char ray[] = "{\"ray\":{\"origin\":[1,0.5,9],\"direction\":[0,0,-1]}}";
    api_bench *b = bench_new();
    bench_reply r;
    put(b, "{\"vertices\":[[0,0,0],[2,0,0],[2,2,0]],\"faces\":[[0,1,2]]}");
    assert_true(in(in(ask(b, ray, &r), "hit"), "distance")->valuedouble == 9);
    bench_reply_free(&r);
    for (int z = 1; z < 4; z++) {
        char body[128];
        snprintf(body, sizeof body,
                 "{\"op\":\"transform\",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,1,0,0,0,1]}");
        r = bench_send(b, "POST", "/v1/meshes/m/edits", NULL, body);
        assert_int_equal(r.status, 200);
        bench_reply_free(&r);
        assert_true(in(in(ask(b, ray, &r), "hit"), "distance")->valuedouble == 9 - z);
        bench_reply_free(&r);
    }
    r = bench_send(b, "POST", "/v1/meshes/m/undo", NULL, NULL);
    assert_int_equal(r.status, 200);
    bench_reply_free(&r);
    assert_true(in(in(ask(b, ray, &r), "hit"), "distance")->valuedouble == 7);
    bench_reply_free(&r);
    put(b, "{\"vertices\":[],\"faces\":[]}");
    expect_answer(b, ray, "{\"hit\":null}");
    bench_free(b);
}

static void faces_that_meet_are_listed_up_to_a_limit(void **state)
{
    (void)state;
    /* The mesh has three triangles that intersect each other. */
    static const char star[] = "{\"vertices\":[[-2,-1,0],[2,-1,0],[0,2,0],[0,-2,-1],[0,2,-1],"
                               "[0,0,2],[-1,0,-2],[-1,0,2],[2,0,0]],"
                               "\"faces\":[[0,1,2],[3,4,5],[6,7,8]]}";
    api_bench *b = bench_new();
    put(b, star);
    expect_answer(b, "{\"self_intersections\":{}}",
                  "{\"pairs\":[[0,1],[0,2],[1,2]],\"total\":3,\"complete\":true}");
    expect_answer(b, "{\"self_intersections\":{\"limit\":1}}",
                  "{\"pairs\":[[0,1]],\"total\":3,\"complete\":true}");
    expect_answer(b, "{\"self_intersections\":{\"limit\":0}}",
                  "{\"pairs\":[],\"total\":3,\"complete\":true}");
    bench_free(b);
}

/* Three thousand triangles lie at one position, so a question about that position has to visit all
 * of them. The visits for all questions of a request count toward one budget, but the first
 * question is always answered. */
static void crowded_places_have_a_budget(void **state)
{
    (void)state;
    enum { CROWD = 3000, CROWD_TEXT = CROWD * 64 };
    char *text = malloc(CROWD_TEXT);
    assert_non_null(text);
    size_t used = (size_t)snprintf(text, CROWD_TEXT, "{\"vertices\":[");
    for (int i = 0; i < CROWD; i++) {
        used += (size_t)snprintf(text + used, CROWD_TEXT - used, "%s[0,0,0],[1,0,0],[0,1,0]",
                                 i == 0 ? "" : ",");
    }
    used += (size_t)snprintf(text + used, CROWD_TEXT - used, "],\"faces\":[");
    for (int i = 0; i < CROWD; i++) {
        used += (size_t)snprintf(text + used, CROWD_TEXT - used, "%s[%d,%d,%d]", i == 0 ? "" : ",",
                                 3 * i, 3 * i + 1, 3 * i + 2);
    }
    snprintf(text + used, CROWD_TEXT - used, "]}");
    api_bench *b = bench_new();
    put(b, text);
    free(text);
    bench_reply r;
    const cJSON *found = ask(b, "{\"self_intersections\":{\"limit\":2}}", &r);
    assert_int_equal(cJSON_GetArraySize(in(found, "pairs")), 2);
    assert_true(in(found, "total")->valuedouble >= 1 << 20);
    assert_true(cJSON_IsFalse(in(found, "complete")));
    bench_reply_free(&r);
    /* The number of nearest-point questions; each of them visits two or three thousand bounding
     * boxes. */
    enum { RAYS = 9000, RAYS_TEXT = RAYS * 64 };
    char *rays = malloc(RAYS_TEXT);
    assert_non_null(rays);
    used = (size_t)snprintf(rays, RAYS_TEXT, "{\"queries\":[");
    for (int i = 0; i < RAYS; i++) {
        used += (size_t)snprintf(rays + used, RAYS_TEXT - used, "%s{\"closest\":[0.1,0.1,%d]}",
                                 i == 0 ? "" : ",", i);
    }
    snprintf(rays + used, RAYS_TEXT - used, "]}");
    r = bench_send(b, "POST", QUERY, NULL, rays);
    free(rays);
    assert_int_equal(r.status, 200);
    int answered = 0, refused = 0;
    for (const cJSON *a = in(r.json, "results")->child; a != NULL; a = a->next) {
        const cJSON *code = cJSON_GetObjectItemCaseSensitive(a, "code");
        answered += code == NULL;
        refused += code != NULL && strcmp(code->valuestring, "limit_exceeded") == 0;
    }
    assert_int_equal(answered + refused, RAYS);
    assert_true(answered > 1000 && refused > 1000);
    bench_reply_free(&r);
    bench_free(b);
}

/* --- isolated vertices far away --- */

/* Returns the answer to a request about a cube and an isolated vertex at the distance `far`. If
 * `far` is 0, the vertex is at the origin, which is inside the cube and on no face. */
static bench_reply ask_cube(api_bench *b, double far, const char *method, const char *target,
                            const char *body)
{
    char vertex[200];
    bench_done(bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL));
    put(b, "{\"shape\":\"cube\",\"size\":2}");
    snprintf(vertex, sizeof vertex, "{\"op\":\"vertex_add\",\"position\":[%.17g,%.17g,0]}", far,
             -far);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/edits", vertex)));
    return bench_expect(200, bench_send(b, method, target, NULL, body));
}

static void a_far_isolated_vertex_changes_no_answer(void **state)
{
    (void)state;
    static const struct {
        const char *method, *what, *body, *members[8];
    } rows[] = {
        {"GET", "", NULL, {"area", "volume", "closed"}},
        {"GET", "/check", NULL, {"defects", "totals", "thresholds"}},
        {"POST",
         "/query",
         "{\"queries\":[{\"ray\":{\"origin\":[0.25,0.5,5],\"direction\":[0,0,-1]}},"
         "{\"closest\":[0.25,-3,0.5]},"
         "{\"measure\":\"normal\",\"of\":{\"vertex\":0}}]}",
         {"results"}},
        {"POST",
         "/edits",
         "{\"op\":\"plane_split\",\"point\":[0.1,0,0],\"normal\":[1,0,0]}",
         {"results", "created", "deleted"}},
    };
    static const double far_away[] = {1e60, 1e81, 1e108, -1e200, 1e308};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char target[100];
        snprintf(target, sizeof target, "/v1/meshes/m%s", rows[i].what);
        api_bench *b = bench_new();
        bench_reply near = ask_cube(b, 0, rows[i].method, target, rows[i].body);
        for (size_t k = 0; k < sizeof far_away / sizeof *far_away; k++) {
            bench_reply far = ask_cube(b, far_away[k], rows[i].method, target, rows[i].body);
            for (const char *const *name = rows[i].members; *name != NULL; name++) {
                char *wanted = cJSON_PrintUnformatted(in(near.json, *name));
                char *got = cJSON_PrintUnformatted(in(far.json, *name));
                assert_string_equal(got, wanted);
                cJSON_free(wanted);
                cJSON_free(got);
            }
            bench_reply_free(&far);
        }
        bench_reply_free(&near);
        bench_free(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_measure_of_a_cube),
        cmocka_unit_test(vectors_have_three_components),
        cmocka_unit_test(what_has_no_value_is_null),
        cmocka_unit_test(octets_are_doubles_and_null_is_nan),
        cmocka_unit_test(defects_of_a_sphere_sum_to_two_pi_euler),
        cmocka_unit_test(quality_and_degree_differ_between_elements),
        cmocka_unit_test(rays_hit_once_and_name_where),
        cmocka_unit_test(an_empty_mesh_is_nowhere),
        cmocka_unit_test(a_mesh_that_changes_is_asked_anew),
        cmocka_unit_test(faces_that_meet_are_listed_up_to_a_limit),
        cmocka_unit_test(crowded_places_have_a_budget),
        cmocka_unit_test(a_far_isolated_vertex_changes_no_answer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
