/* Writing attributes: to sets of elements instead of lists of ids, whether a write makes a
 * revision, undo of large writes, and the maximum number of attributes. */
#include "tests/api/strip.h"

#include "api/json/text.h"
#include "api/limits.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static uint64_t revision_of(api_bench *b)
{
    bench_reply r = bench_expect(200, bench_send(b, "GET", "/v1/meshes/m", NULL, NULL));
    uint64_t revision = (uint64_t)cJSON_GetObjectItem(r.json, "revision")->valuedouble;
    bench_reply_free(&r);
    return revision;
}

static void sets_stand_for_lists(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    strip_send(b, 201, "POST", "/v1/meshes?id=m", "{\"shape\":\"cube\"}");
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/faces/selected", "{\"type\":\"bool\"}");
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/faces/kind", "{\"type\":\"int32\"}");
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/vertices/selected",
               "{\"type\":\"bool\",\"default\":true}");
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/vertices/none", "{\"type\":\"bool\"}");
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/edges/none", "{\"type\":\"bool\"}");
    uint64_t before = revision_of(b);
    static const char *const nothing[] = {
        "{\"op\":\"transform\",\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1],"
        "\"vertices\":{\"none\":true}}",
        "{\"op\":\"vertex_move\",\"by\":[1,1,1],\"vertices\":{\"none\":true}}",
        "{\"op\":\"delaunay\",\"edges\":{\"none\":true}}",
        "{\"op\":\"face_delete\",\"faces\":{\"selected\":true}}",
        "{\"op\":\"face_triangulate\",\"faces\":{\"selected\":true}}",
        "{\"op\":\"plane_split\",\"point\":[0,0,0],\"normal\":[1,0,0],\"faces\":{\"selected\":true}"
        "}",
        "{\"ops\":[{\"op\":\"face_triangulate\",\"faces\":{\"selected\":true},\"as\":\"a\"}]}",
    };
    for (size_t i = 0; i < sizeof nothing / sizeof *nothing; i++) {
        strip_send(b, 200, "POST", "/v1/meshes/m/edits", nothing[i]);
        assert_int_equal(revision_of(b), before);
    }
    strip_send(b, 422, "POST", "/v1/meshes/m/edits",
               "{\"op\":\"face_delete\",\"faces\":{\"none\":true}}");
    strip_send(b, 400, "POST", "/v1/meshes/m/edits",
               "{\"op\":\"face_delete\",\"faces\":{\"kind\":true}}");
    strip_send(b, 200, "POST", "/v1/meshes/m/edits",
               "{\"op\":\"transform\",\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1],"
               "\"vertices\":{\"selected\":true}}");
    strip_send(b, 200, "PATCH", "/v1/meshes/m/attributes/faces/selected",
               "{\"ids\":[0,2,5],\"value\":true}");
    strip_send(b, 200, "PATCH", "/v1/meshes/m/attributes/faces/kind",
               "{\"ids\":{\"selected\":true},\"values\":[4,5,6]}");
    bench_reply r = bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/edits", NULL,
                                                 "{\"op\":\"face_triangulate\","
                                                 "\"faces\":{\"selected\":true}}"));
    assert_non_null(strstr(r.body, "\"faces\":[6,7,8]"));
    bench_reply_free(&r);
    r = bench_send(b, "GET", "/v1/meshes/m/attributes/faces/kind", NULL, NULL);
    assert_non_null(strstr(r.body, "\"values\":[4,0,5,0,0,6,4,5,6]"));
    bench_reply_free(&r);
    r = bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/edits", NULL,
                                     "{\"op\":\"face_delete\",\"faces\":{\"selected\":true}}"));
    assert_non_null(strstr(r.body, "\"faces\":[0,2,5,6,7,8]"));
    bench_reply_free(&r);
    bench_free(b);
}

/* Sends an operation on the cube and returns the JSON of its results. */
static void expect_results(api_bench *b, const char *operation, const char *results)
{
    bench_reply r = bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/edits", NULL, operation));
    if (strstr(r.body, results) == NULL) {
        fail_msg("%s: %s is not in %s", operation, results, r.body);
    }
    bench_reply_free(&r);
}

