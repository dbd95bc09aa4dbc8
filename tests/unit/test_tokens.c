/* Tests of access tokens: the file that lists them, what they allow, and what happens when another
 * file replaces the list. */
#include "unit/fixture.h"

#include "api/token/tickets.h"
#include "api/token/token_set.h"
#include "tests/failing.h"

#include <math.h>
#include <time.h>

#define HASH                                                                            \
    "sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08" /* "test" \
                                                                               */
#define OTHER  "sha256:60303ae22b998861bce3b28f33eec1be758a213c86c93c076dbe9f558c11c752"
#define PREFIX "0123456789012345678901234567890123456789012345678"

static char message[API_TOKENS_MESSAGE];

static bool read_text(const char *text, api_token_list *out)
{
    message[0] = '\0';
    return api_token_file_read(text, strlen(text), out, message);
}

static void a_line_says_whose_a_token_is_and_what_it_may_do(void **state)
{
    (void)state;
    api_token_list list;
    assert_true(read_text("# comment\n\n  \t\nalice write " HASH "\n"
                          "\tlab-3.x  read\t" OTHER "  prefix=lab-,shared.  "
                          "expires=2027-01-01T12:30:05Z ",
                          &list));
    assert_int_equal(list.count, 2);
    const api_token *a = list.items[0], *b = list.items[1];
    assert_string_equal(a->name, "alice");
    assert_int_equal(a->role, API_ROLE_WRITE);
    assert_int_equal(a->prefix_count, 0);
    assert_true(isinf(a->expires));
    assert_int_equal(a->line, 4);
    assert_string_equal(b->name, "lab-3.x");
    assert_int_equal(b->role, API_ROLE_READ);
    assert_int_equal(b->prefix_count, 2);
    assert_string_equal(b->prefixes[1], "shared.");
    assert_true(b->expires == 1798806605.0);
    unsigned char hash[API_TOKEN_HASH];
    api_token_hash("test", 4, hash); /* the SHA-256 (FIPS 180-4) of the text "test" */
    assert_true(api_token_matches(a, hash));
    assert_false(api_token_matches(b, hash));
    hash[31] ^= 1;
    assert_false(api_token_matches(a, hash));
    api_token_list_clear(&list);

    assert_true(read_text("a admin " HASH " expires=2028-02-29", &list));
    assert_true(list.items[0]->expires == 1835395200.0);
    assert_true(api_token_is_current(list.items[0], 1835395199.0));
    assert_false(api_token_is_current(list.items[0], 1835395200.0));
    api_token_list_clear(&list);
}

