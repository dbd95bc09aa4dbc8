/* gltf_unpack.c - finds the bytes of buffer views, and decompresses those of
 * EXT_meshopt_compression. */
#include "format/gltf/gltf_asset.h"

#include "format/gltf/meshopt.h"

#include <string.h>

uint32_t he_gltf_meshopt(const he_gltf *asset, uint32_t object)
{
    return he_json_find(&asset->json, he_json_find(&asset->json, object, "extensions"),
                        HE_GLTF_MESHOPT);
}

he_status he_gltf_buffer_part(he_gltf *asset, uint32_t object, he_gltf_buffer *out, he_error *err)
{
    const he_json *json = &asset->json;
    uint64_t buffer = 0, start = 0, length = 0;
    he_status status =
        he_gltf_need(asset, object, "buffer", (he_gltf_range){0, HE_JSON_WHOLE}, &buffer, err);
    if (status == HE_OK && buffer >= asset->buffer_count) {
        status = he_json_fail(json, object, err, HE_BAD_INDEX,
                              "there is no buffer %llu; the file has %zu",
                              (unsigned long long)buffer, asset->buffer_count);
    }
    if (status == HE_OK) {
        status = he_gltf_may(asset, object, "byteOffset", HE_JSON_WHOLE, &start, err);
    }
    if (status == HE_OK) {
        status = he_gltf_need(asset, object, "byteLength", (he_gltf_range){1, HE_JSON_WHOLE},
                              &length, err);
    }
    if (status != HE_OK) {
        return status;
    }
    const he_gltf_buffer *b = &asset->buffers[buffer];
    if (start + length > b->length) {
        return he_json_fail(json, object, err, HE_BAD_VALUE,
                            "bytes %llu to %llu do not fit in a buffer of %llu bytes",
                            (unsigned long long)start, (unsigned long long)(start + length),
                            (unsigned long long)b->length);
    }
    if (b->bytes == NULL) {
        return he_json_fail(json, object, err, HE_BAD_VALUE,
                            "buffer %llu is only a fallback and has no bytes, so it cannot be read",
                            (unsigned long long)buffer);
    }
    *out = (he_gltf_buffer){.bytes = b->bytes + start,
                            .length = length,
                            .start = start,
                            .place = b->place == HE_GLTF_NOWHERE ? b->place : b->place + start};
    return HE_OK;
}

/* --- compressed views --- */

/* A member of a JSON object whose value must be one of `words`. */
typedef struct choice {
    const char *name;
    const char *const *words;
    int count;
    /* Index of the word that is meant if the member is missing; -1 if the member must exist. */
    int absent;
} choice;

/* Reads a member of a JSON object that must be one of the words of `c`. *out becomes the index
 * of this word. */
static he_status find_word(const he_gltf *asset, uint32_t object, const choice *c, int *out,
                           he_error *err)
{
    const he_json *json = &asset->json;
    uint32_t value = he_json_find(json, object, c->name);
    *out = c->absent;
    for (int i = 0; i < c->count && value != HE_NONE; i++) {
        if (he_json_is(json, value, c->words[i])) {
            *out = i;
            return HE_OK;
        }
    }
    if (value == HE_NONE && c->absent >= 0) {
        return HE_OK;
    }
    return value == HE_NONE
               ? he_json_fail(json, object, err, HE_BAD_VALUE, "'%s' is missing", c->name)
               : he_json_fail(json, value, err, HE_UNSUPPORTED,
                              "this value of \"%s\" is not supported", c->name);
}

static he_status read_stream(const he_gltf *asset, uint32_t object, he_meshopt_stream *out,
                             he_error *err)
{
    static const choice modes = {"mode", he_meshopt_modes, HE_MESHOPT_MODES, -1};
    static const choice filters = {"filter", he_meshopt_filters, HE_MESHOPT_FILTERS,
                                   HE_MESHOPT_NONE};
    uint64_t stride = 0;
    int mode = 0, filter = HE_MESHOPT_NONE;
    he_status status = find_word(asset, object, &modes, &mode, err);
    if (status == HE_OK) {
        status = find_word(asset, object, &filters, &filter, err);
    }
    if (status == HE_OK) {
        status =
            he_gltf_need(asset, object, "count", (he_gltf_range){1, HE_MAX_ROWS}, &out->count, err);
    }
    if (status == HE_OK) {
        status = he_gltf_need(asset, object, "byteStride", (he_gltf_range){1, HE_JSON_WHOLE},
                              &stride, err);
    }
    if (status != HE_OK) {
        return status;
    }
    out->mode = (he_meshopt_mode)mode;
    out->filter = (he_meshopt_filter)filter;
    out->stride = (size_t)stride;
    const char *wrong = he_meshopt_fits(out);
    return wrong == NULL ? HE_OK
                         : he_json_fail(&asset->json, object, err, HE_BAD_VALUE, "%s", wrong);
}

