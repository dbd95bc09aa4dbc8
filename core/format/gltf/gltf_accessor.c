/* gltf_accessor.c - finds the elements of accessors in an asset's buffers, and checks them. */
#include "format/gltf/gltf_asset.h"

#include <assert.h>
#include <math.h>
#include <string.h>

size_t he_gltf_type_bytes(he_gltf_type type)
{
    switch (type) {
    case HE_GLTF_INT8:
    case HE_GLTF_UINT8:
        return 1;
    case HE_GLTF_INT16:
    case HE_GLTF_UINT16:
        return 2;
    case HE_GLTF_UINT32:
    case HE_GLTF_FLOAT:
        break;
    }
    return 4;
}

static he_status get_type(const he_gltf *asset, uint32_t object, he_gltf_type *type, he_error *err)
{
    uint64_t code = 0;
    he_status status = he_gltf_need(asset, object, "componentType",
                                    (he_gltf_range){HE_GLTF_INT8, HE_GLTF_FLOAT}, &code, err);
    if (status == HE_OK && code == HE_GLTF_UINT32 - 1) {
        status = he_json_fail(&asset->json, object, err, HE_BAD_VALUE,
                              "componentType 5124 does not exist in glTF");
    }
    if (status == HE_OK) {
        *type = (he_gltf_type)code;
    }
    return status;
}

static he_status get_shape(const he_gltf *asset, he_gltf_accessor *a, he_error *err)
{
    static const struct {
        const char *name;
        uint32_t components;
        bool matrix;
    } shapes[] = {{"SCALAR", 1, false}, {"VEC2", 2, false}, {"VEC3", 3, false}, {"VEC4", 4, false},
                  {"MAT2", 4, true},    {"MAT3", 9, true},  {"MAT4", 16, true}};
    uint32_t value = he_json_find(&asset->json, a->value, "type");
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        if (he_json_is(&asset->json, value, shapes[i].name)) {
            a->components = shapes[i].components;
            a->matrix = shapes[i].matrix;
            return HE_OK;
        }
    }
    return he_json_fail(&asset->json, a->value, err, HE_BAD_VALUE,
                        "'type' is not SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
}

static size_t element_bytes(const he_gltf_accessor *a)
{
    size_t bytes = he_gltf_type_bytes(a->type);
    if (!a->matrix) {
        return bytes * a->components;
    }
    /* The columns of a matrix begin at multiples of four bytes. */
    size_t rows = a->components == 4 ? 2 : a->components == 9 ? 3 : 4;
    return rows * ((rows * bytes + 3) / 4 * 4);
}

/* The elements in a buffer to which a JSON object with bufferView and byteOffset refers. */
typedef struct span {
    const unsigned char *bytes;
    size_t stride;
    uint64_t place;
} span;

/* Finds the bytes of a buffer view, and decompresses the bytes if necessary. */
static he_status get_view(he_gltf *asset, uint32_t view, he_gltf_buffer *out, he_error *err)
{
    uint32_t extension = he_gltf_meshopt(asset, view);
    if (extension == HE_NONE) {
        return he_gltf_buffer_part(asset, view, out, err);
    }
    const he_gltf_buffer *unpacked = NULL;
    he_status status = he_gltf_unpack(asset, view, extension, &unpacked, err);
    if (status == HE_OK) {
        *out = *unpacked;
    }
    return status;
}

/* How the elements of a span lie in memory. */
typedef struct layout {
    uint64_t count;
    size_t size;      /* bytes of an element */
    size_t alignment; /* bytes of each number of an element */
} layout;

/* Finds the bytes of the elements to which a JSON object refers. No computation overflows 64
 * bits: all numbers are at most 2^53, and a stride is below 2^8. */
