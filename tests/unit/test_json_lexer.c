/* Tests of the JSON lexer: which tokens it finds in a text, and where it reports a mistake. Tokens
 * and mistakes must not depend on how the text is cut into pieces. */
#include "format/text/json_lexer.h"

#include "fixture.h"
#include "json_tokens.h"
#include "seed.h"

/* --- tables of texts and their tokens --- */

typedef struct good_case {
    const char *text, *told;
} good_case;

static const good_case good[] = {
    {"{}", "{."},
    {"[]", "[."},
    {" \t\r\n[ ] \n", "[."},
    {"0", "0/1 "},
    {"-0.5e-3", "-0.00050000000000000001/7 "},
    {"[1,2]", "[1/1 2/1 ."},
    {"[true,false,null]", "[true false null ."},
    {"{\"a\":1,\"b\":{\"c\":[]}}", "{a:1/1 b:{c:[..."},
    {"{\"\\u0061\" : \"x\"}", "{\\u0061:s ."},
    {"{\"\":\"\"}", "{:s ."},
    {"\"\xC3\xA9\xF0\x9F\x98\x80 \\ud83d\\ude00\"", "s "},
};

static void a_text_is_read_as_its_tokens(void **state)
{
    (void)state;
    static json_tokens r;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        json_tokens_of_text(&r, good[i].text, strlen(good[i].text));
        assert_int_equal(r.last, HE_TOKEN_END);
        assert_string_equal(r.told, good[i].told);
    }
}

typedef struct bad_case {
    const char *text;
    he_fault fault;
    uint64_t place;
} bad_case;

static const bad_case bad[] = {
    {"", HE_FAULT_ENDS, 0},
    {"  ", HE_FAULT_ENDS, 2},
    {"\xEF\xBB\xBF{}", HE_FAULT_VALUE, 0},
    {"[1,]", HE_FAULT_VALUE, 3},
    {"[,1]", HE_FAULT_VALUE, 1},
    {"[1,", HE_FAULT_ENDS, 3},
    {"{\"a\":", HE_FAULT_ENDS, 5},
    {"{1:2}", HE_FAULT_NAME, 1},
    {"{\"a\":1,}", HE_FAULT_NAME, 7},
    {"{\"a\" 1}", HE_FAULT_COLON, 5},
    {"[1 2]", HE_FAULT_ITEM, 3},
    {"[1}", HE_FAULT_ITEM, 2},
    {"[1", HE_FAULT_ITEM, 2},
    {"{\"a\":1]", HE_FAULT_MEMBER, 6},
    {"{} {}", HE_FAULT_FOLLOWS, 3},
    {"[01]", HE_FAULT_NUMBER, 1},
    {"[1.]", HE_FAULT_NUMBER, 1},
    {"[-]", HE_FAULT_NUMBER, 1},
    {"[+1]", HE_FAULT_VALUE, 1},
    {"[1e999]", HE_FAULT_NOT_FINITE, 1},
    {"[nul]", HE_FAULT_VALUE, 1},
    {"\"a\nb\"", HE_FAULT_STRING, 2},
    {"\"a\\x\"", HE_FAULT_STRING, 2},
    {"\"\\u00g0\"", HE_FAULT_STRING, 1},
    {"\"\\u0000\"", HE_FAULT_STRING, 1},
    {"\"\\ud800\"", HE_FAULT_STRING, 1},
    {"\"\xC0\x80\"", HE_FAULT_STRING, 1},
    {"\"\xED\xA0\x80\"", HE_FAULT_STRING, 1},
    {"\"a", HE_FAULT_STRING, 2},
};

static void a_fault_has_its_kind_and_place(void **state)
{
    (void)state;
    static json_tokens r;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        json_tokens_of_text(&r, bad[i].text, strlen(bad[i].text));
        if (r.last != HE_TOKEN_FAULT || r.fault != bad[i].fault || r.place != bad[i].place) {
            fail_msg("%s: fault %d at %llu", bad[i].text, (int)r.fault,
                     (unsigned long long)r.place);
        }
    }
}

/* --- limits of nesting, and offsets of mistakes --- */

static void depth_is_refused_beyond_its_limit(void **state)
{
    (void)state;
    static json_tokens r;
    char text[2 * HE_JSON_DEPTH + 2];
    for (size_t depth = HE_JSON_DEPTH; depth <= HE_JSON_DEPTH + 1; depth++) {
        memset(text, '[', depth);
        memset(text + depth, ']', depth);
        json_tokens_of_text(&r, text, 2 * depth);
        assert_int_equal(r.last, depth == HE_JSON_DEPTH ? HE_TOKEN_END : HE_TOKEN_FAULT);
    }
    assert_int_equal(r.fault, HE_FAULT_DEPTH);
    assert_int_equal(r.place, HE_JSON_DEPTH);
}

