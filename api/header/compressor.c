#include "api/header/compressor.h"

#include "api/header/compression.h"
#include "api/limits.h"
#include "base/mem.h"

#include <string.h>

enum { LEVEL = 1 };

/* ISA-L's compressor, the memory in which it collects what it will write, and a piece of its
 * output. What ISA-L writes depends on how much room each call has for output; so every call gets
 * the whole of `out`, however much the caller of api_compressor_read wants. The bytes `from` to
 * `to` of `out` were not returned yet. */
typedef struct gzip {
    struct isal_zstream stream;
    uint8_t room[ISAL_DEF_LVL1_SMALL];
    uint8_t out[32 * 1024];
    size_t from, to;
} gzip;

struct api_compressor {
    api_coding coding;
    api_plain plain;
    size_t used; /* how many bytes of the body in plain.bytes were copied to `in` */
    gzip *gzip;
    ZSTD_CCtx *zstd;
    bool as_it_is;
    bool read;  /* true if the whole body was read: what is not compressed yet is in `in` */
    bool ended; /* true if all bytes of the output were returned to the caller */
    bool failed;
    size_t from, to;
    /* The bytes `from` to `to` were read and are not compressed yet. The array has one byte more
     * than API_COMPRESS_AT_ONCE, because only reading one more byte shows that the body is
     * longer. */
    char in[API_COMPRESS_AT_ONCE + 1];
};

api_compressor *api_compressor_new(api_coding coding, const api_plain *plain)
{
    api_compressor *compressor = he_mem_alloc(sizeof *compressor);
    if (compressor != NULL) {
        memset(compressor, 0, offsetof(api_compressor, in));
        compressor->coding = coding;
        compressor->plain = *plain;
    }
    return compressor;
}

void api_compressor_free(api_compressor *compressor)
{
    if (compressor != NULL) {
        he_mem_free(compressor->gzip);
        ZSTD_freeCCtx(compressor->zstd);
        he_mem_free(compressor);
    }
}

/* Reads bytes of the body into the free part of `in`. */
static void fill(api_compressor *compressor)
{
    const api_plain *plain = &compressor->plain;
    while (!compressor->read && !compressor->failed && compressor->to < sizeof compressor->in) {
        size_t room = sizeof compressor->in - compressor->to;
        if (plain->bytes != NULL) {
            size_t left = plain->length - compressor->used, take = left < room ? left : room;
            memcpy(compressor->in + compressor->to, plain->bytes + compressor->used, take);
            compressor->used += take;
            compressor->to += take;
            compressor->read = compressor->used == plain->length;
        } else {
            int64_t got = plain->read(plain->context, compressor->in + compressor->to, room);
            compressor->to += got > 0 ? (size_t)got : 0;
            compressor->read = got == 0;
            compressor->failed = got < 0;
        }
    }
}

bool api_compressor_whole(api_compressor *compressor, const char **bytes, size_t *length)
{
    fill(compressor);
    *bytes = compressor->in;
    *length = compressor->to;
    return compressor->read && compressor->to <= API_COMPRESS_AT_ONCE;
}

static bool begin_gzip(api_compressor *compressor)
{
    gzip *z = he_mem_alloc(sizeof *z);
    if (z == NULL) {
        return false;
    }
    z->from = z->to = 0;
    isal_deflate_init(&z->stream);
    z->stream.gzip_flag = IGZIP_GZIP;
    z->stream.level = LEVEL;
    z->stream.level_buf = z->room;
    z->stream.level_buf_size = sizeof z->room;
    compressor->gzip = z;
    return true;
}

/* Prepares zstd. Compressing no bytes makes zstd allocate its memory now. Otherwise it would
 * allocate with the first bytes, when it is too late to send the body uncompressed. */
