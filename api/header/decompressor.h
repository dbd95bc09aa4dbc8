/* decompressor.h - decompresses a request's body (gzip or zstd) as it arrives.
 *
 *     api_decompressor_new -> api_decompressor_feed ... -> api_decompressor_end
 *
 * A body may be several gzip members or zstd frames in a row, skippable frames included, as their
 * RFCs allow. The output is passed to a callback in pieces of at most API_DECOMPRESS_PIECE bytes
 * and not kept. A body is refused with one of these problems, most of which name the offset in the
 * compressed body:
 *
 *   bad_encoding           400  the bytes are not in this format, the checksum or length does not
 *                               match, other bytes follow, or the body ends too early
 *   body_too_large         413  the output exceeds API_DECOMPRESS_RATIO times the compressed data
 *                               read by more than API_DECOMPRESS_FREE bytes (gzip names and
 *                               comments and skippable frames do not count as compressed data),
 *                               or a frame needs a larger window than API_DECOMPRESS_WINDOW
 *   too_many_coded_bodies  503  the decoders of all bodies have no memory left and none can be
 *                               evicted, or this decoder was evicted
 *   no_memory              507
 *
 * The size of the whole decompressed body is limited by the callback.
 *
 * A slow client would occupy the 8 MiB of its decoder's window for minutes. So when there is no
 * memory for another zstd decoder, the decoder with the slowest body is evicted: the one that
 * received the smallest share of all compressed bytes that arrived since it began. Its request
 * fails at the next piece. */
#ifndef HE_API_HEADER_DECOMPRESSOR_H
#define HE_API_HEADER_DECOMPRESSOR_H

#include "api/header/content_coding.h"
#include "api/json/problem.h"
#include "api/limits.h"

#include <stdatomic.h>

typedef struct api_decompressor api_decompressor;

enum { API_DECOMPRESS_PIECE = 32 * 1024, API_DECOMPRESS_PLACES = API_MAX_DECOMPRESSING >> 20 };

/* The list entry of a decoder that can be evicted, that is, whose memory another request may free.
 * Two requests need exclusive access to the decoder: its own request (the owner, below) while it
 * decompresses, and a request that needs memory (the newcomer) while it evicts the decoder. Each
 * gains exclusive access by changing the state from WAITING to another.
 *
 *     EMPTY --owner--> BUSY <--owner--> WAITING --newcomer--> TAKING --newcomer--> GONE
 *       ^--------owner---'                                                          |
 *       '----------------------------------owner------------------------------------' */
typedef struct api_decompressor_place {
    _Atomic int state; /* one of the states above; EMPTY is 0 */
    _Atomic(api_decompressor *) owner;
    /* began: the value that `arrived` in api_decompressor_room had when this body began. bytes: how
     * many compressed bytes of this body have arrived. */
    _Atomic uint64_t began, bytes;
} api_decompressor_place;

/* The state that all decoders of a service share. Initially all bytes of the struct are zero. */
typedef struct api_decompressor_room {
    _Atomic size_t lent; /* bytes that all decoders have allocated, at most API_MAX_DECOMPRESSING */
    /* Compressed bytes of all bodies that arrived since the server started. */
    _Atomic uint64_t arrived;
    api_decompressor_place places[API_DECOMPRESS_PLACES];
} api_decompressor_room;

/* Makes a decoder. `coding` must not be identity. `take` receives the decompressed pieces and
 * returns false to stop. `room` limits the total memory of all decoders of a service, and must
 * outlive the decoder. Returns NULL with the problem filled. */
api_decompressor *api_decompressor_new(api_coding coding, api_decompressor_room *room,
                                       bool (*take)(void *context, const char *bytes,
                                                    size_t length),
                                       void *context, api_problem *problem);
void api_decompressor_free(api_decompressor *u);
/* Decompresses bytes of the body. `used` may be less than `length` if API_DECOMPRESS_TURN bytes
 * were decompressed: the caller then serves other requests before it feeds the rest.
 * Returns false if the body is refused, with the problem filled, or if `take` returned false; then
 * neither this function nor api_decompressor_end may be called again. */
bool api_decompressor_feed(api_decompressor *u, const char *bytes, size_t length, size_t *used,
                           api_problem *problem);
/* Ends the body, and checks that it is complete. An empty body is valid. */
bool api_decompressor_end(api_decompressor *u, api_problem *problem);

#endif
