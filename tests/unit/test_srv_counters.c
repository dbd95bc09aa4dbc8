/* Tests of counters and histograms: no count may be lost when several threads add at the same
 * time. */
#include "tests/unit/fixture.h"

#include "api/metric/metric_page.h"
#include "api/metric/metrics.h"
#include "base/mem.h"
#include "system/counters.h"
#include "system/process.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 4, ROUNDS = 20000 };

static void *add(void *context)
{
    for (size_t i = 0; i < ROUNDS; i++) {
        st_counters_add(context, 0, 2);
        st_counters_add_pair(context, 1, 2, i);
    }
    return NULL;
}

static void what_threads_add_at_once_is_in_the_sum(void **state)
{
    (void)state;
    pthread_t threads[THREADS];
    st_counters *counters = st_counters_new(3);
    assert_non_null(counters);
    for (size_t i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, add, counters), 0);
    }
    for (size_t i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
    }
    assert_int_equal(st_counters_sum(counters, 0), 2 * THREADS * ROUNDS);
    assert_int_equal(st_counters_sum(counters, 1), THREADS * ROUNDS);
    assert_int_equal(st_counters_sum(counters, 2), (uint64_t)THREADS * ROUNDS * (ROUNDS - 1) / 2);
    st_counters_free(counters);
}

static void a_value_is_in_the_bucket_of_the_least_bound_that_is_not_below_it(void **state)
{
    (void)state;
    assert_int_equal(st_bucket_of(st_scale_micros, 0), 0);
    for (size_t i = 0; i < ST_BOUNDS; i++) {
        assert_int_equal(st_bucket_of(st_scale_micros, st_scale_micros[i]), i);
        assert_int_equal(st_bucket_of(st_scale_micros, st_scale_micros[i] + 1), i + 1);
        assert_int_equal(st_bucket_of(st_scale_counts, st_scale_counts[i]), i);
    }
}

static void requests_are_counted_by_row_method_and_class(void **state)
{
    (void)state;
    api_metrics *metrics = api_metrics_new(3);
    st_distribution found;
    assert_non_null(metrics);
    const api_served served[] = {
        {.route = 1, .method = "POST", .status = 201, .micros = 250},
        {.route = 1, .method = "HEAD", .status = 304, .micros = 1},
        {.route = API_NO_ROUTE, .method = "BREW", .status = 405, .code = 1, .bytes_in = 7},
        {.route = 2, .method = "GET", .status = 0},
    };
    for (size_t i = 0; i < sizeof served / sizeof *served; i++) {
        api_count_request(metrics, &served[i]);
    }
    api_requests_counted(metrics, 1, API_METHOD_OTHER, API_CLASS_2XX, &found);
    assert_int_equal(found.buckets[1], 1);
    assert_int_equal(found.sum, 250);
    api_requests_counted(metrics, 1, API_METHOD_HEAD, API_CLASS_3XX, &found);
    assert_int_equal(found.buckets[0], 1);
    api_requests_counted(metrics, API_NO_ROUTE, API_METHOD_OTHER, API_CLASS_4XX, &found);
    assert_int_equal(found.buckets[0], 1);
    api_requests_counted(metrics, 2, API_METHOD_OTHER, API_CLASS_NONE, &found);
    assert_int_equal(found.buckets[0], 1);
    assert_int_equal(api_problems_counted(metrics, 1), 1);
    assert_int_equal(api_counted(metrics, API_COUNT_ENDED), 4);
    assert_int_equal(api_counted(metrics, API_COUNT_BYTES_IN), 7);
    api_metrics_free(metrics);
}

static void labels_are_escaped_and_buckets_add_up(void **state)
{
    (void)state;
    api_text text = {0};
    api_metric_page page = {.text = &text};
    const st_distribution two = {.buckets = {1, 0, 1}, .sum = 900};
    api_metric_begin(&page, API_METRIC_ID_BUILD_INFO);
    api_metric_put(&page, (const char *const[]){"a\"b", "c\\d"}, 1);
    api_metric_begin(&page, API_METRIC_ID_LOAD_TIME);
    api_metric_put_histogram(&page, NULL, &two, st_scale_micros, 1000000);
    api_text_add_char(&text, '\0');
    assert_false(text.failed);
    assert_non_null(
        strstr(text.bytes, "\nhedge_build_info{version=\"a\\\"b\",commit=\"c\\\\d\"} 1\n"));
    assert_non_null(strstr(text.bytes, "_bucket{le=\"0.0003\"} 1\n"));
    assert_non_null(strstr(text.bytes, "_bucket{le=\"+Inf\"} 2\n"));
    assert_non_null(strstr(text.bytes, "_count 2\n"));
    api_text_clear(&text);
}

static void the_system_tells_of_the_process(void **state)
{
    (void)state;
    st_process process;
    st_process_read(&process);
    assert_true(process.processor > 0 && process.started > 1e9);
    assert_true(process.resident > 0 && process.address_space >= process.resident);
    assert_true(process.descriptors >= 3 && process.most_descriptors >= process.descriptors);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_threads_add_at_once_is_in_the_sum),
        cmocka_unit_test(a_value_is_in_the_bucket_of_the_least_bound_that_is_not_below_it),
        cmocka_unit_test(requests_are_counted_by_row_method_and_class),
        cmocka_unit_test(labels_are_escaped_and_buckets_add_up),
        cmocka_unit_test(the_system_tells_of_the_process),
    };
    return cmocka_run_group_tests_name("counters", tests, NULL, NULL);
}
