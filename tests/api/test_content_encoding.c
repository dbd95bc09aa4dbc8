/* Content codings: request bodies that arrive compressed with gzip or zstd, and answers that the
 * service compresses with them. */
#include "tests/api/request.h"

#include "tests/codings.h"

#include "api/limits.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <cmocka.h>

static const char *const both[] = {"gzip", "zstd"};

#define HEADERS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define GRID         "{\"shape\":\"grid\",\"columns\":90,\"rows\":90}"

static bench_reply expect(int status, bench_reply r)
{
    if (r.status != status) {
        fail_msg("%d instead of %d: %s", r.status, status, r.body);
    }
    return r;
}

static void done(bench_reply r)
{
    bench_reply_free(&r);
}

static void refused(int status, const char *code, const char *detail, bench_reply r)
{
    r = expect(status, r);
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, code);
    if (strstr(r.body, detail) == NULL) {
        fail_msg("no %s in %s", detail, r.body);
    }
    bench_reply_free(&r);
}

static bench_reply get(api_bench *b, const char *target, const char *accept)
{
    return bench_send(b, "GET", target, HEADERS("Accept-Encoding", accept), NULL);
}

/* Sends the request `plain`, which has no headers, with its body compressed by `coding`. Headers
 * for this coding and for the media type `type` are added. */
static bench_reply send_packed(api_bench *b, const char *coding, const char *type,
                               const bench_request *plain)
{
    size_t packed;
    char *bytes = coding_pack(coding, plain->body, plain->length, &packed);
    bench_reply r = bench_send_bytes(
        b,
        &(bench_request){plain->method, plain->target,
                         HEADERS("Content-Encoding", coding, "Content-Type", type), bytes, packed});
    free(bytes);
    return r;
}

static bench_reply send_json(api_bench *b, const char *method, const char *target,
                             const char *coding, const char *body)
{
    return send_packed(b, coding, "application/json",
                       &(bench_request){method, target, NULL, body, strlen(body)});
}

static api_bench *with_grid(void)
{
    api_bench *b = bench_new();
    done(expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, GRID)));
    return b;
}

/* Replaces the body of an answer by its decompressed form. */
static void unfold(bench_reply *r, const char *coding)
{
    assert_string_equal(bench_header(r, "Content-Encoding"), coding);
    size_t length;
    char *plain = coding_unpack(coding, r->body, r->length, &length);
    assert_non_null(plain);
    free(r->body);
    r->body = plain;
    r->length = length;
}

/* --- answers --- */

static const struct {
    const char *target, *accept;
} read[] = {
    {"/v1/meshes/m/content?format=obj", "*/*"},
    {"/v1/meshes/m/content?format=off", "*/*"},
    {"/v1/meshes/m/content?format=ply", "*/*"},
    {"/v1/meshes/m/content?format=ply&encoding=ascii", "*/*"},
    {"/v1/meshes/m/content?format=stl", "*/*"},
    {"/v1/meshes/m/content?format=json", "*/*"},
    {"/v1/meshes/m/geometry", "*/*"},
    {"/v1/meshes/m/vertices?limit=100", "application/json"},
    {"/v1/meshes/m/vertices?limit=10000", "application/json"},
    {"/v1/meshes/m/faces", "application/x-ndjson"},
    {"/v1/meshes/m/boundaries", "application/json"},
};

enum { READ = sizeof read / sizeof *read };

