/* Mesh documents in JSON are read in pieces, and written. */
#include "api/document/document_in.h"
#include "api/document/document_out.h"

#include "api/limits.h"
#include "fixture.h"
#include "mesh/compact.h"
#include "mesh/write.h"
#include "repair/repair.h"
#include "tests/failing.h"

#include <stdint.h>

/* The outcome of reading a document: HE_OK or an error code, and the JSON pointer to the error. */
typedef struct outcome {
    int code;
    char pointer[API_PROBLEM_POINTER];
} outcome;

static outcome feed(const char *body, size_t length, size_t step, api_document_in **out)
{
    api_document_in *in = api_document_in_new(NULL);
    assert_non_null(in);
    api_problem problem = {0};
    bool good = true;
    for (size_t at = 0; good && at < length; at += step) {
        size_t size = length - at < step ? length - at : step;
        /* The piece is copied to a block of its exact size, so that the sanitizer detects reads
         * beyond the end of the piece. */
        char *piece = malloc(size);
        assert_non_null(piece);
        memcpy(piece, body + at, size);
        good = api_document_in_feed(in, piece, size, &problem);
        free(piece);
    }
    good = good && api_document_in_end(in, &problem);
    assert_int_equal(good, problem.code == HE_OK);
    outcome result = {.code = problem.code};
    memcpy(result.pointer, problem.pointer, sizeof result.pointer);
    if (out != NULL && good) {
        *out = in;
    } else {
        api_document_in_free(in);
    }
    return result;
}

