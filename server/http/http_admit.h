/* http_admit.h - a request whose headers have arrived: what it is called, and whether it may run.
 */
#ifndef HE_SERVER_HTTP_HTTP_ADMIT_H
#define HE_SERVER_HTTP_HTTP_ADMIT_H

#include "server/http/syntax/http_framing.h"
#include "server/http/http_policy.h"
#include "server/log/access.h"
#include "server/net/address.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

enum { SRV_ID_PREFIX = 8 };

/* Names for requests that bring none: a prefix of this server and a counter. */
typedef struct srv_ids {
    char prefix[SRV_ID_PREFIX + 1];
    _Atomic uint64_t next;
} srv_ids;

void srv_ids_init(srv_ids *ids);

/* The client's X-Request-Id where it is 1 to SRV_REQUEST_ID letters, digits and . _ -, or a new
 * one. */
void srv_admit_name(const srv_head *head, srv_ids *ids, char out[SRV_REQUEST_ID + 1]);

/* Who asks, and how. */
typedef struct srv_client {
    char address[SRV_ADDRESS_TEXT]; /* without a port; "unix:uid=1000" on a Unix socket */
    srv_scheme scheme;
    bool told_name; /* P6 of http_policy.h */
} srv_client;

/* Reads what the trusted proxy at the other end of the connection tells of its client (proxy.h).
 * `client` holds what is known of the connection itself, and keeps it where nothing is told. False
 * with the problem filled, bad_header: then it keeps all of it. */
bool srv_admit_proxied(const srv_policy *policy, const srv_head *head, srv_client *client,
                       api_problem *problem);

/* P1 to P6 of http_policy.h for a request whose framing is good. False with the problem filled.
 * `cors` is the origin to be named in the answer, NULL: none. */
bool srv_admit(const srv_policy *policy, const srv_head *head, const srv_framing *framing,
               srv_client *client, const char **cors, api_problem *problem);

#endif
