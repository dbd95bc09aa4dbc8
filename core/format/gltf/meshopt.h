/* meshopt.h - the streams of EXT_meshopt_compression, by libmeshoptimizer: the only file that knows
 * it is meshopt.c.
 *
 * A stream holds `count` elements of `stride` bytes. Of ATTRIBUTES the stride is a multiple of 4 up
 * to 256; of TRIANGLES and INDICES, which are whole numbers without a sign, it is 2 or 4, and
 * triangles have three elements each. A filter, which only attributes have, wants 4 or 8
 * (OCTAHEDRAL), 8 (QUATERNION) or a multiple of 4 (EXPONENTIAL). What is asked for here keeps to
 * that (he_meshopt_fits). */
#ifndef HE_FORMAT_GLTF_MESHOPT_H
#define HE_FORMAT_GLTF_MESHOPT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum he_meshopt_mode {
    HE_MESHOPT_ATTRIBUTES,
    HE_MESHOPT_TRIANGLES, /* coded, one may begin at another of its corners */
    HE_MESHOPT_INDICES,
    HE_MESHOPT_MODES
} he_meshopt_mode;

typedef enum he_meshopt_filter {
    HE_MESHOPT_NONE,
    HE_MESHOPT_OCTAHEDRAL,
    HE_MESHOPT_QUATERNION,
    HE_MESHOPT_EXPONENTIAL,
    HE_MESHOPT_FILTERS
} he_meshopt_filter;

/* As the extension spells them. */
extern const char *const he_meshopt_modes[HE_MESHOPT_MODES];
extern const char *const he_meshopt_filters[HE_MESHOPT_FILTERS];

typedef struct he_meshopt_stream {
    he_meshopt_mode mode;
    he_meshopt_filter filter;
    uint64_t count; /* at least 1 */
    size_t stride;
} he_meshopt_stream;

/* NULL if a stream may have this layout, else a sentence about what is wrong with it. */
const char *he_meshopt_fits(const he_meshopt_stream *stream);
/* The fewest bytes that any stream of this layout has: a shorter one is refused before memory is
 * taken for its elements. */
uint64_t he_meshopt_least(const he_meshopt_stream *stream);
/* The version of the codec that a stream says it is of, -1 where it is no stream of this mode. */
int he_meshopt_version(const he_meshopt_stream *stream, const unsigned char *bytes, size_t length);
enum { HE_MESHOPT_ATTRIBUTES_VERSION = 0, HE_MESHOPT_INDEX_VERSION = 1 }; /* the latest read */

/* Decodes to `to`, which has room for all elements. False where the bytes are no such stream. The
 * indices are not checked. */
bool he_meshopt_decode(const he_meshopt_stream *stream, const unsigned char *bytes, size_t length,
                       void *to);

/* The most bytes that he_meshopt_encode may write. No filter is applied. */
size_t he_meshopt_bound(const he_meshopt_stream *stream);
/* Encodes the elements to `to`, where `room` is he_meshopt_bound; returns the bytes written. The
 * elements of attributes are as they are in memory, triangles and indices are uint32_t: their
 * stride is only what a decoder makes of them. */
size_t he_meshopt_encode(const he_meshopt_stream *stream, const void *elements, unsigned char *to,
                         size_t room);

#endif
