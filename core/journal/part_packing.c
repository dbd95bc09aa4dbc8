#include "journal/part_packing.h"

#include "base/mem.h"
#include "stored/stored.h"

#include <string.h>
/* This makes zstd.h declare the functions that let zstd allocate through base/mem.h. The header
 * offers them for static linking only, but the shared library exports them, too. */
#define ZSTD_STATIC_LINKING_ONLY
#include <zstd.h>
#include <zstd_errors.h>

enum { LEVEL = 1 };

/* A part of a stored mesh is stored compressed only if compression saves at least 1/LEAST_SHARE of
 * its bytes. A smaller saving is not worth the time of decompression. */
enum { LEAST_SHARE = 32 };

struct st_packer {
    ZSTD_CCtx *zstd;
    unsigned char packed[HE_STORED_PART_ROOM];
};

struct st_unpacker {
    ZSTD_DCtx *zstd;
    unsigned char part[HE_STORED_PART_ROOM];
};

static void *take(void *context, size_t size)
{
    (void)context;
    return he_mem_alloc(size);
}

static void give_back(void *context, void *memory)
{
    (void)context;
    he_mem_free(memory);
}

static const ZSTD_customMem memory = {take, give_back, NULL};

st_packer *st_packer_new(void)
{
    st_packer *packer = he_mem_alloc(sizeof *packer);
    if (packer == NULL) {
        return NULL;
    }
    packer->zstd = ZSTD_createCCtx_advanced(memory);
    if (packer->zstd == NULL) {
        he_mem_free(packer);
        return NULL;
    }
    return packer;
}

void st_packer_free(st_packer *packer)
{
    if (packer != NULL) {
        ZSTD_freeCCtx(packer->zstd);
        he_mem_free(packer);
    }
}

size_t st_part_pack(st_packer *packer, unsigned char *part, size_t size, unsigned *coding)
{
    if (packer == NULL) {
        return size;
    }
    const size_t room = size - size / LEAST_SHARE;
    const size_t packed = ZSTD_compressCCtx(packer->zstd, packer->packed, room, part, size, LEVEL);
    if (ZSTD_isError(packed)) {
        /* Compression saves too little, or memory is out, so the part stays uncompressed. */
        return size;
    }
    memcpy(part, packer->packed, packed);
    *coding |= HE_CODING_PACKED;
    return packed;
}

st_unpacker *st_unpacker_new(void)
{
    st_unpacker *unpacker = he_mem_alloc(sizeof *unpacker);
    if (unpacker == NULL) {
        return NULL;
    }
    unpacker->zstd = ZSTD_createDCtx_advanced(memory);
    if (unpacker->zstd == NULL) {
        he_mem_free(unpacker);
        return NULL;
    }
    return unpacker;
}

void st_unpacker_free(st_unpacker *unpacker)
{
    if (unpacker != NULL) {
        ZSTD_freeDCtx(unpacker->zstd);
        he_mem_free(unpacker);
    }
}

/* The part is decompressed directly into a buffer that is as long as the longest possible part, so
 * zstd allocates no memory, whatever size the compressed frame states. A frame is refused if its
 * data is longer than it states or than the buffer. */
st_status st_part_unpack(st_unpacker *unpacker, st_part packed, st_part *out, const char **why)
{
    const unsigned long long said = ZSTD_getFrameContentSize(packed.bytes, packed.size);
    *why = "the stored part is not a zstd frame that declares its length";
    if (said == ZSTD_CONTENTSIZE_UNKNOWN || said == ZSTD_CONTENTSIZE_ERROR) {
        return ST_DAMAGED;
    }
    *why = "the zstd frame of a stored part declares more bytes than a part may have";
    if (said > sizeof unpacker->part) {
        return ST_DAMAGED;
    }
    const size_t got = ZSTD_decompressDCtx(unpacker->zstd, unpacker->part, (size_t)said,
                                           packed.bytes, packed.size);
    if (ZSTD_isError(got)) {
        *why = ZSTD_getErrorName(got);
        return ZSTD_getErrorCode(got) == ZSTD_error_memory_allocation ? ST_NO_MEMORY : ST_DAMAGED;
    }
    *why = "the zstd frame of a stored part decompresses to fewer bytes than it declares";
    if (got != said) {
        return ST_DAMAGED;
    }
    *out = (st_part){unpacker->part, got};
    return ST_OK;
}