static void answers_unfold_to_what_they_are_plain(void **state)
{
    (void)state;
    api_bench *b = with_grid();
    for (size_t i = 0; i < READ; i++) {
        bench_reply plain = expect(
            200, bench_send(b, "GET", read[i].target, HEADERS("Accept", read[i].accept), NULL));
        assert_string_equal(bench_header(&plain, "Content-Encoding"), "");
        assert_non_null(strstr(bench_header(&plain, "Vary"), "Accept-Encoding"));
        for (size_t c = 0; c < 2; c++) {
            const char *const headers[] = {"Accept", read[i].accept, "Accept-Encoding", both[c],
                                           NULL};
            char tag[128];
            bench_reply r = expect(200, bench_send(b, "GET", read[i].target, headers, NULL));
            assert_true(r.length < plain.length);
            unfold(&r, both[c]);
            assert_int_equal(r.length, plain.length);
            assert_memory_equal(r.body, plain.body, r.length);
            assert_string_equal(bench_header(&r, "Vary"), bench_header(&plain, "Vary"));
            assert_string_equal(bench_header(&r, "Content-Type"),
                                bench_header(&plain, "Content-Type"));
            /* The compressed answer must have a strong entity tag of its own: that of the plain
             * answer, followed by the name of the coding. */
            const char *of_plain = bench_header(&plain, "ETag");
            snprintf(tag, sizeof tag, "%.*s-%s\"", (int)strlen(of_plain) - 1, of_plain, both[c]);
            assert_string_equal(bench_header(&r, "ETag"), tag);
            bench_reply head = expect(200, bench_send(b, "HEAD", read[i].target, headers, NULL));
            assert_string_equal(bench_header(&head, "ETag"), tag);
            assert_string_equal(bench_header(&head, "Content-Encoding"), both[c]);
            bench_reply_free(&head);
            bench_reply_free(&r);
        }
        bench_reply_free(&plain);
    }
    bench_free(b);
}

static void what_is_short_or_live_stays_plain(void **state)
{
    (void)state;
    static const char *const targets[] = {"/livez", "/v1/meshes/m", "/v1/meshes/m/faces/3",
                                          "/v1/meshes/m/events", "/v1/meshes/none"};
    api_bench *b = with_grid();
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        bench_reply r = get(b, targets[i], "gzip, zstd");
        assert_string_equal(bench_header(&r, "Content-Encoding"), "");
        bool live = strstr(targets[i], "events") != NULL;
        assert_string_equal(bench_header(&r, "Vary"), live ? "" : "Accept-Encoding");
        bench_reply_free(&r);
    }
    /* The length of an exported OFF file is not known in advance. The service must still find that
     * this file is too small to be compressed. */
    done(expect(201, bench_send(b, "PUT", "/v1/meshes/c", NULL, "{\"shape\":\"tetrahedron\"}")));
    bench_reply r = expect(200, get(b, "/v1/meshes/c/content?format=off", "zstd"));
    assert_string_equal(bench_header(&r, "Content-Encoding"), "");
    assert_int_equal(api_answer_of(r.exchange)->length, r.length);
    bench_reply_free(&r);
    bench_free(b);
}

/* Even a short answer is compressed if the client refuses the coding `identity`; a client that
 * refuses every coding gets an error. */
static void identity_may_be_refused(void **state)
{
    (void)state;
    api_bench *b = with_grid();
    for (size_t c = 0; c < 2; c++) {
        char accept[40];
        snprintf(accept, sizeof accept, "identity;q=0, %s", both[c]);
        bench_reply r = expect(200, get(b, "/livez", accept));
        unfold(&r, both[c]);
        assert_string_equal(r.body, "{\"status\":\"alive\"}");
        bench_reply_free(&r);
        r = get(b, "/v1/meshes/m/faces/99999", accept);
        assert_int_equal(r.status, 404);
        unfold(&r, both[c]);
        assert_non_null(strstr(r.body, "no_such_element"));
        bench_reply_free(&r);
        refused(406, "not_acceptable", "\"supported\":[\"identity\"]",
                get(b, "/v1/meshes/m/events", accept));
    }
    refused(406, "not_acceptable", "\"supported\":[\"gzip\",\"zstd\",\"identity\"]",
            get(b, "/v1/meshes/m", "*;q=0"));
    bench_free(b);
}

