#include "server/http/syntax/http_syntax.h"

#include "api/limits.h"
#include "server/http/syntax/http_character.h"

#include <string.h>

typedef enum state {
    START,
    START_LF, /* expects the LF of an empty line before a request */
    METHOD,
    TARGET,
    VERSION,
    LINE_LF,
    FIELD, /* expects a header line, or the empty line that ends the headers */
    NAME,
    VALUE,
    VALUE_LF,
    HEAD_LF, /* expects the LF of the empty line after headers or trailers */
    BODY,
    CHUNK_SIZE,
    CHUNK_EXTENSION,
    CHUNK_LF,
    CHUNK_DATA,
    CHUNK_END,
    CHUNK_END_LF
} state;

/* The headers whose values are checked. */
typedef enum field { OTHER, HOST, ORIGIN, AUTHORIZATION, LENGTH, CODING } field;

typedef enum phase { BEFORE, WITHIN, AFTER } phase;

static const char version[] = "HTTP/1.1\r\n\r\n";

enum { MAJOR = 5, MINOR = 7, VERSION_END = 8, TLS_HANDSHAKE = 0x16 };

/* --- reading one part of a request --- */

/* Each of these functions reads from `at`, at most to `end`, and returns the position where it
 * stopped: there the next function continues, or s->fault is set and the byte there is faulty. */

static char *fail(srv_syntax *s, char *at, srv_fault fault)
{
    s->fault = (uint8_t)fault;
    return at;
}

/* Returns the fault of a character that is not allowed where it stands in a line: SRV_FAULT_BARE_LF
 * for a line feed, `otherwise` for any other character. */
static srv_fault line_fault(char c, srv_fault otherwise)
{
    return c == '\n' ? SRV_FAULT_BARE_LF : otherwise;
}

static char *read_lf(srv_syntax *s, char *at, state next)
{
    if (*at != '\n') {
        return fail(s, at, SRV_FAULT_BARE_CR);
    }
    s->state = (uint8_t)next;
    return at + 1;
}

/* Begins a request. The state changes from START to METHOD or START_LF. */
static char *begin(srv_syntax *s, char *at)
{
    if (*at == '\r') {
        if (s->empty_lines == SRV_MAX_EMPTY_LINES) {
            return fail(s, at, SRV_FAULT_EMPTY_LINES);
        }
        s->empty_lines++;
        s->state = START_LF;
        return at + 1;
    }
    if (!srv_is_token(*at)) {
        return fail(s, at,
                    *at == TLS_HANDSHAKE ? SRV_FAULT_TLS : line_fault(*at, SRV_FAULT_METHOD));
    }
    *s = (srv_syntax){.state = METHOD, .requests = s->requests + 1};
    return at;
}

/* Reads the method. The state changes from METHOD to TARGET. */
static char *read_method(srv_syntax *s, char *at, const char *end)
{
    for (; at < end && srv_is_token(*at); at++) {
        if (s->method == SRV_MAX_METHOD) {
            return fail(s, at, SRV_FAULT_LONG_METHOD);
        }
        s->method++;
    }
    if (at == end) {
        return at;
    }
    if (*at != ' ') {
        return fail(s, at, line_fault(*at, SRV_FAULT_METHOD));
    }
    s->state = TARGET;
    return at + 1;
}

/* Reads the request target. The state changes from TARGET to VERSION. */
static char *read_target(srv_syntax *s, char *at, const char *end)
{
    for (; at < end && srv_is_target(*at); at++) {
        if (s->target == API_MAX_URI) {
            return fail(s, at, SRV_FAULT_LONG_TARGET);
        }
        if (*at == '?') {
            s->has_query = true;
        } else if (*at == '&' && s->has_query) {
            if (s->parameters + 1 == SRV_MAX_PARAMETERS) {
                return fail(s, at, SRV_FAULT_PARAMETERS);
            }
            s->parameters++;
        }
        s->target++;
    }
    if (at == end) {
        return at;
    }
    if (*at != ' ' || s->target == 0) {
        bool line = *at == '\r' || *at == '\n' || *at == ' ';
        return fail(s, at, line_fault(*at, line ? SRV_FAULT_VERSION : SRV_FAULT_TARGET));
    }
    s->state = VERSION;
    return at + 1;
}

/* Reads the version. The state changes from VERSION to LINE_LF. `digits` counts the characters of
 * "HTTP/1.1". */