static void each_refusal_names_the_line_and_repeats_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } rows[] = {
        {"", "the file of tokens has no token"},
        {"# only\n\n", "the file of tokens has no token"},
        {"a\n", "line 1: the line does not have the form NAME ROLE sha256:HASH"},
        {"\na read\n", "line 2: the line does not have the form NAME ROLE sha256:HASH"},
        {"a/b read " HASH, "line 1: the name (field 1) is not"},
        {"hedge_secret read " HASH, "line 1: the name (field 1) is not"},
        {PREFIX "01234567890123456 read " HASH, "line 1: the name (field 1) is not"},
        {"a secret " HASH, "line 1: the role (field 2) is none of"},
        {"a open " HASH, "line 1: the role (field 2) is none of"},
        {"a Read " HASH, "line 1: the role (field 2) is none of"},
        {"a read hedge_secret",
         "line 1: the hash (field 3) is not \"sha256:\" followed by 64 digits"},
        {"a read " HASH "0", "line 1: the hash (field 3)"},
        {"a read sha256:9F86D081884C7D659A2FEAA0C55AD015A3BF4F1B2B0B822CD15D6C15B0F00A08",
         "line 1: the hash (field 3)"},
        {"a read " HASH " requests=", "line 1: requests= needs a number from 0 to 1000000000"},
        {"a read " HASH " requests=1k", "line 1: requests= needs a number"},
        {"a read " HASH " requests=-1", "line 1: requests= needs a number"},
        {"a read " HASH " jobs=1000000001", "line 1: jobs= needs a number"},
        {"a read " HASH " bytes=2T", "line 1: bytes= needs a number from 0 to 1099511627776 (K, M"},
        {"a read " HASH " bytes=1.5M", "line 1: bytes= needs a number"},
        {"a read " HASH " meshes=1 meshes=1", "line 1: meshes= is given twice"},
        {"a read " HASH " connections=4", "line 1: a field after the hash must be"},
        {"a read " HASH " =4", "line 1: a field after the hash must be"},
        {"a read " HASH " secret",
         "line 1: a field after the hash must be prefix=, expires=, or a limit"},
        {"a read " HASH " prefix=", "line 1: prefix 1 is not"},
        {"a read " HASH " prefix=a,", "line 1: prefix 2 is not"},
        {"a read " HASH " prefix=a/", "line 1: prefix 1 is not"},
        {"a read " HASH " prefix=" PREFIX, "line 1: prefix 1 is not 1 to 48"},
        {"a read " HASH " prefix=a prefix=b", "line 1: prefix= is given twice"},
        {"a read " HASH " prefix=a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q",
         "line 1: a token may have at most 16 prefixes"},
        {"a admin " HASH " prefix=a", "line 1: a token with the role admin may not have prefix="},
        {"a metrics " HASH " prefix=a",
         "line 1: a token with the role metrics may not have prefix="},
        {"a read " HASH " expires=", "line 1: expires= needs"},
        {"a read " HASH " expires=2027", "line 1: expires= needs"},
        {"a read " HASH " expires=2027-02-29", "line 1: expires= needs"},
        {"a read " HASH " expires=2027-01-01T24:00:00Z", "line 1: expires= needs"},
        {"a read " HASH " expires=2027-01-01T00:00:00", "line 1: expires= needs"},
        {"a read " HASH "\nb read " HASH "\n", "line 2: the token in line 1 already has this hash"},
        {"a read " HASH "\n\na write " OTHER "\n",
         "line 3: the token in line 1 already has this name"},
        {"a read " HASH "\r\n", "line 1: byte 79 is a control character"},
        {"# \x01", "line 1: byte 3 is a control character"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        api_token_list list = {NULL, 77};
        if (read_text(rows[i].text, &list)) {
            fail_msg("\"%s\" is taken", rows[i].text);
        }
        if (strncmp(message, rows[i].message, strlen(rows[i].message)) != 0) {
            fail_msg("\"%s\" and not \"%s\"", message, rows[i].message);
        }
        assert_null(strstr(message, "secret"));
        assert_int_equal(list.count, 77);
    }
}

static char *many_lines(size_t count)
{
    char *text = malloc(count * 100 + 1);
    assert_non_null(text);
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        at += (size_t)snprintf(text + at, 100, "t%zu read sha256:%064zx\n", i, i);
    }
    return text;
}

static void a_file_has_its_limits(void **state)
{
    (void)state;
    api_token_list list;
    char *text = many_lines(API_TOKENS + 1);
    assert_false(read_text(text, &list));
    assert_string_equal(message, "line 4097: there are more than 4096 tokens");
    *strstr(text, "t4096 ") = '#';
    assert_true(read_text(text, &list));
    assert_int_equal(list.count, API_TOKENS);
    api_token_list_clear(&list);
    free(text);

    char *large = malloc(API_TOKENS_FILE + 2);
    assert_non_null(large);
    memset(large, '\n', API_TOKENS_FILE + 1);
    large[API_TOKENS_FILE + 1] = '\0';
    assert_false(read_text(large, &list));
    assert_string_equal(message, "the file of tokens is larger than 1048576 bytes");
    memset(large, ' ', API_TOKEN_LINE + 1);
    large[API_TOKEN_LINE + 1] = '\0';
    assert_false(read_text(large, &list));
    assert_string_equal(message, "line 1: the line is longer than 1024 bytes");
    free(large);
}

/* Each row of the table stands for the role of a token, each column for the role that a request
 * requires. */
static void roles_include_each_other_as_documented(void **state)
{
    (void)state;
    enum { A = API_ROLE_ADMIN, W = API_ROLE_WRITE, R = API_ROLE_READ, M = API_ROLE_METRICS };
    static const bool allowed[4][5] = {
        [A] = {[A] = true, [W] = true, [R] = true, [M] = true, [API_ROLE_OPEN] = true},
        [W] = {[W] = true, [R] = true, [API_ROLE_OPEN] = true},
        [R] = {[R] = true, [API_ROLE_OPEN] = true},
        [M] = {[M] = true, [API_ROLE_OPEN] = true},
    };
    for (api_role has = API_ROLE_ADMIN; has < API_ROLE_OPEN; has++) {
        for (api_role needs = API_ROLE_ADMIN; needs <= API_ROLE_OPEN; needs++) {
            if (api_role_allows(has, needs) != allowed[has][needs]) {
                fail_msg("%s for %s", api_role_name(has), api_role_name(needs));
            }
        }
    }
}

