#include "tests/framing_cases.h"

#include <stdlib.h>
#include <string.h>

#define HOST   "Host: localhost\r\n"
#define GET    "GET /livez HTTP/1.1\r\n"
#define POST   "POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
#define CL     "Content-Length: "
#define TE     "Transfer-Encoding: "
#define CHUNKS POST TE "chunked\r\n\r\n"
#define CUBE   "{\"shape\":\"cube\"}" /* 16 bytes */
#define LAST   "0\r\n\r\n"

#define BYTES(text) text, sizeof(text) - 1
/* Defines a test case whose bytes are a correct request, so that the daemon answers it with this
 * status. */
#define TAKEN(name, bytes, status)                               \
    {                                                            \
        name, BYTES(bytes), "", 0, BYTES(""), status, NULL, 0, 0 \
    }
#define ANSWERED(name, bytes, status, code)                      \
    {                                                            \
        name, BYTES(bytes), "", 0, BYTES(""), status, code, 0, 0 \
    }
/* Defines a test case whose bytes have a framing fault, which the daemon must find. */
#define FAULT(name, bytes, status, code)                         \
    {                                                            \
        name, BYTES(bytes), "", 0, BYTES(""), status, code, 1, 1 \
    }
#define BAD(name, bytes) FAULT(name, bytes, 400, "bad_framing")
#define LONG(name, head, unit, times, tail, status, code)               \
    {                                                                   \
        name, BYTES(head), unit, times, BYTES(tail), status, code, 1, 1 \
    }
#define FITS(name, head, unit, times, tail, status, code)               \
    {                                                                   \
        name, BYTES(head), unit, times, BYTES(tail), status, code, 0, 0 \
    }