static char *read_version(srv_syntax *s, char *at, const char *end)
{
    for (; at < end && s->digits < VERSION_END; at++) {
        bool is_digit = *at >= '0' && *at <= '9';
        if (s->digits == MAJOR && is_digit && *at != '1') {
            return fail(s, at, SRV_FAULT_OTHER_VERSION);
        }
        if (s->digits == MINOR ? !is_digit : *at != version[s->digits]) {
            return fail(s, at, line_fault(*at, SRV_FAULT_VERSION));
        }
        /* The last character, the minor version, decides whether the version is HTTP/1.0. */
        s->old = *at == '0';
        s->digits++;
    }
    if (at == end) {
        return at;
    }
    if (*at != '\r') {
        return fail(s, at, line_fault(*at, SRV_FAULT_VERSION));
    }
    s->state = LINE_LF;
    return at + 1;
}

/* Begins a header line, or ends the headers at an empty line. The state changes from FIELD to NAME
 * or HEAD_LF. */
static char *begin_field(srv_syntax *s, char *at)
{
    if (*at == '\r') {
        s->state = HEAD_LF;
        return at + 1;
    }
    if (srv_is_blank(*at)) {
        return fail(s, at, SRV_FAULT_FOLDED);
    }
    if (!srv_is_token(*at)) {
        return fail(s, at, *at == ':' ? SRV_FAULT_NAMELESS : line_fault(*at, SRV_FAULT_NAME));
    }
    if (s->fields == SRV_MAX_FIELDS) {
        return fail(s, at, SRV_FAULT_FIELDS);
    }
    s->fields++;
    s->text_length = 0;
    s->phase = BEFORE;
    uint32_t pooled = s->target + SRV_POOLED_FIELD * ((uint32_t)s->fields + s->parameters);
    uint32_t room = SRV_MAX_POOLED - pooled;
    s->limit = room < SRV_MAX_HEAD ? room : SRV_MAX_HEAD;
    s->state = NAME;
    return at;
}

static bool is_named(const srv_syntax *s, const char *name)
{
    return s->text_length == strlen(name) && memcmp(s->text, name, s->text_length) == 0;
}

/* Called at the colon after the name of a header: sets s->field. Returns false if the header may
 * occur only once and has occurred before. */
static bool choose_field(srv_syntax *s)
{
    s->field = OTHER;
    if (!s->trailers) {
        s->field = is_named(s, "host")                ? HOST
                   : is_named(s, "origin")            ? ORIGIN
                   : is_named(s, "authorization")     ? AUTHORIZATION
                   : is_named(s, "content-length")    ? LENGTH
                   : is_named(s, "transfer-encoding") ? CODING
                                                      : OTHER;
    }
    s->text_length = 0;
    if (s->field == OTHER) {
        return true;
    }
    unsigned bit = 1U << s->field;
    bool first = (s->seen & bit) == 0;
    s->seen = (uint8_t)(s->seen | bit);
    return first;
}

/* Returns the position up to which the present header may be read: the end of the bytes that have
 * arrived, or the place where the headers would have more bytes than allowed. */
static const char *stop_of(const srv_syntax *s, const char *at, const char *end)
{
    size_t room = s->limit > s->head ? s->limit - s->head : 0;
    return (size_t)(end - at) > room ? at + room : end;
}

/* Reads the name of a header. The state changes from NAME to VALUE. */
static char *read_name(srv_syntax *s, char *at, const char *end)
{
    static const char cookie[] = "cookie";
    const char *stop = stop_of(s, at, end);
    char *from = at;
    size_t length = s->text_length, before = length, last = sizeof cookie - 2;
    for (; at < stop && srv_is_token(*at); at++) {
        if (length < SRV_SYNTAX_TEXT) {
            s->text[length++] = srv_lower(*at);
        }
    }
    if (before <= last && length > last && memcmp(s->text, cookie, last + 1) == 0) {
        from[last - before] = '-';
    }
    s->text_length = (uint8_t)length;
    s->head += (uint32_t)(at - from);
    if (at == stop && stop < end && srv_is_token(*at)) {
        return fail(s, at, SRV_FAULT_LARGE_HEAD);
    }
    if (at == end) {
        return at;
    }
    if (*at != ':') {
        return fail(s, at, line_fault(*at, SRV_FAULT_NAME));
    }
    if (!choose_field(s)) {
        return fail(s, at, SRV_FAULT_REPEATED);
    }
    s->head++;
    s->state = VALUE;
    return at + 1;
}

