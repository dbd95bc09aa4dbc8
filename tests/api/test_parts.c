/* A mesh in several files that are sent in one multipart body: a .gltf with its .bin, or an OBJ
 * with its material library. */
#include "base/mem.h"
#include "tests/api/request.h"
#include "tests/codings.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define BOUNDARY "xyz"

static const char type[] = "multipart/form-data; boundary=" BOUNDARY;

typedef struct file {
    const char *name, *type;
    const char *bytes;
    size_t length; /* 0 if `bytes` is a NUL-terminated text */
} file;

enum { MOST_FILES = 4, MOST_BODY = 4096 };

typedef struct several {
    char bytes[MOST_BODY];
    size_t length;
} several;

static void add(several *b, const void *bytes, size_t length)
{
    assert_true(b->length + length <= sizeof b->bytes);
    memcpy(b->bytes + b->length, bytes, length);
    b->length += length;
}

static void add_text(several *b, const char *text)
{
    add(b, text, strlen(text));
}

static several pack_as(const char *boundary, const file *files)
{
    several b = {.length = 0};
    char head[400];
    for (size_t i = 0; i < MOST_FILES && files[i].name != NULL; i++) {
        snprintf(head, sizeof head,
                 "--%s\r\nContent-Disposition: form-data; name=\"files\"; filename=\"%s\"\r\n"
                 "%s%s%s\r\n",
                 boundary, files[i].name, files[i].type == NULL ? "" : "Content-Type: ",
                 files[i].type == NULL ? "" : files[i].type, files[i].type == NULL ? "" : "\r\n");
        add_text(&b, head);
        add(&b, files[i].bytes, files[i].length > 0 ? files[i].length : strlen(files[i].bytes));
        add_text(&b, "\r\n");
    }
    snprintf(head, sizeof head, "--%s--\r\n", boundary);
    add_text(&b, head);
    return b;
}

static bench_reply send_body(api_bench *b, const char *method, const char *target,
                             const several *body)
{
    static const char *const headers[] = {"Content-Type", type, NULL};
    return bench_send_bytes(b,
                            &(bench_request){method, target, headers, body->bytes, body->length});
}

static bench_reply send_files(api_bench *b, const char *target, const file *files)
{
    several packed = pack_as(BOUNDARY, files);
    return send_body(b, "POST", target, &packed);
}

/* The corners (0, 0, 0), (1, 0, 0) and (0, 1, 0) of a triangle as little-endian floats. */
static const unsigned char corners[36] = {[14] = 0x80, [15] = 0x3F, [30] = 0x80, [31] = 0x3F};
#define BIN ((const char *)corners), sizeof corners

#define GLTF(uri)                                                                             \
    "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"" uri "\"}]," \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"    \
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"                                 \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}"
#define OBJ "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
#define MTL "newmtl red\nKd 1 0 0\n"

/* Requires that the answer describes a mesh of three vertices and one face, read from a file in the
 * format `format`; returns the answer. */
static bench_reply expect_triangle(const char *format, bench_reply r)
{
    r = bench_expect(201, r);
    const cJSON *report = cJSON_GetObjectItem(r.json, "import");
    assert_string_equal(cJSON_GetObjectItem(report, "format")->valuestring, format);
    assert_int_equal(cJSON_GetObjectItem(report, "vertices")->valueint, 3);
    assert_int_equal(cJSON_GetObjectItem(report, "faces")->valueint, 1);
    assert_non_null(strstr(r.body, "\"max\":[1,1,0]"));
    return r;
}

static void expect_refused(int status, const char *code, const char *words, bench_reply r)
{
    r = bench_expect(status, r);
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, code);
    const char *detail = cJSON_GetObjectItem(r.json, "detail")->valuestring;
    if (strstr(detail, words) == NULL) {
        fail_msg("got \"%s\", wanted \"%s\"", detail, words);
    }
    bench_reply_free(&r);
}

