/* parts.h - reads the files of a multipart/form-data body. The mesh file is passed on as it
 * arrives; the files that it refers to are kept until the mesh file has been read.
 *
 *     api_parts_new -> api_parts_next ... -> api_parts_end -> api_parts_beside
 *
 * The format of a file in the body is known from its name, or else from its media type. The mesh
 * file is the only file whose format is known by these or, with ?format=, the only one with that
 * format. If there is no such file, the mesh file is the only one whose first bytes show a format;
 * which file this is, is known only at the end of the body. A single file has the format of
 * ?format= whatever its name is. A body without a mesh file by these rules, or with several, is
 * refused as unclear_parts.
 *
 * The hash for the Idempotency-Key covers the files and not the boundary, so a request that is
 * repeated with another boundary is recognised. */
#ifndef HE_API_DOCUMENT_PARTS_H
#define HE_API_DOCUMENT_PARTS_H

#include "api/request/exchange.h"
#include "format/io/format.h"

typedef struct api_parts api_parts;

/* How a file is read: by the reader of a format, or as a mesh document. */
typedef struct api_part_kind {
    bool is_mesh; /* the file is a mesh file: a mesh document, or a file of a known format */
    const he_format *format; /* the format of the file; NULL: the file is a mesh document */
} api_part_kind;

typedef enum api_parts_step {
    API_PARTS_MORE,  /* all bytes were read: more are needed */
    API_PARTS_OPEN,  /* the mesh file begins; `kind` says how to read it */
    API_PARTS_BYTES, /* `bytes` has `length` bytes of the mesh file, valid until the next call */
    API_PARTS_BAD    /* refused: the problem is filled */
} api_parts_step;

typedef struct api_parts_piece {
    api_part_kind kind;
    const char *bytes;
    size_t length;
} api_parts_piece;

/* Makes a reader of the exchange's body. Returns NULL with the problem filled if the Content-Type
 * of the body is wrong or memory is out. */
api_parts *api_parts_new(api_exchange *x);
void api_parts_free(api_parts *parts);
/* Reads the body from *at on, at most to `end`, moves *at past the bytes that it has read, and
 * returns why it stopped. */
api_parts_step api_parts_next(api_exchange *x, api_parts *parts, const char **at, const char *end,
                              api_parts_piece *out);
/* Ends the body. If only now it is known which file is the mesh file, out->kind says how to read it
 * and out->bytes is the whole file, valid until `parts` is freed; otherwise out->bytes is NULL.
 * Returns false with the problem filled. */
bool api_parts_end(api_exchange *x, api_parts *parts, api_parts_piece *out);
/* Returns the files other than the mesh file; they are valid as long as `parts`. */
he_beside *api_parts_beside(api_parts *parts);

#endif
