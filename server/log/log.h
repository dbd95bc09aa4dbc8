/* log.h - the log on standard error. A slow reader of the log never delays requests.
 *
 * Lines and records of requests go into a ring buffer of fixed size; the log's own thread formats
 * and writes them in their order. While the ring is full, further lines and records are dropped;
 * afterwards a line says how many:
 *     {"time":"...","level":"warning","event":"dropped","dropped":12}
 *
 * In the JSON format every line is an object, except those of srv_log_plain. No code that has a
 * token or a ticket passes it to this module. */
#ifndef HE_SERVER_LOG_LOG_H
#define HE_SERVER_LOG_LOG_H

#include "server/log/access.h"
#include "server/log/line.h"

typedef struct srv_log srv_log;

/* Settings that may change while the log is in use. */
typedef struct srv_log_settings {
    /* The least severe level that is written; lines about requests have no level and are not
     * affected. */
    srv_level level;
    bool json;
    bool requests; /* whether a line is written for each request */
    /* Requests that took longer than this many microseconds get a line that says where the time
     * went; 0: no request does. */
    uint64_t slow_us;
} srv_log_settings;

/* Returns how many entries the ring of a daemon with this memory budget should have: as many as fit
 * into a sixty-fourth of the budget, but at least a minimum and at most a maximum. `budget` is in
 * bytes, or 0 if there is none. */
size_t srv_log_capacity(uint64_t budget);
/* Makes a log that writes to `fd`, which it borrows. Returns NULL when memory or threads are
 * out. */
srv_log *srv_log_new(int fd, size_t capacity, const srv_log_settings *settings);
/* Writes what is left in the ring, waits at most half a second for a slow reader of `fd`, and frees
 * the log, which may be NULL. */
void srv_log_free(srv_log *log);

/* All functions below may be called by any thread at any time. */

/* Returns how many lines were dropped so far. `log` is a srv_log. */
uint64_t srv_log_dropped(const void *log);

void srv_log_set(srv_log *log, const srv_log_settings *settings);
srv_log_settings srv_log_get(const srv_log *log);

/* Writes a line that consists only of a message. */
void srv_log_tell(srv_log *log, srv_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* These functions write a line with fields: the caller calls srv_log_begin, then srv_line_text or
 * other functions of line.h, then srv_log_end, which puts the line into the ring and clears
 * `line`. */
void srv_log_begin(const srv_log *log, srv_line *line, srv_level level, const char *message);
void srv_log_end(srv_log *log, srv_line *line);
/* Writes a line unchanged, in both formats and at every level, for programs that wait for it. */
void srv_log_plain(srv_log *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Logs a request that has ended: a line about the request, if the settings say so, and another line
 * that says where its time went, if `slow` is set. */
void srv_log_request(srv_log *log, const srv_access *access, bool slow);

#endif
