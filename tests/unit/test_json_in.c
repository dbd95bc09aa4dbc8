#include "api/json/json_in.h"

#include "api/limits.h"
#include "fixture.h"
#include "tests/failing.h"

#include <stdint.h>

/* A JSON body, the expected error code, and the expected JSON pointer to the error, where "-"
 * stands for any pointer. */
typedef struct body_case {
    const char *body;
    int code;
    const char *pointer;
} body_case;

static const body_case cases[] = {
    /* well-formed bodies */
    {"{}", HE_OK, "-"},
    {"[]", HE_OK, "-"},
    {" \t\r\n{ } \n", HE_OK, "-"},
    {"0", HE_OK, "-"},
    {"-0", HE_OK, "-"},
    {"1e5", HE_OK, "-"},
    {"1E+5", HE_OK, "-"},
    {"0.5e-3", HE_OK, "-"},
    {"1e-999", HE_OK, "-"},
    {"\"\"", HE_OK, "-"},
    {"\"\\u00e9\\ud83d\\ude00\\n\\/\"", HE_OK, "-"},
    {"\"\xC3\xA9\xF0\x9F\x98\x80\x7F\"", HE_OK, "-"},
    {"[true,false,null]", HE_OK, "-"},
    {"{\"a\":{\"a\":{\"a\":1}}}", HE_OK, "-"},
    {"{\"a\":1,\"A\":2}", HE_OK, "-"},
    /* empty bodies, and bodies with more text after the JSON value */
    {"", API_MALFORMED_JSON, ""},
    {"   ", API_MALFORMED_JSON, ""},
    {"{} {}", API_MALFORMED_JSON, ""},
    {"1 2", API_MALFORMED_JSON, ""},
    {"{}x", API_MALFORMED_JSON, ""},
    {"[],", API_MALFORMED_JSON, ""},
    {"\xEF\xBB\xBF{}", API_MALFORMED_JSON, ""},
    {"\xFF\xFE{", API_MALFORMED_JSON, ""},
    {"{}\x01", API_MALFORMED_JSON, ""},
    {"\f{}", API_MALFORMED_JSON, ""},
    {"// x\n{}", API_MALFORMED_JSON, ""},
    {"/**/{}", API_MALFORMED_JSON, ""},
    /* mistakes in brackets and commas */
    {"{", API_MALFORMED_JSON, "-"},
    {"[", API_MALFORMED_JSON, "-"},
    {"}", API_MALFORMED_JSON, ""},
    {"]", API_MALFORMED_JSON, ""},
    {"[1", API_MALFORMED_JSON, "-"},
    {"[1,", API_MALFORMED_JSON, "/1"},
    {"[1,]", API_MALFORMED_JSON, "/1"},
    {"[,1]", API_MALFORMED_JSON, "/0"},
    {"[1,,2]", API_MALFORMED_JSON, "/1"},
    {"[1 2]", API_MALFORMED_JSON, "/0"},
    {"[1}", API_MALFORMED_JSON, "/0"},
    {"{]", API_MALFORMED_JSON, "-"},
    {"{\"a\":1]", API_MALFORMED_JSON, "/a"},
    {"{\"a\":1,}", API_MALFORMED_JSON, "-"},
    {"{,}", API_MALFORMED_JSON, "-"},
    {"{\"a\"}", API_MALFORMED_JSON, "/a"},
    {"{\"a\" 1}", API_MALFORMED_JSON, "/a"},
    {"{\"a\":}", API_MALFORMED_JSON, "/a"},
    {"{a:1}", API_MALFORMED_JSON, "-"},
    {"{'a':1}", API_MALFORMED_JSON, "-"},
    {"{1:1}", API_MALFORMED_JSON, "-"},
    {"{\"a\":1 \"b\":2}", API_MALFORMED_JSON, "/a"},
    {"[[[]]", API_MALFORMED_JSON, "-"},
    {"[[]]]", API_MALFORMED_JSON, "-"},
    /* mistakes in true, false and null */
    {"nul", API_MALFORMED_JSON, ""},
    {"True", API_MALFORMED_JSON, ""},
    {"tru", API_MALFORMED_JSON, ""},
    {"truex", API_MALFORMED_JSON, ""},
    {"NaN", API_MALFORMED_JSON, ""},
    {"nan", API_MALFORMED_JSON, ""},
    {"Infinity", API_MALFORMED_JSON, ""},
    {"-Infinity", API_MALFORMED_JSON, ""},
    {"undefined", API_MALFORMED_JSON, ""},
    /* mistakes in numbers */
    {"01", API_MALFORMED_JSON, ""},
    {"-01", API_MALFORMED_JSON, ""},
    {"00", API_MALFORMED_JSON, ""},
    {"1.", API_MALFORMED_JSON, ""},
    {".5", API_MALFORMED_JSON, ""},
    {"-.5", API_MALFORMED_JSON, ""},
    {"+1", API_MALFORMED_JSON, ""},
    {"--1", API_MALFORMED_JSON, ""},
    {"-", API_MALFORMED_JSON, ""},
    {"1e", API_MALFORMED_JSON, ""},
    {"1e+", API_MALFORMED_JSON, ""},
    {"1.e5", API_MALFORMED_JSON, ""},
    {"1e5.5", API_MALFORMED_JSON, ""},
    {"0x10", API_MALFORMED_JSON, ""},
    {"1,5", API_MALFORMED_JSON, ""},
    {"1_000", API_MALFORMED_JSON, ""},
    {"[1.2.3]", API_MALFORMED_JSON, "/0"},
    {"1e999", HE_NOT_FINITE, ""},
    {"[0,-1e400]", HE_NOT_FINITE, "/1"},
    {"{\"t\":1e309}", HE_NOT_FINITE, "/t"},
    {"[0.0000000000000000000000000000000000000000000000000000000000001]", HE_BAD_VALUE, "/0"},
    /* mistakes in strings */
    {"\"", API_MALFORMED_JSON, ""},
    {"\"a", API_MALFORMED_JSON, ""},
    {"\"\\\"", API_MALFORMED_JSON, ""},
    {"\"\\", API_MALFORMED_JSON, ""},
    {"\"\\x\"", API_MALFORMED_JSON, ""},
    {"\"\\a\"", API_MALFORMED_JSON, ""},
    {"\"\\u12\"", API_MALFORMED_JSON, ""},
    {"\"\\u12G4\"", API_MALFORMED_JSON, ""},
    {"\"\\u 123\"", API_MALFORMED_JSON, ""},
    {"\"\\u0000\"", API_MALFORMED_JSON, ""},
    {"{\"a\\u0000b\":1}", API_MALFORMED_JSON, "-"},
    {"\"\\ud800\"", API_MALFORMED_JSON, ""},
    {"\"\\udc00\"", API_MALFORMED_JSON, ""},
    {"\"\\ud800\\ud800\"", API_MALFORMED_JSON, ""},
    {"\"\\ud83dx\"", API_MALFORMED_JSON, ""},
    {"\"\\ud83d\\u0041\"", API_MALFORMED_JSON, ""},
    {"\"a\tb\"", API_MALFORMED_JSON, ""},
    {"\"a\nb\"", API_MALFORMED_JSON, ""},
    {"\"\x01\"", API_MALFORMED_JSON, ""},
    {"\"\x80\"", API_MALFORMED_JSON, ""},
    {"\"\xC3\"", API_MALFORMED_JSON, ""},
    {"\"\xC0\xAF\"", API_MALFORMED_JSON, ""},
    {"\"\xE0\x80\xAF\"", API_MALFORMED_JSON, ""},
    {"\"\xED\xA0\x80\"", API_MALFORMED_JSON, ""},
    {"\"\xF4\x90\x80\x80\"", API_MALFORMED_JSON, ""},
    {"\"\xF8\x88\x80\x80\x80\"", API_MALFORMED_JSON, ""},
    {"\"\xFF\"", API_MALFORMED_JSON, ""},
    {"'a'", API_MALFORMED_JSON, ""},
    /* a member that occurs twice in an object, with a name that may be escaped the second time */
    {"{\"a\":1,\"a\":2}", API_DUPLICATE_MEMBER, "/a"},
    {"{\"a\":1,\"\\u0061\":2}", API_DUPLICATE_MEMBER, "/a"},
    {"[{},{\"x\":{\"b\":1,\"c\":2,\"b\":1}}]", API_DUPLICATE_MEMBER, "/1/x/b"},
    {"{\"\":1,\"\":2}", API_DUPLICATE_MEMBER, "/"},
    {"{\"a/b~c\":1,\"a/b~c\":2}", API_DUPLICATE_MEMBER, "/a~1b~0c"},
    {"{\"a/b\":[01]}", API_MALFORMED_JSON, "/a~1b/0"},
};

