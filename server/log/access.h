/* access.h - the record of one request, from which its lines in the log are made.
 *
 * Records are small and have a fixed size, so that a worker thread fills one without allocating
 * memory; the thread of log.h formats them. */
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

/* The parts into which the duration of a request is divided. They add up to the whole duration. */
typedef enum srv_part {
    SRV_PART_RECEIVE, /* the head and the body of the request arrive */
    SRV_PART_QUEUE,   /* the request waits for a thread */
    SRV_PART_LOCK,    /* a thread waits for the lock of the mesh or of the list of meshes */
    SRV_PART_WORK,
    SRV_PART_STORE, /* the request waits until its changes are durable */
    SRV_PART_SEND,  /* the client reads the answer */
    SRV_PARTS
} srv_part;

/* What is logged about one request. The query of its URL is not logged, because it may contain a
 * ticket, which grants access, or private data. */
typedef struct srv_access {
    double time; /* time at which the request ended, in seconds since 1970 */
    char request_id[SRV_REQUEST_ID + 1];
    char method[SRV_METHOD + 1];
    char path[SRV_LOG_PATH]; /* path of the request as the client sent it; truncated if long */
    /* Template of the path in the table of routes, a static text; NULL if no route fits. */
    const char *route;
    /* Status of the answer; 0: the connection was closed without an answer. */
    int status;
    uint64_t bytes_in, bytes_out; /* lengths of the bodies */
    uint64_t duration_us;
    /* Duration of each part in microseconds; filled for slow requests only. */
    uint64_t parts[SRV_PARTS];
    char peer[SRV_PEER];
    /* Trace id of the request; "" if the client sent no traceparent: see trace.h. */
    char trace_id[SRV_TRACE_ID + 1];
    /* Parent id that the client sent; "" if it sent none or a malformed one. */
    char parent_id[SRV_SPAN_ID + 1];
    char span_id[SRV_SPAN_ID + 1]; /* the id of this request, sent back in traceparent */
} srv_access;

/* Writes the line of a request, terminated by a newline and NUL; returns its length without the
 * NUL. */
size_t srv_access_format(const srv_access *access, bool json, char line[SRV_ACCESS_LINE]);
/* Writes the line that shows where the time of a slow request went. */
size_t srv_access_format_slow(const srv_access *access, bool json, char line[SRV_ACCESS_LINE]);

#endif