static void what_select_writes_is_taken_by_other_operations(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    strip_send(b, 201, "POST", "/v1/meshes?id=m", "{\"shape\":\"cube\"}");
    expect_results(b,
                   "{\"op\":\"select\",\"by\":\"half_space\",\"point\":[0,0,0.5],"
                   "\"normal\":[0,0,1],\"into\":\"top\"}",
                   "{\"op\":\"select\",\"selected\":1,\"added\":1,\"removed\":0}");
    expect_results(
        b,
        "{\"ops\":[{\"op\":\"select\",\"by\":\"boundary\",\"faces\":{\"top\":true},"
        "\"elements\":\"vertices\"},{\"op\":\"transform\",\"vertices\":{\"selected\":true"
        "},\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,7,0,0,0,1]}]}",
        "\"selected\":4,\"added\":4,\"removed\":0}");
    expect_results(b,
                   "{\"op\":\"select\",\"by\":\"box\",\"min\":[-9,-9,7],\"max\":[9,9,9],"
                   "\"corners\":\"any\",\"value\":3,\"into\":\"part\"}",
                   "\"selected\":5,\"added\":5,\"removed\":0}");
    expect_results(b, "{\"op\":\"face_delete\",\"faces\":{\"part\":3}}", "\"faces\":[");
    strip_send(b, 422, "POST", "/v1/meshes/m/edits",
               "{\"op\":\"face_delete\",\"faces\":{\"parts\":3}}");
    strip_send(b, 400, "POST", "/v1/meshes/m/edits",
               "{\"op\":\"face_delete\",\"faces\":{\"part\":true}}");
    strip_send(b, 400, "POST", "/v1/meshes/m/edits",
               "{\"op\":\"face_delete\",\"faces\":{\"top\":1}}");
    bench_reply r = bench_expect(200, bench_send(b, "GET", "/v1/meshes/m", NULL, NULL));
    assert_non_null(strstr(r.body, "\"faces\":1"));
    bench_reply_free(&r);
    strip_send(b, 200, "PATCH", "/v1/meshes/m/attributes/faces/top",
               "{\"ids\":{\"part\":0},\"value\":true}");
    expect_results(b, "{\"op\":\"select\",\"by\":\"boundary\",\"faces\":{\"part\":3}}",
                   "\"selected\":0,\"added\":0,\"removed\":0}");
    bench_free(b);
}

static void what_changes_nothing_makes_no_revision(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    strip_send(b, 201, "POST", "/v1/meshes?id=m", "{\"shape\":\"cube\"}");
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/faces/a",
               "{\"type\":\"float\",\"value\":2,\"dry_run\":false}");
    uint64_t before = revision_of(b);
    strip_send(b, 200, "PATCH", "/v1/meshes/m/attributes/faces/a", "{\"ids\":[1],\"value\":2}");
    strip_send(b, 200, "PATCH", "/v1/meshes/m/attributes/faces/a",
               "{\"ids\":[1],\"value\":3,\"dry_run\":true}");
    strip_send(b, 200, "PUT", "/v1/meshes/m/attributes/faces/b",
               "{\"type\":\"bool\",\"dry_run\":true}");
    strip_send(b, 200, "DELETE", "/v1/meshes/m/attributes/faces/a?dry_run=true", NULL);
    const char *const headers[] = {"Content-Type", OCTETS, NULL};
    bench_reply octets = bench_expect(
        200,
        bench_send_bytes(
            b, &(bench_request){"PUT", "/v1/meshes/m/attributes/faces/b?type=bool&dry_run=true",
                                headers, "\0\1\0\1\0\1", 6}));
    bench_reply_free(&octets);
    assert_int_equal(revision_of(b), before);
    strip_send(b, 404, "GET", "/v1/meshes/m/attributes/faces/b", NULL);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/attributes/faces/a?ids=1", NULL, NULL);
    assert_non_null(strstr(r.body, "\"values\":[2]"));
    bench_reply_free(&r);
    bench_free(b);
}

static const char FLAG[] = "/v1/meshes/m/attributes/faces/a";

static void what_cannot_be_undone_says_so(void **state)
{
    (void)state;
    static const char *const dry[] = {",\"dry_run\":true", ""};
    static const int then[] = {200, 410};
    api_bench *b = bench_new_within(4000, 0);
    strip_send(b, 201, "PUT", "/v1/meshes/m", "{\"shape\":\"icosphere\",\"subdivisions\":2}");
    strip_send(b, 201, "PUT", FLAG, "{\"type\":\"bool\"}");
    for (int i = 0; i < 2; i++) {
        char body[80];
        snprintf(body, sizeof body, "{\"ids\":\"all\",\"value\":true%s}", dry[i]);
        bench_reply r = bench_expect(200, bench_send(b, "PATCH", FLAG, NULL, body));
        assert_true(cJSON_IsFalse(cJSON_GetObjectItem(r.json, "undoable")));
        bench_reply_free(&r);
        strip_send(b, then[i], "GET", "/v1/meshes/m?revision=2", NULL);
    }
    strip_send(b, 409, "POST", "/v1/meshes/m/undo", NULL);
    bench_free(b);
}

