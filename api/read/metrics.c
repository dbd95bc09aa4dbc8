/* metrics.c - GET /metrics: writes each metric of metric_rows.h from counters and from the present
 * state of the server.
 *
 * A worker thread can answer this request, because locks are held only for moments. */
#include "api/metric/metric_page.h"

#include "api/json/problem.h"
#include "api/request/handlers.h"
#include "system/memory.h"
#include "system/process.h"

/* Measurements that are taken once for each page of metrics. */
typedef struct sources {
    const api_service *service;
    const api_metrics *metrics;
    st_store_measures store;
    st_health health;
    api_job_measures jobs;
    st_process process;
    api_metric_page page;
} sources;

enum { MICROS = 1000000, SINGLE = 1 };

static void read_sources(const api_exchange *x, sources *s)
{
    const api_service *service = x->service;
    s->service = service;
    s->metrics = service->metrics;
    st_store_measure(service->store, &s->store);
    st_store_health(service->store, &s->health);
    s->jobs = (api_job_measures){.bytes = 0};
    if (service->options.jobs != NULL) {
        api_job_measure(service->options.jobs, &s->jobs);
    }
    st_process_read(&s->process);
}

/* --- writing samples --- */

static void put(sources *s, double number)
{
    api_metric_put(&s->page, NULL, number);
}

static void put_count(sources *s, uint64_t count)
{
    put(s, (double)count);
}

static void put_of(sources *s, const char *label, double number)
{
    api_metric_put(&s->page, &label, number);
}

static void put_times(sources *s, const st_distribution *times)
{
    api_metric_put_histogram(&s->page, NULL, times, st_scale_micros, MICROS);
}

/* --- metrics of requests --- */

static uint64_t total_of(const st_distribution *distribution)
{
    uint64_t total = 0;
    for (size_t i = 0; i < ST_BUCKETS; i++) {
        total += distribution->buckets[i];
    }
    return total;
}

/* The requests of one route with one method: their labels on the page, and the arguments of
 * api_requests_counted. */
typedef struct series {
    const char *route_label, *method_label;
    int route; /* index of the route in the table of routes, or API_NO_ROUTE */
    api_method method;
} series;

/* Writes the samples of a series, one for each class of statuses that was counted. Most possible
 * series never get a request, so they are not shown before their first one. */
static void put_series(sources *s, const series *requests, bool times)
{
    for (api_class of = 0; of < API_CLASSES; of++) {
        const char *const labels[] = {requests->method_label, requests->route_label,
                                      api_class_name(of)};
        st_distribution distribution;
        api_requests_counted(s->metrics, requests->route, requests->method, of, &distribution);
        const uint64_t total = total_of(&distribution);
        if (total > 0 && times) {
            api_metric_put_histogram(&s->page, labels, &distribution, st_scale_micros, MICROS);
        } else if (total > 0) {
            api_metric_put(&s->page, labels, (double)total);
        }
    }
}

static void put_requests(sources *s, bool times)
{
    const api_route_table *table = &s->service->table;
    for (size_t i = 0; i < table->count; i++) {
        const api_route *row = &table->rows[i];
        const series own = {row->path, row->method, (int)i, API_METHOD_OTHER};
        const series head = {row->path, api_method_name(API_METHOD_HEAD), (int)i, API_METHOD_HEAD};
        put_series(s, &own, times);
        put_series(s, &head, times);
    }
    for (api_method method = 0; method < API_METHODS; method++) {
        const series other = {"other", api_method_name(method), API_NO_ROUTE, method};
        put_series(s, &other, times);
    }
}

static void put_problems(sources *s)
{
    for (int code = HE_OK + 1; code < API_CODE_COUNT; code++) {
        uint64_t count = api_problems_counted(s->metrics, code);
        if (count > 0) {
            put_of(s, api_code_slug(code), (double)count);
        }
    }
}

/* Returns the counter `begun` minus the counter `ended`. `ended` is read first, so that requests
 * which end between the two reads never make the result negative. */
static uint64_t difference(const api_metrics *metrics, api_counter begun, api_counter ended)
{
    const uint64_t ends = api_counted(metrics, ended), begins = api_counted(metrics, begun);
    return begins > ends ? begins - ends : 0;
}

