#include "server/boot/daemon.h"

#include "server/boot/parts.h"
#include "server/boot/present.h"
#include "server/boot/reload.h"
#include "server/boot/resources.h"
#include "server/boot/signals.h"
#include "server/boot/start.h"
#include "server/boot/watch.h"
#include "server/net/notify.h"
#include "system/memory.h"

#include <time.h>
#include <unistd.h>

/* How long a stop waits for requests and jobs that still run. A stop may last five seconds in
 * all. */
enum { STOP_MILLIS = 4000 };

/* Does the periodic work of the main thread, which serves no requests, until SIGTERM or SIGINT
 * arrives; SIGHUP reloads the configuration. */
static void wait_for_stop(srv_parts *parts, const sigset_t *signals, siginfo_t *reason)
{
    const struct timespec second = {.tv_sec = 1};
    srv_watch watch = {.health.status = ST_OK};
    char message[320];
    int number;
    do {
        srv_watch_look(&watch, parts);
        number = sigtimedwait(signals, reason, &second);
        if (number == SIGHUP) {
            srv_log_tell(parts->log, SRV_LEVEL_DEBUG, "SIGHUP from process %ld",
                         (long)reason->si_pid);
            (void)srv_reload(parts, message, sizeof message);
        }
    } while (number != SIGTERM && number != SIGINT);
    /* This last check reports a failure of the disk that occurred since the check before, up to a
     * second ago. */
    srv_watch_look(&watch, parts);
}

static void tell_stop(srv_log *log, const char *reason)
{
    srv_line line;
    srv_log_begin(log, &line, SRV_LEVEL_INFO, "hedged stops");
    srv_line_text(&line, "reason", reason);
    srv_log_end(log, &line);
}

/* Stops all parts of the daemon. Returns false if some work did not end in time: then the caller
 * must free nothing, because that work may still use it. */
static bool stop(srv_parts *parts, const siginfo_t *reason)
{
    char text[64];
    snprintf(text, sizeof text, "%s from process %ld",
             reason->si_signo == SIGINT ? "SIGINT" : "SIGTERM", (long)reason->si_pid);
    tell_stop(parts->log, text);
    srv_notify("STOPPING=1\nSTATUS=stopping");
    atomic_store(&parts->ready, false);
    api_job_table_stop(parts->job_table);
    bool ended = srv_http_stop(parts->http, STOP_MILLIS);
    srv_unix_remove(&parts->socket);
    if (ended) {
        return true;
    }
    srv_log_tell(parts->log, SRV_LEVEL_ERROR,
                 "requests and jobs that did not end within %d s of the stop were abandoned%s",
                 STOP_MILLIS / 1000,
                 srv_config_folder(parts->config) == NULL
                     ? ""
                     : "; every change that was answered is on the disk");
    return false;
}

static void close_parts(srv_parts *parts)
{
    srv_present_close(parts);
    st_pool_free(parts->pool);
    st_pool_free(parts->makers);
    st_parallel_free(parts->parallel);
    api_job_table_free(parts->job_table);
    api_service_free(parts->service);
    st_store_free(parts->store);
    srv_assets_free(parts->assets);
    api_tokens_free(parts->tokens);
    srv_certificates_free(parts->certificates);
}

int srv_daemon_run(const srv_started *started)
{
    const srv_log_settings settings = srv_start_log_settings(started->config);
    srv_parts parts = {
        .started = started, .config = started->config, .reload_lock = PTHREAD_MUTEX_INITIALIZER};
    sigset_t signals;
    srv_signals_begin(&signals);
    const st_memory_limit limit = srv_choose_budget(started->config);
    parts.log = srv_log_new(STDERR_FILENO, srv_log_capacity(st_memory_budget()), &settings);
    if (parts.log == NULL) {
        srv_line_write(STDERR_FILENO, settings.json, SRV_LEVEL_ERROR,
                       "there is not enough memory, or there are not enough threads, to start");
        return 1;
    }
    srv_start_tell(parts.log, started->config, started->environment);
    srv_tell_budget(parts.log, started->config, &limit);

    bool open = srv_open_tokens(&parts) && srv_open_certificates(&parts) &&
                srv_open_store(&parts) && srv_open_service(&parts) && srv_present_open(&parts) &&
                srv_open_http(&parts);
    if (open) {
        siginfo_t reason;
        srv_watch_announce(&parts);
        wait_for_stop(&parts, &signals, &reason);
        if (!stop(&parts, &reason)) {
            /* Threads of the abandoned work still use the daemon's memory, so nothing is freed. The
             * journal is left as it would be after a kill, which it is designed to survive. */
            srv_log_free(parts.log);
            _exit(1);
        }
    } else {
        tell_stop(parts.log, "the daemon could not start");
    }
    close_parts(&parts);
    srv_log_tell(parts.log, SRV_LEVEL_INFO, "hedged has stopped");
    srv_log_free(parts.log);
    return open ? 0 : 1;
}
