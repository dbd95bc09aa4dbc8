#include "format/gltf/meshopt.h"

#include <assert.h>
#include <meshoptimizer.h>

const char *const he_meshopt_modes[HE_MESHOPT_MODES] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
const char *const he_meshopt_filters[HE_MESHOPT_FILTERS] = {"NONE", "OCTAHEDRAL", "QUATERNION",
                                                            "EXPONENTIAL"};

/* The first byte of a stream in each mode; it is combined with the version. */
static const unsigned char marks[HE_MESHOPT_MODES] = {0xA0, 0xE0, 0xD0};

/* Chooses the versions of the codecs that EXT_meshopt_compression requires. The library stores
 * these versions for the whole process, so they are set before other threads start. */
__attribute__((constructor)) static void choose_version(void)
{
    meshopt_encodeVertexVersion(HE_MESHOPT_ATTRIBUTES_VERSION);
    meshopt_encodeIndexVersion(HE_MESHOPT_INDEX_VERSION);
}

const char *he_meshopt_fits(const he_meshopt_stream *s)
{
    bool attributes = s->mode == HE_MESHOPT_ATTRIBUTES;
    if (attributes ? s->stride == 0 || s->stride % 4 != 0 || s->stride > 256
                   : s->stride != 2 && s->stride != 4) {
        return attributes
                   ? "byteStride must be a multiple of 4, from 4 to 256, in the mode ATTRIBUTES"
                   : "byteStride must be 2 or 4 in the modes TRIANGLES and INDICES";
    }
    if (s->mode == HE_MESHOPT_TRIANGLES && s->count % 3 != 0) {
        return "count must be a multiple of 3 in the mode TRIANGLES";
    }
    if (s->filter != HE_MESHOPT_NONE && !attributes) {
        return "a filter needs the mode ATTRIBUTES";
    }
    if ((s->filter == HE_MESHOPT_OCTAHEDRAL && s->stride != 4 && s->stride != 8) ||
        (s->filter == HE_MESHOPT_QUATERNION && s->stride != 8)) {
        return "byteStride must be 4 or 8 for the filter OCTAHEDRAL, and 8 for the filter "
               "QUATERNION";
    }
    return NULL;
}

/* Returns the fewest bytes that a stream can have. Every stream begins with a byte of mode and
 * version. Attributes then need, for each byte of an element, at least two bits for every 16
 * elements, and the first element as a whole; triangles need one byte each and a table of 16
 * bytes; indices need one byte each and 4 more. */
uint64_t he_meshopt_least(const he_meshopt_stream *s)
{
    switch (s->mode) {
    case HE_MESHOPT_ATTRIBUTES:
        return 1 + s->count / 64 * s->stride + s->stride;
    case HE_MESHOPT_TRIANGLES:
        return 1 + s->count / 3 + 16;
    case HE_MESHOPT_INDICES:
    case HE_MESHOPT_MODES:
        break;
    }
    return 1 + s->count + 4;
}

int he_meshopt_version(const he_meshopt_stream *s, const unsigned char *bytes, size_t length)
{
    return length > 0 && (bytes[0] & 0xF0) == marks[s->mode] ? bytes[0] & 0x0F : -1;
}

static bool decode(const he_meshopt_stream *s, const unsigned char *bytes, size_t length, void *to)
{
    size_t count = (size_t)s->count;
    switch (s->mode) {
    case HE_MESHOPT_ATTRIBUTES:
        return meshopt_decodeVertexBuffer(to, count, s->stride, bytes, length) == 0;
    case HE_MESHOPT_TRIANGLES:
        return meshopt_decodeIndexBuffer(to, count, s->stride, bytes, length) == 0;
    case HE_MESHOPT_INDICES:
    case HE_MESHOPT_MODES:
        break;
    }
    return meshopt_decodeIndexSequence(to, count, s->stride, bytes, length) == 0;
}

bool he_meshopt_decode(const he_meshopt_stream *s, const unsigned char *bytes, size_t length,
                       void *to)
{
    assert(he_meshopt_fits(s) == NULL);
    if (!decode(s, bytes, length, to)) {
        return false;
    }
    switch (s->filter) {
    case HE_MESHOPT_NONE:
    case HE_MESHOPT_FILTERS:
        break;
    case HE_MESHOPT_OCTAHEDRAL:
        meshopt_decodeFilterOct(to, (size_t)s->count, s->stride);
        break;
    case HE_MESHOPT_QUATERNION:
        meshopt_decodeFilterQuat(to, (size_t)s->count, s->stride);
        break;
    case HE_MESHOPT_EXPONENTIAL:
        meshopt_decodeFilterExp(to, (size_t)s->count, s->stride);
        break;
    }
    return true;
}

size_t he_meshopt_bound(const he_meshopt_stream *s)
{
    size_t count = (size_t)s->count;
    switch (s->mode) {
    case HE_MESHOPT_ATTRIBUTES:
        return meshopt_encodeVertexBufferBound(count, s->stride);
    case HE_MESHOPT_TRIANGLES:
        return meshopt_encodeIndexBufferBound(count, UINT32_MAX);
    case HE_MESHOPT_INDICES:
    case HE_MESHOPT_MODES:
        break;
    }
    return meshopt_encodeIndexSequenceBound(count, UINT32_MAX);
}

size_t he_meshopt_encode(const he_meshopt_stream *s, const void *elements, unsigned char *to,
                         size_t room)
{
    size_t count = (size_t)s->count, used = 0;
    switch (s->mode) {
    case HE_MESHOPT_ATTRIBUTES:
        used = meshopt_encodeVertexBuffer(to, room, elements, count, s->stride);
        break;
    case HE_MESHOPT_TRIANGLES:
        used = meshopt_encodeIndexBuffer(to, room, elements, count);
        break;
    case HE_MESHOPT_INDICES:
    case HE_MESHOPT_MODES:
        used = meshopt_encodeIndexSequence(to, room, elements, count);
        break;
    }
    assert(used > 0);
    return used;
}
