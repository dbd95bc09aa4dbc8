/* The gate, which decides whether a request may do what it asks for with its token
 * (api/request/gate.h), must decide correctly, and the tests must fail if any one of its checks is
 * left out.
 *
 * The linker replaces calls of each check by calls of a wrapper in this file (see the Makefile), so
 * that the program can leave out one check at a time. */
#include "tests/api/gate.h"
#include "tests/sanitized.h"

#include "api/request/gate.h"
#include "api/request/rating.h"
#include "api/token/tickets.h"
#include "store/holder/holders.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Each row is X(name of a check, its return type, its parameters, its arguments, the result that
 * the wrapper returns if the check is left out). */
#define CHECKS(X)                                                                                  \
    X(api_gate_enter, bool, (api_exchange * x), (x), true)                                         \
    X(api_gate_sees, bool, (const api_exchange *x, const char *mesh), (x, mesh), true)             \
    X(api_gate_may_create, bool, (api_exchange * x, const char *mesh), (x, mesh), true)            \
    X(api_gate_may_change, bool, (api_exchange * x), (x), true)                                    \
    X(api_role_allows, bool, (api_role has, api_role needs), (has, needs), true)                   \
    X(api_token_is_current, bool, (const api_token *t, double now), (t, now), true)                \
    X(api_token_owns, bool, (const api_token *t, const char *holder, const char *mesh),            \
      (t, holder, mesh), true)                                                                     \
    X(api_token_is_equal, bool, (const unsigned char *a, const unsigned char *b, size_t length),   \
      (a, b, length), true)                                                                        \
    X(st_keyed_begin, st_keyed_status,                                                             \
      (st_store * s, st_mesh * m, const st_key *k, st_keyed **out), (s, m, k, out),                \
      __real_st_keyed_begin(s, m, &(st_key){k->text, {k->digest[0], k->digest[1]}, ""}, out))      \
    X(api_token_ranges, size_t, (const api_token *t, const char **out), (t, out), 0)               \
    X(api_token_matches, bool, (const api_token *t, const unsigned char *h), (t, h), true)         \
    X(api_token_sees, bool, (const api_token *t, const char *mesh), (t, mesh), true)               \
    X(api_rating_enter, bool, (api_exchange * x), (x), true)                                       \
    X(api_rates_admit, bool,                                                                       \
      (api_rates * r, const api_rate_key *key, const api_rate *rate, uint64_t now,                 \
       api_rate_state *out),                                                                       \
      (r, key, rate, now, out), true)                                                              \
    X(st_holders_move, st_status,                                                                  \
      (st_holders * h, const st_holding *gone, const st_holding *come), (h, gone, come),           \
      (st_holders_note(h, gone, come), ST_OK))                                                     \
    X(api_job_submit, st_status,                                                                   \
      (api_job_table * table, const api_job_work *work, const char *operation, const char *mesh,   \
       api_job *out),                                                                              \
      (table, work, operation, mesh, out),                                                         \
      __real_api_job_submit(table, unlimited(work), operation, mesh, out))                         \
    X(api_tickets_take, bool,                                                                      \
      (api_tickets * t, const char *text, const char *target, double now, api_token **out),        \
      (t, text, target, now, out), __real_api_tickets_take(t, text, target, 0, out))               \
    X(api_tokens_find, api_token *, (api_tokens * s, const char *text, size_t length, double now), \
      (s, text, length, now), __real_api_tokens_find(s, "boss-s3cr3t", 11, now))

/* Each row is X(name of a function without a result, its parameters, its arguments). If the
 * function is left out, its wrapper does nothing. */
#define ACTIONS(X)                                                       \
    X(api_rating_charge, (api_exchange * x, uint64_t bytes), (x, bytes)) \
    X(api_tokens_watch, (api_tokens * s, api_token_watch * w), (s, w))

#define NUMBER(name, ...) CHECK_##name,
enum { CHECKS(NUMBER) ACTIONS(NUMBER) CHECK_COUNT };
#undef NUMBER

static int left_out = -1;
static size_t compared; /* number of calls of the function that compares hashes */

static const api_job_work *unlimited(const api_job_work *work)
{
    static api_job_work copy;
    copy = *work;
    copy.most = 0;
    return &copy;
}

#define WRAPPER(name, type, parameters, arguments, without)                                      \
    type __real_##name parameters;                                                               \
    type __wrap_##name parameters;                                                               \
    type __wrap_##name parameters                                                                \
    {                                                                                            \
        compared +=                                                                              \
            CHECK_##name == CHECK_api_token_matches || CHECK_##name == CHECK_api_token_is_equal; \
        if (left_out == CHECK_##name) {                                                          \
            return without;                                                                      \
        }                                                                                        \
        return __real_##name arguments;                                                          \
    }
