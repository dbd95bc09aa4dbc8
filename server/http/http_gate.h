/* http_gate.h - counts running and suspended requests, so that a stop can wait for them.
 *
 * libmicrohttpd must not be stopped while a connection is suspended. So the gate counts the
 * suspended connections, and after it was closed no connection may be suspended any more. */
#ifndef HE_SERVER_HTTP_HTTP_GATE_H
#define HE_SERVER_HTTP_HTTP_GATE_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct srv_gate {
    pthread_mutex_t lock;
    pthread_cond_t ended;
    size_t active;  /* number of requests between their headers and their completion */
    size_t waiting; /* number of suspended connections */
    bool closed;
} srv_gate;

void srv_gate_init(srv_gate *gate);
void srv_gate_clear(srv_gate *gate);

void srv_gate_enter(srv_gate *gate); /* counts a request that begins */
void srv_gate_leave(srv_gate *gate);
/* Counts a connection that is about to be suspended. Returns false if the gate is closed: then the
 * connection must not be suspended. */
bool srv_gate_wait(srv_gate *gate);
void srv_gate_resume(srv_gate *gate);

/* Waits until no request is running, but at most `millis`. Then closes the gate and returns true if
 * no connection is suspended; otherwise returns false. */
bool srv_gate_close(srv_gate *gate, unsigned millis);

#endif
