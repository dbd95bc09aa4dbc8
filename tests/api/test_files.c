/* Exports of mesh files in every encoding, and imports under every file name and media type that
 * identifies a format. */
#include "tests/api/request.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct {
    const char *format, *encoding, *type;
    unsigned vertices, faces;
} files[] = {
    {"obj", "ascii", "model/obj", 8, 6},
    {"off", "ascii", "model/x-off", 8, 6},
    {"ply", "ascii", "model/ply", 8, 6},
    {"ply", "binary", "application/ply", 8, 6},
    {"ply", "binary_big_endian", "model/ply", 8, 6},
    {"stl", "ascii", "model/stl", 8, 12},
    {"stl", "binary", "model/stl", 8, 12},
    {"glb", "binary", "model/gltf-binary", 8, 6},
};

enum { FILES = sizeof files / sizeof *files };

static api_bench *with_cube(void)
{
    api_bench *b = bench_new();
    bench_reply r =
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}"));
    bench_reply_free(&r);
    return b;
}

static bench_reply export(api_bench *b, size_t i)
{
    char target[100];
    snprintf(target, sizeof target, "/v1/meshes/m/content?format=%s&encoding=%s", files[i].format,
             files[i].encoding);
    return bench_expect(200, bench_send(b, "GET", target, NULL, NULL));
}

static void import(api_bench *b, const char *target, const char *type, const bench_reply *file,
                   size_t i)
{
    const char *const headers[] = {"Content-Type", type, NULL};
    bench_reply r = bench_expect(
        201,
        bench_send_bytes(b, &(bench_request){"POST", target, headers, file->body, file->length}));
    const cJSON *counts = cJSON_GetObjectItem(r.json, "counts");
    const cJSON *report = cJSON_GetObjectItem(r.json, "import");
    assert_int_equal(cJSON_GetObjectItem(counts, "vertices")->valueint, files[i].vertices);
    assert_int_equal(cJSON_GetObjectItem(counts, "faces")->valueint, files[i].faces);
    assert_string_equal(cJSON_GetObjectItem(report, "format")->valuestring, files[i].format);
    if (strcmp(files[i].format, "stl") == 0) {
        const cJSON *note = cJSON_GetArrayItem(cJSON_GetObjectItem(report, "warnings"), 0);
        assert_string_equal(cJSON_GetObjectItem(note, "code")->valuestring, "welded");
        assert_int_equal(cJSON_GetObjectItem(note, "count")->valueint, 28);
    }
    bench_reply_free(&r);
}

static void what_is_exported_is_read_back(void **state)
{
    (void)state;
    api_bench *b = with_cube();
    for (size_t i = 0; i < FILES; i++) {
        char target[60];
        bench_reply file = export(b, i);
        import(b, "/v1/meshes", files[i].type, &file, i);
        import(b, "/v1/meshes", "application/octet-stream", &file, i);
        snprintf(target, sizeof target, "/v1/meshes?format=%s", files[i].format);
        import(b, target, "application/octet-stream", &file, i);
        bench_reply_free(&file);
    }
    bench_free(b);
}

static void each_encoding_has_its_tag(void **state)
{
    (void)state;
    api_bench *b = with_cube();
    char tags[FILES][100];
    for (size_t i = 0; i < FILES; i++) {
        bench_reply file = export(b, i);
        snprintf(tags[i], sizeof tags[i], "%s", bench_header(&file, "ETag"));
        for (size_t k = 0; k < i; k++) {
            assert_string_not_equal(tags[i], tags[k]);
        }
        bench_reply_free(&file);
    }
    /* A request that names no encoding gets the default encoding of the format. The header Accept
     * selects a format as well as ?format= does. */
    static const char *const accept[] = {"Accept", "model/ply", NULL};
    bench_reply r = bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/content", accept, NULL));
    assert_string_equal(bench_header(&r, "Content-Type"), "model/ply");
    assert_string_equal(bench_header(&r, "ETag"), tags[3]);
    bench_reply_free(&r);
    r = bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/content?format=stl", NULL, NULL));
    assert_string_equal(bench_header(&r, "Content-Type"), "model/stl");
    assert_string_equal(bench_header(&r, "ETag"), tags[6]);
    assert_non_null(strstr(bench_header(&r, "Content-Disposition"), "m.stl"));
    assert_non_null(strstr(bench_header(&r, "Export-Warnings"),
                           "a face is cut into triangles, because STL files hold only triangles"));
    bench_reply_free(&r);
    bench_free(b);
}

/* The warnings about an export go into a header of at most 2000 bytes. This export drops 40
 * attributes, whose warnings need more: the header must say how many warnings did not fit. */
