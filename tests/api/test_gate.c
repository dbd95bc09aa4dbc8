/* The gate, which decides whether the token of a request may do what it asks (api/request/gate.h),
 * gives the right answers; and if any one of its checks is left out, the tests notice.
 *
 * The linker redirects the calls of each check to a wrapper (Makefile), so that this program can
 * leave out one check at a time. */
#include "tests/api/gate.h"

#include "api/request/gate.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* X(name of the check, its return type, parameters, arguments, result if the check is left out) */
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
    X(api_tokens_find, api_token *, (api_tokens * s, const char *text, size_t length, double now), \
      (s, text, length, now), __real_api_tokens_find(s, "boss-s3cr3t", 11, now))

#define NUMBER(name, type, parameters, arguments, without) CHECK_##name,
enum { CHECKS(NUMBER) CHECK_COUNT };
#undef NUMBER

static int left_out = -1;

#define WRAPPER(name, type, parameters, arguments, without) \
    type __real_##name parameters;                          \
    type __wrap_##name parameters;                          \
    type __wrap_##name parameters                           \
    {                                                       \
        if (left_out == CHECK_##name) {                     \
            return without;                                 \
        }                                                   \
        return __real_##name arguments;                     \
    }
CHECKS(WRAPPER)
#undef WRAPPER

static void no_answer_tells_more_than_it_may(void **state)
{
    (void)state;
    left_out = -1;
    assert_int_equal(gate_findings(true), 0);
}

static void each_check_that_is_left_out_is_noticed(void **state)
{
    (void)state;
#define NAME(name, type, parameters, arguments, without) #name,
    static const char *const names[] = {CHECKS(NAME)};
#undef NAME
    size_t unnoticed = 0;
    for (left_out = 0; left_out < CHECK_COUNT; left_out++) {
        size_t findings = gate_findings(false);
        printf("note: without %s: %zu findings\n", names[left_out], findings);
        unnoticed += findings == 0;
    }
    left_out = -1;
    assert_int_equal(unnoticed, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_answer_tells_more_than_it_may),
        cmocka_unit_test(each_check_that_is_left_out_is_noticed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
