/* The list of meshes: its orders, its search by name, its cursors and its refusals, with and
 * without an access token. */
#include "tests/api/request.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "api/limits.h"
#include "api/token/token_file.h"
#include "tests/failing.h"

#include <math.h>

enum { TARGET = 2000, IDS = 1000 };

static void make(api_bench *b, const char *id, const char *name, const char *shape)
{
    char target[TARGET], body[100];
    snprintf(target, sizeof target, "/v1/meshes?id=%s&name=%s", id, name);
    snprintf(body, sizeof body, "{\"shape\":\"%s\"}", shape);
    bench_done(bench_expect(201, bench_post(b, target, body)));
}

static void rename_mesh(api_bench *b, const char *id, const char *name)
{
    char target[TARGET], body[TARGET];
    snprintf(target, sizeof target, "/v1/meshes/%s", id);
    snprintf(body, sizeof body, "{\"name\":\"%s\"}", name);
    bench_done(bench_expect(200, bench_send(b, "PATCH", target, NULL, body)));
}

/* Appends the ids of the items to `ids`, each with a blank after it. */
static void add_ids(const bench_reply *r, char ids[IDS])
{
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(r->json, "items"))
    {
        const size_t used = strlen(ids);
        snprintf(ids + used, IDS - used, "%s ", cJSON_GetObjectItem(item, "id")->valuestring);
    }
}

/* Copies the URL in the header Link to `target`. Requires that it names the cursor in `next`. */
static bool follow(const bench_reply *r, char target[TARGET])
{
    const cJSON *next = cJSON_GetObjectItem(r->json, "next");
    const char *link = bench_header(r, "Link"), *end = strchr(link, '>');
    if (cJSON_IsNull(next)) {
        assert_string_equal(link, "");
        return false;
    }
    assert_non_null(end);
    assert_non_null(strstr(link, next->valuestring));
    assert_string_equal(end, ">; rel=\"next\"");
    snprintf(target, TARGET, "%.*s", (int)(end - link - 1), link + 1);
    return true;
}

/* Reads the list to its end by the links in the answers, and compares the ids. Returns the number
 * of pages. */
static size_t expect_ids(api_bench *b, const char *query, const char *wanted)
{
    char target[TARGET], ids[IDS] = "";
    size_t pages = 0;
    bool more = true;
    snprintf(target, sizeof target, "/v1/meshes?%s", query);
    while (more) {
        bench_reply r = bench_expect(200, bench_get(b, target));
        add_ids(&r, ids);
        more = follow(&r, target);
        bench_done(r);
        pages++;
    }
    assert_string_equal(ids, wanted);
    return pages;
}

/* Makes five meshes; the sphere is the largest, and two have names that differ by case only. */
static api_bench *bench_of_five(void)
{
    api_bench *b = bench_new();
    make(b, "m1", "beta", "cube");
    make(b, "m2", "Alpha", "icosphere");
    make(b, "m3", "alpha", "tetrahedron");
    make(b, "m4", "", "cube");
    make(b, "m5", "50%25%20%C3%A9%26", "octahedron"); /* 50% é& */
    return b;
}

static void each_order_is_read_in_pages_of_any_size(void **state)
{
    (void)state;
    api_bench *b = bench_of_five();
    for (int limit = 1; limit <= 6; limit++) {
        char query[100];
        const size_t pages = (size_t)(5 + limit - 1) / (size_t)limit;
        snprintf(query, sizeof query, "limit=%d", limit);
        assert_int_equal(expect_ids(b, query, "m1 m2 m3 m4 m5 "), pages);
        snprintf(query, sizeof query, "limit=%d&sort=name", limit);
        assert_int_equal(expect_ids(b, query, "m4 m5 m2 m3 m1 "), pages);
        snprintf(query, sizeof query, "limit=%d&sort=modified", limit);
        assert_int_equal(expect_ids(b, query, "m5 m4 m3 m2 m1 "), pages);
        snprintf(query, sizeof query, "limit=%d&sort=bytes", limit);
        (void)expect_ids(b, query, "m2 m4 m1 m5 m3 ");
    }
    bench_free(b);
}

