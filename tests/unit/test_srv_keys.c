/* Answers kept for an Idempotency-Key: given again, bounded, forgotten in time. */
#include "server/store/idempotency.h"

#include "base/mem.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static srv_keys keys;
static const uint64_t secret[2] = {3, 4};

static int setup(void **state)
{
    (void)state;
    srv_keys_init(&keys, secret);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    srv_keys_clear(&keys);
    return 0;
}

static api_claim_status claim(const char *text, uint64_t digest, double now, api_claim **out)
{
    api_key key = {.text = text, .digest = {digest, 7}};
    return srv_keys_claim(&keys, &key, now, out);
}

static void keep(api_claim *c, const char *body, size_t length, bool changed)
{
    api_kept answer = {
        .status = 200, .changed = changed, .record = 5, .body = body, .length = length};
    memcpy(answer.etag, "\"tag\"", sizeof "\"tag\"");
    srv_keys_keep(c, &answer);
    srv_keys_end(c);
}

/* Claim and keep at once. */
static void put(const char *text, const char *body, size_t length, double now)
{
    api_claim *c = NULL;
    assert_int_equal(claim(text, 1, now, &c), API_CLAIM_NEW);
    keep(c, body, length, true);
}

static bool is_kept(const char *text, double now)
{
    api_claim *c = NULL;
    api_claim_status status = claim(text, 1, now, &c);
    srv_keys_end(c);
    return status == API_CLAIM_KEPT;
}

static void the_first_answer_is_given_again(void **state)
{
    (void)state;
    api_claim *first = NULL, *again = NULL;
    assert_int_equal(claim("a", 1, 0, &first), API_CLAIM_NEW);
    assert_int_equal(claim("a", 1, 1, &again), API_CLAIM_BUSY);
    assert_int_equal(claim("a", 2, 1, &again), API_CLAIM_OTHER);
    keep(first, "body", 4, true);
    assert_int_equal(claim("a", 2, 1, &again), API_CLAIM_OTHER);
    assert_int_equal(claim("a", 1, 1, &again), API_CLAIM_KEPT);
    assert_int_equal(again->answer.status, 200);
    assert_string_equal(again->answer.etag, "\"tag\"");
    assert_true(again->answer.record == 5);
    assert_memory_equal(again->answer.body, "body", 4);
    srv_keys_end(again);
}

static void a_claim_without_an_answer_is_forgotten(void **state)
{
    (void)state;
    api_claim *c = NULL;
    assert_int_equal(claim("a", 1, 0, &c), API_CLAIM_NEW);
    srv_keys_end(c);
    assert_int_equal(claim("a", 2, 0, &c), API_CLAIM_NEW);
    srv_keys_end(c);
    assert_int_equal(keys.count, 0);
}

static void answers_last_a_day(void **state)
{
    (void)state;
    put("a", "x", 1, 1000);
    assert_true(is_kept("a", 1000 + SRV_KEPT_SECONDS - 1));
    assert_false(is_kept("a", 1000 + SRV_KEPT_SECONDS));
}

static void the_oldest_go_when_there_are_too_many(void **state)
{
    (void)state;
    char text[32];
    for (int i = 0; i < SRV_KEPT_KEYS + 10; i++) {
        snprintf(text, sizeof text, "key-%d", i);
        put(text, "x", 1, i);
    }
    assert_int_equal(keys.kept, SRV_KEPT_KEYS);
    assert_int_equal(keys.count, SRV_KEPT_KEYS);
    assert_false(is_kept("key-9", SRV_KEPT_KEYS));
    assert_true(is_kept("key-10", SRV_KEPT_KEYS));
}

static void bytes_are_bounded(void **state)
{
    (void)state;
    char *body = calloc(1, SRV_KEPT_BODY + 1), text[32];
    assert_non_null(body);
    for (int i = 0; i < 10; i++) {
        snprintf(text, sizeof text, "key-%d", i);
        put(text, body, SRV_KEPT_BODY, i);
        assert_true(keys.bytes <= SRV_KEPT_BYTES);
    }
    assert_true(is_kept("key-9", 10));
    assert_false(is_kept("key-0", 10));

    put("large", body, SRV_KEPT_BODY + 1, 10);
    api_claim *c = NULL;
    assert_int_equal(claim("large", 1, 10, &c), API_CLAIM_KEPT);
    assert_null(c->answer.body);
    assert_int_equal(c->answer.length, SRV_KEPT_BODY + 1);
    srv_keys_end(c);

    /* What changed nothing is better tried again than answered without its body. */
    assert_int_equal(claim("dry", 1, 10, &c), API_CLAIM_NEW);
    keep(c, body, SRV_KEPT_BODY + 1, false);
    assert_int_equal(claim("dry", 1, 10, &c), API_CLAIM_NEW);
    srv_keys_end(c);
    free(body);
}

static void an_answer_that_is_read_outlives_its_place(void **state)
{
    (void)state;
    api_claim *c = NULL;
    put("a", "body", 4, 0);
    assert_int_equal(claim("a", 1, 1, &c), API_CLAIM_KEPT);
    assert_false(is_kept("a", SRV_KEPT_SECONDS));
    assert_memory_equal(c->answer.body, "body", 4);
    srv_keys_end(c);
}

static void bodies_go_when_memory_is_short(void **state)
{
    (void)state;
    api_claim *read = NULL, *c = NULL;
    put("a", "body", 4, 0);
    put("b", "body", 4, 0);
    assert_int_equal(claim("a", 1, 1, &read), API_CLAIM_KEPT);
    uint64_t bytes = keys.bytes;
    srv_keys_shed(&keys);
    assert_true(keys.bytes == bytes - 4);
    assert_memory_equal(read->answer.body, "body", 4);
    srv_keys_end(read);
    assert_int_equal(claim("b", 1, 1, &c), API_CLAIM_KEPT);
    assert_null(c->answer.body);
    srv_keys_end(c);
}

static long left;

static void *fail_later(void *context, void *memory, size_t size)
{
    (void)context;
    if (size == 0) {
        free(memory);
        return NULL;
    }
    return left-- > 0 ? realloc(memory, size) : NULL;
}

static void keeping_cannot_fail(void **state)
{
    (void)state;
    he_mem_set_hook(&(he_mem_hook){fail_later, NULL});
    for (long n = 0; n < 4; n++) {
        api_claim *c = NULL;
        char text[32];
        snprintf(text, sizeof text, "%ld", n);
        left = n;
        api_claim_status status = claim(text, 1, 0, &c);
        if (status == API_CLAIM_NEW) {
            keep(c, "body", 4, true);
            assert_int_equal(claim(text, 1, 0, &c), API_CLAIM_KEPT);
            assert_true(c->answer.body == NULL || memcmp(c->answer.body, "body", 4) == 0);
            srv_keys_end(c);
        } else {
            assert_int_equal(status, API_CLAIM_NO_MEMORY);
        }
    }
    assert_true(keys.kept > 0);
    srv_keys_clear(&keys);
    he_mem_set_hook(NULL);
    srv_keys_init(&keys, secret);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(the_first_answer_is_given_again),
        TEST(a_claim_without_an_answer_is_forgotten),
        TEST(answers_last_a_day),
        TEST(the_oldest_go_when_there_are_too_many),
        TEST(bytes_are_bounded),
        TEST(an_answer_that_is_read_outlives_its_place),
        TEST(bodies_go_when_memory_is_short),
        TEST(keeping_cannot_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
