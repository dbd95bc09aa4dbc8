/* http_syntax.h - checks the bytes of a connection before libmicrohttpd reads them.
 *
 * libmicrohttpd 0.9.75 takes requests that another server on the way would read differently (bare
 * line feeds, NULs, empty names, two lengths), and what it does refuse it answers with pages of its
 * own. This state machine looks at each byte once, between the socket and libmicrohttpd
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
 *   S1  Bytes pass as they are, each to its own place: what libmicrohttpd reads is what came. There
 *       are three exceptions, one byte for one. Blanks after the value of Content-Length,
 *       Transfer-Encoding and Host become NULs: libmicrohttpd ends a value there, and would else
 *       take the blanks for a part of it. Blanks after the size of a chunk become semicolons. The
 *       last letter of the name Cookie becomes '-': nobody here reads cookies, and libmicrohttpd
 *       copies them into a buffer that those of all pages on localhost together overflow.
 *   S2  The first byte that no well-formed request could have there is a fault. Neither it nor any
 *       byte after it is passed on.
 *   S3  Instead come the few bytes that end the request which was begun, well formed and as soon as
 *       possible: " HTTP/1.1" and an empty line after half a target, "0" and an empty line between
 *       two chunks. So libmicrohttpd calls the handler for this request as for any other, after all
 *       requests before it were answered in their order.
 *   S4  The handler asks srv_syntax_fault whether the request is the faulty one. Requests are told
 *       apart by counting them on both sides of libmicrohttpd, which nothing that a client sends
 *       can imitate. It answers the fault and closes the connection: one answer, and the last. A
 *       request that libmicrohttpd has begun and the machine has not is not served at all.
 *   S5  Where the bytes were cut into pieces changes neither what is passed on nor the fault.
 *
 * What a request must be (RFC 9112; refused with 400 where nothing else is said):
 *
 *   F1  METHOD SP TARGET SP VERSION CR LF, after at most SRV_MAX_EMPTY_LINES empty lines. The
 *       method is a token of at most SRV_MAX_METHOD characters (longer: 501), the target is visible
 *       ASCII without '#' and has at most API_MAX_URI characters (414), the version is HTTP/1.x
 *       (another: 505).
 *   F2  Lines end in CR LF. There is no other CR or LF, in chunk lines and trailers neither.
 *   F3  Header names are tokens that a colon follows at once. Values have no control character but
 *       tab. No header continues on a second line.
 *   F4  At most SRV_MAX_FIELDS headers and SRV_MAX_HEAD bytes of them, trailers included, and with
 *       the target no more than libmicrohttpd's buffer holds, SRV_MAX_POOLED: 431.
 *   F5  Authorization, Content-Length, Host, Transfer-Encoding and Origin appear once at most.
 *   F6  Content-Length is digits alone, below 2^63 (413). Transfer-Encoding is chunked (gzip and
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

/* One connection; {0} before its first byte. Open so that it can be embedded; only http_syntax.c
 * looks inside. */
typedef struct srv_syntax {
    uint8_t state;
    uint8_t fault; /* srv_fault */
    uint8_t field; /* which of the headers that are looked at, or another */
    uint8_t phase; /* of its value: before, within, after */
    uint8_t seen;  /* of those that appear once: a bit each */
    uint8_t text_length;
    bool trailers, old, has_query;
    uint8_t digits; /* of the version, or of a chunk's size */
    uint8_t empty_lines;
    uint8_t fields, parameters;
    uint16_t method, target; /* characters so far */
    uint16_t extension;      /* bytes, of this chunk */
    uint32_t extensions;     /* bytes, of all chunks of this request */
    uint32_t head, limit;    /* bytes of headers so far, and their maximum */
    uint64_t left;           /* bytes of the body or chunk to come; the number while it is read */
    uint64_t requests;       /* begun so far */
    const char *ending;      /* what is still to be passed on after a fault */
    char text[SRV_SYNTAX_TEXT]; /* a name or a transfer coding, in lower case */
} srv_syntax;

/* `got` bytes (at least one) arrived in a buffer that has room for `size`. Returns how many bytes
 * of the buffer are to be passed on, at least one: `got`, or less or more where there is a fault.
 * To be called until there is one. */
size_t srv_syntax_check(srv_syntax *s, char *bytes, size_t got, size_t size);
/* After a fault: what of the ending did not fit, into `bytes`; 0 when it is complete. */
size_t srv_syntax_end(srv_syntax *s, char *bytes, size_t size);
static inline bool srv_syntax_is_faulty(const srv_syntax *s)
{
    return s->fault != SRV_FAULT_NONE;
}
/* Have the first bytes of the request of this number (the first is 1) passed? */
static inline bool srv_syntax_has_begun(const srv_syntax *s, uint64_t request)
{
    return request <= s->requests;
}
/* Is the request of this number (the first is 1) the one with a fault? Then the problem is filled,
 * unless it is NULL. */
bool srv_syntax_fault(const srv_syntax *s, uint64_t request, api_problem *problem);

#endif
