/* Tests of bodies with several files (multipart/form-data): which parts are found, however the body
 * is split into pieces, and which bodies are refused. */
#include "api/header/multipart.h"

#include "unit/fixture.h"

#include <stdio.h>

#define TYPE    "multipart/form-data; boundary=AbC"
#define LINE    "\r\n"
#define HEAD(n) "Content-Disposition: form-data; name=\"" n "\"" LINE
#define PART(n) "--AbC" LINE HEAD(n) LINE
#define LAST    LINE "--AbC--"

enum { MOST = 8192 };

/* What a test has read of a body: the parts as text, each in the form "[name|type]bytes;", and the
 * problem if the body was refused. */
typedef struct told {
    char text[MOST];
    size_t length;
    api_problem problem;
} told;

static void add(told *t, const char *bytes, size_t length)
{
    assert_true(t->length + length < MOST);
    memcpy(t->text + t->length, bytes, length);
    t->length += length;
    t->text[t->length] = '\0';
}

static void add_text(told *t, const char *text)
{
    add(t, text, strlen(text));
}

/* Reads a body in pieces of `piece` bytes, each in a heap block of its own; returns HE_OK, or the
 * code of the problem if the body was refused. */
static int read_in(const char *type, const char *body, size_t length, size_t piece, told *out)
{
    api_problem *problem = &out->problem;
    *problem = (api_problem){0};
    out->length = 0;
    out->text[0] = '\0';
    api_multipart *m = api_multipart_new(type, problem);
    bool good = m != NULL;
    for (size_t at = 0; at < length && good; at += piece) {
        size_t n = length - at < piece ? length - at : piece;
        char *bytes = malloc(n);
        assert_non_null(bytes);
        memcpy(bytes, body + at, n);
        const char *p = bytes;
        for (bool more = true; more && good;) {
            api_multipart_piece got = {.bytes = NULL};
            switch (api_multipart_next(m, &p, bytes + n, &got, problem)) {
            case API_MULTIPART_MORE:
                assert_ptr_equal(p, bytes + n);
                more = false;
                break;
            case API_MULTIPART_BEGIN:
                add_text(out, "[");
                add_text(out, got.part.name);
                add_text(out, got.part.type == NULL ? "" : "|");
                add_text(out, got.part.type == NULL ? "" : got.part.type);
                add_text(out, "]");
                break;
            case API_MULTIPART_BYTES:
                assert_true(got.length > 0);
                add(out, got.bytes, got.length);
                break;
            case API_MULTIPART_END:
                add_text(out, ";");
                break;
            case API_MULTIPART_BAD:
                good = false;
                break;
            }
        }
        free(bytes);
    }
    good = good && api_multipart_end(m, problem);
    assert_true(good == (problem->code == HE_OK));
    api_multipart_free(m);
    return problem->code;
}

/* Requires that reading the body gives `wanted`, in pieces of any size from one byte to the whole
 * body. */
static void expect_of(const char *type, const char *body, size_t length, const char *wanted)
{
    for (size_t piece = 1; piece <= length; piece += piece < 9 ? 1 : length / 5 + 1) {
        told t;
        int code = read_in(type, body, length, piece, &t);
        if (code != HE_OK || strcmp(t.text, wanted) != 0) {
            fail_msg("pieces of %zu: got %s %s, wanted %s", piece, t.text, t.problem.detail,
                     wanted);
        }
    }
}

static void expect(const char *body, const char *wanted)
{
    expect_of(TYPE, body, strlen(body), wanted);
}

static void expect_refused_of(const char *type, const char *body, size_t length, int code,
                              const char *words)
{
    for (size_t piece = 1; piece <= length; piece += piece < 9 ? 1 : length / 5 + 1) {
        told t;
        assert_int_equal(read_in(type, body, length, piece, &t), code);
        if (strstr(t.problem.detail, words) == NULL) {
            fail_msg("pieces of %zu: got \"%s\", wanted \"%s\"", piece, t.problem.detail, words);
        }
    }
}

static void expect_refused(const char *body, const char *words)
{
    expect_refused_of(TYPE, body, strlen(body), API_BAD_MULTIPART, words);
}

