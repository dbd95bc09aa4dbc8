#include "server/daemon.h"

#include "api/describe/routes.h"
#include "api/event/event_follow.h"
#include "api/job/job_table.h"
#include "journal/sqlite/sqlite_journal.h"
#include "server/assets.h"
#include "server/backup.h"
#include "server/http/http.h"
#include "server/net/healthcheck.h"
#include "server/net/notify.h"
#include "server/samples.h"
#include "server/tokens.h"
#include "server/version.h"
#include "system/memory.h"
#include "system/memory_limit.h"
#include "system/parallel.h"

#include <inttypes.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

enum {
    LOG_RING = 8192,
    STOP_MILLIS = 4000, /* of the five seconds a stop may take */
    OWN_FILES = 48,     /* descriptors that are not connections */
    DRAIN_FILES = 64,
    SHORT_THREADS = 2, /* of the pool, beside as many as there may be jobs: thread_pool.h */
    MAKER_QUEUE = 1024 /* pieces of answers; beyond it workers make them */
};

typedef struct daemon_parts {
    st_store *store;
    srv_assets *assets;
    api_service *service;
    st_pool *pool, *makers;
    st_parallel *parallel;
    api_job_table *job_table;
    srv_access_log *log;
    srv_http *http;
    srv_policy policy;
    char own_host[SRV_ADDRESS_TEXT];
    api_tokens *tokens;             /* NULL: nobody needs one */
    const char *tokens_path;        /* of their file */
    char address[SRV_ADDRESS_TEXT]; /* with the port that was taken */
    srv_backups backups;
    _Atomic bool ready;
} daemon_parts;

static size_t cores(void)
{
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online < 1 ? 1 : (size_t)online;
}

/* Connections are descriptors: as many as the system lets this process have. */
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

/* Of the sockets there may be, some are for telling those who are too many. */
static void choose_limits(const srv_config *config, srv_http_options *options)
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
    options->workers = config->workers == 0 ? cores() : (size_t)config->workers;
}

static bool is_ready(void *context)
{
    const daemon_parts *parts = context;
    return atomic_load(&parts->ready);
}

static bool fail(const char *why)
{
    fprintf(stderr, "hedged: %s\n", why);
    return false;
}

static bool open_threads(daemon_parts *parts, const srv_config *config)
{
    size_t jobs = config->jobs != 0 ? (size_t)config->jobs : cores() > 2 ? cores() : 2;
    parts->pool = st_pool_new("hedged-pool", jobs + SHORT_THREADS, (size_t)config->job_queue);
    parts->makers = st_pool_new("hedged-answers", cores(), MAKER_QUEUE);
    parts->parallel = st_parallel_new(cores() - 1);
    return (parts->pool != NULL && parts->makers != NULL && parts->parallel != NULL) ||
           fail("no memory or threads to start");
}

/* *made: the store is new, so that samples may be put into it. */
static bool open_journal(const srv_config *config, st_journal *out, bool *made)
{
    const char *folder = srv_config_folder(config);
    st_sqlite_opened opened;
    if (folder == NULL) {
        *out = st_journal_memory();
        *made = true;
        return true;
    }
    if (!st_sqlite_open(&(st_sqlite_options){.folder = folder, .release = SRV_VERSION}, &opened)) {
        return fail(opened.message);
    }
    fprintf(stderr, "hedged: meshes are kept in %s%s%s\n", folder,
            opened.message[0] == '\0' ? "" : "; ", opened.message);
    *out = opened.journal;
    *made = opened.made;
    return true;
}

static bool open_store(daemon_parts *parts, const srv_config *config)
{
    st_journal journal;
    bool made = false;
    if (!open_journal(config, &journal, &made)) {
        return false;
    }
    parts->store = st_store_new(&(st_store_options){
        .undo_budget = config->undo_budget,
        .max_meshes = config->max_meshes,
        .journal = journal,
        .pool = parts->pool,
        .listeners = config->max_listeners,
        .mesh_listeners = config->max_mesh_listeners,
        .render = api_event_render,
    });
    if (parts->store == NULL) {
        journal.close(journal.self);
        return fail("no memory to start");
    }
    he_error err;
    if (config->samples && made && srv_samples_add(parts->store, &err) != HE_OK) {
        return fail(err.text);
    }
    if (made && journal.keeps) {
        journal.begun(journal.self);
    }
    return true;
}