static void the_pointer_names_what_is_open(void **state)
{
    (void)state;
    he_lexer x;
    char pointer[64];
    const char *text = "{\"a\":[1,{\"b/~\":tru}]}";
    he_lexer_init(&x, NULL);
    he_lexer_feed(&x, text, strlen(text));
    he_token token = HE_TOKEN_PART;
    while (token != HE_TOKEN_FAULT) {
        token = he_lexer_next(&x);
    }
    he_lexer_pointer(&x, pointer, sizeof pointer);
    assert_string_equal(pointer, "/a/1/b~1~0");
    he_lexer_pointer(&x, pointer, 8);
    assert_string_equal(pointer, "/a/1");
}

static void names_and_numbers_of_pieces_have_limits(void **state)
{
    (void)state;
    static he_lexer_carry carry;
    static json_tokens r;
    he_lexer x;
    for (size_t most = 3; most <= 4; most++) {
        he_lexer_init(&x, &carry);
        x.name_most = most;
        r.length = 0;
        json_tokens_of_piece(&r, &x, "{\"ab", 4);
        json_tokens_of_piece(&r, &x, "cd\":1 }", 7);
        assert_int_equal(r.fault, most == 3 ? HE_FAULT_LONG_NAME : HE_FAULT_NONE);
        assert_int_equal(r.place, most == 3 ? 6 : 0);
        he_lexer_init(&x, &carry);
        x.number_most = most;
        r.length = 0;
        json_tokens_of_piece(&r, &x, "[12", 3);
        json_tokens_of_piece(&r, &x, "34 ]", 4);
        assert_int_equal(r.fault, most == 3 ? HE_FAULT_LONG_NUMBER : HE_FAULT_NONE);
        assert_int_equal(r.place, most == 3 ? 4 : 0);
    }
}

static void a_name_without_room_is_lost_and_the_rest_is_read(void **state)
{
    (void)state;
    static he_lexer_carry carry;
    static json_tokens r;
    he_lexer x;
    char name[HE_JSON_NAMES + 1];
    memset(name, 'n', sizeof name);
    he_lexer_init(&x, &carry);
    r.length = 0;
    json_tokens_of_piece(&r, &x, "{\"", 2);
    json_tokens_of_piece(&r, &x, name, sizeof name);
    json_tokens_of_piece(&r, &x, "\":{\"b\":1}}", 10);
    assert_string_equal(r.told, "{lost:{b:1/1 ..");
    assert_int_equal(x.state, HE_JSON_DONE);
}

static void a_long_string_is_interrupted(void **state)
{
    (void)state;
    enum { LENGTH = 3 * HE_JSON_STRING };
    char *text = malloc(LENGTH);
    he_lexer x;
    size_t parts = 0;
    assert_non_null(text);
    memset(text, 'a', LENGTH);
    text[0] = text[LENGTH - 1] = '"';
    he_lexer_init(&x, NULL);
    he_lexer_feed(&x, text, LENGTH);
    while (he_lexer_next(&x) == HE_TOKEN_PART) {
        parts++;
    }
    assert_int_equal(parts, 2);
    assert_int_equal(x.state, HE_JSON_DONE);
    free(text);
}

/* --- arrays of numbers, read in one call --- */

typedef struct row_case {
    const char *text;
    size_t numbers, indices; /* expected number of values that one call reads: `numbers` if it reads
                                numbers, `indices` if it reads indices; 0 if it reads none */
} row_case;

static const row_case rows[] = {
    {"[0,1,2]", 3, 3},      {"[ 0 , 1 ,2 ]", 3, 3}, {"[0.5,1]", 2, 0}, {"[-1]", 1, 0},
    {"[4294967293]", 1, 1}, {"[4294967294]", 1, 0}, {"[01]", 0, 0},    {"[]", 0, 0},
    {"[0,1,2,3,4]", 0, 0},  {"[0,1", 0, 0},         {"[0,1,", 0, 0},   {"[0 1]", 0, 0},
    {"[\"0\"]", 0, 0},      {"[[0]]", 0, 0},        {"[1e999]", 0, 0}, {"0", 0, 0},
};

static void a_row_of_numbers_is_taken_at_once_or_left_alone(void **state)
{
    (void)state;
    enum { MOST = 4 };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *text = rows[i].text;
        double numbers[MOST];
        uint32_t indices[MOST];
        for (int kind = 0; kind < 2; kind++) {
            he_lexer x;
            he_lexer_init(&x, NULL);
            he_lexer_feed(&x, text, strlen(text));
            assert_true(he_lexer_value_ahead(&x));
            size_t count = kind == 0 ? he_lexer_take_numbers(&x, numbers, MOST)
                                     : he_lexer_take_indices(&x, indices, MOST);
            size_t expected = kind == 0 ? rows[i].numbers : rows[i].indices;
            if (count != expected) {
                fail_msg("%s: %zu taken", text, count);
            }
            assert_int_equal(he_lexer_place(&x), count > 0 ? strlen(text) : 0);
        }
    }
}

/* --- random texts --- */

static uint64_t random_state;

static uint32_t any(uint32_t below)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((random_state >> 33) % below);
}

enum { TEXT = 1024 };

