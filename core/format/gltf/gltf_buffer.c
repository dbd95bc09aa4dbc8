/* Buffers of gltf_asset.h. */
#include "format/gltf/gltf_asset.h"

#include "format/text/base64.h"

#include <string.h>

/* The number of base64 characters after which progress is reported; a multiple of four. */
enum { PIECE = 1 << 16 };

/* Decodes `length` characters of base64 to to->own, which has room for the decoded bytes. */
static he_status decode(he_gltf *asset, uint32_t uri, const char *text, size_t length,
                        he_gltf_buffer *to, he_error *err)
{
    he_status status = HE_OK;
    for (size_t at = 0, n; at < length && status == HE_OK; at += n) {
        size_t decoded;
        n = length - at < PIECE ? length - at : PIECE;
        if (!he_base64_decode(text + at, n, to->own + to->length, &decoded) ||
            (at + n < length && decoded != PIECE / 4 * 3)) {
            return he_json_fail(&asset->json, uri, err, HE_SYNTAX,
                                "the data: URI of a buffer is not base64");
        }
        to->length += decoded;
        asset->steps += n;
        status = he_gltf_tell(asset, err);
    }
    return status;
}

/* Gets the characters of a JSON string. If it has escapes, they are decoded into memory at `own`,
 * which the caller frees. */
static he_status plain_text(const he_json *json, uint32_t value, const char **text, size_t *length,
                            char **own, he_error *err)
{
    *text = he_json_raw(json, value, length);
    if (memchr(*text, '\\', *length) == NULL) {
        return HE_OK;
    }
    *own = he_mem_alloc(*length + 1);
    if (*own == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a string of %zu bytes", *length);
    }
    *length = he_json_string(json, value, *own, *length + 1);
    *text = *own;
    return HE_OK;
}

/* Finds the bytes of a buffer in a file that came together with the asset. */
static he_status find_beside(he_gltf *asset, he_gltf_buffer *buffer, uint32_t uri, const char *name,
                             size_t length, he_error *err)
{
    he_beside *beside = asset->into->beside;
    const he_beside_file *file = he_beside_find_uri(beside, name, length);
    char quoted[48], came[80];
    if (file == NULL) {
        he_quote(name, name + length, quoted, sizeof quoted);
        if (beside == NULL || beside->count == 0) {
            return he_json_fail(&asset->json, uri, err, HE_UNSUPPORTED,
                                "the buffer is in another file, '%s': send both as "
                                "multipart/form-data, or a .glb",
                                quoted);
        }
        he_beside_list(beside, came, sizeof came);
        return he_json_fail(&asset->json, uri, err, HE_UNSUPPORTED,
                            "the file '%s' of a buffer was not sent; the files sent are %s", quoted,
                            came);
    }
    *buffer = (he_gltf_buffer){.bytes = (const unsigned char *)file->bytes,
                               .length = file->length,
                               .place = HE_GLTF_NOWHERE};
    return HE_OK;
}

static he_status decode_data(he_gltf *asset, he_gltf_buffer *buffer, uint32_t uri, const char *text,
                             size_t length, he_error *err)
{
    const he_json *json = &asset->json;
    const char *comma = memchr(text, ',', length);
    static const char coding[] = ";base64";
    size_t head = comma == NULL ? 0 : (size_t)(comma - text), size = sizeof coding - 1;
    if (head < size || memcmp(comma - size, coding, size) != 0) {
        return he_json_fail(json, uri, err, HE_UNSUPPORTED,
                            "the data: URI of a buffer is not base64");
    }
    length -= head + 1;
    *buffer =
        (he_gltf_buffer){.own = he_mem_alloc(he_base64_room(length)), .place = HE_GLTF_NOWHERE};
    if (buffer->own == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a buffer of %zu characters", length);
    }
    buffer->bytes = buffer->own;
    return decode(asset, uri, comma + 1, length, buffer, err);
}

