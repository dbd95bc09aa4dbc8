#include "api/header/decompressor.h"

#include "api/header/compression.h"
#include "base/mem.h"

#include <stddef.h>
#include <string.h>

/* The length of the magic number with which a zstd frame begins. */
enum { MAGIC = 4 };
static const uint32_t ZSTD_FRAME = 0xFD2FB528, ZSTD_SKIPPABLE = 0x184D2A50,
                      ZSTD_ANY_SKIPPABLE = 0xFFFFFFF0;

struct api_decompressor {
    api_coding coding;
    bool (*take)(void *context, const char *bytes, size_t length);
    void *context;
    uint64_t at; /* number of bytes of the compressed body that were read */
    /* By how many decompressed bytes the earlier gzip members or zstd frames of this body have
     * exceeded the ratio API_DECOMPRESS_RATIO, added up. */
    uint64_t beyond;
    /* How many bytes of the present gzip member or zstd frame were read (from: compressed) and
     * written (to: decompressed). */
    uint64_t from, to;
    size_t turn; /* bytes decompressed in this call of api_decompressor_feed */
    bool inside; /* true if a gzip member or zstd frame has begun and not ended */
    api_decompressor_room *room;
    /* The entry of this decoder in the list of decoders that can be evicted; NULL: it has no entry
     * and cannot be evicted. */
    api_decompressor_place *place;
    api_compression_memory memory;
    z_stream zlib;
    bool has_zlib;
    bool deflated; /* true if the header of the present gzip member was read */
    ZSTD_DCtx *zstd;
    size_t wanted; /* number of bytes that zstd still needs to complete the next header or block */
    bool skipped;  /* true if the present frame is a skippable one */
    unsigned char head[ZSTD_FRAMEHEADERSIZE_MAX]; /* the first bytes of the present frame */
    size_t head_length;
    char piece[API_DECOMPRESS_PIECE];
};

static bool fail_memory(const api_decompressor *u, api_problem *problem)
{
    return u->memory.refused
               ? api_problem_set(problem, API_TOO_MANY_CODED,
                                 "the arriving compressed bodies together would need more than %zu "
                                 "bytes of memory to be decompressed",
                                 u->memory.most)
               : api_problem_set(problem, HE_NO_MEMORY, "no memory to decompress the body");
}

/* --- eviction of decoders --- */

enum { EMPTY, BUSY, WAITING, TAKING, GONE };

/* Enters a zstd decoder in the list of decoders that can be evicted to free their memory. If the
 * list is full, this decoder cannot be evicted. Decoders of gzip need little memory and are not
 * entered. */
static void find_place(api_decompressor *u)
{
    for (size_t i = 0; u->place == NULL && i < API_DECOMPRESS_PLACES; i++) {
        api_decompressor_place *place = &u->room->places[i];
        int empty = EMPTY;
        if (atomic_compare_exchange_strong(&place->state, &empty, BUSY)) {
            u->place = place;
            atomic_store(&place->owner, u);
            atomic_store(&place->bytes, 0);
        }
    }
}

/* Changes the state of the decoder's place from WAITING to BUSY (decompressor.h). Returns false if
 * the decoder was evicted. */
static bool enter(api_decompressor *u)
{
    int state = WAITING;
    if (u->place == NULL) {
        return true;
    }
    while (!atomic_compare_exchange_weak(&u->place->state, &state, BUSY)) {
        if (state == GONE || state == BUSY) {
            return state == BUSY;
        }
        /* This loop spins while another thread evicts the decoder (state TAKING), which takes only
         * as long as freeing a block of memory. */
        state = WAITING;
    }
    return true;
}

static void leave(api_decompressor *u, size_t bytes)
{
    uint64_t before = atomic_fetch_add(&u->room->arrived, bytes);
    if (u->place != NULL) {
        if (atomic_load(&u->place->bytes) == 0) {
            atomic_store(&u->place->began, before);
        }
        atomic_fetch_add(&u->place->bytes, bytes);
        atomic_store(&u->place->state, WAITING);
    }
}

