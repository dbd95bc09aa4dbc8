#include "server/boot/daemon.h"

#include "server/boot/parts.h"
#include "server/boot/reload.h"
#include "server/boot/resources.h"
#include "server/boot/signals.h"
#include "server/boot/watch.h"
#include "server/net/notify.h"

#include <time.h>
#include <unistd.h>

enum { STOP_MILLIS = 4000 /* of the five seconds a stop may take */ };

/* The main thread serves nobody, and keeps house until it is told to stop. */
static void wait_for_stop(srv_parts *parts, const sigset_t *signals)
{
    const struct timespec second = {.tv_sec = 1};
    srv_watch watch = {.health.status = ST_OK};
    int number;
    do {
        srv_watch_look(&watch, parts);
        number = sigtimedwait(signals, NULL, &second);
        if (number == SIGHUP) {
            srv_reload_told(parts);
        }
    } while (number != SIGTERM && number != SIGINT);
    srv_watch_look(&watch, parts); /* a disk that failed in the last second is told too */
}

static void close_parts(srv_parts *parts)
{
    st_pool_free(parts->pool);
    st_pool_free(parts->makers);
    st_parallel_free(parts->parallel);
    api_job_table_free(parts->job_table);
    api_service_free(parts->service);
    st_store_free(parts->store);
    srv_assets_free(parts->assets);
    srv_access_log_free(parts->log);
    api_tokens_free(parts->tokens);
}

int srv_daemon_run(const srv_config *config)
{
    srv_parts parts = {.config = config};
    sigset_t signals;
    srv_signals_begin(&signals);
    srv_choose_budget(config);

    bool started = srv_open_tokens(&parts) && srv_open_store(&parts) && srv_open_service(&parts) &&
                   srv_open_http(&parts);
    if (started) {
        srv_notify("READY=1");
        wait_for_stop(&parts, &signals);
        srv_notify("STOPPING=1");
        atomic_store(&parts.ready, false);
        api_job_table_stop(parts.job_table);
        if (!srv_http_stop(parts.http, STOP_MILLIS)) {
            /* It is in the middle of its work, on memory that must stay. The journal is left as by
             * a kill, which it is made for. */
            fprintf(stderr, "hedged: work that did not end within %d s was given up%s\n",
                    STOP_MILLIS / 1000,
                    srv_config_folder(config) == NULL
                        ? ""
                        : "; every change that was answered is on the disk");
            srv_access_log_free(parts.log);
            _exit(1);
        }
    }
    close_parts(&parts);
    return started ? 0 : 1;
}
