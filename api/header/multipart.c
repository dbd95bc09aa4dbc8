#include "api/header/multipart.h"

#include "api/header/media.h"
#include "base/mem.h"
#include "base/utf8.h"

#include <string.h>
#include <strings.h>

enum { BOUNDARY = 70, DELIMITER = BOUNDARY + 4 };

typedef enum state {
    SEEK,    /* reads a part (or the preamble) up to the next delimiter */
    CLOSE,   /* reads the rest of a delimiter's line */
    HEADERS, /* reads the headers of a part */
    EPILOGUE
} state;

struct api_multipart {
    state state;
    uint64_t seen;             /* number of bytes read so far */
    char delimiter[DELIMITER]; /* CR, LF, "--" and the boundary */
    /* length: the length of `delimiter`. matched: how many bytes at the beginning of `delimiter`
     * equal the bytes that were read last. */
    size_t length, matched;
    /* How many of the `matched` bytes belong to the end of the line before the content of a part,
     * so that they cannot be content of the part. */
    size_t implied;
    bool inside; /* true if the content of a part is being read */
    /* The last byte that was read of the line after a boundary; 0: none was read. */
    char close;
    size_t parts;     /* number of parts begun */
    uint64_t head_at; /* offset in the body of the headers of the present part */
    size_t head_length;
    char head[API_MAX_PART_HEADERS];
    char name[API_MAX_PART_NAME + 1], type[API_MAX_PART_NAME + 1];
};

/* --- parameters of a header's value: *( ";" name "=" value ) --- */

typedef struct parameter {
    const char *name;
    size_t name_length;
    char value[API_MAX_PART_NAME + 1]; /* terminated by NUL */
    size_t length;
} parameter;

static bool is_token(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           (c != '\0' && strchr("!#$%&'*+-.^_`|~", c) != NULL);
}

static const char *skip_blanks(const char *p, const char *end)
{
    while (p < end && (*p == ' ' || *p == '\t')) {
        p++;
    }
    return p;
}

static const char *skip_token(const char *p, const char *end)
{
    while (p < end && is_token(*p)) {
        p++;
    }
    return p;
}

static bool put(parameter *out, char c)
{
    if (out->length == API_MAX_PART_NAME) {
        return false;
    }
    out->value[out->length++] = c;
    return true;
}

/* Reads a quoted value. Returns the position after the closing quote; NULL if there is no closing
 * quote or the value is too long. */
static const char *read_quoted(const char *p, const char *end, parameter *out)
{
    for (p++; p < end && *p != '"'; p++) {
        char c = *p;
        if (c == '\\' && end - p > 1 && (p[1] == '"' || p[1] == '\\')) {
            c = *++p;
        } else if (c == '%' && end - p > 2 && p[1] == '2' && p[2] == '2') {
            c = '"';
            p += 2;
        }
        if (!put(out, c)) {
            return NULL;
        }
    }
    return p < end ? p + 1 : NULL;
}

typedef enum found { NONE, FOUND, WRONG } found;

static found next_parameter(const char **at, const char *end, parameter *out)
{
    const char *p = skip_blanks(*at, end);
    out->length = 0;
    if (p == end) {
        return NONE;
    }
    if (*p != ';') {
        return WRONG;
    }
    p = skip_blanks(p + 1, end);
    if (p == end) {
        return NONE;
    }
    out->name = p;
    p = skip_token(p, end);
    out->name_length = (size_t)(p - out->name);
    if (out->name_length == 0 || p == end || *p != '=') {
        return WRONG;
    }
    p++;
    if (p < end && *p == '"') {
        p = read_quoted(p, end, out);
    } else {
        const char *stop = skip_token(p, end);
        bool fits = stop > p;
        for (; p < stop; p++) {
            fits = put(out, *p) && fits;
        }
        p = fits ? stop : NULL;
    }
    out->value[out->length] = '\0';
    *at = p;
    return p == NULL ? WRONG : FOUND;
}

/* Returns true if the bytes from `p` to `end` are this word, ignoring letter case. */
static bool is_word(const char *p, const char *end, const char *word)
{
    size_t length = strlen(word);
    return (size_t)(end - p) == length && strncasecmp(p, word, length) == 0;
}

static bool is_named(const parameter *p, const char *name)
{
    return is_word(p->name, p->name + p->name_length, name);
}

/* --- finding the boundary --- */

static bool is_boundary(const char *text, size_t length)
{
    bool good = length > 0 && length <= BOUNDARY && text[length - 1] != ' ';
    for (size_t i = 0; i < length && good; i++) {
        char c = text[i];
        good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               (c != '\0' && strchr("'()+_,-./:=? ", c) != NULL);
    }
    return good;
}

