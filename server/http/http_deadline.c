#define _GNU_SOURCE /* POLLRDHUP */

#include "server/http/http_deadline.h"

#include "base/mem.h"
#include "server/http/http_buffer.h"
#include "server/net/peers.h"
#include "system/clock.h"
#include "system/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/sock_diag.h>
#include <linux/sockios.h>
#include <linux/tcp.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

enum {
    /* Milliseconds between the beginnings of two sweeps over all connections. */
    SWEEP_MILLIS = 500,
    /* Milliseconds for which no further connection is closed after SRV_CLOSES were closed. */
    PAUSE_MILLIS = 10,
    /* Seconds that an idle connection or a handshake may last while there are too many
     * connections. */
    CROWDED_SECONDS = 2,
    /* Most sockets that are drained at one time; further sockets are closed undrained. */
    DRAINS = 64,
    DRAIN_BYTES = 1 << 20 /* most bytes that are drained from a socket */
};

#define SECOND       UINT64_C(1000000)
#define DRAIN_MICROS (2 * SECOND)

typedef struct drain {
    int socket;
    size_t bytes;
    uint64_t until;
} drain;

struct srv_deadlines {
    srv_deadline_options options;
    pthread_mutex_t lock; /* protects the list, the drains and `ending` */
    srv_connection *first;
    srv_connection *next; /* the connection that a sweep checks next; NULL if none is running */
    _Atomic size_t count;
    drain drains[DRAINS];
    size_t drain_count;
    bool ending;
    int wake; /* an eventfd that wakes the thread */
    pthread_t thread;
    /* The members below are used only by the thread that checks connections. */
    uint64_t swept;  /* time at which the last sweep over all connections began */
    uint64_t paused; /* time before which no connection is closed */
};

void srv_connection_enter(srv_connection *c, srv_stage stage, uint64_t now)
{
    if (c != NULL) {
        /* The start time is written before the stage and the bytes, so that a thread that reads the
         * new stage, or zero bytes, also reads the new start time. */
        atomic_store_explicit(&c->since, now, memory_order_relaxed);
        atomic_store_explicit(&c->bytes, 0, memory_order_release);
        atomic_store_explicit(&c->stage, (int)stage, memory_order_release);
    }
}

void srv_connection_moved(srv_connection *c, uint64_t bytes)
{
    if (c != NULL) {
        atomic_fetch_add_explicit(&c->bytes, bytes, memory_order_relaxed);
    }
}

bool srv_connection_is_left(const srv_connection *connection, uint64_t now)
{
    struct pollfd watched = {.fd = connection == NULL ? -1 : connection->socket,
                             .events = POLLRDHUP};
    if (poll(&watched, 1, 0) <= 0) {
        return false;
    }
    uint64_t since = atomic_load_explicit(&connection->since, memory_order_relaxed);
    return (watched.revents & (POLLERR | POLLHUP)) != 0 ||
           ((watched.revents & POLLRDHUP) != 0 && now > since + SRV_CLOSED_MICROS);
}

static bool is_slow(const srv_deadline_options *o, uint64_t elapsed, uint64_t bytes)
{
    if (o->min_rate == 0 || elapsed <= o->grace * SECOND) {
        return false;
    }
    return bytes / o->min_rate < (elapsed - o->grace * SECOND) / SECOND;
}

bool srv_connection_is_late(const srv_connection *c, const srv_deadline_options *o, bool crowded,
                            uint64_t now)
{
    srv_stage stage = (srv_stage)atomic_load_explicit(&c->stage, memory_order_acquire);
    uint64_t bytes = atomic_load_explicit(&c->bytes, memory_order_acquire);
    uint64_t since = atomic_load_explicit(&c->since, memory_order_relaxed);
    uint64_t elapsed = now > since ? now - since : 0;
    crowded = crowded || atomic_load_explicit(&c->beyond, memory_order_relaxed);
    switch (stage) {
    case SRV_STAGE_HANDSHAKE:
        return elapsed > (crowded ? CROWDED_SECONDS : o->head) * SECOND;
    case SRV_STAGE_IDLE:
        return elapsed > (crowded ? CROWDED_SECONDS : o->idle) * SECOND;
    case SRV_STAGE_HEAD:
        return elapsed > o->head * SECOND;
    case SRV_STAGE_BODY:
        return elapsed > o->total * SECOND || is_slow(o, elapsed, bytes);
    case SRV_STAGE_WORK:
    case SRV_STAGE_ANSWER:
    case SRV_STAGE_LIVE:
        break;
    }
    return false;
}

