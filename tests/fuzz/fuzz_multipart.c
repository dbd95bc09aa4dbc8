/* Bodies of several files (multipart/form-data). The input up to the first line feed is the
 * Content-Type, the rest is the body. Read whole and in pieces, it must have the same parts or be
 * refused alike; names must be UTF-8 without control characters; and the parts, written with
 * another boundary, must be read back as they were. */
#include "fuzz/fuzz.h"
#include "fuzz/pieces.h"

#include "api/header/multipart.h"
#include "api/json/text.h"
#include "base/utf8.h"
#include "unit/fixture.h"

enum { MOST_TYPE = 200 };

/* The parts that were read, written as the body of a second request. */
typedef struct bodies {
    api_text body;
    size_t parts, bytes;
} bodies;

#define BOUNDARY "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'()+_,-."

static void require_name(const char *name)
{
    assert_true(strlen(name) > 0 && strlen(name) <= API_MAX_PART_NAME);
    assert_true(he_is_utf8(name, strlen(name)));
    for (const char *p = name; *p != '\0'; p++) {
        assert_true((unsigned char)*p >= 0x20 && *p != 0x7F);
    }
}

static void begin(bodies *out, const api_part *part)
{
    require_name(part->name);
    api_text_add_string(&out->body, "--" BOUNDARY "\r\nContent-Disposition: form-data; name=\"");
    for (const char *p = part->name; *p != '\0'; p++) {
        bool escaped = *p == '"' || *p == '\\' || *p == '%';
        if (escaped && *p == '%') {
            /* The sequence %22 stands for a quotation mark, so a percent sign in front of 22 cannot
             * be written; all other percent signs stand for themselves. */
            api_text_add_string(&out->body, strncmp(p, "%22", 3) == 0 ? "?" : "%");
            continue;
        }
        api_text_add_string(&out->body, escaped ? "\\" : "");
        api_text_add_char(&out->body, *p);
    }
    api_text_add_string(&out->body, "\"\r\n");
    if (part->type != NULL) {
        api_text_add_format(&out->body, "Content-Type: %s\r\n", part->type);
    }
    api_text_add_string(&out->body, "\r\n");
    out->parts++;
}

/* Reads a body in pieces. Returns the code of the refusal, or HE_OK. */
static int read_in(const char *type, fuzz_pieces pieces, bodies *out)
{
    api_problem problem = {0};
    *out = (bodies){.parts = 0};
    api_multipart *m = api_multipart_new(type, &problem);
    bool good = m != NULL, inside = false;
    char *piece;
    size_t n;
    while (good && (piece = fuzz_pieces_next(&pieces, &n)) != NULL) {
        const char *p = piece;
        for (bool more = true; more && good;) {
            api_multipart_piece got = {.bytes = NULL};
            switch (api_multipart_next(m, &p, piece + n, &got, &problem)) {
            case API_MULTIPART_MORE:
                assert_ptr_equal(p, piece + n);
                more = false;
                break;
            case API_MULTIPART_BEGIN:
                assert_false(inside);
                inside = true;
                begin(out, &got.part);
                break;
            case API_MULTIPART_BYTES:
                assert_true(inside && got.length > 0);
                api_text_add(&out->body, got.bytes, got.length);
                out->bytes += got.length;
                break;
            case API_MULTIPART_END:
                assert_true(inside);
                inside = false;
                api_text_add_string(&out->body, "\r\n");
                break;
            case API_MULTIPART_BAD:
                good = false;
                break;
            }
        }
        free(piece);
    }
    good = good && api_multipart_end(m, &problem);
    api_multipart_free(m);
    api_text_add_string(&out->body, "--" BOUNDARY "--");
    assert_false(out->body.failed);
    assert_true(good == (problem.code == HE_OK));
    assert_true(out->parts <= API_MAX_PARTS && out->bytes <= pieces.size);
    return problem.code;
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    md_random random = {fuzz_hash(bytes, size)};
    const uint8_t *line = memchr(bytes, '\n', size < MOST_TYPE ? size : (size_t)MOST_TYPE);
    char type[MOST_TYPE + 1] = "multipart/form-data; boundary=x";
    if (line != NULL) {
        memcpy(type, bytes, (size_t)(line - bytes));
        type[line - bytes] = '\0';
        size -= (size_t)(line + 1 - bytes);
        bytes = line + 1;
    }
    bodies whole, cut, again;
    int code = read_in(type, (fuzz_pieces){bytes, size, 0, &random, 0}, &whole);
    int second =
        read_in(type, (fuzz_pieces){bytes, size, 1u << md_below(&random, 9), &random, 0}, &cut);
    FUZZ_REQUIRE(code == second, "whole %d, in pieces %d", code, second);
    assert_int_equal(whole.body.length, cut.body.length);
    assert_memory_equal(whole.body.bytes, cut.body.bytes, cut.body.length);
    if (code == HE_OK) {
        code = read_in("multipart/form-data; boundary=\"" BOUNDARY "\"",
                       (fuzz_pieces){whole.body.bytes, whole.body.length, 0, &random, 0}, &again);
        FUZZ_REQUIRE(code == HE_OK, "put together anew it is refused with %d", code);
        assert_int_equal(again.parts, whole.parts);
        assert_int_equal(again.body.length, whole.body.length);
        assert_memory_equal(again.body.bytes, whole.body.bytes, whole.body.length);
        api_text_clear(&again.body);
    }
    api_text_clear(&whole.body);
    api_text_clear(&cut.body);
}
