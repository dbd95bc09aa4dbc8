/* GET /metrics of a real daemon: each event must be counted under its name, promtool must find no
 * fault in the page, and the alerting rules may name only metrics that exist. */
#include "api/metric/metric_page.h"
#include "tests/e2e/client.h"
#include "tests/e2e/listener.h"
#include "tests/store_folder.h"

#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

static char folder[FOLDER_PATH];

static reply read_page(client *c)
{
    return reply_expect(200, client_get(c, "/metrics"));
}

/* Returns the value of a sample on the page of metrics, 0 if the page does not have it. */
static double value_of(const reply *page, const char *sample)
{
    const size_t length = strlen(sample);
    const char *at = page->body;
    while ((at = strstr(at, sample)) != NULL) {
        if ((at == page->body || at[-1] == '\n') && at[length] == ' ') {
            return strtod(at + length, NULL);
        }
        at++;
    }
    return 0;
}

/* Sends requests that change the value of each metric in the list `moved`. */
static void let_things_happen(client *c)
{
    const char *const async[] = {"Prefer: respond-async", NULL};
    reply_done(reply_expect(
        201, client_post(c, "/v1/meshes?id=m", "{\"shape\":\"icosphere\",\"subdivisions\":2}")));
    reply_done(reply_expect(
        200, client_post(c, "/v1/meshes/m/edits", "{\"op\":\"edge_split\",\"edge\":2}")));
    reply_done(
        reply_expect(200, client_post(c, "/v1/meshes/m/edits",
                                      "{\"dry_run\":true,\"op\":\"edge_flip\",\"edge\":5}")));
    reply_done(reply_expect(
        422, client_post(c, "/v1/meshes/m/edits", "{\"op\":\"edge_split\",\"edge\":999999}")));
    reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/undo", "{}")));
    reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/redo", "{}")));
    reply_done(reply_expect(409, client_post(c, "/v1/meshes/m/redo", "{}")));
    reply_done(reply_expect(
        200, client_send(c, "PUT", "/v1/meshes/m/presence", NULL, "{\"client\":\"a\"}")));
    reply_done(reply_expect(404, client_get(c, "/v1/meshes/none")));
    reply_done(reply_expect(404, client_get(c, "/nowhere/at/all")));
    reply_done(reply_expect(405, client_send(c, "BREW", "/v1/meshes", NULL, NULL)));
    reply job = reply_expect(202, client_send(c, "GET", "/v1/meshes/m/content", async, NULL));
    char target[100], stream[120];
    reply_header(&job, "Location", target, sizeof target);
    snprintf(stream, sizeof stream, "%s/events", target);
    reply_done(job);
    /* The event stream of a job ends with the job, so reading it waits for the job. */
    reply_done(reply_expect(200, client_get(c, stream)));
}

static const char *const moved[] = {
    "hedge_http_requests_total{method=\"POST\",route=\"/v1/meshes\",status=\"2xx\"}",
    "hedge_http_requests_total{method=\"POST\",route=\"/v1/meshes/{mesh}/edits\",status=\"4xx\"}",
    "hedge_http_requests_total{method=\"GET\",route=\"other\",status=\"4xx\"}",
    "hedge_http_requests_total{method=\"other\",route=\"other\",status=\"4xx\"}",
    "hedge_http_request_duration_seconds_count{method=\"GET\",route=\"/metrics\",status=\"2xx\"}",
    "hedge_http_request_duration_seconds_sum{method=\"POST\",route=\"/v1/meshes\",status=\"2xx\"}",
    "hedge_http_requests_in_flight",
    "hedge_http_request_bytes_total",
    "hedge_http_response_bytes_total",
    "hedge_problems_total{code=\"no_such_route\"}",
    "hedge_problems_total{code=\"nothing_to_redo\"}",
    "hedge_connections",
    "hedge_connections_opened_total",
    "hedge_edits_total{operation=\"edge_split\",result=\"applied\"}",
    "hedge_edits_total{operation=\"edge_split\",result=\"refused\"}",
    "hedge_edits_total{operation=\"edge_flip\",result=\"rehearsed\"}",
    "hedge_edits_total{operation=\"undo\",result=\"applied\"}",
    "hedge_edits_total{operation=\"redo\",result=\"applied\"}",
    "hedge_edits_total{operation=\"redo\",result=\"refused\"}",
    "hedge_revisions_total",
    "hedge_meshes",
    "hedge_meshes_in_memory",
    "hedge_elements{kind=\"vertex\"}",
    "hedge_elements{kind=\"edge\"}",
    "hedge_elements{kind=\"face\"}",
    "hedge_mesh_loads_total{result=\"absent\"}",
    "hedge_memory_bytes{holder=\"content\"}",
    "hedge_memory_bytes{holder=\"history\"}",
    "hedge_event_streams{about=\"mesh\"}",
    "hedge_clients_present",
    "hedge_events_total",
    "hedge_event_lag_seconds_count",
    "hedge_jobs{state=\"done\"}",
    "hedge_jobs_ended_total{state=\"done\"}",
    "hedge_job_wait_seconds_count",
    "hedge_job_duration_seconds_count",
    "hedge_store_commit_duration_seconds_count",
    "hedge_store_sync_duration_seconds_count",
    "hedge_store_commit_records_sum",
    "hedge_store_wal_bytes",
    "process_cpu_seconds_total",
    "process_open_fds",
};