bool srv_connection_is_stuck(srv_connection *c, const srv_deadline_options *o, uint64_t outstanding,
                             uint64_t acknowledged, uint64_t now)
{
    uint64_t elapsed = now - c->window;
    if (outstanding == 0 || o->min_rate == 0) {
        c->window = 0;
        return false;
    }
    if (c->window != 0 && elapsed < o->grace * SECOND) {
        return false;
    }
    bool stuck =
        c->window != 0 && (acknowledged - c->window_acked) / o->min_rate < elapsed / SECOND;
    c->window = now;
    c->window_acked = acknowledged;
    return stuck;
}

static void count_kept(srv_connection *c, uint64_t kept)
{
    st_memory_count((int64_t)kept - (int64_t)c->kept);
    c->kept = kept;
}

/* Returns how many bytes of memory the kernel uses for data of an answer that the client has not
 * read, or 0 if unknown. A TCP socket has such data in its own queue; what is sent on a Unix socket
 * is in the queue of the reader. */
static uint64_t kept_by_kernel(const srv_connection *c)
{
    uint32_t info[SK_MEMINFO_VARS] = {0};
    socklen_t length = sizeof info;
    return getsockopt(c->socket, SOL_SOCKET, SO_MEMINFO, info, &length) == 0
               ? info[c->counts_sent ? SK_MEMINFO_WMEM_ALLOC : SK_MEMINFO_WMEM_QUEUED]
               : 0;
}

/* Sets c->acked to the number of bytes sent so far that the client has received. For a Unix socket
 * it is computed from `outstanding`, which includes the kernel's bookkeeping, so that it may seem
 * to fall while more bytes are waiting; then it stays as it is. Returns false if the kernel does
 * not report the number. */
static bool find_acknowledged(srv_connection *c, uint64_t outstanding)
{
    struct tcp_info info = {0};
    socklen_t length = sizeof info;
    if (c->counts_sent) {
        uint64_t sent = atomic_load_explicit(&c->sent, memory_order_relaxed);
        uint64_t acked = sent > outstanding ? sent - outstanding : 0;
        c->acked = acked > c->acked ? acked : c->acked;
        return true;
    }
    bool told = getsockopt(c->socket, IPPROTO_TCP, TCP_INFO, &info, &length) == 0;
    c->acked = told ? info.tcpi_bytes_acked : c->acked;
    return told;
}

/* Returns true if bytes of an answer may still be in the socket's buffer. In the stage IDLE that is
 * so until a check has found the buffer empty. */
static bool may_wait(const srv_connection *c, int stage, uint64_t since)
{
    return stage == SRV_STAGE_ANSWER || stage == SRV_STAGE_LIVE ||
           (stage == SRV_STAGE_IDLE && c->taken != since);
}

static bool is_answer_stuck(srv_connection *c, const srv_deadline_options *o, uint64_t now)
{
    int outstanding = 0;
    int stage = atomic_load_explicit(&c->stage, memory_order_acquire);
    uint64_t since = atomic_load_explicit(&c->since, memory_order_relaxed);
    if (!may_wait(c, stage, since)) {
        c->window = 0;
        return false;
    }
    if (ioctl(c->socket, SIOCOUTQ, &outstanding) != 0 ||
        !find_acknowledged(c, (uint64_t)outstanding)) {
        return false;
    }
    c->taken = stage == SRV_STAGE_IDLE && outstanding == 0 ? since : 0;
    count_kept(c, outstanding == 0 ? 0 : kept_by_kernel(c));
    const srv_deadline_options patient = {.grace = o->total, .min_rate = 1};
    return srv_connection_is_stuck(c, stage == SRV_STAGE_LIVE ? &patient : o, (uint64_t)outstanding,
                                   c->acked, now);
}

/* Returns true if the client has closed its side before its request was complete. Two checks must
 * find this, with no bytes handled in between, because the handler may still be working on bytes
 * that arrived together with the end of the stream. */
static bool is_request_cut(srv_connection *c)
{
    char byte;
    int stage = atomic_load_explicit(&c->stage, memory_order_acquire);
    if ((stage != SRV_STAGE_HEAD && stage != SRV_STAGE_BODY) ||
        recv(c->socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT) != 0) {
        c->closed = 0;
        return false;
    }
    uint64_t since = atomic_load_explicit(&c->since, memory_order_relaxed);
    uint64_t bytes = atomic_load_explicit(&c->bytes, memory_order_relaxed);
    bool again = c->closed == since && c->closed_bytes == bytes;
    c->closed = since;
    c->closed_bytes = bytes;
    return again;
}

