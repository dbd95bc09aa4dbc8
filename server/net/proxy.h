/* proxy.h - who asked a proxy, going by the headers that it adds.
 *
 * Behind a proxy all connections come from the proxy. It tells its client's address and scheme in
 * headers that any client can send as well. They count only where the peer of the connection is one
 * of the proxies that --trusted-proxy names.
 *
 *   T1  Each proxy on the way adds what it knows at the end of the list, so the list is read from
 *       its end: addresses of trusted proxies are passed over, and the first other one is the
 *       client's. What stands before it was written by the client and is not looked at. Where every
 *       address is a trusted proxy's, the first of the list is the client's.
 *   T2  Forwarded (RFC 7239) tells address and scheme in one element. X-Forwarded-For tells
 *       addresses; the last word of X-Forwarded-Proto is the scheme.
 *   T3  A trusted proxy that knows only one of the two lets the other one through as its client
 *       wrote it. So where Forwarded and X-Forwarded-For name different clients the request is
 *       refused, and likewise where the two schemes differ.
 *   T4  An address that is none, in the place that counts, is refused, and so is a Forwarded that
 *       is not well formed anywhere: a quote that the client leaves open would hide what the proxy
 *       added. `for=unknown` and hidden names (`for=_x`) are well formed and tell no address. */
#ifndef HE_SERVER_NET_PROXY_H
#define HE_SERVER_NET_PROXY_H

#include "server/net/address.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_MAX_PROXIES = 32 };

/* The addresses that agree with `address` in its first `bits` bits. */
typedef struct srv_network {
    int family; /* AF_INET, AF_INET6; AF_UNIX: every peer on a Unix socket */
    uint8_t address[16];
    unsigned bits;
} srv_network;

typedef struct srv_proxies {
    srv_network items[SRV_MAX_PROXIES];
    size_t count;
} srv_proxies;

/* "10.0.0.7", "10.0.0.0/8", "2001:db8::/32", or "unix". False when it is none, or one too many. */
bool srv_proxies_add(srv_proxies *proxies, const char *text);
/* Is the address of this text, as srv_address_format writes it without a port, one of a proxy? */
bool srv_proxies_has(const srv_proxies *proxies, const char *address);

typedef enum srv_scheme { SRV_SCHEME_UNKNOWN, SRV_SCHEME_HTTP, SRV_SCHEME_HTTPS } srv_scheme;

/* What one kind of header has told so far; {0} before the first line. Only proxy.c looks inside. */
typedef struct srv_told {
    char address[SRV_ADDRESS_TEXT]; /* "": not told */
    srv_scheme scheme;
    bool any;       /* an element came */
    bool malformed; /* the one that counts is no address */
} srv_told;

typedef struct srv_forwarding {
    srv_told forwarded, x_forwarded;
    bool broken;    /* a line of Forwarded */
    bool no_scheme; /* X-Forwarded-Proto has another last word */
} srv_forwarding;

/* Takes a line of a header, in the order in which they came; headers of other names are passed
 * over. */
void srv_forwarding_read(srv_forwarding *told, const srv_proxies *proxies, const char *name,
                         const char *value);
/* What the lines told, after the last one: the client's address into `address`, which is left as it
 * is where none told one, and the scheme. Returns NULL, or a sentence that says why the request is
 * refused: then nothing is written. */
const char *srv_forwarding_end(const srv_forwarding *told, char address[SRV_ADDRESS_TEXT],
                               srv_scheme *scheme);

#endif
