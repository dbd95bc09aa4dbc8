/* parts.h - everything a running daemon is made of.
 *
 * A part is NULL until the source of this room that opens it has done so: daemon.c has the
 * order, and closes them in the opposite one. */
#ifndef HE_SERVER_BOOT_PARTS_H
#define HE_SERVER_BOOT_PARTS_H

#include "api/job/job_table.h"
#include "server/assets.h"
#include "server/backup.h"
#include "server/boot/daemon.h"
#include "server/http/http.h"
#include "server/net/unix_socket.h"
#include "system/parallel.h"

#include <stdatomic.h>

typedef struct srv_parts {
    const srv_started *started;
    const srv_config *config; /* of `started` */
    srv_log *log;             /* opened first, closed last */
    st_pool *pool, *makers;   /* for long work, and for answers that are made while they are sent */
    st_parallel *parallel;
    st_store *store;
    srv_assets *assets;
    srv_certificates *certificates; /* NULL: no TLS */
    api_tokens *tokens;             /* NULL: requests need no token */
    api_job_table *job_table;
    srv_backups backups;
    api_service *service;
    srv_policy policy;
    char own_host[SRV_ADDRESS_TEXT];
    srv_unix_socket socket; /* the file of `listen`, if it is one */
    srv_http *http;
    char url[SRV_URL_TEXT]; /* with the port that was taken */
    _Atomic bool ready;     /* what /readyz answers */
} srv_parts;

/* Each opens its parts from `parts->config`. False, with a line in the log that says why, when one
 * cannot be opened; what was opened stays in `parts`, to be closed by daemon.c. */
bool srv_open_tokens(srv_parts *parts); /* from their file, if there is one */
bool srv_open_certificates(srv_parts *parts);
bool srv_open_store(srv_parts *parts);   /* thread pools, journal, store, samples */
bool srv_open_service(srv_parts *parts); /* page, jobs, service */
bool srv_open_http(srv_parts *parts);    /* the address; tells that the daemon is ready */

/* Tells the log `why`, and returns false. */
bool srv_open_failed(const srv_parts *parts, const char *why);

#endif
