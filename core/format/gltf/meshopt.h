/* meshopt.h - the streams of EXT_meshopt_compression, by libmeshoptimizer, which only meshopt.c
 * includes.
 *
 * A stream has `count` elements of `stride` bytes. For ATTRIBUTES the stride is a multiple of 4 up
 * to 256; for TRIANGLES and INDICES, which are unsigned whole numbers, it is 2 or 4, and triangles
 * have three elements each. A filter, which only attributes can have, requires a stride of 4 or 8
 * (OCTAHEDRAL), 8 (QUATERNION) or a multiple of 4 (EXPONENTIAL). he_meshopt_fits checks this. */
#ifndef HE_FORMAT_GLTF_MESHOPT_H
#define HE_FORMAT_GLTF_MESHOPT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum he_meshopt_mode {
    HE_MESHOPT_ATTRIBUTES,
    /* triangles; after coding, a triangle may begin at another of its corners. */
    HE_MESHOPT_TRIANGLES,
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

/* The names that modes and filters have in the JSON of the extension EXT_meshopt_compression. */
extern const char *const he_meshopt_modes[HE_MESHOPT_MODES];
extern const char *const he_meshopt_filters[HE_MESHOPT_FILTERS];

typedef struct he_meshopt_stream {
    he_meshopt_mode mode;
    he_meshopt_filter filter;
    uint64_t count; /* at least 1 */
    size_t stride;
} he_meshopt_stream;

/* Returns NULL if a stream may have this layout, else a sentence that says why it may not. */
const char *he_meshopt_fits(const he_meshopt_stream *stream);
/* Returns the fewest bytes that a stream of this layout can have: a shorter one is refused before
 * memory is allocated for its elements. */
uint64_t he_meshopt_least(const he_meshopt_stream *stream);
/* Returns the version of the codec that a stream states; -1 if the bytes are no stream of this
 * mode. */
int he_meshopt_version(const he_meshopt_stream *stream, const unsigned char *bytes, size_t length);
/* The latest versions of the codecs that he_meshopt_decode can read. */
enum { HE_MESHOPT_ATTRIBUTES_VERSION = 0, HE_MESHOPT_INDEX_VERSION = 1 };

/* Decodes a stream to `to`, which must have room for all elements. Returns false if the bytes are
 * no such stream. Whether decoded indices are in range is not checked. */
bool he_meshopt_decode(const he_meshopt_stream *stream, const unsigned char *bytes, size_t length,
                       void *to);

/* Returns the most bytes that he_meshopt_encode may write. Encoding applies no filter. */
size_t he_meshopt_bound(const he_meshopt_stream *stream);
/* Encodes elements to `to`, where `room` must be what he_meshopt_bound returns; returns the number
 * of bytes written. Elements of attributes are passed as they are in memory; triangles and indices
 * are passed as uint32_t, whatever the stride, which only matters to decoders. */
size_t he_meshopt_encode(const he_meshopt_stream *stream, const void *elements, unsigned char *to,
                         size_t room);

#endif