/* Returns which share of all compressed bytes that have arrived since this body began belong to
 * this body. */
static double part_of(const api_decompressor_room *room, const api_decompressor_place *place)
{
    uint64_t all = atomic_load(&room->arrived) - atomic_load(&place->began);
    return all == 0 ? 1 : (double)atomic_load(&place->bytes) / (double)all;
}

/* Evicts the decoder with the slowest body. Returns false if no decoder can be evicted now (state
 * WAITING). */
static bool take_slowest(void *context)
{
    api_decompressor_room *room = context;
    for (;;) {
        api_decompressor_place *slowest = NULL;
        double part = 0;
        for (size_t i = 0; i < API_DECOMPRESS_PLACES; i++) {
            api_decompressor_place *place = &room->places[i];
            double its = part_of(room, place);
            if (atomic_load(&place->state) == WAITING && (slowest == NULL || its < part)) {
                slowest = place;
                part = its;
            }
        }
        int waiting = WAITING;
        if (slowest == NULL) {
            return false;
        }
        if (atomic_compare_exchange_strong(&slowest->state, &waiting, TAKING)) {
            api_decompressor *u = atomic_load(&slowest->owner);
            ZSTD_freeDCtx(u->zstd);
            u->zstd = NULL;
            atomic_store(&slowest->state, GONE);
            return true;
        }
    }
}

api_decompressor *api_decompressor_new(api_coding coding, api_decompressor_room *room,
                                       bool (*take)(void *context, const char *bytes,
                                                    size_t length),
                                       void *context, api_problem *problem)
{
    api_decompressor *u = he_mem_alloc(sizeof *u);
    if (u == NULL) {
        api_problem_set(problem, HE_NO_MEMORY, "no memory to decompress the body");
        return NULL;
    }
    memset(u, 0, offsetof(api_decompressor, piece));
    u->coding = coding;
    u->take = take;
    u->context = context;
    u->room = room;
    u->memory = (api_compression_memory){.lent = &room->lent,
                                         .most = API_MAX_DECOMPRESSING,
                                         .make_room = take_slowest,
                                         .context = room};
    if (coding == API_GZIP) {
        api_compression_zlib(&u->zlib, &u->memory);
        /* The window size plus 16 makes zlib accept the gzip format only. */
        u->has_zlib = inflateInit2(&u->zlib, MAX_WBITS + 16) == Z_OK;
    } else {
        u->zstd = ZSTD_createDCtx_advanced(api_compression_zstd(&u->memory));
        if (u->zstd != NULL) {
            ZSTD_DCtx_setParameter(u->zstd, ZSTD_d_windowLogMax, API_DECOMPRESS_WINDOW);
            find_place(u);
        }
    }
    if (!u->has_zlib && u->zstd == NULL) {
        fail_memory(u, problem);
        he_mem_free(u);
        return NULL;
    }
    return u;
}

void api_decompressor_free(api_decompressor *u)
{
    if (u != NULL) {
        (void)enter(u);
        if (u->has_zlib) {
            inflateEnd(&u->zlib);
        }
        ZSTD_freeDCtx(u->zstd);
        if (u->place != NULL) {
            atomic_store(&u->place->state, EMPTY);
        }
        he_mem_free(u);
    }
}

static bool refuse(const api_decompressor *u, api_problem *problem, const char *why)
{
    return api_problem_set(problem, API_BAD_ENCODING, "byte %llu of the %s body: %s",
                           (unsigned long long)u->at, api_coding_name(u->coding), why);
}

/* Returns how many decompressed bytes of the present gzip member or zstd frame exceed the allowed
 * ratio. */
static uint64_t beyond(const api_decompressor *u)
{
    uint64_t earned = u->from * API_DECOMPRESS_RATIO;
    return u->to > earned ? u->to - earned : 0;
}

/* Passes `length` decompressed bytes, which are in `piece`, to the callback. Refuses the body if
 * its decompressed size exceeds the allowed ratio by too much. */
