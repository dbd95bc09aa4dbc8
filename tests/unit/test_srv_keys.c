/* Tests of the answers that are kept for Idempotency-Keys: they must be repeated, limited in
 * number, and dropped after a time. */
#include "store/idempotency.h"

#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static st_keys keys;
static const uint64_t secret[2] = {3, 4};

static int setup(void **state)
{
    (void)state;
    st_keys_init(&keys, secret);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    st_keys_clear(&keys);
    return 0;
}

static st_keyed_status begin_keyed(const char *text, uint64_t digest, double now, st_keyed **out)
{
    st_key key = {.text = text, .digest = {digest, 7}};
    return st_keys_begin(&keys, &key, now, out);
}

static void keep(st_keyed *c, const char *body, size_t length, bool changed)
{
    st_kept answer = {
        .status = 200, .changed = changed, .position = 5, .body = body, .length = length};
    memcpy(answer.etag, "\"tag\"", sizeof "\"tag\"");
    st_keyed_keep(c, &answer);
    st_keyed_end(c);
}

/* Begins a request with the Idempotency-Key `text`, and ends it at once with the answer `body`. */
static void put(const char *text, const char *body, size_t length, double now)
{
    st_keyed *c = NULL;
    assert_int_equal(begin_keyed(text, 1, now, &c), ST_KEYED_NEW);
    keep(c, body, length, true);
}

static bool is_kept(const char *text, double now)
{
    st_keyed *c = NULL;
    st_keyed_status status = begin_keyed(text, 1, now, &c);
    st_keyed_end(c);
    return status == ST_KEYED_KEPT;
}

static void another_holder_has_keys_of_its_own(void **state)
{
    (void)state;
    const st_key alice = {.text = "a", .digest = {1, 7}, .holder = "alice"};
    const st_key bob = {.text = "a", .digest = {2, 7}, .holder = "bob"};
    st_keyed *first = NULL, *second = NULL, *again = NULL;
    put("a", "body", 4, 0);
    assert_int_equal(st_keys_begin(&keys, &alice, 0, &first), ST_KEYED_NEW);
    assert_int_equal(st_keys_begin(&keys, &bob, 0, &second), ST_KEYED_NEW);
    assert_int_equal(st_keys_begin(&keys, &alice, 0, &again), ST_KEYED_BUSY);
    keep(first, "alice's", 7, true);
    st_keyed_end(second);
    assert_int_equal(st_keys_begin(&keys, &alice, 0, &again), ST_KEYED_KEPT);
    assert_int_equal(again->answer.length, 7);
    st_keyed_end(again);
    assert_true(is_kept("a", 0));
    assert_int_equal(st_keys_begin(&keys, &bob, 0, &again), ST_KEYED_NEW);
    st_keyed_end(again);
}

static void of_a_damaged_key_no_request_is_done(void **state)
{
    (void)state;
    st_keyed *keyed = NULL;
    const st_kept_key kept = {
        .key = {.text = "a", .holder = "", .digest = {1, 7}}, .id = "m", .is_damaged = true};
    assert_true(st_keys_restore(&keys, &kept));
    assert_int_equal(begin_keyed("a", 1, 1, &keyed), ST_KEYED_DAMAGED);
    assert_int_equal(begin_keyed("b", 1, 1, &keyed), ST_KEYED_NEW);
    st_keyed_end(keyed);
}

static void the_first_answer_is_given_again(void **state)
{
    (void)state;
    st_keyed *first = NULL, *again = NULL;
    assert_int_equal(begin_keyed("a", 1, 0, &first), ST_KEYED_NEW);
    assert_int_equal(begin_keyed("a", 1, 1, &again), ST_KEYED_BUSY);
    assert_int_equal(begin_keyed("a", 2, 1, &again), ST_KEYED_OTHER);
    keep(first, "body", 4, true);
    assert_int_equal(begin_keyed("a", 2, 1, &again), ST_KEYED_OTHER);
    assert_int_equal(begin_keyed("a", 1, 1, &again), ST_KEYED_KEPT);
    assert_int_equal(again->answer.status, 200);
    assert_string_equal(again->answer.etag, "\"tag\"");
    assert_true(again->answer.position == 5);
    assert_memory_equal(again->answer.body, "body", 4);
    st_keyed_end(again);
}

static void a_request_without_an_answer_is_forgotten(void **state)
{
    (void)state;
    st_keyed *c = NULL;
    assert_int_equal(begin_keyed("a", 1, 0, &c), ST_KEYED_NEW);
    st_keyed_end(c);
    assert_int_equal(begin_keyed("a", 2, 0, &c), ST_KEYED_NEW);
    st_keyed_end(c);
    assert_int_equal(keys.count, 0);
}

