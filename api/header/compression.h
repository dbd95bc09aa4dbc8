/* compression.h - the only header that gives access to the compression libraries. It lets zlib and
 * zstd take their memory from base/mem.h; ISA-L uses memory of the caller.
 *
 * The functions of zstd that take an allocator are declared only if ZSTD_STATIC_LINKING_ONLY is
 * defined, but the shared library exports them too. Without these functions, the memory that
 * decoders allocate for the bodies of clients would count towards no budget. */
#ifndef HE_API_HEADER_COMPRESSION_H
#define HE_API_HEADER_COMPRESSION_H

#define ZSTD_STATIC_LINKING_ONLY
#include <isa-l/igzip_lib.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

/* Limits the memory that compression streams allocate from the heap; a group of streams shares one
 * ceiling. */
typedef struct api_compression_memory {
    /* The bytes that all streams of the group have allocated, including the overhead of each
     * block. */
    _Atomic size_t *lent;
    size_t most;
    /* Called when an allocation would exceed the ceiling: returns true if another stream freed its
     * memory. */
    bool (*make_room)(void *context);
    void *context;
    /* True if an allocation failed because of the ceiling, not because memory was out. */
    bool refused;
} api_compression_memory;

/* api_compression_zlib and api_compression_zstd set the allocator of a stream. `memory` must live
 * as long as the stream; NULL means that there is no ceiling. */
void api_compression_zlib(z_stream *stream, api_compression_memory *memory);
ZSTD_customMem api_compression_zstd(api_compression_memory *memory);

#endif
