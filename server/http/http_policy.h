/* http_policy.h - decides which requests of browsers this server accepts.
 *
 * Configured names are those of --allow-host, configured origins those of --allow-origin.
 *
 * P1  The header Host must name localhost, a loopback address or a configured name, with any port;
 *     otherwise the answer is 421. So a page whose own name resolves to 127.0.0.1 (DNS
 *     rebinding) is refused.
 * P2  If a write has the header Origin, its value must be this server's own origin (http or https,
 *     and the host and port of Host) or a configured origin; otherwise, and always for `null`, the
 *     answer is 403. Requests with two Origin headers are refused before, by http_syntax.h.
 * P3  A write whose header Sec-Fetch-Site is cross-site is answered 403, unless its Origin is a
 *     configured one. A write whose Sec-Fetch-Site is same-site and that has no Origin is answered
 *     403, too: a page on another port or subdomain sent it, and it is unknown which. Reads that
 *     the table of routes calls expensive are refused in the same cases: see api/request/admit.c.
 * P4  Answers to requests from configured origins, and no others, have CORS headers.
 * P5  If a request came over TLS, or a trusted proxy reports its scheme, this server's own origin
 *     has that scheme: http://name is then a foreign origin for https://name. If the scheme is
 *     unknown, as behind a proxy that is not trusted, the origins of both schemes count as the
 *     server's own.
 * P6  If a request came over TLS and its Host is a configured name, the answer tells browsers to
 *     use only TLS from now on (RFC 6797). It does not for localhost, because other servers on that
 *     machine may speak HTTP, nor for addresses, for which browsers ignore the header. */
#ifndef HE_SERVER_HTTP_HTTP_POLICY_H
#define HE_SERVER_HTTP_HTTP_POLICY_H

#include "api/json/problem.h"
#include "server/net/proxy.h"

#include <stdbool.h>
#include <stddef.h>

enum { SRV_MAX_NAMES = 32 };

typedef struct srv_names {
    const char *items[SRV_MAX_NAMES];
    size_t count;
} srv_names;

typedef struct srv_policy {
    srv_names hosts;   /* without a port */
    srv_names origins; /* "https://example.org" */
    srv_proxies proxies;
} srv_policy;

/* Checks the value of the header Host ("name", "name:port", "[::1]:port") by rule P1. Returns false
 * with wrong_host if it is refused. `host` may be NULL, which is accepted: an HTTP/1.0 client may
 * leave the header out, and browsers never do. */
bool srv_policy_host(const srv_policy *policy, const char *host, size_t length,
                     api_problem *problem);
/* What a request says about the page that sent it: the values of its headers Host, Origin and
 * Sec-Fetch-Site, which may be NULL, and its method. */
typedef struct srv_sender {
    const char *method, *host, *origin, *fetch_site;
    srv_scheme scheme; /* the scheme of the connection */
} srv_sender;

/* Checks by rules P2, P3 and P5 whether the request of a sender may run. Returns false with
 * foreign_origin if it may not. */
bool srv_policy_origin(const srv_policy *policy, const srv_sender *sender, api_problem *problem);
/* Returns true if `host`, the value of the header Host or NULL, is a configured name to which rule
 * P6 applies. */
bool srv_policy_is_name(const srv_policy *policy, const char *host);
/* Returns the configured origin that is equal to `origin`, or NULL if there is none. */
const char *srv_policy_cors(const srv_policy *policy, const char *origin);
/* Returns true if the method is safe in the sense of RFC 9110: GET, HEAD or OPTIONS. */
bool srv_policy_is_read(const char *method);

#endif
