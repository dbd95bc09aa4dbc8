#include "server/access_log.h"

#include "mesh/mem.h"
#include "server/clock.h"

#include <errno.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct srv_access_log {
    int fd;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    bool ending;
    srv_access *ring;
    size_t capacity, first, count;
    uint64_t dropped;
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

static void append_member(char line[SRV_LOG_LINE], size_t *at, const char *name, const char *value)
{
    int length = snprintf(line + *at, SRV_LOG_LINE - *at, "\"%s\":\"", name);
    *at += (size_t)length;
    append_text(line, at, value);
    line[(*at)++] = '"';
    line[(*at)++] = ',';
}

/* The fields are bounded so that SRV_LOG_LINE holds a path of escapes only; a request id has been
 * checked and a method is a token. */
size_t srv_access_format(const srv_access *access, char line[SRV_LOG_LINE])
{
    char time[SRV_TIMESTAMP];
    srv_clock_format(access->time, time);
    size_t at = 0;
    line[at++] = '{';
    append_member(line, &at, "time", time);
    append_member(line, &at, "request_id", access->request_id);
    append_member(line, &at, "method", access->method);
    append_member(line, &at, "path", access->path);
    append_member(line, &at, "route", access->route == NULL ? "-" : access->route);
    int length = snprintf(line + at, SRV_LOG_LINE - at,
                          "\"status\":%d,\"bytes_in\":%" PRIu64 ",\"bytes_out\":%" PRIu64
                          ",\"duration_us\":%" PRIu64 ",\"peer\":\"%s\"}\n",
                          access->status, access->bytes_in, access->bytes_out, access->duration_us,
                          access->peer);
    return at + (size_t)length;
}

/* A log that cannot be written to is not a reason to stop serving. */
static void write_all(int fd, const char *bytes, size_t length)
{
    while (length > 0) {
        ssize_t written = write(fd, bytes, length);
        if (written < 0 && errno != EINTR) {
            return;
        }
        if (written > 0) {
            bytes += written;
            length -= (size_t)written;
        }
    }
}

static void write_dropped(int fd, uint64_t dropped)
{
    char time[SRV_TIMESTAMP], line[96];
    srv_clock_format(srv_clock_utc(), time);
    int length =
        snprintf(line, sizeof line, "{\"time\":\"%s\",\"dropped\":%" PRIu64 "}\n", time, dropped);
    write_all(fd, line, (size_t)length);
}

static void *run(void *context)
{
    srv_access_log *log = context;
    char lines[8 * SRV_LOG_LINE];
    pthread_mutex_lock(&log->lock);
    for (;;) {
        while (log->count == 0 && log->dropped == 0 && !log->ending) {
            pthread_cond_wait(&log->wake, &log->lock);
        }
        if (log->count == 0 && log->dropped == 0) {
            break;
        }
        uint64_t dropped = log->dropped;
        log->dropped = 0;
        size_t at = 0;
        while (log->count > 0 && at + SRV_LOG_LINE <= sizeof lines) {
            srv_access next = log->ring[log->first];
            log->first = (log->first + 1) % log->capacity;
            log->count--;
            pthread_mutex_unlock(&log->lock);
            at += srv_access_format(&next, lines + at);
            pthread_mutex_lock(&log->lock);
        }
        pthread_mutex_unlock(&log->lock);
        write_all(log->fd, lines, at);
        if (dropped > 0) {
            write_dropped(log->fd, dropped);
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
    pthread_cond_init(&log->wake, NULL);
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
    log->ending = true;
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
    /* Woken once a batch: while it writes it will look again by itself. */
    if (log->count == 1 || log->dropped == 1) {
        pthread_cond_signal(&log->wake);
    }
    pthread_mutex_unlock(&log->lock);
}