static bool load_page(daemon_parts *parts, const srv_config *config)
{
    char folder[PATH_MAX], message[320];
    bool found = srv_assets_folder(config->web, folder, sizeof folder);
    parts->assets = srv_assets_load(found ? folder : NULL, message, sizeof message);
    if (parts->assets == NULL) {
        return fail("no memory for the page");
    }
    /* Asked for by name, the page must be there; otherwise serving without it is fine. */
    return message[0] == '\0' || config->web[0] == '\0' || fail(message);
}

static void count_memory(uint64_t *used, uint64_t *budget)
{
    *used = st_memory_used();
    *budget = st_memory_budget();
}

/* By a signal or by a request, which may come at one time: the file that was read last stays. */
static bool reload(void *context, char *message, size_t size)
{
    const daemon_parts *parts = context;
    return parts->tokens == NULL ||
           srv_tokens_read(parts->tokens, parts->tokens_path, message, size);
}

static bool open_tokens(daemon_parts *parts, const srv_config *config)
{
    char message[320];
    if (config->tokens[0] == '\0') {
        return true;
    }
    parts->tokens = api_tokens_new();
    parts->tokens_path = config->tokens;
    if (parts->tokens == NULL) {
        return fail("no memory to start");
    }
    return reload(parts, message, sizeof message) || fail(message);
}

static bool submit_job(void *pool, const st_task *task)
{
    return st_pool_submit(pool, task);
}

static bool open_service(daemon_parts *parts, const srv_config *config)
{
    parts->job_table = api_job_table_new(&(api_job_table_options){
        .store = parts->store, .submit = submit_job, .pool = parts->pool, .keep = API_JOB_SECONDS});
    if (parts->job_table == NULL) {
        return fail("no memory to start");
    }
    parts->backups.folder = srv_config_folder(config);
    parts->service =
        api_service_new(parts->store, api_routes(),
                        &(api_options){
                            .max_upload = config->max_upload,
                            .version = SRV_VERSION,
                            .asset = srv_assets_find,
                            .asset_context = parts->assets,
                            .ready = is_ready,
                            .ready_context = parts,
                            .memory = count_memory,
                            .tokens = parts->tokens,
                            .reload = reload,
                            .reload_context = parts,
                            .backup = parts->backups.folder == NULL ? NULL : srv_backup_make,
                            .backup_context = &parts->backups,
                            .jobs = parts->job_table,
                            .pool = parts->pool,
                            .plain_answers = config->no_compression,
                            .exec = st_parallel_exec(parts->parallel),
                        });
    bool logs = config->log == SRV_LOG_ACCESS ||
                (config->log == SRV_LOG_AUTO && isatty(STDERR_FILENO) == 0);
    if (logs) {
        parts->log = srv_access_log_new(STDERR_FILENO, LOG_RING);
    }
    return (parts->service != NULL && (parts->log != NULL || !logs)) ||
           fail("no memory or threads to start");
}

/* Whoever reaches the daemon by the address it listens on names that as the host. */
static void allow_own_host(daemon_parts *parts, const srv_address *address)
{
    srv_names *hosts = &parts->policy.hosts;
    srv_address_format(&address->socket.any, false, parts->own_host);
    if (hosts->count < SRV_MAX_NAMES && strcmp(parts->own_host, "0.0.0.0") != 0 &&
        strcmp(parts->own_host, "::") != 0) {
        hosts->items[hosts->count++] = parts->own_host;
    }
}

/* Programs wait for the first line. The second is for a reader at a terminal: it names localhost
 * where the daemon listens on all addresses, since 0.0.0.0 in a browser is a Host that is refused.
 */