static void what_happens_is_counted(void **state)
{
    (void)state;
    char store[FOLDER_PATH + 20];
    snprintf(store, sizeof store, "sqlite:%s/data", folder);
    daemon_process *d = daemon_start(ARGUMENTS("--store", store));
    client *c = client_new(d);
    reply before = read_page(c);
    let_things_happen(c);
    /* Once a second the daemon opens a file of /proc to read its use of memory. The page `before`
     * or the page `after` may count that as an open file, so a single event stream would not always
     * raise the number of open files; two do. */
    listener *streams[2];
    for (size_t i = 0; i < 2; i++) {
        streams[i] = listener_open(d, "/v1/meshes/m/events", NULL, 0);
    }
    /* A stream may still read what happened while it was opened from the log, which has no lag.
     * When it has told the first edit, it waits for the second one. */
    for (int edit = 0; edit < 2; edit++) {
        reply_done(reply_expect(
            200, client_post(c, "/v1/meshes/m/edits", "{\"op\":\"edge_split\",\"edge\":7}")));
        for (size_t i = 0; i < 2; i++) {
            listener_next(streams[i], true);
        }
    }
    reply after = read_page(c);
    for (size_t i = 0; i < sizeof moved / sizeof *moved; i++) {
        double from = value_of(&before, moved[i]), to = value_of(&after, moved[i]);
        if (to <= from) {
            fail_msg("%s was %g and is %g", moved[i], from, to);
        }
    }
    assert_true(value_of(&after, "hedge_mesh_loads_total{result=\"loaded\"}") == 0);
    for (size_t i = 0; i < 2; i++) {
        listener_close(streams[i]);
    }
    reply_done(before);
    reply_done(after);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);

    /* After the restart the mesh is only on the disk; the first request for the mesh loads it. */
    d = daemon_start(ARGUMENTS("--store", store));
    c = client_new(d);
    reply_done(reply_expect(200, client_get(c, "/v1/meshes/m")));
    after = read_page(c);
    assert_true(value_of(&after, "hedge_mesh_loads_total{result=\"loaded\"}") == 1);
    assert_true(value_of(&after, "hedge_mesh_load_duration_seconds_count") == 1);
    assert_true(value_of(&after, "hedge_store_state{state=\"writable\"}") == 1);
    reply_done(after);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* --- metrics of refusals, and of settings --- */

static const char *const refused[] = {
    "hedge_connections_refused_total{reason=\"limit\"}",
    "hedge_connections_timed_out_total{stage=\"head\"}",
    "hedge_limited_total{client=\"address\",limit=\"requests\"}",
};

