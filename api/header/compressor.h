/* compressor.h - compresses an answer's body while the server sends it.
 *
 *     api_compressor_new -> _whole -> _begin -> _read ... -> 0
 *
 * The compressors, ISA-L for gzip and zstd, run at level 1: about as fast as the loopback network
 * takes the bytes, so that a client which accepts gzip only because its library does waits little
 * longer for it. Equal bodies are compressed to equal bytes, in however many pieces they are
 * read. */
#ifndef HE_API_HEADER_COMPRESSOR_H
#define HE_API_HEADER_COMPRESSOR_H

#include "api/header/content_coding.h"

#include <stddef.h>
#include <stdint.h>

typedef struct api_compressor api_compressor;

/* An uncompressed body, which is borrowed: either all its bytes, or a function `read` that reads it
 * piece by piece, like the member `read` of api_answer. */
typedef struct api_plain {
    const char *bytes; /* the whole body; NULL: the body is read with `read` */
    size_t length;
    int64_t (*read)(void *context, char *buffer, size_t size);
    void *context;
} api_plain;

/* Makes a compressor for a body. Returns NULL when memory is out. `coding` must not be identity. */
api_compressor *api_compressor_new(api_coding coding, const api_plain *plain);
void api_compressor_free(api_compressor *compressor);

/* If the body is no longer than API_COMPRESS_AT_ONCE, returns true and sets `bytes` and `length` to
 * the whole uncompressed body, valid as long as the compressor. It may read from the body, so it
 * must be called before the first api_compressor_read. */
bool api_compressor_whole(api_compressor *compressor, const char **bytes, size_t *length);

/* Allocates the compressor, after api_compressor_whole and before api_compressor_read. Returns
 * false, with nothing changed, when memory is out. */
bool api_compressor_begin(api_compressor *compressor);
/* Makes api_compressor_read send the body uncompressed. It is called instead of
 * api_compressor_begin. */
void api_compressor_give_up(api_compressor *compressor);

/* Reads compressed bytes; it can be the `read` of an api_answer. A call compresses about
 * API_COMPRESS_TURN bytes of the body, so that it does not take long even if the body compresses
 * very well. It compresses more only as long as there is no output (ISA-L buffers up to 4 MiB of
 * zeros). */
int64_t api_compressor_read(void *compressor, char *buffer, size_t size);

#endif
