#include "api/packing.h"

#include "mesh/mem.h"

static void *zlib_alloc(void *context, unsigned count, unsigned size)
{
    (void)context;
    return he_mem_array(NULL, count, size);
}

static void *zstd_alloc(void *context, size_t size)
{
    (void)context;
    return he_mem_alloc(size);
}

static void give_back(void *context, void *memory)
{
    (void)context;
    he_mem_free(memory);
}

void api_packing_zlib(z_stream *stream)
{
    *stream = (z_stream){.zalloc = zlib_alloc, .zfree = give_back};
}

ZSTD_customMem api_packing_zstd(void)
{
    return (ZSTD_customMem){zstd_alloc, give_back, NULL};
}
