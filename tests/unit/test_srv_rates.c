/* Tests of the token buckets that limit the requests and bytes of clients, with a clock that the
 * test sets: which requests are admitted, how long a bucket stays in debt, which bucket is dropped
 * when the table is full, and what the header fields say. */
#include "unit/fixture.h"

#include "api/limit/rate.h"
#include "tests/seed.h"
#include "tests/failing.h"
#include "tests/sanitized.h"

#include <pthread.h>
#include <time.h>

#define SECOND UINT64_C(1000000)
/* The clock of the test begins at an arbitrary time. */
#define START UINT64_C(77000000)

static api_rate_key key_of(uint64_t client)
{
    return (api_rate_key){{client, client * 3}};
}

static bool admit(api_rates *rates, uint64_t client, const api_rate *rate, uint64_t now,
                  api_rate_state *out)
{
    const api_rate_key key = key_of(client);
    return api_rates_admit(rates, &key, rate, now, out);
}

static void charge(api_rates *rates, uint64_t client, const api_rate *rate, uint64_t bytes,
                   uint64_t now)
{
    const api_rate_key key = key_of(client);
    api_rates_charge(rates, &key, rate, bytes, now);
}

static void a_bucket_lets_its_burst_in_and_then_its_rate(void **state)
{
    (void)state;
    const api_rate rate = {.requests = 5, .seconds = 2};
    api_rates *rates = api_rates_new(4);
    api_rate_state said;
    assert_non_null(rates);
    for (uint64_t i = 0; i < 10; i++) {
        assert_true(admit(rates, 1, &rate, START, &said));
        assert_int_equal(said.requests.left, 9 - i);
        assert_int_equal(said.requests.wait, 0);
    }
    assert_int_equal(said.requests.reset, 2);
    assert_false(admit(rates, 1, &rate, START, &said));
    assert_int_equal(said.requests.wait, 1);
    assert_int_equal(said.requests.left, 0);
    assert_false(admit(rates, 1, &rate, START + SECOND / 5 - 1, &said));
    assert_true(admit(rates, 1, &rate, START + SECOND / 5, &said));
    assert_false(admit(rates, 1, &rate, START + SECOND / 5, &said));
    /* However long a client waits, its bucket must not hold more than the burst. */
    for (int i = 0; i < 10; i++) {
        assert_true(admit(rates, 1, &rate, START + 100 * SECOND, &said));
    }
    assert_false(admit(rates, 1, &rate, START + 100 * SECOND, &said));
    assert_true(admit(rates, 2, &rate, START, &said)); /* another client has a bucket of its own */
    api_rates_free(rates);
}

static void bytes_make_a_debt_that_is_paid_before_another_request(void **state)
{
    (void)state;
    const api_rate rate = {.bytes = 1000, .seconds = 10};
    api_rates *rates = api_rates_new(4);
    api_rate_state said;
    assert_non_null(rates);
    assert_true(admit(rates, 1, &rate, START, &said));
    charge(rates, 1, &rate, 9999, START);
    assert_true(admit(rates, 1, &rate, START, &said)); /* one byte is left in the bucket */
    assert_int_equal(said.bytes.left, 1);
    assert_int_equal(said.requests.reset, 0); /* 0 because requests are not limited */
    charge(rates, 1, &rate, 50001, START);
    assert_false(admit(rates, 1, &rate, START, &said));
    assert_int_equal(said.bytes.wait,
                     51); /* seconds until the bucket holds a byte again, rounded up */
    assert_int_equal(said.bytes.reset, 60);
    assert_false(admit(rates, 1, &rate, START + 50 * SECOND, &said));
    assert_true(admit(rates, 1, &rate, START + 50 * SECOND + 1000, &said));
    /* If a charge is so large that no bucket could ever pay it, the debt must last for ever, and no
     * number may overflow. */
    charge(rates, 1, &rate, UINT64_MAX, START + 50 * SECOND);
    charge(rates, 1, &rate, UINT64_MAX, START + 50 * SECOND);
    assert_false(admit(rates, 1, &rate, START + 1000 * SECOND, &said));
    api_rates_free(rates);
}