static void a_gltf_finds_its_buffers_by_name(void **state)
{
    (void)state;
    static const file rows[][MOST_FILES] = {
        {{"a.gltf", NULL, GLTF("a.bin"), 0}, {"a.bin", NULL, BIN}},
        {{"a.bin", "application/octet-stream", BIN}, {"a.gltf", NULL, GLTF("a.bin"), 0}},
        {{"scene", "model/gltf+json", GLTF("a.bin"), 0}, {"a.bin", NULL, BIN}},
        {{"scene", NULL, GLTF("a.bin"), 0}, {"a.bin", NULL, BIN}},
        {{"a.gltf", NULL, GLTF("the%20%C3%BC.bin"), 0}, {"the \xC3\xBC.bin", NULL, BIN}},
        {{"a.gltf", NULL, GLTF("100%25.bin"), 0}, {"100%25.bin", NULL, BIN}},
        {{"a.gltf", NULL, GLTF("the \\u00fc.bin"), 0}, {"the \xC3\xBC.bin", NULL, BIN}},
        /* A browser sends the names of chosen files without their folders. So a file that is not
         * found by its path is found by the last part of that path. */
        {{"a.gltf", NULL, GLTF("./a.bin"), 0}, {"a.bin", NULL, BIN}},
        {{"a.gltf", NULL, GLTF("a.bin"), 0}, {"dir\\a.bin", NULL, BIN}},
        {{"d/a.gltf", NULL, GLTF("x/a.bin"), 0},
         {"y/a.bin", NULL, "no", 0},
         {"x/a.bin", NULL, BIN}},
    };
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        bench_reply r = expect_triangle("gltf", send_files(b, "/v1/meshes", rows[i]));
        bool whole = rows[i][2].name == NULL;
        assert_true((strstr(r.body, "\"warnings\":[]") != NULL) == whole);
        assert_true((strstr(r.body, "file 'y/a.bin'") != NULL) == !whole);
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void a_buffer_that_did_not_come_is_named(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    expect_refused(422, "unsupported",
                   "buffers/0/uri: the file 'a.bin' of a buffer was not sent; the files sent are "
                   "b.bin, c.bin",
                   send_files(b, "/v1/meshes",
                              (file[MOST_FILES]){{"a.gltf", NULL, GLTF("a.bin"), 0},
                                                 {"b.bin", NULL, BIN},
                                                 {"c.bin", NULL, BIN}}));
    expect_refused(
        422, "unsupported", "the buffer is in another file, 'a.bin': send both",
        send_files(b, "/v1/meshes", (file[MOST_FILES]){{"a.gltf", NULL, GLTF("a.bin"), 0}}));
    /* The body has two files, in different folders, whose name is the one to which the glTF refers.
     * The request is refused, because either file could be meant. */
    expect_refused(422, "unsupported", "the file 'x/a.bin' of a buffer was not sent",
                   send_files(b, "/v1/meshes",
                              (file[MOST_FILES]){{"a.gltf", NULL, GLTF("x/a.bin"), 0},
                                                 {"y/a.bin", NULL, BIN},
                                                 {"z/a.bin", NULL, BIN}}));
    expect_refused(400, "bad_value", "the buffer should have 36 bytes, and only 2 were sent",
                   send_files(b, "/v1/meshes",
                              (file[MOST_FILES]){{"a.gltf", NULL, GLTF("a.bin"), 0},
                                                 {"a.bin", NULL, "12", 0}}));
    expect_refused(400, "bad_multipart", "two files are named \"a.bin\"",
                   send_files(b, "/v1/meshes",
                              (file[MOST_FILES]){{"a.bin", NULL, BIN}, {"a.bin", NULL, BIN}}));
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes"));
    assert_non_null(strstr(r.body, "\"items\":[]"));
    bench_reply_free(&r);
    bench_free(b);
}

static void an_obj_comes_with_its_library(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = expect_triangle(
        "obj", send_files(b, "/v1/meshes",
                          (file[MOST_FILES]){{"a.mtl", NULL, MTL, 0}, {"a.obj", NULL, OBJ, 0}}));
    bench_reply_free(&r);
    /* A file in the body that the mesh file does not refer to is reported as a warning. */
    r = expect_triangle("obj", send_files(b, "/v1/meshes",
                                          (file[MOST_FILES]){{"a.obj", "text/plain", OBJ, 0},
                                                             {"b.png", "image/png", "1", 0}}));
    assert_non_null(strstr(r.body, "file 'b.png'"));
    bench_reply_free(&r);
    bench_free(b);
}

static void one_file_is_the_mesh(void **state)
{
    (void)state;
    static const file two[MOST_FILES] = {
        {"a.obj", NULL, OBJ, 0}, {"a.gltf", NULL, GLTF("a.bin"), 0}, {"a.bin", NULL, BIN}};
    static const file none[MOST_FILES] = {{"a.bin", NULL, BIN}, {"a.mtl", NULL, MTL, 0}};
    static const file bare[MOST_FILES] = {{"mesh", NULL, OBJ, 0}, {"a.mtl", NULL, MTL, 0}};
    static const file bares[MOST_FILES] = {{"x", NULL, OBJ, 0}, {"y", NULL, OBJ, 0}};
    static const file odd[MOST_FILES] = {{"mesh.txt", NULL, "# nothing yet\nv 0 0 0\n", 0}};
    static const file json[MOST_FILES] = {
        {"mesh.json", NULL, "{\"name\":\"tile\",\"vertices\":[[0,0,0]],\"faces\":[]}", 0}};
    api_bench *b = bench_new();
    expect_refused(422, "unclear_parts",
                   "could be the mesh: a.obj, a.gltf; send only one of them, or choose with",
                   send_files(b, "/v1/meshes", two));
    bench_reply r = expect_triangle("gltf", send_files(b, "/v1/meshes?format=gltf", two));
    assert_non_null(strstr(r.body, "file 'a.obj'"));
    bench_reply_free(&r);
    bench_done(expect_triangle("obj", send_files(b, "/v1/meshes?format=obj", two)));
    expect_refused(422, "unclear_parts",
                   "in the format ply, judging by their names, media types and first bytes: "
                   "a.obj, a.gltf, a.bin",
                   send_files(b, "/v1/meshes?format=ply", two));
    expect_refused(422, "unclear_parts",
                   "in a format that the server reads, judging by their names, media types and "
                   "first bytes: "
                   "a.bin, a.mtl",
                   send_files(b, "/v1/meshes", none));
    expect_refused(422, "unclear_parts", "names, media types and first bytes: ",
                   send_files(b, "/v1/meshes", (file[MOST_FILES]){{NULL, NULL, NULL, 0}}));
    bench_done(expect_triangle("obj", send_files(b, "/v1/meshes", bare)));
    expect_refused(422, "unclear_parts", "could be the mesh: x, y;",
                   send_files(b, "/v1/meshes", bares));
    bench_done(bench_expect(201, send_files(b, "/v1/meshes?format=obj", odd)));
    r = bench_expect(201, send_files(b, "/v1/meshes", json));
    assert_string_equal(cJSON_GetObjectItem(r.json, "name")->valuestring, "tile");
    bench_reply_free(&r);
    bench_free(b);
}

static void every_upload_takes_them(void **state)
{
    (void)state;
    static const file files[MOST_FILES] = {{"a.gltf", NULL, GLTF("a.bin"), 0},
                                           {"a.bin", NULL, BIN}};
    const several packed = pack_as(BOUNDARY, files);
    api_bench *b = bench_new();
    bench_done(bench_expect(201, send_body(b, "PUT", "/v1/meshes/m", &packed)));
    bench_done(bench_expect(200, send_body(b, "PUT", "/v1/meshes/m?repair=weld", &packed)));
    /* The multipart body may be compressed as a whole. */
    static const char *const codings[] = {"gzip", "zstd"};
    for (size_t i = 0; i < 2; i++) {
        size_t length;
        char *coded = coding_pack(codings[i], packed.bytes, packed.length, &length);
        const char *const headers[] = {"Content-Type", type, "Content-Encoding", codings[i], NULL};
        bench_done(expect_triangle(
            "gltf",
            bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes", headers, coded, length})));
        free(coded);
    }
    /* The request may become a job, which reads the files after the body has been freed. */
    const char *const headers[] = {"Content-Type", type, "Prefer", "respond-async", NULL};
    bench_reply r = bench_expect(
        202, bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes?id=late", headers,
                                                  packed.bytes, packed.length}));
    bench_reply_free(&r);
    bench_run_jobs(b, 1);
    r = bench_expect(200, bench_get(b, "/v1/meshes/late"));
    assert_non_null(strstr(r.body, "\"faces\":1"));
    bench_reply_free(&r);
    bench_free(b);
}

static void a_body_that_is_cut_or_has_no_boundary_is_refused(void **state)
{
    (void)state;
    static const file files[MOST_FILES] = {{"a.obj", NULL, OBJ, 0}, {"a.mtl", NULL, MTL, 0}};
    several packed = pack_as(BOUNDARY, files);
    api_bench *b = bench_new();
    const char *const plain[] = {"Content-Type", "multipart/form-data", NULL};
    expect_refused(400, "bad_header", "needs exactly one parameter boundary, of 1 to 70 characters",
                   bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes", plain, packed.bytes,
                                                        packed.length}));
    const char *const mixed[] = {"Content-Type", "multipart/mixed; boundary=xyz", NULL};
    expect_refused(415, "unsupported_media_type", "multipart/mixed",
                   bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes", mixed, packed.bytes,
                                                        packed.length}));
    packed.length -= 4; /* leaves out "--" and the line break at the end of the body */
    expect_refused(400, "bad_multipart", "ends before its last delimiter",
                   send_body(b, "POST", "/v1/meshes", &packed));
    /* A mistake in the mesh file is reported as soon as it is read, before the other files have
     * arrived. */
    const file wrong[MOST_FILES] = {{"a.obj", NULL, "v 1 2\n", 0}, {"a.mtl", NULL, MTL, 0}};
    expect_refused(400, "syntax", "line 1", send_files(b, "/v1/meshes", wrong));
    bench_free(b);
}

