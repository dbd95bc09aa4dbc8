/* http_admit.h - what is done when the headers of a request have arrived: chooses the id of the
 * request, finds its client, and checks whether the request may run. */
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

/* A generator of request ids. An id consists of a random prefix of this server and a counter. */
typedef struct srv_ids {
    char prefix[SRV_ID_PREFIX + 1];
    _Atomic uint64_t next;
} srv_ids;

void srv_ids_init(srv_ids *ids);

/* Chooses the id of a request: copies the client's X-Request-Id if it is 1 to SRV_REQUEST_ID
 * letters, digits and . _ -, or makes a new one. */
void srv_admit_name(const srv_head *head, srv_ids *ids, char out[SRV_REQUEST_ID + 1]);

/* What is known about the client of a request, and the headers for browsers that its answer has. */
typedef struct srv_client {
    /* The client's address without a port; "unix:uid=1000" on a Unix socket. */
    char address[SRV_ADDRESS_TEXT];
    srv_scheme scheme;
    /* True if the answer has the header Strict-Transport-Security: rule P6 of http_policy.h. */
    bool told_name;
    /* The origin that the answer names in CORS headers (rule P4 of http_policy.h), or NULL. */
    const char *cors;
} srv_client;

/* Reads from the headers of a request what a trusted proxy, from which the connection comes, says
 * about its own client (proxy.h). Before the call `client` describes the proxy; members about which
 * the headers say nothing stay as they are. Returns false with bad_header, and `client` unchanged,
 * if the headers are invalid. */
bool srv_admit_proxied(const srv_policy *policy, const srv_head *head, srv_client *client,
                       api_problem *problem);

/* Applies rules P1 to P6 of http_policy.h to a request with valid framing. Returns false with the
 * problem filled if the request is refused. Sets the members of `client` about the answer in both
 * cases. */
bool srv_admit(const srv_policy *policy, const srv_head *head, const srv_framing *framing,
               srv_client *client, api_problem *problem);

#endif