static void tell_ready(const daemon_parts *parts)
{
    char port[SRV_ADDRESS_TEXT];
    const char *text = parts->address;
    fprintf(stderr, "hedged " SRV_VERSION ": listening on http://%s\n", text);
    if (isatty(STDERR_FILENO) == 0) {
        return;
    }
    if (strcmp(parts->own_host, "0.0.0.0") == 0 || strcmp(parts->own_host, "::") == 0) {
        snprintf(port, sizeof port, "localhost:%u", srv_http_port(parts->http));
        text = port;
    }
    fprintf(stderr, "hedge is at http://%s/ - open it in a browser; Ctrl-C stops it\n", text);
}

static bool open_http(daemon_parts *parts, const srv_config *config)
{
    char message[256];
    srv_http_options options = {
        .service = parts->service,
        .store = parts->store,
        .pool = parts->pool,
        .makers = parts->makers,
        .log = parts->log,
        .policy = &parts->policy,
        .read_seconds = config->read_seconds,
        .heartbeat_micros = config->heartbeat * 1000000,
    };
    if (!srv_address_parse(config->listen, &options.address)) {
        return fail("no address to listen on");
    }
    parts->policy = config->policy;
    allow_own_host(parts, &options.address);
    choose_limits(config, &options);
    atomic_store(&parts->ready, true);
    parts->http = srv_http_start(&options, message, sizeof message);
    if (parts->http == NULL) {
        return fail(message);
    }
    srv_address_set_port(&options.address, srv_http_port(parts->http));
    srv_address_format(&options.address.socket.any, true, parts->address);
    tell_ready(parts);
    return true;
}

static uint64_t processor_micros(void)
{
    struct timespec time = {0};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (uint64_t)time.tv_sec * 1000000 + (uint64_t)time.tv_nsec / 1000;
}

/* A line when the disk is found full, when it has space again, and when it failed. What began and
 * ended between two looks is told all the same; what ended and began again is not. */
static void tell_health(const st_health *before, const st_health *now, const char *folder)
{
    const bool was_full = before->status == ST_FULL;
    const bool found_full = !was_full && now->fulls != before->fulls;
    if (found_full) {
        fprintf(stderr,
                "hedged: the disk of %s is full: changes are refused, reads and DELETE go on. Make "
                "space there, or delete meshes\n",
                folder);
    }
    if ((was_full || found_full) && now->status == ST_OK) {
        fprintf(stderr, "hedged: the disk of %s has space again: changes are taken\n", folder);
    }
    if (now->status == ST_FAILED && before->status != ST_FAILED) {
        fprintf(stderr,
                "hedged: the disk of %s failed%s%s: reads go on, no change is taken any more. Look "
                "at the disk and start hedged again: what was acknowledged is there\n",
                folder, now->reason[0] == '\0' ? "" : ", ", now->reason);
    }
}

static void tell_reload(daemon_parts *parts)
{
    char message[320];
    if (!reload(parts, message, sizeof message)) {
        fprintf(stderr, "hedged: %s; those before stay in force\n", message);
    } else if (parts->tokens != NULL) {
        fprintf(stderr, "hedged: %zu tokens are in force, read again from %s\n",
                api_tokens_count(parts->tokens), parts->tokens_path);
    }
}

static uint64_t now_micros(void)
{
    struct timespec time = {0};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (uint64_t)time.tv_sec * 1000000 + (uint64_t)time.tv_nsec / 1000;
}

/* systemd hears twice in the time it waits that a worker still answers. */
static void feed_watchdog(const daemon_parts *parts, uint64_t *fed)
{
    const uint64_t patience = srv_notify_watchdog();
    char message[128];
    if (patience == 0 || now_micros() - *fed < patience / 2) {
        return;
    }
    *fed = now_micros();
    if (srv_healthcheck(NULL, parts->address, message, sizeof message)) {
        srv_notify("WATCHDOG=1");
    } else {
        fprintf(stderr, "hedged: asked itself for /livez, and %s\n", message);
    }
}