static void warnings_that_find_no_room_are_counted(void **state)
{
    (void)state;
    static const char *const patch[] = {"Content-Type", "application/json", NULL};
    enum { ATTRIBUTES = 40 };
    api_bench *b = with_cube();
    for (unsigned i = 0; i < ATTRIBUTES; i++) {
        char target[100];
        snprintf(target, sizeof target, "/v1/meshes/m/attributes/faces/attribute_%02u", i);
        bench_reply r = bench_send(b, "PUT", target, patch, "{\"type\":\"float\"}");
        r = bench_expect(201, r);
        bench_reply_free(&r);
    }
    bench_reply r =
        bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/content?format=obj", NULL, NULL));
    const char *text = bench_header(&r, "Export-Warnings"), *last = strstr(text, "; and ");
    unsigned said = 1, more = 0;
    assert_non_null(last);
    assert_int_equal(sscanf(last, "; and %u more", &more), 1);
    for (const char *p = text; p < last; p++) {
        said += *p == ';';
    }
    assert_int_equal(said + more, ATTRIBUTES);
    static const char first[] =
        "attribute 'face attribute_00' is not written, because the format cannot hold it; ";
    assert_true(said > 20 && strlen(text) <= 2000);
    assert_memory_equal(text, first, strlen(first));
    bench_reply_free(&r);
    bench_free(b);
}

static void a_position_that_no_float_holds_is_named(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL,
                               "{\"vertices\":[[0,0,0],[0,-1e39,0]],\"faces\":[]}");
    r = bench_expect(201, r);
    bench_reply_free(&r);
    r = bench_expect(422, bench_send(b, "GET", "/v1/meshes/m/content?format=glb", NULL, NULL));
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "beyond_float");
    assert_non_null(strstr(r.body, "vertex 1 has a coordinate too large for the floats"));
    bench_reply_free(&r);
    bench_free(b);
}

/* A compressed export has an entity tag of its own, and contains the same mesh. */
static void a_compressed_export_is_another_representation(void **state)
{
    (void)state;
    static const char *const targets[] = {
        "/v1/meshes/m/content?format=glb", "/v1/meshes/m/content?format=glb&compress=meshopt",
        "/v1/meshes/m/content?format=glb&encoding=binary&compress=meshopt"};
    static const char *const type[] = {"Content-Type", "model/gltf-binary", NULL};
    api_bench *b = with_cube();
    char tags[3][80];
    for (size_t i = 0; i < 3; i++) {
        bench_reply r = bench_expect(200, bench_send(b, "GET", targets[i], NULL, NULL));
        assert_string_equal(bench_header(&r, "Content-Type"), "model/gltf-binary");
        snprintf(tags[i], sizeof tags[i], "%s", bench_header(&r, "ETag"));
        bench_reply made =
            bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes", type, r.body, r.length});
        made = bench_expect(201, made);
        assert_non_null(strstr(made.body, "\"vertices\":8,\"faces\":6,"));
        assert_non_null(strstr(made.body, "\"volume\":1,"));
        bench_reply_free(&made);
        bench_reply_free(&r);
    }
    assert_string_not_equal(tags[0], tags[1]);
    assert_string_equal(tags[1], tags[2]);
    bench_free(b);
}