static bool give(api_decompressor *u, size_t length, api_problem *problem)
{
    u->to += length;
    u->turn += length;
    if (u->beyond + beyond(u) > API_DECOMPRESS_FREE) {
        return api_problem_set(problem, API_BODY_TOO_LARGE,
                               "byte %llu of the %s body: the decompressed data is larger than the "
                               "allowed %d times its compressed size plus %llu bytes",
                               (unsigned long long)u->at, api_coding_name(u->coding),
                               API_DECOMPRESS_RATIO, (unsigned long long)API_DECOMPRESS_FREE);
    }
    return length == 0 || u->take(u->context, u->piece, length);
}

/* Ends a gzip member or zstd frame. */
static void end_part(api_decompressor *u)
{
    u->beyond += beyond(u);
    u->from = u->to = 0;
    u->inside = false;
}

/* --- decompressing gzip --- */

static bool refuse_gzip(api_decompressor *u, int status, api_problem *problem)
{
    const z_stream *z = &u->zlib;
    if (status == Z_MEM_ERROR) {
        return fail_memory(u, problem);
    }
    if (status == Z_DATA_ERROR && z->total_in <= 2) {
        u->at -= z->total_in;
        return refuse(u, problem, "the bytes are not in gzip format");
    }
    return refuse(u, problem,
                  status == Z_NEED_DICT
                      ? "the data needs a preset dictionary, which the server does not support"
                  : z->msg == NULL ? "the compressed data is damaged"
                                   : z->msg);
}

static bool feed_gzip(api_decompressor *u, const unsigned char *bytes, size_t length, size_t *used,
                      api_problem *problem)
{
    z_stream *z = &u->zlib;
    const unsigned char *end = bytes + length;
    z->next_in = (z_const Bytef *)bytes;
    /* When all input was read, a full piece of output means that there may be more output. */
    bool full = false;
    while (z->next_in < end ? u->turn < API_DECOMPRESS_TURN : full) {
        if (!u->inside) {
            inflateReset(z);
            u->inside = true;
            u->deflated = false;
        }
        const unsigned char *before = z->next_in;
        z->avail_in = (unsigned)(end - before);
        z->next_out = (unsigned char *)u->piece;
        z->avail_out = sizeof u->piece;
        /* Z_BLOCK makes zlib stop after the gzip header, whose length is not limited. */
        int status = inflate(z, u->deflated ? Z_NO_FLUSH : Z_BLOCK);
        u->at += (uint64_t)(z->next_in - before);
        u->from += u->deflated ? (uint64_t)(z->next_in - before) : 0;
        u->deflated = u->deflated || (z->data_type & 128) != 0;
        full = z->avail_out == 0;
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
            return refuse_gzip(u, status, problem);
        }
        if (!give(u, sizeof u->piece - z->avail_out, problem)) {
            return false;
        }
        if (status == Z_STREAM_END) {
            end_part(u);
            full = false;
        }
    }
    *used = (size_t)(z->next_in - bytes);
    return true;
}

/* --- decompressing zstd --- */

static bool refuse_zstd(const api_decompressor *u, size_t code, api_problem *problem)
{
    ZSTD_ErrorCode error = ZSTD_getErrorCode(code);
    if (error == ZSTD_error_memory_allocation) {
        return fail_memory(u, problem);
    }
    if (error == ZSTD_error_frameParameter_windowTooLarge) {
        return api_problem_set(
            problem, API_BODY_TOO_LARGE,
            "byte %llu of the zstd body: the frame needs a window of more than %lu bytes",
            (unsigned long long)u->at, 1UL << API_DECOMPRESS_WINDOW);
    }
    return refuse(u, problem, ZSTD_getErrorName(code));
}

/* Ends a frame. This function compares the decompressed length with the length in the frame's
 * header, because zstd does not compare them if the last block is empty. */
static bool end_frame(api_decompressor *u, api_problem *problem)
{
    unsigned long long said = ZSTD_getFrameContentSize(u->head, u->head_length);
    if (!u->skipped && said != ZSTD_CONTENTSIZE_UNKNOWN && said != u->to) {
        return refuse(
            u, problem,
            "the length of the decompressed frame differs from the length in the frame's header");
    }
    u->head_length = 0;
    end_part(u);
    return true;
}

