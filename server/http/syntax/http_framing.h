/* http_framing.h - finds path, query and body of a request.
 *
 * The bytes were checked before (http_syntax.h, rules F1 to F8): the target is visible ASCII,
 * Content-Length is a number, Transfer-Encoding is chunked, and Content-Length, Transfer-Encoding
 * and Host occur once at most. This module only refuses targets that are neither path?query nor
 * http://authority/path?query. The connection of a refused request is closed. */
#ifndef HE_SERVER_HTTP_SYNTAX_HTTP_FRAMING_H
#define HE_SERVER_HTTP_SYNTAX_HTTP_FRAMING_H

#include "server/http/syntax/http_fault.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct srv_field {
    const char *name, *value;
    size_t name_length, value_length;
} srv_field;

/* A request as libmicrohttpd parsed it; everything is borrowed. */
typedef struct srv_head {
    const char *method, *target, *version;
    srv_field fields[SRV_MAX_FIELDS];
    size_t field_count;
} srv_head;

typedef struct srv_framing {
    const char *path; /* the path: points into the target, and ends at '?' or the target's end */
    size_t path_length;
    const char *query; /* the query: points into the target, or to "" if there is no query */
    /* Host and port in a target like http://HOST/PATH; NULL if the target names none. */
    const char *authority;
    size_t authority_length;
    const char *host; /* the value of the header Host, NULL if absent */
    bool chunked;
    bool has_length;
    uint64_t length;
} srv_framing;

/* Finds path, query and body of a request. If `secure` is true, it came over TLS, and its target
 * may be https://authority/path?query, too. Returns false with bad_path if the target is
 * refused. */
bool srv_framing_read(const srv_head *head, bool secure, srv_framing *out, api_problem *problem);
/* Returns the first header line with this name, ignoring case, or NULL if there is none. */
const srv_field *srv_head_find(const srv_head *head, const char *name);

#endif