static srv_fault add_digit(srv_syntax *s, char c)
{
    if (c < '0' || c > '9' || s->phase == AFTER) {
        return SRV_FAULT_LENGTH;
    }
    uint64_t digit = (uint64_t)(c - '0');
    if (s->left > ((uint64_t)INT64_MAX - digit) / 10) {
        return SRV_FAULT_LARGE_LENGTH;
    }
    s->left = s->left * 10 + digit;
    return SRV_FAULT_NONE;
}

static srv_fault add_host(const srv_syntax *s, char c)
{
    return srv_is_host(c) && s->phase != AFTER ? SRV_FAULT_NONE : SRV_FAULT_HOST;
}

/* Appends a character to the value of Transfer-Encoding in s->text, with one blank in place of
 * several. A value that does not fit into s->text is cut; it is certainly not "chunked". */
static srv_fault add_coding(srv_syntax *s, char c)
{
    if (s->phase == AFTER && s->text_length < SRV_SYNTAX_TEXT) {
        s->text[s->text_length++] = ' ';
    }
    if (s->text_length < SRV_SYNTAX_TEXT) {
        s->text[s->text_length++] = srv_lower(c);
    }
    return SRV_FAULT_NONE;
}

static srv_fault add_character(srv_syntax *s, char c)
{
    switch ((field)s->field) {
    case LENGTH:
        return add_digit(s, c);
    case HOST:
        return add_host(s, c);
    case CODING:
        return add_coding(s, c);
    case ORIGIN:
    case AUTHORIZATION:
    case OTHER:
        break;
    }
    return SRV_FAULT_NONE;
}

/* Returns the fault of the value of Transfer-Encoding (RFC 9112, 6.1 and 6.3). Codings before
 * "chunked" are not supported. If "chunked" is not the last coding or occurs twice, the end of the
 * body is unknown. */
static srv_fault coding_fault(const srv_syntax *s)
{
    static const char chunked[] = "chunked";
    size_t length = sizeof chunked - 1, count = 0, at = 0;
    for (size_t i = 0; i + length <= s->text_length; i++) {
        if (memcmp(s->text + i, chunked, length) == 0) {
            count++;
            at = i;
        }
    }
    if (count != 1 || at + length != s->text_length) {
        return SRV_FAULT_CODING;
    }
    if (at == 0) {
        return SRV_FAULT_NONE;
    }
    bool is_last =
        memchr(s->text, ',', at) != NULL && (s->text[at - 1] == ',' || s->text[at - 1] == ' ');
    return is_last ? SRV_FAULT_OTHER_CODING : SRV_FAULT_CODING;
}

/* Reads the value of Host, Content-Length or Transfer-Encoding, which is checked, up to the CR. */
static char *read_known_value(srv_syntax *s, char *at, const char *end)
{
    for (; at < end && srv_is_value(*at); at++) {
        if (s->head >= s->limit) {
            return fail(s, at, SRV_FAULT_LARGE_HEAD);
        }
        if (!srv_is_blank(*at)) {
            srv_fault fault = add_character(s, *at);
            if (fault != SRV_FAULT_NONE) {
                return fail(s, at, fault);
            }
            s->phase = WITHIN;
        } else if (s->phase != BEFORE) {
            s->phase = AFTER;
            *at = '\0';
        }
        s->head++;
    }
    return at;
}

/* Reads the value of any other header, up to the CR. */
static char *read_other_value(srv_syntax *s, char *at, const char *end)
{
    const char *stop = stop_of(s, at, end);
    char *from = at;
    while (at < stop && srv_is_value(*at)) {
        at++;
    }
    s->head += (uint32_t)(at - from);
    bool full = at == stop && stop < end && srv_is_value(*at);
    return full ? fail(s, at, SRV_FAULT_LARGE_HEAD) : at;
}

/* Reads the value of a header. The state changes from VALUE to VALUE_LF. */
static char *read_value(srv_syntax *s, char *at, const char *end)
{
    bool known = s->field == HOST || s->field == LENGTH || s->field == CODING;
    at = known ? read_known_value(s, at, end) : read_other_value(s, at, end);
    if (at == end || srv_syntax_is_faulty(s)) {
        return at;
    }
    if (*at != '\r') {
        return fail(s, at, line_fault(*at, SRV_FAULT_VALUE));
    }
    if (s->field == LENGTH && s->phase == BEFORE) {
        return fail(s, at, SRV_FAULT_LENGTH);
    }
    srv_fault fault = s->field == CODING ? coding_fault(s) : SRV_FAULT_NONE;
    if (fault != SRV_FAULT_NONE) {
        return fail(s, at, fault);
    }
    s->head += 2;
    s->state = VALUE_LF;
    return at + 1;
}

