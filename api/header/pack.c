#include "api/header/pack.h"

#include "api/header/packing.h"
#include "api/limits.h"
#include "base/mem.h"

#include <string.h>

enum { LEVEL = 1, GZIP_MEMORY = 8 };

struct api_pack {
    api_coding coding;
    api_plain plain;
    size_t used; /* bytes of plain.bytes used */
    z_stream zlib;
    ZSTD_CCtx *zstd;
    bool begun; /* the compressor was started */
    bool as_it_is;
    bool read;  /* the whole body was read: what is left of it is in `in` */
    bool ended; /* the whole output was returned */
    bool failed;
    size_t from, to;
    /* The bytes from..to are uncompressed input. There is room for one byte more than is compressed
     * at once, which shows whether the body is longer. */
    char in[API_PACK_AT_ONCE + 1];
};

api_pack *api_pack_new(api_coding coding, const api_plain *plain)
{
    api_pack *pack = he_mem_alloc(sizeof *pack);
    if (pack != NULL) {
        memset(pack, 0, offsetof(api_pack, in));
        pack->coding = coding;
        pack->plain = *plain;
    }
    return pack;
}

void api_pack_free(api_pack *pack)
{
    if (pack != NULL) {
        if (pack->begun && pack->coding == API_GZIP) {
            deflateEnd(&pack->zlib);
        }
        ZSTD_freeCCtx(pack->zstd);
        he_mem_free(pack);
    }
}

/* Reads bytes of the body into the free part of `in`. */
static void fill(api_pack *pack)
{
    const api_plain *plain = &pack->plain;
    while (!pack->read && !pack->failed && pack->to < sizeof pack->in) {
        size_t room = sizeof pack->in - pack->to;
        if (plain->bytes != NULL) {
            size_t left = plain->length - pack->used, take = left < room ? left : room;
            memcpy(pack->in + pack->to, plain->bytes + pack->used, take);
            pack->used += take;
            pack->to += take;
            pack->read = pack->used == plain->length;
        } else {
            int64_t got = plain->read(plain->context, pack->in + pack->to, room);
            pack->to += got > 0 ? (size_t)got : 0;
            pack->read = got == 0;
            pack->failed = got < 0;
        }
    }
}

bool api_pack_whole(api_pack *pack, const char **bytes, size_t *length)
{
    fill(pack);
    *bytes = pack->in;
    *length = pack->to;
    return pack->read && pack->to <= API_PACK_AT_ONCE;
}

static bool begin_gzip(api_pack *pack)
{
    /* A short body needs no larger window than itself. zlib does not support windows of 256
     * bytes. */
    int window = MAX_WBITS;
    while (pack->read && window > 9 && pack->to <= (size_t)1 << (window - 1)) {
        window--;
    }
    int memory = window < MAX_WBITS ? window - 7 : GZIP_MEMORY;
    api_packing_zlib(&pack->zlib, NULL);
    return deflateInit2(&pack->zlib, LEVEL, Z_DEFLATED, window + 16, memory, Z_DEFAULT_STRATEGY) ==
           Z_OK;
}

/* Makes zstd allocate its memory now by compressing no bytes: it would otherwise allocate with the
 * first bytes, when failure is too late. */
static bool begin_zstd(api_pack *pack)
{
    ZSTD_inBuffer none = {"", 0, 0};
    ZSTD_outBuffer nowhere = {NULL, 0, 0};
    pack->zstd = ZSTD_createCCtx_advanced(api_packing_zstd(NULL));
    return pack->zstd != NULL &&
           !ZSTD_isError(ZSTD_CCtx_setParameter(pack->zstd, ZSTD_c_compressionLevel, LEVEL)) &&
           !ZSTD_isError(ZSTD_CCtx_setParameter(pack->zstd, ZSTD_c_checksumFlag, 1)) &&
           (!pack->read || !ZSTD_isError(ZSTD_CCtx_setPledgedSrcSize(pack->zstd, pack->to))) &&
           !ZSTD_isError(ZSTD_compressStream2(pack->zstd, &nowhere, &none, ZSTD_e_continue));
}

bool api_pack_begin(api_pack *pack)
{
    pack->begun = pack->coding == API_GZIP ? begin_gzip(pack) : begin_zstd(pack);
    return pack->begun;
}

void api_pack_give_up(api_pack *pack)
{
    pack->as_it_is = true;
}

/* Each compresses the bytes from..to into `buffer`, and returns the number of bytes written. */
static size_t step_gzip(api_pack *pack, char *buffer, size_t size)
{
    z_stream *z = &pack->zlib;
    z->next_in = (z_const Bytef *)(pack->in + pack->from);
    z->avail_in = (unsigned)(pack->to - pack->from);
    z->next_out = (Bytef *)buffer;
    z->avail_out = size > UINT32_MAX ? UINT32_MAX : (unsigned)size;
    unsigned room = z->avail_out;
    int status = deflate(z, pack->read ? Z_FINISH : Z_NO_FLUSH);
    pack->from = pack->to - z->avail_in;
    pack->ended = status == Z_STREAM_END;
    pack->failed = status == Z_STREAM_ERROR;
    return room - z->avail_out;
}

static size_t step_zstd(api_pack *pack, char *buffer, size_t size)
{
    ZSTD_inBuffer in = {pack->in + pack->from, pack->to - pack->from, 0};
    ZSTD_outBuffer out = {buffer, size, 0};
    size_t left =
        ZSTD_compressStream2(pack->zstd, &out, &in, pack->read ? ZSTD_e_end : ZSTD_e_continue);
    pack->from += in.pos;
    pack->failed = ZSTD_isError(left);
    pack->ended = pack->read && left == 0;
    return out.pos;
}

static size_t step_plain(api_pack *pack, char *buffer, size_t size)
{
    size_t left = pack->to - pack->from, take = left < size ? left : size;
    memcpy(buffer, pack->in + pack->from, take);
    pack->from += take;
    pack->ended = pack->read && pack->from == pack->to;
    return take;
}

int64_t api_pack_read(void *context, char *buffer, size_t size)
{
    api_pack *pack = context;
    size_t given = 0, plain = 0;
    while (given < size && !pack->ended && (given == 0 || plain < API_PACK_TURN)) {
        if (pack->from == pack->to) {
            pack->from = pack->to = 0;
        }
        if (pack->to == 0) {
            fill(pack);
            plain += pack->to;
        }
        if (pack->failed) {
            return -1;
        }
        given += pack->as_it_is             ? step_plain(pack, buffer + given, size - given)
                 : pack->coding == API_GZIP ? step_gzip(pack, buffer + given, size - given)
                                            : step_zstd(pack, buffer + given, size - given);
    }
    return pack->failed ? -1 : (int64_t)given;
}
