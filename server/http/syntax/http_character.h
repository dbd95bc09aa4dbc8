/* http_character.h - tells which characters are allowed in which parts of a request (RFC 9110, RFC
 * 3986).
 *
 * The functions are inline because they check every byte of every request. */
#ifndef HE_SERVER_HTTP_SYNTAX_HTTP_CHARACTER_H
#define HE_SERVER_HTTP_SYNTAX_HTTP_CHARACTER_H

#include <stdbool.h>
#include <stdint.h>

/* A set of ASCII characters is two words of 64 bits: `low` has a bit for each character below 64,
 * `high` has a bit for each character from 64 on. */
#define SRV_BIT(c)          (UINT64_C(1) << ((c)&63))
#define SRV_RANGE(from, to) ((SRV_BIT(to) - SRV_BIT(from)) | SRV_BIT(to))
#define SRV_DIGITS          SRV_RANGE('0', '9')
#define SRV_LETTERS         (SRV_RANGE('A', 'Z') | SRV_RANGE('a', 'z'))

static inline bool srv_is_in(unsigned char c, uint64_t low, uint64_t high)
{
    return c < 64 ? (low >> c & 1) != 0 : c < 128 && (high >> (c - 64) & 1) != 0;
}

static inline bool srv_is_token(char c)
{
    static const uint64_t low = SRV_DIGITS | SRV_BIT('!') | SRV_BIT('#') | SRV_BIT('$') |
                                SRV_BIT('%') | SRV_BIT('&') | SRV_BIT('\'') | SRV_BIT('*') |
                                SRV_BIT('+') | SRV_BIT('-') | SRV_BIT('.');
    static const uint64_t high =
        SRV_LETTERS | SRV_BIT('^') | SRV_BIT('_') | SRV_BIT('`') | SRV_BIT('|') | SRV_BIT('~');
    return srv_is_in((unsigned char)c, low, high);
}

/* Returns true if the character may occur in "host:port" by RFC 3986: unreserved characters,
 * percent, sub-delims, colon, and the brackets of IPv6. */
static inline bool srv_is_host(char c)
{
    static const uint64_t low = SRV_DIGITS | SRV_BIT('-') | SRV_BIT('.') | SRV_BIT('%') |
                                SRV_BIT('!') | SRV_BIT('$') | SRV_BIT('&') | SRV_BIT('\'') |
                                SRV_BIT('(') | SRV_BIT(')') | SRV_BIT('*') | SRV_BIT('+') |
                                SRV_BIT(',') | SRV_BIT(';') | SRV_BIT('=') | SRV_BIT(':');
    static const uint64_t high =
        SRV_LETTERS | SRV_BIT('_') | SRV_BIT('~') | SRV_BIT('[') | SRV_BIT(']');
    return srv_is_in((unsigned char)c, low, high);
}

static inline bool srv_is_target(char c)
{
    return c > ' ' && c < 0x7F && c != '#';
}

static inline bool srv_is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Returns true if the character may occur in the value of a header: visible ASCII, a blank, or a
 * byte beyond ASCII. */
static inline bool srv_is_value(char c)
{
    unsigned char u = (unsigned char)c;
    return (u >= ' ' && u != 0x7F) || u == '\t';
}

static inline char srv_lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + ('a' - 'A')) : c;
}

/* Returns the value of a hexadecimal digit, or -1. */
static inline int srv_hexadecimal(char c)
{
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    c = srv_lower(c);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

#endif