static void items_have_the_members_by_which_they_are_sorted(void **state)
{
    (void)state;
    api_bench *b = bench_of_five();
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes?sort=bytes"));
    bench_reply plain = bench_expect(200, bench_get(b, "/v1/meshes"));
    const cJSON *item;
    double last = HUGE_VAL;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(r.json, "items"))
    {
        const double bytes = cJSON_GetObjectItem(item, "memory_bytes")->valuedouble;
        assert_true(bytes > 0 && bytes <= last);
        last = bytes;
        /* the list in the order of ids has an equal item */
        const int place = cJSON_GetObjectItem(item, "id")->valuestring[1] - '1';
        assert_true(cJSON_Compare(
            item, cJSON_GetArrayItem(cJSON_GetObjectItem(plain.json, "items"), place), true));
    }
    bench_done(plain);
    bench_done(r);
    bench_reply one = bench_expect(200, bench_get(b, "/v1/meshes/m3"));
    r = bench_expect(200, bench_get(b, "/v1/meshes?contains=alpha"));
    item = cJSON_GetArrayItem(cJSON_GetObjectItem(r.json, "items"), 1);
    assert_string_equal(cJSON_GetObjectItem(item, "modified")->valuestring,
                        bench_text(&one, "modified"));
    bench_done(r);
    bench_done(one);
    bench_free(b);
}

static void a_change_moves_a_mesh(void **state)
{
    (void)state;
    api_bench *b = bench_of_five();
    rename_mesh(b, "m2", "gamma");
    (void)expect_ids(b, "sort=name", "m4 m5 m3 m1 m2 ");
    (void)expect_ids(b, "sort=modified", "m2 m5 m4 m3 m1 ");
    bench_done(
        bench_expect(200, bench_post(b, "/v1/meshes/m1/edits",
                                     "{\"op\":\"subdivide\",\"scheme\":\"linear\",\"steps\":4}")));
    (void)expect_ids(b, "sort=modified", "m1 m2 m5 m4 m3 ");
    (void)expect_ids(b, "sort=bytes", "m1 m2 m4 m5 m3 ");
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m1/undo", "{}")));
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m5", NULL, NULL)));
    (void)expect_ids(b, "sort=name", "m4 m3 m1 m2 ");
    bench_done(bench_expect(201, bench_send(b, "POST", "/v1/meshes/m3/copy", NULL,
                                            "{\"id\":\"m6\",\"name\":\"ALPHA\"}")));
    (void)expect_ids(b, "sort=name", "m4 m3 m6 m1 m2 ");
    (void)expect_ids(b, "sort=modified&limit=2", "m6 m1 m2 m4 m3 ");
    bench_done(bench_expect(
        200, bench_send(b, "PUT", "/v1/meshes/m4?name=zeta", NULL, "{\"shape\":\"cube\"}")));
    (void)expect_ids(b, "sort=name&limit=1", "m3 m6 m1 m2 m4 ");
    bench_free(b);
}

/* A cursor keeps its place, even if its mesh gets another name or is deleted. */
static void a_cursor_outlives_its_mesh(void **state)
{
    (void)state;
    for (int deletes = 0; deletes < 2; deletes++) {
        char target[TARGET], ids[IDS] = "";
        api_bench *b = bench_of_five();
        bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes?sort=name&limit=3"));
        assert_true(follow(&r, target));
        bench_done(r);
        if (deletes != 0) {
            bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m2", NULL, NULL)));
        } else {
            rename_mesh(b, "m2", "aaaa"); /* a place that the client has read already */
        }
        r = bench_expect(200, bench_get(b, target));
        add_ids(&r, ids);
        assert_string_equal(ids, "m3 m1 ");
        bench_done(r);
        bench_free(b);
    }
}