static void another_boundary_is_the_same_request(void **state)
{
    (void)state;
    static const char *const boundaries[] = {BOUNDARY, "other"};
    static const char *const types[] = {type, "multipart/form-data; boundary=other"};
    file files[MOST_FILES] = {{"a.obj", NULL, OBJ, 0}, {"a.mtl", NULL, MTL, 0}};
    api_bench *b = bench_new();
    char *first = NULL;
    for (size_t i = 0; i < 2; i++) {
        several packed = pack_as(boundaries[i], files);
        const char *const headers[] = {"Content-Type", types[i], "Idempotency-Key", "k", NULL};
        bench_reply r =
            bench_expect(201, bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes", headers,
                                                                   packed.bytes, packed.length}));
        assert_string_equal(bench_header(&r, "Idempotency-Replayed"), i == 0 ? "" : "true");
        if (i == 0) {
            first = strdup(r.body);
            assert_non_null(first);
        } else {
            assert_string_equal(r.body, first);
        }
        bench_reply_free(&r);
    }
    free(first);
    /* A request with the same Idempotency-Key counts as another request if the name or the bytes of
     * any file have changed. */
    for (size_t i = 0; i < 2; i++) {
        file *changed = &files[1];
        *changed = i == 0 ? (file){"b.mtl", NULL, MTL, 0} : (file){"a.mtl", NULL, MTL "\n", 0};
        several packed = pack_as(BOUNDARY, files);
        const char *const headers[] = {"Content-Type", type, "Idempotency-Key", "k", NULL};
        expect_refused(422, "idempotency_mismatch", "another request",
                       bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes", headers,
                                                            packed.bytes, packed.length}));
    }
    bench_free(b);
}