static void a_refused_request_costs_nothing(void **state)
{
    (void)state;
    const api_rate rate = {.requests = 1, .bytes = 10, .seconds = 1};
    api_rates *rates = api_rates_new(4);
    api_rate_state said;
    assert_non_null(rates);
    assert_true(admit(rates, 1, &rate, START, &said));
    for (int i = 0; i < 1000; i++) {
        assert_false(admit(rates, 1, &rate, START + 1, &said));
    }
    assert_true(admit(rates, 1, &rate, START + SECOND, &said));
    charge(rates, 1, &rate, 20, START + SECOND);
    assert_false(admit(rates, 1, &rate, START + 2 * SECOND, &said)); /* the byte limit refuses it */
    assert_int_equal(said.requests.left, 1);
    assert_int_equal(said.requests.wait, 0);
    assert_true(said.bytes.wait > 0);
    api_rates_free(rates);
}

static void new_limits_hold_at_once_for_a_bucket_that_is_there(void **state)
{
    (void)state;
    const api_rate small = {.requests = 2, .seconds = 1}, large = {.requests = 4, .seconds = 1};
    const api_rate none = {.bytes = 5, .seconds = 1};
    api_rates *rates = api_rates_new(4);
    api_rate_state said;
    assert_non_null(rates);
    assert_true(admit(rates, 1, &small, START, &said));
    assert_true(admit(rates, 1, &small, START, &said));
    assert_false(admit(rates, 1, &small, START, &said));
    /* the bucket admits two more requests, not four, because it admitted two before the limits
     * changed */
    assert_true(admit(rates, 1, &large, START, &said));
    assert_true(admit(rates, 1, &large, START, &said));
    assert_false(admit(rates, 1, &large, START, &said));
    assert_false(admit(rates, 1, &small, START, &said));
    assert_true(admit(rates, 1, &none, START, &said)); /* without limits, debts are forgotten */
    assert_true(admit(rates, 1, &small, START, &said));
    api_rates_free(rates);
}

static void a_clock_that_runs_backwards_fills_nothing(void **state)
{
    (void)state;
    const api_rate rate = {.requests = 1, .seconds = 1};
    api_rates *rates = api_rates_new(1);
    api_rate_state said;
    assert_non_null(rates);
    assert_true(admit(rates, 1, &rate, START, &said));
    assert_false(admit(rates, 1, &rate, START - 50 * SECOND, &said));
    assert_false(admit(rates, 1, &rate, START + SECOND - 1, &said));
    assert_true(admit(rates, 1, &rate, START + SECOND, &said));
    api_rates_free(rates);
}

static void of_a_full_table_the_oldest_full_bucket_goes(void **state)
{
    (void)state;
    const api_rate rate = {.requests = 1, .bytes = 10, .seconds = 10};
    api_rates *rates = api_rates_new(3);
    api_rate_state said;
    assert_non_null(rates);
    assert_true(admit(rates, 1, &rate, START, &said));
    charge(rates, 1, &rate, 1000, START); /* the debt of client 1 will last long */
    assert_true(admit(rates, 2, &rate, START, &said));
    assert_true(admit(rates, 3, &rate, START, &said));
    assert_int_equal(api_rates_count(rates), 3);
    /* The buckets of clients 2 and 3 are full again. The bucket of client 2 was used earlier than
     * that of client 3, so the bucket of client 2 must be dropped to make room. */
    assert_true(admit(rates, 4, &rate, START + 2 * SECOND, &said));
    assert_int_equal(api_rates_count(rates), 3);
    assert_false(admit(rates, 1, &rate, START + 2 * SECOND, &said));
    assert_true(admit(rates, 3, &rate, START + 2 * SECOND, &said));
    assert_int_equal(said.requests.left, 9);
    /* No bucket is full, so the bucket that was not used for the longest time must be dropped. Its
     * client then gets a new, full bucket. */
    assert_true(admit(rates, 5, &rate, START + 2 * SECOND, &said));
    assert_true(admit(rates, 4, &rate, START + 2 * SECOND, &said));
    assert_int_equal(said.requests.left, 9);
    api_rates_free(rates);
}

