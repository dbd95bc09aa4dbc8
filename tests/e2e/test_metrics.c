/* GET /metrics of a real daemon: each event is counted under its name, promtool finds no fault in
 * the page, and the alerting rules name only metrics that exist. */
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

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

static char folder[FOLDER_PATH];

static reply read_page(client *c)
{
    return reply_expect(200, client_get(c, "/metrics"));
}

/* Returns the value of a sample, 0 if the page has none. */
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

/* Sends requests that cause everything that the rows of `moved` count. */
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
    reply_done(reply_expect(404, client_get(c, "/v1/meshes/none")));
    reply_done(reply_expect(404, client_get(c, "/nowhere/at/all")));
    reply_done(reply_expect(405, client_send(c, "BREW", "/v1/meshes", NULL, 0, NULL)));
    reply job = reply_expect(202, client_send(c, "GET", "/v1/meshes/m/content", NULL, 0, async));
    char target[100], stream[120];
    reply_header(&job, "Location", target, sizeof target);
    snprintf(stream, sizeof stream, "%s/events", target);
    reply_done(job);
    /* The event stream of a job ends when the job has ended, so this waits for the job. */
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
    listener *l = listener_open(d, "/v1/meshes/m/events", NULL, 0);
    reply_done(reply_expect(
        200, client_post(c, "/v1/meshes/m/edits", "{\"op\":\"edge_split\",\"edge\":7}")));
    listener_next(l, true);
    reply after = read_page(c);
    for (size_t i = 0; i < sizeof moved / sizeof *moved; i++) {
        double from = value_of(&before, moved[i]), to = value_of(&after, moved[i]);
        if (to <= from) {
            fail_msg("%s was %g and is %g", moved[i], from, to);
        }
    }
    assert_true(value_of(&after, "hedge_mesh_loads_total{result=\"loaded\"}") == 0);
    listener_close(l);
    reply_done(before);
    reply_done(after);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);

    /* After the restart the mesh is only on the disk, and the first request for it loads it. */
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
        cmocka_unit_test(the_page_has_every_metric_and_promtool_finds_no_fault),
        cmocka_unit_test(the_rules_for_alerts_are_good_and_name_metrics_that_there_are),
    };
    folder_make(folder);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    folder_remove(folder);
    return failed;
}
