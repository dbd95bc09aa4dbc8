#define _GNU_SOURCE /* F_GETPIPE_SZ */

#include "server/log/log.h"

#include "base/mem.h"
#include "system/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    /* Longest time, in milliseconds, that the line of a request waits for other lines. */
    GATHER_MILLIS = 20,
    /* Size of the buffer in which lines of requests are collected. It is what a pipe holds by
     * default, so that one write fills an empty pipe. */
    COLLECTED = 64 * 1024,
    MOST_OF_ENTRY = 2 * SRV_ACCESS_LINE, /* the most bytes that one entry adds to the buffer */
    POLL_MILLIS = 100,
    ENDING_MILLIS = 500,
    LEAST_ENTRIES = 256,
    MOST_ENTRIES = 8192,
    RING_SHARE = 64 /* the ring may take a part of the memory budget: the budget divided by this */
};

/* One entry of the ring: a line of the daemon itself, or the record of a request. */
typedef struct entry {
    char *line; /* owned by the ring; NULL if the entry is the record of a request, `access` */
    size_t length;
    srv_access access;
    /* usual: the line about the request is written; slow: the line about where its time went,
     * too. */
    bool usual, slow;
} entry;

struct srv_log {
    int fd;
    size_t whole; /* the most bytes that are written to `fd` at once: see whole_of */
    _Atomic int level;
    _Atomic bool json, requests;
    _Atomic uint64_t slow_us;
    pthread_mutex_t lock;
    pthread_cond_t wake;
    _Atomic bool ending;
    /* True if the ring holds a line that is not about a request. Such a line is written without
     * delay. */
    bool urgent;
    entry *ring;
    size_t capacity, first, count;
    uint64_t dropped; /* number of dropped lines that no line in the log has reported yet */
    _Atomic uint64_t all_dropped;
    /* How often the log's thread has polled in vain since `ending` became true; used by that thread
     * only. */
    int waited;
    pthread_t thread;
};

/* Returns how many bytes the descriptor of the log takes now without blocking, or 0 if it took none
 * for POLL_MILLIS. A pipe that is ready takes PIPE_BUF bytes, and an empty one all that it holds. A
 * file takes any number. */
static size_t room_in(const srv_log *log)
{
    struct pollfd out = {.fd = log->fd, .events = POLLOUT};
    int queued = 0;
    if (log->whole == SIZE_MAX) {
        return SIZE_MAX;
    }
    if (log->whole > PIPE_BUF && ioctl(log->fd, FIONREAD, &queued) == 0 && queued == 0) {
        return log->whole;
    }
    return poll(&out, 1, POLL_MILLIS) == 0 ? 0 : PIPE_BUF;
}

/* Returns the most bytes that are written to a descriptor at once: the size of a pipe, no limit for
 * a file, and PIPE_BUF for anything else. */
static size_t whole_of(int fd)
{
    struct stat about;
    const int size = fcntl(fd, F_GETPIPE_SZ);
    if (size > PIPE_BUF) {
        return (size_t)size;
    }
    return fstat(fd, &about) == 0 && S_ISREG(about.st_mode) ? SIZE_MAX : PIPE_BUF;
}

/* Writes bytes to the descriptor of the log. On an error they are lost, and the server goes on.
 * While nothing can be written because the log is not read, this waits, but only ENDING_MILLIS once
 * the log ends. */
static void write_all(srv_log *log, const char *bytes, size_t length)
{
    while (length > 0 && log->waited < ENDING_MILLIS / POLL_MILLIS) {
        const size_t room = room_in(log);
        if (room == 0) {
            log->waited += atomic_load(&log->ending) ? 1 : 0;
            continue;
        }
        ssize_t written = write(log->fd, bytes, length < room ? length : room);
        if (written < 0 && errno != EINTR && errno != EAGAIN) {
            return;
        }
        if (written > 0) {
            bytes += written;
            length -= (size_t)written;
        }
    }
}

static void write_dropped(srv_log *log, uint64_t dropped)
{
    char time[ST_TIMESTAMP], line[160];
    st_clock_format(st_clock_utc(), time);
    int length = snprintf(line, sizeof line,
                          atomic_load(&log->json)
                              ? "{\"time\":\"%s\",\"level\":\"warning\",\"event\":\"dropped\","
                                "\"dropped\":%" PRIu64 "}\n"
                              : "%s warning %" PRIu64
                                " lines were dropped, because they were not read in time\n",
                          time, dropped);
    write_all(log, line, (size_t)length);
}

/* Waits until there are entries in the ring. Because waking the log's thread takes a worker thread
 * longer than adding a record, the thread is woken by the first record and then waits for more
 * records before it writes them. The caller holds the lock. Returns false when everything is
 * written and the log ends. */
static bool wait_for_entries(srv_log *log)
{
    while (log->count == 0 && log->dropped == 0 && !atomic_load(&log->ending)) {
        pthread_cond_wait(&log->wake, &log->lock);
    }
    const uint64_t until = st_clock_micros() + GATHER_MILLIS * 1000;
    bool in_time = true;
    while (in_time && !log->urgent && log->count < log->capacity / 2 &&
           !atomic_load(&log->ending)) {
        in_time = st_clock_wait(&log->wake, &log->lock, until);
    }
    log->urgent = false;
    return log->count > 0 || log->dropped > 0;
}

/* Writes an entry. If it is a line of the daemon itself, writes the *at bytes in `room`, and then
 * the line; if it is the record of a request, appends its lines to `room`. */
