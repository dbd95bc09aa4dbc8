/* parts.h - the files of a multipart/form-data body: that of the mesh, which is handed on as it
 * arrives, and those it refers to, which are kept until it is read.
 *
 *     api_parts_new -> api_parts_next ... -> api_parts_end -> api_parts_beside
 *
 * The mesh's file is the only one whose name or, where that says nothing, media type is of a format
 * that is read; with ?format= the only one of that format. Where none is, it is the only one whose
 * first bytes are, which is known at the end alone; a file that comes alone is of the format that
 * was asked for whatever its name. Anything else is refused as unclear_parts.
 *
 * What was sent counts for Idempotency-Key, not how: another boundary is the same request. */
#ifndef HE_API_DOCUMENT_PARTS_H
#define HE_API_DOCUMENT_PARTS_H

#include "api/request/exchange.h"
#include "format/io/format.h"

typedef struct api_parts api_parts;

/* How a file is read: by a format's reader, or as a mesh document. */
typedef struct api_part_kind {
    bool is_mesh;            /* by one of these */
    const he_format *format; /* NULL: as a document */
} api_part_kind;

typedef enum api_parts_step {
    API_PARTS_MORE,  /* the bytes are used up */
    API_PARTS_OPEN,  /* the mesh's file begins: `kind` */
    API_PARTS_BYTES, /* `length` of it, which live until the next call */
    API_PARTS_BAD    /* refused: the problem is filled */
} api_parts_step;

typedef struct api_parts_piece {
    api_part_kind kind;
    const char *bytes;
    size_t length;
} api_parts_piece;

/* By the Content-Type and ?format= of the exchange. NULL with the problem filled. */
api_parts *api_parts_new(api_exchange *x);
void api_parts_free(api_parts *parts);
/* Moves `*at`, which goes up to `end`, behind what was used. */
api_parts_step api_parts_next(api_exchange *x, api_parts *parts, const char **at, const char *end,
                              api_parts_piece *out);
/* The body is whole. Where the mesh's file is known only now, out->kind says what it is and
 * `bytes` are all of it, which live until `parts` are freed; else those are NULL. False with the
 * problem filled. */
bool api_parts_end(api_exchange *x, api_parts *parts, api_parts_piece *out);
/* The other files. Theirs is the life of `parts`. */
he_beside *api_parts_beside(api_parts *parts);

#endif
