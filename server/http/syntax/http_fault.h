/* http_fault.h - the faults that the bytes of a request may have, with the answer to each.
 *
 * http_syntax.h finds faults. The limits that it enforces are defined here, because the messages
 * contain them. */
#ifndef HE_SERVER_HTTP_SYNTAX_HTTP_FAULT_H
#define HE_SERVER_HTTP_SYNTAX_HTTP_FAULT_H

#include "api/json/problem.h"

enum {
    SRV_MAX_EMPTY_LINES = 8,
    SRV_MAX_METHOD = 16,
    /* The most parameters that a query may have; libmicrohttpd needs memory for each. */
    SRV_MAX_PARAMETERS = 64,
    SRV_MAX_FIELDS = 100,
    SRV_MAX_HEAD = 16 * 1024,
    SRV_MAX_CHUNK_DIGITS = 16,
    SRV_MAX_EXTENSION = 256,
    /* The most memory that libmicrohttpd may need for target and headers: their bytes, and
     * SRV_POOLED_FIELD for each header and each parameter. The rest of the connection's buffer is
     * for the head of the answer. */
    SRV_MAX_POOLED = 28 * 1024,
    SRV_POOLED_FIELD = 64
};

/* The table of faults. Each row is X(constant, code of api/json/problem.h without API_, message,
 * limit that is appended to the message or 0). */
#define SRV_FAULT_MAP(X)                                                                          \
    X(TLS, BAD_FRAMING, "the bytes begin a TLS handshake, but this port speaks plain HTTP", 0)    \
    X(EMPTY_LINES, BAD_FRAMING, "too many empty lines before a request", SRV_MAX_EMPTY_LINES)     \
    X(METHOD, BAD_FRAMING, "the method has a character that is not allowed in a method", 0)       \
    X(LONG_METHOD, NOT_IMPLEMENTED, "the method has too many characters", SRV_MAX_METHOD)         \
    X(TARGET, BAD_PATH, "a character of the request target must be percent-encoded", 0)           \
    X(LONG_TARGET, URI_TOO_LONG, "path and query have too many characters", API_MAX_URI)          \
    X(PARAMETERS, BAD_QUERY, "the query has too many parameters", SRV_MAX_PARAMETERS)             \
    X(VERSION, BAD_FRAMING, "the request line is not of the form METHOD TARGET HTTP/1.1", 0)      \
    X(OTHER_VERSION, VERSION_NOT_SUPPORTED, "the version is neither HTTP/1.0 nor HTTP/1.1", 0)    \
    X(BARE_CR, BAD_FRAMING, "no line feed follows a carriage return", 0)                          \
    X(BARE_LF, BAD_FRAMING, "a line ends without a carriage return", 0)                           \
    X(FOLDED, BAD_FRAMING, "a header begins with a blank or continues on a second line", 0)       \
    X(NAMELESS, BAD_FRAMING, "a header has no name", 0)                                           \
    X(NAME, BAD_FRAMING,                                                                          \
      "the name of a header has a character that is not allowed, or is not directly followed by " \
      "a colon",                                                                                  \
      0)                                                                                          \
    X(VALUE, BAD_FRAMING, "the value of a header has a control character", 0)                     \
    X(FIELDS, HEADERS_TOO_LARGE, "there are too many headers", SRV_MAX_FIELDS)                    \
    X(LARGE_HEAD, HEADERS_TOO_LARGE,                                                              \
      "the headers have too many bytes, alone or together with a long path and query",            \
      SRV_MAX_HEAD)                                                                               \
    X(REPEATED, BAD_FRAMING,                                                                      \
      "Authorization, Content-Length, Host, Origin or Transfer-Encoding is given twice", 0)       \
    X(LENGTH, BAD_FRAMING, "Content-Length is not a single number in decimal digits", 0)          \
    X(LARGE_LENGTH, BODY_TOO_LARGE, "Content-Length is above 9223372036854775807", 0)             \
    X(CODING, BAD_FRAMING,                                                                        \
      "chunked is not the last coding in Transfer-Encoding, or is given twice", 0)                \
    X(OTHER_CODING, NOT_IMPLEMENTED, "the only supported Transfer-Encoding is chunked", 0)        \
    X(OLD_CODING, BAD_FRAMING, "an HTTP/1.0 request must not have a Transfer-Encoding", 0)        \
    X(TWO_LENGTHS, BAD_FRAMING, "Content-Length and Transfer-Encoding exclude each other", 0)     \
    X(HOST, BAD_FRAMING, "the header Host has a character that a host name cannot have", 0)       \
    X(NO_HOST, BAD_FRAMING, "HTTP/1.1 needs a Host header", 0)                                    \
    X(CHUNK_SIZE, BAD_FRAMING, "the size of a chunk is not a hexadecimal number below 2^63", 0)   \
    X(EXTENSION, BAD_FRAMING, "an extension of a chunk has a control character", 0)               \
    X(LARGE_EXTENSION, BAD_FRAMING, "the extensions of a chunk have too many bytes",              \
      SRV_MAX_EXTENSION)                                                                          \
    X(CHUNK_END, BAD_FRAMING, "no CR LF follows the data of a chunk", 0)

typedef enum srv_fault {
    SRV_FAULT_NONE,
#define SRV_FAULT_ENUM(constant, code, text, limit) SRV_FAULT_##constant,
    SRV_FAULT_MAP(SRV_FAULT_ENUM)
#undef SRV_FAULT_ENUM
        SRV_FAULT_COUNT
} srv_fault;

/* Fills the problem for a fault other than SRV_FAULT_NONE. */
void srv_fault_describe(srv_fault fault, api_problem *problem);

#endif