/* The values of a body that was parsed, or the problem for which it was refused. */
typedef struct parsed {
    api_document document;
    api_in root;
    api_problem problem;
} parsed;

/* Parses a body; a body with more than `values` JSON values must be refused. */
static bool parse(const char *body, size_t length, size_t values, parsed *p)
{
    const api_in_options options = {.values = values};
    return api_document_parse((api_bytes){body, length}, &options, &p->document, &p->root,
                              &p->problem);
}

static void hostile_bodies_are_refused_exactly(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const body_case *c = &cases[i];
        parsed p = {0};
        /* The body is copied to a block of its exact size, so that the address sanitizer detects a
         * read beyond its end. */
        size_t length = strlen(c->body);
        char *body = malloc(length + 1);
        assert_non_null(body);
        char *exact = length == 0 ? body : realloc(body, length);
        memcpy(exact, c->body, length);
        bool good = parse(exact, length, 1000, &p);
        if (good != (c->code == HE_OK) || p.problem.code != c->code ||
            (strcmp(c->pointer, "-") != 0 && strcmp(c->pointer, p.problem.pointer) != 0)) {
            fail_msg("%s: %s at \"%s\" (%s)", c->body, api_code_slug(p.problem.code),
                     p.problem.pointer, p.problem.detail);
        }
        api_document_clear(&p.document);
        free(exact);
    }
}