static const framing_case cases[] = {
    /* cases of the request line */
    TAKEN("a request", GET HOST "\r\n", 200),
    TAKEN("HTTP/1.0 without Host", "GET /livez HTTP/1.0\r\nConnection: keep-alive\r\n\r\n", 200),
    TAKEN("a higher minor version", "GET /livez HTTP/1.2\r\n" HOST "\r\n", 200),
    TAKEN("an absolute target", "GET http://localhost/livez HTTP/1.1\r\n" HOST "\r\n", 200),
    TAKEN("one empty line first", "\r\n" GET HOST "\r\n", 200),
    TAKEN("eight empty lines first", "\r\n\r\n\r\n\r\n\r\n\r\n\r\n\r\n" GET HOST "\r\n", 200),
    BAD("nine empty lines first", "\r\n\r\n\r\n\r\n\r\n\r\n\r\n\r\n\r\n" GET HOST "\r\n"),
    BAD("an empty line of a bare LF first", "\n" GET HOST "\r\n"),
    BAD("a bare CR first", "\rGET /livez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a blank first", " " GET HOST "\r\n"),
    BAD("a NUL first", "\0" GET HOST "\r\n"),
    BAD("a byte order mark first", "\xef\xbb\xbf" GET HOST "\r\n"),
    BAD("a TLS handshake", "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03"),
    BAD("SSL 2", "\x80\x2e\x01\x00\x02\x00\x15\x00\x00\x00\x10"),
    FAULT("the preface of HTTP/2", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 505,
          "version_not_supported"),
    FAULT("HTTP/2.0", "GET /livez HTTP/2.0\r\n" HOST "\r\n", 505, "version_not_supported"),
    FAULT("HTTP/3.0", "GET /livez HTTP/3.0\r\n" HOST "\r\n", 505, "version_not_supported"),
    FAULT("HTTP/0.9 by name", "GET /livez HTTP/0.9\r\n" HOST "\r\n", 505, "version_not_supported"),
    BAD("HTTP/0.9", "GET /livez\r\n"),
    BAD("HTTP/0.9 with a bare LF", "GET /livez\n"),
    BAD("HTTP/11.1", "GET /livez HTTP/11.1\r\n" HOST "\r\n"),
    BAD("HTTP/1.10", "GET /livez HTTP/1.10\r\n" HOST "\r\n"),
    BAD("HTTP/1", "GET /livez HTTP/1\r\n" HOST "\r\n"),
    BAD("HTTP/1.", "GET /livez HTTP/1.\r\n" HOST "\r\n"),
    BAD("HTTP/1.x", "GET /livez HTTP/1.x\r\n" HOST "\r\n"),
    BAD("http/1.1", "GET /livez http/1.1\r\n" HOST "\r\n"),
    BAD("HTTPS/1.1", "GET /livez HTTPS/1.1\r\n" HOST "\r\n"),
    BAD("a sign in the version", "GET /livez HTTP/+1.1\r\n" HOST "\r\n"),
    BAD("no version but a blank", "GET /livez \r\n" HOST "\r\n"),
    BAD("a blank after the version", "GET /livez HTTP/1.1 \r\n" HOST "\r\n"),
    BAD("a second version", "GET /livez HTTP/1.1 HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a NUL after the version", "GET /livez HTTP/1.1\0\r\n" HOST "\r\n"),
    BAD("a bare LF ends the request line", "GET /livez HTTP/1.1\n" HOST "\r\n"),
    BAD("a bare CR ends the request line", "GET /livez HTTP/1.1\r" HOST "\r\n"),
    BAD("two CR end the request line", "GET /livez HTTP/1.1\r\r\n" HOST "\r\n"),
    BAD("no target", "GET HTTP/1.1\r\n" HOST "\r\n"),
    BAD("two blanks before the target", "GET  /livez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("two blanks before the version", "GET /livez  HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a tab before the target", "GET\t/livez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a blank in the target", "GET /li vez HTTP/1.1\r\n" HOST "\r\n"),
    FAULT("a tab in the target", "GET /li\tvez HTTP/1.1\r\n" HOST "\r\n", 400, "bad_path"),
    FAULT("a NUL in the target", "GET /livez\0x HTTP/1.1\r\n" HOST "\r\n", 400, "bad_path"),
    FAULT("a NUL in the query", "GET /livez?\0 HTTP/1.1\r\n" HOST "\r\n", 400, "bad_path"),
    FAULT("a DEL in the target", "GET /li\x7fvez HTTP/1.1\r\n" HOST "\r\n", 400, "bad_path"),
    FAULT("UTF-8 in the target", "GET /\xc3\xa9 HTTP/1.1\r\n" HOST "\r\n", 400, "bad_path"),
    FAULT("a fragment", "GET /livez#x HTTP/1.1\r\n" HOST "\r\n", 400, "bad_path"),
    BAD("a CR in the target", "GET /li\rvez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("no method", " /livez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a method that is no token", "G@T /livez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a NUL in the method", "GE\0T /livez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a method in quotes", "\"GET\" /livez HTTP/1.1\r\n" HOST "\r\n"),
    BAD("a method alone", "GET\r\n\r\n"),
    ANSWERED("an unknown method", "BREW /livez HTTP/1.1\r\n" HOST "\r\n", 405,
             "method_not_allowed"),
    FAULT("a method of 17 characters", "PROPPATCHPROPPATC /livez HTTP/1.1\r\n" HOST "\r\n", 501,
          "not_implemented"),
    {"the asterisk", BYTES("OPTIONS * HTTP/1.1\r\n" HOST "\r\n"), "", 0, BYTES(""), 400, "bad_path",
     0, 1},

    /* headers */
    TAKEN("a tab before a value", GET HOST "X:\ta\r\n\r\n", 200),
    TAKEN("no blank before a value", GET "Host:localhost\r\n\r\n", 200),
    TAKEN("an empty value", GET HOST "X:\r\n\r\n", 200),
    TAKEN("bytes beyond ASCII in a value", GET HOST "X: \xc3\xa9\xff\r\n\r\n", 200),
    TAKEN("every token character in a name", GET HOST "!#$%&'*+-.^_`|~09AZaz: a\r\n\r\n", 200),
    TAKEN("a name in another case", GET "hOST: localhost\r\n\r\n", 200),
    BAD("a bare LF ends a header", GET "Host: localhost\n\r\n"),
    BAD("a bare LF ends the head", GET HOST "\n"),
    BAD("bare LFs throughout", "GET /livez HTTP/1.1\nHost: localhost\n\n"),
    BAD("a bare CR ends a header", GET HOST "X: a\rY: b\r\n\r\n"),
    BAD("a CR in a value", GET HOST "X: a\rb\r\n\r\n"),
    BAD("a CR before the CR LF of a header", GET HOST "X: a\r\r\n\r\n"),
    BAD("a CR for the empty line", GET HOST "\rX"),
    BAD("a NUL in a value", GET HOST "X: a\0b\r\n\r\n"),
    BAD("a NUL in Host", GET "Host: localhost\0.evil.example\r\n\r\n"),
    BAD("a NUL in a name", GET HOST "X\0Y: a\r\n\r\n"),
    BAD("a NUL before a name", GET HOST "\0X: a\r\n\r\n"),
    BAD("a NUL for the empty line", GET HOST "\0\r\n\r\n"),
    BAD("an ESC in a value", GET HOST "X: \x1b[0m\r\n\r\n"),
    BAD("a DEL in a value", GET HOST "X: a\x7f\r\n\r\n"),
    BAD("an empty name", GET HOST ": a\r\n\r\n"),
    BAD("a blank before the colon", GET HOST "X : a\r\n\r\n"),
    BAD("a tab before the colon", GET HOST "X\t: a\r\n\r\n"),
    BAD("a blank in a name", GET HOST "X Y: a\r\n\r\n"),
    BAD("UTF-8 in a name", GET HOST "\xc3\xa9: a\r\n\r\n"),
    BAD("a parenthesis in a name", GET HOST "X(Y): a\r\n\r\n"),
    BAD("no colon", GET HOST "X\r\n\r\n"),
    BAD("a folded header", GET HOST "X: a\r\n b\r\n\r\n"),
    BAD("a header folded with a tab", GET HOST "X: a\r\n\tb\r\n\r\n"),
    BAD("a folded header without text", GET HOST "X: a\r\n \r\n\r\n"),
    BAD("a blank before the first header", GET " " HOST "\r\n"),
    BAD("a request line among the headers", GET HOST "GET / HTTP/1.1\r\n\r\n"),

    /* cases of the headers Host and Origin */
    TAKEN("a port in Host", GET "Host: 127.0.0.1:1234\r\n\r\n", 200),
    TAKEN("IPv6 in Host", GET "Host: [::1]:9\r\n\r\n", 200),
    TAKEN("a blank after Host", GET "Host: localhost \t\r\n\r\n", 200),
    BAD("no Host", GET "\r\n"),
    BAD("two Hosts", GET HOST "Host: 127.0.0.1\r\n\r\n"),
    BAD("one Host twice", GET HOST "hOST: localhost\r\n\r\n"),
    BAD("two Hosts in HTTP/1.0", "GET /livez HTTP/1.0\r\n" HOST HOST "\r\n"),
    BAD("a blank in Host", GET "Host: local host\r\n\r\n"),
    BAD("a path in Host", GET "Host: localhost/\r\n\r\n"),
    BAD("a user in Host", GET "Host: me@localhost\r\n\r\n"),
    BAD("UTF-8 in Host", GET "Host: loc\xc3\xa1lhost\r\n\r\n"),
    ANSWERED("an empty Host", GET "Host:\r\n\r\n", 421, "wrong_host"),
    ANSWERED("another Host", GET "Host: evil.example\r\n\r\n", 421, "wrong_host"),
    BAD("two Origins",
        POST CL "16\r\nOrigin: http://localhost\r\nOrigin: http://localhost\r\n\r\n" CUBE),
    ANSWERED("another site without Origin", POST CL "16\r\nSec-Fetch-Site: same-site\r\n\r\n" CUBE,
             403, "foreign_origin"),

    /* Content-Length */
    TAKEN("a body", POST CL "16\r\n\r\n" CUBE, 201),
    TAKEN("leading zeros", POST CL "0000000000000000000000000000016\r\n\r\n" CUBE, 201),
    TAKEN("blanks around the length", POST "Content-Length: \t 16 \t \r\n\r\n" CUBE, 201),
    TAKEN("a body after Expect", POST "Expect: 100-continue\r\n" CL "16\r\n\r\n" CUBE, 201),
    TAKEN("a length of zero", GET HOST CL "0\r\n\r\n", 200),
    BAD("an empty length", POST "Content-Length:\r\n\r\n" CUBE),
    BAD("a blank length", POST CL "  \r\n\r\n" CUBE),
    BAD("+16", POST CL "+16\r\n\r\n" CUBE),
    BAD("-1", POST CL "-1\r\n\r\n" CUBE),
    BAD("0x10", POST CL "0x10\r\n\r\n" CUBE),
    BAD("16.0", POST CL "16.0\r\n\r\n" CUBE),
    BAD("1e1", POST CL "1e1\r\n\r\n" CUBE),
    BAD("1_6", POST CL "1_6\r\n\r\n" CUBE),
    BAD("1 6", POST CL "1 6\r\n\r\n" CUBE),
    BAD("\"16\" in quotes", POST CL "\"16\"\r\n\r\n" CUBE),
    BAD("16 and a word", POST CL "16 bytes\r\n\r\n" CUBE),
    BAD("a length of letters", POST CL "sixteen\r\n\r\n" CUBE),
    BAD("a NUL after the length", POST CL "16\0\r\n\r\n" CUBE),
    BAD("a NUL and more after the length", POST CL "16\0 99\r\n\r\n" CUBE),
    BAD("digits beyond ASCII", POST CL "\xef\xbc\x91\r\n\r\n" CUBE),
    BAD("a list of lengths", POST CL "16, 16\r\n\r\n" CUBE),
    BAD("a list of two lengths", POST CL "16,17\r\n\r\n" CUBE),
    BAD("a list with an empty item", POST CL "16,\r\n\r\n" CUBE),
    BAD("two lengths", POST CL "16\r\n" CL "17\r\n\r\n" CUBE),
    BAD("one length twice", POST CL "16\r\ncontent-length: 16\r\n\r\n" CUBE),
    BAD("the second length malformed", POST CL "16\r\n" CL "x\r\n\r\n" CUBE),
    BAD("a blank before the colon of the length", POST "Content-Length : 16\r\n\r\n" CUBE),
    BAD("a folded length", POST "Content-Length:\r\n 16\r\n\r\n" CUBE),
    FAULT("2^63", POST CL "9223372036854775808\r\n\r\n" CUBE, 413, "body_too_large"),
    FAULT("2^64 + 16", POST CL "18446744073709551632\r\n\r\n" CUBE, 413, "body_too_large"),
    FAULT("a hundred digits",
          POST CL "99999999999999999999999999999999999999999999999999"
                  "99999999999999999999999999999999999999999999999999\r\n\r\n",
          413, "body_too_large"),
    {"2^63 - 1", BYTES(POST CL "9223372036854775807\r\n\r\n" CUBE), "", 0, BYTES(""), 413,
     "body_too_large", 0, 1},

    /* Transfer-Encoding */
    TAKEN("a chunked body", CHUNKS "10\r\n" CUBE "\r\n" LAST, 201),
    TAKEN("several chunks", CHUNKS "8\r\n{\"shape\"\r\n8\r\n:\"cube\"}\r\n" LAST, 201),
    TAKEN("chunked in another case", POST TE "ChunKED\r\n\r\n10\r\n" CUBE "\r\n" LAST, 201),
    TAKEN("blanks after chunked", POST TE "chunked \t\r\n\r\n10\r\n" CUBE "\r\n" LAST, 201),
    BAD("both lengths", POST CL "16\r\n" TE "chunked\r\n\r\n10\r\n" CUBE "\r\n" LAST),
    BAD("both lengths, the other way round",
        POST TE "chunked\r\n" CL "16\r\n\r\n10\r\n" CUBE "\r\n" LAST),
    BAD("both lengths, the second malformed", POST TE "chunked\r\n" CL "x\r\n\r\n" LAST),
    BAD("a length of zero and chunks", POST CL "0\r\n" TE "chunked\r\n\r\n" LAST),
    BAD("chunked twice", POST TE "chunked\r\n" TE "chunked\r\n\r\n" LAST),
    BAD("chunked twice in one header", POST TE "chunked, chunked\r\n\r\n" LAST),
    BAD("chunked, then identity", POST TE "chunked\r\n" TE "identity\r\n\r\n" LAST),
    BAD("chunked, identity", POST TE "chunked, identity\r\n\r\n" LAST),
    BAD("identity", POST TE "identity\r\n\r\n" CUBE),
    BAD("gzip alone", POST TE "gzip\r\n\r\n" CUBE),
    FAULT("gzip, chunked", POST TE "gzip, chunked\r\n\r\n" LAST, 501, "not_implemented"),
    FAULT("identity,chunked", POST TE "identity,chunked\r\n\r\n" LAST, 501, "not_implemented"),
    BAD("xchunked", POST TE "xchunked\r\n\r\n" LAST),
    BAD("chunkedx", POST TE "chunkedx\r\n\r\n" LAST),
    BAD("chun ked", POST TE "chun ked\r\n\r\n" LAST),
    BAD("x chunked", POST TE "x chunked\r\n\r\n" LAST),
    BAD("chunked with a parameter", POST TE "chunked;q=1\r\n\r\n" LAST),
    BAD("chunked in quotes", POST TE "\"chunked\"\r\n\r\n" LAST),
    BAD("chunked and a comma", POST TE "chunked,\r\n\r\n" LAST),
    BAD("an empty coding", POST "Transfer-Encoding:\r\n\r\n" LAST),
    BAD("a vertical tab before chunked", POST TE "\x0b"
                                                 "chunked\r\n\r\n" LAST),
    BAD("a NUL after chunked", POST TE "chunked\0\r\n\r\n" LAST),
    BAD("a blank before the colon of the coding", POST "Transfer-Encoding : chunked\r\n\r\n" LAST),
    BAD("a folded coding", POST "Transfer-Encoding:\r\n chunked\r\n\r\n" LAST),
    BAD("chunked in HTTP/1.0",
        "POST /v1/meshes HTTP/1.0\r\n" HOST "Content-Type: application/json\r\n" TE
        "chunked\r\n\r\n10\r\n" CUBE "\r\n" LAST),

    /* chunks */
    TAKEN("leading zeros of a size", CHUNKS "00000010\r\n" CUBE "\r\n000\r\n\r\n", 201),
    TAKEN("an extension", CHUNKS "10;a=b;c=\"d e\"\r\n" CUBE "\r\n0;e\r\n\r\n", 201),
    TAKEN("a blank before an extension", CHUNKS "10 \t;a=b\r\n" CUBE "\r\n" LAST, 201),
    TAKEN("trailers", CHUNKS "10\r\n" CUBE "\r\n0\r\nX: a\r\nY: b\r\n\r\n", 201),
    TAKEN("a length among the trailers", CHUNKS "10\r\n" CUBE "\r\n0\r\n" CL "3\r\n\r\n", 201),
    ANSWERED("no chunk", CHUNKS LAST, 400, "missing_body"),
    BAD("a fault after Expect", POST "Expect: 100-continue\r\n" TE "chunked\r\n\r\n"
                                     "xyz\r\n"),
    BAD("a size with a bare LF", CHUNKS "10\n" CUBE "\r\n" LAST),
    BAD("data with a bare LF", CHUNKS "10\r\n" CUBE "\n" LAST),
    BAD("the last size with a bare LF", CHUNKS "10\r\n" CUBE "\r\n0\n\r\n"),
    BAD("the end with a bare LF", CHUNKS "10\r\n" CUBE "\r\n0\r\n\n"),
    BAD("a size with a bare CR", CHUNKS "10\r" CUBE "\r\n" LAST),
    BAD("data with a bare CR", CHUNKS "10\r\n" CUBE "\r" LAST),
    BAD("the last size with a bare CR", CHUNKS "10\r\n" CUBE "\r\n0\r\r\n\r\n"),
    BAD("no size", CHUNKS "\r\n" CUBE "\r\n" LAST),
    BAD("an extension and no size", CHUNKS ";a=b\r\n" CUBE "\r\n" LAST),
    BAD("a blank before the size", CHUNKS " 10\r\n" CUBE "\r\n" LAST),
    BAD("a blank after the size", CHUNKS "10 \r\n" CUBE "\r\n" LAST),
    BAD("0x10 as a size", CHUNKS "0x10\r\n" CUBE "\r\n" LAST),
    BAD("+10 as a size", CHUNKS "+10\r\n" CUBE "\r\n" LAST),
    BAD("-10 as a size", CHUNKS "-10\r\n" CUBE "\r\n" LAST),
    BAD("1g as a size", CHUNKS "1g\r\n" CUBE "\r\n" LAST),
    BAD("10_ as a size", CHUNKS "10_\r\n" CUBE "\r\n" LAST),
    BAD("a NUL after the size", CHUNKS "10\0\r\n" CUBE "\r\n" LAST),
    BAD("a size of 2^63", CHUNKS "8000000000000000\r\n" CUBE "\r\n" LAST),
    BAD("a size of 2^64 - 1", CHUNKS "ffffffffffffffff\r\n" CUBE "\r\n" LAST),
    BAD("a size of 2^64 + 16", CHUNKS "10000000000000010\r\n" CUBE "\r\n" LAST),
    BAD("a size of 17 digits", CHUNKS "00000000000000010\r\n" CUBE "\r\n" LAST),
    BAD("data longer than its size", CHUNKS "f\r\n" CUBE "\r\n" LAST),
    BAD("data shorter than its size", CHUNKS "11\r\n" CUBE "\r\n" LAST),
    BAD("a negative last size", CHUNKS "10\r\n" CUBE "\r\n-0\r\n\r\n"),
    BAD("a NUL in an extension", CHUNKS "10;a\0\r\n" CUBE "\r\n" LAST),
    BAD("a bare LF in an extension", CHUNKS "10;a\nb\r\n" CUBE "\r\n" LAST),
    BAD("a folded trailer", CHUNKS "10\r\n" CUBE "\r\n0\r\nX: a\r\n b\r\n\r\n"),
    BAD("a trailer without a colon", CHUNKS "10\r\n" CUBE "\r\n0\r\nX\r\n\r\n"),
    BAD("a blank before the colon of a trailer", CHUNKS "10\r\n" CUBE "\r\n0\r\nX : a\r\n\r\n"),
    BAD("a NUL in a trailer", CHUNKS "10\r\n" CUBE "\r\n0\r\nX: a\0\r\n\r\n"),
    BAD("a bare LF in the trailers", CHUNKS "10\r\n" CUBE "\r\n0\r\nX: a\n\r\n"),
    BAD("a request instead of the empty line", CHUNKS "10\r\n" CUBE "\r\n0\r\n" GET HOST "\r\n"),

    /* sizes */
    FITS("a target of 8192 characters", "GET /", "a", 8191, " HTTP/1.1\r\n" HOST "\r\n", 404,
         "no_such_route"),
    LONG("a target of 8193 characters", "GET /", "a", 8192, " HTTP/1.1\r\n" HOST "\r\n", 414,
         "uri_too_long"),
    LONG("a target of 64 KB", "GET /", "a", 65536, " HTTP/1.1\r\n" HOST "\r\n", 414,
         "uri_too_long"),
    LONG("a target without end", "GET /", "a", 200000, "", 414, "uri_too_long"),
    LONG("a query of 64 KB", "GET /livez?", "a=b&", 16384, " HTTP/1.1\r\n" HOST "\r\n", 400,
         "bad_query"),
    LONG("a query of 4,000 parameters", "GET /livez?", "a&", 4000, " HTTP/1.1\r\n" HOST "\r\n", 400,
         "bad_query"),
    LONG("a method without end", "", "A", 100000, "", 501, "not_implemented"),
    FITS("100 headers", GET HOST, "X: a\r\n", 99, "\r\n", 200, NULL),
    LONG("101 headers", GET HOST, "X: a\r\n", 100, "\r\n", 431, "headers_too_large"),
    LONG("1,000 headers", GET HOST, "X: a\r\n", 1000, "\r\n", 431, "headers_too_large"),
    LONG("10,000 headers", GET HOST, "X: a\r\n", 10000, "\r\n", 431, "headers_too_large"),
    FITS("16 KB of headers", GET HOST "X: ", "a", 16364, "\r\n\r\n", 200, NULL),
    LONG("a byte more", GET HOST "X: ", "a", 16365, "\r\n\r\n", 431, "headers_too_large"),
    LONG("32 KB of headers", GET HOST "X: ", "a", 32768, "\r\n\r\n", 431, "headers_too_large"),
    LONG("a megabyte of headers", GET HOST "X: ", "a", 1 << 20, "\r\n\r\n", 431,
         "headers_too_large"),
    LONG("a name without end", GET HOST, "a", 100000, "", 431, "headers_too_large"),
    LONG("blanks without end", GET HOST "X:", " ", 100000, "", 431, "headers_too_large"),
    LONG("blanks after a length", POST CL "16", " ", 100000, "\r\n\r\n" CUBE, 431,
         "headers_too_large"),
    LONG("zeros before a length", POST CL, "0", 100000, "16\r\n\r\n" CUBE, 431,
         "headers_too_large"),
    FITS("14 KB of cookies", GET HOST "Cookie: ", "a=b; ", 2800, "\r\n\r\n", 200, NULL),
    FITS("7,000 cookies", GET HOST "cOOKIE: ", "a;", 7000, "\r\n\r\n", 200, NULL),
    LONG("an extension of 100 KB", CHUNKS "10;", "a", 100000, "\r\n" CUBE "\r\n" LAST, 400,
         "bad_framing"),
    LONG("many extensions", CHUNKS, "1;aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa\r\n \r\n",
         400, LAST, 400, "bad_framing"),
    LONG("a size without end", CHUNKS, "0", 100000, "\r\n\r\n", 400, "bad_framing"),
    LONG("101 trailers", CHUNKS "10\r\n" CUBE "\r\n0\r\n", "X: a\r\n", 101, "\r\n", 431,
         "headers_too_large"),
    LONG("32 KB of trailers", CHUNKS "10\r\n" CUBE "\r\n0\r\nX: ", "a", 32768, "\r\n\r\n", 431,
         "headers_too_large"),
};

size_t framing_case_count(void)
{
    return sizeof cases / sizeof *cases;
}

const framing_case *framing_case_at(size_t i)
{
    return &cases[i];
}

char *framing_case_bytes(const framing_case *c, size_t *length)
{
    size_t unit = strlen(c->unit);
    *length = c->head_length + unit * (size_t)c->times + c->tail_length;
    char *bytes = malloc(*length + 1), *at = bytes;
    if (bytes == NULL) {
        abort();
    }
    memcpy(at, c->head, c->head_length);
    at += c->head_length;
    for (int i = 0; i < c->times; i++, at += unit) {
        memcpy(at, c->unit, unit);
    }
    memcpy(at, c->tail, c->tail_length);
    at[c->tail_length] = '\0';
    return bytes;
}
