/* Tests of the short texts in a request that have a grammar of their own: paths, media types,
 * entity tags, cursors. */
#include "api/header/cursor.h"
#include "api/header/etag.h"
#include "api/header/media.h"
#include "api/header/path.h"

#include "fixture.h"

static void paths_are_split_before_they_are_decoded(void **state)
{
    (void)state;
    static const struct {
        const char *raw;
        int code;
        size_t count;
        const char *last;
    } paths[] = {
        {"/", HE_OK, 0, ""},
        {"/a", HE_OK, 1, "a"},
        {"/a/b%20c", HE_OK, 2, "b c"},
        {"/a/%C3%A9", HE_OK, 2, "\xC3\xA9"},
        {"/a/..", HE_OK, 2, ".."},
        {"/a/%2e%2E", HE_OK, 2, ".."},
        {"/a/%252f", HE_OK, 2, "%2f"},
        {"/a/b?c", HE_OK, 2, "b?c"},
        {"/a/b+c", HE_OK, 2, "b+c"},
        {"", API_BAD_PATH, 0, ""},
        {"a", API_BAD_PATH, 0, ""},
        {"*", API_BAD_PATH, 0, ""},
        {"//", API_NO_SUCH_ROUTE, 0, ""},
        {"/a/", API_NO_SUCH_ROUTE, 0, ""},
        {"//a", API_NO_SUCH_ROUTE, 0, ""},
        {"/a//b", API_NO_SUCH_ROUTE, 0, ""},
        {"/1/2/3/4/5/6/7/8/9/0/1/2/3/4/5/6/7", API_NO_SUCH_ROUTE, 0, ""},
        {"/a/b%2Fc", HE_OK, 2, "b/c"},
        {"/a%2Fb/c", API_BAD_PATH, 0, ""},
        {"/a%2fb/c", API_BAD_PATH, 0, ""},
        {"/%2F/", API_BAD_PATH, 0, ""},
        {"/a%00", API_BAD_PATH, 0, ""},
        {"/a%", API_BAD_PATH, 0, ""},
        {"/a%1", API_BAD_PATH, 0, ""},
        {"/a%1/b", API_BAD_PATH, 0, ""},
        {"/a%zz", API_BAD_PATH, 0, ""},
        {"/a%0x", API_BAD_PATH, 0, ""},
        {"/%FF", API_BAD_PATH, 0, ""},
        {"/\xFF", API_BAD_PATH, 0, ""},
        {"/%C0%AF", API_BAD_PATH, 0, ""},
    };
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        api_arena arena = {0};
        api_path path = {.count = 0};
        api_problem problem = {0};
        bool good = api_path_split(paths[i].raw, &arena, &path, &problem);
        if (problem.code != paths[i].code || good != (problem.code == HE_OK) ||
            path.count != paths[i].count ||
            (path.count > 0 && strcmp(path.segments[path.count - 1], paths[i].last) != 0)) {
            fail_msg("%s: %s", paths[i].raw, api_code_slug(problem.code));
        }
        api_arena_clear(&arena);
    }
}

static void queries_are_pairs(void **state)
{
    (void)state;
    static const struct {
        const char *raw;
        int code;
        size_t count;
        const char *last;
    } queries[] = {
        {"", HE_OK, 0, ""},
        {"a=1", HE_OK, 1, "1"},
        {"a=1&b=%2F+%26", HE_OK, 2, "/+&"},
        {"a=", HE_OK, 1, ""},
        {"a=b=c", HE_OK, 1, "b=c"},
        {"a", API_BAD_QUERY, 0, ""},
        {"=1", API_BAD_QUERY, 0, ""},
        {"&", API_BAD_QUERY, 0, ""},
        {"a=1&", API_BAD_QUERY, 0, ""},
        {"a=1&&b=2", API_BAD_QUERY, 0, ""},
        {"a=%", API_BAD_QUERY, 0, ""},
        {"a=%00", API_BAD_QUERY, 0, ""},
        {"%FF=1", API_BAD_QUERY, 0, ""},
        {"a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1&a=1", API_BAD_QUERY, 0,
         ""},
    };
    for (size_t i = 0; i < sizeof queries / sizeof queries[0]; i++) {
        api_arena arena = {0};
        api_query query = {.count = 0};
        api_problem problem = {0};
        bool good = api_query_split(queries[i].raw, &arena, &query, &problem);
        if (problem.code != queries[i].code || good != (problem.code == HE_OK) ||
            query.count != queries[i].count ||
            (query.count > 0 && strcmp(query.pairs[query.count - 1].value, queries[i].last) != 0)) {
            fail_msg("%s: %s", queries[i].raw, api_code_slug(problem.code));
        }
        api_arena_clear(&arena);
    }
}