static void depth_and_number_of_values_are_bounded(void **state)
{
    (void)state;
    char body[2 * API_MAX_DEPTH + 8];
    for (int depth = API_MAX_DEPTH; depth <= API_MAX_DEPTH + 1; depth++) {
        memset(body, '[', (size_t)depth);
        memset(body + depth, ']', (size_t)depth);
        parsed p = {0};
        assert_int_equal(parse(body, 2 * (size_t)depth, 1000, &p), depth == API_MAX_DEPTH);
        assert_int_equal(p.problem.code, depth == API_MAX_DEPTH ? HE_OK : API_MALFORMED_JSON);
        api_document_clear(&p.document);
    }
    parsed p = {0};
    assert_true(parse("[1,2,3]", 7, 4, &p));
    api_document_clear(&p.document);
    assert_false(parse("[1,2,3]", 7, 3, &p));
    assert_int_equal(api_problem_http(&p.problem), 413);
    /* A hundred thousand brackets, opened and never closed, must not overflow the stack. */
    static char deep[100000];
    memset(deep, '[', sizeof deep);
    p.problem = (api_problem){0};
    assert_false(parse(deep, sizeof deep, 1000000, &p));
}

static void objects_have_a_bounded_number_of_members(void **state)
{
    (void)state;
    char body[8 * (API_MAX_MEMBERS + 2)];
    for (int members = API_MAX_MEMBERS; members <= API_MAX_MEMBERS + 1; members++) {
        size_t used = 0;
        for (int i = 0; i < members; i++) {
            used += (size_t)snprintf(body + used, sizeof body - used, "%s\"%d\":1",
                                     i == 0 ? "{" : ",", i);
        }
        body[used++] = '}';
        parsed p = {0};
        assert_int_equal(parse(body, used, 10000, &p), members == API_MAX_MEMBERS);
        api_document_clear(&p.document);
    }
}

/* The type as which the member "v" of a document is read, and the limits of its value. */
typedef enum reader {
    READ_BOOL,
    READ_NUMBER,
    READ_OPEN_RANGE, /* a number greater than 0 and less than 1 */
    READ_U64,        /* a whole number from 1 to 10 */
    READ_ID,
    READ_IDS,
    READ_VEC3,
    READ_STRING, /* a string of at most 4 bytes */
    READ_CHOICE, /* the string "a" or "b" */
    READ_ELEMENT
} reader;

