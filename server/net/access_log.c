#include "server/net/access_log.h"

#include "base/mem.h"
#include "format/text/number.h"
#include "system/clock.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    GATHER_MILLIS = 20, /* a line is written at most this late */
    BATCH = 16,         /* lines formatted at once */
    POLL_MILLIS = 100,
    ENDING_MILLIS = 500
};

struct srv_access_log {
    int fd;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    _Atomic bool ending;
    srv_access *ring;
    size_t capacity, first, count;
    uint64_t dropped;
    int waited; /* polls in vain while it ends; the thread's own */
    pthread_t thread;
};

/* Everything but printable ASCII is escaped byte by byte: what is logged was never decoded. */
static void append_text(char line[SRV_LOG_LINE], size_t *at, const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        if (*at + 8 >= SRV_LOG_LINE) {
            return;
        }
        if (*c < 0x20 || *c >= 0x7F || *c == '"' || *c == '\\') {
            *at += (size_t)snprintf(line + *at, 7, "\\u%04x", (unsigned)*c);
        } else {
            line[(*at)++] = (char)*c;
        }
    }
}

/* What is known to fit and to need no escapes. */
static void append(char line[SRV_LOG_LINE], size_t *at, const char *text)
{
    size_t length = strlen(text);
    assert(*at + length < SRV_LOG_LINE);
    memcpy(line + *at, text, length);
    *at += length;
}

static void append_member(char line[SRV_LOG_LINE], size_t *at, const char *key, const char *value)
{
    append(line, at, key);
    append_text(line, at, value);
    line[(*at)++] = '"';
    line[(*at)++] = ',';
}

static void append_number(char line[SRV_LOG_LINE], size_t *at, const char *key, int64_t value)
{
    append(line, at, key);
    *at += he_i64_print(value, line + *at);
}

/* The fields are bounded so that SRV_LOG_LINE holds a path of escapes only; a request id has been
 * checked and a method is a token. Written without the C library's formats: at the highest rates a
 * line takes its time from the requests. */
size_t srv_access_format(const srv_access *access, char line[SRV_LOG_LINE])
{
    char time[ST_TIMESTAMP];
    st_clock_format(access->time, time);
    size_t at = 0;
    append_member(line, &at, "{\"time\":\"", time);
    append_member(line, &at, "\"request_id\":\"", access->request_id);
    append_member(line, &at, "\"method\":\"", access->method);
    append_member(line, &at, "\"path\":\"", access->path);
    append_member(line, &at, "\"route\":\"", access->route == NULL ? "-" : access->route);
    append_number(line, &at, "\"status\":", access->status);
    append_number(line, &at, ",\"bytes_in\":", (int64_t)access->bytes_in);
    append_number(line, &at, ",\"bytes_out\":", (int64_t)access->bytes_out);
    append_number(line, &at, ",\"duration_us\":", (int64_t)access->duration_us);
    append(line, &at, ",\"peer\":\"");
    append(line, &at, access->peer);
    append(line, &at, "\"}\n");
    line[at] = '\0';
    return at;
}

/* A log that cannot be written to is not a reason to stop serving, and a reader that takes nothing
 * is none to go on for ever: once the log ends, it has a moment. A pipe that is ready takes
 * PIPE_BUF bytes without blocking. */
static void write_all(srv_access_log *log, const char *bytes, size_t length)
{
    while (length > 0 && log->waited < ENDING_MILLIS / POLL_MILLIS) {
        struct pollfd out = {.fd = log->fd, .events = POLLOUT};
        if (poll(&out, 1, POLL_MILLIS) == 0) {
            log->waited += atomic_load(&log->ending) ? 1 : 0;
            continue;
        }
        ssize_t written = write(log->fd, bytes, length < PIPE_BUF ? length : PIPE_BUF);
        if (written < 0 && errno != EINTR && errno != EAGAIN) {
            return;
        }
        if (written > 0) {
            bytes += written;
            length -= (size_t)written;
        }
    }
}

