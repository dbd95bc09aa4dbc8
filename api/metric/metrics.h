/* metrics.h - counters of requests and connections for GET /metrics.
 *
 * Counting takes no lock and allocates nothing; any thread may do it. The store, the thread pools
 * and the table of jobs count themselves (st_store_measure, st_pool_look, api_job_measure); the
 * page of metrics also reads these counters. */
#ifndef HE_API_METRIC_METRICS_H
#define HE_API_METRIC_METRICS_H

#include "api/metric/metric_rows.h"
#include "op/op.h"
#include "system/histogram.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct api_metrics api_metrics;

/* Makes counters for a table of `routes` routes, all zero. Returns NULL when memory is out. */
api_metrics *api_metrics_new(size_t routes);
void api_metrics_free(api_metrics *metrics); /* takes NULL */

/* --- counting requests --- */

typedef enum api_method {
    API_METHOD_GET,
    API_METHOD_HEAD,
    API_METHOD_POST,
    API_METHOD_PUT,
    API_METHOD_PATCH,
    API_METHOD_DELETE,
    API_METHOD_OPTIONS,
    API_METHOD_OTHER,
    API_METHODS
} api_method;

const char *api_method_name(api_method method); /* returns "other" for API_METHOD_OTHER */

/* The classes of HTTP statuses. 1xx is missing, because such answers are not final. */
typedef enum api_class {
    API_CLASS_NONE, /* there was no answer */
    API_CLASS_2XX,
    API_CLASS_3XX,
    API_CLASS_4XX,
    API_CLASS_5XX,
    API_CLASSES
} api_class;

const char *api_class_name(api_class of);

/* The index that stands for requests that match no route. Requests are counted in series: each
 * route has one series for its own method and one for HEAD, and requests that match no route have
 * one series for each method. */
enum { API_NO_ROUTE = -1 };

/* A request that ended. */
typedef struct api_served {
    int route; /* index of the request's route in the table of routes, or API_NO_ROUTE */
    const char *method;
    int status; /* HTTP status; 0: there was no answer */
    int code;   /* the problem's code, an api_code or he_status; HE_OK: no problem */
    uint64_t bytes_in, bytes_out, micros;
} api_served;

void api_count_request(api_metrics *metrics, const api_served *served);

/* Gets the durations of those requests of one series that were answered with a status of one class.
 * The series is that of `route` and HEAD if `method` is API_METHOD_HEAD, else of `route` and its
 * own method; or, if `route` is API_NO_ROUTE, of the requests with this method that matched no
 * route. */
void api_requests_counted(const api_metrics *metrics, int route, api_method method, api_class of,
                          st_distribution *out);
/* Returns the number of requests that were refused with this code. */
uint64_t api_problems_counted(const api_metrics *metrics, int code);

/* --- counting edits --- */

typedef enum api_edit_result {
    API_EDIT_APPLIED,
    API_EDIT_REHEARSED,
    API_EDIT_REFUSED,
    API_EDIT_RESULTS
} api_edit_result;

/* Edits are counted by the number of their operation (he_op_number). Undo and redo have the numbers
 * after the highest possible number of an operation. */
enum { API_MOST_OPERATIONS = 64, API_UNDO = API_MOST_OPERATIONS, API_REDO, API_OPERATIONS };

/* Counts `count` operations that have this number and result. */
void api_count_edits(api_metrics *metrics, size_t number, api_edit_result result, uint64_t count);
uint64_t api_edits_counted(const api_metrics *metrics, size_t number, api_edit_result result);

/* --- counters that have neither a route nor an operation --- */

typedef enum api_counter {
    API_COUNT_BEGUN, /* requests that have begun */
    API_COUNT_ENDED,
    API_COUNT_BYTES_IN,
    API_COUNT_BYTES_OUT,
    API_COUNT_OPENED, /* connections that were opened */
    API_COUNT_CLOSED,
    /* Connections that were refused; three counters, one for each reason. */
    API_COUNT_REFUSED_LIMIT,
    API_COUNT_REFUSED_MEMORY,
    API_COUNT_REFUSED_STOPPING,
    /* Connections that were closed because the client was too slow, one counter for each stage:
     * before a request, in its headers, in its body, in the answer. */
    API_COUNT_LATE_IDLE,
    API_COUNT_LATE_HEAD,
    API_COUNT_LATE_BODY,
    API_COUNT_LATE_ANSWER,
    API_COUNT_HANDSHAKES, /* TLS handshakes that succeeded */
    API_COUNT_HANDSHAKES_FAILED,
    API_COUNTERS
} api_counter;

void api_count(api_metrics *metrics, api_counter which);
uint64_t api_counted(const api_metrics *metrics, api_counter which);

/* Sets the maximum number of connections, which is 0 until the server calls this. */
void api_set_connection_limit(api_metrics *metrics, uint64_t limit);
uint64_t api_connection_limit(const api_metrics *metrics);

#endif
