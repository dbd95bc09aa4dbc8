#include "api/metric/metrics.h"

#include "api/json/problem.h"
#include "base/mem.h"
#include "system/counters.h"

#include <assert.h>
#include <stdatomic.h>
#include <string.h>

/* The index at which each part of the array of counters begins. First come the counters of
 * api_counter, at 0; then problems by code; then edits by operation and result; then, for each
 * series of requests and class of statuses, the buckets of a histogram and its sum. */
enum {
    PROBLEMS = API_COUNTERS,
    EDITS = PROBLEMS + API_CODE_COUNT,
    SERIES = EDITS + API_OPERATIONS * API_EDIT_RESULTS,
    SERIES_SIZE = ST_BUCKETS + 1
};

struct api_metrics {
    size_t routes;
    st_counters *counters;
    _Atomic uint64_t connection_limit;
};

static const char *const method_names[API_METHODS] = {"GET",   "HEAD",   "POST",    "PUT",
                                                      "PATCH", "DELETE", "OPTIONS", "other"};
static const char *const class_names[API_CLASSES] = {"none", "2xx", "3xx", "4xx", "5xx"};

const char *api_method_name(api_method method)
{
    return method_names[method];
}

const char *api_class_name(api_class of)
{
    return class_names[of];
}

api_metrics *api_metrics_new(size_t routes)
{
    assert(he_op_count() <= API_MOST_OPERATIONS);
    api_metrics *metrics = he_mem_zero(1, sizeof *metrics);
    if (metrics != NULL) {
        const size_t series = (2 * routes + API_METHODS) * API_CLASSES;
        metrics->routes = routes;
        metrics->counters = st_counters_new(SERIES + series * SERIES_SIZE);
        if (metrics->counters == NULL) {
            he_mem_free(metrics);
            metrics = NULL;
        }
    }
    return metrics;
}

void api_metrics_free(api_metrics *metrics)
{
    if (metrics != NULL) {
        st_counters_free(metrics->counters);
        he_mem_free(metrics);
    }
}

static api_method method_of(const char *name)
{
    api_method method = 0;
    while (method < API_METHOD_OTHER && strcmp(name, method_names[method]) != 0) {
        method++;
    }
    return method;
}

static api_class class_of(int status)
{
    return status >= 500   ? API_CLASS_5XX
           : status >= 400 ? API_CLASS_4XX
           : status >= 300 ? API_CLASS_3XX
           : status >= 200 ? API_CLASS_2XX
                           : API_CLASS_NONE;
}

/* Returns the index in the array of counters at which the histogram of a series and class of
 * statuses begins. */
static size_t series_at(const api_metrics *metrics, int route, api_method method, api_class of)
{
    const size_t series = route == API_NO_ROUTE ? 2 * metrics->routes + method
                                                : 2 * (size_t)route + (method == API_METHOD_HEAD);
    return SERIES + (series * API_CLASSES + of) * SERIES_SIZE;
}

void api_count_request(api_metrics *metrics, const api_served *served)
{
    st_counters *counters = metrics->counters;
    /* Each route has two series, one for its own method and one for HEAD. */
    const api_method method = served->route == API_NO_ROUTE ? method_of(served->method)
                              : served->method[0] == 'H'    ? API_METHOD_HEAD
                                                            : API_METHOD_OTHER;
    const size_t at = series_at(metrics, served->route, method, class_of(served->status));
    st_counters_add_pair(counters, at + st_bucket_of(st_scale_micros, served->micros),
                         at + ST_BUCKETS, served->micros);
    st_counters_add_pair(counters, API_COUNT_ENDED, API_COUNT_BYTES_OUT, served->bytes_out);
    if (served->bytes_in > 0) {
        st_counters_add(counters, API_COUNT_BYTES_IN, served->bytes_in);
    }
    if (served->code != HE_OK) {
        st_counters_add(counters, PROBLEMS + (size_t)served->code, 1);
    }
}

void api_requests_counted(const api_metrics *metrics, int route, api_method method, api_class of,
                          st_distribution *out)
{
    const size_t at = series_at(metrics, route, method, of);
    for (size_t i = 0; i < ST_BUCKETS; i++) {
        out->buckets[i] = st_counters_sum(metrics->counters, at + i);
    }
    out->sum = st_counters_sum(metrics->counters, at + ST_BUCKETS);
}

uint64_t api_problems_counted(const api_metrics *metrics, int code)
{
    return st_counters_sum(metrics->counters, PROBLEMS + (size_t)code);
}

static size_t edits_at(size_t number, api_edit_result result)
{
    return EDITS + number * API_EDIT_RESULTS + result;
}

void api_count_edits(api_metrics *metrics, size_t number, api_edit_result result, uint64_t count)
{
    st_counters_add(metrics->counters, edits_at(number, result), count);
}

uint64_t api_edits_counted(const api_metrics *metrics, size_t number, api_edit_result result)
{
    return st_counters_sum(metrics->counters, edits_at(number, result));
}

void api_count(api_metrics *metrics, api_counter which)
{
    st_counters_add(metrics->counters, which, 1);
}

uint64_t api_counted(const api_metrics *metrics, api_counter which)
{
    return st_counters_sum(metrics->counters, which);
}

void api_set_connection_limit(api_metrics *metrics, uint64_t limit)
{
    atomic_store_explicit(&metrics->connection_limit, limit, memory_order_relaxed);
}

uint64_t api_connection_limit(const api_metrics *metrics)
{
    return atomic_load_explicit(&metrics->connection_limit, memory_order_relaxed);
}
