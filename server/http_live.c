#include "server/http_live.h"

#include "mesh/mem.h"
#include "server/clock.h"

#include <pthread.h>
#include <string.h>

struct srv_live {
    uint64_t heartbeat; /* microseconds */
    pthread_mutex_t lock;
    pthread_cond_t changed;
    pthread_t thread;
    srv_stream *first, *last; /* aside, in the order of their deadlines */
    srv_stream *ready;        /* to be resumed */
    bool stopping, ending;
};

/* --- lists, under the lock --- */

static void add_last(srv_live *live, srv_stream *stream)
{
    stream->next = NULL;
    stream->previous = live->last;
    if (live->last != NULL) {
        live->last->next = stream;
    } else {
        live->first = stream;
    }
    live->last = stream;
}

static void make_ready(srv_live *live, srv_stream *stream)
{
    if (stream->previous != NULL) {
        stream->previous->next = stream->next;
    } else {
        live->first = stream->next;
    }
    if (stream->next != NULL) {
        stream->next->previous = stream->previous;
    } else {
        live->last = stream->previous;
    }
    stream->aside = false;
    stream->next = live->ready;
    live->ready = stream;
}

/* --- the thread --- */

static void ready_due(srv_live *live)
{
    uint64_t now = srv_clock_micros();
    while (live->first != NULL && live->first->deadline <= now) {
        live->first->due = true;
        make_ready(live, live->first);
    }
}

/* Until somebody is ready; for no longer than the first deadline. */
static void wait_for_change(srv_live *live)
{
    if (live->first == NULL) {
        pthread_cond_wait(&live->changed, &live->lock);
        return;
    }
    (void)srv_clock_wait(&live->changed, &live->lock, live->first->deadline);
}

/* A stream that was resumed may be gone at once. */
static void resume_all(srv_live *live)
{
    srv_stream *ready = live->ready;
    live->ready = NULL;
    pthread_mutex_unlock(&live->lock);
    while (ready != NULL) {
        srv_stream *next = ready->next;
        ready->resume(ready);
        ready = next;
    }
    pthread_mutex_lock(&live->lock);
}

static void *run(void *context)
{
    srv_live *live = context;
    pthread_mutex_lock(&live->lock);
    while (!live->ending) {
        ready_due(live);
        if (live->ready != NULL) {
            resume_all(live);
        } else {
            wait_for_change(live);
        }
    }
    pthread_mutex_unlock(&live->lock);
    return NULL;
}

srv_live *srv_live_new(uint64_t heartbeat_micros)
{
    srv_live *live = he_mem_zero(1, sizeof *live);
    if (live == NULL) {
        return NULL;
    }
    live->heartbeat = heartbeat_micros;
    pthread_mutex_init(&live->lock, NULL);
    srv_clock_condition(&live->changed);
    if (pthread_create(&live->thread, NULL, run, live) != 0) {
        pthread_mutex_destroy(&live->lock);
        pthread_cond_destroy(&live->changed);
        he_mem_free(live);
        return NULL;
    }
    return live;
}

void srv_live_free(srv_live *live)
{
    if (live == NULL) {
        return;
    }
    pthread_mutex_lock(&live->lock);
    live->ending = true;
    pthread_cond_signal(&live->changed);
    pthread_mutex_unlock(&live->lock);
    pthread_join(live->thread, NULL);
    pthread_mutex_destroy(&live->lock);
    pthread_cond_destroy(&live->changed);
    he_mem_free(live);
}

/* --- one stream --- */

static void wake(void *context)
{
    srv_stream *stream = context;
    srv_live *live = stream->live;
    pthread_mutex_lock(&live->lock);
    if (stream->aside) {
        bool first = live->ready == NULL;
        make_ready(live, stream);
        if (first) {
            pthread_cond_signal(&live->changed);
        }
    } else {
        stream->woken = true;
    }
    pthread_mutex_unlock(&live->lock);
}

void srv_live_begin(srv_live *live, srv_stream *stream, const api_source *source, const char *idle,
                    void (*resume)(srv_stream *stream))
{
    *stream = (srv_stream){.live = live, .source = source, .idle = idle, .resume = resume};
    source->start(source->self, wake, stream);
}

static bool is_stopping(srv_live *live)
{
    pthread_mutex_lock(&live->lock);
    bool stopping = live->stopping;
    pthread_mutex_unlock(&live->lock);
    return stopping;
}

int64_t srv_live_read(srv_stream *stream, char *buffer, size_t size)
{
    const api_source *source = stream->source;
    if (!stream->finished && is_stopping(stream->live)) {
        stream->finished = true;
        source->finish(source->self);
    }
    int64_t got = source->read(source->self, buffer, size);
    size_t length = strlen(stream->idle);
    if (got == API_READ_WAIT && stream->due && length <= size) {
        memcpy(buffer, stream->idle, length);
        got = (int64_t)length;
    }
    stream->due = stream->due && got == API_READ_WAIT;
    return got;
}

/* What came while the stream was pulled makes it ready at once. */
void srv_live_aside(srv_stream *stream)
{
    srv_live *live = stream->live;
    pthread_mutex_lock(&live->lock);
    bool alone = live->first == NULL;
    stream->deadline = srv_clock_micros() + live->heartbeat;
    stream->aside = true;
    add_last(live, stream);
    bool at_once = stream->woken || (live->stopping && !stream->finished);
    stream->woken = false;
    if (at_once) {
        make_ready(live, stream);
    }
    if (at_once || alone) {
        pthread_cond_signal(&live->changed);
    }
    pthread_mutex_unlock(&live->lock);
}

void srv_live_stop(srv_live *live)
{
    pthread_mutex_lock(&live->lock);
    live->stopping = true;
    while (live->first != NULL) {
        make_ready(live, live->first);
    }
    pthread_cond_signal(&live->changed);
    pthread_mutex_unlock(&live->lock);
}
