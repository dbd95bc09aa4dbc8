/* http_syntax.h - checks the bytes of a connection before libmicrohttpd reads them.
 *
 * libmicrohttpd 0.9.75 accepts malformed requests that a proxy in front of it may parse differently
 * (bare line feeds, NULs, empty names, two lengths), and it refuses others with HTML pages of its
 * own. So this state machine reads each byte once, between the socket and libmicrohttpd
 * (http_recv.h), and knows where every request, header, body, chunk and trailer ends:
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
 *   S1  Bytes are passed on unchanged, with three exceptions, in which a byte is replaced by one
 *       other byte. Blanks after the value of Content-Length, Transfer-Encoding and Host become
 *       NULs, because libmicrohttpd would take the blanks for a part of the value, but ends it at
 *       a NUL.
 *       Blanks after the size of a chunk become semicolons. The last letter of the name Cookie
 *       becomes '-': hedged reads no cookies, and libmicrohttpd copies them into a buffer that the
 *       cookies of all pages on localhost may overflow.
 *   S2  The first byte that cannot continue a well-formed request is a fault. Neither this byte nor
 *       any byte after it is passed on.
 *   S3  In place of the faulty byte and the rest, libmicrohttpd gets a few bytes that make the
 *       request a well-formed one and end it as soon as possible: for example " HTTP/1.1" and an
 *       empty line after half a target, or "0" and an empty line between two chunks. So
 *       libmicrohttpd calls the handler for this request as for any other, after all earlier
 *       requests were answered in order.
 *   S4  The handler asks srv_syntax_fault whether its request is the faulty one. Requests are
 *       identified by their number on the connection: the state machine and the handler count them
 *       separately, and nothing that a client sends can make the counts differ. The handler answers
 *       the faulty request with a refusal, the last answer, and closes the connection. If
 *       libmicrohttpd begins a request that the state machine has not counted, the request is not
 *       served.
 *   S5  How the bytes are split into reads changes neither what is passed on nor which fault is
 *       found.
 *
 * Rules for requests (RFC 9112); a violation is answered 400 unless another status is given:
 *
 *   F1  METHOD SP TARGET SP VERSION CR LF, after at most SRV_MAX_EMPTY_LINES empty lines. The
 *       method is a token of at most SRV_MAX_METHOD characters (longer: 501), the target is visible
 *       ASCII without '#' and has at most API_MAX_URI characters (414), the version is HTTP/1.x
 *       (another: 505).
 *   F2  Lines end in CR LF. There is no other CR or LF in heads, chunk lines and trailers.
 *   F3  Header names are tokens, followed at once by a colon. Values have no control character
 *       except tab. No header continues on a second line.
 *   F4  There are at most SRV_MAX_FIELDS headers, with at most SRV_MAX_HEAD bytes, including
 *       trailers; headers and target together fit into SRV_MAX_POOLED bytes of libmicrohttpd's
 *       buffer (otherwise: 431).
 *   F5  Authorization, Content-Length, Host, Transfer-Encoding and Origin appear at most once.
 *   F6  Content-Length consists of digits, below 2^63 (413). Transfer-Encoding is chunked (gzip and
 *       others before chunked: 501), in HTTP/1.1, without Content-Length.
 *   F7  A request of HTTP/1.1 has a header Host. Its value has only characters of hosts and ports.
 *   F8  A chunk's size is 1 to SRV_MAX_CHUNK_DIGITS hexadecimal digits, below 2^63. Its extensions
 *       have no control character except tab and at most SRV_MAX_EXTENSION bytes, and those of all
 *       chunks of a request together at most SRV_MAX_HEAD. CR LF follows the data of a chunk. */
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
    /* The header that is being read, if the values of this header are checked; else OTHER. */
    uint8_t field;
    /* Says whether the state machine is before, within or after the text of a header's value. */
    uint8_t phase;
    /* Bit set of those headers that may occur only once and have occurred in this request. */
    uint8_t seen;
    uint8_t text_length;
    bool trailers, old, has_query;
    /* Number of characters of the version, or of digits of a chunk's size, read so far. */
    uint8_t digits;
    uint8_t empty_lines;
    uint8_t fields, parameters;
    uint16_t method, target; /* lengths of the method and of the target, as far as they were read */
    uint16_t extension;      /* bytes of the extensions of the present chunk */
    uint32_t extensions;     /* bytes of the extensions of all chunks of this request */
    uint32_t head, limit;    /* head: bytes of headers read so far; limit: their maximum */
    /* How many bytes of the body or chunk are still to come. While the size of a chunk is read: the
     * value of the digits read so far. */
    uint64_t left;
    uint64_t requests; /* number of requests begun on the connection */
    /* After a fault: those bytes which end the request (rule S3) that are still to be passed on. */
    const char *ending;
    char text[SRV_SYNTAX_TEXT]; /* a header name or transfer coding, in lower case */
} srv_syntax;

/* Checks the first `got` bytes (at least one) of a buffer of `size` bytes, in which they arrived.
 * Returns how many bytes of the buffer are to be passed on, at least one: `got`, or another number
 * if there is a fault, after which the buffer contains bytes of S3. Must not be called after a
 * fault. */
size_t srv_syntax_check(srv_syntax *s, char *bytes, size_t got, size_t size);
/* Must be called after a fault: writes into `bytes` those bytes that end the request (rule S3) and
 * did not fit before. Returns their number, which is 0 when all have been written. */
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