/* --- random steps, compared with a model that fills buckets every microsecond --- */

enum { CLIENTS = 14, ROOM = 10 };

typedef struct naive {
    bool is_there;
    uint64_t requests,
        bytes;     /* how much was taken from the bucket, in millionths of a request or byte */
    uint64_t used; /* number of the last step that used the bucket */
    api_rate rate; /* rate at the last use */
} naive;

static naive world[CLIENTS];

static void pass(naive *n, uint64_t micros)
{
    for (uint64_t i = 0; i < micros; i++) {
        n->requests -= n->requests < n->rate.requests ? n->requests : n->rate.requests;
        n->bytes -= n->bytes < n->rate.bytes ? n->bytes : n->rate.bytes;
    }
}

static void pass_all(uint64_t micros)
{
    for (size_t i = 0; i < CLIENTS; i++) {
        if (world[i].is_there) {
            pass(&world[i], micros);
        }
    }
}

static bool is_full(const naive *n)
{
    return (n->requests == 0 || n->rate.requests == 0) && (n->bytes == 0 || n->rate.bytes == 0);
}

/* Lists the clients that have a bucket, beginning with the bucket that was used longest ago. */
static size_t by_age(size_t order[CLIENTS])
{
    size_t count = 0;
    for (size_t i = 0; i < CLIENTS; i++) {
        size_t at = count;
        if (!world[i].is_there) {
            continue;
        }
        for (count++; at > 0 && world[order[at - 1]].used > world[i].used; at--) {
            order[at] = order[at - 1];
        }
        order[at] = i;
    }
    return count;
}

static naive *use(size_t client, const api_rate *rate, uint64_t step)
{
    size_t order[CLIENTS], count = by_age(order);
    if (!world[client].is_there && count == ROOM) {
        size_t gone = order[0];
        for (size_t i = 0; i < API_RATE_LOOKS && i < count; i++) {
            if (is_full(&world[order[i]])) {
                gone = order[i];
                break;
            }
        }
        world[gone] = (naive){.is_there = false};
    }
    naive *n = &world[client];
    n->is_there = true;
    n->rate = *rate;
    n->used = step;
    n->requests = rate->requests == 0 ? 0 : n->requests;
    n->bytes = rate->bytes == 0 ? 0 : n->bytes;
    return n;
}

static bool expect_admit(naive *n)
{
    const api_rate *rate = &n->rate;
    bool good =
        rate->requests == 0 || n->requests + SECOND <= rate->requests * rate->seconds * SECOND;
    good = good && (rate->bytes == 0 || n->bytes + SECOND <= rate->bytes * rate->seconds * SECOND);
    n->requests += good && rate->requests != 0 ? SECOND : 0;
    return good;
}

static void random_steps_agree_with_a_slow_oracle(void **state)
{
    (void)state;
    /* Each client must have the same limits during the whole test, because the model always fills a
     * bucket at the rate of its last use. */
    static const api_rate kinds[] = {{.requests = 2000, .seconds = 1},
                                     {.bytes = 50000, .seconds = 1},
                                     {.requests = 900, .bytes = 30000, .seconds = 2},
                                     {.requests = 3, .bytes = 7000000, .seconds = 1}};
    uint64_t seed = seed_of_run(), now = START, admitted = 0, refused = 0;
    api_rates *rates = api_rates_new(ROOM);
    assert_non_null(rates);
    srand((unsigned)seed);
    for (uint64_t step = 1; step <= 20000; step++) {
        size_t client = (size_t)rand() % (rand() % 4 == 0 ? CLIENTS : 3);
        const api_rate *rate = &kinds[client % 4];
        uint64_t passed = rand() % 3 == 0 ? (uint64_t)rand() % 1500 : 0;
        pass_all(passed);
        now += passed;
        if (rand() % 3 == 0) {
            uint64_t bytes = (uint64_t)rand() % 2000;
            naive *n = use(client, rate, step);
            n->bytes += rate->bytes == 0 ? 0 : bytes * SECOND;
            charge(rates, client, rate, bytes, now);
            continue;
        }
        naive *n = use(client, rate, step);
        api_rate_state said;
        bool expected = expect_admit(n);
        if (admit(rates, client, rate, now, &said) != expected) {
            fail_msg("step %llu: client %zu was %s", (unsigned long long)step, client,
                     expected ? "refused" : "let in");
        }
        admitted += expected ? 1 : 0;
        refused += expected ? 0 : 1;
        uint64_t most = rate->requests * rate->seconds * SECOND;
        uint64_t left = most > n->requests ? (most - n->requests) / SECOND : 0;
        assert_int_equal(said.requests.left, left);
        assert_true((said.requests.wait > 0 || said.bytes.wait > 0) == !expected);
    }
    printf("note: %llu requests let in, %llu refused\n", (unsigned long long)admitted,
           (unsigned long long)refused);
    assert_true(admitted > 1000 && refused > 1000);
    api_rates_free(rates);
}

