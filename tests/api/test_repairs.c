/* Repairs of imported meshes. A refusal must name the repairs with which the body would be
 * accepted, the body must be accepted with them, and the report of the import must list what each
 * of them did. */
#include "tests/api/request.h"

#include "unit/fixture.h"
#include "tests/failing.h"

#include <dirent.h>
#include <strings.h>

static const char OCTETS[] = "application/octet-stream";

static bench_reply expect(int status, bench_reply r)
{
    if (r.status != status) {
        fail_msg("%d instead of %d: %s", r.status, status, r.body);
    }
    return r;
}

static bench_reply post(api_bench *b, const char *query, const char *type, const char *body,
                        size_t length)
{
    char target[200];
    const char *const headers[] = {"Content-Type", type, "Prefer", "wait=600", NULL};
    snprintf(target, sizeof target, "/v1/meshes%s", query);
    return bench_send_bytes(b, &(bench_request){"POST", target, headers, body, length});
}

static bench_reply post_json(api_bench *b, const char *query, const char *body)
{
    return post(b, query, "application/json", body, strlen(body));
}

/* Builds the query "?repair=a,b" from the repairs that the refusal names; returns false if the
 * refusal names none. */
static bool named_repairs(const bench_reply *r, char query[120])
{
    const cJSON *list = cJSON_GetObjectItem(r->json, "repair"), *one;
    size_t used = (size_t)snprintf(query, 120, "?repair=");
    bool first = true;
    cJSON_ArrayForEach(one, list)
    {
        used +=
            (size_t)snprintf(query + used, 120 - used, "%s%s", first ? "" : ",", one->valuestring);
        first = false;
    }
    return !first;
}

static void expect_valid(api_bench *b, const bench_reply *created)
{
    char target[100];
    snprintf(target, sizeof target, "%s/check", bench_header(created, "Location"));
    bench_reply r = expect(200, bench_send(b, "GET", target, NULL, NULL));
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(r.json, "valid")));
    bench_reply_free(&r);
}

/* Requires that the body is refused with the error code `code`, that the refusal names exactly
 * `repairs`, and that the body is accepted when these repairs are requested. */
static void expect_mended(api_bench *b, const char *type, const char *body, const char *code,
                          const char *repairs)
{
    size_t length = strlen(body);
    char query[120];
    bench_reply r = post(b, "", type, body, length);
    if (r.status != 422 || !named_repairs(&r, query)) {
        fail_msg("%s: %d %s", body, r.status, r.body);
    }
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, code);
    assert_string_equal(query + strlen("?repair="), repairs);
    if (strstr(cJSON_GetObjectItem(r.json, "detail")->valuestring, query + 1) == NULL) {
        fail_msg("%s", r.body);
    }
    bench_reply_free(&r);
    r = expect(201, post(b, query, type, body, length));
    expect_valid(b, &r);
    bench_reply_free(&r);
}

/* --- each refusal, in each file format --- */

typedef struct specimen {
    const char *code, *repairs;
    int vertices;
    const char *faces; /* faces joined by commas, one character for each vertex */
} specimen;

static const specimen specimens[] = {
    {"nonmanifold_edge", "split", 5, "012,103,014"},
    {"nonmanifold_edge", "split", 5, "021,032,013,123,132,124,234,314"},
    {"nonmanifold_edge", "drop_duplicates", 4, "021,032,013,123,132"},
    {"repeated_corner", "drop_degenerate", 4, "012,0230"},
    {"repeated_corner", "drop_degenerate,split", 6, "010,012,103,014"},
    {"repeated_corner", "drop_degenerate,orient", 4, "010,012,123"},
    {"orientation", "orient", 4, "012,123"},
    {"orientation", "drop_duplicates", 3, "012,012"},
    {"orientation", "orient,split", 5, "012,123,234,340,401"},
    {"closed_fan", "split", 7, "021,032,013,123,354,365,346,456"},
    {"closed_fan", "split", 6, "021,032,013,123,345"},
};

static const char *const formats[] = {"json", "obj", "off", "ply"};
static const char *const types[] = {"application/json", "model/obj", "model/x-off", "model/ply"};

static size_t faces_of(const char *faces)
{
    size_t count = 1;
    for (; *faces != '\0'; faces++) {
        count += *faces == ',';
    }
    return count;
}