static void tags_of_each_coding_are_good(void **state)
{
    (void)state;
    static const char target[] = "/v1/meshes/m/content?format=obj";
    static const char *const wanted[] = {"identity", "gzip", "zstd"};
    api_bench *b = with_grid();
    for (size_t i = 0; i < 3; i++) {
        bench_reply r = expect(200, get(b, target, wanted[i]));
        char tag[128], list[300];
        snprintf(tag, sizeof tag, "%s", bench_header(&r, "ETag"));
        snprintf(list, sizeof list, "\"other\", W/%s", tag);
        bench_reply_free(&r);
        for (size_t k = 0; k < 3; k++) {
            /* If the client still accepts the coding of its cached copy, the answer is 304 and
             * names the entity tag of that copy. */
            bool good = i == 0 || i == k;
            r = expect(good ? 304 : 200,
                       bench_send(b, "GET", target,
                                  HEADERS("Accept-Encoding", wanted[k], "If-None-Match", list),
                                  NULL));
            if (good) {
                assert_string_equal(bench_header(&r, "ETag"), tag);
                assert_non_null(strstr(bench_header(&r, "Vary"), "Accept-Encoding"));
                assert_string_equal(bench_header(&r, "Content-Encoding"), "");
                assert_int_equal(r.length, 0);
            }
            bench_reply_free(&r);
        }
        /* If-Match compares the revision of the mesh and ignores the coding in the tag. */
        char name[24];
        snprintf(name, sizeof name, "{\"name\":\"%s\"}", wanted[i]);
        for (int again = 0; again < 2; again++) {
            done(expect(again == 0 ? 200 : 412,
                        bench_send(b, "PATCH", "/v1/meshes/m", HEADERS("If-Match", tag), name)));
        }
    }
    bench_free(b);
}

static void answers_may_always_be_plain(void **state)
{
    (void)state;
    static const struct {
        const char *accept;
        int status;
    } rows[] = {{"gzip, zstd", 200}, {"*", 200}, {"gzip, identity;q=0", 406}};
    api_bench *b = with_grid();
    api_service *service =
        api_service_new(bench_store(b), api_routes(), &(api_options){.plain_answers = true});
    assert_non_null(service);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        api_exchange *x =
            api_handle(service,
                       &(api_request){.method = "GET",
                                      .path = "/v1/meshes/m/boundaries",
                                      .query = "",
                                      .headers = {[API_HEADER_ACCEPT_ENCODING] = rows[i].accept}},
                       NULL, 0);
        assert_non_null(x);
        const api_answer *answer = api_answer_of(x);
        assert_int_equal(answer->status, rows[i].status);
        for (size_t h = 0; h < answer->header_count; h++) {
            assert_string_not_equal(answer->headers[h].name, "Content-Encoding");
            assert_string_not_equal(answer->headers[h].name, "Vary");
        }
        api_free(x);
    }
    api_service_free(service);
    bench_free(b);
}

/* --- bodies --- */

static void every_route_with_a_body_takes_codings(void **state)
{
    (void)state;
    static const struct {
        const char *method, *target, *body;
        int status;
    } rows[] = {
        {"POST", "/v1/meshes", "{\"shape\":\"cube\"}", 201},
        {"PUT", "/v1/meshes/n", "{\"shape\":\"cube\"}", 201},
        {"PUT", "/v1/meshes/n", "{\"shape\":\"cube\",\"size\":2}", 200},
        {"PATCH", "/v1/meshes/n", "{\"name\":\"x\"}", 200},
        {"POST", "/v1/meshes/n/copy", "{\"id\":\"k\"}", 201},
        {"PUT", "/v1/meshes/n/attributes/faces/a", "{\"type\":\"bool\"}", 201},
        {"PATCH", "/v1/meshes/n/attributes/faces/a", "{\"ids\":[0],\"value\":true}", 200},
        {"POST", "/v1/meshes/n/query", "{\"queries\":[{\"get\":{\"face\":0}}]}", 200},
        {"POST", "/v1/meshes/n/traverse", "{\"walk\":\"loop\",\"from\":{\"halfedge\":0}}", 200},
        {"POST", "/v1/meshes/n/edits", "{\"op\":\"face_poke\",\"face\":0}", 200},
        {"POST", "/v1/meshes/n/undo", "{}", 200},
        {"POST", "/v1/meshes/n/redo", "{\"steps\":1}", 200},
        {"POST", "/v1/meshes/n/edits", "{\"op\":\"face_poke\",\"face\":99}", 422},
        {"POST", "/v1/meshes/n/edits", "{\"op\":", 400},
        {"DELETE", "/v1/meshes/n", NULL, 204},
        {"DELETE", "/v1/meshes/k", NULL, 204},
    };
    api_bench *b = bench_new();
    for (size_t c = 0; c < 2; c++) {
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            done(expect(rows[i].status,
                        rows[i].body == NULL
                            ? bench_send(b, rows[i].method, rows[i].target, NULL, NULL)
                            : send_json(b, rows[i].method, rows[i].target, both[c], rows[i].body)));
        }
    }
    bench_free(b);
}