static bool has(const srv_syntax *s, field which)
{
    return (s->seen >> which & 1) != 0;
}

static srv_fault head_fault(const srv_syntax *s)
{
    if (has(s, CODING) && has(s, LENGTH)) {
        return SRV_FAULT_TWO_LENGTHS;
    }
    if (has(s, CODING) && s->old) {
        return SRV_FAULT_OLD_CODING;
    }
    return !has(s, HOST) && !s->old ? SRV_FAULT_NO_HOST : SRV_FAULT_NONE;
}

/* Ends the headers. The state changes from HEAD_LF to BODY, CHUNK_SIZE, or START of the next
 * request. */
static char *end_head(srv_syntax *s, char *at)
{
    srv_fault fault = s->trailers ? SRV_FAULT_NONE : head_fault(s);
    if (*at != '\n') {
        return fail(s, at, SRV_FAULT_BARE_CR);
    }
    if (fault != SRV_FAULT_NONE) {
        return fail(s, at, fault);
    }
    s->digits = 0;
    s->state = s->trailers                     ? START
               : has(s, CODING)                ? CHUNK_SIZE
               : has(s, LENGTH) && s->left > 0 ? BODY
                                               : START;
    if (s->state == CHUNK_SIZE) {
        s->left = 0;
    }
    return at + 1;
}

/* Skips data of a body, which need no check. The state changes from BODY or CHUNK_DATA to `next`.
 */
static char *pass_data(srv_syntax *s, char *at, const char *end, state next)
{
    uint64_t here = (uint64_t)(end - at);
    if (here < s->left) {
        s->left -= here;
        return at + here;
    }
    at += s->left;
    s->left = 0;
    s->state = (uint8_t)next;
    return at;
}

/* Reads the size of a chunk. The state changes from CHUNK_SIZE to CHUNK_EXTENSION or CHUNK_LF. */
static char *read_size(srv_syntax *s, char *at, const char *end)
{
    for (; at < end && srv_hexadecimal(*at) >= 0; at++) {
        if (s->digits == SRV_MAX_CHUNK_DIGITS || s->left >> 59 != 0) {
            return fail(s, at, SRV_FAULT_CHUNK_SIZE);
        }
        s->left = s->left << 4 | (uint64_t)srv_hexadecimal(*at);
        s->digits++;
    }
    if (at == end) {
        return at;
    }
    if (s->digits == 0) {
        return fail(s, at, line_fault(*at, SRV_FAULT_CHUNK_SIZE));
    }
    if (*at == ';' || srv_is_blank(*at)) {
        s->extension = 0;
        s->phase = BEFORE;
        s->state = CHUNK_EXTENSION;
        return at;
    }
    if (*at != '\r') {
        return fail(s, at, line_fault(*at, SRV_FAULT_CHUNK_SIZE));
    }
    s->state = CHUNK_LF;
    return at + 1;
}

/* Reads the extensions of a chunk. The state changes from CHUNK_EXTENSION to CHUNK_LF. s->phase is
 * BEFORE until the first semicolon was read. */
static char *read_extension(srv_syntax *s, char *at, const char *end)
{
    for (; at < end && srv_is_value(*at); at++) {
        if (s->extension == SRV_MAX_EXTENSION || s->extensions == SRV_MAX_HEAD) {
            return fail(s, at, SRV_FAULT_LARGE_EXTENSION);
        }
        if (s->phase == BEFORE && *at != ';' && !srv_is_blank(*at)) {
            return fail(s, at, SRV_FAULT_CHUNK_SIZE);
        }
        if (s->phase == BEFORE) {
            s->phase = *at == ';' ? WITHIN : BEFORE;
            *at = ';';
        }
        s->extension++;
        s->extensions++;
    }
    if (at == end) {
        return at;
    }
    if (*at != '\r') {
        return fail(s, at, line_fault(*at, SRV_FAULT_EXTENSION));
    }
    if (s->phase == BEFORE) {
        return fail(s, at, SRV_FAULT_CHUNK_SIZE);
    }
    s->state = CHUNK_LF;
    return at + 1;
}

/* Ends the line with the size of a chunk. The state changes from CHUNK_LF to CHUNK_DATA, or FIELD
 * if the size is 0, which is followed by trailers. */
static char *end_size(srv_syntax *s, char *at)
{
    s->trailers = s->left == 0;
    s->digits = 0;
    return read_lf(s, at, s->trailers ? FIELD : CHUNK_DATA);
}

