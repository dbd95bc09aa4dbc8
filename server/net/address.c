#define _GNU_SOURCE /* struct ucred */

#include "server/net/address.h"

#include "base/siphash.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>

enum { MAX_PORT = 65535, MAX_HOST = 47 };

bool srv_address_parse_port(const char *text, unsigned *port)
{
    unsigned value = 0;
    size_t length = strlen(text);
    if (length == 0 || length > 5 || strspn(text, "0123456789") != length) {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        value = value * 10 + (unsigned)(text[i] - '0');
    }
    *port = value;
    return value <= MAX_PORT;
}

static bool parse_host(const char *host, srv_address *out)
{
    *out = (srv_address){0};
    if (strcmp(host, "localhost") == 0) {
        host = "127.0.0.1";
    }
    size_t length = strlen(host);
    if (host[0] == '[' && length > 2 && host[length - 1] == ']') {
        char inner[MAX_HOST + 1];
        memcpy(inner, host + 1, length - 2);
        inner[length - 2] = '\0';
        out->socket.v6.sin6_family = AF_INET6;
        out->length = sizeof out->socket.v6;
        return inet_pton(AF_INET6, inner, &out->socket.v6.sin6_addr) == 1;
    }
    out->socket.v4.sin_family = AF_INET;
    out->length = sizeof out->socket.v4;
    return inet_pton(AF_INET, host, &out->socket.v4.sin_addr) == 1;
}

static const char scheme[] = "unix:";

static bool parse_path(const char *path, srv_address *out)
{
    size_t length = strlen(path);
    if (length == 0 || length > SRV_MAX_PATH) {
        return false;
    }
    *out = (srv_address){.length = sizeof out->socket.local};
    out->socket.local.sun_family = AF_UNIX;
    memcpy(out->socket.local.sun_path, path, length);
    return true;
}

bool srv_address_parse(const char *text, srv_address *out)
{
    if (strncmp(text, scheme, sizeof scheme - 1) == 0) {
        return parse_path(text + sizeof scheme - 1, out);
    }
    const char *colon = strrchr(text, ':');
    char host[MAX_HOST + 1];
    unsigned port;
    srv_address address;
    if (colon == NULL || (size_t)(colon - text) >= sizeof host ||
        !srv_address_parse_port(colon + 1, &port)) {
        return false;
    }
    memcpy(host, text, (size_t)(colon - text));
    host[colon - text] = '\0';
    if (!parse_host(host, &address)) {
        return false;
    }
    srv_address_set_port(&address, port);
    *out = address;
    return true;
}

static bool is_loopback_v4(const struct in_addr *address)
{
    return ntohl(address->s_addr) >> 24 == 127;
}

const char *srv_address_path(const srv_address *address)
{
    return address->socket.any.sa_family == AF_UNIX ? address->socket.local.sun_path : NULL;
}

bool srv_address_is_local(const srv_address *address)
{
    if (address->socket.any.sa_family == AF_UNIX) {
        return true;
    }
    if (address->socket.any.sa_family == AF_INET6) {
        return IN6_IS_ADDR_LOOPBACK(&address->socket.v6.sin6_addr);
    }
    return is_loopback_v4(&address->socket.v4.sin_addr);
}

void srv_address_set_port(srv_address *address, unsigned port)
{
    if (address->socket.any.sa_family == AF_INET6) {
        address->socket.v6.sin6_port = htons((uint16_t)port);
    } else {
        address->socket.v4.sin_port = htons((uint16_t)port);
    }
}

unsigned srv_address_port(const srv_address *address)
{
    return address->socket.any.sa_family == AF_INET6 ? ntohs(address->socket.v6.sin6_port)
                                                     : ntohs(address->socket.v4.sin_port);
}

void srv_address_format(const struct sockaddr *address, bool with_port, char out[SRV_ADDRESS_TEXT])
{
    char host[INET6_ADDRSTRLEN] = "-";
    bool v6 = address->sa_family == AF_INET6;
    unsigned port = 0;
    if (address->sa_family == AF_UNIX) {
        const struct sockaddr_un *local = (const struct sockaddr_un *)(const void *)address;
        snprintf(out, SRV_ADDRESS_TEXT, "%s%s", scheme, local->sun_path);
        return;
    }
    if (v6) {
        const struct sockaddr_in6 *in = (const struct sockaddr_in6 *)(const void *)address;
        inet_ntop(AF_INET6, &in->sin6_addr, host, sizeof host);
        port = ntohs(in->sin6_port);
    } else if (address->sa_family == AF_INET) {
        const struct sockaddr_in *in = (const struct sockaddr_in *)(const void *)address;
        inet_ntop(AF_INET, &in->sin_addr, host, sizeof host);
        port = ntohs(in->sin_port);
    }
    if (with_port) {
        snprintf(out, SRV_ADDRESS_TEXT, v6 ? "[%s]:%u" : "%s:%u", host, port);
    } else {
        snprintf(out, SRV_ADDRESS_TEXT, "%s", host);
    }
}

void srv_address_of_peer(int socket, const struct sockaddr *peer, char out[SRV_ADDRESS_TEXT])
{
    struct ucred who;
    socklen_t length = sizeof who;
    if (peer->sa_family != AF_UNIX) {
        srv_address_format(peer, false, out);
    } else if (getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &who, &length) == 0) {
        snprintf(out, SRV_ADDRESS_TEXT, "%suid=%u", scheme, (unsigned)who.uid);
    } else {
        snprintf(out, SRV_ADDRESS_TEXT, "%s", scheme);
    }
}

api_rate_key srv_address_key(const char *text)
{
    static const uint64_t secret[2] = {0, 0};
    api_rate_key key = {{0, 0}};
    struct in6_addr v6;
    struct in_addr v4;
    if (inet_pton(AF_INET, text, &v4) == 1) {
        key.words[1] = UINT64_C(1) << 32 | v4.s_addr;
    } else if (inet_pton(AF_INET6, text, &v6) != 1) {
        key.words[1] = he_siphash_of(secret, text, strlen(text)) | UINT64_C(1) << 63;
    } else if (IN6_IS_ADDR_V4MAPPED(&v6)) {
        memcpy(&v4, v6.s6_addr + 12, sizeof v4);
        key.words[1] = UINT64_C(1) << 32 | v4.s_addr;
    } else {
        memcpy(&key.words[0], v6.s6_addr, sizeof key.words[0]);
    }
    return key;
}

bool srv_address_text_is_loopback(const char *text, size_t length)
{
    char host[MAX_HOST + 1];
    struct in_addr v4;
    struct in6_addr v6;
    if (length > MAX_HOST) {
        return false;
    }
    memcpy(host, text, length);
    host[length] = '\0';
    if (inet_pton(AF_INET, host, &v4) == 1) {
        return is_loopback_v4(&v4);
    }
    return inet_pton(AF_INET6, host, &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}
