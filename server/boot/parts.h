/* parts.h - the parts of a running daemon.
 *
 * A part is NULL until it is opened by one of the files open_*.c. daemon.c opens the parts in order
 * and closes them in the opposite order. */
#ifndef HE_SERVER_BOOT_PARTS_H
#define HE_SERVER_BOOT_PARTS_H

#include "api/job/job_table.h"
#include "server/assets.h"
#include "server/backup.h"
#include "server/boot/daemon.h"
#include "server/http/http.h"
#include "server/net/unix_socket.h"
#include "system/parallel.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct srv_parts {
    const srv_started *started;
    const srv_config *config; /* the member of `started` */
    srv_log *log;             /* opened first, closed last */
    /* `pool` has the threads for long work, `makers` those that make pieces of answers ahead of
     * sending. */
    st_pool *pool, *makers;
    st_parallel *parallel;
    st_store *store;
    srv_assets *assets;
    /* The certificates that clients see; NULL if the daemon does not use TLS. */
    srv_certificates *certificates;
    /* The tokens that requests may have; NULL if requests need no token. */
    api_tokens *tokens;
    api_job_table *job_table;
    srv_backups backups;
    api_service *service;
    /* The thread of present.h; `has_present` says whether it was started. */
    pthread_t present;
    bool has_present;
    srv_policy policy;
    char own_host[SRV_ADDRESS_TEXT];
    /* Path of the Unix socket's file, if the daemon listens on a Unix socket. */
    srv_unix_socket socket;
    srv_http *http;
    char url[SRV_URL_TEXT]; /* the daemon's URL, with the port that is in use */
    _Atomic bool ready;     /* whether the daemon serves requests, for /readyz */
    _Atomic bool full;      /* whether memory is full, for /readyz: see watch.h */
    /* Whether the message READY=1 to systemd was lost, so that watch.c must send it again. */
    _Atomic bool unannounced;
    /* Held during a reload: of two reloads, the later one must not be overtaken by the earlier one,
     * which may have read the files before they were changed. */
    pthread_mutex_t reload_lock;
} srv_parts;

/* Each of these functions opens its parts of the daemon as `parts->config` says. Returns false,
 * with the reason in the log, if a part cannot be opened; daemon.c closes what was opened
 * before. */
/* Opens the tokens: reads the file of tokens that the configuration names, if any. */
bool srv_open_tokens(srv_parts *parts);
bool srv_open_certificates(srv_parts *parts);
bool srv_open_store(srv_parts *parts);   /* thread pools, journal, store, samples */
bool srv_open_service(srv_parts *parts); /* page, jobs, service */
/* Starts the HTTP server, and reports that the daemon is ready. */
bool srv_open_http(srv_parts *parts);

/* Logs `why` and returns false. */
bool srv_open_failed(const srv_parts *parts, const char *why);

#endif
