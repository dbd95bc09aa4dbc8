/* compressor.h - an answer's body, compressed while the server sends it.
 *
 *     api_compressor_new -> _whole -> _begin -> _read ... -> 0
 *
 * Both libraries run at level 1, the fastest. A client that downloads a million faces waits for the
 * compressor and not for the network, and a higher level shrinks a text of coordinates by a few
 * percent at twice the time. Equal bodies give equal bytes, however they are read. */
#ifndef HE_API_HEADER_COMPRESSOR_H
#define HE_API_HEADER_COMPRESSOR_H

#include "api/header/content_coding.h"

#include <stddef.h>
#include <stdint.h>

typedef struct api_compressor api_compressor;

/* The uncompressed body, which is borrowed: bytes, or a reader like that of api_answer. */
typedef struct api_plain {
    const char *bytes; /* NULL: use `read` */
    size_t length;
    int64_t (*read)(void *context, char *buffer, size_t size);
    void *context;
} api_plain;

/* Makes a compressor for a body. Returns NULL when memory is out. `coding` must not be identity. */
api_compressor *api_compressor_new(api_coding coding, const api_plain *plain);
void api_compressor_free(api_compressor *compressor);

/* If the body is no longer than API_COMPRESS_AT_ONCE, returns true with all of its bytes,
 * uncompressed, valid as long as the compressor. It may read from the body, so it must be called
 * before the first api_compressor_read. */
bool api_compressor_whole(api_compressor *compressor, const char **bytes, size_t *length);

/* Allocates the compressor, after api_compressor_whole and before api_compressor_read. Returns
 * false, with nothing changed, when memory is out. */
bool api_compressor_begin(api_compressor *compressor);
/* Makes api_compressor_read send the body uncompressed. It is called instead of
 * api_compressor_begin. */
void api_compressor_give_up(api_compressor *compressor);

/* Reads compressed bytes, as the `read` of an api_answer. Returns what the compressor made of
 * API_COMPRESS_TURN bytes of the body, so that no call takes long, however well the body
 * compresses. It reads more of the body only if there was no output (zlib buffers up to 4 MiB of
 * zeros). */
int64_t api_compressor_read(void *compressor, char *buffer, size_t size);

#endif