static const struct {
    const char *body;
    int code;
    const char *pointer; /* expected JSON pointer to the error; "-" if the test does not check it */
} bodies[] = {
    {"{}", HE_OK, "-"},
    {"{\"vertices\":[],\"faces\":[]}", HE_OK, "-"},
    {"{\"name\":\"a\",\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2]]}", HE_OK, "-"},
    {" {\n\"faces\" : [ [ 0 , 1 , 2 ] ] ,\t\"vertices\":[ [ 0 , 0.5 , -1e-3 ] ] } \r\n", HE_OK,
     "-"},
    {"{\"f\\u0061ces\":[[0,1,2]],\"vertices\":[]}", HE_OK, "-"},
    {"{\"shape\":\"cube\",\"size\":2}", HE_OK, "-"},
    {"{\"attributes\":[{\"domain\":\"mesh\",\"name\":\"a\\\\\\\"]}\",\"type\":\"double\","
     "\"values\":[-1.5e-7]},{\"values\":[[1,2.25],[3,4]],\"components\":2,\"default\":[ 7 , 8 ],"
     "\"type\":\"float\",\"labels\":1,\"name\":\"b\",\"domain\":\"vertices\"}]}",
     HE_BAD_VALUE, "/attributes/1/labels"},
    {"{\"attribut\\u0065s\":[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"bool\","
     "\"values\":[true, false,true ]}, {\"type\":\"int32\",\"domain\":\"edges\",\"name\":\"a\"} ] "
     "}",
     HE_OK, "-"},
    {"{\"attributes\":[],\"attributes\":[]}", API_DUPLICATE_MEMBER, ""},
    {"{\"materials\" : [ ] , \"name\":\"a\"}", HE_OK, "-"},
    {"{\"name\":\"a\",\"material\\u0073\":[{\"name\":\"a ] } \\\" b\"},{\"name\":\"c\","
     "\"base_color\":[1,0,0],\"metallic\":1,\"roughness\":0,\"emission\":[9,0,0],\"two_sided\":"
     "true}]}",
     HE_OK, "-"},
    {"{\"materials\":[],\"materials\":[]}", API_DUPLICATE_MEMBER, ""},
    {"{\"materials\":{}}", API_WRONG_TYPE, "/materials"},
    {"{\"materials\":[1]}", API_WRONG_TYPE, "/materials/0"},
    {"{\"materials\":[{}]}", API_MISSING_MEMBER, "/materials/0"},
    {"{\"materials\":[{\"name\":\"\"}]}", HE_BAD_VALUE, "/materials/0"},
    {"{\"materials\":[{\"name\":\"a\"},{\"name\":\"a\"}]}", API_DUPLICATE_MEMBER,
     "/materials/1/name"},
    {"{\"materials\":[{\"name\":\"a\",\"color\":1}]}", API_UNKNOWN_MEMBER, "/materials/0/color"},
    {"{\"materials\":[{\"name\":\"a\",\"base_color\":[1,0]}]}", HE_BAD_VALUE,
     "/materials/0/base_color"},
    {"{\"materials\":[{\"name\":\"a\",\"base_color\":[1,0,-1]}]}", HE_BAD_VALUE,
     "/materials/0/base_color/2"},
    {"{\"materials\":[{\"name\":\"a\",\"base_color\":[1,0,2]}]}", HE_BAD_VALUE, "/materials/0"},
    {"{\"materials\":[{\"name\":\"a\",\"emission\":[1,0,0,1]}]}", HE_BAD_VALUE,
     "/materials/0/emission"},
    {"{\"materials\":[{\"name\":\"a\",\"metallic\":1.5}]}", HE_BAD_VALUE, "/materials/0/metallic"},
    {"{\"materials\":[{\"name\":\"a\",\"two_sided\":1}]}", API_WRONG_TYPE,
     "/materials/0/two_sided"},
    {"{\"materials\":[{\"name\":\"a\"]}", API_MALFORMED_JSON, "-"},
    {"{\"attributes\":[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"bool\",\"values\":[tru]}]}",
     API_MALFORMED_JSON, "/attributes/0/values/0"},
    {"{\"attributes\":[{\"values\":[1,2", API_MALFORMED_JSON, ""},
    {"{\"a\":{\"x\":[1,{\"]\":\"}\\\"],\"}]},\"vertices\":[[1,2,3]]}", HE_OK, "-"},
    {"{\"vertices\":[[1.0,-0,1e5]],\"faces\":[[1.0,2e0,-0]]}", HE_OK, "-"},
    {"{\"faces\":[[]]}", HE_OK, "-"},
    {"{\"faces\":[[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18]]}", HE_OK, "-"},
    {"{\"faces\":[[4294967293]]}", HE_OK, "-"},
    /* not JSON */
    {"", API_MALFORMED_JSON, ""},
    {" ", API_MALFORMED_JSON, ""},
    {"[]", API_MALFORMED_JSON, ""},
    {"null", API_MALFORMED_JSON, ""},
    {"\xEF\xBB\xBF{}", API_MALFORMED_JSON, ""},
    {"{", API_MALFORMED_JSON, ""},
    {"{}}", API_MALFORMED_JSON, ""},
    {"{} 1", API_MALFORMED_JSON, ""},
    {"{,}", API_MALFORMED_JSON, ""},
    {"{\"vertices\":[],}", API_MALFORMED_JSON, ""},
    {"{\"vertices\"}", API_MALFORMED_JSON, ""},
    {"{\"vertices\":}", API_MALFORMED_JSON, "/vertices"},
    {"{\"vertices\":[", API_MALFORMED_JSON, "-"},
    {"{\"vertices\":[[1,2,3", API_MALFORMED_JSON, "-"},
    {"{\"vertices\":[[1,2,3],]}", API_MALFORMED_JSON, "/vertices/1"},
    {"{\"vertices\":[[1,2,3][1,2,3]]}", API_MALFORMED_JSON, "-"},
    {"{\"vertices\":[[1,2 3]]}", API_MALFORMED_JSON, "-"},
    {"{\"vertices\":[[1,2,]]}", API_MALFORMED_JSON, "/vertices/0/2"},
    {"{\"vertices\":[[,2,3]]}", API_MALFORMED_JSON, "/vertices/0/0"},
    {"{\"vertices\":[[1,2,3}]}", API_MALFORMED_JSON, "-"},
    {"{\"vertices\":[[01,2,3]]}", API_MALFORMED_JSON, "/vertices/0/0"},
    {"{\"vertices\":[[1.,2,3]]}", API_MALFORMED_JSON, "/vertices/0/0"},
    {"{\"vertices\":[[1,.5,3]]}", API_MALFORMED_JSON, "/vertices/0/1"},
    {"{\"vertices\":[[1,+2,3]]}", API_MALFORMED_JSON, "/vertices/0/1"},
    {"{\"vertices\":[[1,2,1e]]}", API_MALFORMED_JSON, "/vertices/0/2"},
    {"{\"vertices\":[[1,2,-]]}", API_MALFORMED_JSON, "/vertices/0/2"},
    {"{\"vertices\":[[1,2,NaN]]}", API_MALFORMED_JSON, "/vertices/0/2"},
    {"{\"vertices\":[[1,2,0x1]]}", API_MALFORMED_JSON, "-"},
    {"{\"faces\":[[0,1,02]]}", API_MALFORMED_JSON, "/faces/0/2"},
    {"{\"faces\":[[0,1,2-]]}", API_MALFORMED_JSON, "/faces/0/2"},
    {"{\"name\":}", API_MALFORMED_JSON, "-"},
    {"{\"name\":tru}", API_MALFORMED_JSON, "-"},
    {"{\"name\":[}", API_MALFORMED_JSON, "-"},
    {"{\"name\":1]}", API_MALFORMED_JSON, "-"},
    {"{\"name\":\"\\ud800\"}", API_MALFORMED_JSON, "/name"},
    {"{\"name\":\"\xFF\"}", API_MALFORMED_JSON, "/name"},
    {"{\"na\\x\":1}", API_MALFORMED_JSON, "-"},
    {"{\"name\":\"\\u0000\"}", API_MALFORMED_JSON, "/name"},
    {"{\"a\":[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]}",
     API_MALFORMED_JSON, "-"},
    /* members given twice */
    {"{\"vertices\":[],\"vertices\":[]}", API_DUPLICATE_MEMBER, "/vertices"},
    {"{\"vertices\":[],\"\\u0076ertices\":[]}", API_DUPLICATE_MEMBER, "/vertices"},
    {"{\"faces\":[],\"faces\":[[0,1,2]]}", API_DUPLICATE_MEMBER, "/faces"},
    {"{\"name\":\"a\",\"vertices\":[],\"name\":\"b\"}", API_DUPLICATE_MEMBER, "/name"},
    /* members of wrong types or with invalid values */
    {"{\"vertices\":null}", API_WRONG_TYPE, "/vertices"},
    {"{\"vertices\":{}}", API_WRONG_TYPE, "/vertices"},
    {"{\"vertices\":[1,2,3]}", API_WRONG_TYPE, "/vertices/0"},
    {"{\"vertices\":[[1,2,3],{}]}", API_WRONG_TYPE, "/vertices/1"},
    {"{\"vertices\":[[1,2,\"3\"]]}", API_WRONG_TYPE, "/vertices/0/2"},
    {"{\"vertices\":[[1,2,null]]}", API_WRONG_TYPE, "/vertices/0/2"},
    {"{\"vertices\":[[1,2,[3]]]}", API_WRONG_TYPE, "/vertices/0/2"},
    {"{\"vertices\":[[1,2]]}", HE_BAD_VALUE, "/vertices/0"},
    {"{\"vertices\":[[1,2,3],[]]}", HE_BAD_VALUE, "/vertices/1"},
    {"{\"vertices\":[[1,2,3,4]]}", HE_BAD_VALUE, "/vertices/0"},
    {"{\"vertices\":[[1,2,1e999]]}", HE_NOT_FINITE, "/vertices/0/2"},
    {"{\"vertices\":[[1,-1e309,0]]}", HE_NOT_FINITE, "/vertices/0/1"},
    {"{\"faces\":[[0,1,-1]]}", HE_BAD_VALUE, "/faces/0/2"},
    {"{\"faces\":[[0,1,2],[0,1,1.5]]}", HE_BAD_VALUE, "/faces/1/2"},
    {"{\"faces\":[[0,1,\"2\"]]}", API_WRONG_TYPE, "/faces/0/2"},
    {"{\"faces\":[[0,4294967294,2]]}", HE_BAD_INDEX, "/faces/0/1"},
    {"{\"faces\":[[0,4294967297,2]]}", HE_BAD_INDEX, "/faces/0/1"},
    {"{\"faces\":[[0,18446744073709551617,2]]}", HE_BAD_INDEX, "/faces/0/1"},
};

