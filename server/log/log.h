/* log.h - what the daemon says on standard error, without making anybody wait for its reader.
 *
 * Lines and records of requests are put into a bounded ring; a thread of the log's own formats and
 * writes them, in the order in which they came. When the reader of the log is slow, they are
 * dropped and counted, and a line says how many:
 *     {"time":"...","level":"warning","event":"dropped","dropped":12}
 *
 * In the JSON format every line is an object, but those of srv_log_plain. What a token or a ticket
 * is never gets here: nobody who has one hands it to this module. */
#ifndef HE_SERVER_LOG_LOG_H
#define HE_SERVER_LOG_LOG_H

#include "server/log/access.h"
#include "server/log/line.h"

typedef struct srv_log srv_log;

/* What may change while the log is in use. */
typedef struct srv_log_settings {
    srv_level level; /* lines below it are not written; those of requests have no part in that */
    bool json;
    bool requests;    /* a line for each */
    uint64_t slow_us; /* requests that took longer get a line of where the time went; 0: none do */
} srv_log_settings;

/* Writes to `fd`, borrowed. NULL when memory or threads are out. */
srv_log *srv_log_new(int fd, size_t capacity, const srv_log_settings *settings);
/* Writes what is left, for half a second at most. NULL is accepted. */
void srv_log_free(srv_log *log);

/* Any thread may call what follows, at any time. */

void srv_log_set(srv_log *log, const srv_log_settings *settings);
srv_log_settings srv_log_get(const srv_log *log);

/* A line that is a message alone. */
void srv_log_tell(srv_log *log, srv_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* A line with fields: begin, srv_line_text and the others of line.h, end, which puts it into the
 * ring and clears it. */
void srv_log_begin(const srv_log *log, srv_line *line, srv_level level, const char *message);
void srv_log_end(srv_log *log, srv_line *line);
/* A line as it is, in either format and at every level, for programs that wait for it. */
void srv_log_plain(srv_log *log, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A request that has ended: a line where requests have one, and another where `slow`. */
void srv_log_request(srv_log *log, const srv_access *access, bool slow);

#endif