static void parts_come_with_their_names_types_and_bytes(void **state)
{
    (void)state;
    expect(PART("a") "one" LAST, "[a]one;");
    expect(PART("a") "one" LINE PART("b") "two" LAST LINE, "[a]one;[b]two;");
    expect("--AbC" LINE "Content-Disposition: form-data; name=\"f\"; filename=\"x.bin\"" LINE
           "Content-Type: application/octet-stream" LINE LINE "123" LAST,
           "[x.bin|application/octet-stream]123;");
    /* part headers without quotes, with upper-case and lower-case letters mixed, with blanks, and
     * with unknown names */
    expect("--AbC" LINE "x-other: 1" LINE "CONTENT-TYPE:text/plain ; charset=utf-8  " LINE
           "content-disposition:Form-Data;NAME=f ;\tFileName=x.bin;" LINE LINE "1" LAST,
           "[x.bin|text/plain ; charset=utf-8]1;");
    /* text before the first part and after the last one, and blanks after a delimiter */
    expect("a preamble" LINE "--Ab" LINE "--AbC \t" LINE HEAD("a") LINE "1" LAST "epilogue" LINE
                                                                        "--AbC" LINE,
           "[a]1;");
    /* a body without parts */
    expect("--AbC--", "");
    expect(LINE "--AbC--" LINE, "");
}

static void empty_parts_are_parts(void **state)
{
    (void)state;
    expect(PART("a") LAST, "[a];");
    /* The line break before a delimiter belongs to the delimiter, even if the part is empty. */
    expect(PART("a") "--AbC--", "[a];");
    expect(PART("a") LINE PART("b") LINE PART("c") "x" LAST, "[a];[b];[c]x;");
    expect(PART("a") LINE LINE "--AbC--", "[a]\r\n;");
}

static void what_only_begins_as_a_delimiter_is_data(void **state)
{
    (void)state;
    static const char *const data[] = {"--AbC--",  "\r",        "\n",         "\r\n",
                                       "\r\n-",    "\r\n--",    "\r\n--A",    "\r\n--Ab",
                                       "\r\r\n--", "\r\n--abC", "\r\n\r\n--", "\r\n--AbX--AbC",
                                       "\n--AbC",  "\r--AbC",   "-\r\n--Ab\r"};
    for (size_t i = 0; i < sizeof data / sizeof *data; i++) {
        char body[200], wanted[200];
        snprintf(body, sizeof body, PART("a") "x%s" LAST, data[i]);
        snprintf(wanted, sizeof wanted, "[a]x%s;", data[i]);
        expect(body, wanted);
    }
    static const char zeros[] = PART("a") "\0\r\n\0--AbC\0" LAST;
    told t;
    for (size_t piece = 1; piece < sizeof zeros; piece++) {
        assert_int_equal(read_in(TYPE, zeros, sizeof zeros - 1, piece, &t), HE_OK);
        assert_int_equal(t.length, 14);
        assert_memory_equal(t.text, "[a]\0\r\n\0--AbC\0;", 14);
    }
}

#define NAMED(text) "--AbC" LINE "Content-Disposition: form-data; " text LINE LINE LAST

static void names_are_taken_as_they_are_given(void **state)
{
    (void)state;
    expect(NAMED("name=\"a b;c=d\""), "[a b;c=d];");
    expect(NAMED("name=f; filename=\"a \\\"b\\\" \\\\ c\""), "[a \"b\" \\ c];");
    expect(NAMED("name=f; filename=\"C:\\dir\\x.bin\""), "[C:\\dir\\x.bin];");
    expect(NAMED("name=f; filename=\"%22quoted%22 100%25 %0A\""), "[\"quoted\" 100%25 %0A];");
    expect(NAMED("name=f; filename=\"\xC3\xBC\xE2\x82\xAC\xF0\x9F\x98\x80.gltf\""),
           "[\xC3\xBC\xE2\x82\xAC\xF0\x9F\x98\x80.gltf];");
    expect(NAMED("name=f; filename=\"../../etc/passwd\""), "[../../etc/passwd];");
    expect(NAMED("filename=\"x\"; name=f"), "[x];");
    expect(NAMED("name=f; filename=\"\""), "[f];"); /* what a browser sends if no file was chosen */
    expect(NAMED("filename=\"\"; name=f"), "[f];");
    expect(NAMED("name=f; other=\"filename=x\""), "[f];");
}