/* Refuses bytes that cannot be a stream of this layout, before memory for its elements is
 * allocated. */
static he_status check_stream(const he_gltf *asset, uint32_t object,
                              const he_meshopt_stream *stream, const he_gltf_buffer *packed,
                              he_error *err)
{
    const he_json *json = &asset->json;
    uint64_t least = he_meshopt_least(stream);
    int version = he_meshopt_version(stream, packed->bytes, packed->length);
    int latest = stream->mode == HE_MESHOPT_ATTRIBUTES ? (int)HE_MESHOPT_ATTRIBUTES_VERSION
                                                       : (int)HE_MESHOPT_INDEX_VERSION;
    if (packed->length < least) {
        return he_json_fail(json, object, err, HE_BAD_VALUE,
                            "%llu elements of %zu bytes cannot be compressed to only %llu bytes",
                            (unsigned long long)stream->count, stream->stride,
                            (unsigned long long)packed->length);
    }
    if (version < 0) {
        return he_json_fail(json, object, err, HE_SYNTAX,
                            "the bytes are not a compressed stream of the mode %s",
                            he_meshopt_modes[stream->mode]);
    }
    if (version > latest) {
        return he_json_fail(json, object, err, HE_UNSUPPORTED,
                            "%s were compressed by version %d of their coding; " HE_GLTF_MESHOPT
                            " allows at most %d",
                            he_meshopt_modes[stream->mode], version, latest);
    }
    return HE_OK;
}

static he_status unpack(he_gltf *asset, uint32_t view, uint32_t object, he_gltf_buffer *out,
                        he_error *err)
{
    const he_json *json = &asset->json;
    he_meshopt_stream stream = {.mode = HE_MESHOPT_ATTRIBUTES};
    he_gltf_buffer packed = {.bytes = NULL};
    uint64_t length = 0;
    he_status status =
        he_gltf_need(asset, view, "byteLength", (he_gltf_range){1, HE_JSON_WHOLE}, &length, err);
    if (status == HE_OK) {
        status = read_stream(asset, object, &stream, err);
    }
    if (status == HE_OK) {
        status = he_gltf_buffer_part(asset, object, &packed, err);
    }
    if (status == HE_OK) {
        status = check_stream(asset, object, &stream, &packed, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* The product does not overflow: its factors are below 2^32 and 2^9. */
    uint64_t bytes = stream.count * stream.stride;
    if (length > bytes) {
        return he_json_fail(json, view, err, HE_BAD_VALUE,
                            "the buffer view declares %llu bytes, but decompresses to %llu",
                            (unsigned long long)length, (unsigned long long)bytes);
    }
    if (bytes > asset->unpack_room) {
        return he_json_fail(
            json, object, err, HE_LIMIT,
            "the file decompresses to more than %llu MiB, and more than %llu times its size",
            (unsigned long long)(HE_GLTF_ROOM >> 20), (unsigned long long)HE_GLTF_UNPACKED);
    }
    asset->unpack_room -= bytes;
    asset->room += 2 * bytes;
    unsigned char *own = he_mem_alloc((size_t)bytes);
    if (own == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to unpack %llu bytes",
                             (unsigned long long)bytes);
    }
    if (!he_meshopt_decode(&stream, packed.bytes, (size_t)packed.length, own)) {
        he_mem_free(own);
        return he_json_fail(
            json, object, err, HE_SYNTAX,
            "the bytes are not a compressed stream of the mode %s with %llu elements",
            he_meshopt_modes[stream.mode], (unsigned long long)stream.count);
    }
    *out = (he_gltf_buffer){.bytes = own, .own = own, .length = length, .place = HE_GLTF_NOWHERE};
    asset->steps += bytes / sizeof(uint32_t);
    return he_gltf_tell(asset, err);
}

/* Returns the index of a view (a JSON value) in the list of views, which is in rising order. */
static size_t number_of(const he_ids *views, uint32_t view)
{
    size_t from = 0, to = views->count;
    while (to - from > 1) {
        size_t middle = from + (to - from) / 2;
        from = views->ids[middle] <= view ? middle : from;
        to = views->ids[middle] <= view ? to : middle;
    }
    return from;
}

he_status he_gltf_unpack(he_gltf *asset, uint32_t view, uint32_t extension,
                         const he_gltf_buffer **out, he_error *err)
{
    if (asset->unpacked == NULL) {
        asset->unpacked = he_mem_zero(asset->views.count, sizeof *asset->unpacked);
        if (asset->unpacked == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu buffer views",
                                 asset->views.count);
        }
    }
    size_t i = number_of(&asset->views, view);
    he_status status = HE_OK;
    if (asset->unpacked[i].bytes == NULL) {
        status = unpack(asset, view, extension, &asset->unpacked[i], err);
    }
    if (status == HE_OK) {
        *out = &asset->unpacked[i];
    }
    return status;
}