static void put_counters(sources *s, const api_counter *counters, const char *const *labels)
{
    for (size_t i = 0; labels[i] != NULL; i++) {
        put_of(s, labels[i], (double)api_counted(s->metrics, counters[i]));
    }
}

static void put_limited(sources *s)
{
    for (api_client_kind kind = 0; kind < API_CLIENT_KINDS; kind++) {
        for (api_limit limit = 0; limit < API_LIMIT_COUNT; limit++) {
            const char *const labels[] = {api_client_kind_name(kind), api_limit_name(limit)};
            const uint64_t count = api_limited_get(&s->service->limited, kind, limit);
            api_metric_put(&s->page, labels, (double)count);
        }
    }
}

/* --- metrics of edits --- */

static const char *operation_name(size_t number)
{
    return number == API_UNDO       ? "undo"
           : number == API_REDO     ? "redo"
           : number < he_op_count() ? he_op_at(number)->name
                                    : NULL;
}

static void put_edits(sources *s)
{
    static const char *const results[API_EDIT_RESULTS] = {"applied", "rehearsed", "refused"};
    for (size_t number = 0; number < API_OPERATIONS; number++) {
        const char *name = operation_name(number);
        for (api_edit_result result = 0; name != NULL && result < API_EDIT_RESULTS; result++) {
            uint64_t count = api_edits_counted(s->metrics, number, result);
            if (count > 0) {
                const char *const labels[] = {name, results[result]};
                api_metric_put(&s->page, labels, (double)count);
            }
        }
    }
}

/* --- metrics of the store and of memory --- */

static void put_elements(sources *s)
{
    put_of(s, "vertex", (double)s->store.vertices);
    put_of(s, "edge", (double)s->store.edges);
    put_of(s, "face", (double)s->store.faces);
}

static void put_loads(sources *s)
{
    static const char *const results[ST_LOADED_COUNT] = {"loaded", "absent", "damaged", "failed"};
    for (size_t i = 0; i < ST_LOADED_COUNT; i++) {
        put_of(s, results[i], (double)s->store.loads[i]);
    }
}

static void put_memory(sources *s)
{
    const struct {
        const char *holder;
        uint64_t bytes;
    } holders[] = {{"content", s->store.content_bytes},
                   {"history", s->store.history_bytes},
                   {"snapshots", s->store.snapshot_bytes},
                   {"events", s->store.event_bytes},
                   {"jobs", s->jobs.bytes},
                   {"connections", st_memory_outside()}};
    uint64_t known = 0;
    for (size_t i = 0; i < sizeof holders / sizeof *holders; i++) {
        put_of(s, holders[i].holder, (double)holders[i].bytes);
        known += holders[i].bytes;
    }
    const uint64_t used = st_memory_used();
    put_of(s, "other", used > known ? (double)(used - known) : 0);
}

static void put_store_state(sources *s)
{
    const st_status status = s->health.status;
    put_of(s, "writable", status != ST_FULL && status != ST_FAILED);
    put_of(s, "full", status == ST_FULL);
    put_of(s, "failed", status == ST_FAILED);
}

/* --- metrics of jobs and threads --- */

static void put_jobs(sources *s, bool ended)
{
    static const char *const states[API_JOB_STATES] = {"queued", "running", "done", "failed",
                                                       "cancelled"};
    for (size_t i = ended ? API_JOB_DONE : API_JOB_QUEUED; i < API_JOB_STATES; i++) {
        put_of(s, states[i], ended ? (double)s->jobs.ended[i] : (double)s->jobs.in_state[i]);
    }
}

static double number_of(const st_pool_state *state, api_metric_id id)
{
    return id == API_METRIC_ID_POOL_WAITING   ? (double)state->waiting
           : id == API_METRIC_ID_POOL_LIMIT   ? (double)state->most_waiting
           : id == API_METRIC_ID_POOL_RUNNING ? (double)state->running
                                              : (double)state->refused;
}