/* Writes vertices, the i-th at (i, i*i, i*i*i) so that all positions differ. */
static size_t write_vertices(char *text, size_t room, const char *format, int count)
{
    size_t used = 0;
    bool json = strcmp(format, "json") == 0;
    for (int i = 0; i < count; i++) {
        used += (size_t)snprintf(text + used, room - used,
                                 json                         ? "%s[%d,%d,%d]"
                                 : strcmp(format, "obj") == 0 ? "%sv %d %d %d\n"
                                                              : "%s%d %d %d\n",
                                 json && i > 0 ? "," : "", i, i * i, i * i * i);
    }
    return used;
}

static size_t write_faces(char *text, size_t room, const char *format, const char *faces)
{
    bool json = strcmp(format, "json") == 0, obj = strcmp(format, "obj") == 0;
    size_t used = 0;
    for (const char *p = faces;; p++) {
        size_t degree = strcspn(p, ",");
        used += (size_t)snprintf(text + used, room - used, json ? "[" : obj ? "f" : "%zu", degree);
        for (size_t i = 0; i < degree; i++) {
            used += (size_t)snprintf(text + used, room - used, "%s%d",
                                     json ? (i > 0 ? "," : "") : " ", p[i] - '0' + obj);
        }
        p += degree;
        used += (size_t)snprintf(text + used, room - used, "%s",
                                 !json       ? "\n"
                                 : *p == ',' ? "],"
                                             : "]");
        if (*p == '\0') {
            return used;
        }
    }
}

static void write_file(char *text, size_t room, const char *format, const specimen *s)
{
    size_t used = 0;
    bool json = strcmp(format, "json") == 0;
    if (json) {
        used += (size_t)snprintf(text, room, "{\"vertices\":[");
    } else if (strcmp(format, "off") == 0) {
        used += (size_t)snprintf(text, room, "OFF\n%d %zu 0\n", s->vertices, faces_of(s->faces));
    } else if (strcmp(format, "ply") == 0) {
        used += (size_t)snprintf(text, room,
                                 "ply\nformat ascii 1.0\nelement vertex %d\nproperty double x\n"
                                 "property double y\nproperty double z\nelement face %zu\n"
                                 "property list uchar int vertex_indices\nend_header\n",
                                 s->vertices, faces_of(s->faces));
    }
    used += write_vertices(text + used, room - used, format, s->vertices);
    if (json) {
        used += (size_t)snprintf(text + used, room - used, "],\"faces\":[");
    }
    used += write_faces(text + used, room - used, format, s->faces);
    if (json) {
        snprintf(text + used, room - used, "]}");
    }
}

static void the_repairs_named_let_it_pass(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof specimens / sizeof *specimens; i++) {
        for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
            char text[2000];
            write_file(text, sizeof text, formats[f], &specimens[i]);
            expect_mended(b, types[f], text, specimens[i].code, specimens[i].repairs);
        }
    }
    static const char few[] = "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1],[0,1,2]]}";
    expect_mended(b, types[0], few, "too_few_corners", "drop_degenerate");
    static const char stl[] = "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n"
                              "facet\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 1 0\nendfacet\n"
                              "facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendfacet\n"
                              "endsolid\n";
    expect_mended(b, "model/stl", stl, "repeated_corner", "drop_degenerate,orient");
    bench_free(b);
}

static void what_no_repair_mends_names_none(void **state)
{
    (void)state;
    static const struct {
        const char *type, *body;
    } rows[] = {
        {"application/json", "{\"vertices\":[[0,0,0]],\"faces\":[[0,0,0],[0,1,2]]}"},
        {"application/json", "{\"vertices\":[[0,0,0]],"},
        {"model/obj", "v 0 0 0\nf 1 2 3\n"},
        {"model/obj", "v 0 0 nan\n"},
        {"model/x-off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n"},
    };
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (int asked = 0; asked < 2; asked++) {
            const char *query =
                asked == 0 ? "" : "?repair=weld,drop_degenerate,drop_duplicates,orient,split,fill";
            bench_reply r = post(b, query, rows[i].type, rows[i].body, strlen(rows[i].body));
            assert_true(r.status == 400 || r.status == 422);
            assert_null(cJSON_GetObjectItem(r.json, "repair"));
            bench_reply_free(&r);
        }
    }
    bench_free(b);
}