static void the_history_counts_what_was_written(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    strip_send(b, 201, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    strip_send(b, 201, "PUT", FLAG, "{\"type\":\"bool\"}");
    strip_send(b, 200, "PATCH", FLAG, "{\"ids\":[1,2],\"value\":true}");
    strip_send(b, 200, "DELETE", FLAG, NULL);
    bench_reply r = bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/edits", NULL, NULL));
    static const int modified[] = {0, 2, 0};
    const cJSON *entry = cJSON_GetObjectItem(r.json, "entries")->child;
    for (size_t i = 0; i < 3; i++, entry = entry->next) {
        const cJSON *sets = cJSON_GetObjectItem(entry, "modified");
        assert_non_null(sets);
        assert_int_equal(cJSON_GetObjectItem(sets, "faces")->valueint, modified[i]);
    }
    assert_null(entry);
    bench_reply_free(&r);
    bench_free(b);
}

static void there_is_a_largest_number_of_attributes(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    strip_send(b, 201, "POST", "/v1/meshes?id=m", "{\"shape\":\"cube\"}");
    char target[80];
    for (int i = 0; i < API_MAX_ATTRIBUTES; i++) {
        snprintf(target, sizeof target, "/v1/meshes/m/attributes/faces/a%d", i);
        strip_send(b, 201, "PUT", target, "{\"type\":\"bool\"}");
    }
    strip_send(b, 413, "PUT", "/v1/meshes/m/attributes/faces/more", "{\"type\":\"bool\"}");
    strip_send(b, 200, "PUT", "/v1/meshes/m/attributes/faces/a7", "{\"type\":\"float\"}");
    strip_send(b, 200, "DELETE", "/v1/meshes/m/attributes/faces/a9", NULL);
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/faces/more", "{\"type\":\"bool\"}");
    bench_free(b);
}

/* Attributes that an edit would add, and labels (names that stand for the numbers of an attribute),
 * count toward their maximum. An edit that exceeds the maximum changes nothing. */
static void an_edit_adds_no_more_attributes_or_labels(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    strip_send(b, 201, "POST", "/v1/meshes?id=m", "{\"shape\":\"cube\"}");
    char target[80];
    for (int i = 0; i < API_MAX_ATTRIBUTES; i++) {
        snprintf(target, sizeof target, "/v1/meshes/m/attributes/faces/a%d", i);
        strip_send(b, 201, "PUT", target, "{\"type\":\"bool\"}");
    }
    strip_send(b, 413, "POST", "/v1/meshes/m/edits",
               "{\"op\":\"material_set\",\"name\":\"red\",\"faces\":[0]}");
    bench_reply r = bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/materials", NULL, NULL));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "materials")), 0);
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1 + API_MAX_ATTRIBUTES);
    bench_reply_free(&r);
    strip_send(b, 200, "POST", "/v1/meshes/m/edits", "{\"op\":\"material_set\",\"name\":\"red\"}");

    strip_send(b, 201, "POST", "/v1/meshes?id=n", "{\"shape\":\"cube\"}");
    api_text labels = {.maximum = 2 << 20};
    api_text_add_string(&labels, "{\"type\":\"uint32\",\"labels\":[\"\"");
    for (int i = 1; i < API_MAX_LABELS; i++) {
        api_text_add_format(&labels, ",\"%d\"", i);
    }
    api_text_add(&labels, "]}", 3); /* the 3 bytes are ']', '}' and the NUL that ends the text */
    assert_false(labels.failed);
    strip_send(b, 201, "PUT", "/v1/meshes/n/attributes/faces/material", labels.bytes);
    strip_send(b, 413, "POST", "/v1/meshes/n/edits",
               "{\"op\":\"material_set\",\"name\":\"red\",\"faces\":[0]}");
    strip_send(b, 200, "POST", "/v1/meshes/n/edits",
               "{\"op\":\"material_set\",\"name\":\"7\",\"faces\":[0]}");
    strip_send(b, 200, "POST", "/v1/meshes/n/edits",
               "{\"ops\":[{\"op\":\"material_delete\",\"name\":\"8\"},"
               "{\"op\":\"material_set\",\"name\":\"red\",\"faces\":[0]}]}");
    api_text_clear(&labels);
    bench_free(b);
}

static void a_page_leads_to_the_next(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    strip_make(b, "m", true);
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/vertices/a%20%22%C3%A4",
               "{\"type\":\"float\"}");
    char target[400] = "/v1/meshes/m/attributes/vertices/a%20%22%C3%A4?limit=3";
    unsigned ids = 0;
    for (;;) {
        bench_reply r = bench_expect(200, bench_send(b, "GET", target, NULL, NULL));
        ids += (unsigned)cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "ids"));
        const char *link = bench_header(&r, "Link");
        if (link[0] == '\0') {
            bench_reply_free(&r);
            break;
        }
        snprintf(target, sizeof target, "%.*s", (int)strcspn(link + 1, ">"), link + 1);
        bench_reply_free(&r);
    }
    assert_int_equal(ids, 8);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sets_stand_for_lists),
        cmocka_unit_test(what_select_writes_is_taken_by_other_operations),
        cmocka_unit_test(what_changes_nothing_makes_no_revision),
        cmocka_unit_test(what_cannot_be_undone_says_so),
        cmocka_unit_test(the_history_counts_what_was_written),
        cmocka_unit_test(there_is_a_largest_number_of_attributes),
        cmocka_unit_test(an_edit_adds_no_more_attributes_or_labels),
        cmocka_unit_test(a_page_leads_to_the_next),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