static void every_format_comes_back(void **state)
{
    (void)state;
    static const struct {
        const char *target, *type;
    } files[] = {
        {"/v1/meshes/m/content?format=obj", "model/obj"},
        {"/v1/meshes/m/content?format=off", "model/x-off"},
        {"/v1/meshes/m/content?format=ply&encoding=ascii", "model/ply"},
        {"/v1/meshes/m/content?format=ply", "application/ply"},
        {"/v1/meshes/m/content?format=ply&encoding=binary_big_endian", "application/octet-stream"},
        {"/v1/meshes/m/content?format=stl", "model/stl"},
        {"/v1/meshes/m/content?format=stl&encoding=ascii", "model/stl"},
        {"/v1/meshes/m/content?format=json", "application/json"},
    };
    api_bench *b = with_grid();
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        bench_reply plain = expect(200, bench_send(b, "GET", files[i].target, NULL, NULL));
        for (size_t c = 0; c < 2; c++) {
            /* The service must read a body that it compressed itself, and one that another program
             * compressed. */
            bench_reply file = expect(200, get(b, files[i].target, both[c]));
            char again[100];
            snprintf(again, sizeof again, "/v1/meshes/again%s", strrchr(files[i].target, '/'));
            done(expect(201,
                        bench_send_bytes(b, &(bench_request){"PUT", "/v1/meshes/again",
                                                             HEADERS("Content-Encoding", both[c],
                                                                     "Content-Type", files[i].type),
                                                             file.body, file.length})));
            bench_reply back = expect(200, bench_send(b, "GET", again, NULL, NULL));
            assert_int_equal(back.length, plain.length);
            assert_memory_equal(back.body, plain.body, plain.length);
            bench_reply_free(&back);
            bench_reply_free(&file);
            done(expect(200, send_packed(b, both[c], files[i].type,
                                         &(bench_request){"PUT", "/v1/meshes/again", NULL,
                                                          plain.body, plain.length})));
            done(expect(204, bench_send(b, "DELETE", "/v1/meshes/again", NULL, NULL)));
        }
        bench_reply_free(&plain);
    }
    bench_free(b);
}

/* Returns a text that compresses well, but not beyond the ratio at which the server refuses it as a
 * decompression bomb. */
static char *long_text(size_t length)
{
    char *text = malloc(length + 1);
    assert_non_null(text);
    uint32_t random = 7;
    for (size_t i = 0; i < length; i++) {
        random = random * 1664525 + 1013904223;
        text[i] = " \n"[random >> 31];
    }
    text[length] = '\0';
    return text;
}

static void what_unfolds_counts_against_the_limits(void **state)
{
    (void)state;
    api_bench *b = with_grid();
    char *text = long_text(9 << 20);
    for (size_t c = 0; c < 2; c++) {
        /* The maximum length of a body applies to the decompressed body: a length equal to it is
         * accepted, one byte more is refused. */
        text[API_MAX_CONTROL] = '\0';
        memcpy(text, "{\"walk\":\"loop\",\"from\":{\"halfedge\":0}}", 37);
        done(expect(200, send_json(b, "POST", "/v1/meshes/m/traverse", both[c], text)));
        text[API_MAX_CONTROL] = ' ';
        text[API_MAX_CONTROL + 1] = '\0';
        refused(413, "body_too_large", "decompresses to more than 1048576 bytes",
                send_json(b, "POST", "/v1/meshes/m/traverse", both[c], text));
        text[API_MAX_CONTROL + 1] = ' ';
        refused(413, "body_too_large", "decompresses to more than 8388608 bytes",
                send_json(b, "POST", "/v1/meshes/m/edits", both[c], text));
        memset(text, ' ', 37);
        refused(413, "body_too_large", "decompresses to more than 8388608 bytes",
                send_json(b, "POST", "/v1/meshes", both[c], text));
        memset(text, ' ', 8 << 20);
        text[8 << 20] = '\0';
        refused(413, "body_too_large", "larger than the allowed 100 times its compressed size",
                send_json(b, "POST", "/v1/meshes", both[c], text));
        refused(400, "unexpected_body", "a request with the method GET must not have a body",
                bench_send(b, "GET", "/livez", HEADERS("Content-Encoding", both[c]), "x"));
        free(text);
        text = long_text(9 << 20);
    }
    free(text);
    bench_free(b);
}