/* Metrics with constant values, and the option that sets each value. */
static const struct {
    const char *sample, *option, *value;
    double expected;
} settled[] = {
    {"hedge_connections_limit", "--max-connections", "3", 3},
    {"hedge_meshes_limit", "--max-meshes", "77", 77},
    {"hedge_memory_budget_bytes", "--memory-budget", "256M", 256 << 20},
    {"hedge_event_streams_limit{about=\"mesh\"}", "--max-listeners", "5", 5},
};

enum { SETTLED = sizeof settled / sizeof *settled };

/* Opens three connections, of which the first never completes its request, and a fourth one, which
 * is refused. */
static void exceed_connections(const daemon_process *d)
{
    static const char head[] = "GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\n";
    char byte;
    int fds[2];
    for (int i = 0; i < 2; i++) {
        fds[i] = client_connect(d, 0);
        assert_true(write(fds[i], head, i == 0 ? 10 : sizeof head - 1) > 0);
    }
    assert_int_equal(read(fds[1], &byte, 1), 1);
    char *answer = client_raw(d, head, sizeof head - 1, 1, false);
    assert_int_equal(client_raw_status(answer), 503);
    free(answer);
    close(fds[1]);
    /* waits until the daemon closes the first connection because of its incomplete request */
    while (read(fds[0], &byte, 1) > 0) {
    }
    close(fds[0]);
}

static void what_is_refused_and_what_is_set_is_on_the_page(void **state)
{
    (void)state;
    const char *arguments[2 * SETTLED + 5] = {"--header-timeout", "1", "--address-requests", "1"};
    size_t count = 4;
    for (size_t i = 0; i < SETTLED; i++) {
        arguments[count++] = settled[i].option;
        arguments[count++] = settled[i].value;
    }
    daemon_process *d = daemon_start(arguments);
    client *c = client_new(d);
    reply page = read_page(c);
    assert_non_null(strstr(page.body, "\nhedge_build_info{version=\""));
    for (size_t i = 0; i < SETTLED; i++) {
        if (value_of(&page, settled[i].sample) != settled[i].expected) {
            fail_msg("%s is %g", settled[i].sample, value_of(&page, settled[i].sample));
        }
    }
    reply_done(page);
    long status = 200;
    while (status == 200) {
        reply r = client_get(c, "/v1/meshes");
        status = r.status;
        reply_free(&r);
    }
    assert_int_equal(status, 429);
    exceed_connections(d);
    reply r = client_get(c, "/metrics");
    while (r.status == 503) { /* waits until the connections of exceed_connections() are closed */
        reply_free(&r);
        r = client_get(c, "/metrics");
    }
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        if (value_of(&r, refused[i]) < 1) {
            fail_msg("%s is %g", refused[i], value_of(&r, refused[i]));
        }
    }
    reply_free(&r);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* Creates more meshes than the memory budget holds, so that some are evicted from memory. */