static he_status read_uri(he_gltf *asset, he_gltf_buffer *buffer, uint32_t uri, he_error *err)
{
    size_t length;
    const char *text;
    char *own = NULL;
    if (he_json_type(&asset->json, uri) != '"') {
        return he_json_fail(&asset->json, uri, err, HE_BAD_VALUE,
                            "the URI of a buffer is not a string");
    }
    he_status status = plain_text(&asset->json, uri, &text, &length, &own, err);
    if (status == HE_OK) {
        status = he_json_begins(&asset->json, uri, "data:")
                     ? decode_data(asset, buffer, uri, text, length, err)
                     : find_beside(asset, buffer, uri, text, length, err);
    }
    he_mem_free(own);
    return status;
}

/* Returns true if the buffer is only a fallback for readers that do not know the compression
 * extension. The file of such a buffer may be missing. */
static bool is_fallback(const he_gltf *asset, uint32_t value)
{
    uint32_t flag = he_json_find(&asset->json, he_gltf_meshopt(asset, value), "fallback");
    return he_json_type(&asset->json, flag) == 't';
}

/* Finds the bytes of a fallback buffer. The bytes may be missing, because hedge does not use
 * them if all views of the buffer are compressed. */
static he_status find_fallback(he_gltf *asset, size_t i, uint32_t value, he_error *err)
{
    uint32_t uri = he_json_find(&asset->json, value, "uri");
    he_error missing = {0};
    he_status status =
        uri == HE_NONE ? HE_UNSUPPORTED : read_uri(asset, &asset->buffers[i], uri, &missing);
    if (status != HE_OK && status != HE_UNSUPPORTED && err != NULL) {
        *err = missing;
    }
    return status == HE_UNSUPPORTED ? HE_OK : status;
}

static he_status find_bytes(he_gltf *asset, size_t i, uint32_t value, const he_gltf_bin *bin,
                            uint64_t length, he_error *err)
{
    he_gltf_buffer *buffer = &asset->buffers[i];
    uint32_t uri = he_json_find(&asset->json, value, "uri");
    if (uri != HE_NONE) {
        return read_uri(asset, buffer, uri, err);
    }
    if (i > 0 || bin->bytes == NULL) {
        return he_json_fail(
            &asset->json, value, err, HE_BAD_VALUE,
            "the buffer has no URI, and the file has no binary chunk that holds its bytes");
    }
    *buffer = (he_gltf_buffer){.bytes = bin->bytes, .length = bin->length, .place = bin->place};
    if (bin->length > length && bin->length - length > 3) {
        he_gltf_note(asset, "bin_longer",
                     "bytes at the end of the BIN chunk are ignored, because the buffer in it is "
                     "shorter than the chunk",
                     HE_NONE, value);
    }
    return HE_OK;
}

static he_status open_buffer(he_gltf *asset, size_t i, uint32_t value, const he_gltf_bin *bin,
                             he_error *err)
{
    he_gltf_buffer *buffer = &asset->buffers[i];
    uint64_t length = 0;
    he_status status =
        he_gltf_need(asset, value, "byteLength", (he_gltf_range){1, HE_JSON_WHOLE}, &length, err);
    if (status == HE_OK) {
        status = is_fallback(asset, value) ? find_fallback(asset, i, value, err)
                                           : find_bytes(asset, i, value, bin, length, err);
    }
    if (status == HE_OK && buffer->bytes != NULL && buffer->length < length) {
        return he_json_fail(&asset->json, value, err, HE_BAD_VALUE,
                            "the buffer should have %llu bytes, and only %llu were sent",
                            (unsigned long long)length, (unsigned long long)buffer->length);
    }
    buffer->length = length;
    return status;
}

he_status he_gltf_open_buffers(he_gltf *asset, const he_gltf_bin *bin, he_error *err)
{
    he_ids list = {0};
    he_status status = he_gltf_list(asset, "buffers", &list, err);
    if (status == HE_OK && list.count > 0) {
        asset->buffers = he_mem_zero(list.count, sizeof *asset->buffers);
        asset->buffer_count = list.count;
        if (asset->buffers == NULL) {
            asset->buffer_count = 0;
            status = he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu buffers", list.count);
        }
    }
    for (size_t i = 0; i < list.count && status == HE_OK; i++) {
        status = open_buffer(asset, i, list.ids[i], bin, err);
    }
    he_ids_clear(&list);
    return status;
}
