/* http_syntax.h - checks the bytes of a connection before libmicrohttpd reads them.
 *
 * libmicrohttpd 0.9.75 accepts requests that a proxy in front of it may parse differently (bare
 * line feeds, NULs, empty names, two lengths), and its refusals are HTML pages of its own. This
 * state machine reads each byte once, between the socket and libmicrohttpd (http_recv.h), and knows
 * where every request, header, body, chunk and trailer ends:
 *
 *     START --> METHOD --> TARGET --> VERSION --> LINE_LF --> FIELD --(empty line)--> HEAD_LF
 *       ^                                                     |   ^                      |
 *       |                         NAME <--(a header)----------+   |                      |
 *       |                           +--> VALUE --> VALUE_LF ------+                      |
 *       +--(no body)---------------------------------------------------------------------+
 *       +-- BODY <--(Content-Length)-----------------------------------------------------+
 *       |           CHUNK_SIZE <--(chunked)----------------------------------------------+
 *       |             |  ^
 *       |             |  +-- CHUNK_END_LF <-- CHUNK_END <-- CHUNK_DATA <---+
 *       |             +-- (CHUNK_EXTENSION) --> CHUNK_LF --(size above 0)--+
 *       |                                          |
 *       +-- HEAD_LF <-- FIELD ... of trailers <----+
 *
 *   S1  Bytes pass unchanged and in place, with three exceptions, each of one byte for one byte.
 *       Blanks after the value of Content-Length, Transfer-Encoding and Host become NULs:
 *       libmicrohttpd ends a value there, and would otherwise take the blanks for a part of it.
 *       Blanks after the size of a chunk become semicolons. The last letter of the name Cookie
 *       becomes '-': hedged reads no cookies, and libmicrohttpd copies them into a buffer that the
 *       cookies of all pages on localhost may overflow.
 *   S2  The first byte that cannot continue a well-formed request is a fault. Neither it nor any
 *       byte after it is passed on.
 *   S3  Instead libmicrohttpd gets a few bytes that end the request, well formed and as soon as
 *       possible: " HTTP/1.1" and an empty line after half a target, "0" and an empty line between
 *       two chunks. So libmicrohttpd calls the handler for this request like for any other, after
 *       all earlier requests were answered in order.
 *   S4  The handler asks srv_syntax_fault whether the request is the faulty one. Requests are
 *       identified by counting them before and after libmicrohttpd, which nothing that a client
 *       sends can disturb. The handler answers the fault and closes the connection: one answer, and
 *       the last. A request that libmicrohttpd has begun and the state machine has not is not
 *       served at all.
 *   S5  How the bytes are split into reads changes neither what is passed on nor the fault.
 *
 * Rules for requests (RFC 9112); a violation is answered 400 unless another status is given:
 *
 *   F1  METHOD SP TARGET SP VERSION CR LF, after at most SRV_MAX_EMPTY_LINES empty lines. The
 *       method is a token of at most SRV_MAX_METHOD characters (longer: 501), the target is visible
 *       ASCII without '#' and has at most API_MAX_URI characters (414), the version is HTTP/1.x
 *       (another: 505).
 *   F2  Lines end in CR LF. There is no other CR or LF, in chunk lines and trailers neither.
 *   F3  Header names are tokens, followed at once by a colon. Values have no control character but
 *       tab. No header continues on a second line.
 *   F4  At most SRV_MAX_FIELDS headers and SRV_MAX_HEAD bytes of them, trailers included, and with
 *       the target no more than libmicrohttpd's buffer holds, SRV_MAX_POOLED: 431.
 *   F5  Authorization, Content-Length, Host, Transfer-Encoding and Origin appear at most once.
 *   F6  Content-Length consists of digits, below 2^63 (413). Transfer-Encoding is chunked (gzip and
 *       others before chunked: 501), in HTTP/1.1, without Content-Length.
 *   F7  HTTP/1.1 has a Host. It consists of characters that hosts and ports have.
 *   F8  A chunk's size is 1 to SRV_MAX_CHUNK_DIGITS hexadecimal digits, below 2^63. Its extensions
 *       have no control character but tab, and at most SRV_MAX_EXTENSION bytes, SRV_MAX_HEAD in all
 *       chunks of a request. CR LF follows its data. */
#ifndef HE_SERVER_HTTP_SYNTAX_HTTP_SYNTAX_H
#define HE_SERVER_HTTP_SYNTAX_HTTP_SYNTAX_H

#include "server/http/syntax/http_fault.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_SYNTAX_TEXT = 32 };

/* State of one connection; {0} before its first byte. The struct is public so that it can be
 * embedded; only http_syntax.c uses its members. */
typedef struct srv_syntax {
    uint8_t state;
    uint8_t fault; /* an srv_fault */
    uint8_t field; /* the present header: one that is checked, or OTHER */
    uint8_t phase; /* before, within or after the value */
    uint8_t seen;  /* bit set of headers seen that may appear once */
    uint8_t text_length;
    bool trailers, old, has_query;
    uint8_t digits; /* characters of the version, or digits of a chunk's size */
    uint8_t empty_lines;
    uint8_t fields, parameters;
    uint16_t method, target; /* characters so far */
    uint16_t extension;      /* bytes of this chunk's extensions */
    uint32_t extensions;     /* bytes of the extensions of all chunks of this request */
    uint32_t head, limit;    /* bytes of headers so far, and the maximum */
    uint64_t left; /* bytes left of the body or chunk; while its size is read, the size so far */
    uint64_t requests;          /* requests begun so far */
    const char *ending;         /* after a fault: what is still to be passed on */
    char text[SRV_SYNTAX_TEXT]; /* a header name or transfer coding, in lower case */
} srv_syntax;

/* Checks `got` bytes (at least one) that arrived in a buffer of `size` bytes. Returns how many
 * bytes of the buffer to pass on, at least one: `got`, or another number after a fault. Must not be
 * called after a fault. */
size_t srv_syntax_check(srv_syntax *s, char *bytes, size_t got, size_t size);
/* After a fault, writes the part of the ending that did not fit before into `bytes`. Returns 0 when
 * the ending is complete. */
size_t srv_syntax_end(srv_syntax *s, char *bytes, size_t size);
static inline bool srv_syntax_is_faulty(const srv_syntax *s)
{
    return s->fault != SRV_FAULT_NONE;
}
/* Returns true if the first bytes of request number `request` (from 1) have passed the check. */
static inline bool srv_syntax_has_begun(const srv_syntax *s, uint64_t request)
{
    return request <= s->requests;
}
/* Returns true if request number `request` (from 1) is the faulty one. If so, fills `problem`,
 * unless that is NULL. */
bool srv_syntax_fault(const srv_syntax *s, uint64_t request, api_problem *problem);

#endif