static void what_is_not_the_coding_is_refused(void **state)
{
    (void)state;
    api_bench *b = with_grid();
    const char *const json = "{\"shape\":\"cube\"}";
    static const char *const bad[] = {"br",         "deflate",   "compress",
                                      "gzip, gzip", "gzip,zstd", "gzip;q=1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        bench_reply r = expect(
            415, bench_send(b, "POST", "/v1/meshes", HEADERS("Content-Encoding", bad[i]), json));
        assert_string_equal(bench_header(&r, "Accept-Encoding"), "gzip, zstd");
        refused(415, "unsupported_encoding", "\"supported\":[\"gzip\",\"zstd\",\"identity\"]", r);
    }
    /* A 415 about the media type must not have the header Accept-Encoding, which a 415 about the
     * content coding has. */
    bench_reply other = expect(
        415, bench_send(b, "POST", "/v1/meshes", HEADERS("Content-Type", "text/plain"), json));
    assert_string_equal(bench_header(&other, "Accept-Encoding"), "");
    bench_reply_free(&other);
    for (size_t c = 0; c < 2; c++) {
        size_t length;
        char *packed = coding_pack(both[c], json, strlen(json), &length);
        const char *const headers[] = {"Content-Encoding", both[c], NULL};
        refused(400, "bad_encoding", "byte 0 of the",
                bench_send(b, "POST", "/v1/meshes", headers, json));
        refused(400, "bad_encoding", "the body ends before",
                bench_send_bytes(
                    b, &(bench_request){"POST", "/v1/meshes", headers, packed, length - 1}));
        refused(400, "missing_body", "",
                bench_send_bytes(b, &(bench_request){"POST", "/v1/meshes", headers, "", 0}));
        packed[length - 1] ^= 1;
        if (strcmp(both[c], "gzip") == 0) {
            refused(400, "bad_encoding", "incorrect length check",
                    bench_send_bytes(
                        b, &(bench_request){"POST", "/v1/meshes", headers, packed, length}));
        }
        free(packed);
        /* A compressed empty body counts as an empty body. */
        refused(400, "missing_body", "", send_json(b, "POST", "/v1/meshes", both[c], ""));
        done(expect(409, send_json(b, "POST", "/v1/meshes/m/undo", both[c], "")));
    }
    bench_reply r = expect(200, bench_send(b, "GET", "/v1/meshes", NULL, NULL));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "items")), 1);
    bench_reply_free(&r);
    bench_free(b);
}

/* Begins the upload of an OBJ file compressed with zstd. Only the frame header is sent, which
 * declares a window of 8 MiB; the file's bytes are still to come. */
static api_exchange *begin_wide(api_bench *b, api_step *step)
{
    static const char frame[] = {0x28,   (char)0xB5, 0x2F, (char)0xFD, 0,   13 << 3,
                                 2 << 3, 0,          0,    '#',        '\n'};
    const api_request request = {
        .method = "POST",
        .path = "/v1/meshes",
        .query = "",
        .request_id = "test",
        .headers =
            {[API_HEADER_CONTENT_ENCODING] = "zstd", [API_HEADER_CONTENT_TYPE] = "model/obj"},
        .has_body = true};
    size_t used;
    api_exchange *x = api_begin(bench_service(b), &request, step);
    assert_non_null(x);
    if (*step == API_MORE) {
        *step = api_body(x, frame, sizeof frame, &used);
    }
    return x;
}

/* Sends the next block of zeros of a body that begin_wide() began: 1 KiB when decompressed. */
static api_step more_of(api_exchange *x)
{
    /* a run-length block: the last byte is repeated 1025 times */
    static const char block[] = {2 | 1 << 3, 32, 0, '\n'};
    size_t used;
    return api_body(x, block, sizeof block, &used);
}

