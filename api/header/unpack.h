/* unpack.h - a coded body (gzip or zstd), unfolded as it arrives.
 *
 *     api_unpack_new -> api_unpack_feed ... -> api_unpack_end
 *
 * Members of gzip and frames of zstd may follow one another, as their RFCs allow, skippable frames
 * among them; all together are one body. What is unfolded goes on in pieces of at most
 * API_UNPACK_PIECE bytes and is not kept. Refused, with the byte of the coded body it was seen at:
 *
 *   bad_encoding           400  bytes that are not of the coding, its checksum or length does not
 *                               hold, something follows that is none, the body ends in the middle
 *   body_too_large         413  members or frames unfold to more than API_UNPACK_RATIO times what
 *                               of their compressed data was read, together by API_UNPACK_FREE
 *                               bytes: names and comments of gzip and skippable frames count for
 *                               nothing; a frame wants a larger window than API_UNPACK_WINDOW
 *   too_many_coded_bodies  503  the decoders of all bodies would take more than is left, and none
 *                               gives way; or this one gave way
 *   no_memory              507
 *
 * What the body may come to is the business of who takes the pieces.
 *
 * A sender who takes his time would keep a window of 8 MiB for minutes. So where there is no room
 * for another decoder of zstd, that whose body came the slowest gives way: the one with the
 * smallest part of all coded bytes that arrived since it began. It is told at its next piece. */
#ifndef HE_API_HEADER_UNPACK_H
#define HE_API_HEADER_UNPACK_H

#include "api/header/coding.h"
#include "api/json/problem.h"
#include "api/limits.h"

#include <stdatomic.h>

typedef struct api_unpack api_unpack;

enum { API_UNPACK_PIECE = 32 * 1024, API_UNPACK_PLACES = API_MAX_UNPACKING >> 20 };

/* A decoder that may give way. Its owner, while it feeds or ends it, and a newcomer, while it takes
 * the decoder away, have it for themselves; each takes it from WAITING.
 *
 *     EMPTY --owner--> BUSY <--owner--> WAITING --newcomer--> TAKING --newcomer--> GONE
 *       ^--------owner---'                                                          |
 *       '----------------------------------owner------------------------------------' */
typedef struct api_unpack_place {
    _Atomic int state; /* EMPTY is 0 */
    _Atomic(api_unpack *) owner;
    _Atomic uint64_t began, bytes; /* of the room's `arrived`, and of this body */
} api_unpack_place;

/* What all decoders of a service share. All zeros at first. */
typedef struct api_unpack_room {
    _Atomic size_t lent;      /* bytes they hold, at most API_MAX_UNPACKING */
    _Atomic uint64_t arrived; /* coded bytes of all bodies */
    api_unpack_place places[API_UNPACK_PLACES];
} api_unpack_room;

/* `coding` is not identity. `take` gets the pieces, and is false when it wants no more. `room`
 * outlives this one. NULL with the problem filled. */
api_unpack *api_unpack_new(api_coding coding, api_unpack_room *room,
                           bool (*take)(void *context, const char *bytes, size_t length),
                           void *context, api_problem *problem);
void api_unpack_free(api_unpack *u);
/* False when it is refused, with the problem filled, or when `take` wants no more. Neither it nor
 * end is called again then. `used` may be less than `length` when API_UNPACK_TURN bytes were
 * unfolded: the rest is to be fed again, once others have had their turn. */
bool api_unpack_feed(api_unpack *u, const char *bytes, size_t length, size_t *used,
                     api_problem *problem);
/* The body ends here; one of no bytes at all is good. */
bool api_unpack_end(api_unpack *u, api_problem *problem);

#endif
