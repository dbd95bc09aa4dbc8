/* glb_pack.c - compresses the parts of a GLB file into streams of EXT_meshopt_compression. */
#include "format/gltf/glb_parts.h"

#include <string.h>

he_meshopt_stream he_glb_part_stream(const he_glb_part *part)
{
    he_meshopt_stream stream = {HE_MESHOPT_ATTRIBUTES, HE_MESHOPT_NONE, part->count, part->stride};
    switch (part->content) {
    case HE_GLB_TRIANGLES:
        stream.mode = HE_MESHOPT_TRIANGLES;
        break;
    case HE_GLB_COPIES:
    case HE_GLB_CORNERS:
        stream.mode = HE_MESHOPT_INDICES;
        break;
    case HE_GLB_WORDS: {
        /* The codec packs the differences between consecutive elements. A 32-bit word of an
         * attribute's value (at a vertex, face or corner) differs little from the same word of the
         * next value, so an element is one whole value. */
        uint32_t words = part->column->components * (part->column->type == HE_DOUBLE ? 2 : 1);
        stream.count /= words;
        stream.stride *= words;
        break;
    }
    case HE_GLB_POSITIONS:
    case HE_GLB_VALUES:
    case HE_GLB_DEGREES:
    case HE_GLB_ORDER:
        break;
    }
    return stream;
}

he_status he_glb_pack(he_glb_parts *parts, he_glb_part *part, const void *bytes, he_error *err)
{
    const he_meshopt_stream stream = he_glb_part_stream(part);
    size_t most = he_meshopt_bound(&stream) + 3;
    if (parts->streams_capacity - parts->streams_length < most) {
        size_t capacity = he_mem_grown(parts->streams_capacity, parts->streams_length + most);
        unsigned char *grown = he_mem_resize(parts->streams, capacity);
        if (grown == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to pack %zu bytes", most);
        }
        parts->streams = grown;
        parts->streams_capacity = capacity;
    }
    unsigned char *at = parts->streams + parts->streams_length;
    size_t used = he_meshopt_encode(&stream, bytes, at, most - 3);
    part->packed_at = parts->streams_length;
    part->packed = used;
    while (used % 4 != 0) {
        at[used++] = 0;
    }
    parts->streams_length += used;
    return HE_OK;
}

uint64_t he_glb_bin_bytes(const he_glb_parts *parts)
{
    return parts->packs ? parts->streams_length : parts->bytes;
}