static void pieces_do_not_matter(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bodies / sizeof bodies[0]; i++) {
        size_t length = strlen(bodies[i].body);
        for (size_t step = 1; step <= length + 1; step++) {
            outcome result = feed(bodies[i].body, length, step, NULL);
            if (result.code != bodies[i].code || (strcmp(bodies[i].pointer, "-") != 0 &&
                                                  strcmp(bodies[i].pointer, result.pointer) != 0)) {
                fail_msg("%s in steps of %zu: %s at \"%s\"", bodies[i].body, step,
                         api_code_slug(result.code), result.pointer);
            }
        }
    }
}

static const char sample[] =
    "{\"vertices\":[[0.1,-2.5e-300,9007199254740993],[123456.789,1e22,4.9e-324],"
    "[0.30000000000000004,7,8],[1,2,3]],\"name\":\"n\\u00e9\",\"extra\":[{\"a\":1}],"
    "\"faces\":[[0,1,2],[2,1,3,0,17,4000000000]]}";

static void all_pieces_give_the_same_soup(void **state)
{
    (void)state;
    static const double positions[][3] = {
        {0.1, -2.5e-300, 9007199254740993.0},
        {123456.789, 1e22, 4.9e-324},
        {0.30000000000000004, 7, 8},
        {1, 2, 3},
    };
    static const uint32_t corners[] = {0, 1, 2, 2, 1, 3, 0, 17, 4000000000u};
    size_t length = strlen(sample);
    for (size_t step = 1; step <= length; step++) {
        api_document_in *in = NULL;
        assert_int_equal(feed(sample, length, step, &in).code, HE_OK);
        const he_soup *soup = api_document_in_soup(in);
        assert_int_equal(soup->vertex_count, 4);
        assert_memory_equal(soup->positions, positions, sizeof positions);
        assert_int_equal(soup->face_count, 2);
        assert_int_equal(soup->corner_count, 9);
        assert_memory_equal(soup->corners, corners, sizeof corners);
        assert_true(api_document_in_has_vertices(in) && api_document_in_has_faces(in));
        api_in name;
        const char *text;
        const api_in *rest = api_document_in_rest(in);
        assert_int_equal(api_in_count(rest), 2);
        assert_true(api_in_find(rest, "name", &name) && api_in_string(&name, 100, &text));
        assert_string_equal(text, "n\xC3\xA9");
        api_document_in_free(in);
    }
}