static void meshes_that_leave_memory_are_counted(void **state)
{
    (void)state;
    static const char grid[] = "{\"shape\":\"grid\",\"columns\":100,\"rows\":100}";
    char store[FOLDER_PATH + 20], path[40];
    snprintf(store, sizeof store, "sqlite:%s/many", folder);
    daemon_process *d = daemon_start(ARGUMENTS("--store", store, "--memory-budget", "40M"));
    client *c = client_new(d);
    double left = 0;
    for (int i = 0; i < 60 && left == 0; i++) {
        snprintf(path, sizeof path, "/v1/meshes?id=m%d", i);
        reply_done(reply_expect(201, client_post(c, path, grid)));
        reply page = read_page(c);
        left = value_of(&page, "hedge_mesh_evictions_total");
        reply_done(page);
    }
    assert_true(left > 0);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* --- every metric of the table --- */

/* Metrics whose changes other programs test, since they need a disk that fails, threads that stop
 * or a listener that does not read. */
static const struct {
    const char *metric, *file;
} elsewhere[] = {
    {"hedge_tls_handshakes_total", "tests/e2e/test_tls.c"},
    {"hedge_memory_full", "tests/e2e/test_memory.c"},
    {"hedge_event_streams_behind_total", "tests/api/test_events.c"},
    {"hedge_store_state", "tests/api/test_disk.c"},
    {"hedge_store_disk_full_total", "tests/api/test_disk.c"},
    {"hedge_store_checkpoint_duration_seconds", "tests/api/test_disk.c"},
    {"hedge_store_records_pending", "tests/api/test_disk.c"},
    {"hedge_store_records_lost_total", "tests/api/test_disk.c"},
    {"hedge_store_queue_bytes", "tests/api/test_disk.c"},
    {"hedge_store_queue_limit_bytes", "tests/api/test_disk.c"},
    {"hedge_pool_tasks_waiting", "tests/unit/test_srv_pool.c"},
    {"hedge_pool_tasks_waiting_limit", "tests/unit/test_srv_pool.c"},
    {"hedge_pool_tasks_running", "tests/unit/test_srv_pool.c"},
    {"hedge_pool_tasks_refused_total", "tests/unit/test_srv_pool.c"},
};

/* Metrics whose changes no test checks, each with the reason. */
static const struct {
    const char *metric, *reason;
} unmoved[] = {
    {"hedge_log_lines_dropped_total",
     "thousands of lines are dropped only while standard error is blocked, which in a daemon no "
     "test can time; test_srv_log compares the number that the page shows with what was dropped"},
    {"hedge_build_info", "it is always 1"},
    {"process_resident_memory_bytes", "the kernel's number; test_srv_counters reads it"},
    {"process_virtual_memory_bytes", "the kernel's number; test_srv_counters reads it"},
    {"process_max_fds", "the limit of the process; test_srv_counters reads it"},
    {"process_start_time_seconds", "it never changes; test_srv_counters reads it"},
};

/* Returns whether the sample belongs to the metric: it has the metric's name, perhaps a suffix of
 * histograms, and perhaps labels. */
static bool is_sample_of(const char *sample, const char *metric)
{
    static const char *const suffixes[] = {"", "_sum", "_count"};
    const size_t length = strlen(metric), named = strcspn(sample, "{");
    bool found = false;
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes && !found; i++) {
        const size_t more = strlen(suffixes[i]);
        found = named == length + more && strncmp(sample, metric, length) == 0 &&
                strncmp(sample + length, suffixes[i], more) == 0;
    }
    return found;
}

static int count_in(const char *const *samples, size_t count, const char *metric)
{
    int found = 0;
    for (size_t i = 0; i < count; i++) {
        found += is_sample_of(samples[i], metric);
    }
    return found;
}

/* Returns whether the source file names the metric, and not only a longer name that begins with
 * it. */
static bool names(const char *path, const char *metric)
{
    static char text[1 << 18];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    const size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[length] = '\0';
    bool found = false;
    for (const char *at = text; !found && (at = strstr(at, metric)) != NULL; at++) {
        char name[120];
        snprintf(name, sizeof name, "%.*s", (int)strspn(at, "abcdefghijklmnopqrstuvwxyz_"), at);
        found = is_sample_of(name, metric);
    }
    return found;
}

static void every_metric_is_moved_by_a_test_or_has_its_reason(void **state)
{
    (void)state;
    static const char *const evicted[] = {"hedge_mesh_evictions_total",
                                          "hedge_mesh_load_duration_seconds_count"};
    size_t listed = 0; /* number of rows of the two lists above that name a metric */
    for (api_metric_id id = 0; id < API_METRIC_COUNT; id++) {
        const char *metric = api_metric_at(id)->name;
        int found = count_in(moved, sizeof moved / sizeof *moved, metric) > 0;
        found += count_in(refused, sizeof refused / sizeof *refused, metric) > 0;
        found += count_in(evicted, sizeof evicted / sizeof *evicted, metric) > 0;
        for (size_t i = 0; i < SETTLED; i++) {
            found += is_sample_of(settled[i].sample, metric);
        }
        for (size_t i = 0; i < sizeof elsewhere / sizeof *elsewhere; i++) {
            if (strcmp(elsewhere[i].metric, metric) == 0) {
                found++;
                listed++;
                if (!names(elsewhere[i].file, metric)) {
                    fail_msg("%s does not name %s", elsewhere[i].file, metric);
                }
            }
        }
        for (size_t i = 0; i < sizeof unmoved / sizeof *unmoved; i++) {
            found += strcmp(unmoved[i].metric, metric) == 0;
            listed += strcmp(unmoved[i].metric, metric) == 0;
        }
        if (found != 1) {
            fail_msg("%s is moved by %d of these tests, or has no reason not to be", metric, found);
        }
    }
    assert_int_equal(listed,
                     sizeof elsewhere / sizeof *elsewhere + sizeof unmoved / sizeof *unmoved);
}