static void expect_gave_way(api_exchange *x)
{
    bool later = false;
    const api_answer *a = api_answer_of(x);
    for (size_t i = 0; i < a->header_count; i++) {
        later |= strcmp(a->headers[i].name, "Retry-After") == 0;
    }
    assert_int_equal(a->status, 503);
    assert_non_null(strstr(a->bytes, "\"code\":\"too_many_coded_bodies\""));
    assert_true(later);
}

/* Slow uploads share a limited memory for the windows of their decoders. While one upload
 * continues, many others begin and then send nothing: the service must end the idle uploads, and
 * not the upload that makes progress. */
static void slow_senders_give_way_to_others(void **state)
{
    (void)state;
    enum { MANY = 4 * (API_MAX_DECOMPRESSING >> API_DECOMPRESS_WINDOW) };
    api_bench *b = bench_new();
    api_exchange *open[MANY];
    api_step step;
    api_exchange *steady = begin_wide(b, &step);
    assert_int_equal(step, API_MORE);
    for (size_t i = 0; i < MANY; i++) {
        open[i] = begin_wide(b, &step);
        assert_int_equal(step, API_MORE);
        assert_int_equal(more_of(steady), API_MORE);
        assert_int_equal(more_of(steady), API_MORE);
    }
    done(expect(201, send_json(b, "POST", "/v1/meshes", "gzip", "{\"shape\":\"cube\"}")));
    size_t gone = 0;
    for (size_t i = 0; i < MANY; i++) {
        if (more_of(open[i]) != API_MORE) {
            expect_gave_way(open[i]);
            /* the uploads that sent nothing for longest were ended first */
            assert_int_equal(gone, i);
            gone++;
        }
    }
    assert_true(gone >= MANY - (API_MAX_DECOMPRESSING >> API_DECOMPRESS_WINDOW) && gone < MANY);
    assert_int_equal(more_of(steady), API_MORE);
    api_free(steady);
    for (size_t i = 0; i < MANY; i++) {
        api_free(open[i]);
    }
    bench_free(b);
}

/* An Idempotency-Key identifies the decompressed body: a request that repeats the body in another
 * coding, or uncompressed, counts as the same request. */
static void a_key_is_of_the_unfolded_body(void **state)
{
    (void)state;
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":0}";
    api_bench *b = with_grid();
    const char *const plain[] = {"Idempotency-Key", "k", NULL};
    done(expect(200, bench_send(b, "POST", "/v1/meshes/m/edits", plain, poke)));
    for (size_t c = 0; c < 2; c++) {
        size_t length;
        char *packed = coding_pack(both[c], poke, sizeof poke - 1, &length);
        bench_reply r = expect(
            200, bench_send_bytes(
                     b, &(bench_request){"POST", "/v1/meshes/m/edits",
                                         HEADERS("Idempotency-Key", "k", "Content-Encoding",
                                                 both[c], "Content-Type", "application/json"),
                                         packed, length}));
        assert_string_equal(bench_header(&r, "Idempotency-Replayed"), "true");
        assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 2);
        bench_reply_free(&r);
        free(packed);
        /* The stored answer is uncompressed, so that each client that repeats the request gets it
         * in a coding that it accepts. */
        char accept[40];
        snprintf(accept, sizeof accept, "%s, identity;q=0", both[c]);
        r = expect(200,
                   bench_send(b, "POST", "/v1/meshes/m/edits",
                              HEADERS("Idempotency-Key", "k", "Accept-Encoding", accept), poke));
        assert_string_equal(bench_header(&r, "Idempotency-Replayed"), "true");
        unfold(&r, both[c]);
        assert_non_null(strstr(r.body, "\"revision\":2"));
        bench_reply_free(&r);
    }
    refused(
        422, "idempotency_mismatch", "",
        bench_send(b, "POST", "/v1/meshes/m/edits", plain, "{\"op\":\"face_poke\",\"face\":1}"));
    bench_free(b);
}