static void prefixes_say_which_meshes_there_are(void **state)
{
    (void)state;
    api_token_list list;
    const char *ranges[API_TOKEN_PREFIXES];
    assert_true(read_text("a read " HASH " prefix=b-,a,b-c,ab,z\nb read " OTHER, &list));
    const api_token *token = list.items[0];
    assert_true(api_token_sees(token, "b-"));
    assert_true(api_token_sees(token, "apple"));
    assert_false(api_token_sees(token, "b"));
    assert_false(api_token_sees(token, "c-b-"));
    assert_false(api_token_sees(token, ""));
    assert_true(api_token_sees(list.items[1], "anything"));
    assert_int_equal(api_token_ranges(token, ranges), 3);
    assert_string_equal(ranges[0], "a");
    assert_string_equal(ranges[1], "b-");
    assert_string_equal(ranges[2], "z");
    api_token_list_clear(&list);
}

/* --- replacing the file of tokens --- */

static bool load(api_tokens *tokens, const char *text)
{
    return api_tokens_load(tokens, text, strlen(text), message);
}

typedef struct listener {
    api_token_watch watch;
    int told;
} listener;

static void tell(api_token_watch *watch)
{
    ((listener *)(void *)watch)->told++;
}

static void a_file_takes_the_place_of_another_whole_or_not_at_all(void **state)
{
    (void)state;
    api_tokens *tokens = api_tokens_new();
    assert_non_null(tokens);
    assert_null(api_tokens_find(tokens, "test", 4, 0));
    assert_true(load(tokens, "a read " HASH " expires=1970-01-02\nb write " OTHER));
    assert_int_equal(api_tokens_count(tokens), 2);
    assert_null(api_tokens_find(tokens, "tesT", 4, 0));
    assert_null(api_tokens_find(tokens, "test", 3, 0));
    assert_null(api_tokens_find(tokens, "", 0, 0));
    assert_null(api_tokens_find(tokens, "test", 4, 86400));
    api_token *a = api_tokens_find(tokens, "test", 4, 86399);
    assert_non_null(a);
    listener first = {.watch = {.token = a, .gone = tell}}, second = first, third = first;
    api_tokens_watch(tokens, &first.watch);
    api_tokens_watch(tokens, &second.watch);
    api_tokens_unwatch(tokens, &second.watch);

    assert_false(load(tokens, "a read " HASH "\nwrong"));
    assert_true(api_token_is_current(a, 0));
    assert_true(load(tokens, "# moved\n\na read " HASH " expires=1970-01-02"));
    assert_int_equal(api_tokens_count(tokens), 1);
    api_token *again = api_tokens_find(tokens, "test", 4, 0);
    assert_ptr_equal(again, a); /* kept, since the token's line did not change */
    api_token_release(again);
    assert_int_equal(first.told, 0);

    assert_true(load(tokens, "a write " HASH " expires=1970-01-02"));
    assert_int_equal(first.told, 1);
    assert_int_equal(second.told, 0);
    assert_false(api_token_is_current(a, 0));
    again = api_tokens_find(tokens, "test", 4, 0);
    assert_ptr_not_equal(again, a);
    api_token_release(again);
    api_tokens_watch(tokens, &third.watch); /* calls `gone` at once: the token is gone */
    assert_int_equal(third.told, 1);
    assert_true(load(tokens, "b read " OTHER));
    assert_int_equal(first.told, 1);
    assert_string_equal(a->name, "a"); /* the reference keeps the token alive */
    api_tokens_unwatch(tokens, &first.watch);
    api_token_release(a);
    api_tokens_free(tokens);
}