static bool read_value(reader how, const api_in *in, api_arena *arena)
{
    bool flag;
    double number;
    uint64_t whole;
    uint32_t id, *ids;
    size_t count;
    he_vec3 point;
    const char *text;
    int choice;
    he_kind kind;
    switch (how) {
    case READ_BOOL:
        return api_in_bool(in, &flag);
    case READ_NUMBER:
        return api_in_number(in, &number);
    case READ_OPEN_RANGE:
        return api_in_number_within(in, 0, 1, true, &number);
    case READ_U64:
        return api_in_u64(in, 1, 10, &whole);
    case READ_ID:
        return api_in_id(in, &id);
    case READ_IDS:
        return api_in_ids(in, 1, arena, &ids, &count);
    case READ_VEC3:
        return api_in_vec3(in, &point);
    case READ_STRING:
        return api_in_string(in, 4, &text);
    case READ_CHOICE:
        return api_in_choice(in, (const char *const[]){"a", "b", NULL}, &choice);
    case READ_ELEMENT:
        return api_in_element(in, &kind, &id);
    }
    return false;
}

static const struct {
    reader how;
    const char *value;
    int code;
    const char *pointer;
} values[] = {
    {READ_BOOL, "true", HE_OK, ""},
    {READ_BOOL, "1", API_WRONG_TYPE, "/v"},
    {READ_NUMBER, "0.1", HE_OK, ""},
    {READ_NUMBER, "\"1\"", API_WRONG_TYPE, "/v"},
    {READ_NUMBER, "null", API_WRONG_TYPE, "/v"},
    {READ_OPEN_RANGE, "0.5", HE_OK, ""},
    {READ_OPEN_RANGE, "0", HE_BAD_VALUE, "/v"},
    {READ_OPEN_RANGE, "1", HE_BAD_VALUE, "/v"},
    {READ_U64, "10", HE_OK, ""},
    {READ_U64, "1.0", HE_OK, ""},
    {READ_U64, "0", HE_BAD_VALUE, "/v"},
    {READ_U64, "11", HE_BAD_VALUE, "/v"},
    {READ_U64, "1.5", HE_BAD_VALUE, "/v"},
    {READ_ID, "0", HE_OK, ""},
    {READ_ID, "4294967293", HE_OK, ""},
    {READ_ID, "4294967294", HE_BAD_VALUE, "/v"},
    {READ_ID, "4294967296", HE_BAD_VALUE, "/v"},
    {READ_ID, "18446744073709551617", HE_BAD_VALUE, "/v"},
    {READ_ID, "-1", HE_BAD_VALUE, "/v"},
    {READ_ID, "null", API_WRONG_TYPE, "/v"},
    {READ_IDS, "[1,2]", HE_OK, ""},
    {READ_IDS, "[]", HE_BAD_VALUE, "/v"},
    {READ_IDS, "7", API_WRONG_TYPE, "/v"},
    {READ_IDS, "[1,2.5]", HE_BAD_VALUE, "/v/1"},
    {READ_VEC3, "[1,2,3]", HE_OK, ""},
    {READ_VEC3, "[1,2]", HE_BAD_VALUE, "/v"},
    {READ_VEC3, "[1,2,3,4]", HE_BAD_VALUE, "/v"},
    {READ_VEC3, "[1,\"2\",3]", API_WRONG_TYPE, "/v/1"},
    {READ_STRING, "\"abcd\"", HE_OK, ""},
    {READ_STRING, "\"abcde\"", HE_BAD_VALUE, "/v"},
    {READ_CHOICE, "\"b\"", HE_OK, ""},
    {READ_CHOICE, "\"B\"", HE_BAD_VALUE, "/v"},
    {READ_ELEMENT, "{\"edge\":3}", HE_OK, ""},
    {READ_ELEMENT, "{}", API_MISSING_MEMBER, "/v"},
    {READ_ELEMENT, "{\"edge\":3,\"face\":1}", API_UNKNOWN_MEMBER, "/v/face"},
    {READ_ELEMENT, "{\"corner\":3}", API_UNKNOWN_MEMBER, "/v/corner"},
    {READ_ELEMENT, "{\"edge\":-3}", HE_BAD_VALUE, "/v/edge"},
};

