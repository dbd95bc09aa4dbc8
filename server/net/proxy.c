#include "server/net/proxy.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MOST_ADDRESS = 64 }; /* greatest length of an address with brackets and a port, plus 1 */

static const char local[] = "unix";

/* --- networks --- */

static bool parse_bits(const char *text, unsigned most, unsigned *out)
{
    unsigned value = 0;
    size_t length = strlen(text);
    if (length == 0 || length > 3 || strspn(text, "0123456789") != length) {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        value = value * 10 + (unsigned)(text[i] - '0');
    }
    *out = value;
    return value <= most;
}

/* Parses an address without a port. */
static bool parse_plain(const char *text, srv_network *out)
{
    out->family = AF_INET;
    out->bits = 32;
    if (inet_pton(AF_INET, text, out->address) == 1) {
        return true;
    }
    out->family = AF_INET6;
    out->bits = 128;
    return inet_pton(AF_INET6, text, out->address) == 1;
}

bool srv_proxies_add(srv_proxies *proxies, const char *text)
{
    srv_network network = {0};
    char address[MOST_ADDRESS];
    size_t length = strcspn(text, "/");
    if (proxies->count == SRV_MAX_PROXIES || length >= sizeof address) {
        return false;
    }
    memcpy(address, text, length);
    address[length] = '\0';
    if (strcmp(text, local) == 0) {
        network.family = AF_UNIX;
    } else if (!parse_plain(address, &network) ||
               (text[length] == '/' &&
                !parse_bits(text + length + 1, network.bits, &network.bits))) {
        return false;
    }
    proxies->items[proxies->count++] = network;
    return true;
}

static bool is_within(const srv_network *network, const srv_network *address)
{
    if (network->family != address->family) {
        return false;
    }
    size_t whole = network->bits / 8;
    unsigned rest = network->bits % 8;
    if (memcmp(network->address, address->address, whole) != 0) {
        return false;
    }
    return rest == 0 ||
           ((network->address[whole] ^ address->address[whole]) & (0xFF00U >> rest & 0xFF)) == 0;
}

bool srv_proxies_has(const srv_proxies *proxies, const char *address)
{
    srv_network peer = {0};
    if (strncmp(address, local, sizeof local - 1) == 0) {
        peer.family = AF_UNIX;
    } else if (!parse_plain(address, &peer)) {
        return false;
    }
    for (size_t i = 0; i < proxies->count; i++) {
        if (is_within(&proxies->items[i], &peer)) {
            return true;
        }
    }
    return false;
}

/* --- one element of a list of addresses --- */

/* Parses "192.0.2.1", "192.0.2.1:80", "2001:db8::1", "[2001:db8::1]" or "[2001:db8::1]:80" and
 * writes the address without the port, in the form of srv_address_format. */
static bool parse_address(const char *text, size_t length, char out[SRV_ADDRESS_TEXT])
{
    char copy[MOST_ADDRESS];
    char *host = copy, *after = NULL;
    srv_network address = {0};
    unsigned port;
    if (length == 0 || length >= sizeof copy) {
        return false;
    }
    memcpy(copy, text, length);
    copy[length] = '\0';
    if (copy[0] == '[') {
        after = strchr(copy, ']');
        if (after == NULL) {
            return false;
        }
        host = copy + 1;
        *after++ = '\0';
    } else {
        char *colon = strchr(copy, ':');
        if (colon != NULL && strchr(colon + 1, ':') == NULL) {
            after = colon;
        }
    }
    if (after != NULL && *after == ':') {
        *after++ = '\0';
        if (!srv_address_parse_port(after, &port)) {
            return false;
        }
    } else if (after != NULL && *after != '\0') {
        return false;
    }
    return parse_plain(host, &address) && (host == copy) != (copy[0] == '[') &&
           (copy[0] != '[' || address.family == AF_INET6) &&
           inet_ntop(address.family, address.address, out, SRV_ADDRESS_TEXT) != NULL;
}

/* Handles the next address of a list by rule T1 (proxy.h); `address` is NULL if the element of the
 * list has no address. Returns true if, as far as the list was read, this element is the
 * client's. */
static bool take_address(srv_told *told, const srv_proxies *proxies, const char *address)
{
    const bool counts = !told->any || address == NULL || !srv_proxies_has(proxies, address);
    told->any = true;
    if (counts) {
        told->malformed = false;
        snprintf(told->address, sizeof told->address, "%s", address == NULL ? "" : address);
    }
    return counts;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static bool read_scheme(const char *text, size_t length, srv_scheme *out)
{
    if (length == 4 && strncasecmp(text, "http", 4) == 0) {
        *out = SRV_SCHEME_HTTP;
        return true;
    }
    *out = SRV_SCHEME_HTTPS;
    return length == 5 && strncasecmp(text, "https", 5) == 0;
}

/* --- X-Forwarded-For, X-Forwarded-Proto --- */

/* Returns the next element of a list that is separated by commas, without the blanks around the
 * element, and moves *at behind it. Returns NULL after the last element. */
static const char *next_element(const char **at, size_t *length)
{
    const char *text = *at;
    if (text == NULL) {
        return NULL;
    }
    const char *end = text + strcspn(text, ",");
    *at = *end == ',' ? end + 1 : NULL;
    while (text < end && is_blank(*text)) {
        text++;
    }
    while (end > text && is_blank(end[-1])) {
        end--;
    }
    *length = (size_t)(end - text);
    return text;
}

static void read_addresses(srv_told *told, const srv_proxies *proxies, const char *value)
{
    size_t length;
    for (const char *text; (text = next_element(&value, &length)) != NULL;) {
        char address[SRV_ADDRESS_TEXT];
        if (parse_address(text, length, address)) {
            take_address(told, proxies, address);
        } else if (length > 0) { /* an empty element of the list does not count: RFC 9110 5.6.1 */
            take_address(told, proxies, NULL);
            told->malformed = true;
        }
    }
}

static bool read_schemes(srv_told *told, const char *value)
{
    size_t length;
    bool good = true;
    for (const char *text; (text = next_element(&value, &length)) != NULL;) {
        if (length > 0) {
            good = read_scheme(text, length, &told->scheme);
        }
    }
    return good;
}

/* --- Forwarded --- */

typedef struct pair {
    const char *name;
    size_t name_length;
    /* The value without quotes; "" if it is too long to be an address or a scheme. */
    char value[MOST_ADDRESS];
} pair;

static size_t token_length(const char *text)
{
    return strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                        "!#$%&'*+-.^_`|~");
}

