#include "server/boot/resources.h"

#include "system/memory.h"
#include "system/resident.h"

#include <inttypes.h>
#include <limits.h>
#include <sys/resource.h>
#include <unistd.h>

enum {
    /* Number of descriptors that the daemon needs for other things than connections. */
    OWN_FILES = 48,
    DRAIN_FILES = 64
};

size_t srv_cores(void)
{
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online < 1 ? 1 : (size_t)online;
}

/* Raises the limit of open descriptors as far as the system allows, because each connection needs
 * one, and returns the limit. */
static size_t open_files(void)
{
    struct rlimit files;
    if (getrlimit(RLIMIT_NOFILE, &files) != 0) {
        return 1024;
    }
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
    if (getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur > INT_MAX) {
        return INT_MAX;
    }
    return (size_t)files.rlim_cur;
}

/* Chooses how many connections and sockets there may be. There may be a few more sockets than
 * connections, so that connections over the limit can be answered 503. */
void srv_choose_connections(const srv_config *config, srv_http_options *options)
{
    size_t files = open_files();
    size_t own = OWN_FILES + DRAIN_FILES;
    size_t sockets = files > 2 * own ? files - own : files / 2;
    size_t slack = sockets / 16 < 256 ? sockets / 16 : 256;
    size_t most = sockets - slack > 0 ? sockets - slack : 1;
    if (config->max_connections < most) {
        most = (size_t)config->max_connections;
    }
    options->deadlines = (srv_deadline_options){
        .idle = config->idle_timeout,
        .head = config->header_timeout,
        .grace = config->body_grace,
        .total = config->request_timeout,
        .min_rate = config->min_rate,
        .max_connections = most,
    };
    options->max_sockets = most + slack;
    options->workers = config->workers == 0 ? srv_cores() : (size_t)config->workers;
}

st_memory_limit srv_choose_budget(const srv_config *config)
{
    const st_memory_limit limit = st_memory_limit_find("", st_memory_limit_machine());
    const uint64_t chosen = limit.bytes == UINT64_MAX ? 0 : limit.bytes / 4 * 3;
    st_memory_set_budget(config->memory_budget == 0 ? chosen : config->memory_budget);
    st_resident_watch();
    return limit;
}

void srv_tell_budget(srv_log *log, const srv_config *config, const st_memory_limit *limit)
{
    const uint64_t mib = UINT64_C(1) << 20, budget = st_memory_budget();
    if (budget == 0) {
        srv_log_tell(log, SRV_LEVEL_WARNING,
                     "the memory budget has no limit, because the system does not say how much "
                     "memory the machine has");
    } else if (config->memory_budget == 0) {
        srv_log_tell(log, SRV_LEVEL_INFO,
                     "memory budget %" PRIu64 " MiB, three quarters of the %" PRIu64
                     " MiB that %s allows",
                     budget / mib, limit->bytes / mib, limit->source);
    } else if (budget > limit->bytes) {
        srv_log_tell(
            log, SRV_LEVEL_WARNING,
            "memory budget %" PRIu64 " MiB, as configured, is more than the %" PRIu64
            " MiB that %s allows: the kernel may kill the daemon before the budget is used up",
            budget / mib, limit->bytes / mib, limit->source);
    } else {
        srv_log_tell(log, SRV_LEVEL_INFO, "memory budget %" PRIu64 " MiB, as configured",
                     budget / mib);
    }
}
