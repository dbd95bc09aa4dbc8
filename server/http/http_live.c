#include "server/http/http_live.h"

#include "base/mem.h"
#include "system/clock.h"

#include <poll.h>
#include <pthread.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

enum { GONE_AT_ONCE = 64, LONGEST_MILLIS = 60 * 1000 };

struct srv_live {
    uint64_t heartbeat; /* microseconds */
    int watch;          /* an epoll set with the streams' sockets and `changed` */
    int changed;        /* an eventfd that wakes the thread */
    pthread_mutex_t lock;
    pthread_t thread;
    srv_stream *first, *last; /* suspended streams, in the order of their deadlines */
    srv_stream *ready;        /* suspended streams that the thread is to resume */
    bool stopping, ending;
};

/* --- lists of streams; the caller holds the lock --- */

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
    uint64_t now = st_clock_micros();
    while (live->first != NULL && live->first->deadline <= now) {
        live->first->due = true;
        make_ready(live, live->first);
    }
}

/* Marks the streams whose clients have closed their side. The caller holds the lock, under which a
 * stream is also removed from the epoll set; so the streams that epoll reports still exist. */
static void ready_gone(srv_live *live)
{
    struct epoll_event events[GONE_AT_ONCE];
    int count = epoll_wait(live->watch, events, GONE_AT_ONCE, 0);
    for (int i = 0; i < count; i++) {
        srv_stream *stream = events[i].data.ptr;
        if (stream == NULL) {
            uint64_t ignored;
            (void)!read(live->changed, &ignored, sizeof ignored);
            continue;
        }
        stream->gone = true;
        if (stream->aside) {
            make_ready(live, stream);
        }
    }
}

/* Waits until a stream must be resumed, a client has closed its side, or the first deadline has
 * come. The caller holds the lock, which is released meanwhile. */
static void wait_for_change(srv_live *live)
{
    struct pollfd watched = {.fd = live->watch, .events = POLLIN};
    int millis = -1;
    if (live->first != NULL) {
        uint64_t now = st_clock_micros(), until = live->first->deadline;
        uint64_t left = until > now ? (until - now + 999) / 1000 : 0;
        millis = left < LONGEST_MILLIS ? (int)left : LONGEST_MILLIS;
    }
    pthread_mutex_unlock(&live->lock);
    (void)poll(&watched, 1, millis);
    pthread_mutex_lock(&live->lock);
    ready_gone(live);
}

/* Resumes the streams of the list `ready`. A stream must not be touched after it was resumed,
 * because it may be freed at once. The caller holds the lock, which is released meanwhile. */
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

static void wake_thread(srv_live *live)
{
    uint64_t one = 1;
    (void)!write(live->changed, &one,
                 sizeof one); /* fails only if it is full: then it wakes, too */
}

static void release(srv_live *live)
{
    if (live->watch >= 0) {
        close(live->watch);
    }
    if (live->changed >= 0) {
        close(live->changed);
    }
    pthread_mutex_destroy(&live->lock);
    he_mem_free(live);
}

srv_live *srv_live_new(uint64_t heartbeat_micros)
{
    srv_live *live = he_mem_zero(1, sizeof *live);
    if (live == NULL) {
        return NULL;
    }
    live->heartbeat = heartbeat_micros;
    live->watch = epoll_create1(EPOLL_CLOEXEC);
    live->changed = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    pthread_mutex_init(&live->lock, NULL);
    struct epoll_event wakes = {.events = EPOLLIN, .data.ptr = NULL};
    if (live->watch < 0 || live->changed < 0 ||
        epoll_ctl(live->watch, EPOLL_CTL_ADD, live->changed, &wakes) != 0 ||
        pthread_create(&live->thread, NULL, run, live) != 0) {
        release(live);
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
    pthread_mutex_unlock(&live->lock);
    wake_thread(live);
    pthread_join(live->thread, NULL);
    release(live);
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
            wake_thread(live);
        }
    } else {
        stream->woken = true;
    }
    pthread_mutex_unlock(&live->lock);
}

void srv_live_begin(srv_live *live, srv_stream *stream, const api_source *source, int socket,
                    void (*resume)(srv_stream *stream))
{
    *stream = (srv_stream){.live = live, .source = source, .resume = resume, .socket = socket};
    /* The event that the client has closed its side is edge-triggered, so it is reported only once.
     * If the socket cannot be watched, that is noticed when the second heartbeat cannot be sent. */
    struct epoll_event closed = {.events = EPOLLRDHUP | EPOLLET, .data.ptr = stream};
    if (socket >= 0 && epoll_ctl(live->watch, EPOLL_CTL_ADD, socket, &closed) != 0) {
        stream->socket = -1;
    }
    source->start(source->self, wake, stream);
}

void srv_live_end(srv_stream *stream)
{
    srv_live *live = stream->live;
    if (live != NULL && stream->socket >= 0) {
        pthread_mutex_lock(&live->lock);
        epoll_ctl(live->watch, EPOLL_CTL_DEL, stream->socket, NULL);
        pthread_mutex_unlock(&live->lock);
    }
}

int64_t srv_live_read(srv_stream *stream, char *buffer, size_t size)
{
    const api_source *source = stream->source;
    pthread_mutex_lock(&stream->live->lock);
    bool stopping = stream->live->stopping, gone = stream->gone;
    pthread_mutex_unlock(&stream->live->lock);
    if (gone) {
        return -1;
    }
    if (!stream->finished && stopping) {
        stream->finished = true;
        source->finish(source->self);
    }
    int64_t got = source->read(source->self, buffer, size);
    size_t length = strlen(source->idle);
    if (got == API_READ_WAIT && stream->due && length <= size) {
        memcpy(buffer, source->idle, length);
        got = (int64_t)length;
    }
    stream->due = stream->due && got == API_READ_WAIT;
    return got;
}

/* Leaves a stream to the thread of this module until there is something to send. If the source has
 * called wake while the worker read from the stream, the stream is resumed at once. */
void srv_live_aside(srv_stream *stream)
{
    srv_live *live = stream->live;
    pthread_mutex_lock(&live->lock);
    bool alone = live->first == NULL;
    stream->deadline = st_clock_micros() + live->heartbeat;
    stream->aside = true;
    add_last(live, stream);
    bool at_once = stream->woken || stream->gone || (live->stopping && !stream->finished);
    stream->woken = false;
    if (at_once) {
        make_ready(live, stream);
    }
    if (at_once || alone) {
        wake_thread(live);
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
    wake_thread(live);
    pthread_mutex_unlock(&live->lock);
}