static void what_is_gathered_is_bounded(void **state)
{
    (void)state;
    size_t length = API_MAX_CONTROL + 64;
    char *body = malloc(length);
    assert_non_null(body);
    memset(body, 'x', length);
    memcpy(body, "{\"name\":\"", 9);
    memcpy(body + length - 2, "\"}", 2);
    assert_int_equal(feed(body, length, 65536, NULL).code, HE_LIMIT);
    /* A member name that does not end within the body must be refused without being stored. */
    memset(body + 2, 'k', length - 2);
    assert_int_equal(feed(body, length, 65536, NULL).code, API_UNKNOWN_MEMBER);
    /* A number that does not end within the body must be refused without being stored. */
    memset(body, '0', length);
    memcpy(body, "{\"vertices\":[[1.", 16);
    assert_int_equal(feed(body, length, 7, NULL).code, HE_BAD_VALUE);
    assert_int_equal(feed(body, length, length, NULL).code, HE_BAD_VALUE);
    free(body);
}

static void limits_of_the_soup_are_kept(void **state)
{
    (void)state;
    api_document_in *in = api_document_in_new(&(he_limits){.vertices = 2});
    api_problem problem = {0};
    static const char body[] = "{\"vertices\":[[1,2,3],[1,2,3],[1,2,3]]}";
    assert_false(api_document_in_feed(in, body, strlen(body), &problem));
    assert_int_equal(api_problem_http(&problem), 413);
    assert_string_equal(problem.pointer, "/vertices/2");
    api_document_in_free(in);
}

static void every_failed_allocation_while_reading_is_a_problem(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        api_problem problem = {0};
        api_document_in *in = api_document_in_new(NULL);
        for (size_t at = 0; in != NULL && problem.code == HE_OK && at < strlen(sample); at += 9) {
            size_t left = strlen(sample) - at;
            if (!api_document_in_feed(in, sample + at, left < 9 ? left : 9, &problem)) {
                assert_int_equal(problem.code, HE_NO_MEMORY);
            }
        }
        bool good = in != NULL && problem.code == HE_OK && api_document_in_end(in, &problem);
        failing_end(&f, good);
        api_document_in_free(in);
    }
    assert_true(f.n > 10);
}