static void encodings_that_do_not_exist(void **state)
{
    (void)state;
    static const char *const targets[] = {
        "/v1/meshes/m/content?format=obj&encoding=binary",
        "/v1/meshes/m/content?format=stl&encoding=binary_big_endian",
        "/v1/meshes/m/content?format=json&encoding=ascii",
        "/v1/meshes/m/content?encoding=binary",
        "/v1/meshes/m/content?format=ply&encoding=utf-8",
        "/v1/meshes/m/content?format=glb&encoding=ascii",
        "/v1/meshes/m/content?format=gltf",
        "/v1/meshes/m/content?format=glb&encoding=meshopt",
        "/v1/meshes/m/content?format=glb&compress=draco",
        "/v1/meshes/m/content?format=glb&encoding=ascii&compress=meshopt",
        "/v1/meshes/m/content?format=ply&compress=meshopt",
        "/v1/meshes/m/content?compress=meshopt",
    };
    api_bench *b = with_cube();
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        bench_reply r = bench_expect(400, bench_send(b, "GET", targets[i], NULL, NULL));
        assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "bad_parameter");
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void a_wrong_file_names_its_place(void **state)
{
    (void)state;
    static const struct {
        const char *type, *body;
        const char *member;
        int at;
    } rows[] = {
        {"model/ply", "ply\nformat ascii 1.0\nelement face 3\nend_header\n", "line", 3},
        {"model/stl", "solid\nfacet\nvertex 0 0 0\nendfacet\n", "line", 4},
        {"model/stl", "short", "byte", 5},
        {"model/ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty char x\n"
         "property char y\nproperty char z\nend_header\n12",
         "byte", 114},
        {"model/stl", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 -0\nvertex 1 0 0\nendfacet\n", "line",
         2},
        {"model/gltf-binary", "glTF", "byte", 4},
        {"model/gltf+json", "{\"asset\":{\"version\":\"1.0\"}}", "byte", 20},
    };
    api_bench *b = with_cube();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *const headers[] = {"Content-Type", rows[i].type, NULL};
        bench_reply r = bench_send(b, "POST", "/v1/meshes", headers, rows[i].body);
        assert_true(r.status == 400 || r.status == 422);
        char place[40];
        snprintf(place, sizeof place, "%s %d", rows[i].member, rows[i].at);
        if (strstr(r.body, place) == NULL) {
            fail_msg("no %s in %s", place, r.body);
        }
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* A JSON body can be glTF or a mesh document: its media type, its file name or its first bytes
 * decide. Files outside the body are never read. */
static void gltf_is_read_and_what_is_outside_never(void **state)
{
    (void)state;
    static const char *const types[] = {"model/gltf+json", "application/octet-stream"};
    static const char inside[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"data:;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAA\"}],\"bufferViews\":[{\"buffer\":0,"
        "\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
        "\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}";
    static const char outside[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,"
        "\"uri\":\"file:///etc/hostname\"}]}";
    api_bench *b = with_cube();
    for (size_t i = 0; i < 2; i++) {
        const char *const headers[] = {"Content-Type", types[i], NULL};
        bench_reply r = bench_expect(201, bench_send(b, "POST", "/v1/meshes", headers, inside));
        const cJSON *report = cJSON_GetObjectItem(r.json, "import");
        assert_string_equal(cJSON_GetObjectItem(report, "format")->valuestring, "gltf");
        assert_int_equal(cJSON_GetObjectItem(report, "faces")->valueint, 1);
        bench_reply_free(&r);
        r = bench_expect(422, bench_send(b, "POST", "/v1/meshes", headers, outside));
        assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "unsupported");
        assert_non_null(strstr(r.body, "buffers/0/uri: the buffer is in another file"));
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* Uploads a glTF file and returns the request after the last byte. A glTF file is read only when it
 * is complete, and then by a thread of the job pool. */
static api_exchange *upload_gltf(api_bench *b, const char *text, size_t length)
{
    const api_request request = {.method = "POST",
                                 .path = "/v1/meshes",
                                 .query = "",
                                 .request_id = "test",
                                 .headers = {[API_HEADER_CONTENT_TYPE] = "model/gltf+json"},
                                 .has_length = true,
                                 .length = length,
                                 .has_body = true};
    api_step step;
    size_t used;
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    assert_non_null(x);
    assert_int_equal(api_body(x, text, length, &used), API_MORE);
    assert_int_equal(used, length);
    assert_int_equal(api_end(x), API_WORK);
    return x;
}

static bool give_up_reading(void *context, const char *phase, double done)
{
    unsigned *told = context;
    *told += strcmp(phase, "parsing") == 0;
    return *told < 3 || done < 0;
}

/* A glTF file is parsed in the job pool after its last byte has arrived. The client must be able to
 * cancel the request during that time. */
static void a_file_that_is_read_at_its_end_can_be_given_up(void **state)
{
    (void)state;
    enum { LENGTH = 600000 };
    char *text = malloc(LENGTH);
    assert_non_null(text);
    memset(text, '0', LENGTH);
    for (size_t i = 0; i < LENGTH; i += 2) {
        text[i] = i == 0 ? '[' : ',';
    }
    text[LENGTH - 1] = ']';
    text[LENGTH - 2] = ' ';
    api_bench *b = bench_new();
    unsigned told = 0;
    api_exchange *x = upload_gltf(b, text, LENGTH);
    api_set_progress(x, give_up_reading, &told);
    assert_int_equal(api_work(x), API_READY);
    assert_int_equal(api_answer_of(x)->status, 503);
    assert_int_equal(told, 3);
    api_free(x);
    bench_free(b);
    free(text);
}

/* Even a short glTF file is parsed in the job pool and not by a worker, because a few bytes can
 * describe a large mesh. */
static void a_small_file_that_is_read_at_its_end_leaves_the_worker(void **state)
{
    (void)state;
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":"
        "{\"POSITION\":0},\"mode\":0}]}],\"accessors\":[{\"componentType\":5126,"
        "\"type\":\"VEC3\",\"count\":30000,\"min\":[0,0,0],\"max\":[0,0,0]}]}";
    api_bench *b = bench_new();
    api_exchange *x = upload_gltf(b, text, sizeof text - 1);
    assert_int_equal(api_work(x), API_READY);
    api_free(x);
    bench_free(b);
}

static const char *warning(const cJSON *report, int i)
{
    const cJSON *item = cJSON_GetArrayItem(cJSON_GetObjectItem(report, "warnings"), i);
    return item == NULL ? "" : cJSON_GetObjectItem(item, "code")->valuestring;
}

/* The report of an import counts the edges right after the file was read. A repair may remove or
 * add edges, so the mesh may have another number. */
static void a_report_says_what_was_read_and_what_was_not(void **state)
{
    (void)state;
    static const struct {
        const char *target, *edges, *warning;
    } rows[] = {
        {"/v1/meshes?format=off", "3", ""},
        {"/v1/meshes?format=off", "0", ""},
        {"/v1/meshes?format=off", "", ""},
        {"/v1/meshes?format=off", "1e300", "edge_count"},
        {"/v1/meshes?format=off", "4", "edge_count"},
        {"/v1/meshes?format=off&repair=weld", "4", ""},
    };
    static const char *const headers[] = {"Content-Type", "application/octet-stream", NULL};
    api_bench *b = with_cube();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[200];
        snprintf(
            text, sizeof text,
            "CNOFF\n3 1 %s\n0 0 0 0 0 1 1 2 3\n1 0 0 0 0 1 1 2 3\n0 1 0 0 0 1 1 2 3\n3 0 1 2\n",
            rows[i].edges);
        bench_reply r = bench_expect(201, bench_send(b, "POST", rows[i].target, headers, text));
        const cJSON *report = cJSON_GetObjectItem(r.json, "import");
        assert_string_equal(warning(report, 0), rows[i].warning);
        assert_non_null(strstr(r.body,
                               "\"attributes\":[{\"domain\":\"vertices\",\"name\":"
                               "\"normal\"},{\"domain\":\"vertices\",\"name\":\"color\"}]"));
        bench_reply_free(&r);
    }
    bench_reply r = bench_expect(201, bench_send(b, "POST", "/v1/meshes?format=obj", headers,
                                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 2\nf 1 2 3\n"));
    const cJSON *report = cJSON_GetObjectItem(r.json, "import");
    assert_string_equal(warning(report, 0), "unused_uv");
    assert_null(cJSON_GetObjectItem(report, "attributes"));
    bench_reply_free(&r);
    bench_free(b);
}

/* The format of a body is given by ?format=, or, without that, by the header Content-Type. If the
 * bytes look like another format, the refusal must say which. */
static void a_body_of_another_format_is_told(void **state)
{
    (void)state;
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static const char off[] = "OFF\n1 0 0\n0 0 0\n";
    static const char wide[] = "\xFF\xFEv\x20";
    static const struct {
        const char *target, *type, *body;
        int status;
        const char *words;
    } rows[] = {
        {"/v1/meshes", "model/stl", obj, 400, "the body looks like a file of the format obj"},
        {"/v1/meshes", "model/obj", off, 400, "the body looks like a file of the format off"},
        {"/v1/meshes", "model/gltf-binary", off, 400, "looks like a file of the format off"},
        {"/v1/meshes?format=ply", "model/obj", obj, 400, "looks like a file of the format obj"},
        {"/v1/meshes?format=obj", "model/stl", obj, 201, "\"format\":\"obj\""},
        {"/v1/meshes?format=obj", "application/json", obj, 201, "\"format\":\"obj\""},
        {"/v1/meshes", "model/off", off, 415, "model/off"},
        {"/v1/meshes", "application/octet-stream", wide, 415, "the body is UTF-16"},
        {"/v1/meshes?format=obj", "application/octet-stream", wide, 422, "the text is UTF-16"},
    };
    api_bench *b = with_cube();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *const headers[] = {"Content-Type", rows[i].type, NULL};
        bench_reply r = bench_send(b, "POST", rows[i].target, headers, rows[i].body);
        r = bench_expect(rows[i].status, r);
        assert_non_null(strstr(r.body, rows[i].words));
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* The body is an image. Whatever format is declared, the refusal must say that the body is no mesh,
 * instead of interpreting its bytes as a number of triangles. */
static void a_body_that_is_no_mesh_is_called_by_its_name(void **state)
{
    (void)state;
    static const char png[100] = "\x89PNG\r\n\x1A\n", zip[100] = "PK\3\4",
                      page[100] = "<!DOCTYPE html><title>404</title>";
    static const struct {
        const char *target, *type, *body;
        int status;
        const char *words;
    } rows[] = {
        {"/v1/meshes", "application/octet-stream", png, 415, "\"the body is a PNG image\""},
        {"/v1/meshes", "model/stl", png, 400, "\"the body is a PNG image\""},
        {"/v1/meshes", "model/ply", png, 400, "\"the body is a PNG image\""},
        {"/v1/meshes", "model/gltf-binary", png, 400, "\"the body is a PNG image\""},
        {"/v1/meshes", "application/octet-stream", zip, 415, "as 3MF and USDZ files are: unpack"},
        {"/v1/meshes?format=stl", "application/octet-stream", zip, 400, "a ZIP archive"},
        {"/v1/meshes?format=obj", "application/octet-stream", page, 400, "an HTML page"},
        {"/v1/meshes", "application/octet-stream", page, 415, "an HTML page"},
    };
    api_bench *b = with_cube();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *const headers[] = {"Content-Type", rows[i].type, NULL};
        bench_reply r = bench_expect(
            rows[i].status, bench_send_bytes(b, &(bench_request){"POST", rows[i].target, headers,
                                                                 rows[i].body, 100}));
        if (strstr(r.body, rows[i].words) == NULL || strstr(r.body, "facets") != NULL) {
            fail_msg("no %s in %s", rows[i].words, r.body);
        }
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* curl -T sends no Content-Type and curl --data-binary a generic one. In both cases ?format= must
 * determine the format. */
static void a_format_that_is_named_stands_in_for_a_generic_type(void **state)
{
    (void)state;
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    static const char *const types[] = {NULL, "text/plain; charset=utf-8",
                                        "application/x-www-form-urlencoded",
                                        "application/octet-stream"};
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        const char *const headers[] = {"Content-Type", types[i] == NULL ? "" : types[i], NULL};
        bench_reply r = bench_send_bytes(
            b, &(bench_request){"PUT", "/v1/meshes/part?format=obj", headers, obj, sizeof obj - 1});
        r = bench_expect(i == 0 ? 201 : 200, r);
        assert_non_null(strstr(r.body, "\"format\":\"obj\""));
        bench_reply_free(&r);
        r = bench_send_bytes(
            b, &(bench_request){"PUT", "/v1/meshes/part", headers, obj, sizeof obj - 1});
        r = bench_expect(i == 3 ? 200 : 415, r);
        if (i < 3) {
            assert_non_null(strstr(
                r.body,
                "give the format with ?format=, one of obj, off, ply, stl, glb, gltf, json"));
            assert_non_null(strstr(r.body, "\"supported\":[\"application/json\",\"model/obj\""));
        }
        bench_reply_free(&r);
    }
    const char *const other[] = {"Content-Type", "image/png", NULL};
    bench_reply r =
        bench_send_bytes(b, &(bench_request){"PUT", "/v1/meshes/part?format=obj", other, obj, 5});
    r = bench_expect(415, r);
    bench_reply_free(&r);
    r = bench_expect(400, bench_send(b, "PUT", "/v1/meshes/part?format=obj", NULL, ""));
    assert_non_null(strstr(r.body, "the body is empty: send the bytes of a mesh file"));
    bench_reply_free(&r);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_exported_is_read_back),
        cmocka_unit_test(each_encoding_has_its_tag),
        cmocka_unit_test(warnings_that_find_no_room_are_counted),
        cmocka_unit_test(a_position_that_no_float_holds_is_named),
        cmocka_unit_test(a_compressed_export_is_another_representation),
        cmocka_unit_test(encodings_that_do_not_exist),
        cmocka_unit_test(a_wrong_file_names_its_place),
        cmocka_unit_test(gltf_is_read_and_what_is_outside_never),
        cmocka_unit_test(a_file_that_is_read_at_its_end_can_be_given_up),
        cmocka_unit_test(a_small_file_that_is_read_at_its_end_leaves_the_worker),
        cmocka_unit_test(a_body_of_another_format_is_told),
        cmocka_unit_test(a_body_that_is_no_mesh_is_called_by_its_name),
        cmocka_unit_test(a_format_that_is_named_stands_in_for_a_generic_type),
        cmocka_unit_test(a_report_says_what_was_read_and_what_was_not),
    };
    return cmocka_run_group_tests_name("files", tests, NULL, NULL);
}
