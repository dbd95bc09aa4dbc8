/* access_log.h - one JSON line a request, without making the request wait.
 *
 * Requests put a record into a bounded ring; a thread of the log's own formats and writes it. When
 * the reader of the log is slow, records are dropped and counted, and the next line says how many:
 *     {"time":"...","dropped":12}                                                             */
#ifndef HE_SERVER_NET_ACCESS_LOG_H
#define HE_SERVER_NET_ACCESS_LOG_H

#include <stddef.h>
#include <stdint.h>

enum {
    SRV_REQUEST_ID = 64,
    SRV_METHOD = 16,
    SRV_PEER = 64,
    SRV_LOG_PATH = 256,
    SRV_LOG_LINE = 2048
};

/* The query is never logged: it may hold what is nobody's business. */
typedef struct srv_access {
    double time; /* of the end, seconds since 1970 */
    char request_id[SRV_REQUEST_ID + 1];
    char method[SRV_METHOD + 1];
    char path[SRV_LOG_PATH];      /* raw, cut */
    const char *route;            /* template, static */
    int status;                   /* 0: closed without an answer */
    uint64_t bytes_in, bytes_out; /* of bodies */
    uint64_t duration_us;
    char peer[SRV_PEER];
} srv_access;

typedef struct srv_access_log srv_access_log;

/* Writes to `fd`, borrowed. NULL when memory or threads are out. */
srv_access_log *srv_access_log_new(int fd, size_t capacity);
/* Writes what is left. NULL is accepted. */
void srv_access_log_free(srv_access_log *log);
void srv_access_log_add(srv_access_log *log, const srv_access *access);

/* The line, ended by a newline and a null; its length without the null. */
size_t srv_access_format(const srv_access *access, char line[SRV_LOG_LINE]);

#endif