static void ids_in_paths_are_digits(void **state)
{
    (void)state;
    uint32_t id;
    assert_true(api_path_id("0", &id) && id == 0);
    assert_true(api_path_id("4294967293", &id) && id == 4294967293u);
    static const char *const bad[] = {"",   "-1", "+1",         "1.0",        " 1",
                                      "0x", "1e", "4294967294", "4294967295", "42949672960"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_false(api_path_id(bad[i], &id));
    }
    assert_true(api_path_is_mesh_id("A.b_c-9"));
    static const char *const names[] = {"", ".", "..", "a b", "a/b", "\xC3\xA9"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        assert_false(api_path_is_mesh_id(names[i]));
    }
    char longest[ST_MESH_ID + 2];
    memset(longest, 'a', sizeof longest);
    longest[ST_MESH_ID + 1] = '\0';
    assert_false(api_path_is_mesh_id(longest));
    longest[ST_MESH_ID] = '\0';
    assert_true(api_path_is_mesh_id(longest));
}

static void accept_is_read_with_its_weights(void **state)
{
    (void)state;
    static const char *const offers[] = {"application/json", "model/obj", "model/stl", NULL};
    static const struct {
        const char *accept;
        int choice;
    } headers[] = {
        {NULL, 0},
        {"*/*", 0},
        {"application/json", 0},
        {"APPLICATION/JSON", 0},
        {"model/obj", 1},
        {"model/*", 1},
        {"model/stl, model/obj;q=0.5", 2},
        {"application/json;q=0.1, model/*;q=0.2", 1},
        {"*/*;q=0.1, model/stl", 2},
        {"*/*, application/json;q=0", 1},
        {"model/*, model/obj;q=0", 2},
        {"model/obj;q=0.5,model/stl;q=0.501", 2},
        {"text/html, */*;q=0.8", 0},
        {"model/obj ; q=0.3 , model/stl ; q=0.4", 2},
        {"model/obj;x=\"a,b;q=0\";q=0.9", 1},
        {"text/html", -1},
        {"application/json;q=0", -1},
        {"*/*;q=0", -1},
        {"*/*;q=2", -1},
        {"*/*;q=0.1234", -1},
        {"*/*;q=x", -1},
        {"*/json", -1},
        {"model", -1},
        {"mod*", -1},
        {"application/jsonx", -1},
        {",,,", -1},
    };
    for (size_t i = 0; i < sizeof headers / sizeof headers[0]; i++) {
        int choice = api_media_choose(headers[i].accept, offers);
        if (choice != headers[i].choice) {
            fail_msg("%s: %d", headers[i].accept, choice);
        }
    }
}

static void content_types_are_compared_without_parameters(void **state)
{
    (void)state;
    assert_true(api_media_is("application/json", "application/json"));
    assert_true(api_media_is("Application/JSON; charset=UTF-8", "application/json"));
    assert_true(api_media_is("application/json;charset=\"utf-8\"", "application/json"));
    assert_true(api_media_is(" application/json ", "application/json"));
    assert_false(api_media_is("application/json; charset=latin1", "application/json"));
    assert_false(api_media_is("application/jsonp", "application/json"));
    assert_false(api_media_is("text/plain, application/json", "application/json"));
    assert_false(api_media_is("", "application/json"));
    assert_true(api_header_has("respond-async, return=minimal", "return=minimal"));
    assert_false(api_header_has("return=minimalist", "return=minimal"));
    assert_false(api_header_has(NULL, "return=minimal"));
}

