/* http_framing.h - is a request what it claims to be, before anything trusts it?
 *
 * libmicrohttpd takes requests that leave open where the body ends (two Content-Length, both
 * lengths, unknown codings) or that another server on the way would read differently. This looks
 * at the line and the headers as they arrived and refuses (RFC 9112, sections 3 and 6):
 *
 *   F1  method and header names are tokens, values hold no control character but tab
 *   F2  the version is HTTP/1.0 or HTTP/1.1
 *   F3  the target is path?query, or http://authority/path?query, in visible ASCII without '#'
 *   F4  at most SRV_MAX_FIELDS headers and SRV_MAX_HEAD bytes of them: 431; target: 414
 *   F5  Content-Length, Host and Transfer-Encoding appear once at most
 *   F6  Content-Length is digits alone; Transfer-Encoding is chunked, in HTTP/1.1, without
 *       Content-Length
 *   F7  HTTP/1.1 has a Host
 *
 * The connection of a refused request is closed. */
#ifndef HE_SERVER_HTTP_FRAMING_H
#define HE_SERVER_HTTP_FRAMING_H

#include "api/problem.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_MAX_FIELDS = 100, SRV_MAX_HEAD = 16 * 1024 };

typedef struct srv_field {
    const char *name, *value;
    size_t name_length, value_length;
} srv_field;

/* A request as it arrived; everything is borrowed. */
typedef struct srv_head {
    const char *method, *target, *version;
    srv_field fields[SRV_MAX_FIELDS];
    size_t field_count; /* may exceed SRV_MAX_FIELDS: the rest is not in the array */
    size_t bytes;       /* of names and values, all of them */
} srv_head;

typedef struct srv_framing {
    const char *path; /* points into the target, up to '?' or the end */
    size_t path_length;
    const char *query;     /* into the target, "" when absent */
    const char *authority; /* of an absolute target, NULL else; it counts instead of Host */
    size_t authority_length;
    const char *host; /* the header, NULL when absent */
    bool http_1_0;
    bool chunked;
    bool has_length;
    uint64_t length;
} srv_framing;

/* False with the problem filled: 400, 414 or 431. */
bool srv_framing_check(const srv_head *head, srv_framing *out, api_problem *problem);
/* Of the first SRV_MAX_FIELDS, without case; NULL when absent. */
const srv_field *srv_head_find(const srv_head *head, const char *name);

#endif
