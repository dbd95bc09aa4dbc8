#include "server/http/http_stream.h"

#include "base/mem.h"
#include "system/clock.h"

#include <poll.h>
#include <pthread.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

enum { GONE_AT_ONCE = 64, LONGEST_MILLIS = 60 * 1000 };

struct srv_streams {
    uint64_t heartbeat; /* microseconds */
    int watch;          /* an epoll set with the streams' sockets and `changed` */
    int changed;        /* an eventfd that wakes the thread */
    pthread_mutex_t lock;
    pthread_t thread;
    srv_stream *first, *last; /* list of the suspended streams, in the order of their deadlines */
    srv_stream *ready;        /* suspended streams whose requests the thread is to resume next */
    bool stopping, ending;
};

/* --- lists of streams; the caller holds the lock --- */

static void add_last(srv_streams *streams, srv_stream *stream)
{
    stream->next = NULL;
    stream->previous = streams->last;
    if (streams->last != NULL) {
        streams->last->next = stream;
    } else {
        streams->first = stream;
    }
    streams->last = stream;
}

static void make_ready(srv_streams *streams, srv_stream *stream)
{
    if (stream->previous != NULL) {
        stream->previous->next = stream->next;
    } else {
        streams->first = stream->next;
    }
    if (stream->next != NULL) {
        stream->next->previous = stream->previous;
    } else {
        streams->last = stream->previous;
    }
    stream->aside = false;
    stream->next = streams->ready;
    streams->ready = stream;
}

/* --- the thread --- */

static void ready_due(srv_streams *streams)
{
    uint64_t now = st_clock_micros();
    while (streams->first != NULL && streams->first->deadline <= now) {
        streams->first->due = true;
        make_ready(streams, streams->first);
    }
}

/* Marks the streams whose clients have closed their side. The caller holds the lock, under which a
 * stream is also removed from the epoll set; so every stream that epoll reports still exists. */
static void ready_gone(srv_streams *streams)
{
    struct epoll_event events[GONE_AT_ONCE];
    int count = epoll_wait(streams->watch, events, GONE_AT_ONCE, 0);
    for (int i = 0; i < count; i++) {
        srv_stream *stream = events[i].data.ptr;
        if (stream == NULL) {
            uint64_t ignored;
            (void)!read(streams->changed, &ignored, sizeof ignored);
            continue;
        }
        stream->gone = true;
        if (stream->aside) {
            make_ready(streams, stream);
        }
    }
}

/* Waits until a stream must be resumed, a client has closed its side, or the first deadline has
 * come. The caller holds the lock, which is released meanwhile. */
static void wait_for_change(srv_streams *streams)
{
    struct pollfd watched = {.fd = streams->watch, .events = POLLIN};
    int millis = -1;
    if (streams->first != NULL) {
        uint64_t now = st_clock_micros(), until = streams->first->deadline;
        uint64_t left = until > now ? (until - now + 999) / 1000 : 0;
        millis = left < LONGEST_MILLIS ? (int)left : LONGEST_MILLIS;
    }
    pthread_mutex_unlock(&streams->lock);
    (void)poll(&watched, 1, millis);
    pthread_mutex_lock(&streams->lock);
    ready_gone(streams);
}

/* Resumes the streams of the list `ready`. A stream must not be touched after it was resumed,
 * because it may be freed at once. The caller holds the lock, which is released meanwhile. */
static void resume_all(srv_streams *streams)
{
    srv_stream *ready = streams->ready;
    streams->ready = NULL;
    pthread_mutex_unlock(&streams->lock);
    while (ready != NULL) {
        srv_stream *next = ready->next;
        ready->resume(ready);
        ready = next;
    }
    pthread_mutex_lock(&streams->lock);
}

static void *run(void *context)
{
    srv_streams *streams = context;
    pthread_mutex_lock(&streams->lock);
    while (!streams->ending) {
        ready_due(streams);
        if (streams->ready != NULL) {
            resume_all(streams);
        } else {
            wait_for_change(streams);
        }
    }
    pthread_mutex_unlock(&streams->lock);
    return NULL;
}

static void wake_thread(srv_streams *streams)
{
    uint64_t one = 1;
    /* The write fails only if the eventfd's counter is full: then the thread wakes up anyway. */
    (void)!write(streams->changed, &one, sizeof one);
}

