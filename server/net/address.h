/* address.h - parses and prints addresses of the form HOST:PORT, where HOST is a numeric address or
 * localhost, or unix:PATH. No other names are resolved. */
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

/* SRV_ADDRESS_TEXT is enough for the text of any address. SRV_MAX_PATH is the greatest length that
 * the kernel allows for the path of a Unix socket, without the NUL. */
enum {
    SRV_ADDRESS_TEXT = 128,
    SRV_MAX_PATH = sizeof(struct sockaddr_un) - sizeof(sa_family_t) - 1
};

/* Parses "127.0.0.1:8080", "[::1]:0", "localhost:80" or "unix:/run/hedge/socket". Returns false for
 * other texts. */
bool srv_address_parse(const char *text, srv_address *out);
/* Parses a port, a number from 0 to 65535 in decimal digits. Returns false for other texts. */
bool srv_address_parse_port(const char *text, unsigned *port);
/* Returns the path of a Unix socket; NULL for other addresses. */
const char *srv_address_path(const srv_address *address);
/* Returns true if only programs of this machine can connect to the address. */
bool srv_address_is_local(const srv_address *address);
/* Sets the port of an IPv4 or IPv6 address. */
void srv_address_set_port(srv_address *address, unsigned port);
unsigned srv_address_port(const srv_address *address);
/* Writes "127.0.0.1:8080", "[::1]:8080" or "unix:/run/hedge/socket"; without the port if
 * `with_port` is false. */
void srv_address_format(const struct sockaddr *address, bool with_port, char out[SRV_ADDRESS_TEXT]);

/* Writes the address, without a port, of the client at the other end of a connection. On a Unix
 * socket, writes the id of the user who runs the client instead, as in "unix:uid=1000". */
void srv_address_of_peer(int socket, const struct sockaddr *peer, char out[SRV_ADDRESS_TEXT]);
/* Returns the key under which requests and connections of a client's address, given without a port,
 * are counted for limits (api/limit/limit.h). An IPv4 address, also if it is mapped into IPv6, has
 * a key of its own. IPv6 addresses with equal first 64 bits have the same key, because one client
 * may use all of them. On a Unix socket each user has a key. */
api_rate_key srv_address_key(const char *text);

/* Returns true if the `length` bytes of `text` are a loopback address of IPv4, or of IPv6 without
 * brackets. */
bool srv_address_text_is_loopback(const char *text, size_t length);

#endif
