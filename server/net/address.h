/* address.h - HOST:PORT, written as an address. Names are not looked up, but for localhost. */
#ifndef HE_SERVER_NET_ADDRESS_H
#define HE_SERVER_NET_ADDRESS_H

#include <netinet/in.h>
#include <stdbool.h>
#include <sys/socket.h>

typedef struct srv_address {
    union {
        struct sockaddr any;
        struct sockaddr_in v4;
        struct sockaddr_in6 v6;
    } socket;
    socklen_t length;
} srv_address;

enum { SRV_ADDRESS_TEXT = 64 };

/* "127.0.0.1:8080", "[::1]:0", "localhost:80". False when it is none. */
bool srv_address_parse(const char *text, srv_address *out);
bool srv_address_is_loopback(const srv_address *address);
void srv_address_set_port(srv_address *address, unsigned port);
unsigned srv_address_port(const srv_address *address);
/* "127.0.0.1:8080", "[::1]:8080"; without the port when `with_port` is false. */
void srv_address_format(const struct sockaddr *address, bool with_port, char out[SRV_ADDRESS_TEXT]);

/* Is `text` of this length an IPv4 or (without brackets) IPv6 loopback address? */
bool srv_address_text_is_loopback(const char *text, size_t length);

#endif