static void content_codings_are_chosen_by_weight(void **state)
{
    (void)state;
    static const struct {
        const char *header;
        bool any;
        api_coding best;
        bool identity; /* whether an uncompressed answer is allowed */
    } rows[] = {
        {NULL, true, API_IDENTITY, true},
        {"", true, API_IDENTITY, true},
        {" , ", true, API_IDENTITY, true},
        {"gzip", true, API_GZIP, true},
        {"GZip", true, API_GZIP, true},
        {"x-gzip", true, API_GZIP, true},
        {"zstd", true, API_ZSTD, true},
        {"gzip, zstd", true, API_ZSTD, true},
        {"gzip, deflate, br, zstd", true, API_ZSTD, true},
        {"gzip, deflate, br", true, API_GZIP, true},
        {"gzip;q=1, zstd;q=0.999", true, API_GZIP, true},
        {"gzip;q=0.5 , zstd ; q=0.6", true, API_ZSTD, true},
        {"gzip;Q=0.5, zstd;q=0.4", true, API_GZIP, true},
        {"gzip;q=0.001", true, API_GZIP, true},
        {"gzip;q=0.0", true, API_IDENTITY, true},
        {"gzip;q=0, zstd;q=0.000", true, API_IDENTITY, true},
        {"gzip;q=0.5, identity", true, API_IDENTITY, true},
        {"gzip;q=0.5, identity;q=0.5", true, API_GZIP, true},
        {"gzip;q=0.5, identity;q=0.6", true, API_IDENTITY, true},
        {"gzip, identity;q=0", true, API_GZIP, false},
        {"identity;q=0", false, API_IDENTITY, false},
        {"identity;q=0, br", false, API_IDENTITY, false},
        /* Some proxies send "*" although they can read gzip at most, so "*" must not lead to
         * zstd. */
        {"*", true, API_GZIP, true},
        {"*;q=0.5, zstd", true, API_ZSTD, true},
        {"*, zstd;q=0.5", true, API_GZIP, true},
        {"identity;q=0, *", true, API_GZIP, false},
        {"identity;q=0, gzip;q=0, *", true, API_ZSTD, false},
        {"*;q=0", false, API_IDENTITY, false},
        {"*;q=0, identity;q=0.1", true, API_IDENTITY, true},
        {"*;q=0, gzip", true, API_GZIP, false},
        {"gzip;q=0, *", true, API_IDENTITY, true},
        {"zstd;q=0, *;q=0.5, identity;q=0", true, API_GZIP, false},
        {"br, *;q=0.1", true, API_GZIP, true},
        {"gzip;q=2", true, API_IDENTITY, true},
        {"gzip;q=-1, zstd;q=0.5", true, API_ZSTD, true},
        {"gzip;q=0.1234", true, API_IDENTITY, true},
        {"gzip;level=9", true, API_IDENTITY, true},
        {"gzip;q", true, API_IDENTITY, true},
        {"gzip, gzip;q=0", true, API_GZIP, true},
        {"gzipped, zstandard, averylongnameofacodingthatnobodyhasheardof", true, API_IDENTITY,
         true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        api_codings codings;
        bool any = api_coding_choose(rows[i].header, &codings);
        if (any != rows[i].any || codings.best != rows[i].best ||
            codings.allowed[API_IDENTITY] != rows[i].identity) {
            fail_msg("%s: %d %s", rows[i].header, any, api_coding_name(codings.best));
        }
    }
}

static void one_content_coding_is_taken(void **state)
{
    (void)state;
    static const struct {
        const char *header;
        bool taken;
        api_coding coding;
    } rows[] = {
        {NULL, true, API_IDENTITY},
        {"", true, API_IDENTITY},
        {"identity", true, API_IDENTITY},
        {"gzip", true, API_GZIP},
        {"X-GZIP", true, API_GZIP},
        {" zstd ,", true, API_ZSTD},
        {"gzip, gzip", false, 0},
        {"gzip,zstd", false, 0},
        {"identity, gzip", false, 0},
        {"br", false, 0},
        {"deflate", false, 0},
        {"compress", false, 0},
        {"gzip;q=1", false, 0},
        {"*", false, 0},
        {"gzip zstd", false, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        api_coding coding;
        bool taken = api_coding_of_body(rows[i].header, &coding);
        if (taken != rows[i].taken || (taken && coding != rows[i].coding)) {
            fail_msg("%s", rows[i].header);
        }
    }
}

static const st_mesh_info facts = {.incarnation = 0xABC, .metadata = 2, .revision = 41};

/* Returns whether `header`, a value of If-None-Match, lists the entity tag `etag` with the content
 * coding `coding`, for a client that sends Accept-Encoding: gzip. */
static bool listed(const char *header, const char *etag, api_coding coding)
{
    const api_codings codings = {.allowed = {[API_GZIP] = true, [API_IDENTITY] = true}};
    api_coding found = API_CODING_COUNT;
    return api_etag_listed(header, etag, &codings, &found) && found == coding;
}

static void entity_tags_name_state_and_representation(void **state)
{
    (void)state;
    char etag[API_ETAG];
    api_etag_write(&facts, "obj", etag);
    assert_string_equal(etag, "\"0000000000000abc-2-41-obj\"");
    assert_true(listed("\"x\", W/\"0000000000000abc-2-41-obj\"", etag, API_IDENTITY));
    assert_true(listed(" * ", etag, API_IDENTITY));
    assert_false(listed("\"0000000000000abc-2-41-stl\"", etag, API_IDENTITY));
    assert_false(listed("0000000000000abc-2-41-obj", etag, API_IDENTITY));
    assert_false(listed("", etag, API_IDENTITY));
    assert_false(listed("\"", etag, API_IDENTITY));
    /* An entity tag may end with the name of a content coding; it matches only if the client
     * accepts this coding. */
    assert_true(listed("\"0000000000000abc-2-41-obj-gzip\"", etag, API_GZIP));
    assert_true(listed("\"y\", \"0000000000000abc-2-41-obj-gzip\"", etag, API_GZIP));
    assert_false(listed("\"0000000000000abc-2-41-obj-zstd\"", etag, API_ZSTD));
    assert_false(listed("\"0000000000000abc-2-41-obj-identity\"", etag, API_IDENTITY));
    /* The header If-Match of a write may contain the entity tag of any representation of the
     * present state. */
    assert_true(api_etag_is_present("\"0000000000000abc-2-41-stl\"", &facts));
    assert_true(api_etag_is_present("\"a\",\"0000000000000abc-2-41-obj\"", &facts));
    assert_true(api_etag_is_present("*", &facts));
    assert_true(api_etag_is_present("\"0000000000000abc-2-41-obj-gzip\"", &facts));
    assert_false(api_etag_is_present("W/\"0000000000000abc-2-41-obj\"", &facts));
    assert_false(api_etag_is_present("\"0000000000000abc-2-4-obj\"", &facts));
    assert_false(api_etag_is_present("\"0000000000000abc-2-411-obj\"", &facts));
    assert_false(api_etag_is_present("\"0000000000000abd-2-41-obj\"", &facts));
}

static void cursors_come_back_or_are_refused(void **state)
{
    (void)state;
    char text[API_CURSOR];
    uint64_t position = 0;
    api_problem problem = {0};
    api_cursor_write("vertices", &facts, 1000, text);
    assert_true(api_cursor_read(text, "vertices", &facts, &position, &problem));
    assert_int_equal(position, 1000);
    assert_false(api_cursor_read(text, "faces", &facts, &position, &problem));
    assert_int_equal(problem.code, API_BAD_CURSOR);
    for (size_t cut = strlen(text); cut-- > 0;) {
        char shorter[API_CURSOR] = "";
        memcpy(shorter, text, cut);
        problem = (api_problem){0};
        /* A truncated cursor may still be a valid cursor, for example if the position 1000 at its
         * end becomes 100. */
        if (!api_cursor_read(shorter, "vertices", &facts, &position, &problem)) {
            assert_true(problem.code == API_BAD_CURSOR);
        }
    }
    static const char *const bad[] = {"",
                                      "vertices",
                                      "vertices.0000000000000abc.41.1000.",
                                      "vertices.0000000000000abc.41.",
                                      "vertices.0000000000000abc.41.-1",
                                      "vertices.0000000000000abc.041.1",
                                      "vertices.0000000000000ABC.41.1",
                                      "vertices.0000000000000abc.41.99999999999999999999",
                                      "vertices.0000000000000abc.41.1x"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        problem = (api_problem){0};
        assert_false(api_cursor_read(bad[i], "vertices", &facts, &position, &problem));
        assert_int_equal(problem.code, API_BAD_CURSOR);
    }
    /* A cursor keeps its revision while the mesh is edited, and becomes invalid if the mesh is
     * deleted and another one is created with its id. */
    st_mesh_info later = facts;
    uint64_t pinned = 0;
    later.revision++;
    assert_true(api_cursor_pins(text, &later, &pinned));
    assert_int_equal(pinned, facts.revision);
    later.incarnation++;
    assert_false(api_cursor_pins(text, &later, &pinned));
    assert_false(api_cursor_pins("vertices", &facts, &pinned));
    problem = (api_problem){0};
    assert_false(api_cursor_read(text, "vertices", &later, &position, &problem));
    assert_int_equal(problem.code, API_REVISION_GONE);
    assert_int_equal(api_problem_http(&problem), 410);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_are_split_before_they_are_decoded),
        cmocka_unit_test(queries_are_pairs),
        cmocka_unit_test(ids_in_paths_are_digits),
        cmocka_unit_test(accept_is_read_with_its_weights),
        cmocka_unit_test(content_types_are_compared_without_parameters),
        cmocka_unit_test(entity_tags_name_state_and_representation),
        cmocka_unit_test(content_codings_are_chosen_by_weight),
        cmocka_unit_test(one_content_coding_is_taken),
        cmocka_unit_test(cursors_come_back_or_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
