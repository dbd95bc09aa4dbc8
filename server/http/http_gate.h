/* http_gate.h - how many requests run and how many are suspended, for a stop that waits for them.
 *
 * libmicrohttpd must not be stopped while a connection is suspended. The gate counts those, and
 * once it is closed lets none be suspended any more. */
#ifndef HE_SERVER_HTTP_HTTP_GATE_H
#define HE_SERVER_HTTP_HTTP_GATE_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct srv_gate {
    pthread_mutex_t lock;
    pthread_cond_t ended;
    size_t active;  /* requests between their headers and their completion */
    size_t waiting; /* of them suspended */
    bool closed;
} srv_gate;

void srv_gate_init(srv_gate *gate);
void srv_gate_clear(srv_gate *gate);

void srv_gate_enter(srv_gate *gate); /* a request begins */
void srv_gate_leave(srv_gate *gate);
/* About to suspend a connection: false when it must not be. */
bool srv_gate_wait(srv_gate *gate);
void srv_gate_resume(srv_gate *gate);

/* Wait until no request runs, for at most `millis`. True when none is suspended: then the gate is
 * closed. */
bool srv_gate_close(srv_gate *gate, unsigned millis);

#endif