static void names_that_are_none_are_refused(void **state)
{
    (void)state;
    expect_refused(NAMED("filename=\"x\""), "a part has no name");
    expect_refused(NAMED("name=\"\""), "a part has no name");
    expect_refused(NAMED("name=a; name=b"), "given twice");
    expect_refused(NAMED("name=a; filename=b; filename=b"), "given twice");
    expect_refused(NAMED("name=f; filename*=UTF-8''x"), "filename*");
    expect_refused(NAMED("name=\"a"), "name=\"value\"");
    expect_refused(NAMED("name=\"a\"b"), "name=\"value\"");
    expect_refused(NAMED("name=\"a\\\""), "name=\"value\"");
    expect_refused(NAMED("name"), "name=\"value\"");
    expect_refused(NAMED("name="), "name=\"value\"");
    expect_refused(NAMED("=a"), "name=\"value\"");
    expect_refused(NAMED("name=f; filename=\"\x80\""), "not UTF-8");
    expect_refused(NAMED("name=f; filename=\"\xC0\xAF\""), "not UTF-8");
    expect_refused(NAMED("name=f; filename=\"a\tb\""), "control characters");
    expect_refused(NAMED("name=f; filename=\"a\nb\""), "control characters");
}

static void headers_that_are_none_are_refused(void **state)
{
    (void)state;
    expect_refused("--AbC" LINE LINE "x" LAST, "byte 7 of the body: a part has no name");
    expect_refused("--AbC" LINE "Content-Type: text/plain" LINE LINE LAST, "a part has no name");
    expect_refused("--AbC" LINE "Content-Disposition: attachment; name=a" LINE LINE LAST,
                   "the Content-Disposition of a part must be form-data");
    expect_refused("--AbC" LINE "Content-Disposition" LINE LINE LAST,
                   "byte 7 of the body: a line in the headers of a part is not");
    expect_refused("--AbC" LINE ": x" LINE LINE LAST, "a line in the headers of a part is not");
    expect_refused("--AbC" LINE HEAD("a") " name=b" LINE LINE LAST,
                   "a line in the headers of a part is not");
    expect_refused("--AbC" LINE HEAD("a") HEAD("a") LINE LAST, "a header of a part is given twice");
    expect_refused("--AbC" LINE HEAD("a") "Content-Type: a/b" LINE
                                          "content-type: a/b" LINE LINE LAST,
                   "given twice");
    expect_refused("--AbC" LINE HEAD("a") "Content-Transfer-Encoding: base64" LINE LINE LAST,
                   "send the bytes as they are");
    expect("--AbC" LINE HEAD("a") "Content-Transfer-Encoding: BINARY" LINE LINE LAST, "[a];");
    expect_refused(
        "--AbC" LINE HEAD("a") "Content-Type: multipart/mixed; boundary=x" LINE LINE LAST,
        "a part of the body is itself a multipart body");
}

static void a_body_that_ends_too_early_is_refused(void **state)
{
    (void)state;
    static const char whole[] = PART("a") "one" LINE PART("b") "two" LAST;
    expect(whole, "[a]one;[b]two;");
    for (size_t length = 1; length < sizeof whole - 1; length++) {
        expect_refused_of(TYPE, whole, length, API_BAD_MULTIPART, "ends before its last delimiter");
    }
    expect_refused("no delimiter at all", "ends before its last delimiter");
    expect_refused(PART("a") "x" LINE "--AbC- ", "neither \"--\" nor a new line follows");
    expect_refused(PART("a") "x" LINE "--AbC -", "neither \"--\" nor a new line follows");
    expect_refused(PART("a") "x" LINE "--AbCd" LINE, "neither \"--\" nor a new line follows");
    expect_refused(PART("a") "x" LINE "--AbC\r\r", "neither \"--\" nor a new line follows");
}

/* Returns a block with `text` repeated `count` times between `before` and `behind`. */
static char *repeat(const char *before, const char *text, size_t count, const char *behind)
{
    size_t first = strlen(before), each = strlen(text), last = strlen(behind) + 1;
    char *body = malloc(first + count * each + last);
    assert_non_null(body);
    memcpy(body, before, first);
    for (size_t i = 0; i < count; i++) {
        memcpy(body + first + i * each, text, each);
    }
    memcpy(body + first + count * each, behind, last);
    return body;
}

