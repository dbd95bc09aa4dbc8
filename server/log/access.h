/* access.h - one request as a record, and its lines in the log.
 *
 * Records are small and of one size, so that a worker fills one without memory of its own and goes
 * on; log.h has them formatted by another thread. */
#ifndef HE_SERVER_LOG_ACCESS_H
#define HE_SERVER_LOG_ACCESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    SRV_REQUEST_ID = 64,
    SRV_METHOD = 16,
    SRV_PEER = 64,
    SRV_LOG_PATH = 256,
    SRV_TRACE_ID = 32, /* hexadecimal digits */
    SRV_SPAN_ID = 16,
    SRV_ACCESS_LINE = 2560
};

/* Where the time of a request went. The parts add up to the whole. */
typedef enum srv_part {
    SRV_PART_RECEIVE, /* its head and body arrive */
    SRV_PART_QUEUE,   /* it waits for a thread */
    SRV_PART_LOCK,    /* it waits for other requests that use the mesh, or the list of meshes */
    SRV_PART_WORK,
    SRV_PART_STORE, /* it waits for what it shows to be durable */
    SRV_PART_SEND,  /* the client takes the answer */
    SRV_PARTS
} srv_part;

/* The query is never logged: it may hold a ticket, or what is nobody's business. */
typedef struct srv_access {
    double time; /* of the end, seconds since 1970 */
    char request_id[SRV_REQUEST_ID + 1];
    char method[SRV_METHOD + 1];
    char path[SRV_LOG_PATH];      /* raw, cut */
    const char *route;            /* template, static; NULL: none */
    int status;                   /* 0: closed without an answer */
    uint64_t bytes_in, bytes_out; /* of bodies */
    uint64_t duration_us;
    uint64_t parts[SRV_PARTS]; /* microseconds; of a slow request alone */
    char peer[SRV_PEER];
    char trace_id[SRV_TRACE_ID + 1]; /* "": the client sent no traceparent */
    char parent_id[SRV_SPAN_ID + 1]; /* the client's; "": what it sent was malformed */
    char span_id[SRV_SPAN_ID + 1];   /* of this request, answered in traceparent */
} srv_access;

/* The line, ended by a newline and a null; its length without the null. */
size_t srv_access_format(const srv_access *access, bool json, char line[SRV_ACCESS_LINE]);
/* The line that says where the time of a slow request went. */
size_t srv_access_format_slow(const srv_access *access, bool json, char line[SRV_ACCESS_LINE]);

#endif
