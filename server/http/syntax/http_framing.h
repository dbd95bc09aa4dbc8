/* http_framing.h - finds path, query and body of a request.
 *
 * The bytes were checked before (http_syntax.h, rules F1 to F8): the target is visible ASCII,
 * Content-Length is a number, Transfer-Encoding is chunked, and neither of these nor Host is given
 * twice. This module refuses only targets that are neither path?query nor
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
    const char *path; /* points into the target, up to '?' or the end */
    size_t path_length;
    const char *query;     /* into the target, "" when absent */
    const char *authority; /* of an absolute target, which overrides Host; else NULL */
    size_t authority_length;
    const char *host; /* the Host header, NULL when absent */
    bool chunked;
    bool has_length;
    uint64_t length;
} srv_framing;

/* Finds path, query and body of a request. `secure` says that it came over TLS, so that
 * https://authority/path?query is allowed, too. Returns false with bad_path. */
bool srv_framing_read(const srv_head *head, bool secure, srv_framing *out, api_problem *problem);
/* Finds a header, ignoring case; returns NULL when absent. */
const srv_field *srv_head_find(const srv_head *head, const char *name);

#endif