static void every_file_of_the_corpus_that_is_refused(void **state)
{
    (void)state;
    const char *corpus = getenv("CORPUS");
    char path[400];
    snprintf(path, sizeof path, "%s/files", corpus != NULL ? corpus : "../shared/corpus");
    DIR *folder = opendir(path);
    if (folder == NULL) {
        skip();
    }
    api_bench *b = bench_new();
    size_t mended = 0;
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char name[700], query[120];
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        FILE *file = entry->d_name[0] == '.' ? NULL : fopen(name, "rb");
        if (file == NULL) {
            continue;
        }
        enum { ROOM = 1 << 20 };
        char *body = malloc(ROOM);
        assert_non_null(body);
        size_t length = fread(body, 1, ROOM, file);
        fclose(file);
        bench_reply r = post(b, "", OCTETS, body, length);
        if (r.status == 422 && named_repairs(&r, query)) {
            bench_reply again = post(b, query, OCTETS, body, length);
            if (again.status != 201) {
                fail_msg("%s%s: %s", name, query, again.body);
            }
            expect_valid(b, &again);
            bench_reply_free(&again);
            mended++;
        } else if (r.status == 422) {
            const char *code = cJSON_GetObjectItem(r.json, "code")->valuestring;
            assert_true(strcmp(code, "bad_index") == 0 || strcmp(code, "unsupported") == 0);
        }
        bench_reply_free(&r);
        free(body);
    }
    closedir(folder);
    print_message("note: %zu files refused, then mended by the repairs their refusal named\n",
                  mended);
    assert_true(mended > 0);
    bench_free(b);
}

/* --- the report of the import --- */

static const cJSON *repair_at(const bench_reply *r, int i, const char *name)
{
    const cJSON *list = cJSON_GetObjectItem(cJSON_GetObjectItem(r->json, "import"), "repairs");
    const cJSON *one = cJSON_GetArrayItem(list, i);
    assert_non_null(one);
    assert_string_equal(cJSON_GetObjectItem(one, "repair")->valuestring, name);
    return one;
}

static void expect_member(const cJSON *object, const char *member, const char *json)
{
    char *text = cJSON_PrintUnformatted(cJSON_GetObjectItem(object, member));
    assert_non_null(text);
    assert_string_equal(text, json);
    cJSON_free(text);
}

/* The vertices 3 and 4 are at one position; the faces are on lines 7 to 13. */
static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 1\nv 1 1 1\n"
                          "f 1 2 3\nf 2 3 1\nf 4 4 2\nf 4 2 1\nf 1 4 3\nf 2 5 6\nf 2 6 5\n";

static void each_repair_accounts_for_itself(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = expect(201, post(b,
                                     "?repair=fill,split,orient,drop_duplicates,drop_degenerate,"
                                     "weld&hole_edges=4&tolerance=0.25",
                                     "model/obj", obj, strlen(obj)));
    const cJSON *report = cJSON_GetObjectItem(r.json, "import");
    expect_member(report, "vertices", "6");
    expect_member(report, "faces", "7");
    const cJSON *one = repair_at(&r, 0, "weld");
    expect_member(one, "count", "1");
    expect_member(one, "tolerance", "0.25");
    expect_member(one, "gone", "[4]");
    expect_member(one, "into", "[3]");
    expect_member(one, "lines", "[5]");
    one = repair_at(&r, 1, "drop_degenerate");
    expect_member(one, "count", "1");
    expect_member(one, "gone", "[2]");
    expect_member(one, "lines", "[9]");
    expect_member(one, "mended", "0");
    expect_member(one, "faces", "[]");
    one = repair_at(&r, 2, "drop_duplicates");
    expect_member(one, "count", "2");
    expect_member(one, "gone", "[1,6]");
    expect_member(one, "into", "[0,3]");
    expect_member(one, "lines", "[8,13]");
    one = repair_at(&r, 3, "orient");
    expect_member(one, "not_orientable", "0");
    one = repair_at(&r, 4, "split");
    expect_member(one, "vertices", "0");
    expect_member(one, "parents", "{\"vertices\":[]}");
    one = repair_at(&r, 5, "fill");
    expect_member(one, "hole_edges", "4");
    expect_valid(b, &r);
    bench_reply_free(&r);
    bench_free(b);
}

/* The file has a quadrilateral that repeats a corner and so is a triangle, a face that is only a
 * line, and a ring of quadrilaterals that is written as one face. */