static void meshes_are_found_by_a_part_of_their_names(void **state)
{
    (void)state;
    api_bench *b = bench_of_five();
    static const char *const orders[] = {"", "&sort=name", "&sort=modified", "&sort=bytes"};
    static const struct {
        const char *contains, *wanted[4];
    } cases[] = {
        {"ALPHA", {"m2 m3 ", "m2 m3 ", "m3 m2 ", "m2 m3 "}},
        {"a", {"m1 m2 m3 ", "m2 m3 m1 ", "m3 m2 m1 ", "m2 m1 m3 "}},
        {"TA", {"m1 ", "m1 ", "m1 ", "m1 "}},
        {"0%25%20%C3%A9%26", {"m5 ", "m5 ", "m5 ", "m5 "}},
        {"%C3%89", {"", "", "", ""}}, /* É: only the letters A to Z are the same as a to z */
        {"alphas", {"", "", "", ""}},
        {"", {"m1 m2 m3 m4 m5 ", "m4 m5 m2 m3 m1 ", "m5 m4 m3 m2 m1 ", "m2 m4 m1 m5 m3 "}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (size_t k = 0; k < 4; k++) {
            for (int limit = 1; limit < 4; limit++) {
                char query[200];
                snprintf(query, sizeof query, "limit=%d&contains=%s%s", limit, cases[i].contains,
                         orders[k]);
                (void)expect_ids(b, query, cases[i].wanted[k]);
            }
        }
    }
    bench_free(b);
}

static void expect_refused(api_bench *b, const char *query, const char *code, const char *reason)
{
    char target[TARGET];
    snprintf(target, sizeof target, "/v1/meshes?%s", query);
    bench_reply r = bench_expect(400, bench_get(b, target));
    assert_string_equal(bench_text(&r, "code"), code);
    if (strstr(bench_text(&r, "detail"), reason) == NULL) {
        fail_msg("%s: %s", query, bench_text(&r, "detail"));
    }
    bench_done(r);
}

static void wrong_parameters_are_refused_with_a_reason(void **state)
{
    (void)state;
    api_bench *b = bench_of_five();
    char text[700];
    expect_refused(b, "sort=size", "bad_parameter", "name, modified, bytes");
    expect_refused(b, "sort=", "bad_parameter", "name, modified, bytes");
    expect_refused(b, "sort=-name", "bad_parameter", "name, modified, bytes");
    expect_refused(b, "sort=name&sort=name", "repeated_parameter", "sort");
    snprintf(text, sizeof text, "contains=%0*d", ST_MESH_NAME + 1, 0);
    expect_refused(b, text, "bad_parameter", "at most 256 bytes");
    snprintf(text, sizeof text, "contains=%0*d", ST_MESH_NAME, 0);
    (void)expect_ids(b, text, "");
    bench_free(b);
}

/* Copies the cursor of a list's next page. */
static void get_cursor(api_bench *b, const char *query, char out[TARGET])
{
    char target[TARGET];
    snprintf(target, sizeof target, "/v1/meshes?%s", query);
    bench_reply r = bench_expect(200, bench_get(b, target));
    snprintf(out, TARGET, "%s", bench_text(&r, "next"));
    bench_done(r);
}

static void a_cursor_of_another_list_is_refused_with_a_reason(void **state)
{
    (void)state;
    api_bench *b = bench_of_five();
    static const char *const orders[] = {"name", "modified", "bytes"};
    char cursor[TARGET], query[TARGET + 100], reason[200];
    for (size_t from = 0; from < 3; from++) {
        snprintf(query, sizeof query, "limit=2&sort=%s", orders[from]);
        get_cursor(b, query, cursor);
        for (size_t to = 0; to < 3; to++) {
            snprintf(query, sizeof query, "sort=%s&cursor=%s", orders[to], cursor);
            snprintf(reason, sizeof reason,
                     "the list of meshes with sort=%s, but the request has "
                     "sort=%s",
                     orders[from], orders[to]);
            if (from != to) {
                expect_refused(b, query, "bad_cursor", reason);
            }
        }
        snprintf(query, sizeof query, "cursor=%s", cursor);
        expect_refused(b, query, "bad_cursor", "the list of meshes without `sort`");
    }
    get_cursor(b, "limit=2", cursor);
    snprintf(query, sizeof query, "sort=name&cursor=%s", cursor);
    expect_refused(b, query, "bad_cursor", "the list of meshes with sort=name");
    bench_free(b);
}

static void a_cursor_that_the_server_has_not_made_is_refused(void **state)
{
    (void)state;
    api_bench *b = bench_of_five();
    static const char *const wrong[] = {
        "sort=name&cursor=",
        "sort=name&cursor=by-name",
        "sort=name&cursor=by-name.",
        "sort=name&cursor=by-name.6d",
        "sort=name&cursor=by-name.6d.",
        "sort=name&cursor=by-name.6.m",
        "sort=name&cursor=by-name.6D.m",
        "sort=name&cursor=by-name.00.m",
        "sort=name&cursor=by-name.6d.m%2Fn",
        "sort=name&cursor=by-nam.6d.m",
        "sort=name&cursor=by-names.6d.m",
        "sort=bytes&cursor=by-bytes.00.m",
        "sort=bytes&cursor=by-bytes..m",
        "sort=bytes&cursor=by-bytes.8000000000000000.m",
        "sort=bytes&cursor=by-bytes.000000000000000000.m",
        "sort=modified&cursor=by-modified.7ff8000000000000.m",
        "sort=modified&cursor=by-modified.7ff0000000000000.m",
        "sort=modified&cursor=by-modified.fff0000000000000.m",
        "cursor=m",
        "cursor=n1",
        "cursor=by-name.6d.m",
        "sort=name&cursor=name.6d.m",
        "cursor=m%2F",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        expect_refused(b, wrong[i], "bad_cursor", "does not belong to the list of meshes with");
    }
    char text[1000];
    snprintf(text, sizeof text, "sort=name&cursor=by-name.%s%0*d.m", "6d", 2 * ST_MESH_NAME, 6);
    expect_refused(b, text, "bad_cursor", "does not belong");
    (void)expect_ids(b, "sort=name&cursor=by-name..m4", "m5 m2 m3 m1 ");
    (void)expect_ids(b, "sort=bytes&cursor=by-bytes.7fffffffffffffff.m4", "m2 m4 m1 m5 m3 ");
    (void)expect_ids(b, "sort=modified&cursor=by-modified.8000000000000000.m4", "");
    bench_free(b);
}

/* The longest name has the longest cursor and, if it is searched for, the longest link. */
static void the_longest_names_can_be_listed(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    char name[ST_MESH_NAME + 1] = "", query[3 * ST_MESH_NAME + 100] = "limit=1&sort=name&contains=";
    for (size_t i = 0; i < ST_MESH_NAME / 2; i++) {
        memcpy(name + 2 * i, "\xc3\xa9", 3);
        memcpy(query + strlen(query), "%C3%A9", 7);
    }
    for (int i = 0; i < 3; i++) {
        st_mesh *mesh;
        char id[ST_MESH_ID + 1];
        memset(id, 'x', ST_MESH_ID);
        id[ST_MESH_ID - 1] = (char)('a' + i);
        id[ST_MESH_ID] = '\0';
        assert_int_equal(st_create(bench_store(b), id, name, fixture_mesh("012"), NULL, &mesh),
                         ST_OK);
        st_release(mesh);
    }
    char wanted[IDS] = "";
    for (int i = 0; i < 3; i++) {
        size_t used = strlen(wanted);
        memset(wanted + used, 'x', ST_MESH_ID);
        wanted[used + ST_MESH_ID - 1] = (char)('a' + i);
        memcpy(wanted + used + ST_MESH_ID, " ", 2);
    }
    assert_int_equal(expect_ids(b, query, wanted), 3);
    bench_free(b);
}

/* A request looks at a limited number of meshes, so the page that ends there is empty. */
static void a_search_goes_on_after_an_empty_page(void **state)
{
    (void)state;
    api_bench *b = bench_new_within(0, 0);
    static const char *const queries[] = {"contains=needle", "contains=needle&sort=name",
                                          "contains=needle&sort=modified",
                                          "contains=needle&sort=bytes"};
    for (size_t i = 0; i <= API_MAX_SEARCHED; i++) {
        st_mesh *mesh;
        char id[16];
        snprintf(id, sizeof id, "m%06zu", i);
        const bool last = i == API_MAX_SEARCHED;
        assert_int_equal(st_create(bench_store(b), id, "hay", fixture_mesh("012"), NULL, &mesh),
                         ST_OK);
        st_release(mesh);
        if (last) {
            rename_mesh(b, id, "the needle");
        }
    }
    for (size_t i = 0; i < 4; i++) {
        /* The mesh that was changed last is the first in the third order, and the last in the other
         * orders; in the fourth it is the first of many with an equal size. */
        const bool is_first = i >= 2;
        char target[TARGET], ids[IDS] = "";
        snprintf(target, sizeof target, "/v1/meshes?%s", queries[i]);
        bench_reply r = bench_expect(200, bench_get(b, target));
        add_ids(&r, ids);
        assert_string_equal(ids, is_first ? "m020000 " : "");
        assert_true(follow(&r, target));
        bench_done(r);
        r = bench_expect(200, bench_get(b, target));
        add_ids(&r, ids);
        assert_string_equal(ids, "m020000 ");
        assert_false(follow(&r, target));
        bench_done(r);
    }
    bench_free(b);
}

/* --- tokens --- */

static api_bench *bench_of_tokens(void)
{
    char file[1000] = "";
    static const char *const names[] = {"boss", "left"};
    for (size_t i = 0; i < 2; i++) {
        char line[API_TOKEN_SHORT_LINE];
        const size_t used = strlen(file);
        api_token_file_line(names[i], i == 0 ? API_ROLE_ADMIN : API_ROLE_WRITE, names[i], line);
        snprintf(file + used, sizeof file - used, "%s%s\n", line,
                 i == 0 ? "" : " prefix=left-,zz.,left-x");
    }
    api_bench *b = bench_new_guarded(file);
    bench_use_token(b, "boss");
    make(b, "left-2", "b", "cube");
    make(b, "left-1", "c", "icosphere");
    make(b, "zz.3", "A", "tetrahedron");
    return b;
}

/* Returns all bytes that the token "left" can read of the lists of meshes. */
static char *all_of_left(api_bench *b)
{
    static const char *const queries[] = {"",           "sort=name",  "sort=modified",
                                          "sort=bytes", "contains=a", "contains=B&sort=bytes"};
    enum { MOST = 1 << 16 };
    char *all = calloc(1, MOST), target[TARGET];
    assert_non_null(all);
    bench_use_token(b, "left");
    for (size_t i = 0; i < sizeof queries / sizeof *queries; i++) {
        bool more = true;
        snprintf(target, sizeof target, "/v1/meshes?limit=1%s%s", i == 0 ? "" : "&", queries[i]);
        while (more) {
            bench_reply r = bench_expect(200, bench_get(b, target));
            const size_t used = strlen(all);
            snprintf(all + used, MOST - used, "%s\n%s\n", target, r.body);
            more = follow(&r, target);
            bench_done(r);
        }
    }
    bench_use_token(b, "boss");
    return all;
}

static void a_token_with_prefixes_learns_nothing_of_other_meshes(void **state)
{
    (void)state;
    api_bench *b = bench_of_tokens();
    char *alone = all_of_left(b);
    /* these would come before, between and after the meshes that the token can see */
    make(b, "a", "aa", "cube");
    make(b, "left", "b", "icosphere");
    make(b, "m", "bb", "tetrahedron");
    make(b, "zz", "z", "octahedron");
    char *among = all_of_left(b);
    assert_string_equal(among, alone);
    free(among);
    free(alone);
    (void)expect_ids(b, "sort=name&limit=2", "zz.3 a left left-2 m left-1 zz ");
    bench_use_token(b, "left");
    (void)expect_ids(b, "sort=name&limit=1", "zz.3 left-2 left-1 ");
    (void)expect_ids(b, "sort=name&limit=2", "zz.3 left-2 left-1 ");
    (void)expect_ids(b, "sort=name", "zz.3 left-2 left-1 ");
    (void)expect_ids(b, "sort=modified&limit=2", "zz.3 left-1 left-2 ");
    (void)expect_ids(b, "sort=bytes&limit=2", "left-1 left-2 zz.3 ");
    (void)expect_ids(b, "sort=bytes&contains=B", "left-2 ");
    /* a cursor that the client has made itself shows no more */
    (void)expect_ids(b, "sort=name&cursor=by-name.61.zz.4", "left-2 left-1 ");
    bench_free(b);
}

/* A token with prefixes gets the first of many meshes, chosen while all are looked at. */
static void a_token_with_prefixes_gets_each_page_of_many(void **state)
{
    (void)state;
    enum { MANY = 150 };
    api_bench *b = bench_of_tokens();
    for (int i = 0; i < MANY; i++) {
        char id[20], name[20];
        snprintf(id, sizeof id, "zz.%03d", i * 77 % MANY);
        snprintf(name, sizeof name, "k%03d", i * 77 % MANY * 31 % MANY);
        make(b, id, name, "tetrahedron");
    }
    bench_use_token(b, "left");
    for (size_t limit = 1; limit < 200; limit = 3 * limit + 1) {
        char target[TARGET], last[20] = "";
        size_t count = 0;
        bool more = true;
        snprintf(target, sizeof target, "/v1/meshes?sort=name&contains=K&limit=%zu", limit);
        while (more) {
            bench_reply r = bench_expect(200, bench_get(b, target));
            const cJSON *item;
            cJSON_ArrayForEach(item, cJSON_GetObjectItem(r.json, "items"))
            {
                const char *name = cJSON_GetObjectItem(item, "name")->valuestring;
                assert_true(strcmp(name, last) > 0);
                snprintf(last, sizeof last, "%s", name);
                count++;
            }
            more = follow(&r, target);
            bench_done(r);
        }
        assert_int_equal(count, MANY);
    }
    bench_free(b);
}

/* --- memory --- */

static void a_list_without_memory_is_refused_whole(void **state)
{
    (void)state;
    static const char *const targets[] = {"/v1/meshes?sort=name&contains=e&limit=1",
                                          "/v1/meshes?sort=bytes&limit=3", "/v1/meshes?contains=A"};
    api_bench *b = bench_of_tokens();
    for (int token = 0; token < 2; token++) {
        bench_use_token(b, token == 0 ? "boss" : "left");
        for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
            failing f = {.may_succeed = true, .what = targets[i]};
            while (failing_next(&f)) {
                bench_reply r;
                const bench_request request = {.method = "GET", .target = targets[i]};
                const bool sent = bench_try(b, &request, &r);
                const bool good = sent && r.status == 200;
                failing_end(&f, good);
                failing_pause();
                if (sent) {
                    assert_true(good || r.status == 503 || r.status == 507);
                    bench_reply_free(&r);
                }
                failing_resume();
            }
        }
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_order_is_read_in_pages_of_any_size),
        cmocka_unit_test(items_have_the_members_by_which_they_are_sorted),
        cmocka_unit_test(a_change_moves_a_mesh),
        cmocka_unit_test(a_cursor_outlives_its_mesh),
        cmocka_unit_test(meshes_are_found_by_a_part_of_their_names),
        cmocka_unit_test(wrong_parameters_are_refused_with_a_reason),
        cmocka_unit_test(a_cursor_of_another_list_is_refused_with_a_reason),
        cmocka_unit_test(a_cursor_that_the_server_has_not_made_is_refused),
        cmocka_unit_test(the_longest_names_can_be_listed),
        cmocka_unit_test(a_search_goes_on_after_an_empty_page),
        cmocka_unit_test(a_token_with_prefixes_learns_nothing_of_other_meshes),
        cmocka_unit_test(a_token_with_prefixes_gets_each_page_of_many),
        cmocka_unit_test(a_list_without_memory_is_refused_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