static const char attributed[] =
    "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0],[0,0,0]],\"faces\":[[0,1,2],[0,1],[2,1,0]],"
    "\"attributes\":[{\"domain\":\"vertices\",\"name\":\"a\",\"type\":\"float\",\"components\":2,"
    "\"values\":[[1,2],[3,4],[5,6],[7,8]]},{\"domain\":\"faces\",\"name\":\"b\",\"type\":"
    "\"uint32\","
    "\"labels\":[\"x\",\"y\"],\"values\":[0,1,0]},{\"domain\":\"mesh\",\"name\":\"c\",\"type\":"
    "\"bool\","
    "\"values\":[true]}],\"name\":\"n\"}";

/* Reads a document with attributes, repairs its faces and builds a mesh; if an allocation fails,
 * returns NULL and sets the problem to HE_NO_MEMORY. */
static he_mesh *make_attributed(api_problem *problem)
{
    const he_repair_plan plan = {.which = he_repair_bit(HE_REPAIR_WELD) |
                                          he_repair_bit(HE_REPAIR_DROP_DEGENERATE) |
                                          he_repair_bit(HE_REPAIR_DROP_DUPLICATES)};
    he_repaired done = {0};
    he_mesh *mesh = NULL;
    api_document_in *in = api_document_in_new(NULL);
    if (in == NULL) {
        problem->code = HE_NO_MEMORY;
        return NULL;
    }
    if (api_document_in_feed(in, attributed, sizeof attributed - 1, problem) &&
        api_document_in_end(in, problem)) {
        he_soup *soup = api_document_in_soup(in);
        he_status status = HE_NO_MEMORY;
        if (api_document_in_lend(in, problem)) {
            status = he_repair_soup(soup, &plan, &done, NULL);
        }
        if (status == HE_OK) {
            status = he_build(soup, HE_BUILD_TAKE, &mesh, NULL, NULL);
        }
        problem->code = (int)status;
        if (status == HE_OK &&
            !api_document_in_attributes(in, mesh, he_repaired_soup(&done), problem)) {
            he_mesh_free(mesh);
            mesh = NULL;
        }
    }
    he_repaired_clear(&done);
    api_document_in_free(in);
    return mesh;
}

/* The test lets each allocation fail in turn. If the failed allocation was optional, such as one
 * that shrinks a block, the mesh must still be made. */
static void every_failed_allocation_of_attributes_and_repairs_is_a_problem(void **state)
{
    (void)state;
    long refused = 0;
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        api_problem problem = {0};
        he_mesh *mesh = make_attributed(&problem);
        failing_end(&f, mesh != NULL);
        assert_int_equal(problem.code, mesh != NULL ? HE_OK : HE_NO_MEMORY);
        refused += mesh == NULL;
        if (mesh != NULL) {
            fixture_check(mesh);
            fixture_counts(mesh, 3, 3, 1);
            assert_int_equal(he_mesh_columns(mesh), 3);
        }
        he_mesh_free(mesh);
    }
    assert_true(refused > 30);
}

/* Writes a document in pieces of `step` bytes; returns the text, which the caller must free. */
static char *write_all(const he_mesh *mesh, const char *name, size_t step, size_t *length)
{
    api_document_out *out = api_document_out_new(mesh, name);
    assert_non_null(out);
    size_t used = 0, capacity = 1 << 20;
    char *text = malloc(capacity + step);
    assert_non_null(text);
    int64_t got;
    while ((got = api_document_out_read(out, text + used, step)) > 0) {
        used += (size_t)got;
        assert_true(used <= capacity);
    }
    assert_int_equal(got, 0);
    assert_int_equal(api_document_out_read(out, text + used, step), 0);
    api_document_out_free(out);
    *length = used;
    return text;
}