static void degenerate_faces_that_keep_an_area_are_named(void **state)
{
    (void)state;
    static const char text[] = "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\n"
                               "v 1 2 0\nf 1 2 3 4 1 5 8 7 6 5\nf 5 5 6\nf 5 6 7 7\n";
    api_bench *b = bench_new();
    bench_reply r =
        expect(201, post(b, "?repair=drop_degenerate", "model/obj", text, strlen(text)));
    expect_member(cJSON_GetObjectItem(r.json, "counts"), "faces", "9");
    expect_member(r.json, "area", "8.5");
    const cJSON *one = repair_at(&r, 0, "drop_degenerate");
    expect_member(one, "count", "1");
    expect_member(one, "gone", "[1]");
    expect_member(one, "lines", "[10]");
    expect_member(one, "mended", "2");
    expect_member(one, "faces", "[0,2]");
    expect_valid(b, &r);
    bench_reply_free(&r);
    bench_free(b);
}

static void copies_and_turned_faces_are_named(void **state)
{
    (void)state;
    static const specimen s = {NULL, NULL, 8, "021,032,013,213,354,365,346,456,107"};
    char text[1000];
    api_bench *b = bench_new();
    write_file(text, sizeof text, "json", &s);
    bench_reply r = expect(201, post_json(b, "?repair=split,orient", text));
    const cJSON *one = repair_at(&r, 0, "orient");
    expect_member(one, "count", "1");
    expect_member(one, "components", "1");
    expect_member(one, "faces", "[3]");
    one = repair_at(&r, 1, "split");
    expect_member(one, "count", "3");
    expect_member(one, "vertices", "3");
    expect_member(one, "parents", "{\"vertices\":[[8,3],[9,1],[10,0]]}");
    bench_reply_free(&r);
    bench_free(b);
}

static void a_band_that_cannot_be_oriented_is_told(void **state)
{
    (void)state;
    static const specimen s = {NULL, NULL, 5, "012,123,234,340,401"};
    char text[1000], query[120];
    api_bench *b = bench_new();
    write_file(text, sizeof text, "obj", &s);
    bench_reply r = expect(422, post(b, "?repair=orient", "model/obj", text, strlen(text)));
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "not_orientable");
    assert_string_equal(
        cJSON_GetObjectItem(cJSON_GetObjectItem(r.json, "element"), "kind")->valuestring, "face");
    assert_memory_equal(cJSON_GetObjectItem(r.json, "detail")->valuestring, "line ", 5);
    assert_true(named_repairs(&r, query));
    assert_string_equal(query, "?repair=orient,split");
    bench_reply_free(&r);
    r = expect(201, post(b, query, "model/obj", text, strlen(text)));
    expect_member(repair_at(&r, 0, "orient"), "not_orientable", "1");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(repair_at(&r, 0, "orient"), "clashes")),
                     1);
    bench_reply_free(&r);
    bench_free(b);
}

/* If the mesh is refused after some repairs, the refusal must still name the element numbers and
 * lines of the file. */
static void a_refusal_after_repairs_names_the_file(void **state)
{
    (void)state;
    static const char body[] = "v 0 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\n"
                               "f 1 2 3\nf 3 4 5\nf 3 4 6\n";
    api_bench *b = bench_new();
    bench_reply r =
        expect(422, post(b, "?repair=drop_degenerate,weld", "model/obj", body, strlen(body)));
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "orientation");
    if (strstr(r.body, "line 9: face 2, edge 2-3:") == NULL) {
        fail_msg("%s", r.body);
    }
    expect_member(cJSON_GetObjectItem(r.json, "element"), "id", "2");
    expect_member(r.json, "repair", "[\"weld\",\"drop_degenerate\",\"orient\"]");
    bench_reply_free(&r);
    bench_free(b);
}

/* Returns a file with two faces that repeat a corner among many correct ones, and with one face so
 * large that checking it allocates memory. */
static char *broken_file(size_t *length)
{
    enum { FACES = 20000, LARGE = 40 };
    char *text;
    FILE *out = open_memstream(&text, length);
    assert_non_null(out);
    for (int i = 0; i < LARGE; i++) {
        fprintf(out, "v %d %d 0\n", i, i * i);
    }
    fputs("f 1 2 2\nf", out);
    for (int i = 1; i <= LARGE; i++) {
        fprintf(out, " %d", i);
    }
    for (int i = 0; i < FACES; i++) {
        fprintf(out, "\nf %d %d %d", 1 + i % 30, 2 + i % 30, 3 + i % 30);
    }
    fputs("\nf 3 4 4\n", out);
    fclose(out);
    return text;
}

