/* stream.h - listening to a mesh without a socket, and keeping a copy of it by what is heard. */
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
    sse_event event; /* of the last `next` */
    cJSON *data;
} listener;

/* NULL where it is refused for want of memory; else the status is 200. `last` is a Last-Event-ID or
 * NULL. */
listener *stream_try(api_bench *b, const char *path, const char *query, const char *last);
listener *stream_open(api_bench *b, const char *path, const char *query, const char *last);
void stream_close(listener *l);
/* The next event; "" at the end of the stream, and where it would wait and `patient` is false. */
const char *stream_next(listener *l, bool patient);
/* Members of its data: "" where there is no such text. */
const char *stream_text(const listener *l, const char *member);
uint64_t stream_number(const listener *l, const char *member);

/* The mesh "m", with a reference. */
st_mesh *stream_mesh(api_bench *b);
/* What it is now. */
void stream_dump(api_bench *b, mirror *m);
void stream_require(api_bench *b, const mirror *copy, const char *after);
/* Read everything there is. How often the copy had to be taken anew. */
unsigned stream_follow(api_bench *b, listener *l, mirror *copy);

#endif