static void put_pools(sources *s, api_metric_id id)
{
    static const char *const shares[ST_SHARES] = {"brief", "long", "job"};
    const api_options *options = &s->service->options;
    st_pool_state state;
    for (st_share share = 0; options->pool != NULL && share < ST_SHARES; share++) {
        const char *const labels[] = {"work", shares[share]};
        st_pool_look(options->pool, share, &state);
        api_metric_put(&s->page, labels, number_of(&state, id));
    }
    if (options->makers != NULL) {
        const char *const labels[] = {"answers", shares[ST_SHARE_BRIEF]};
        st_pool_look(options->makers, ST_SHARE_BRIEF, &state);
        api_metric_put(&s->page, labels, number_of(&state, id));
    }
}

/* --- the whole page of metrics --- */

static void put_family(sources *s, api_metric_id id)
{
    static const api_counter refused[] = {API_COUNT_REFUSED_LIMIT, API_COUNT_REFUSED_MEMORY,
                                          API_COUNT_REFUSED_STOPPING};
    static const char *const reasons[] = {"limit", "memory", "stopping", NULL};
    static const api_counter late[] = {API_COUNT_LATE_IDLE, API_COUNT_LATE_HEAD,
                                       API_COUNT_LATE_BODY, API_COUNT_LATE_ANSWER};
    static const char *const stages[] = {"idle", "head", "body", "answer", NULL};
    static const api_counter handshakes[] = {API_COUNT_HANDSHAKES, API_COUNT_HANDSHAKES_FAILED};
    static const char *const results[] = {"completed", "failed", NULL};
    const api_options *options = &s->service->options;
    const st_journal_measures *journal = &s->store.journal;
    switch (id) {
    case API_METRIC_ID_REQUESTS:
        put_requests(s, false);
        break;
    case API_METRIC_ID_REQUEST_TIME:
        put_requests(s, true);
        break;
    case API_METRIC_ID_IN_FLIGHT:
        put_count(s, difference(s->metrics, API_COUNT_BEGUN, API_COUNT_ENDED));
        break;
    case API_METRIC_ID_BYTES_IN:
        put_count(s, api_counted(s->metrics, API_COUNT_BYTES_IN));
        break;
    case API_METRIC_ID_BYTES_OUT:
        put_count(s, api_counted(s->metrics, API_COUNT_BYTES_OUT));
        break;
    case API_METRIC_ID_PROBLEMS:
        put_problems(s);
        break;
    case API_METRIC_ID_CONNECTIONS:
        put_count(s, difference(s->metrics, API_COUNT_OPENED, API_COUNT_CLOSED));
        break;
    case API_METRIC_ID_CONNECTION_LIMIT:
        put_count(s, api_connection_limit(s->metrics));
        break;
    case API_METRIC_ID_CONNECTIONS_OPENED:
        put_count(s, api_counted(s->metrics, API_COUNT_OPENED));
        break;
    case API_METRIC_ID_CONNECTIONS_REFUSED:
        put_counters(s, refused, reasons);
        break;
    case API_METRIC_ID_CONNECTIONS_LATE:
        put_counters(s, late, stages);
        break;
    case API_METRIC_ID_HANDSHAKES:
        put_counters(s, handshakes, results);
        break;
    case API_METRIC_ID_LIMITED:
        put_limited(s);
        break;
    case API_METRIC_ID_EDITS:
        put_edits(s);
        break;
    case API_METRIC_ID_REVISIONS:
        put_count(s, s->store.revisions);
        break;
    case API_METRIC_ID_MESHES:
        put_count(s, s->store.meshes);
        break;
    case API_METRIC_ID_MESH_LIMIT:
        put_count(s, s->store.most_meshes);
        break;
    case API_METRIC_ID_MESHES_LOADED:
        put_count(s, s->store.meshes_in_memory);
        break;
    case API_METRIC_ID_ELEMENTS:
        put_elements(s);
        break;
    case API_METRIC_ID_EVICTIONS:
        put_count(s, s->store.evicted);
        break;
    case API_METRIC_ID_LOADS:
        put_loads(s);
        break;
    case API_METRIC_ID_LOAD_TIME:
        put_times(s, &s->store.load_time);
        break;
    case API_METRIC_ID_MEMORY:
        put_memory(s);
        break;
    case API_METRIC_ID_MEMORY_BUDGET:
        put_count(s, st_memory_budget());
        break;
    case API_METRIC_ID_MEMORY_FULL:
        put(s, options->is_full != NULL && options->is_full(options->ready_context));
        break;
    case API_METRIC_ID_STREAMS:
        put_of(s, "mesh", (double)s->store.listeners);
        put_of(s, "job", (double)s->jobs.listeners);
        break;
    case API_METRIC_ID_STREAM_LIMIT:
        put_of(s, "mesh", (double)s->store.most_listeners);
        put_of(s, "job", (double)s->jobs.most_listeners);
        break;
    case API_METRIC_ID_PRESENT:
        put_count(s, api_presences_count(s->service->presences));
        break;
    case API_METRIC_ID_EVENTS:
        put_count(s, s->store.events);
        break;
    case API_METRIC_ID_EVENT_LAG:
        put_times(s, &s->store.event_lag);
        break;
    case API_METRIC_ID_BEHIND:
        put_count(s, s->store.listeners_behind);
        break;
    case API_METRIC_ID_JOBS:
        put_jobs(s, false);
        break;
    case API_METRIC_ID_JOBS_ENDED:
        put_jobs(s, true);
        break;
    case API_METRIC_ID_JOB_WAIT:
        put_times(s, &s->jobs.waited);
        break;
    case API_METRIC_ID_JOB_TIME:
        put_times(s, &s->jobs.ran);
        break;
    case API_METRIC_ID_STORE_STATE:
        put_store_state(s);
        break;
    case API_METRIC_ID_DISK_FULL:
        put_count(s, s->health.fulls);
        break;
    case API_METRIC_ID_COMMIT_TIME:
        put_times(s, &journal->commits);
        break;
    case API_METRIC_ID_SYNC_TIME:
        put_times(s, &journal->syncs);
        break;
    case API_METRIC_ID_GROUP_SIZE:
        api_metric_put_histogram(&s->page, NULL, &journal->groups, st_scale_counts, SINGLE);
        break;
    case API_METRIC_ID_PENDING:
        put_count(s, journal->behind);
        break;
    case API_METRIC_ID_LOST:
        put_count(s, journal->lost);
        break;
    case API_METRIC_ID_QUEUE:
        put_count(s, journal->queued);
        break;
    case API_METRIC_ID_QUEUE_LIMIT:
        put_count(s, journal->most_queued);
        break;
    case API_METRIC_ID_WAL:
        put_count(s, journal->log);
        break;
    case API_METRIC_ID_CHECKPOINT_TIME:
        put_times(s, &journal->checkpoints);
        break;
    case API_METRIC_ID_POOL_WAITING:
    case API_METRIC_ID_POOL_LIMIT:
    case API_METRIC_ID_POOL_RUNNING:
    case API_METRIC_ID_POOL_REFUSED:
        put_pools(s, id);
        break;
    case API_METRIC_ID_LOG_DROPPED:
        put_count(s, options->log_dropped == NULL ? 0 : options->log_dropped(options->log));
        break;
    case API_METRIC_ID_BUILD_INFO: {
        const char *commit = options->commit == NULL ? "" : options->commit;
        api_metric_put(&s->page, (const char *const[]){options->version, commit}, 1);
        break;
    }
    case API_METRIC_ID_PROCESSOR:
        put(s, s->process.processor);
        break;
    case API_METRIC_ID_RESIDENT:
        put_count(s, s->process.resident);
        break;
    case API_METRIC_ID_VIRTUAL:
        put_count(s, s->process.address_space);
        break;
    case API_METRIC_ID_DESCRIPTORS:
        put_count(s, s->process.descriptors);
        break;
    case API_METRIC_ID_MOST_DESCRIPTORS:
        put_count(s, s->process.most_descriptors);
        break;
    case API_METRIC_ID_STARTED:
        put(s, s->process.started);
        break;
    case API_METRIC_COUNT:
        break;
    }
}

void api_metrics_get(api_exchange *x)
{
    sources s = {.page = {.text = &x->text}};
    read_sources(x, &s);
    for (api_metric_id id = 0; id < API_METRIC_COUNT; id++) {
        api_metric_begin(&s.page, id);
        put_family(&s, id);
    }
    if (x->text.failed) {
        api_fail_memory(x);
        return;
    }
    api_answer_text(x, 200, "text/plain; version=0.0.4; charset=utf-8");
}
