/* lines.h - lines and tokens of a text format that arrives in pieces.
 *
 * he_lines cuts the pieces into lines and passes each line to a function, without copying it if one
 * piece contains all of it. Lines end in LF or CRLF, or, if the first line ends in CR alone, all in
 * CR alone; the last line may have no line end. With `joins`, a backslash before the line end
 * continues the line; the backslash and the line end then stay in the text, where the token
 * functions treat them as blanks, so that the line number of any token can still be found. A UTF-8
 * byte order mark is skipped, UTF-16 is refused.
 *
 * Between pieces only the unfinished line is kept, in one block that grows by doubling; a comment
 * is not kept. Time is linear in the number of bytes, however the text is cut into pieces. */
#ifndef HE_FORMAT_TEXT_LINES_H
#define HE_FORMAT_TEXT_LINES_H

#include "base/mem.h"

#include <stdbool.h>

/* A line of text: the bytes [begin, end), without the line end. */
typedef struct he_line {
    const char *begin, *end;
    uint64_t number; /* line number of its first byte, from 1 */
} he_line;

typedef he_status he_line_take(void *context, const he_line *line, he_error *err);

typedef struct he_lines {
    bool joins;
    uint64_t limit; /* most bytes of an unfinished line, 0 for no limit */
    he_line_take *take;
    void *context;
    char *rest; /* the unfinished line */
    size_t length, capacity;
    uint64_t number; /* number of the line being collected */
    uint64_t joined; /* number of line ends inside the unfinished line, after backslashes */
    bool in_comment; /* true if the unfinished line is a comment, which is not kept */
    /* How lines end: the end of the first line decides for all. */
    enum { HE_ENDS_UNKNOWN, HE_ENDS_FEED, HE_ENDS_RETURN } ends;
    bool returned; /* true if a carriage return has come, and it is not known yet how lines end */
} he_lines;

void he_lines_init(he_lines *lines, he_line_take *take, void *context);
void he_lines_clear(he_lines *lines);
/* Returns the end of the first line of [p, end), after its line end. It is for callers that must
 * feed one line at a time, because binary data may follow the text. */
static inline const char *he_line_stop(const char *p, const char *end)
{
    while (p < end && *p != '\n' && *p != '\r') {
        p++;
    }
    return p < end ? p + 1 : end;
}
/* Feeds a piece of the text to the lines. Each whole line is passed to `take`.
 * Returns HE_LIMIT if a line is too long.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_UNSUPPORTED if the text is UTF-16.
 * Returns HE_SYNTAX if the text contains a NUL.
 * Returns the error of `take` if that fails. */
HE_NODISCARD he_status he_lines_feed(he_lines *lines, const void *bytes, size_t n, he_error *err);
/* Returns the line number of the last line that was passed to `take`, where comments count as
 * lines; 1 if there is none. */
uint64_t he_lines_last(const he_lines *lines);
/* Passes the last line of the text to `take` if it had no line end. */
HE_NODISCARD he_status he_lines_finish(he_lines *lines, he_error *err);

/* Returns the end of the continuation (a backslash and a line end) that starts at `p`; NULL if no
 * continuation starts there. */
const char *he_continuation(const char *p, const char *end);

static inline const char *he_skip_blanks(const char *p, const char *end)
{
    while (p < end) {
        const char *after;
        if (*p == ' ' || *p == '\t') {
            p++;
        } else if (*p == '\\' && (after = he_continuation(p, end)) != NULL) {
            p = after;
        } else {
            break;
        }
    }
    return p;
}

/* Returns true if the rest of the line is empty or a comment. `p` must point behind the blanks. */
static inline bool he_at_end(const char *p, const char *end)
{
    return p == end || *p == '#';
}

/* Returns true if a token ends at `p`. */
static inline bool he_token_ends(const char *p, const char *end)
{
    return p == end || *p == ' ' || *p == '\t' || *p == '#' ||
           (*p == '\\' && he_continuation(p, end) != NULL);
}

/* Returns the end of the token that starts at `p`. */
static inline const char *he_token_end(const char *p, const char *end)
{
    while (!he_token_ends(p, end)) {
        p++;
    }
    return p;
}

/* Returns the number of the line that contains `p`. */
uint64_t he_line_number(const he_line *line, const char *p);
/* Fails like he_fail_at, with the number of the line that contains `p`. */
he_status he_line_fail(he_error *err, he_status status, const he_line *line, const char *p,
                       const char *format, ...) __attribute__((format(printf, 5, 6)));
/* Adds the number of the line to an error that names no place, such as one for lack of memory.
 * Returns `status`. */
he_status he_line_locate(he_status status, const he_line *line, he_error *err);
/* Fails like he_line_fail, with a message that quotes the token at `p`: "'abc' is not a number". */
he_status he_token_fail(he_error *err, he_status status, const he_line *line, const char *p,
                        const char *what);

/* Reads a token that must be a number; `*p` moves behind it.
 * Returns HE_SYNTAX if the token is no number.
 * Returns HE_NOT_FINITE if the number is not finite. */
HE_NODISCARD he_status he_token_number(const he_line *line, const char **p, double *value,
                                       he_error *err);
/* Reads a number like he_token_number, but accepts numbers that are not finite: for these it sets
 * `*finite` to false and the value to 0.
 * Returns HE_SYNTAX if the token is no number. */
HE_NODISCARD he_status he_token_any_number(const he_line *line, const char **p, double *value,
                                           bool *finite, he_error *err);

#endif
