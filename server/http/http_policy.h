/* http_policy.h - which requests of browsers this server accepts.
 *
 * P1  Host must name localhost, a loopback address or a configured name, with any port. So a page
 *     that resolves its own name to 127.0.0.1 (DNS rebinding) is refused with 421.
 * P2  A write with an Origin needs it to be this server's own (http or https, the authority of
 *     Host) or a configured one; `null` never is: 403. Two Origins are refused before, by
 *     http_syntax.h.
 * P3  A write whose Sec-Fetch-Site is cross-site is 403, unless its Origin is a configured one. So
 *     is a write whose Sec-Fetch-Site is same-site and that has no Origin: a page on another port
 *     or subdomain sent it, and it is unknown which. A read that the table of routes calls
 *     expensive is 403 under the same conditions: see api/request/admit.c.
 * P4  Configured origins, and no others, get CORS headers.
 * P5  If a request came over TLS, or a trusted proxy reports its scheme, this server's own origin
 *     has that scheme: https:// is not the same site as http:// of that name. If the scheme is
 *     unknown, as behind a proxy that is not trusted, both count as its own.
 * P6  An answer over TLS tells browsers to use only TLS from now on (RFC 6797), if Host is a
 *     configured name. Localhost is excluded, because other servers on that machine may speak HTTP.
 *     So are addresses, for which browsers ignore the header. */
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

/* Checks that a request may name this host ("name", "name:port", "[::1]:port"). NULL is allowed: an
 * HTTP/1.0 client may leave Host out, and browsers never do. Returns false with wrong_host. */
bool srv_policy_host(const srv_policy *policy, const char *host, size_t length,
                     api_problem *problem);
/* What a request says about its origin; all members but the method may be NULL. */
typedef struct srv_sender {
    const char *method, *host, *origin, *fetch_site;
    srv_scheme scheme; /* the scheme of the connection */
} srv_sender;

/* Checks whether a request with this origin may run. Returns false with foreign_origin. */
bool srv_policy_origin(const srv_policy *policy, const srv_sender *sender, api_problem *problem);
/* Returns true if this Host (which may be NULL) is a configured name, so that rule P6 applies. */
bool srv_policy_is_name(const srv_policy *policy, const char *host);
/* Returns the configured origin equal to `origin`, or NULL. */
const char *srv_policy_cors(const srv_policy *policy, const char *origin);
/* Returns true if the method is safe in the sense of RFC 9110: GET, HEAD or OPTIONS. */
bool srv_policy_is_read(const char *method);

#endif
