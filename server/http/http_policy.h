/* http_policy.h - who may drive this server from inside a browser.
 *
 * P1  Host must name localhost, a loopback address or a configured name, whatever the port: a page
 *     that resolves its own name to 127.0.0.1 (DNS rebinding) is refused with 421.
 * P2  A write with an Origin needs it to be this server's own (http or https, the authority of
 *     Host) or a configured one; `null` never is: 403. Two are refused before, by http_syntax.h.
 * P3  A write whose Sec-Fetch-Site is cross-site is 403, unless its Origin is a configured one. So
 *     is one whose Sec-Fetch-Site is same-site and that has no Origin: a page on another port or
 *     subdomain sent it, and nothing says which.
 *     A read that the table of routes calls expensive is 403 likewise: see api/request/admit.c.
 * P4  Configured origins, and no others, get CORS headers.
 * P5  Where a request came over TLS, or a trusted proxy tells the scheme, this server's own origin
 *     has that scheme: https:// is not the same site as http:// of that name. Where nothing tells
 *     it, as behind a proxy that is not trusted, both are its own.
 * P6  An answer over TLS tells browsers to use nothing else from now on (RFC 6797), where Host is
 *     a configured name. Localhost is not told: what else runs on that machine may speak HTTP. An
 *     address cannot be told. */
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
    srv_names hosts;   /* without port */
    srv_names origins; /* "https://example.org" */
    srv_proxies proxies;
} srv_policy;

/* May a request name this host ("name", "name:port", "[::1]:port")? NULL, as an HTTP/1.0 client
 * sends it, may: browsers always name one. Fills wrong_host. */
bool srv_policy_host(const srv_policy *policy, const char *host, size_t length,
                     api_problem *problem);
/* Where a request says that it comes from; each but the method may be NULL. */
typedef struct srv_sender {
    const char *method, *host, *origin, *fetch_site;
    srv_scheme scheme; /* by which it came */
} srv_sender;

/* May it be run? Fills foreign_origin. */
bool srv_policy_origin(const srv_policy *policy, const srv_sender *sender, api_problem *problem);
/* P6: is this Host a name of which browsers are told? It may be NULL. */
bool srv_policy_is_name(const srv_policy *policy, const char *host);
/* The configured origin equal to `origin`, NULL when there is none. */
const char *srv_policy_cors(const srv_policy *policy, const char *origin);
/* Is it safe in the sense of RFC 9110: GET, HEAD, OPTIONS? */
bool srv_policy_is_read(const char *method);

#endif