static void values_are_refused_with_their_pointer(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        char body[128];
        int length = snprintf(body, sizeof body, "{\"v\":%s}", values[i].value);
        parsed p = {0};
        api_arena arena = {0};
        api_in value;
        assert_true(parse(body, (size_t)length, 100, &p));
        assert_true(api_in_need(&p.root, "v", &value));
        bool good = read_value(values[i].how, &value, &arena);
        if (good != (values[i].code == HE_OK) || p.problem.code != values[i].code ||
            strcmp(p.problem.pointer, values[i].pointer) != 0) {
            fail_msg("%s: %s at \"%s\" (%s)", body, api_code_slug(p.problem.code),
                     p.problem.pointer, p.problem.detail);
        }
        api_arena_clear(&arena);
        api_document_clear(&p.document);
    }
}

static void members_are_those_that_are_named(void **state)
{
    (void)state;
    static const char body[] = "{\"a\":1,\"B\":2}";
    parsed p = {0};
    api_in value;
    assert_true(parse(body, strlen(body), 100, &p));
    assert_true(api_in_only(&p.root, (const char *const[]){"a", "B", "c", NULL}));
    assert_false(api_in_find(&p.root, "b", &value)); /* letter case matters */
    assert_int_equal(p.problem.code, HE_OK);
    assert_false(api_in_need(&p.root, "c", &value));
    assert_int_equal(p.problem.code, API_MISSING_MEMBER);
    assert_string_equal(p.problem.pointer, "");
    p.problem = (api_problem){0};
    assert_false(api_in_only(&p.root, (const char *const[]){"a", "b", NULL}));
    assert_int_equal(p.problem.code, API_UNKNOWN_MEMBER);
    assert_string_equal(p.problem.pointer, "/B");
    api_document_clear(&p.document);
}

static void numbers_are_exact(void **state)
{
    (void)state;
    static const char body[] = "[9007199254740991,0.1,1e-320,179769313486231570e291]";
    static const double expected[] = {9007199254740991.0, 0.1, 1e-320, 1.7976931348623157e308};
    parsed p = {0};
    api_in child;
    assert_true(parse(body, strlen(body), 100, &p));
    size_t i = 0;
    for (bool more = api_in_first(&p.root, &child); more; more = api_in_next(&child)) {
        double value;
        assert_true(api_in_number(&child, &value));
        assert_memory_equal(&value, &expected[i], sizeof value);
        i++;
    }
    assert_int_equal(i, 4);
    api_document_clear(&p.document);
}

static void every_failed_allocation_is_a_problem(void **state)
{
    (void)state;
    static const char body[] = "{\"ids\":[1,2,3],\"name\":\"x\",\"deep\":[[{\"a\":null}]]}";
    failing f = {0};
    while (failing_next(&f)) {
        parsed p = {0};
        api_arena arena = {0};
        api_in list;
        uint32_t *ids;
        size_t count;
        bool good = parse(body, strlen(body), 100, &p) && api_in_need(&p.root, "ids", &list) &&
                    api_in_ids(&list, 1, &arena, &ids, &count);
        failing_end(&f, good);
        assert_int_equal(p.problem.code, good ? HE_OK : HE_NO_MEMORY);
        api_arena_clear(&arena);
        api_document_clear(&p.document);
    }
    assert_true(f.n > 10);
}

int main(void)
{
    api_in_setup();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hostile_bodies_are_refused_exactly),
        cmocka_unit_test(depth_and_number_of_values_are_bounded),
        cmocka_unit_test(objects_have_a_bounded_number_of_members),
        cmocka_unit_test(values_are_refused_with_their_pointer),
        cmocka_unit_test(members_are_those_that_are_named),
        cmocka_unit_test(numbers_are_exact),
        cmocka_unit_test(every_failed_allocation_is_a_problem),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