static void there_are_maxima(void **state)
{
    (void)state;
    char *body = repeat("", PART("a") LINE, API_MAX_PARTS, "--AbC--");
    char *wanted = repeat("", "[a];", API_MAX_PARTS, "");
    expect(body, wanted);
    free(body);
    free(wanted);
    body = repeat("", PART("a") LINE, API_MAX_PARTS + 1, "--AbC--");
    expect_refused(body, "more than 64 parts");
    free(body);
    /* The limit counts all bytes of the headers of a part, including the empty line that ends
     * them. */
    size_t room = API_MAX_PART_HEADERS - strlen(HEAD("a") "x: " LINE LINE);
    for (size_t more = 0; more < 2; more++) {
        body = repeat("--AbC" LINE HEAD("a") "x: ", "x", room + more, LINE LINE "1" LAST);
        if (more == 0) {
            expect(body, "[a]1;");
        } else {
            expect_refused(body, "byte 7 of the body: the headers of a part are too long");
        }
        free(body);
    }
    for (size_t more = 0; more < 2; more++) {
        body = repeat("--AbC" LINE "Content-Disposition: form-data; name=\"", "x",
                      API_MAX_PART_NAME + more, "\"" LINE LINE "1" LAST);
        wanted = repeat("[", "x", API_MAX_PART_NAME, "]1;");
        if (more == 0) {
            expect(body, wanted);
        } else {
            expect_refused(body, "too long");
        }
        free(body);
        free(wanted);
    }
    body =
        repeat("--AbC" LINE HEAD("a") "Content-Type: ", "x", API_MAX_PART_NAME + 1, LINE LINE LAST);
    expect_refused(body, "too long");
    free(body);
}

static void the_boundary_is_a_parameter_of_the_type(void **state)
{
    (void)state;
    static const char body[] = PART("a") "1" LAST;
    static const char *const good[] = {"multipart/form-data;boundary=AbC",
                                       "Multipart/Form-Data ; charset=UTF-8; Boundary=\"AbC\"",
                                       "multipart/form-data; boundary=AbC;"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        expect_of(good[i], body, sizeof body - 1, "[a]1;");
    }
    static const char *const bad[] = {"multipart/form-data",
                                      "multipart/form-data; boundary=",
                                      "multipart/form-data; boundary=\"\"",
                                      "multipart/form-data; boundary=\"a",
                                      "multipart/form-data; boundary=\"a \"",
                                      "multipart/form-data; boundary=\"a\r\n\"",
                                      "multipart/form-data; boundary=a*",
                                      "multipart/form-data; boundary=AbC; boundary=AbC",
                                      "multipart/form-data, boundary=AbC"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        api_problem problem = {0};
        assert_null(api_multipart_new(bad[i], &problem));
        assert_int_equal(problem.code, API_BAD_HEADER);
    }
    /* the longest possible boundary, with all allowed characters */
    static const char odd[] =
        "multipart/form-data; boundary=\""
        "0123456789'()+_,-./:=? abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTU\"";
    static const char text[] =
        "--0123456789'()+_,-./:=? abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTU" LINE HEAD("a")
            LINE "1" LINE
                 "--0123456789'()+_,-./:=? abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTU--";
    expect_of(odd, text, sizeof text - 1, "[a]1;");
    char *long_one = repeat("multipart/form-data; boundary=", "x", 71, "");
    api_problem problem = {0};
    assert_null(api_multipart_new(long_one, &problem));
    free(long_one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_come_with_their_names_types_and_bytes),
        cmocka_unit_test(empty_parts_are_parts),
        cmocka_unit_test(what_only_begins_as_a_delimiter_is_data),
        cmocka_unit_test(names_are_taken_as_they_are_given),
        cmocka_unit_test(names_that_are_none_are_refused),
        cmocka_unit_test(headers_that_are_none_are_refused),
        cmocka_unit_test(a_body_that_ends_too_early_is_refused),
        cmocka_unit_test(there_are_maxima),
        cmocka_unit_test(the_boundary_is_a_parameter_of_the_type),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