/* The main thread serves nobody, and keeps house until it is told to stop. */
static void wait_for_stop(daemon_parts *parts, const sigset_t *signals, const char *folder)
{
    const struct timespec second = {.tv_sec = 1};
    st_memory_rest rest = {0};
    st_health health = {.status = ST_OK}, before;
    uint64_t fed = 0;
    int number;
    do {
        feed_watchdog(parts, &fed);
        number = sigtimedwait(signals, NULL, &second);
        st_memory_rests(&rest, processor_micros());
        st_store_rest(parts->store);
        before = health;
        st_store_health(parts->store, &health);
        tell_health(&before, &health, folder);
        if (number == SIGHUP) {
            tell_reload(parts);
        }
    } while (number != SIGTERM && number != SIGINT);
}

/* Signals that end a process unless it says otherwise, and mean nothing here: a terminal or client
 * that is gone, timers, descriptors, and what other daemons take for a command. */
static void ignore_signals(void)
{
    static const int harmless[] = {SIGPIPE, SIGALRM, SIGUSR1,   SIGUSR2, SIGVTALRM,
                                   SIGPROF, SIGPOLL, SIGSTKFLT, SIGPWR};
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++) {
        signal(harmless[i], SIG_IGN);
    }
    for (int number = SIGRTMIN; number <= SIGRTMAX; number++) {
        signal(number, SIG_IGN);
    }
}

/* Signals are taken by the main thread alone: every other inherits that they are blocked. */
static void block_signals(sigset_t *waited)
{
    sigemptyset(waited);
    sigaddset(waited, SIGTERM);
    sigaddset(waited, SIGINT);
    sigaddset(waited, SIGHUP);
    pthread_sigmask(SIG_BLOCK, waited, NULL);
}

/* Say what the budget is and why, for an operator who wonders at a 507. */
static void choose_budget(const srv_config *config)
{
    const uint64_t mib = UINT64_C(1) << 20;
    const st_memory_limit limit = st_memory_limit_find("", st_memory_limit_machine());
    uint64_t budget = config->memory_budget;
    if (budget == 0 && limit.bytes == UINT64_MAX) {
        fprintf(stderr, "hedged: no memory budget: the system does not say what the machine has\n");
    } else if (budget == 0) {
        budget = limit.bytes / 4 * 3;
        fprintf(stderr,
                "hedged: memory budget %" PRIu64 " MiB, three quarters of the %" PRIu64
                " MiB that %s allows\n",
                budget / mib, limit.bytes / mib, limit.source);
    } else if (budget > limit.bytes) {
        fprintf(stderr,
                "hedged: memory budget %" PRIu64 " MiB as told, more than the %" PRIu64
                " MiB that %s allows: the kernel may end the daemon before it is used up\n",
                budget / mib, limit.bytes / mib, limit.source);
    } else {
        fprintf(stderr, "hedged: memory budget %" PRIu64 " MiB as told\n", budget / mib);
    }
    st_memory_set_budget(budget);
}

int srv_daemon_run(const srv_config *config)
{
    daemon_parts parts = {0};
    sigset_t signals;
    ignore_signals();
    block_signals(&signals);
    choose_budget(config);

    bool started = open_tokens(&parts, config) && open_threads(&parts, config) &&
                   open_store(&parts, config) && load_page(&parts, config) &&
                   open_service(&parts, config) && open_http(&parts, config);
    if (started) {
        srv_notify("READY=1");
        wait_for_stop(&parts, &signals, srv_config_folder(config));
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
    st_pool_free(parts.pool);
    st_pool_free(parts.makers);
    st_parallel_free(parts.parallel);
    api_job_table_free(parts.job_table);
    api_service_free(parts.service);
    st_store_free(parts.store);
    srv_assets_free(parts.assets);
    srv_access_log_free(parts.log);
    api_tokens_free(parts.tokens);
    return started ? 0 : 1;
}
