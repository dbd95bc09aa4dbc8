/* parts.h - the files of a multipart/form-data body: the mesh file, which is passed on as it
 * arrives, and the files that it refers to, which are kept until it is read.
 *
 *     api_parts_new -> api_parts_next ... -> api_parts_end -> api_parts_beside
 *
 * The mesh file is the only file whose name shows a known format; if the name shows none, its media
 * type decides. With ?format= it is the only file of that format. If there is no such file, it is
 * the only one whose first bytes show a format, which is known only at the end of the body. A
 * single file has the format of ?format= whatever its name is. Everything else is refused as
 * unclear_parts.
 *
 * The hash of Idempotency-Key covers the files and not the boundary: another boundary is still the
 * same request. */
#ifndef HE_API_DOCUMENT_PARTS_H
#define HE_API_DOCUMENT_PARTS_H

#include "api/request/exchange.h"
#include "format/io/format.h"

typedef struct api_parts api_parts;

/* How a file is read: by the reader of a format, or as a mesh document. */
typedef struct api_part_kind {
    bool is_mesh;            /* it is one of these two */
    const he_format *format; /* NULL: a mesh document */
} api_part_kind;

typedef enum api_parts_step {
    API_PARTS_MORE,  /* all bytes are used: more are needed */
    API_PARTS_OPEN,  /* the mesh file begins; `kind` says how to read it */
    API_PARTS_BYTES, /* `length` bytes of it, which live until the next call */
    API_PARTS_BAD    /* refused: the problem is filled */
} api_parts_step;

typedef struct api_parts_piece {
    api_part_kind kind;
    const char *bytes;
    size_t length;
} api_parts_piece;

/* Makes a reader for the Content-Type and ?format= of the exchange. Returns NULL with the problem
 * filled. */
api_parts *api_parts_new(api_exchange *x);
void api_parts_free(api_parts *parts);
/* Reads from *at, which lies before `end`, and moves it past the bytes it used. */
api_parts_step api_parts_next(api_exchange *x, api_parts *parts, const char **at, const char *end,
                              api_parts_piece *out);
/* Ends the body. If only now it is known which file is the mesh, out->kind says how to read it and
 * `bytes` are all of it, which live until `parts` are freed; otherwise both are NULL. Returns false
 * with the problem filled. */
bool api_parts_end(api_exchange *x, api_parts *parts, api_parts_piece *out);
/* Returns the files other than the mesh file; they are valid as long as `parts`. */
he_beside *api_parts_beside(api_parts *parts);

#endif
