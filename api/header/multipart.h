/* multipart.h - reads a body that contains several files, multipart/form-data (RFC 7578), as it
 * arrives.
 *
 *     api_multipart_new -> api_multipart_next ... -> api_multipart_end
 *
 *     --BOUNDARY
 *     Content-Disposition: form-data; name="files"; filename="part.bin"
 *     Content-Type: application/octet-stream
 *
 *     the bytes
 *     --BOUNDARY--
 *
 * Names are UTF-8 without control characters. In a quoted name \" and \\ stand for " and \, and %22
 * stands for ", as browsers write it; any other backslash or escape is taken literally. The name of
 * a part without a filename is its field name. Bytes before the first and after the last delimiter
 * are skipped, and so are unknown headers.
 *
 * These bodies are refused as bad_multipart (400), with the offset of the fault: lines where a
 * header should be but is not, a part without a name or with a disposition other than form-data, a
 * parameter given twice, filename* (which RFC 7578 does not allow), a part that is itself multipart
 * or has a transfer coding, more than API_MAX_PARTS, more than API_MAX_PART_HEADERS bytes of
 * headers, a name longer than API_MAX_PART_NAME, a body that ends before its last delimiter. */
#ifndef HE_API_HEADER_MULTIPART_H
#define HE_API_HEADER_MULTIPART_H

#include "api/json/problem.h"
#include "api/limits.h"

typedef struct api_multipart api_multipart;

/* What api_multipart_next found in the bytes. */
typedef enum api_multipart_step {
    API_MULTIPART_MORE,  /* all bytes were read: more are needed */
    API_MULTIPART_BEGIN, /* a part begins: `part` describes it */
    API_MULTIPART_BYTES, /* `bytes` has content of the part, valid until the next call */
    API_MULTIPART_END,   /* the part ends */
    API_MULTIPART_BAD    /* refused: the problem is filled; no call may follow */
} api_multipart_step;

/* A part of the body: the name and type from its headers. The texts are valid until the next part
 * begins. */
typedef struct api_part {
    const char *name; /* file name; the field name if there is none */
    const char *type; /* value of the part's Content-Type; NULL if it has none */
} api_part;

typedef struct api_multipart_piece {
    api_part part;
    const char *bytes;
    size_t length;
} api_multipart_piece;

/* Makes a reader for a body with this Content-Type. Its parameter `boundary` must be 1 to 70 of the
 * characters that RFC 2046 allows.
 * Returns NULL with bad_header or no_memory. */
api_multipart *api_multipart_new(const char *content_type, api_problem *problem);
void api_multipart_free(api_multipart *m);
/* Reads the body from *at, at most to `end`, until there is something to report, and moves *at past
 * the bytes that it has read. */
api_multipart_step api_multipart_next(api_multipart *m, const char **at, const char *end,
                                      api_multipart_piece *out, api_problem *problem);
/* Ends the body. Returns false with the problem filled if the last delimiter is missing. */
bool api_multipart_end(const api_multipart *m, api_problem *problem);

#endif