static void write_entry(srv_log *log, entry *e, char room[COLLECTED], size_t *at)
{
    const bool json = atomic_load(&log->json);
    if (e->line != NULL) {
        write_all(log, room, *at);
        *at = 0;
        write_all(log, e->line, e->length);
        he_mem_free(e->line);
        e->line = NULL;
        return;
    }
    *at += e->usual ? srv_access_format(&e->access, json, room + *at) : 0;
    *at += e->slow ? srv_access_format_slow(&e->access, json, room + *at) : 0;
}

/* The function of the log's thread: writes the entries of the ring. No other thread touches an
 * entry in the ring until the log's thread has subtracted it from `count`. */
static void *run(void *context)
{
    srv_log *log = context;
    char lines[COLLECTED];
    pthread_mutex_lock(&log->lock);
    while (wait_for_entries(log)) {
        size_t count = log->count, first = log->first;
        uint64_t dropped = log->dropped;
        log->dropped = 0;
        pthread_mutex_unlock(&log->lock);
        for (size_t taken = 0; taken < count;) {
            size_t at = 0, batch = 0;
            for (; at + MOST_OF_ENTRY <= sizeof lines && taken + batch < count; batch++) {
                write_entry(log, &log->ring[(first + taken + batch) % log->capacity], lines, &at);
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

size_t srv_log_capacity(uint64_t budget)
{
    const uint64_t count = budget / RING_SHARE / sizeof(entry);
    return budget == 0 || count > MOST_ENTRIES ? MOST_ENTRIES
           : count < LEAST_ENTRIES             ? LEAST_ENTRIES
                                               : (size_t)count;
}

srv_log *srv_log_new(int fd, size_t capacity, const srv_log_settings *settings)
{
    srv_log *log = he_mem_zero(1, sizeof *log);
    if (log == NULL) {
        return NULL;
    }
    log->fd = fd;
    log->whole = whole_of(fd);
    log->capacity = capacity;
    log->ring = he_mem_zero(capacity, sizeof *log->ring);
    srv_log_set(log, settings);
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

void srv_log_free(srv_log *log)
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

void srv_log_set(srv_log *log, const srv_log_settings *settings)
{
    atomic_store(&log->level, settings->level);
    atomic_store(&log->json, settings->json);
    atomic_store(&log->requests, settings->requests);
    atomic_store(&log->slow_us, settings->slow_us);
}

srv_log_settings srv_log_get(const srv_log *log)
{
    return (srv_log_settings){
        .level = (srv_level)atomic_load(&log->level),
        .json = atomic_load(&log->json),
        .requests = atomic_load(&log->requests),
        .slow_us = atomic_load(&log->slow_us),
    };
}

uint64_t srv_log_dropped(const void *log)
{
    return atomic_load_explicit(&((const srv_log *)log)->all_dropped, memory_order_relaxed);
}

/* Counts a line that is dropped. The caller holds the lock. */
static void drop(srv_log *log)
{
    log->dropped++;
    atomic_fetch_add_explicit(&log->all_dropped, 1, memory_order_relaxed);
}

/* Returns a new entry of the ring. If the ring is full, counts a dropped line and returns NULL. The
 * caller holds the lock. */
static entry *take_entry(srv_log *log)
{
    if (log->count == log->capacity) {
        drop(log);
        return NULL;
    }
    return &log->ring[(log->first + log->count++) % log->capacity];
}

static void wake(srv_log *log)
{
    if (log->urgent || log->count == 1 || log->count == log->capacity / 2 || log->dropped == 1) {
        pthread_cond_signal(&log->wake);
    }
}

/* Puts a line into the ring, which then owns the text, and wakes the log's thread. If memory for
 * the text was out or the ring is full, the line is counted as dropped. */
static void add_line(srv_log *log, api_text *text)
{
    pthread_mutex_lock(&log->lock);
    if (text->failed) {
        drop(log);
    } else {
        entry *e = take_entry(log);
        if (e != NULL) {
            e->line = text->bytes;
            e->length = text->length;
            *text = (api_text){0};
        }
    }
    log->urgent = true;
    wake(log);
    pthread_mutex_unlock(&log->lock);
    api_text_clear(text);
}

static void begin(const srv_log *log, srv_line *line, srv_level level, const char *format,
                  va_list values)
{
    srv_line_begin(line, atomic_load(&log->json), level, format, values);
}

void srv_log_tell(srv_log *log, srv_level level, const char *format, ...)
{
    srv_line line;
    va_list values;
    va_start(values, format);
    begin(log, &line, level, format, values);
    va_end(values);
    srv_log_end(log, &line);
}

__attribute__((format(printf, 4, 5))) static void
begin_with(const srv_log *log, srv_line *line, srv_level level, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    begin(log, line, level, format, values);
    va_end(values);
}

void srv_log_begin(const srv_log *log, srv_line *line, srv_level level, const char *message)
{
    begin_with(log, line, level, "%s", message);
}

void srv_log_end(srv_log *log, srv_line *line)
{
    srv_line_end(line);
    if ((int)line->level <= atomic_load(&log->level)) {
        add_line(log, &line->text);
    }
    srv_line_clear(line);
}

void srv_log_plain(srv_log *log, const char *format, ...)
{
    char bytes[SRV_MESSAGE];
    api_text text = {0};
    va_list values;
    va_start(values, format);
    vsnprintf(bytes, sizeof bytes, format, values);
    va_end(values);
    api_text_add_string(&text, bytes);
    api_text_add_char(&text, '\n');
    add_line(log, &text);
}

void srv_log_request(srv_log *log, const srv_access *access, bool slow)
{
    const bool usual = atomic_load(&log->requests);
    if (!usual && !slow) {
        return;
    }
    pthread_mutex_lock(&log->lock);
    entry *e = take_entry(log);
    if (e != NULL) {
        e->access = *access;
        e->usual = usual;
        e->slow = slow;
    }
    wake(log);
    pthread_mutex_unlock(&log->lock);
}
