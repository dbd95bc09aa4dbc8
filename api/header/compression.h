/* compression.h - zlib and zstd with memory from base/mem.h: shared by compressor.c and
 * decompressor.c.
 *
 * zstd takes an allocator only through functions that its header hides behind
 * ZSTD_STATIC_LINKING_ONLY; the shared library exports them too. Without them no budget would count
 * the memory that a client makes the decoders allocate. */
#ifndef HE_API_HEADER_COMPRESSION_H
#define HE_API_HEADER_COMPRESSION_H

#define ZSTD_STATIC_LINKING_ONLY
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

/* Where the memory of a compression stream comes from: the heap, under a ceiling that all streams
 * share. */
typedef struct api_compression_memory {
    /* The bytes that all streams have allocated, with the overhead of each block; NULL means no
     * ceiling. */
    _Atomic size_t *lent;
    size_t most;
    /* Called when an allocation would exceed the ceiling: returns true if another stream freed its
     * memory. */
    bool (*make_room)(void *context);
    void *context;
    bool refused; /* an allocation failed by the ceiling, not by lack of memory */
} api_compression_memory;

/* Each fills the allocator hooks of its library. `memory` must live as long as the stream; it may
 * be NULL, which means no ceiling. */
void api_compression_zlib(z_stream *stream, api_compression_memory *memory);
ZSTD_customMem api_compression_zstd(api_compression_memory *memory);

#endif