/* Returns false, which cancels the request, in the n-th call and in all later ones. `context`
 * points to n. If n is 0, it always returns true. */
static bool count_down(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    return *(int *)context == 0 || --*(int *)context > 0;
}

/* Uploads the file. `*left` is counted down at each progress message; at 0 the request is
 * cancelled. Returns the status of the answer; if it is 422, `*total` becomes the number of
 * defects. */
static int upload_broken(api_bench *b, const char *text, size_t length, int *left, int *total)
{
    const api_request request = {
        .method = "POST",
        .path = "/v1/meshes",
        .query = "",
        .request_id = "test",
        .headers = {[API_HEADER_CONTENT_TYPE] = "model/obj", [API_HEADER_PREFER] = "wait=600"},
        .has_length = true,
        .length = length,
        .has_body = true};
    api_step step;
    *total = 0;
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    if (x == NULL) {
        return 507;
    }
    for (size_t at = 0, used; step == API_MORE && at < length; at += used) {
        step = api_body(x, text + at, length - at, &used);
    }
    step = step == API_MORE ? api_end(x) : step;
    if (step == API_WORK) {
        api_set_progress(x, count_down, left);
        step = api_work(x);
    }
    assert_int_equal(step, API_READY);
    int status = api_answer_of(x)->status;
    if (status == 422) {
        /* searches the text instead of parsing it, because the allocations of cJSON would fail,
         * too */
        const char *said = strstr(api_answer_of(x)->bytes, "\"total\":");
        assert_non_null(said);
        *total = (int)strtol(said + strlen("\"total\":"), NULL, 10);
    }
    api_free(x);
    return status;
}

static void what_is_given_up_does_not_tell_the_defects_so_far(void **state)
{
    (void)state;
    size_t length;
    char *text = broken_file(&length);
    api_bench *b = bench_new();
    int status, total, given_up = 0;
    for (int n = 1;; n++) {
        int left = n;
        status = upload_broken(b, text, length, &left, &total);
        if (left > 0) {
            break; /* the request was finished before count_down() was called n times */
        }
        assert_int_equal(status, 503);
        given_up++;
    }
    assert_true(given_up > 4);
    assert_int_equal(status, 422);
    assert_true(total >= 2);
    bench_free(b);
    free(text);
}

static void what_lacks_memory_does_not_tell_the_defects_so_far(void **state)
{
    (void)state;
    size_t length;
    char *text = broken_file(&length);
    api_bench *b = bench_new();
    int never = 0, all, total;
    assert_int_equal(upload_broken(b, text, length, &never, &all), 422);
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        int status = upload_broken(b, text, length, &never, &total);
        failing_end(&f, status == 422);
        assert_true(status == 507 || (status == 422 && total == all));
    }
    bench_free(b);
    free(text);
}

static void the_order_in_the_query_does_not_matter(void **state)
{
    (void)state;
    static const char *const queries[] = {"?repair=weld,drop_degenerate,drop_duplicates,orient",
                                          "?repair=orient,drop_duplicates,weld,drop_degenerate",
                                          "?repair=drop_degenerate,orient,drop_duplicates,weld"};
    char *first = NULL;
    api_bench *b = bench_new();
    for (size_t i = 0; i < 3; i++) {
        bench_reply r = expect(201, post(b, queries[i], "model/obj", obj, strlen(obj)));
        char *text = cJSON_PrintUnformatted(cJSON_GetObjectItem(r.json, "import"));
        if (first == NULL) {
            first = text;
        } else {
            assert_string_equal(text, first);
            cJSON_free(text);
        }
        bench_reply_free(&r);
    }
    cJSON_free(first);
    bench_free(b);
}

