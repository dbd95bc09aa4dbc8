/* line.h - formats one line of the log, as JSON or as text for people.
 *
 *     {"time":"2026-01-31T12:00:00.000Z","level":"info","message":"started","port":80}
 *     2026-01-31T12:00:00.000Z info started port=80
 *
 * The fields follow the message in the order in which they are added. */
#ifndef HE_SERVER_LOG_LINE_H
#define HE_SERVER_LOG_LINE_H

#include "api/json/json_out.h"

#include <stdarg.h>

typedef enum srv_level {
    SRV_LEVEL_ERROR,   /* something does not work: an operator must act */
    SRV_LEVEL_WARNING, /* something works, but not as it was configured to work */
    SRV_LEVEL_INFO,    /* starts, stops, reloads: for every operator */
    SRV_LEVEL_DEBUG    /* for finding the cause of a problem */
} srv_level;

const char *srv_level_name(srv_level level); /* returns "error", ... */

/* A line that is being written. It is {0} until srv_line_begin is called. */
typedef struct srv_line {
    api_text text;
    api_out out; /* writes the JSON format */
    srv_level level;
    bool json;
} srv_line;

/* Begins a line with a message in the format of printf, cut at SRV_MESSAGE bytes. */
enum { SRV_MESSAGE = 1024 };
void srv_line_begin(srv_line *line, bool json, srv_level level, const char *format, va_list values);

void srv_line_text(srv_line *line, const char *name, const char *value);
void srv_line_number(srv_line *line, const char *name, uint64_t value);
/* Begins an object: in the JSON format, the fields added before srv_line_close is called are
 * members of an object with this name. Does nothing in the text format. */
void srv_line_open(srv_line *line, const char *name);
void srv_line_close(srv_line *line);

/* Ends the line: line->text then contains the whole line with a line feed, unless memory was out.
 */
void srv_line_end(srv_line *line);
void srv_line_clear(srv_line *line);

/* Formats a line that consists of a message, and writes it to `fd` at once. It is for times when
 * the program has no log (log.h) yet. */
void srv_line_write(int fd, bool json, srv_level level, const char *message);

#endif