/* --- header fields, memory and speed --- */

static void the_fields_say_what_is_limited_and_what_is_left(void **state)
{
    (void)state;
    char policy[API_RATE_FIELD], field[API_RATE_FIELD];
    api_rate rate = {.requests = 20, .seconds = 10};
    const api_rate_state left = {.requests = {199, 1, 0}, .bytes = {0, 61, 51}};
    api_rate_policy(&rate, policy);
    api_rate_field(&rate, &left, field);
    assert_string_equal(policy, "\"requests\";q=200;w=10");
    assert_string_equal(field, "\"requests\";r=199;t=1");
    rate.bytes = 1000;
    api_rate_policy(&rate, policy);
    api_rate_field(&rate, &left, field);
    assert_string_equal(policy,
                        "\"requests\";q=200;w=10, \"bytes\";q=10000;w=10;qu=\"content-bytes\"");
    assert_string_equal(field, "\"requests\";r=199;t=1, \"bytes\";r=0;t=61");
    rate.requests = 0;
    api_rate_policy(&rate, policy);
    assert_string_equal(policy, "\"bytes\";q=10000;w=10;qu=\"content-bytes\"");
    /* The largest possible values must fit into the header field, where an integer has at most 15
     * digits. */
    rate = (api_rate){API_LIMIT_MOST, API_LIMIT_MOST_BYTES, API_BURST_MOST};
    const api_rate_state most = {{UINT64_MAX, UINT64_MAX, 0}, {UINT64_MAX, UINT64_MAX, 0}};
    api_rate_policy(&rate, policy);
    api_rate_field(&rate, &most, field);
    assert_non_null(strstr(field, "\"bytes\";r=999999999999999;t=999999999999999"));
    rate = (api_rate){.seconds = 1};
    api_rate_policy(&rate, policy);
    api_rate_field(&rate, &left, field);
    assert_string_equal(policy, "");
    assert_string_equal(field, "");
}

static void amounts_are_numbers_with_units_where_they_are_bytes(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        bool bytes, good;
        uint64_t value;
    } rows[] = {{"0", false, true, 0},
                {"12", false, true, 12},
                {"10M", true, true, 10 << 20},
                {"1k", true, true, 1024},
                {"2T", true, true, UINT64_C(2) << 40},
                {"10M", false, false, 0},
                {"10Mb", true, false, 0},
                {"M", true, false, 0},
                {"", true, false, 0},
                {"-1", true, false, 0},
                {"1.5", true, false, 0},
                {"18446744073709551600", false, true, UINT64_MAX - 15},
                {"18446744073709551616", false, false, 0},
                {"99999999999T", true, false, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint64_t value = 0;
        bool good = api_amount_parse(rows[i].text, strlen(rows[i].text), rows[i].bytes, &value);
        if (good != rows[i].good || (good && value != rows[i].value)) {
            fail_msg("\"%s\": %d, %llu", rows[i].text, good, (unsigned long long)value);
        }
    }
}

