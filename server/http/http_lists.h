/* http_lists.h - headers that are lists and were sent in several lines: one list (RFC 9110 5.3).
 *
 * libmicrohttpd gives the first line of a name. A second "Content-Encoding: gzip" that nobody looks
 * at would have a body taken for something it is not. */
#ifndef HE_SERVER_HTTP_HTTP_LISTS_H
#define HE_SERVER_HTTP_HTTP_LISTS_H

#include "server/http/http_framing.h"

enum { SRV_LISTS = 6 };

/* {0} joins nothing. */
typedef struct srv_lists {
    char *joined[SRV_LISTS]; /* owned; NULL where there is one line or none */
} srv_lists;

/* False when memory is out. */
bool srv_lists_join(srv_lists *lists, const srv_head *head);
void srv_lists_clear(srv_lists *lists);
/* NULL where the header is no list, or one line. */
const char *srv_lists_find(const srv_lists *lists, const char *name);

#endif