/* --- memory --- */

static void without_memory_nothing_is_made(void **state)
{
    (void)state;
    static const file files[MOST_FILES] = {{"scene", NULL, GLTF("a.bin"), 0}, {"a.bin", NULL, BIN}};
    static const char *const headers[] = {"Content-Type", type, NULL};
    several packed = pack_as(BOUNDARY, files);
    api_bench *b = bench_new();
    failing f = {.lasts = true, .may_succeed = true};
    while (failing_next(&f)) {
        bench_reply r;
        assert_true(f.n <= 10000);
        bool answered = bench_try(
            b, &(bench_request){"POST", "/v1/meshes?id=m", headers, packed.bytes, packed.length},
            &r);
        int status = answered ? r.status : 507;
        failing_pause();
        if (answered) {
            bench_reply_free(&r);
        }
        if (failing_end(&f, status == 201)) {
            bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
        } else {
            assert_int_equal(status, 507);
        }
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_gltf_finds_its_buffers_by_name),
        cmocka_unit_test(a_buffer_that_did_not_come_is_named),
        cmocka_unit_test(an_obj_comes_with_its_library),
        cmocka_unit_test(one_file_is_the_mesh),
        cmocka_unit_test(every_upload_takes_them),
        cmocka_unit_test(a_body_that_is_cut_or_has_no_boundary_is_refused),
        cmocka_unit_test(another_boundary_is_the_same_request),
        cmocka_unit_test(without_memory_nothing_is_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