/* A job reads a compressed body like any other body, and its result is stored uncompressed. */
static void a_job_of_a_coded_upload(void **state)
{
    (void)state;
    api_bench *b = with_grid();
    bench_reply file = expect(200, get(b, "/v1/meshes/m/content?format=obj", "zstd"));
    bench_reply r = expect(
        202,
        bench_send_bytes(b, &(bench_request){"PUT", "/v1/meshes/j",
                                             HEADERS("Content-Encoding", "zstd", "Content-Type",
                                                     "model/obj", "Prefer", "respond-async",
                                                     "Accept-Encoding", "gzip, identity;q=0"),
                                             file.body, file.length}));
    unfold(&r, "gzip");
    char location[80];
    snprintf(location, sizeof location, "%s", bench_header(&r, "Location"));
    bench_reply_free(&r);
    bench_reply_free(&file);
    bench_run_jobs(b, 1);
    r = expect(200, bench_send(b, "GET", location, NULL, NULL));
    const cJSON *result = cJSON_GetObjectItem(r.json, "result");
    assert_non_null(result);
    const cJSON *counts = cJSON_GetObjectItem(result, "counts");
    assert_int_equal(cJSON_GetObjectItem(counts, "faces")->valueint, 8100);
    bench_reply_free(&r);
    bench_free(b);
}

/* --- memory --- */

/* Lets each allocation of the request fail in turn: the answer must be the expected one or 507. */
static void starve(api_bench *b, const bench_request *request, const bench_reply *expected)
{
    failing f = {.may_succeed = true, .what = request->target};
    while (failing_next(&f)) {
        bench_reply r;
        bool sent = bench_try(b, request, &r);
        failing_end(&f, sent && r.status == expected->status);
        if (!sent) {
            continue;
        }
        if (r.status != expected->status) {
            assert_int_equal(r.status, 507);
        } else if (strcmp(bench_header(&r, "Content-Encoding"), "") == 0) {
            assert_int_equal(r.length, expected->length);
            assert_memory_equal(r.body, expected->body, r.length);
        } else {
            unfold(&r, bench_header(&r, "Content-Encoding"));
            assert_int_equal(r.length, expected->length);
            assert_memory_equal(r.body, expected->body, r.length);
        }
        bench_reply_free(&r);
    }
    print_message("%s %s: %ld allocations failed\n", request->method, request->target, f.n - 1);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const char question[] = "{\"queries\":[{\"get\":{\"face\":0}},{\"get\":{\"face\":1}},"
                                   "{\"relation\":\"vertices\",\"of\":{\"vertices\":\"all\"}}]}";
    api_bench *b = with_grid();
    for (size_t c = 0; c < 2; c++) {
        const char *const accept[] = {"Accept-Encoding", both[c], NULL};
        for (size_t i = 0; i < READ; i++) {
            if (strstr(read[i].target, "stl") != NULL) {
                /* the STL reader makes allocations for each corner, too many to let each of them
                 * fail */
                continue;
            }
            bench_reply plain = expect(200, bench_send(b, "GET", read[i].target, NULL, NULL));
            starve(b, &(bench_request){"GET", read[i].target, accept, NULL, 0}, &plain);
            bench_reply_free(&plain);
        }
        size_t length;
        char *packed = coding_pack(both[c], question, sizeof question - 1, &length);
        bench_reply plain =
            expect(200, bench_send(b, "POST", "/v1/meshes/m/query", NULL, question));
        starve(b,
               &(bench_request){"POST", "/v1/meshes/m/query",
                                HEADERS("Accept-Encoding", both[c], "Content-Encoding", both[c],
                                        "Content-Type", "application/json"),
                                packed, length},
               &plain);
        bench_reply_free(&plain);
        free(packed);
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_unfold_to_what_they_are_plain),
        cmocka_unit_test(what_is_short_or_live_stays_plain),
        cmocka_unit_test(identity_may_be_refused),
        cmocka_unit_test(tags_of_each_coding_are_good),
        cmocka_unit_test(answers_may_always_be_plain),
        cmocka_unit_test(every_route_with_a_body_takes_codings),
        cmocka_unit_test(every_format_comes_back),
        cmocka_unit_test(what_unfolds_counts_against_the_limits),
        cmocka_unit_test(what_is_not_the_coding_is_refused),
        cmocka_unit_test(slow_senders_give_way_to_others),
        cmocka_unit_test(a_key_is_of_the_unfolded_body),
        cmocka_unit_test(a_job_of_a_coded_upload),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