/* Finds the boundary parameter of a Content-Type; returns false if it is missing or repeated. */
static bool find_boundary(const char *content_type, parameter *out)
{
    const char *end = content_type + strlen(content_type);
    const char *at = content_type + strcspn(content_type, ";");
    parameter next;
    size_t count = 0;
    found step;
    while ((step = next_parameter(&at, end, &next)) == FOUND) {
        if (is_named(&next, "boundary")) {
            *out = next;
            count++;
        }
    }
    return step == NONE && count == 1 && is_boundary(out->value, out->length);
}

api_multipart *api_multipart_new(const char *content_type, api_problem *problem)
{
    parameter boundary = {.length = 0};
    if (!find_boundary(content_type, &boundary)) {
        api_problem_set(problem, API_BAD_HEADER,
                        "the Content-Type multipart/form-data needs exactly one parameter "
                        "boundary, of 1 to %d characters",
                        BOUNDARY);
        return NULL;
    }
    api_multipart *m = he_mem_zero(1, sizeof *m);
    if (m == NULL) {
        api_problem_set(problem, HE_NO_MEMORY, "no memory for the parts of the body");
        return NULL;
    }
    memcpy(m->delimiter, "\r\n--", 4);
    memcpy(m->delimiter + 4, boundary.value, boundary.length);
    m->length = 4 + boundary.length;
    /* CR LF count as matched, because the first delimiter may stand at the very beginning of the
     * body, without them. */
    m->matched = m->implied = 2;
    return m;
}

void api_multipart_free(api_multipart *m)
{
    he_mem_free(m);
}

/* --- headers of a part --- */

static api_multipart_step refuse(api_problem *problem, uint64_t at, const char *why)
{
    api_problem_set(problem, API_BAD_MULTIPART, "byte %llu of the body: %s", (unsigned long long)at,
                    why);
    return API_MULTIPART_BAD;
}

static bool is_text(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if ((unsigned char)text[i] < 0x20 || text[i] == 0x7F) {
            return false;
        }
    }
    return he_is_utf8(text, length);
}

/* Which headers of a part have been read so far. */
typedef struct head {
    bool disposition, type, coding;
} head;

/* Reads the value of Content-Disposition. Returns NULL, or a sentence about what is wrong with
 * it. */
static const char *read_disposition(api_multipart *m, const char *p, const char *end)
{
    const char *word = p;
    parameter next;
    bool name = false, filename = false;
    found step;
    p = skip_token(p, end);
    if (!is_word(word, p, "form-data")) {
        return "the Content-Disposition of a part must be form-data";
    }
    while ((step = next_parameter(&p, end, &next)) == FOUND) {
        bool is_file = is_named(&next, "filename");
        bool *seen = is_file ? &filename : is_named(&next, "name") ? &name : NULL;
        if (is_named(&next, "filename*")) {
            return "filename* is not allowed in multipart/form-data: use filename, in UTF-8";
        }
        if (seen == NULL) {
            continue;
        }
        if (*seen) {
            return "a parameter is given twice in the Content-Disposition of a part";
        }
        *seen = true;
        if (!is_text(next.value, next.length)) {
            return "the name of a part or of its file is not UTF-8, or has control characters";
        }
        /* An HTML form sends an empty filename for a file input without a chosen file. */
        if (next.length > 0 && (is_file || !filename || m->name[0] == '\0')) {
            memcpy(m->name, next.value, next.length + 1);
        }
    }
    if (step == WRONG) {
        return "a Content-Disposition is too long, or not name=\"value\" separated by ';'";
    }
    return name ? NULL : "a part has no name";
}

static const char *read_header(api_multipart *m, head *seen, const char *p, const char *end)
{
    const char *name = p, *stop = skip_token(p, end);
    if (stop == name || stop == end || *stop != ':') {
        return "a line in the headers of a part is not of the form NAME: VALUE";
    }
    p = skip_blanks(stop + 1, end);
    while (end > p && (end[-1] == ' ' || end[-1] == '\t')) {
        end--;
    }
    bool disposition = is_word(name, stop, "Content-Disposition");
    bool type = is_word(name, stop, "Content-Type");
    bool coding = is_word(name, stop, "Content-Transfer-Encoding");
    if ((disposition && seen->disposition) || (type && seen->type) || (coding && seen->coding)) {
        return "a header of a part is given twice";
    }
    seen->disposition |= disposition;
    seen->type |= type;
    seen->coding |= coding;
    size_t length = (size_t)(end - p);
    if (disposition) {
        return read_disposition(m, p, end);
    }
    if (type && length >= 10 && strncasecmp(p, "multipart/", 10) == 0) {
        return "a part of the body is itself a multipart body, which is not allowed";
    }
    if (type && (length > API_MAX_PART_NAME || !is_text(p, length))) {
        return "a Content-Type is too long, not UTF-8 or has control characters";
    }
    if (type) {
        memcpy(m->type, p, length);
        m->type[length] = '\0';
    }
    bool plain = is_word(p, end, "7bit") || is_word(p, end, "8bit") || is_word(p, end, "binary");
    return coding && !plain
               ? "Content-Transfer-Encoding is not supported: send the bytes as they are"
               : NULL;
}