/* Reads a pair name=token or name="text" at `at`. Returns the position after the pair, or NULL if
 * there is no such pair. */
static const char *read_pair(const char *at, pair *out)
{
    size_t length = 0;
    out->name = at;
    out->name_length = token_length(at);
    at += out->name_length;
    if (out->name_length == 0 || *at++ != '=') {
        return NULL;
    }
    const bool quoted = *at == '"';
    const char *end = at + token_length(at);
    for (at += quoted; quoted ? *at != '"' : at < end; at++) {
        at += quoted && *at == '\\';
        if (*at == '\0') {
            return NULL;
        }
        out->value[length] = *at;
        length += length + 1 < sizeof out->value;
    }
    out->value[length] = '\0';
    return at + quoted;
}

static bool is_named(const pair *p, const char *name)
{
    return strlen(name) == p->name_length && strncasecmp(p->name, name, p->name_length) == 0;
}

/* What one element of a Forwarded header says; its `for` and its `proto` may occur once each. */
typedef struct element {
    bool empty, has_for, has_proto;
    char address[SRV_ADDRESS_TEXT]; /* "": none */
    srv_scheme scheme;
} element;

static bool take_pair(element *out, const pair *p)
{
    if (is_named(p, "for")) {
        bool again = out->has_for;
        out->has_for = true;
        bool hidden = p->value[0] == '_' || strcasecmp(p->value, "unknown") == 0;
        return !again && (hidden || parse_address(p->value, strlen(p->value), out->address));
    }
    if (is_named(p, "proto")) {
        bool again = out->has_proto;
        out->has_proto = true;
        return !again && read_scheme(p->value, strlen(p->value), &out->scheme);
    }
    return true;
}

static const char *skip_blanks(const char *at)
{
    return at + strspn(at, " \t");
}

/* Reads the value of a Forwarded header. Returns false if it is malformed. */
static bool read_forwarded(srv_told *told, const srv_proxies *proxies, const char *at)
{
    for (;;) {
        element e = {.empty = true};
        at = skip_blanks(at);
        while (*at != ',' && *at != '\0') {
            pair p;
            at = read_pair(at, &p);
            if (at == NULL || !take_pair(&e, &p)) {
                return false;
            }
            e.empty = false;
            at = skip_blanks(at);
            if (*at == ';') {
                at = skip_blanks(at + 1);
            } else if (*at != ',' && *at != '\0') {
                return false;
            }
        }
        if (!e.empty && take_address(told, proxies, e.address[0] == '\0' ? NULL : e.address)) {
            told->scheme = e.scheme;
        }
        if (*at++ == '\0') {
            return true;
        }
    }
}

/* --- all header lines of a request --- */

void srv_forwarding_read(srv_forwarding *told, const srv_proxies *proxies, const char *name,
                         const char *value)
{
    if (strcasecmp(name, "Forwarded") == 0) {
        told->broken = !read_forwarded(&told->forwarded, proxies, value) || told->broken;
    } else if (strcasecmp(name, "X-Forwarded-For") == 0) {
        read_addresses(&told->x_forwarded, proxies, value);
    } else if (strcasecmp(name, "X-Forwarded-Proto") == 0) {
        told->no_scheme = !read_schemes(&told->x_forwarded, value);
    }
}

const char *srv_forwarding_end(const srv_forwarding *told, char address[SRV_ADDRESS_TEXT],
                               srv_scheme *scheme)
{
    const srv_told *a = &told->forwarded, *b = &told->x_forwarded;
    if (told->broken) {
        return "Forwarded is not a list of elements such as for=192.0.2.1;proto=https";
    }
    if (b->malformed) {
        return "X-Forwarded-For has, in the place of the client's address, a text that is not an "
               "address";
    }
    if (told->no_scheme) {
        return "X-Forwarded-Proto is neither http nor https";
    }
    if (a->address[0] != '\0' && b->address[0] != '\0' && strcmp(a->address, b->address) != 0) {
        return "Forwarded and X-Forwarded-For name different clients: the proxy has to remove the "
               "one that it does not write";
    }
    if (a->scheme != SRV_SCHEME_UNKNOWN && b->scheme != SRV_SCHEME_UNKNOWN &&
        a->scheme != b->scheme) {
        return "Forwarded and X-Forwarded-Proto name different schemes: the proxy has to remove "
               "the one that it does not write";
    }
    const char *found = a->address[0] != '\0' ? a->address : b->address;
    if (found[0] != '\0') {
        snprintf(address, SRV_ADDRESS_TEXT, "%s", found);
    }
    *scheme = a->scheme != SRV_SCHEME_UNKNOWN ? a->scheme : b->scheme;
    return NULL;
}