static void a_table_is_made_whole_or_not_at_all(void **state)
{
    (void)state;
    const api_rate rate = {.requests = 10, .seconds = 1};
    api_rate_state said;
    api_rates *rates = NULL;
    failing f = {0};
    while (failing_next(&f)) {
        rates = api_rates_new(8);
        failing_end(&f, rates != NULL);
        assert_true(f.n < 10);
    }
    assert_true(f.n > 3);
    /* Once the table is made, requests must allocate no memory. */
    failing_at(1);
    for (uint64_t i = 0; i < 100; i++) {
        assert_true(admit(rates, i, &rate, START + i, &said));
        charge(rates, i, &rate, 5, START + i);
    }
    assert_int_equal(failing_count(), 0);
    api_rates_free(rates);
    failing_off();
}

enum { THREADS = 4, TRIES = 20000 };

typedef struct crowd {
    api_rates *rates;
    uint64_t admitted;
} crowd;

static void *try_often(void *context)
{
    crowd *c = context;
    const api_rate rate = {.requests = 1000, .bytes = 1 << 30, .seconds = 10};
    api_rate_state said;
    for (uint64_t i = 0; i < TRIES; i++) {
        c->admitted += admit(c->rates, 1, &rate, START, &said) ? 1 : 0;
        (void)admit(c->rates, 2 + i % 20, &rate, START, &said);
        charge(c->rates, 1, &rate, 1, START);
    }
    return NULL;
}

static void threads_share_a_bucket_and_never_more_than_its_burst(void **state)
{
    (void)state;
    pthread_t threads[THREADS];
    crowd crowds[THREADS];
    uint64_t admitted = 0;
    api_rates *rates = api_rates_new(64);
    assert_non_null(rates);
    for (int i = 0; i < THREADS; i++) {
        crowds[i] = (crowd){rates, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, try_often, &crowds[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(threads[i], NULL), 0);
        admitted += crowds[i].admitted;
    }
    assert_int_equal(admitted, 10000);
    api_rates_free(rates);
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static void a_request_costs_as_much_among_many_clients_as_among_few(void **state)
{
    (void)state;
    enum { REQUESTS = SANITIZED ? 100000 : 400000 };
    const api_rate rate = {.requests = 1000000, .bytes = 1 << 30, .seconds = 10};
    double costs[2];
    for (int many = 0; many < 2; many++) {
        const uint64_t clients = many ? API_ADDRESS_RATES : 16;
        api_rates *rates = api_rates_new(API_ADDRESS_RATES);
        char policy[API_RATE_FIELD], field[API_RATE_FIELD];
        api_rate_state said;
        assert_non_null(rates);
        double begin = seconds();
        for (uint64_t i = 0; i < REQUESTS; i++) {
            (void)admit(rates, i * 40503 % clients, &rate, START + i, &said);
            charge(rates, i * 40503 % clients, &rate, 300, START + i);
            api_rate_policy(&rate, policy);
            api_rate_field(&rate, &said, field);
        }
        costs[many] = (seconds() - begin) * 1e6 / REQUESTS;
        api_rates_free(rates);
    }
    printf("note: limits cost a request %.2f us with 16 clients, %.2f us with %d\n", costs[0],
           costs[1], API_ADDRESS_RATES);
    /* the limit is generous, because sanitizers and some machines are slow */
    assert_true(costs[0] < 20 && costs[1] < 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bucket_lets_its_burst_in_and_then_its_rate),
        cmocka_unit_test(bytes_make_a_debt_that_is_paid_before_another_request),
        cmocka_unit_test(a_refused_request_costs_nothing),
        cmocka_unit_test(new_limits_hold_at_once_for_a_bucket_that_is_there),
        cmocka_unit_test(a_clock_that_runs_backwards_fills_nothing),
        cmocka_unit_test(of_a_full_table_the_oldest_full_bucket_goes),
        cmocka_unit_test(random_steps_agree_with_a_slow_oracle),
        cmocka_unit_test(the_fields_say_what_is_limited_and_what_is_left),
        cmocka_unit_test(amounts_are_numbers_with_units_where_they_are_bytes),
        cmocka_unit_test(a_table_is_made_whole_or_not_at_all),
        cmocka_unit_test(threads_share_a_bucket_and_never_more_than_its_burst),
        cmocka_unit_test(a_request_costs_as_much_among_many_clients_as_among_few),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
