/* proxy.h - finds the client of a proxy from the headers that the proxy adds.
 *
 * If hedged is behind a proxy, all connections come from the proxy. The proxy sends the address and
 * the scheme of its client in headers, which any client can forge. So these headers count only if
 * the connection comes from one of the proxies that --trusted-proxy names.
 *
 *   T1  Each proxy on the way appends the address of its own client to the list. So the list is
 *       read from its end: addresses of trusted proxies are skipped, and the first other address is
 *       the client's. What precedes that address is ignored, because the client may have written
 *       it. If all addresses are those of trusted proxies, the first of the list is the client's.
 *   T2  Forwarded (RFC 7239) has address and scheme in one element. X-Forwarded-For has
 *       addresses; the last word of X-Forwarded-Proto is the scheme.
 *   T3  A trusted proxy that sets only one of the two headers passes the other one on as its client
 *       wrote it. So if Forwarded and X-Forwarded-For name different clients the request is
 *       refused, and also if the two schemes differ.
 *   T4  A request is refused if the element that is the client's by T1 is no valid address, or if a
 *       Forwarded header is malformed anywhere: a quotation mark that the client leaves open would
 *       hide what the proxy added. `for=unknown` and hidden names (`for=_x`) are well formed and
 *       have no address. */
#ifndef HE_SERVER_NET_PROXY_H
#define HE_SERVER_NET_PROXY_H

#include "server/net/address.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_MAX_PROXIES = 32 };

/* A network: all addresses that share their first `bits` bits with `address`. */
typedef struct srv_network {
    int family; /* AF_INET, AF_INET6, or AF_UNIX, which stands for every client on a Unix socket */
    uint8_t address[16];
    unsigned bits;
} srv_network;

typedef struct srv_proxies {
    srv_network items[SRV_MAX_PROXIES];
    size_t count;
} srv_proxies;

/* Adds a trusted proxy: "10.0.0.7", "10.0.0.0/8", "2001:db8::/32", or "unix". Returns false if the
 * text is none of these, or if there are too many. */
bool srv_proxies_add(srv_proxies *proxies, const char *text);
/* Returns true if the address (as srv_address_format writes it without a port) is that of a trusted
 * proxy. */
bool srv_proxies_has(const srv_proxies *proxies, const char *address);

typedef enum srv_scheme { SRV_SCHEME_UNKNOWN, SRV_SCHEME_HTTP, SRV_SCHEME_HTTPS } srv_scheme;

/* What the lines of the header Forwarded, or those of X-Forwarded-For and X-Forwarded-Proto, have
 * said so far about the client; {0} before the first line. Only proxy.c uses the members. */
typedef struct srv_told {
    /* The client's address by rule T1; "" if the headers have none. */
    char address[SRV_ADDRESS_TEXT];
    srv_scheme scheme;
    bool any;       /* whether there was an element */
    bool malformed; /* true if the element that is the client's by rule T1 is no valid address */
} srv_told;

typedef struct srv_forwarding {
    srv_told forwarded, x_forwarded;
    bool broken;    /* whether a line of the header Forwarded is malformed */
    bool no_scheme; /* whether the last word of X-Forwarded-Proto is no scheme */
} srv_forwarding;

/* Reads a header line. Lines must be passed in the order in which they arrived; headers with other
 * names are ignored. */
void srv_forwarding_read(srv_forwarding *told, const srv_proxies *proxies, const char *name,
                         const char *value);
/* Evaluates the header lines after the last one was read: writes the client's address to `address`,
 * which is unchanged if there was none, and the scheme. Returns NULL, or a sentence that says why
 * the request is refused; then nothing is written. */
const char *srv_forwarding_end(const srv_forwarding *told, char address[SRV_ADDRESS_TEXT],
                               srv_scheme *scheme);

#endif