/* Counts a connection that is closed for being too slow. It is counted once, although later sweeps
 * may find it again. */
static void count_late(const srv_deadlines *d, srv_connection *c, bool stuck)
{
    const int stage = atomic_load_explicit(&c->stage, memory_order_relaxed);
    const api_counter which = stuck                     ? API_COUNT_LATE_ANSWER
                              : stage == SRV_STAGE_HEAD ? API_COUNT_LATE_HEAD
                              : stage == SRV_STAGE_BODY ? API_COUNT_LATE_BODY
                                                        : API_COUNT_LATE_IDLE;
    if (!c->late && d->options.metrics != NULL) {
        api_count(d->options.metrics, which);
    }
    c->late = true;
}

/* Closes the connection if it is too slow; returns true if it did. */
static bool look_at(srv_deadlines *d, srv_connection *c, bool crowded, uint64_t now)
{
    bool stuck = is_answer_stuck(c, &d->options, now);
    if (stuck) {
        /* The connection is reset, because otherwise the kernel would still try to send what is in
         * the socket's buffer. */
        struct linger reset = {.l_onoff = 1, .l_linger = 0};
        setsockopt(c->socket, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
        count_late(d, c, true);
    } else if (srv_connection_is_late(c, &d->options, crowded, now)) {
        count_late(d, c, false);
    } else if (!is_request_cut(c)) {
        return false;
    }
    shutdown(c->socket, SHUT_RDWR);
    return true;
}

/* Begins a sweep over all connections when it is time, or continues the sweep in progress, and
 * closes connections that are too slow. The caller holds the lock: so no socket of the list is
 * closed meanwhile, and no descriptor can be that of another socket. Returns the milliseconds until
 * the next call. */
static int sweep(srv_deadlines *d)
{
    uint64_t now = st_clock_micros();
    if (d->next == NULL && now - d->swept >= SWEEP_MILLIS * SECOND / 1000) {
        d->swept = now;
        d->next = d->first;
    }
    if (d->next == NULL) {
        return SWEEP_MILLIS;
    }
    if (now < d->paused) {
        return PAUSE_MILLIS;
    }
    bool crowded = srv_deadlines_count(d) > d->options.max_connections;
    int closes = 0;
    for (int looks = 0; d->next != NULL && looks < SRV_LOOKS && closes < SRV_CLOSES; looks++) {
        srv_connection *c = d->next;
        d->next = c->next;
        closes += look_at(d, c, crowded, now);
    }
    if (closes == SRV_CLOSES) {
        d->paused = now + PAUSE_MILLIS * SECOND / 1000;
        return PAUSE_MILLIS;
    }
    return d->next == NULL ? SWEEP_MILLIS : 0;
}

/* Reads and discards what a client still sends. Returns true when the socket can be closed. */
static bool drain_once(drain *one, uint64_t now)
{
    char buffer[16 * 1024];
    for (;;) {
        ssize_t got = recv(one->socket, buffer, sizeof buffer, MSG_DONTWAIT);
        if (got == 0 || now > one->until) {
            return true;
        }
        if (got < 0) {
            return errno != EAGAIN && errno != EINTR;
        }
        one->bytes += (size_t)got;
        if (one->bytes > DRAIN_BYTES) {
            return true;
        }
    }
}

static void drain_all(srv_deadlines *d)
{
    uint64_t now = st_clock_micros();
    for (size_t i = d->drain_count; i > 0; i--) {
        if (drain_once(&d->drains[i - 1], now)) {
            close(d->drains[i - 1].socket);
            d->drains[i - 1] = d->drains[--d->drain_count];
        }
    }
}

static void *run(void *context)
{
    srv_deadlines *d = context;
    int timeout = SWEEP_MILLIS;
    pthread_mutex_lock(&d->lock);
    d->swept = st_clock_micros();
    while (!d->ending) {
        struct pollfd polls[DRAINS + 1] = {{.fd = d->wake, .events = POLLIN}};
        nfds_t count = 1;
        for (size_t i = 0; i < d->drain_count; i++) {
            polls[count++] = (struct pollfd){.fd = d->drains[i].socket, .events = POLLIN};
        }
        pthread_mutex_unlock(&d->lock);
        poll(polls, count, timeout);
        uint64_t ignored;
        if (polls[0].revents != 0 && read(d->wake, &ignored, sizeof ignored) < 0) {
            /* The eventfd had nothing to read. That does no harm: the thread checks the list of
             * connections anyway. */
        }
        pthread_mutex_lock(&d->lock);
        drain_all(d);
        timeout = sweep(d);
    }
    pthread_mutex_unlock(&d->lock);
    return NULL;
}

static void wake(srv_deadlines *d)
{
    uint64_t one = 1;
    if (write(d->wake, &one, sizeof one) < 0) {
        /* The eventfd's counter is full, so the thread will wake up anyway. */
    }
}

srv_deadlines *srv_deadlines_new(const srv_deadline_options *options)
{
    srv_deadlines *d = he_mem_zero(1, sizeof *d);
    if (d == NULL) {
        return NULL;
    }
    d->options = *options;
    pthread_mutex_init(&d->lock, NULL);
    d->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (d->wake < 0 || pthread_create(&d->thread, NULL, run, d) != 0) {
        if (d->wake >= 0) {
            close(d->wake);
        }
        pthread_mutex_destroy(&d->lock);
        he_mem_free(d);
        return NULL;
    }
    return d;
}

void srv_deadlines_free(srv_deadlines *d)
{
    if (d == NULL) {
        return;
    }
    pthread_mutex_lock(&d->lock);
    d->ending = true;
    pthread_mutex_unlock(&d->lock);
    wake(d);
    pthread_join(d->thread, NULL);
    for (size_t i = 0; i < d->drain_count; i++) {
        close(d->drains[i].socket);
    }
    close(d->wake);
    pthread_mutex_destroy(&d->lock);
    he_mem_free(d);
}

srv_connection *srv_deadlines_add(srv_deadlines *d, int socket, const struct sockaddr *peer,
                                  gnutls_session_t session, uint32_t buffer)
{
    srv_connection *c = he_mem_zero(1, sizeof *c);
    if (c == NULL) {
        return NULL;
    }
    c->socket = socket;
    c->session = session;
    c->metrics = d->options.metrics;
    c->counts_sent = peer->sa_family == AF_UNIX;
    c->of_peer = SRV_NO_PEER;
    c->buffer = buffer;
    srv_buffer_rest(buffer, st_clock_micros());
    srv_address_of_peer(socket, peer, c->peer);
    c->client = srv_address_key(c->peer);
    srv_connection_enter(c, session == NULL ? SRV_STAGE_IDLE : SRV_STAGE_HANDSHAKE,
                         st_clock_micros());
    pthread_mutex_lock(&d->lock);
    c->next = d->first;
    if (c->next != NULL) {
        c->next->previous = c;
    }
    d->first = c;
    pthread_mutex_unlock(&d->lock);
    atomic_fetch_add_explicit(&d->count, 1, memory_order_relaxed);
    return c;
}

/* Begins to drain a connection. A duplicate of the socket is drained, because the connection then
 * stays open although libmicrohttpd closes the socket. */
static void begin_drain(srv_deadlines *d, int socket)
{
    if (d->drain_count == DRAINS || d->ending) {
        return;
    }
    int duplicate = fcntl(socket, F_DUPFD_CLOEXEC, 0);
    if (duplicate >= 0) {
        shutdown(duplicate, SHUT_WR);
        d->drains[d->drain_count++] =
            (drain){.socket = duplicate, .until = st_clock_micros() + DRAIN_MICROS};
        wake(d);
    }
}

void srv_deadlines_remove(srv_deadlines *d, srv_connection *c)
{
    if (c == NULL) {
        return;
    }
    pthread_mutex_lock(&d->lock);
    if (c->previous != NULL) {
        c->previous->next = c->next;
    } else {
        d->first = c->next;
    }
    if (c->next != NULL) {
        c->next->previous = c->previous;
    }
    if (d->next == c) {
        d->next = c->next;
    }
    count_kept(c, 0);
    if (c->drain) {
        begin_drain(d, c->socket);
    }
    pthread_mutex_unlock(&d->lock);
    atomic_fetch_sub_explicit(&d->count, 1, memory_order_relaxed);
    he_mem_free(c);
}

size_t srv_deadlines_count(const srv_deadlines *d)
{
    return atomic_load_explicit(&d->count, memory_order_relaxed);
}
