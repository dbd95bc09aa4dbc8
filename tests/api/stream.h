/* stream.h - listening to the events of a mesh without a socket, and updating a copy from them. */
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
    sse_event event; /* the result of the last stream_next */
    cJSON *data;
} listener;

/* Opens an event stream. Returns NULL if the request was refused because memory is out; any other
 * refusal fails the test. `last` is the value of the header Last-Event-ID, or NULL. */
listener *stream_try(api_bench *b, const char *path, const char *query, const char *last);
listener *stream_open(api_bench *b, const char *path, const char *query, const char *last);
void stream_close(listener *l);
/* Returns the name of the next event, "" at the end of the stream. If `patient` is false, also
 * returns "" where the stream has no event at present. */
const char *stream_next(listener *l, bool patient);
/* Return a member of the last event's data; "" if the data has no such text. */
const char *stream_text(const listener *l, const char *member);
uint64_t stream_number(const listener *l, const char *member);

/* Returns the mesh "m"; the caller must release it. */
st_mesh *stream_mesh(api_bench *b);
/* Copies the present state of the mesh "m". */
void stream_dump(api_bench *b, mirror *m);
void stream_require(api_bench *b, const mirror *copy, const char *after);
/* Reads all events and applies them to the copy; returns how often the copy had to be fetched
 * again. */
unsigned stream_follow(api_bench *b, listener *l, mirror *copy);

#endif
