#include "api/unpack.h"

#include "api/limits.h"
#include "api/packing.h"
#include "mesh/mem.h"

#include <stddef.h>
#include <string.h>

/* What a frame of zstd begins with. */
enum { MAGIC = 4 };
static const uint32_t ZSTD_FRAME = 0xFD2FB528, ZSTD_SKIPPABLE = 0x184D2A50,
                      ZSTD_ANY_SKIPPABLE = 0xFFFFFFF0;

struct api_unpack {
    api_coding coding;
    bool (*take)(void *context, const char *bytes, size_t length);
    void *context;
    uint64_t arrived, given; /* bytes, of the coded body and of the plain one */
    uint64_t at;             /* of the coded body: read so far */
    bool inside;             /* of a member or frame */
    z_stream zlib;
    bool has_zlib;
    ZSTD_DCtx *zstd;
    size_t wanted;              /* bytes up to the end of zstd's next header or block */
    unsigned char magic[MAGIC]; /* of a frame that begins */
    size_t magic_length;
    char piece[API_UNPACK_PIECE];
};

api_unpack *api_unpack_new(api_coding coding,
                           bool (*take)(void *context, const char *bytes, size_t length),
                           void *context)
{
    api_unpack *u = he_mem_alloc(sizeof *u);
    if (u == NULL) {
        return NULL;
    }
    memset(u, 0, offsetof(api_unpack, piece));
    u->coding = coding;
    u->take = take;
    u->context = context;
    if (coding == API_GZIP) {
        api_packing_zlib(&u->zlib);
        u->has_zlib = inflateInit2(&u->zlib, MAX_WBITS + 16) == Z_OK; /* gzip's framing alone */
    } else {
        u->zstd = ZSTD_createDCtx_advanced(api_packing_zstd());
        if (u->zstd != NULL) {
            ZSTD_DCtx_setParameter(u->zstd, ZSTD_d_windowLogMax, API_UNPACK_WINDOW);
        }
    }
    if (!u->has_zlib && u->zstd == NULL) {
        he_mem_free(u);
        return NULL;
    }
    return u;
}

void api_unpack_free(api_unpack *u)
{
    if (u != NULL) {
        if (u->has_zlib) {
            inflateEnd(&u->zlib);
        }
        ZSTD_freeDCtx(u->zstd);
        he_mem_free(u);
    }
}

static bool fail_memory(api_problem *problem)
{
    return api_problem_set(problem, HE_NO_MEMORY, "no memory to unfold the body");
}

static bool refuse(const api_unpack *u, api_problem *problem, const char *why)
{
    return api_problem_set(problem, API_BAD_ENCODING, "byte %llu of the %s body: %s",
                           (unsigned long long)u->at, api_coding_name(u->coding), why);
}

/* Hand on `length` bytes of u->piece, if the body may unfold so far. */
static bool give(api_unpack *u, size_t length, api_problem *problem)
{
    u->given += length;
    if (u->given > API_UNPACK_FREE && u->given / API_UNPACK_RATIO > u->arrived) {
        return api_problem_set(problem, API_BODY_TOO_LARGE,
                               "the first %llu bytes of the %s body unfold to more than %d times "
                               "as many, and to more than %llu bytes",
                               (unsigned long long)u->arrived, api_coding_name(u->coding),
                               API_UNPACK_RATIO, (unsigned long long)API_UNPACK_FREE);
    }
    return length == 0 || u->take(u->context, u->piece, length);
}

/* --- gzip --- */