static void write_dropped(srv_access_log *log, uint64_t dropped)
{
    char time[ST_TIMESTAMP], line[96];
    st_clock_format(st_clock_utc(), time);
    int length =
        snprintf(line, sizeof line, "{\"time\":\"%s\",\"dropped\":%" PRIu64 "}\n", time, dropped);
    write_all(log, line, (size_t)length);
}

/* Waking a thread costs a request more than its record does, so the thread is woken for the first
 * one and then lets others gather. Under the lock; false when all is written and the log ends. */
static bool wait_for_records(srv_access_log *log)
{
    while (log->count == 0 && log->dropped == 0 && !atomic_load(&log->ending)) {
        pthread_cond_wait(&log->wake, &log->lock);
    }
    const uint64_t until = st_clock_micros() + GATHER_MILLIS * 1000;
    bool in_time = true;
    while (in_time && log->count < log->capacity / 2 && !atomic_load(&log->ending)) {
        in_time = st_clock_wait(&log->wake, &log->lock, until);
    }
    return log->count > 0 || log->dropped > 0;
}

/* What is in the ring is not touched by others until `count` says that it was taken. */
static void *run(void *context)
{
    srv_access_log *log = context;
    pthread_mutex_lock(&log->lock);
    while (wait_for_records(log)) {
        size_t count = log->count, first = log->first;
        uint64_t dropped = log->dropped;
        log->dropped = 0;
        pthread_mutex_unlock(&log->lock);
        for (size_t taken = 0; taken < count;) {
            char lines[BATCH * SRV_LOG_LINE];
            size_t at = 0, batch = 0;
            for (; batch < BATCH && taken + batch < count; batch++) {
                at += srv_access_format(&log->ring[(first + taken + batch) % log->capacity],
                                        lines + at);
            }
            write_all(log, lines, at);
            taken += batch;
            pthread_mutex_lock(&log->lock);
            log->first = (first + taken) % log->capacity;
            log->count -= batch;
            pthread_mutex_unlock(&log->lock);
        }
        if (dropped > 0) {
            write_dropped(log, dropped);
        }
        pthread_mutex_lock(&log->lock);
    }
    pthread_mutex_unlock(&log->lock);
    return NULL;
}

srv_access_log *srv_access_log_new(int fd, size_t capacity)
{
    srv_access_log *log = he_mem_zero(1, sizeof *log);
    if (log == NULL) {
        return NULL;
    }
    log->fd = fd;
    log->capacity = capacity;
    log->ring = he_mem_zero(capacity, sizeof *log->ring);
    pthread_mutex_init(&log->lock, NULL);
    st_clock_condition(&log->wake);
    if (log->ring == NULL || pthread_create(&log->thread, NULL, run, log) != 0) {
        pthread_mutex_destroy(&log->lock);
        pthread_cond_destroy(&log->wake);
        he_mem_free(log->ring);
        he_mem_free(log);
        return NULL;
    }
    return log;
}

void srv_access_log_free(srv_access_log *log)
{
    if (log == NULL) {
        return;
    }
    pthread_mutex_lock(&log->lock);
    atomic_store(&log->ending, true);
    pthread_cond_signal(&log->wake);
    pthread_mutex_unlock(&log->lock);
    pthread_join(log->thread, NULL);
    pthread_mutex_destroy(&log->lock);
    pthread_cond_destroy(&log->wake);
    he_mem_free(log->ring);
    he_mem_free(log);
}

void srv_access_log_add(srv_access_log *log, const srv_access *access)
{
    pthread_mutex_lock(&log->lock);
    if (log->count == log->capacity) {
        log->dropped++;
    } else {
        log->ring[(log->first + log->count) % log->capacity] = *access;
        log->count++;
    }
    if (log->count == 1 || log->count == log->capacity / 2 || log->dropped == 1) {
        pthread_cond_signal(&log->wake);
    }
    pthread_mutex_unlock(&log->lock);
}