static void release(srv_streams *streams)
{
    if (streams->watch >= 0) {
        close(streams->watch);
    }
    if (streams->changed >= 0) {
        close(streams->changed);
    }
    pthread_mutex_destroy(&streams->lock);
    he_mem_free(streams);
}

srv_streams *srv_streams_new(uint64_t heartbeat_micros)
{
    srv_streams *streams = he_mem_zero(1, sizeof *streams);
    if (streams == NULL) {
        return NULL;
    }
    streams->heartbeat = heartbeat_micros;
    streams->watch = epoll_create1(EPOLL_CLOEXEC);
    streams->changed = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    pthread_mutex_init(&streams->lock, NULL);
    struct epoll_event wakes = {.events = EPOLLIN, .data.ptr = NULL};
    if (streams->watch < 0 || streams->changed < 0 ||
        epoll_ctl(streams->watch, EPOLL_CTL_ADD, streams->changed, &wakes) != 0 ||
        pthread_create(&streams->thread, NULL, run, streams) != 0) {
        release(streams);
        return NULL;
    }
    return streams;
}

void srv_streams_free(srv_streams *streams)
{
    if (streams == NULL) {
        return;
    }
    pthread_mutex_lock(&streams->lock);
    streams->ending = true;
    pthread_mutex_unlock(&streams->lock);
    wake_thread(streams);
    pthread_join(streams->thread, NULL);
    release(streams);
}

/* --- one stream --- */

static void wake(void *context)
{
    srv_stream *stream = context;
    srv_streams *streams = stream->streams;
    pthread_mutex_lock(&streams->lock);
    if (stream->aside) {
        bool first = streams->ready == NULL;
        make_ready(streams, stream);
        if (first) {
            wake_thread(streams);
        }
    } else {
        stream->woken = true;
    }
    pthread_mutex_unlock(&streams->lock);
}

void srv_stream_begin(srv_streams *streams, srv_stream *stream, const api_source *source,
                      int socket, void (*resume)(srv_stream *stream))
{
    *stream =
        (srv_stream){.streams = streams, .source = source, .resume = resume, .socket = socket};
    /* The event that the client has closed its side is edge-triggered, so it is reported only once.
     * If the socket cannot be watched, that is noticed when the second heartbeat cannot be sent. */
    struct epoll_event closed = {.events = EPOLLRDHUP | EPOLLET, .data.ptr = stream};
    if (socket >= 0 && epoll_ctl(streams->watch, EPOLL_CTL_ADD, socket, &closed) != 0) {
        stream->socket = -1;
    }
    source->start(source->self, wake, stream);
}

void srv_stream_end(srv_stream *stream)
{
    srv_streams *streams = stream->streams;
    if (streams != NULL && stream->socket >= 0) {
        pthread_mutex_lock(&streams->lock);
        epoll_ctl(streams->watch, EPOLL_CTL_DEL, stream->socket, NULL);
        pthread_mutex_unlock(&streams->lock);
    }
}

int64_t srv_stream_read(srv_stream *stream, char *buffer, size_t size)
{
    const api_source *source = stream->source;
    pthread_mutex_lock(&stream->streams->lock);
    bool stopping = stream->streams->stopping, gone = stream->gone;
    pthread_mutex_unlock(&stream->streams->lock);
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
 * called wake while the worker thread read from the stream, the stream is resumed at once. */
void srv_stream_aside(srv_stream *stream)
{
    srv_streams *streams = stream->streams;
    pthread_mutex_lock(&streams->lock);
    bool alone = streams->first == NULL;
    stream->deadline = st_clock_micros() + streams->heartbeat;
    stream->aside = true;
    add_last(streams, stream);
    bool at_once = stream->woken || stream->gone || (streams->stopping && !stream->finished);
    stream->woken = false;
    if (at_once) {
        make_ready(streams, stream);
    }
    if (at_once || alone) {
        wake_thread(streams);
    }
    pthread_mutex_unlock(&streams->lock);
}

void srv_streams_stop(srv_streams *streams)
{
    pthread_mutex_lock(&streams->lock);
    streams->stopping = true;
    while (streams->first != NULL) {
        make_ready(streams, streams->first);
    }
    wake_thread(streams);
    pthread_mutex_unlock(&streams->lock);
}
