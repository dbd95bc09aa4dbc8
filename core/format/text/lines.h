/* lines.h - lines and tokens of a text format that arrives in pieces.
 *
 * he_lines cuts the pieces into lines and gives each to a function, in place when the piece holds
 * all of it. Lines end in LF or CRLF, or all in CR alone where the first does; the last one may end
 * in nothing. With `joins`, a backslash
 * before the line end continues the line; the backslash and the line end then stay in the text,
 * where the token functions take them for a blank, so that the line number of any token can still
 * be told. A UTF-8 byte order mark is passed over, UTF-16 refused.
 *
 * What is kept between pieces is the unfinished line, in one block that grows by doubling; a
 * comment is not kept. All is linear in the bytes, whatever the pieces. */
#ifndef HE_FORMAT_TEXT_LINES_H
#define HE_FORMAT_TEXT_LINES_H

#include "base/mem.h"

#include <stdbool.h>

/* [begin, end) without the line end. */
typedef struct he_line {
    const char *begin, *end;
    uint64_t number; /* of its first byte, from 1 */
} he_line;

typedef he_status he_line_take(void *context, const he_line *line, he_error *err);

typedef struct he_lines {
    bool joins;
    uint64_t limit; /* bytes of an unfinished line, 0 for none */
    he_line_take *take;
    void *context;
    char *rest; /* the unfinished line */
    size_t length, capacity;
    uint64_t number; /* of the line that is being collected */
    uint64_t joined; /* line ends inside it */
    bool in_comment; /* the unfinished line is a comment and not kept */
    /* what ends the first line, and so all */
    enum { HE_ENDS_UNKNOWN, HE_ENDS_FEED, HE_ENDS_RETURN } ends;
    bool returned; /* carriage returns are the last that came, and that is unknown yet */
} he_lines;

void he_lines_init(he_lines *lines, he_line_take *take, void *context);
void he_lines_clear(he_lines *lines);
/* The end of the first line of some bytes, behind what may end it, for who has to feed what comes
 * line by line, since other things than text follow. */
static inline const char *he_line_stop(const char *p, const char *end)
{
    while (p < end && *p != '\n' && *p != '\r') {
        p++;
    }
    return p < end ? p + 1 : end;
}
/* HE_LIMIT, HE_NO_MEMORY, HE_UNSUPPORTED for UTF-16, HE_SYNTAX for a NUL, or what `take`
 * returns. */
HE_NODISCARD he_status he_lines_feed(he_lines *lines, const void *bytes, size_t n, he_error *err);
/* The number of the last line that has come, comments included; 1 while there is none. */
uint64_t he_lines_last(const he_lines *lines);
/* Give out the last line if it had no line end. */
HE_NODISCARD he_status he_lines_finish(he_lines *lines, he_error *err);

/* The end of a continuation that starts at `p`, else NULL. */
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

/* Nothing but a comment follows; `p` is past blanks. */
static inline bool he_at_end(const char *p, const char *end)
{
    return p == end || *p == '#';
}

/* Does a token end at `p`? */
static inline bool he_token_ends(const char *p, const char *end)
{
    return p == end || *p == ' ' || *p == '\t' || *p == '#' ||
           (*p == '\\' && he_continuation(p, end) != NULL);
}

/* The end of the token that starts at `p`. */
static inline const char *he_token_end(const char *p, const char *end)
{
    while (!he_token_ends(p, end)) {
        p++;
    }
    return p;
}

/* The number of the line that holds `p`. */
uint64_t he_line_number(const he_line *line, const char *p);
/* he_fail_at that line. */
he_status he_line_fail(he_error *err, he_status status, const he_line *line, const char *p,
                       const char *format, ...) __attribute__((format(printf, 5, 6)));
/* Give a failure without a place, such as a resource that ran out, that of the line. Returns it. */
he_status he_line_locate(he_status status, const he_line *line, he_error *err);
/* he_line_fail about the token at `p`, which is quoted: "'abc' is not a number". */
he_status he_token_fail(he_error *err, he_status status, const he_line *line, const char *p,
                        const char *what);

/* A number that is a whole token; `*p` moves behind it. HE_SYNTAX, HE_NOT_FINITE. */
HE_NODISCARD he_status he_token_number(const he_line *line, const char **p, double *value,
                                       he_error *err);
/* The same where it need not be finite: then `*finite` is false and the value 0. HE_SYNTAX. */
HE_NODISCARD he_status he_token_any_number(const he_line *line, const char **p, double *value,
                                           bool *finite, he_error *err);

#endif