static he_status get_span(he_gltf *asset, uint32_t object, layout elements, span *out,
                          he_error *err)
{
    const uint64_t count = elements.count;
    const size_t size = elements.size, alignment = elements.alignment;
    const he_json *json = &asset->json;
    uint64_t stride = 0, offset = 0;
    he_gltf_buffer part = {.bytes = NULL};
    uint32_t view = HE_NONE, name = he_json_find(json, object, "bufferView");
    if (name == HE_NONE) {
        return he_json_fail(json, object, err, HE_BAD_VALUE, "'bufferView' is missing");
    }
    he_status status = he_gltf_item(asset, &asset->views, name, "buffer view", &view, err);
    if (status == HE_OK) {
        status = get_view(asset, view, &part, err);
    }
    if (status == HE_OK) {
        status = he_gltf_may(asset, view, "byteStride", 252, &stride, err);
    }
    if (status == HE_OK) {
        status = he_gltf_may(asset, object, "byteOffset", HE_JSON_WHOLE, &offset, err);
    }
    if (status != HE_OK) {
        return status;
    }
    uint64_t length = part.length;
    stride = stride == 0 ? size : stride;
    if (stride < size) {
        return he_json_fail(json, view, err, HE_BAD_VALUE,
                            "elements of %zu bytes overlap, because the stride is only %llu", size,
                            (unsigned long long)stride);
    }
    if (offset > length || size > length - offset ||
        count - 1 > (length - offset - size) / stride) {
        return he_json_fail(
            json, object, err, HE_BAD_VALUE,
            "%llu elements of %zu bytes from byte %llu do not fit in a buffer view of %llu bytes",
            (unsigned long long)count, size, (unsigned long long)offset,
            (unsigned long long)length);
    }
    if ((part.start + offset) % alignment != 0 || stride % alignment != 0) {
        he_gltf_note(
            asset, "misaligned",
            "the numbers of an accessor are read, although they are not aligned as glTF requires",
            HE_NONE, object);
    }
    *out = (span){part.bytes + offset, (size_t)stride,
                  part.place == HE_GLTF_NOWHERE ? part.place : part.place + offset};
    return HE_OK;
}

/* Checks the indices of the elements that a sparse accessor replaces. The indices must rise,
 * because a walk over the elements meets them in rising order. */
static he_status check_changed(he_gltf *asset, const he_gltf_accessor *a, uint32_t sparse,
                               he_error *err)
{
    uint64_t least = 0;
    size_t bytes = he_gltf_type_bytes(a->changed_type);
    he_status status = HE_OK;
    for (uint64_t i = 0; i < a->changed && status == HE_OK; i++) {
        uint32_t index = he_gltf_whole(a->changed_type, a->changed_index + i * bytes);
        if (index < least || index >= a->count) {
            return he_json_fail(&asset->json, sparse, err, HE_BAD_INDEX,
                                "sparse index %u (number %llu) is not greater than the sparse "
                                "index before it, or not less than %llu",
                                index, (unsigned long long)i, (unsigned long long)a->count);
        }
        least = (uint64_t)index + 1;
        status = he_gltf_poll(asset, err);
    }
    return status;
}

static he_status get_sparse(he_gltf *asset, he_gltf_accessor *a, uint32_t sparse, he_error *err)
{
    const he_json *json = &asset->json;
    uint32_t indices = he_json_find(json, sparse, "indices");
    uint32_t values = he_json_find(json, sparse, "values");
    span found = {0};
    if (he_json_type(json, indices) != '{' || he_json_type(json, values) != '{') {
        return he_json_fail(json, sparse, err, HE_BAD_VALUE,
                            "a sparse accessor needs 'indices' and 'values'");
    }
    he_status status =
        he_gltf_need(asset, sparse, "count", (he_gltf_range){1, a->count}, &a->changed, err);
    if (status == HE_OK) {
        status = get_type(asset, indices, &a->changed_type, err);
    }
    if (status == HE_OK && a->changed_type != HE_GLTF_UINT8 && a->changed_type != HE_GLTF_UINT16 &&
        a->changed_type != HE_GLTF_UINT32) {
        status = he_json_fail(json, indices, err, HE_BAD_VALUE,
                              "sparse indices must have componentType 5121, 5123 or 5125");
    }
    if (status == HE_OK) {
        size_t bytes = he_gltf_type_bytes(a->changed_type);
        status = get_span(asset, indices, (layout){a->changed, bytes, bytes}, &found, err);
        if (status == HE_OK && found.stride != bytes) {
            status = he_json_fail(json, indices, err, HE_BAD_VALUE,
                                  "the buffer view of sparse indices must not have a byteStride");
        }
    }
    if (status != HE_OK) {
        return status;
    }
    assert(found.bytes != NULL);
    a->changed_index = found.bytes;
    size_t bytes = element_bytes(a);
    status = get_span(asset, values, (layout){a->changed, bytes, he_gltf_type_bytes(a->type)},
                      &found, err);
    if (status == HE_OK && found.stride != bytes) {
        status = he_json_fail(json, values, err, HE_BAD_VALUE,
                              "the buffer view of sparse values must not have a byteStride");
    }
    if (status != HE_OK) {
        return status;
    }
    a->changed_value = found.bytes;
    /* The changed elements are charged to the asset's limit of memory, because the reader visits
     * them whenever it uses the accessor. */
    status = he_gltf_spend(asset, sparse, a->changed, err);
    return status == HE_OK ? check_changed(asset, a, sparse, err) : status;
}

