/* listener.h - a client of an event stream with a socket of its own, which reads only when the test
 * asks it to. */
#ifndef TESTS_E2E_LISTENER_H
#define TESTS_E2E_LISTENER_H

#include "tests/e2e/daemon.h"
#include "tests/sse.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

typedef struct listener {
    int socket;
    int status; /* of the answer */
    sse events;
    cJSON *data;   /* of the last event */
    bool ended;    /* the server closed the stream in order */
    size_t left;   /* bytes still to come of the current chunk */
    char line[32]; /* the part of a chunk's size that has come */
    size_t line_length;
} listener;

/* Requests `target` and reads the head of the answer. `last` is the Last-Event-ID, or NULL;
 * `buffer` is the size of the receive buffer, 0 for the system's default. */
listener *listener_open(const daemon_process *d, const char *target, const char *last, int buffer);
/* Opens a stream with this token. */
listener *listener_open_as(const daemon_process *d, const char *target, const char *token);
void listener_close(listener *l);

/* Returns the name of the next event, whose data is then parsed. Returns "" at the end of the
 * stream and, if `patient` is false, also when no event has come. Fails the test if nothing comes
 * for long. */
const char *listener_next(listener *l, bool patient);
/* Waits until the stream has had this many comments, which the daemon sends as heartbeats. */
void listener_wait_idle(listener *l, size_t comments);
/* Return members of the last event's data; fail the test if they are absent. */
const char *listener_string(const listener *l, const char *name);
double listener_number(const listener *l, const char *name);

#endif
