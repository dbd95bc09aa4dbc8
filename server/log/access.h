/* access.h - the record of one request, and its lines in the log.
 *
 * Records are small and have a fixed size, so that a worker fills one without allocating; log.h
 * formats them on another thread. */
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

/* The parts of the time of a request. They add up to the whole. */
typedef enum srv_part {
    SRV_PART_RECEIVE, /* its head and body arrive */
    SRV_PART_QUEUE,   /* it waits for a thread */
    SRV_PART_LOCK,    /* it waits for the lock of the mesh or of the list of meshes */
    SRV_PART_WORK,
    SRV_PART_STORE, /* it waits until its changes are durable */
    SRV_PART_SEND,  /* the client reads the answer */
    SRV_PARTS
} srv_part;

/* What is logged of one request. The query is missing because it may hold a ticket or private
 * data. */
typedef struct srv_access {
    double time; /* when it ended, in seconds since 1970 */
    char request_id[SRV_REQUEST_ID + 1];
    char method[SRV_METHOD + 1];
    char path[SRV_LOG_PATH];      /* raw; truncated if long */
    const char *route;            /* template of the route, static; NULL: none */
    int status;                   /* 0: the connection was closed without an answer */
    uint64_t bytes_in, bytes_out; /* of bodies */
    uint64_t duration_us;
    uint64_t parts[SRV_PARTS]; /* microseconds; filled for slow requests only */
    char peer[SRV_PEER];
    char trace_id[SRV_TRACE_ID + 1]; /* "": the client sent no traceparent */
    char parent_id[SRV_SPAN_ID + 1]; /* sent by the client; "": none or malformed */
    char span_id[SRV_SPAN_ID + 1];   /* of this request, sent back in traceparent */
} srv_access;

/* Writes the line of a request, terminated by a newline and NUL; returns its length without the
 * NUL. */
size_t srv_access_format(const srv_access *access, bool json, char line[SRV_ACCESS_LINE]);
/* Writes the line that shows where the time of a slow request went. */
size_t srv_access_format_slow(const srv_access *access, bool json, char line[SRV_ACCESS_LINE]);

#endif