CHECKS(WRAPPER)
#undef WRAPPER

#define WRAPPER(name, parameters, arguments) \
    void __real_##name parameters;           \
    void __wrap_##name parameters;           \
    void __wrap_##name parameters            \
    {                                        \
        if (left_out != CHECK_##name) {      \
            __real_##name arguments;         \
        }                                    \
    }
ACTIONS(WRAPPER)
#undef WRAPPER

double __real_st_clock_utc(void);
double __wrap_st_clock_utc(void);
double __wrap_st_clock_utc(void)
{
    return __real_st_clock_utc() + gate_seconds_passed;
}

static void no_answer_tells_more_than_it_may(void **state)
{
    (void)state;
    left_out = -1;
    assert_int_equal(gate_findings(true), 0);
    assert_int_equal(gate_limit_findings(true), 0);
}

static void each_check_that_is_left_out_is_noticed(void **state)
{
    (void)state;
#define NAME(name, ...) #name,
    static const char *const names[] = {CHECKS(NAME) ACTIONS(NAME)};
#undef NAME
    size_t unnoticed = 0;
    /* What is noticed does not depend on the build, so a few checks suffice under a sanitizer. */
    for (left_out = 0; left_out < CHECK_COUNT; left_out += SANITIZED ? 5 : 1) {
        /* gate_limit_findings() is called first because it takes less time than gate_findings() */
        size_t findings = gate_limit_findings(false);
        findings = findings > 0 ? findings : gate_findings(false);
        printf("note: without %s: %zu findings\n", names[left_out], findings);
        unnoticed += findings == 0;
    }
    left_out = -1;
    assert_int_equal(unnoticed, 0);
}

/* The time of a lookup must not reveal whether a ticket was found, or how much of a guessed ticket
 * was correct. So the lookup must compare the hashes of all tickets, even after it has found the
 * right one. */
static void as_many_tickets_are_compared_whichever_is_found(void **state)
{
    (void)state;
    enum { TICKETS = 20 };
    api_ticket made[TICKETS];
    api_token *token = NULL;
    api_tickets *tickets = api_tickets_new();
    assert_non_null(tickets);
    for (size_t i = 0; i < TICKETS; i++) {
        assert_true(api_tickets_make(tickets, NULL, "/", 0, &made[i]));
    }
    for (size_t i = 0; i < TICKETS; i++) {
        compared = 0;
        assert_false(api_tickets_take(tickets, made[i].text, "/other", 0, &token));
        assert_int_equal(compared, TICKETS);
    }
    for (size_t i = 0; i < TICKETS; i++) {
        compared = 0;
        assert_true(api_tickets_take(tickets, made[(7 * i) % TICKETS].text, "/", 0, &token));
        assert_int_equal(compared, TICKETS - i);
    }
    api_tickets_free(tickets);
}

/* A lookup must compare all tokens in a bucket of the hash table, even after it has found the right
 * one. So the lookup of each of the k tokens in a bucket takes k comparisons, and the number of
 * tokens whose lookup takes k comparisons is a multiple of k. */
static void as_many_tokens_are_compared_whichever_is_found(void **state)
{
    (void)state;
    enum { MANY = 3000, MOST = 20 };
    size_t counts[MOST] = {0}, used = 0;
    char *file = malloc(MANY * API_TOKEN_SHORT_LINE), text[40], message[API_TOKENS_MESSAGE];
    api_tokens *set = api_tokens_new();
    assert_non_null(file);
    assert_non_null(set);
    for (int i = 0; i < MANY; i++) {
        char name[20], line[API_TOKEN_SHORT_LINE];
        snprintf(name, sizeof name, "t%d", i);
        snprintf(text, sizeof text, "text of %d", i);
        api_token_file_line(name, API_ROLE_READ, text, line);
        used += (size_t)snprintf(file + used, API_TOKEN_SHORT_LINE, "%s\n", line);
    }
    assert_true(api_tokens_load(set, file, used, message));
    for (int i = 0; i < MANY; i++) {
        snprintf(text, sizeof text, "text of %d", i);
        compared = 0;
        api_token *token = api_tokens_find(set, text, strlen(text), 0);
        assert_non_null(token);
        api_token_release(token);
        assert_true(compared > 0 && compared < MOST);
        counts[compared]++;
    }
    for (size_t k = 1; k < MOST; k++) {
        assert_int_equal(counts[k] % k, 0);
    }
    assert_true(counts[2] > 0);
    api_tokens_free(set);
    free(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_answer_tells_more_than_it_may),
        cmocka_unit_test(each_check_that_is_left_out_is_noticed),
        cmocka_unit_test(as_many_tickets_are_compared_whichever_is_found),
        cmocka_unit_test(as_many_tokens_are_compared_whichever_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
