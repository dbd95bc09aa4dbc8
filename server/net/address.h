/* address.h - HOST:PORT, written as an address, or unix:PATH. Names are not looked up, but for
 * localhost. */
#ifndef HE_SERVER_NET_ADDRESS_H
#define HE_SERVER_NET_ADDRESS_H

#include "api/limit/rate.h"

#include <netinet/in.h>
#include <stdbool.h>
#include <sys/socket.h>
#include <sys/un.h>

typedef struct srv_address {
    union {
        struct sockaddr any;
        struct sockaddr_in v4;
        struct sockaddr_in6 v6;
        struct sockaddr_un local;
    } socket;
    socklen_t length;
} srv_address;

/* SRV_MAX_PATH bytes of a path are what the kernel takes, a NUL after them. */
enum {
    SRV_ADDRESS_TEXT = 128,
    SRV_MAX_PATH = sizeof(struct sockaddr_un) - sizeof(sa_family_t) - 1
};

/* "127.0.0.1:8080", "[::1]:0", "localhost:80", "unix:/run/hedge/socket". False when it is none. */
bool srv_address_parse(const char *text, srv_address *out);
/* A number from 0 to 65535, digits alone. */
bool srv_address_parse_port(const char *text, unsigned *port);
/* The path of a Unix socket; NULL of another address. */
const char *srv_address_path(const srv_address *address);
/* Can only programs of this machine connect to it? */
bool srv_address_is_local(const srv_address *address);
/* The port is that of an address that is no path. */
void srv_address_set_port(srv_address *address, unsigned port);
unsigned srv_address_port(const srv_address *address);
/* "127.0.0.1:8080", "[::1]:8080", "unix:/run/hedge/socket"; without the port when `with_port` is
 * false. */
void srv_address_format(const struct sockaddr *address, bool with_port, char out[SRV_ADDRESS_TEXT]);

/* The client at the other end of a socket: its address without a port, or "unix:uid=1000", the user
 * who runs it, on a Unix socket. */
void srv_address_of_peer(int socket, const struct sockaddr *peer, char out[SRV_ADDRESS_TEXT]);
/* Whose limits a client's address has (api/limit/limit.h), of its text without a port: all of it of
 * IPv4, mapped into IPv6 or not, and of IPv6 the first 64 bits, since a client may have all others.
 * Users of a Unix socket have one each. */
api_rate_key srv_address_key(const char *text);

/* Is `text` of this length an IPv4 or (without brackets) IPv6 loopback address? */
bool srv_address_text_is_loopback(const char *text, size_t length);

#endif