/* Ends the data of a chunk. The state changes from CHUNK_END to CHUNK_END_LF. */
static char *end_chunk(srv_syntax *s, char *at)
{
    if (*at != '\r') {
        return fail(s, at, line_fault(*at, SRV_FAULT_CHUNK_END));
    }
    s->state = CHUNK_END_LF;
    return at + 1;
}

static char *move(srv_syntax *s, char *at, const char *end)
{
    switch ((state)s->state) {
    case START:
        return begin(s, at);
    case START_LF:
        return read_lf(s, at, START);
    case METHOD:
        return read_method(s, at, end);
    case TARGET:
        return read_target(s, at, end);
    case VERSION:
        return read_version(s, at, end);
    case LINE_LF:
    case VALUE_LF:
        return read_lf(s, at, FIELD);
    case FIELD:
        return begin_field(s, at);
    case NAME:
        return read_name(s, at, end);
    case VALUE:
        return read_value(s, at, end);
    case HEAD_LF:
        return end_head(s, at);
    case BODY:
        return pass_data(s, at, end, START);
    case CHUNK_SIZE:
        return read_size(s, at, end);
    case CHUNK_EXTENSION:
        return read_extension(s, at, end);
    case CHUNK_LF:
        return end_size(s, at);
    case CHUNK_DATA:
        return pass_data(s, at, end, CHUNK_END);
    case CHUNK_END:
        return end_chunk(s, at);
    case CHUNK_END_LF:
        return read_lf(s, at, CHUNK_SIZE);
    }
    return at;
}

/* --- faults --- */

/* Returns the bytes that libmicrohttpd gets in place of the rest of a faulty request (rule S3). If
 * the size of a chunk was read, they include one byte of data, with which libmicrohttpd calls the
 * handler. */
static const char *ending_of(const srv_syntax *s)
{
    switch ((state)s->state) {
    case START:
        return "- / HTTP/1.1\r\n\r\n";
    case START_LF:
        return "\n- / HTTP/1.1\r\n\r\n";
    case METHOD:
        return " / HTTP/1.1\r\n\r\n";
    case TARGET:
        return s->target == 0 ? "/ HTTP/1.1\r\n\r\n" : " HTTP/1.1\r\n\r\n";
    case VERSION:
        return version + s->digits;
    case NAME:
        /* The '-' makes a name that differs from all names of known headers. */
        return "-: \r\n\r\n";
    case VALUE:
        return s->field == LENGTH && s->phase == BEFORE ? "0\r\n\r\n" : "\r\n\r\n";
    case LINE_LF:
    case VALUE_LF:
        return "\n\r\n";
    case FIELD:
        return "\r\n";
    case HEAD_LF:
        return "\n";
    case CHUNK_SIZE:
        if (s->digits == 0) {
            return "0\r\n\r\n";
        }
        return s->left == 0 ? "\r\n\r\n" : "\r\n-";
    case CHUNK_EXTENSION:
        return s->left == 0 ? "\r\n\r\n" : "\r\n-";
    case CHUNK_LF:
        return s->left == 0 ? "\n\r\n" : "\n-";
    case CHUNK_END:
        return "\r\n0\r\n\r\n";
    case CHUNK_END_LF:
        return "\n0\r\n\r\n";
    case BODY:
    case CHUNK_DATA:
        break; /* these states have no faults */
    }
    return "";
}

size_t srv_syntax_end(srv_syntax *s, char *bytes, size_t size)
{
    size_t length = strlen(s->ending);
    length = length < size ? length : size;
    memcpy(bytes, s->ending, length);
    s->ending += length;
    return length;
}

size_t srv_syntax_check(srv_syntax *s, char *bytes, size_t got, size_t size)
{
    char *at = bytes;
    const char *end = bytes + got;
    while (at < end && !srv_syntax_is_faulty(s)) {
        at = move(s, at, end);
    }
    if (!srv_syntax_is_faulty(s)) {
        return got;
    }
    if (s->state == START || s->state == START_LF) {
        s->requests++;
    }
    s->ending = ending_of(s);
    size_t passed = (size_t)(at - bytes);
    return passed + srv_syntax_end(s, at, size - passed);
}

bool srv_syntax_fault(const srv_syntax *s, uint64_t request, api_problem *problem)
{
    bool is_it = srv_syntax_is_faulty(s) && s->requests == request;
    if (is_it && problem != NULL) {
        srv_fault_describe((srv_fault)s->fault, problem);
    }
    return is_it;
}
