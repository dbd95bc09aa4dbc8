/* packing.h - zlib and zstd with memory from base/mem.h: what pack.c and unpack.c share.
 *
 * That of zstd is lent by functions its header keeps for ZSTD_STATIC_LINKING_ONLY. They are
 * exported by the shared library too; without them what a client makes the server hold would be
 * counted by nobody and bounded by no budget. */
#ifndef HE_API_HEADER_PACKING_H
#define HE_API_HEADER_PACKING_H

#define ZSTD_STATIC_LINKING_ONLY
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

/* What a stream takes from memory, and from a ceiling that it has in common with others. */
typedef struct api_packing_memory {
    _Atomic size_t *lent; /* by all of them, counted with what each block costs; NULL: no ceiling */
    size_t most;
    bool (*make_room)(void *context); /* at the ceiling: has another stream given way? */
    void *context;
    bool refused; /* the ceiling, not memory, was in the way */
} api_packing_memory;

/* Both fill what the libraries ask for. `memory` lives as long as the stream; NULL: no ceiling. */
void api_packing_zlib(z_stream *stream, api_packing_memory *memory);
ZSTD_customMem api_packing_zstd(api_packing_memory *memory);

#endif