typedef struct writer {
    char text[TEXT];
    size_t length;
} writer;

static void put(writer *w, const char *text)
{
    size_t length = strlen(text);
    if (length <= TEXT - w->length) {
        memcpy(w->text + w->length, text, length);
        w->length += length;
    }
}

static const char *const blanks[] = {"", "", "", " ", "\n ", "\t\r"};
static const char *const scalars[] = {"0",
                                      "-0",
                                      "12",
                                      "1e5",
                                      "-0.25E-2",
                                      "1234567890123456789",
                                      "true",
                                      "false",
                                      "null",
                                      "\"\"",
                                      "\"a\"",
                                      "\"\\n\\u00e9\"",
                                      "\"\\ud83d\\ude00\"",
                                      "\"\xF0\x9F\x98\x80\xC3\xA9\""};
static const char *const names[] = {"\"\"", "\"a\"", "\"b\\u0041\"", "\"\xC3\xA9\""};

#define ONE_OF(list) put(w, (list)[any(sizeof(list) / sizeof *(list))])

static void put_value(writer *w, int depth)
{
    uint32_t kind = depth > 4 ? 2 : any(4);
    ONE_OF(blanks);
    if (kind >= 2) {
        ONE_OF(scalars);
    } else {
        put(w, kind == 0 ? "{" : "[");
        ONE_OF(blanks);
        for (uint32_t i = 0, count = any(4); i < count; i++) {
            put(w, i > 0 ? "," : "");
            if (kind == 0) {
                ONE_OF(blanks);
                ONE_OF(names);
                ONE_OF(blanks);
                put(w, ":");
            }
            put_value(w, depth + 1);
        }
        put(w, kind == 0 ? "}" : "]");
    }
    ONE_OF(blanks);
}

/* Changes, removes or inserts one byte of a text. The new byte is mostly a character that has a
 * meaning in JSON. */
static void damage(writer *w)
{
    static const char bytes[] = "{}[]:,\"\\0-+.eEtfnu \n\x01\xC3\xFF";
    char byte = bytes[any(sizeof bytes - 1)];
    size_t at = any((uint32_t)w->length);
    uint32_t how = any(3);
    if (how == 0) {
        w->text[at] = byte;
    } else if (how == 1) {
        w->length--;
        memmove(w->text + at, w->text + at + 1, w->length - at);
    } else if (w->length < TEXT) {
        memmove(w->text + at + 1, w->text + at, w->length - at);
        w->text[at] = byte;
        w->length++;
    }
}

static void expect_equal(const json_tokens *whole, const json_tokens *pieces, const writer *w,
                         uint64_t cuts)
{
    if (!json_tokens_agree(whole, pieces)) {
        fail_msg("cut by %016llx it is another text: %.*s\n%s\n%s\nfault %d at %llu, %d at %llu",
                 (unsigned long long)cuts, (int)w->length, w->text, whole->told, pieces->told,
                 (int)whole->fault, (unsigned long long)whole->place, (int)pieces->fault,
                 (unsigned long long)pieces->place);
    }
}

static void random_texts_are_the_same_wherever_they_are_cut(void **state)
{
    (void)state;
    enum { ROUNDS = 20000, CUTS = 6 };
    static json_tokens whole, pieces;
    static writer w;
    size_t good_texts = 0;
    random_state = seed_of_run();
    for (int round = 0; round < ROUNDS; round++) {
        w.length = 0;
        put_value(&w, 0);
        for (uint32_t i = any(3); i > 0 && w.length > 1; i--) {
            damage(&w);
        }
        /* A line feed ends the text: without it, a number at the end of a text in pieces might
         * continue in the next piece. */
        w.length -= w.length == TEXT;
        w.text[w.length++] = '\n';
        json_tokens_of_text(&whole, w.text, w.length);
        good_texts += whole.last == HE_TOKEN_END;
        for (int i = 0; i < CUTS; i++) {
            uint64_t cuts = i == 0 ? UINT64_MAX : (uint64_t)any(UINT32_MAX) << 32 | any(UINT32_MAX);
            json_tokens_of_pieces(&pieces, w.text, w.length, cuts);
            expect_equal(&whole, &pieces, &w, cuts);
        }
    }
    printf("note: %zu of %d texts were well formed\n", good_texts, ROUNDS);
    assert_in_range(good_texts, ROUNDS / 4, ROUNDS - ROUNDS / 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_is_read_as_its_tokens),
        cmocka_unit_test(a_fault_has_its_kind_and_place),
        cmocka_unit_test(depth_is_refused_beyond_its_limit),
        cmocka_unit_test(the_pointer_names_what_is_open),
        cmocka_unit_test(names_and_numbers_of_pieces_have_limits),
        cmocka_unit_test(a_name_without_room_is_lost_and_the_rest_is_read),
        cmocka_unit_test(a_long_string_is_interrupted),
        cmocka_unit_test(a_row_of_numbers_is_taken_at_once_or_left_alone),
        cmocka_unit_test(random_texts_are_the_same_wherever_they_are_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