static void a_line_may_set_limits_of_its_own(void **state)
{
    (void)state;
    const api_limits defaults = {
        .most = {[API_LIMIT_REQUESTS] = 7, [API_LIMIT_BYTES] = 99, [API_LIMIT_MESHES] = 3}};
    api_tokens *tokens = api_tokens_new();
    assert_non_null(tokens);
    api_tokens_limit(tokens, &defaults);
    assert_true(load(tokens, "a read " HASH " requests=20 bytes=10M mesh-bytes=2g prefix=x "
                             "jobs=4 meshes=0\nb write " OTHER));
    api_token *a = api_tokens_find(tokens, "test", 4, 0);
    assert_non_null(a);
    assert_int_equal(api_token_limit(a, API_LIMIT_REQUESTS), 20);
    assert_int_equal(api_token_limit(a, API_LIMIT_BYTES), 10 << 20);
    assert_int_equal(api_token_limit(a, API_LIMIT_MESH_BYTES), UINT64_C(2) << 30);
    assert_int_equal(api_token_limit(a, API_LIMIT_JOBS), 4);
    assert_int_equal(api_token_limit(a, API_LIMIT_MESHES), 0); /* 0 is no limit */
    assert_int_equal(api_token_limit(NULL, API_LIMIT_REQUESTS), 0);

    /* If the file gives a token new limits, the token must stay the same token: running requests
     * must continue, with the new limits. */
    listener watcher = {.watch = {.token = a, .gone = tell}};
    api_tokens_watch(tokens, &watcher.watch);
    assert_false(load(tokens, "a read " HASH " prefix=x requests=1 requests=2"));
    assert_true(load(tokens, "a read " HASH " prefix=x bytes=5"));
    api_token *again = api_tokens_find(tokens, "test", 4, 0);
    assert_ptr_equal(again, a);
    assert_int_equal(watcher.told, 0);
    assert_int_equal(api_token_limit(a, API_LIMIT_REQUESTS), 7); /* the daemon's default */
    assert_int_equal(api_token_limit(a, API_LIMIT_BYTES), 5);
    assert_int_equal(api_token_limit(a, API_LIMIT_MESHES), 3);
    assert_int_equal(api_token_limit(a, API_LIMIT_JOBS), 0);

    /* When the file is replaced, a new token with the name of an old token must continue the count
     * of requests of the old token; a new token with another name must not. */
    api_token_list list;
    assert_true(read_text("a write " OTHER "\nb read " HASH, &list));
    assert_memory_equal(&list.items[0]->rate_key, &a->rate_key, sizeof a->rate_key);
    assert_memory_not_equal(&list.items[1]->rate_key, &a->rate_key, sizeof a->rate_key);
    api_token_list_clear(&list);
    api_tokens_unwatch(tokens, &watcher.watch);
    api_token_release(again);
    api_token_release(a);
    api_tokens_free(tokens);
}

static void without_memory_the_tokens_before_stay(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        api_tokens *tokens = api_tokens_new();
        assert_non_null(tokens);
        assert_true(load(tokens, "a read " HASH));
        failing_resume();
        bool loaded = failing_end(&f, load(tokens, "a write " HASH "\nb read " OTHER));
        assert_true(loaded || strstr(message, "no memory") != NULL);
        api_token *a = api_tokens_find(tokens, "test", 4, 0);
        assert_non_null(a);
        assert_int_equal(a->role, loaded ? API_ROLE_WRITE : API_ROLE_READ);
        api_token_release(a);
        api_tokens_free(tokens);
        assert_true(f.n < 20);
    }
}

static void a_ticket_is_good_once_for_its_path_and_a_minute(void **state)
{
    (void)state;
    api_token_list list;
    api_ticket ticket, another;
    assert_true(read_text("a read " HASH " expires=1970-01-02\nb read " OTHER, &list));
    api_tickets *tickets = api_tickets_new();
    assert_non_null(tickets);
    api_token *a = list.items[0], *b = list.items[1], *got = NULL;
    assert_true(api_tickets_make(tickets, a, "/x", 100, &ticket));
    assert_true(ticket.expires == 160);
    assert_false(api_tickets_take(tickets, ticket.text, "/y", 100, &got));
    assert_false(api_tickets_take(tickets, "ticket", "/x", 100, &got));
    assert_true(api_tickets_take(tickets, ticket.text, "/x", 159, &got));
    assert_ptr_equal(got, a);
    api_token_release(got);
    assert_false(api_tickets_take(tickets, ticket.text, "/x", 159, &got));
    assert_true(api_tickets_make(tickets, a, "/x", 100, &ticket));
    assert_false(
        api_tickets_take(tickets, ticket.text, "/x", 160, &got)); /* too late: the ticket expired */
    assert_true(api_tickets_make(tickets, a, "/x", 86390, &ticket));
    assert_false(
        api_tickets_take(tickets, ticket.text, "/x", 86400, &got)); /* its token has expired */
    for (int i = 0; i < API_TICKETS_OF_A_TOKEN; i++) {
        assert_true(api_tickets_make(tickets, b, "/x", 0, &ticket));
    }
    assert_false(api_tickets_make(tickets, b, "/x", 0, &another));
    for (int i = API_TICKETS_OF_A_TOKEN; i < API_TICKETS; i++) {
        assert_true(api_tickets_make(tickets, NULL, "/x", 0, &another));
    }
    assert_false(api_tickets_make(tickets, NULL, "/x", 0, &another));
    assert_true(api_tickets_make(tickets, NULL, "/x", 60, &another));
    assert_true(api_tickets_take(tickets, another.text, "/x", 60, &got));
    assert_null(got);
    assert_true(api_tickets_make(tickets, b, "/x", 60, &another)); /* api_tickets_free frees it */
    api_tickets_free(tickets);
    assert_int_equal(b->uses, 1);
    api_token_list_clear(&list);
}

