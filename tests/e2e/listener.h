/* listener.h - a client of an event stream, with a socket of its own. The socket is read only in
 * calls that wait for an event. */
#ifndef TESTS_E2E_LISTENER_H
#define TESTS_E2E_LISTENER_H

#include "tests/e2e/daemon.h"
#include "tests/sse.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

typedef struct listener {
    int socket;
    int status; /* status of the answer */
    sse events;
    cJSON *data;   /* data of the latest event */
    bool ended;    /* whether the answer's last chunk, which has size 0, has come */
    size_t left;   /* number of bytes of the current chunk that have not come yet */
    char line[32]; /* the received part of the line with the size of the current chunk */
    size_t line_length;
} listener;

/* Requests `target` and reads the head of the answer. `last` is the Last-Event-ID, or NULL;
 * `buffer` is the size of the receive buffer, 0 for the system's default. */
listener *listener_open(const daemon_process *d, const char *target, const char *last, int buffer);
/* Opens an event stream like listener_open(); the request is sent with the token `token`. */
listener *listener_open_as(const daemon_process *d, const char *target, const char *token);
void listener_close(listener *l);

/* Waits for the next event, parses its data and returns its name. Returns "" at the end of the
 * stream and, if `patient` is false, also if no event has come. Fails the test if nothing comes for
 * ten minutes. */
const char *listener_next(listener *l, bool patient);
/* Waits until `comments` comments have come in the stream; the daemon sends them as heartbeats. */
void listener_wait_idle(listener *l, size_t comments);
/* listener_string returns a string, and listener_number a number, in the data of the latest event;
 * `name` is its name. Both fail the test if there is no such member. */
const char *listener_string(const listener *l, const char *name);
double listener_number(const listener *l, const char *name);

#endif
