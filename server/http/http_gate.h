/* http_gate.h - counts running and suspended requests, so that a stop can wait for them.
 *
 * libmicrohttpd must not be stopped while a connection is suspended. The gate counts suspended
 * connections, and after it is closed no connection can be suspended. */
#ifndef HE_SERVER_HTTP_HTTP_GATE_H
#define HE_SERVER_HTTP_HTTP_GATE_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct srv_gate {
    pthread_mutex_t lock;
    pthread_cond_t ended;
    size_t active;  /* requests between their headers and their completion */
    size_t waiting; /* how many of them are suspended */
    bool closed;
} srv_gate;

void srv_gate_init(srv_gate *gate);
void srv_gate_clear(srv_gate *gate);

void srv_gate_enter(srv_gate *gate); /* counts a request that begins */
void srv_gate_leave(srv_gate *gate);
/* Counts a connection that is about to be suspended. Returns false if it must not be suspended. */
bool srv_gate_wait(srv_gate *gate);
void srv_gate_resume(srv_gate *gate);

/* Waits until no request is running, for at most `millis`. Returns true when none is suspended:
 * then the gate is closed. */
bool srv_gate_close(srv_gate *gate, unsigned millis);

#endif