static he_mesh *read_back(const char *text, size_t length)
{
    api_document_in *in = NULL;
    he_mesh *mesh = NULL;
    outcome result = feed(text, length, 1000, &in);
    assert_int_equal(result.code, HE_OK);
    assert_int_equal(he_build(api_document_in_soup(in), HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    api_document_in_free(in);
    return mesh;
}

/* Writes a mesh as a document, in pieces of several sizes in turn. Reading the document back must
 * always give an equal mesh. */
static void expect_comes_back(const he_mesh *mesh, const char *name)
{
    size_t length;
    for (size_t step = 1; step < 200; step = step * 3 + 1) {
        char *text = write_all(mesh, name, step, &length);
        he_mesh *again = read_back(text, length);
        assert_true(he_mesh_equal(mesh, again));
        he_mesh_free(again);
        free(text);
    }
}

static void a_document_makes_its_mesh_again(void **state)
{
    (void)state;
    static const char *const meshes[] = {"", "012", "0123,7654,1045,2156,3267,0374", "012,034,056"};
    for (size_t i = 0; i < sizeof meshes / sizeof meshes[0]; i++) {
        he_mesh *mesh = fixture_mesh(meshes[i]);
        expect_comes_back(mesh, "a \"b\"");
        he_mesh_free(mesh);
    }
}

static void materials_come_back_with_their_names(void **state)
{
    (void)state;
    static const he_look look = {.base_color = {0.1, 1e-7, 1, 0.5},
                                 .metallic = 0.25,
                                 .roughness = 0.75,
                                 .emission = {0, 1e300, 2},
                                 .two_sided = true};
    static const char *const names[] = {"red", "K\xc3\xb6rper \"1\"", "tab\there"};
    he_mesh *mesh = fixture_mesh("012");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        he_material *row = NULL;
        assert_int_equal(he_material_new(names[i], strlen(names[i]),
                                         i == 1 ? &look : &he_plain_look, &row, NULL),
                         HE_OK);
        assert_int_equal(he_mesh_put_material(mesh, i, row, NULL), HE_OK);
        expect_comes_back(mesh, "t");
    }
    he_mesh_free(mesh);
}

static void text_is_one_item_a_line(void **state)
{
    (void)state;
    he_mesh *mesh = fixture_mesh("012");
    size_t length;
    char *text = write_all(mesh, "t", 4096, &length);
    static const char expected[] = "{\"name\":\"t\",\"vertices\":[\n[0,0,0],\n[1,3,1],\n[4,1,2]],\n"
                                   "\"faces\":[\n[0,1,2]]}\n";
    assert_int_equal(length, strlen(expected));
    assert_memory_equal(text, expected, length);
    free(text);
    he_mesh_free(mesh);
}

static void a_large_document_is_cut_anywhere(void **state)
{
    (void)state;
    /* Number of quadrilaterals in a strip, enough to make its document larger than the writer's
     * buffer. */
    enum { QUADS = 5000 };
    he_soup soup;
    he_mesh *mesh = NULL;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i <= QUADS; i++) {
        for (int side = 0; side < 2; side++) {
            he_vec3 p = {i / 3.0, side, 1.0 / (i + 1)};
            assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
        }
    }
    for (uint32_t i = 0; i < QUADS; i++) {
        uint32_t quad[4] = {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1};
        assert_int_equal(he_soup_add_face(&soup, quad, 4, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    for (size_t step = 777; step < 200000; step *= 17) {
        size_t length;
        char *text = write_all(mesh, "strip", step, &length);
        he_mesh *again = read_back(text, length);
        assert_true(he_mesh_equal(mesh, again));
        he_mesh_free(again);
        free(text);
    }
    he_mesh_free(mesh);
}

static void every_failed_allocation_of_the_writer_gives_null(void **state)
{
    (void)state;
    he_soup soup;
    he_column *column;
    he_mesh *mesh = NULL;
    fixture_soup(&soup, "012,021");
    assert_int_equal(he_soup_column(&soup,
                                    &(he_column_schema){"a", HE_HALFEDGE, HE_FLOAT, 1, HE_COPY},
                                    &column, NULL),
                     HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    failing f = {0};
    while (failing_next(&f)) {
        api_document_out *out = api_document_out_new(mesh, "name");
        failing_end(&f, out != NULL);
        api_document_out_free(out);
    }
    he_mesh_free(mesh);
    assert_true(f.n > 1);
}

int main(void)
{
    api_in_setup();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_do_not_matter),
        cmocka_unit_test(all_pieces_give_the_same_soup),
        cmocka_unit_test(what_is_gathered_is_bounded),
        cmocka_unit_test(limits_of_the_soup_are_kept),
        cmocka_unit_test(every_failed_allocation_while_reading_is_a_problem),
        cmocka_unit_test(every_failed_allocation_of_attributes_and_repairs_is_a_problem),
        cmocka_unit_test(a_document_makes_its_mesh_again),
        cmocka_unit_test(materials_come_back_with_their_names),
        cmocka_unit_test(text_is_one_item_a_line),
        cmocka_unit_test(a_large_document_is_cut_anywhere),
        cmocka_unit_test(every_failed_allocation_of_the_writer_gives_null),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