static void answers_last_a_day(void **state)
{
    (void)state;
    put("a", "x", 1, 1000);
    assert_true(is_kept("a", 1000 + ST_KEPT_SECONDS - 1));
    assert_false(is_kept("a", 1000 + ST_KEPT_SECONDS));
}

static void the_oldest_go_when_there_are_too_many(void **state)
{
    (void)state;
    char text[32];
    for (int i = 0; i < ST_KEPT_KEYS + 10; i++) {
        snprintf(text, sizeof text, "key-%d", i);
        put(text, "x", 1, i);
    }
    assert_int_equal(keys.kept, ST_KEPT_KEYS);
    assert_int_equal(keys.count, ST_KEPT_KEYS);
    assert_false(is_kept("key-9", ST_KEPT_KEYS));
    assert_true(is_kept("key-10", ST_KEPT_KEYS));
}

static void bytes_are_bounded(void **state)
{
    (void)state;
    char *body = calloc(1, ST_KEPT_BODY + 1), text[32];
    assert_non_null(body);
    for (int i = 0; i < 10; i++) {
        snprintf(text, sizeof text, "key-%d", i);
        put(text, body, ST_KEPT_BODY, i);
        assert_true(keys.bytes <= ST_KEPT_BYTES);
    }
    assert_true(is_kept("key-9", 10));
    assert_false(is_kept("key-0", 10));

    put("large", body, ST_KEPT_BODY + 1, 10);
    st_keyed *c = NULL;
    assert_int_equal(begin_keyed("large", 1, 10, &c), ST_KEYED_KEPT);
    assert_null(c->answer.body);
    assert_int_equal(c->answer.length, ST_KEPT_BODY + 1);
    st_keyed_end(c);

    /* The request changed nothing, and the body of its answer is too large to be kept. Executing
     * the request again is better than repeating an answer without its body, so the key of the
     * request must not be kept. */
    assert_int_equal(begin_keyed("dry", 1, 10, &c), ST_KEYED_NEW);
    keep(c, body, ST_KEPT_BODY + 1, false);
    assert_int_equal(begin_keyed("dry", 1, 10, &c), ST_KEYED_NEW);
    st_keyed_end(c);
    free(body);
}

static void an_answer_that_is_read_outlives_its_place(void **state)
{
    (void)state;
    st_keyed *c = NULL;
    put("a", "body", 4, 0);
    assert_int_equal(begin_keyed("a", 1, 1, &c), ST_KEYED_KEPT);
    assert_false(is_kept("a", ST_KEPT_SECONDS));
    assert_memory_equal(c->answer.body, "body", 4);
    st_keyed_end(c);
}

static void bodies_go_when_memory_is_short(void **state)
{
    (void)state;
    st_keyed *read = NULL, *c = NULL;
    put("a", "body", 4, 0);
    put("b", "body", 4, 0);
    assert_int_equal(begin_keyed("a", 1, 1, &read), ST_KEYED_KEPT);
    uint64_t bytes = keys.bytes;
    st_keys_shed(&keys);
    assert_true(keys.bytes == bytes - 4);
    assert_memory_equal(read->answer.body, "body", 4);
    st_keyed_end(read);
    assert_int_equal(begin_keyed("b", 1, 1, &c), ST_KEYED_KEPT);
    assert_null(c->answer.body);
    st_keyed_end(c);
}

static void keeping_cannot_fail(void **state)
{
    (void)state;
    failing f = {.lasts = true};
    while (failing_next(&f)) {
        st_keyed *c = NULL;
        char text[32];
        bool is_whole = false;
        snprintf(text, sizeof text, "%ld", f.n);
        st_keyed_status status = begin_keyed(text, 1, 0, &c);
        if (status == ST_KEYED_NEW) {
            keep(c, "body", 4, true);
            assert_int_equal(begin_keyed(text, 1, 0, &c), ST_KEYED_KEPT);
            is_whole = c->answer.body != NULL;
            assert_true(!is_whole || memcmp(c->answer.body, "body", 4) == 0);
            st_keyed_end(c);
        } else {
            assert_int_equal(status, ST_KEYED_NO_MEMORY);
        }
        failing_end(&f, is_whole);
    }
    assert_true(f.n > 2);
    assert_true(keys.kept > 0);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(another_holder_has_keys_of_its_own),
        TEST(the_first_answer_is_given_again),
        TEST(of_a_damaged_key_no_request_is_done),
        TEST(a_request_without_an_answer_is_forgotten),
        TEST(answers_last_a_day),
        TEST(the_oldest_go_when_there_are_too_many),
        TEST(bytes_are_bounded),
        TEST(an_answer_that_is_read_outlives_its_place),
        TEST(bodies_go_when_memory_is_short),
        TEST(keeping_cannot_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
