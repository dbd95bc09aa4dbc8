/* http_admit.h - a request whose headers have arrived: choosing its id, and checking whether it may
 * run.
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

/* Makes request ids, which consist of a prefix of this server and a counter. */
typedef struct srv_ids {
    char prefix[SRV_ID_PREFIX + 1];
    _Atomic uint64_t next;
} srv_ids;

void srv_ids_init(srv_ids *ids);

/* Chooses the id of a request: copies the client's X-Request-Id if it is 1 to SRV_REQUEST_ID
 * letters, digits and . _ -, or makes a new one. */
void srv_admit_name(const srv_head *head, srv_ids *ids, char out[SRV_REQUEST_ID + 1]);

/* The client of a request, and the headers for browsers that its answer has. */
typedef struct srv_client {
    char address[SRV_ADDRESS_TEXT]; /* without a port; "unix:uid=1000" on a Unix socket */
    srv_scheme scheme;
    bool told_name;   /* the answer has the header of P6 (http_policy.h) */
    const char *cors; /* the origin that the answer names in CORS headers (P4); NULL: none */
} srv_client;

/* Reads what a trusted proxy at the other end of the connection says about its client (proxy.h).
 * `client` describes the connection at first, and stays as it is where the proxy says nothing.
 * Returns false with bad_header and `client` unchanged. */
bool srv_admit_proxied(const srv_policy *policy, const srv_head *head, srv_client *client,
                       api_problem *problem);

/* Applies rules P1 to P6 of http_policy.h to a request with valid framing. Returns false with the
 * problem filled if it is refused. Sets what `client` says about its answer in both cases. */
bool srv_admit(const srv_policy *policy, const srv_head *head, const srv_framing *framing,
               srv_client *client, api_problem *problem);

#endif