static api_multipart_step read_headers(api_multipart *m, api_multipart_piece *out,
                                       api_problem *problem)
{
    const char *p = m->head, *end = p + m->head_length - 2;
    head seen = {false, false, false};
    m->name[0] = m->type[0] = '\0';
    while (p < end) {
        const char *stop = p;
        while (stop[0] != '\r' || stop[1] != '\n') {
            stop++;
        }
        const char *why = read_header(m, &seen, p, stop);
        if (why != NULL) {
            return refuse(problem, m->head_at + (uint64_t)(p - m->head), why);
        }
        p = stop + 2;
    }
    if (!seen.disposition || m->name[0] == '\0') {
        return refuse(problem, m->head_at, "a part has no name");
    }
    m->state = SEEK;
    m->inside = true;
    /* CR LF count as matched, because in an empty part the CR LF of the empty line after the
     * headers is the beginning of the next delimiter. */
    m->matched = m->implied = 2;
    out->part = (api_part){m->name, seen.type ? m->type : NULL};
    return API_MULTIPART_BEGIN;
}

/* --- reading bytes of parts and delimiters --- */

/* Reads bytes of a part up to the next delimiter. Bytes that match the beginning of the delimiter
 * are held back; if a later byte differs, they belong to the part. CR is the first byte of the
 * delimiter and occurs nowhere else in it, so no byte has to be compared twice. */
static api_multipart_step seek(api_multipart *m, const char **at, const char *end,
                               api_multipart_piece *out)
{
    const char *p = *at;
    while (m->matched < m->length && p < end && *p == m->delimiter[m->matched]) {
        m->matched++;
        p++;
    }
    if (m->matched == m->length) {
        *at = p;
        m->state = CLOSE;
        m->close = '\0';
        bool ends = m->inside;
        m->inside = false;
        return ends ? API_MULTIPART_END : API_MULTIPART_MORE;
    }
    if (p == end) {
        *at = p;
        return API_MULTIPART_MORE;
    }
    out->bytes = m->delimiter + m->implied;
    out->length = m->matched - m->implied;
    m->matched = m->implied = 0;
    if (out->length == 0) {
        const char *stop = memchr(p, '\r', (size_t)(end - p));
        stop = stop == NULL ? end : stop;
        out->bytes = p;
        out->length = (size_t)(stop - p);
        p = stop;
    }
    *at = p;
    return m->inside && out->length > 0 ? API_MULTIPART_BYTES : API_MULTIPART_MORE;
}

/* Reads a byte after a boundary, where "--", or blanks and CR LF, must follow. Returns false if
 * another byte follows. */
static bool close_delimiter(api_multipart *m, char c)
{
    if (m->close == '-' || m->close == '\r') {
        m->state = m->close == '-' ? EPILOGUE : HEADERS;
        m->head_length = 0;
        return c == (m->close == '-' ? '-' : '\n');
    }
    bool good = c == '\r' || c == ' ' || c == '\t' || (c == '-' && m->close == '\0');
    m->close = c;
    return good;
}

/* Returns true if the empty line after the headers of a part has arrived. */
static bool ends_headers(const api_multipart *m)
{
    const char *p = m->head + m->head_length;
    return (m->head_length == 2 && memcmp(p - 2, "\r\n", 2) == 0) ||
           (m->head_length >= 4 && memcmp(p - 4, "\r\n\r\n", 4) == 0);
}

api_multipart_step api_multipart_next(api_multipart *m, const char **at, const char *end,
                                      api_multipart_piece *out, api_problem *problem)
{
    api_multipart_step step = API_MULTIPART_MORE;
    while (*at < end && step == API_MULTIPART_MORE) {
        const char *before = *at;
        switch (m->state) {
        case SEEK:
            step = seek(m, at, end, out);
            break;
        case CLOSE:
            if (!close_delimiter(m, *(*at)++)) {
                return refuse(problem, m->seen,
                              "after a delimiter (two hyphens and the boundary) neither \"--\" nor "
                              "a new line follows");
            }
            break;
        case HEADERS:
            if (m->head_length == 0) {
                m->head_at = m->seen;
                if (m->parts++ == API_MAX_PARTS) {
                    api_problem_set(problem, API_BAD_MULTIPART, "the body has more than %d parts",
                                    (int)API_MAX_PARTS);
                    return API_MULTIPART_BAD;
                }
            }
            if (m->head_length == sizeof m->head) {
                return refuse(problem, m->head_at, "the headers of a part are too long");
            }
            m->head[m->head_length++] = *(*at)++;
            step = ends_headers(m) ? read_headers(m, out, problem) : step;
            break;
        case EPILOGUE:
            *at = end;
            break;
        }
        m->seen += (uint64_t)(*at - before);
    }
    return step;
}

bool api_multipart_end(const api_multipart *m, api_problem *problem)
{
    return m->state == EPILOGUE ||
           refuse(problem, m->seen, "the body ends before its last delimiter") != API_MULTIPART_BAD;
}