static bool begin_zstd(api_compressor *compressor)
{
    ZSTD_inBuffer none = {"", 0, 0};
    ZSTD_outBuffer nowhere = {NULL, 0, 0};
    compressor->zstd = ZSTD_createCCtx_advanced(api_compression_zstd(NULL));
    return compressor->zstd != NULL &&
           !ZSTD_isError(
               ZSTD_CCtx_setParameter(compressor->zstd, ZSTD_c_compressionLevel, LEVEL)) &&
           !ZSTD_isError(ZSTD_CCtx_setParameter(compressor->zstd, ZSTD_c_checksumFlag, 1)) &&
           (!compressor->read ||
            !ZSTD_isError(ZSTD_CCtx_setPledgedSrcSize(compressor->zstd, compressor->to))) &&
           !ZSTD_isError(ZSTD_compressStream2(compressor->zstd, &nowhere, &none, ZSTD_e_continue));
}

bool api_compressor_begin(api_compressor *compressor)
{
    return compressor->coding == API_GZIP ? begin_gzip(compressor) : begin_zstd(compressor);
}

void api_compressor_give_up(api_compressor *compressor)
{
    compressor->as_it_is = true;
}

/* Clears the upper halves of the vector registers. ISA-L leaves them filled, and then code for
 * older processors, such as zstd's, runs a third slower in the same thread from there on. */
#if defined(__x86_64__)
__attribute__((target("avx"))) static void clear_registers(void)
{
    __builtin_ia32_vzeroupper();
}
#endif

static int deflate_piece(struct isal_zstream *stream)
{
    const int status = isal_deflate(stream);
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx")) {
        clear_registers();
    }
#endif
    return status;
}

/* The functions step_gzip, step_zstd and step_plain write the waiting input, compressed or
 * unchanged, to `buffer` as far as it fits, and return the number of bytes written. The waiting
 * input is the bytes `from` to `to` of the array `in`. */
static size_t step_gzip(api_compressor *compressor, char *buffer, size_t size)
{
    gzip *z = compressor->gzip;
    if (z->from == z->to) {
        z->stream.next_in = (uint8_t *)compressor->in + compressor->from;
        z->stream.avail_in = (uint32_t)(compressor->to - compressor->from);
        z->stream.next_out = z->out;
        z->stream.avail_out = sizeof z->out;
        z->stream.end_of_stream = compressor->read;
        compressor->failed = deflate_piece(&z->stream) != COMP_OK;
        compressor->from = compressor->to - z->stream.avail_in;
        z->from = 0;
        z->to = sizeof z->out - z->stream.avail_out;
    }
    const size_t left = z->to - z->from, take = left < size ? left : size;
    memcpy(buffer, z->out + z->from, take);
    z->from += take;
    compressor->ended = z->from == z->to && z->stream.internal_state.state == ZSTATE_END;
    return take;
}

static size_t step_zstd(api_compressor *compressor, char *buffer, size_t size)
{
    ZSTD_inBuffer in = {compressor->in + compressor->from, compressor->to - compressor->from, 0};
    ZSTD_outBuffer out = {buffer, size, 0};
    size_t left = ZSTD_compressStream2(compressor->zstd, &out, &in,
                                       compressor->read ? ZSTD_e_end : ZSTD_e_continue);
    compressor->from += in.pos;
    compressor->failed = ZSTD_isError(left);
    compressor->ended = compressor->read && left == 0;
    return out.pos;
}

static size_t step_plain(api_compressor *compressor, char *buffer, size_t size)
{
    size_t left = compressor->to - compressor->from, take = left < size ? left : size;
    memcpy(buffer, compressor->in + compressor->from, take);
    compressor->from += take;
    compressor->ended = compressor->read && compressor->from == compressor->to;
    return take;
}

int64_t api_compressor_read(void *context, char *buffer, size_t size)
{
    api_compressor *compressor = context;
    size_t given = 0, plain = 0;
    while (given < size && !compressor->ended && (given == 0 || plain < API_COMPRESS_TURN)) {
        if (compressor->from == compressor->to) {
            compressor->from = compressor->to = 0;
        }
        if (compressor->to == 0) {
            fill(compressor);
            plain += compressor->to;
        }
        if (compressor->failed) {
            return -1;
        }
        given += compressor->as_it_is ? step_plain(compressor, buffer + given, size - given)
                 : compressor->coding == API_GZIP
                     ? step_gzip(compressor, buffer + given, size - given)
                     : step_zstd(compressor, buffer + given, size - given);
    }
    return compressor->failed ? -1 : (int64_t)given;
}