he_status he_gltf_accessor_get(he_gltf *asset, uint32_t value, he_gltf_accessor *out, he_error *err)
{
    const he_json *json = &asset->json;
    he_gltf_accessor a = {.value = HE_NONE, .place = HE_GLTF_NOWHERE};
    he_status status = he_gltf_item(asset, &asset->accessors, value, "accessor", &a.value, err);
    if (status == HE_OK) {
        status = get_type(asset, a.value, &a.type, err);
    }
    if (status == HE_OK) {
        status = get_shape(asset, &a, err);
    }
    if (status == HE_OK) {
        status =
            he_gltf_need(asset, a.value, "count", (he_gltf_range){1, HE_JSON_WHOLE}, &a.count, err);
    }
    if (status == HE_OK && a.count > HE_MAX_ROWS) {
        status = he_json_fail(json, a.value, err, HE_LIMIT,
                              "the accessor has %llu elements, more than a mesh can have",
                              (unsigned long long)a.count);
    }
    if (status != HE_OK) {
        return status;
    }
    a.normalized = he_json_type(json, he_json_find(json, a.value, "normalized")) == 't' &&
                   a.type != HE_GLTF_FLOAT && a.type != HE_GLTF_UINT32;
    if (he_json_find(json, a.value, "bufferView") != HE_NONE) {
        span found = {0};
        status =
            get_span(asset, a.value,
                     (layout){a.count, element_bytes(&a), he_gltf_type_bytes(a.type)}, &found, err);
        if (status != HE_OK) {
            return status;
        }
        a.bytes = found.bytes;
        a.stride = found.stride;
        a.place = found.place;
    }
    uint32_t sparse = he_json_find(json, a.value, "sparse");
    if (sparse != HE_NONE) {
        status = get_sparse(asset, &a, sparse, err);
    }
    if (status == HE_OK) {
        *out = a;
    }
    return status;
}

const unsigned char *he_gltf_next(he_gltf_walk *walk)
{
    static const unsigned char zeros[HE_GLTF_ELEMENT];
    const he_gltf_accessor *a = walk->accessor;
    uint64_t i = walk->next++;
    if (walk->changed < a->changed) {
        size_t bytes = he_gltf_type_bytes(a->changed_type);
        if (he_gltf_whole(a->changed_type, a->changed_index + walk->changed * bytes) == i) {
            return a->changed_value + walk->changed++ * element_bytes(a);
        }
    }
    return a->bytes == NULL ? zeros : a->bytes + i * a->stride;
}

uint32_t he_gltf_whole(he_gltf_type type, const unsigned char *at)
{
    uint32_t value = at[0];
    if (type == HE_GLTF_UINT16 || type == HE_GLTF_UINT32) {
        value |= (uint32_t)at[1] << 8;
    }
    if (type == HE_GLTF_UINT32) {
        value |= (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
    }
    return value;
}

double he_gltf_number(const he_gltf_accessor *a, const unsigned char *element, uint32_t component)
{
    const unsigned char *at = element + component * he_gltf_type_bytes(a->type);
    double value = 0;
    switch (a->type) {
    case HE_GLTF_INT8:
        value = (int8_t)at[0];
        return a->normalized ? fmax(value / 127, -1) : value;
    case HE_GLTF_UINT8:
        value = at[0];
        return a->normalized ? value / 255 : value;
    case HE_GLTF_INT16:
        value = (int16_t)he_gltf_whole(HE_GLTF_UINT16, at);
        return a->normalized ? fmax(value / 32767, -1) : value;
    case HE_GLTF_UINT16:
        value = he_gltf_whole(HE_GLTF_UINT16, at);
        return a->normalized ? value / 65535 : value;
    case HE_GLTF_UINT32:
        return he_gltf_whole(HE_GLTF_UINT32, at);
    case HE_GLTF_FLOAT: {
        uint32_t bits = he_gltf_whole(HE_GLTF_UINT32, at);
        float number;
        memcpy(&number, &bits, sizeof number);
        value = (double)number;
        break;
    }
    }
    return value;
}
