/* listener.h - a client of an event stream: a socket of its own, read only when asked to. */
#ifndef TESTS_E2E_LISTENER_H
#define TESTS_E2E_LISTENER_H

#include "tests/e2e/daemon.h"
#include "tests/sse.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

typedef struct listener {
    int socket;
    int status; /* of the answer's head */
    sse events;
    cJSON *data;   /* of the last event */
    bool ended;    /* the server closed the stream in order */
    size_t left;   /* of the chunk being read */
    char line[32]; /* the size of a chunk, as far as it has come */
    size_t line_length;
} listener;

/* Ask for `target` and read the head of the answer. `last` is the Last-Event-ID, or NULL; `buffer`
 * the size of the receive buffer, 0 for the system's. */
listener *listener_open(const daemon_process *d, const char *target, const char *last, int buffer);
/* Asks as the client who has this token. */
listener *listener_open_as(const daemon_process *d, const char *target, const char *token);
void listener_close(listener *l);

/* The name of the next event, its data parsed; "" at the end of the stream, or, when not `patient`,
 * when none has come. Fails the test when nothing comes for long. */
const char *listener_next(listener *l, bool patient);
/* Wait for this many comments in all. */
void listener_wait_idle(listener *l, size_t comments);
/* Members of the data; fail the test where they are absent. */
const char *listener_string(const listener *l, const char *name);
double listener_number(const listener *l, const char *name);

#endif