static void a_new_token_is_in_its_line(void **state)
{
    (void)state;
    char token[API_TOKEN_TEXT + 1], another[API_TOKEN_TEXT + 1], line[API_TOKEN_SHORT_LINE];
    api_token_make(token);
    api_token_make(another);
    assert_int_equal(strlen(token), API_TOKEN_TEXT);
    assert_string_not_equal(token, another);
    api_token_file_line("someone", API_ROLE_METRICS, token, line);
    assert_null(strstr(line, token));
    api_tokens *tokens = api_tokens_new();
    assert_non_null(tokens);
    assert_true(load(tokens, line));
    api_token *found = api_tokens_find(tokens, token, strlen(token), 0);
    assert_non_null(found);
    assert_string_equal(found->name, "someone");
    assert_int_equal(found->role, API_ROLE_METRICS);
    api_token_release(found);
    assert_null(api_tokens_find(tokens, another, strlen(another), 0));
    api_tokens_free(tokens);
}

/* Returns the processor time of the process, which does not depend on other programs. */
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static double microseconds_a_check(api_tokens *tokens, const char *text)
{
    enum { CHECKS = 100000 };
    double begin = seconds();
    for (int i = 0; i < CHECKS; i++) {
        api_token_release(api_tokens_find(tokens, text, strlen(text), 0));
    }
    return (seconds() - begin) * 1e6 / CHECKS;
}

static void a_check_costs_about_a_microsecond(void **state)
{
    (void)state;
    char token[API_TOKEN_TEXT + 1], line[API_TOKEN_SHORT_LINE];
    api_token_make(token);
    api_token_file_line("one", API_ROLE_READ, token, line);
    char *others = many_lines(API_TOKENS - 1);
    size_t size = strlen(others) + sizeof line + 1;
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, "%s%s", others, line);
    api_tokens *tokens = api_tokens_new();
    assert_non_null(tokens);
    assert_true(load(tokens, text));
    double good = microseconds_a_check(tokens, token);
    token[API_TOKEN_TEXT - 1] ^= 1;
    double wrong = microseconds_a_check(tokens, token);
    printf("note: a token is checked in %.2f us among %d, a wrong one in %.2f us\n", good,
           API_TOKENS, wrong);
    /* a generous limit, because sanitizers and some machines are slow */
    assert_true(good < 20 && wrong < 20);
    free(others);
    free(text);
    api_tokens_free(tokens);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_says_whose_a_token_is_and_what_it_may_do),
        cmocka_unit_test(each_refusal_names_the_line_and_repeats_nothing),
        cmocka_unit_test(a_file_has_its_limits),
        cmocka_unit_test(roles_include_each_other_as_documented),
        cmocka_unit_test(prefixes_say_which_meshes_there_are),
        cmocka_unit_test(a_file_takes_the_place_of_another_whole_or_not_at_all),
        cmocka_unit_test(a_line_may_set_limits_of_its_own),
        cmocka_unit_test(without_memory_the_tokens_before_stay),
        cmocka_unit_test(a_ticket_is_good_once_for_its_path_and_a_minute),
        cmocka_unit_test(a_new_token_is_in_its_line),
        cmocka_unit_test(a_check_costs_about_a_microsecond),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