static bool feed_gzip(api_unpack *u, const unsigned char *bytes, size_t length,
                      api_problem *problem)
{
    z_stream *z = &u->zlib;
    const unsigned char *end = bytes + length;
    z->next_in = (z_const Bytef *)bytes;
    /* Once all is read, as long as a whole piece comes out there may be more. */
    bool full = false;
    while (z->next_in < end || full) {
        if (!u->inside) {
            if (z->next_in == end) {
                break;
            }
            inflateReset(z);
            u->inside = true;
        }
        const unsigned char *before = z->next_in;
        z->avail_in = (unsigned)(end - before);
        z->next_out = (unsigned char *)u->piece;
        z->avail_out = sizeof u->piece;
        int status = inflate(z, Z_NO_FLUSH);
        u->at += (uint64_t)(z->next_in - before);
        full = z->avail_out == 0;
        if (status == Z_MEM_ERROR) {
            return fail_memory(problem);
        }
        if (status == Z_DATA_ERROR && z->total_in <= 2) {
            u->at -= z->total_in;
            return refuse(u, problem, "no member begins here");
        }
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
            return refuse(u, problem,
                          status == Z_NEED_DICT ? "a dictionary is wanted"
                          : z->msg == NULL      ? "not of the coding"
                                                : z->msg);
        }
        if (!give(u, sizeof u->piece - z->avail_out, problem)) {
            return false;
        }
        if (status == Z_STREAM_END) {
            u->inside = false;
            full = false;
        }
    }
    return true;
}

/* --- zstd --- */

static bool refuse_zstd(const api_unpack *u, size_t code, api_problem *problem)
{
    ZSTD_ErrorCode error = ZSTD_getErrorCode(code);
    if (error == ZSTD_error_memory_allocation) {
        return fail_memory(problem);
    }
    if (error == ZSTD_error_frameParameter_windowTooLarge) {
        return api_problem_set(problem, API_BODY_TOO_LARGE,
                               "byte %llu of the zstd body: the frame wants a window of more than "
                               "%lu bytes",
                               (unsigned long long)u->at, 1UL << API_UNPACK_WINDOW);
    }
    return refuse(u, problem, ZSTD_getErrorName(code));
}

/* Let zstd have these bytes, up to the end of the frame; `taken` of them it read. */
static bool decode(api_unpack *u, const unsigned char *bytes, size_t length, size_t *taken,
                   api_problem *problem)
{
    ZSTD_inBuffer in = {bytes, length, 0};
    bool full = false;
    while (u->inside && (in.pos < in.size || full)) {
        ZSTD_outBuffer out = {u->piece, sizeof u->piece, 0};
        size_t left = ZSTD_decompressStream(u->zstd, &out, &in);
        if (ZSTD_isError(left)) {
            return refuse_zstd(u, left, problem);
        }
        if (!give(u, out.pos, problem)) {
            return false;
        }
        full = out.pos == out.size;
        u->wanted = left;
        u->inside = left != 0;
    }
    u->at += in.pos;
    *taken = in.pos;
    return true;
}

/* A frame begins: older formats, which the library may know, are not the coding. */
static bool begin_frame(api_unpack *u, api_problem *problem)
{
    uint32_t magic = 0;
    for (size_t i = MAGIC; i > 0; i--) {
        magic = magic << 8 | u->magic[i - 1];
    }
    u->at -= MAGIC;
    if (magic != ZSTD_FRAME && (magic & ZSTD_ANY_SKIPPABLE) != ZSTD_SKIPPABLE) {
        return refuse(u, problem, "no frame begins here");
    }
    size_t taken;
    u->magic_length = 0;
    u->inside = true;
    return decode(u, u->magic, MAGIC, &taken, problem);
}

static bool feed_zstd(api_unpack *u, const unsigned char *bytes, size_t length,
                      api_problem *problem)
{
    while (length > 0) {
        size_t taken = 1;
        if (!u->inside) {
            u->magic[u->magic_length++] = *bytes;
            u->at++;
            if (u->magic_length == MAGIC && !begin_frame(u, problem)) {
                return false;
            }
        } else {
            /* No further than to the end of a header or block, so that a refusal names it. */
            size_t most = u->wanted < length ? u->wanted : length;
            if (!decode(u, bytes, most, &taken, problem)) {
                return false;
            }
        }
        bytes += taken;
        length -= taken;
    }
    return true;
}

bool api_unpack_feed(api_unpack *u, const char *bytes, size_t length, api_problem *problem)
{
    const unsigned char *from = (const unsigned char *)bytes;
    u->arrived += length;
    return u->coding == API_GZIP ? feed_gzip(u, from, length, problem)
                                 : feed_zstd(u, from, length, problem);
}

bool api_unpack_end(api_unpack *u, api_problem *problem)
{
    return (!u->inside && u->magic_length == 0) ||
           refuse(u, problem, "the body ends before the coding does");
}