static void warnings_name_every_place(void **state)
{
    (void)state;
    static const char body[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 7 7 7\nwhat 1\nf 1 2 3\nwhat 2\n"
                               "v 8 8 8\nv 0 0 1\nv 0 1 1\nf 1 6 7\n";
    api_bench *b = bench_new();
    bench_reply r = expect(201, post(b, "", "model/obj", body, strlen(body)));
    const cJSON *list = cJSON_GetObjectItem(cJSON_GetObjectItem(r.json, "import"), "warnings");
    assert_int_equal(cJSON_GetArraySize(list), 3);
    expect_member(cJSON_GetArrayItem(list, 0), "line", "5");
    expect_member(cJSON_GetArrayItem(list, 0), "lines", "[5,7]");
    expect_member(cJSON_GetArrayItem(list, 1), "code", "\"bowtie\"");
    expect_member(cJSON_GetArrayItem(list, 1), "vertices", "[0]");
    expect_member(cJSON_GetArrayItem(list, 1), "line", "1");
    expect_member(cJSON_GetArrayItem(list, 2), "code", "\"isolated_vertices\"");
    expect_member(cJSON_GetArrayItem(list, 2), "count", "2");
    expect_member(cJSON_GetArrayItem(list, 2), "vertices", "[3,4]");
    expect_member(cJSON_GetArrayItem(list, 2), "line", "4");
    bench_reply_free(&r);
    bench_free(b);
}

/* --- mesh documents in JSON --- */

#define DOCUMENT(attributes)                                                               \
    "{\"vertices\":[[0,0,0],[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2],[1,2,3],[0,2,3]]," \
    "\"attributes\":[" attributes "]}"

static void attributes_of_a_document_go_with_their_elements(void **state)
{
    (void)state;
    static const char document[] = DOCUMENT(
        "{\"domain\":\"vertices\",\"name\":\"v\",\"type\":\"uint32\",\"values\":[10,11,12,13]},"
        "{\"domain\":\"faces\",\"name\":\"f\",\"type\":\"double\",\"components\":2,"
        "\"values\":[[0,1],[2,3],[4,5]]},"
        "{\"domain\":\"mesh\",\"name\":\"m\",\"type\":\"bool\",\"values\":[true]}");
    api_bench *b = bench_new();
    bench_reply r =
        expect(201, post_json(b, "?id=a&repair=weld,drop_degenerate,drop_duplicates", document));
    expect_member(repair_at(&r, 0, "weld"), "moved", "1");
    bench_reply_free(&r);
    /* The vertices 10 and 11 were merged, but the corner that used vertex 11 must keep its value
     * 11. */
    r = expect(200, bench_send(b, "GET", "/v1/meshes/a/attributes/halfedges/v", NULL, NULL));
    expect_member(r.json, "values", "[11,0,12,0,13,0]");
    bench_reply_free(&r);
    r = expect(404, bench_send(b, "GET", "/v1/meshes/a/attributes/vertices/v", NULL, NULL));
    bench_reply_free(&r);
    r = expect(200, bench_send(b, "GET", "/v1/meshes/a/attributes/faces/f", NULL, NULL));
    expect_member(r.json, "values", "[[2,3]]");
    bench_reply_free(&r);

    static const char wrong[] = DOCUMENT(
        "{\"domain\":\"vertices\",\"name\":\"v\",\"type\":\"uint32\",\"values\":[10,11,12]}");
    r = expect(422, post_json(b, "?repair=weld,drop_degenerate,drop_duplicates", wrong));
    expect_member(r.json, "pointer", "\"/attributes/0/values\"");
    bench_reply_free(&r);
    bench_free(b);
}

/* Many programs write one vertex per corner, with different values, which separates the faces. The
 * report must say so and name the repair that joins the faces. */
static void faces_apart_along_coinciding_edges_are_told(void **state)
{
    (void)state;
    static const char document[] =
        "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,1,0],[1,0,0]],"
        "\"faces\":[[0,1,2],[3,4,5]]}";
    api_bench *b = bench_new();
    for (int welded = 0; welded < 2; welded++) {
        bench_reply r = expect(201, post_json(b, welded ? "?repair=weld" : "", document));
        const cJSON *import = cJSON_GetObjectItem(r.json, "import");
        const cJSON *warning = cJSON_GetArrayItem(cJSON_GetObjectItem(import, "warnings"), 0);
        assert_int_equal(warning != NULL, !welded);
        if (!welded) {
            expect_member(warning, "code", "\"open_seams\"");
            expect_member(warning, "count", "1");
            assert_non_null(
                strstr(cJSON_GetObjectItem(warning, "detail")->valuestring, "repair=weld"));
        }
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void values_of_edges_are_not_guessed(void **state)
{
    (void)state;
    static const char document[] =
        DOCUMENT("{\"domain\":\"edges\",\"name\":\"e\",\"type\":\"uint32\",\"values\":[1,2,3]}");
    api_bench *b = bench_new();
    bench_reply r = expect(422, post_json(b, "", document));
    assert_null(cJSON_GetObjectItem(r.json, "repair"));
    bench_reply_free(&r);
    r = expect(422, post_json(b, "?repair=weld,drop_degenerate,drop_duplicates", document));
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "unsupported");
    expect_member(r.json, "pointer", "\"/attributes/0/values\"");
    bench_reply_free(&r);
    /* If the requested repairs find nothing to repair, the attributes of the edges must be kept. */
    r = expect(201, post_json(b, "?repair=split,orient",
                              "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2]],"
                              "\"attributes\":[{\"domain\":\"edges\",\"name\":\"e\",\"type\":"
                              "\"uint32\",\"values\":[1,2,3]}]}"));
    bench_reply_free(&r);
    bench_free(b);
}

/* --- the request --- */

static void wrong_parameters(void **state)
{
    (void)state;
    static const char *const queries[] = {
        "?repair=",
        "?repair=mend",
        "?repair=weld,",
        "?repair=weld,weld",
        "?repair=weld%20split",
        "?repair=WELD",
        "?repair=weld&tolerance=-1",
        "?repair=weld&tolerance=nan",
        "?repair=weld&tolerance=1e999",
        "?repair=weld&tolerance=1x",
        "?repair=split&tolerance=1",
        "?tolerance=1",
        "?repair=fill&hole_edges=2",
        "?repair=weld&hole_edges=5",
    };
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof queries / sizeof *queries; i++) {
        bench_reply r = expect(400, post(b, queries[i], "model/obj", obj, strlen(obj)));
        assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "bad_parameter");
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void a_put_and_a_job_repair_too(void **state)
{
    (void)state;
    static const char *const async[] = {"Content-Type", "model/obj", "Prefer", "respond-async",
                                        NULL};
    char job[100];
    api_bench *b = bench_new();
    for (int i = 0; i < 2; i++) {
        const char *target =
            i == 0 ? "/v1/meshes/m"
                   : "/v1/meshes/m?repair=weld,drop_degenerate,drop_duplicates,orient";
        bench_reply r = expect(202, bench_send(b, "PUT", target, async, obj));
        snprintf(job, sizeof job, "%s", bench_header(&r, "Location"));
        bench_reply_free(&r);
        bench_run_jobs(b, 1);
        r = expect(200, bench_send(b, "GET", job, NULL, NULL));
        const cJSON *found =
            i == 0 ? cJSON_GetObjectItem(cJSON_GetObjectItem(r.json, "problem"), "repair")
                   : cJSON_GetObjectItem(
                         cJSON_GetObjectItem(cJSON_GetObjectItem(r.json, "result"), "import"),
                         "repairs");
        if (cJSON_GetArraySize(found) < 2) {
            fail_msg("%s", r.body);
        }
        bench_reply_free(&r);
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_repairs_named_let_it_pass),
        cmocka_unit_test(what_no_repair_mends_names_none),
        cmocka_unit_test(every_file_of_the_corpus_that_is_refused),
        cmocka_unit_test(each_repair_accounts_for_itself),
        cmocka_unit_test(degenerate_faces_that_keep_an_area_are_named),
        cmocka_unit_test(copies_and_turned_faces_are_named),
        cmocka_unit_test(a_band_that_cannot_be_oriented_is_told),
        cmocka_unit_test(a_refusal_after_repairs_names_the_file),
        cmocka_unit_test(what_is_given_up_does_not_tell_the_defects_so_far),
        cmocka_unit_test(what_lacks_memory_does_not_tell_the_defects_so_far),
        cmocka_unit_test(the_order_in_the_query_does_not_matter),
        cmocka_unit_test(warnings_name_every_place),
        cmocka_unit_test(attributes_of_a_document_go_with_their_elements),
        cmocka_unit_test(faces_apart_along_coinciding_edges_are_told),
        cmocka_unit_test(values_of_edges_are_not_guessed),
        cmocka_unit_test(wrong_parameters),
        cmocka_unit_test(a_put_and_a_job_repair_too),
    };
    return cmocka_run_group_tests_name("repairs", tests, NULL, NULL);
}
