/* stream.h - a listener that reads the event stream of a mesh without a socket, and a copy of the
 * mesh that is kept up to date by the events. */
#ifndef TESTS_API_STREAM_H
#define TESTS_API_STREAM_H

#include "tests/api/request.h"
#include "tests/mirror.h"
#include "tests/sse.h"

#include <pthread.h>

typedef struct listener {
    api_exchange *exchange;
    const api_source *source;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool woken;
    sse events;
    sse_event event; /* result of the latest stream_next */
    cJSON *data;
} listener;

/* Opens an event stream. Returns NULL if the request was refused because memory is out; a refusal
 * for another reason fails the test. `last` is the value of the header Last-Event-ID, or NULL. */
listener *stream_try(api_bench *b, const char *path, const char *query, const char *last);
listener *stream_open(api_bench *b, const char *path, const char *query, const char *last);
void stream_close(listener *l);
/* Waits for the next event and returns its name, or "" at the end of the stream. If `patient` is
 * false, it does not wait: it also returns "" if no event is ready. */
const char *stream_next(listener *l, bool patient);
/* stream_text returns a string, and stream_number a number, in the data of the latest event;
 * `member` is its name. stream_text returns "" if the data has no such string. */
const char *stream_text(const listener *l, const char *member);
uint64_t stream_number(const listener *l, const char *member);

/* Returns the mesh "m" of the store; the caller must release it. */
st_mesh *stream_mesh(api_bench *b);
/* Copies the present state of the mesh "m". */
void stream_dump(api_bench *b, mirror *m);
void stream_require(api_bench *b, const mirror *copy, const char *after);
/* Reads all events that are ready and applies them to the copy. Returns the number of times that
 * the whole mesh had to be copied again, because the server sent `resync` or a revision was
 * missing. */
unsigned stream_follow(api_bench *b, listener *l, mirror *copy);

#endif
