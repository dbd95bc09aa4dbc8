/* multipart.h - a body of several files: multipart/form-data (RFC 7578), read as it arrives.
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
 * Names are taken as they are given, UTF-8 without control characters: in a quoted name \" and \\
 * stand for " and \, and %22 for ", as browsers write it; any other backslash or escape is itself.
 * A part without a filename is named by its name. What comes before the first delimiter and behind
 * the last is passed over, as are headers that are not looked at.
 *
 * Refused as bad_multipart (400), with the byte of the body: lines that are no headers, a part
 * without a name or of another disposition, a parameter given twice, filename* (which RFC 7578 does
 * not allow), a part that is itself multipart or has a transfer coding, more than API_MAX_PARTS,
 * more than API_MAX_PART_HEADERS bytes of headers, a name of more than API_MAX_PART_NAME, a body
 * that ends before its last delimiter. */
#ifndef HE_API_HEADER_MULTIPART_H
#define HE_API_HEADER_MULTIPART_H

#include "api/json/problem.h"
#include "api/limits.h"

typedef struct api_multipart api_multipart;

/* What is next in the bytes at hand. */
typedef enum api_multipart_step {
    API_MULTIPART_MORE,  /* nothing: they are used up */
    API_MULTIPART_BEGIN, /* a part begins, `part` says which */
    API_MULTIPART_BYTES, /* `bytes` of it, which live until the next call */
    API_MULTIPART_END,   /* it is whole */
    API_MULTIPART_BAD    /* refused: the problem is filled, and this is the last call */
} api_multipart_step;

/* Texts live until the next part begins. */
typedef struct api_part {
    const char *name; /* of the file, else of the field */
    const char *type; /* Content-Type, NULL where there is none */
} api_part;

typedef struct api_multipart_piece {
    api_part part;
    const char *bytes;
    size_t length;
} api_multipart_piece;

/* The parameter `boundary` of `content_type` is 1 to 70 of the characters that RFC 2046 allows.
 * NULL with the problem filled: bad_header, no_memory. */
api_multipart *api_multipart_new(const char *content_type, api_problem *problem);
void api_multipart_free(api_multipart *m);
/* Moves `*at`, which goes up to `end`, behind what was used. */
api_multipart_step api_multipart_next(api_multipart *m, const char **at, const char *end,
                                      api_multipart_piece *out, api_problem *problem);
/* The body ends here: was the last delimiter there? */
bool api_multipart_end(const api_multipart *m, api_problem *problem);

#endif
