/* address.h - network addresses of the form HOST:PORT with a numeric address, or unix:PATH. The
 * only name that is resolved is localhost. */
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

/* The kernel allows SRV_MAX_PATH bytes of a path, followed by a NUL. */
enum {
    SRV_ADDRESS_TEXT = 128,
    SRV_MAX_PATH = sizeof(struct sockaddr_un) - sizeof(sa_family_t) - 1
};

/* Parses "127.0.0.1:8080", "[::1]:0", "localhost:80" or "unix:/run/hedge/socket". Returns false for
 * other texts. */
bool srv_address_parse(const char *text, srv_address *out);
/* Parses a number from 0 to 65535, digits only. */
bool srv_address_parse_port(const char *text, unsigned *port);
/* Returns the path of a Unix socket; NULL for other addresses. */
const char *srv_address_path(const srv_address *address);
/* Returns true if only programs of this machine can connect to the address. */
bool srv_address_is_local(const srv_address *address);
/* Sets the port of an address that is no path. */
void srv_address_set_port(srv_address *address, unsigned port);
unsigned srv_address_port(const srv_address *address);
/* Writes "127.0.0.1:8080", "[::1]:8080" or "unix:/run/hedge/socket"; without the port if
 * `with_port` is false. */
void srv_address_format(const struct sockaddr *address, bool with_port, char out[SRV_ADDRESS_TEXT]);

/* Writes the address, without a port, of the client at the other end of a socket; on a Unix socket
 * the user who runs the client, "unix:uid=1000". */
void srv_address_of_peer(int socket, const struct sockaddr *peer, char out[SRV_ADDRESS_TEXT]);
/* Returns the key under which limits are counted (api/limit/limit.h) for a client's address without
 * a port: the whole address for IPv4, also mapped into IPv6, and the first 64 bits for IPv6,
 * because a client may have all addresses below these. On a Unix socket each user has a key. */
api_rate_key srv_address_key(const char *text);

/* Returns true if `text` of this length is an IPv4 or (without brackets) IPv6 loopback address. */
bool srv_address_text_is_loopback(const char *text, size_t length);

#endif