/* --- promtool --- */

static int run(const char *command)
{
    int status = system(command); /* NOLINT(cert-env33-c): this file builds the command */
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void the_page_has_every_metric_and_promtool_finds_no_fault(void **state)
{
    (void)state;
    char command[FOLDER_PATH + 60], path[FOLDER_PATH + 10];
    daemon_process *d = daemon_start(NULL);
    client *c = client_new(d);
    reply_done(reply_expect(404, client_get(c, "/nowhere")));
    reply page = read_page(c);
    char type[80];
    assert_string_equal(reply_header(&page, "Content-Type", type, sizeof type),
                        "text/plain; version=0.0.4; charset=utf-8");
    for (api_metric_id id = 0; id < API_METRIC_COUNT; id++) {
        char line[120];
        snprintf(line, sizeof line, "\n# TYPE %s ", api_metric_at(id)->name);
        if (strstr(page.body, line) == NULL) {
            fail_msg("the page lacks %s", api_metric_at(id)->name);
        }
    }
    snprintf(path, sizeof path, "%s/page", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_int_equal(fwrite(page.body, 1, page.length, file), page.length);
    assert_int_equal(fclose(file), 0);
    snprintf(command, sizeof command, "promtool check metrics <%s", path);
    assert_int_equal(run(command), 0);
    remove(path);
    reply_done(page);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static bool is_metric(const char *name, size_t length)
{
    static const char *const suffixes[] = {"", "_bucket", "_sum", "_count"};
    for (api_metric_id id = 0; id < API_METRIC_COUNT; id++) {
        const api_metric *metric = api_metric_at(id);
        const size_t most = metric->type == API_METRIC_HISTOGRAM ? 4 : 1;
        for (size_t i = 0; i < most; i++) {
            char full[120];
            snprintf(full, sizeof full, "%s%s", metric->name, suffixes[i]);
            if (strlen(full) == length && memcmp(full, name, length) == 0) {
                return true;
            }
        }
    }
    return false;
}

static void the_rules_for_alerts_are_good_and_name_metrics_that_there_are(void **state)
{
    (void)state;
    static char text[32768];
    FILE *file = fopen("server/alerts.yaml", "r");
    assert_non_null(file);
    size_t length = fread(text, 1, sizeof text - 1, file), names = 0;
    fclose(file);
    text[length] = '\0';
    for (const char *at = text; *at != '\0'; at++) {
        bool begins = (strncmp(at, "hedge_", 6) == 0 || strncmp(at, "process_", 8) == 0) &&
                      (at == text || (!isalnum((unsigned char)at[-1]) && at[-1] != '_'));
        if (begins) {
            size_t size = strspn(at, "abcdefghijklmnopqrstuvwxyz_");
            if (!is_metric(at, size)) {
                fail_msg("no metric has the name %.*s", (int)size, at);
            }
            names++;
        }
    }
    assert_true(names > 10);
    assert_int_equal(run("promtool check rules server/alerts.yaml"), 0);
    assert_int_equal(run("promtool test rules tests/alerts.yaml"), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_happens_is_counted),
        cmocka_unit_test(what_is_refused_and_what_is_set_is_on_the_page),
        cmocka_unit_test(meshes_that_leave_memory_are_counted),
        cmocka_unit_test(every_metric_is_moved_by_a_test_or_has_its_reason),
        cmocka_unit_test(the_page_has_every_metric_and_promtool_finds_no_fault),
        cmocka_unit_test(the_rules_for_alerts_are_good_and_name_metrics_that_there_are),
    };
    folder_make(folder);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    folder_remove(folder);
    return failed;
}
