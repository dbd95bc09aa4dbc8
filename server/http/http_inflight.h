/* http_inflight.h - counts running and suspended requests, so that a stop can wait for them.
 *
 * libmicrohttpd must not be stopped while a connection is suspended. So this module counts the
 * suspended connections and acts as a gate: after the gate was closed, no connection can be
 * suspended any more. */
#ifndef HE_SERVER_HTTP_HTTP_INFLIGHT_H
#define HE_SERVER_HTTP_HTTP_INFLIGHT_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct srv_inflight {
    pthread_mutex_t lock;
    pthread_cond_t ended;
    size_t active;  /* number of requests between their headers and their completion */
    size_t waiting; /* number of suspended connections */
    bool closed;
} srv_inflight;

void srv_inflight_init(srv_inflight *inflight);
void srv_inflight_clear(srv_inflight *inflight);

void srv_inflight_enter(srv_inflight *inflight); /* counts a request that begins */
void srv_inflight_leave(srv_inflight *inflight);
/* Counts a connection that is about to be suspended. Returns false if the gate is closed: then the
 * connection must not be suspended. */
bool srv_inflight_wait(srv_inflight *inflight);
void srv_inflight_resume(srv_inflight *inflight);

/* Waits until no request is running, but at most `millis`. Then closes the gate and returns true if
 * no connection is suspended; otherwise returns false. */
bool srv_inflight_close(srv_inflight *inflight, unsigned millis);

#endif
