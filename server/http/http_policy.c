#include "server/http/http_policy.h"

#include "server/net/address.h"

#include <string.h>
#include <strings.h>

typedef struct authority {
    const char *host; /* the host of the authority; an IPv6 address has no brackets here */
    size_t host_length;
    long port; /* the port; -1 if no port is given */
} authority;

/* Parses "host", "host:", "host:port" or "[v6]:port". */
static bool parse_authority(const char *text, size_t length, authority *out)
{
    const char *end = text + length, *after;
    if (length > 0 && text[0] == '[') {
        const char *close = memchr(text, ']', length);
        if (close == NULL) {
            return false;
        }
        out->host = text + 1;
        out->host_length = (size_t)(close - text) - 1;
        after = close + 1;
    } else {
        const char *colon = memchr(text, ':', length);
        after = colon == NULL ? end : colon;
        out->host = text;
        out->host_length = (size_t)(after - text);
    }
    out->port = -1;
    if (after < end) {
        if (*after != ':' || end - after > 6) {
            return false;
        }
        for (const char *c = after + 1; c < end; c++) {
            if (*c < '0' || *c > '9') {
                return false;
            }
            out->port = (out->port < 0 ? 0 : out->port * 10) + (*c - '0');
        }
    }
    return out->host_length > 0;
}

static bool same_text(const char *a, size_t length, const char *b)
{
    return strlen(b) == length && strncasecmp(a, b, length) == 0;
}

bool srv_policy_host(const srv_policy *policy, const char *host, size_t length,
                     api_problem *problem)
{
    if (host == NULL) {
        return true;
    }
    authority named;
    if (parse_authority(host, length, &named)) {
        if (same_text(named.host, named.host_length, "localhost") ||
            srv_address_text_is_loopback(named.host, named.host_length)) {
            return true;
        }
        for (size_t i = 0; i < policy->hosts.count; i++) {
            if (same_text(named.host, named.host_length, policy->hosts.items[i])) {
                return true;
            }
        }
    }
    return api_problem_set(problem, API_WRONG_HOST,
                           "the server does not accept the header Host of this request; the "
                           "server's option --allow-host adds a name");
}

bool srv_policy_is_name(const srv_policy *policy, const char *host)
{
    authority named;
    srv_proxies address = {0};
    if (host == NULL || !parse_authority(host, strlen(host), &named)) {
        return false;
    }
    for (size_t i = 0; i < policy->hosts.count; i++) {
        const char *name = policy->hosts.items[i];
        if (same_text(named.host, named.host_length, name)) {
            return strcasecmp(name, "localhost") != 0 && !srv_proxies_add(&address, name);
        }
    }
    return false;
}

bool srv_policy_is_read(const char *method)
{
    return strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0 ||
           strcmp(method, "OPTIONS") == 0;
}

const char *srv_policy_cors(const srv_policy *policy, const char *origin)
{
    if (origin == NULL || strcmp(origin, "null") == 0) {
        return NULL;
    }
    for (size_t i = 0; i < policy->origins.count; i++) {
        if (strcasecmp(origin, policy->origins.items[i]) == 0) {
            return policy->origins.items[i];
        }
    }
    return NULL;
}

/* Returns true if `origin` is this server's own origin: its host and port are those of the header
 * Host, and its scheme is that of the connection, if that is known. If no port is given, it is the
 * default port of the origin's scheme. */
static bool is_own_origin(const char *origin, const char *host, srv_scheme scheme)
{
    long port;
    srv_scheme named;
    if (strncasecmp(origin, "http://", 7) == 0) {
        origin += 7;
        port = 80;
        named = SRV_SCHEME_HTTP;
    } else if (strncasecmp(origin, "https://", 8) == 0) {
        origin += 8;
        port = 443;
        named = SRV_SCHEME_HTTPS;
    } else {
        return false;
    }
    authority from, here;
    if ((scheme != SRV_SCHEME_UNKNOWN && scheme != named) || host == NULL ||
        !parse_authority(origin, strlen(origin), &from) ||
        !parse_authority(host, strlen(host), &here)) {
        return false;
    }
    return from.host_length == here.host_length &&
           strncasecmp(from.host, here.host, here.host_length) == 0 &&
           (from.port < 0 ? port : from.port) == (here.port < 0 ? port : here.port);
}

bool srv_policy_origin(const srv_policy *policy, const srv_sender *sender, api_problem *problem)
{
    const char *origin = sender->origin, *fetch_site = sender->fetch_site;
    if (srv_policy_is_read(sender->method) || srv_policy_cors(policy, origin) != NULL) {
        return true;
    }
    if (origin != NULL && !is_own_origin(origin, sender->host, sender->scheme)) {
        return api_problem_set(problem, API_FOREIGN_ORIGIN,
                               "a page of another origin sent the request; the server's option "
                               "--allow-origin would allow the origin");
    }
    if (fetch_site != NULL && strcasecmp(fetch_site, "cross-site") == 0) {
        return api_problem_set(
            problem, API_FOREIGN_ORIGIN,
            "the header Sec-Fetch-Site says that a page of another site sent the request");
    }
    if (fetch_site != NULL && strcasecmp(fetch_site, "same-site") == 0 && origin == NULL) {
        return api_problem_set(problem, API_FOREIGN_ORIGIN,
                               "the header Sec-Fetch-Site says that a page of another origin of "
                               "this site sent the request, and the header Origin is missing");
    }
    return true;
}
