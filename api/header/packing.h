/* packing.h - zlib and zstd with memory from base/mem.h: shared by pack.c and unpack.c.
 *
 * zstd takes an allocator only through functions that its header hides behind
 * ZSTD_STATIC_LINKING_ONLY; the shared library exports them too. Without them no budget would count
 * the memory that a client makes the decoders allocate. */
#ifndef HE_API_HEADER_PACKING_H
#define HE_API_HEADER_PACKING_H

#define ZSTD_STATIC_LINKING_ONLY
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

/* Where a stream's memory comes from: the heap, under a ceiling that streams share. */
typedef struct api_packing_memory {
    /* bytes of all streams, with the overhead of each block; NULL: no ceiling */
    _Atomic size_t *lent;
    size_t most;
    /* called at the ceiling: true if another stream freed its memory */
    bool (*make_room)(void *context);
    void *context;
    bool refused; /* an allocation failed by the ceiling, not by lack of memory */
} api_packing_memory;

/* Both fill the allocator hooks of the library. `memory` lives as long as the stream and may be
 * NULL: no ceiling. */
void api_packing_zlib(z_stream *stream, api_packing_memory *memory);
ZSTD_customMem api_packing_zstd(api_packing_memory *memory);

#endif