/* Decompresses bytes, at most up to the end of the frame; `taken` gets the number of bytes that
 * zstd read. */
static bool decode(api_decompressor *u, const unsigned char *bytes, size_t length, size_t *taken,
                   api_problem *problem)
{
    ZSTD_inBuffer in = {bytes, length, 0};
    bool full = false, ended = false;
    while (!ended && (in.pos < in.size || full)) {
        ZSTD_outBuffer out = {u->piece, sizeof u->piece, 0};
        size_t before = in.pos, left = ZSTD_decompressStream(u->zstd, &out, &in);
        if (ZSTD_isError(left)) {
            return refuse_zstd(u, left, problem);
        }
        u->from += u->skipped ? 0 : in.pos - before;
        if (!give(u, out.pos, problem)) {
            return false;
        }
        full = out.pos == out.size;
        u->wanted = left;
        ended = left == 0;
    }
    u->at += in.pos;
    *taken = in.pos;
    return !ended || end_frame(u, problem);
}

/* Begins a frame whose magic number has arrived. The magic number is checked here, because the
 * library may also accept older formats, which the content coding "zstd" does not include. */
static bool begin_frame(api_decompressor *u, api_problem *problem)
{
    uint32_t magic = 0;
    for (size_t i = MAGIC; i > 0; i--) {
        magic = magic << 8 | u->head[i - 1];
    }
    u->at -= MAGIC;
    u->skipped = (magic & ZSTD_ANY_SKIPPABLE) == ZSTD_SKIPPABLE;
    if (magic != ZSTD_FRAME && !u->skipped) {
        return refuse(u, problem, "the bytes are not in zstd format");
    }
    size_t taken;
    u->inside = true;
    return decode(u, u->head, MAGIC, &taken, problem);
}

static void keep_head(api_decompressor *u, const unsigned char *bytes, size_t length)
{
    size_t room = sizeof u->head - u->head_length, take = length < room ? length : room;
    memcpy(u->head + u->head_length, bytes, take);
    u->head_length += take;
}

static bool feed_zstd(api_decompressor *u, const unsigned char *bytes, size_t length, size_t *used,
                      api_problem *problem)
{
    size_t at = 0;
    while (at < length && u->turn < API_DECOMPRESS_TURN) {
        size_t taken = 1;
        if (!u->inside) {
            keep_head(u, bytes + at, 1);
            u->at++;
            if (u->head_length == MAGIC && !begin_frame(u, problem)) {
                return false;
            }
        } else {
            /* In each step zstd gets no more than the next header or block, so that a refusal names
             * the offset of the block at fault. */
            size_t left = length - at, most = u->wanted < left ? u->wanted : left;
            keep_head(u, bytes + at, most);
            if (!decode(u, bytes + at, most, &taken, problem)) {
                return false;
            }
        }
        at += taken;
    }
    *used = at;
    return true;
}

static bool refuse_gone(const api_decompressor *u, api_problem *problem)
{
    return api_problem_set(problem, API_TOO_MANY_CODED,
                           "too many compressed bodies arrive at the same time, and this was the "
                           "slowest one: the memory to decompress them is limited to %zu bytes",
                           u->memory.most);
}

bool api_decompressor_feed(api_decompressor *u, const char *bytes, size_t length, size_t *used,
                           api_problem *problem)
{
    const unsigned char *from = (const unsigned char *)bytes;
    u->turn = 0;
    *used = length;
    if (!enter(u)) {
        return refuse_gone(u, problem);
    }
    bool good = u->coding == API_GZIP ? feed_gzip(u, from, length, used, problem)
                                      : feed_zstd(u, from, length, used, problem);
    leave(u, *used);
    return good;
}

bool api_decompressor_end(api_decompressor *u, api_problem *problem)
{
    if (!u->inside && u->head_length == 0) {
        return true;
    }
    return enter(u) ? refuse(u, problem, "the body ends before its compressed data is complete")
                    : refuse_gone(u, problem);
}
