#include "api/json/packed.h"

#include "base/mem.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char magic[4] = {'H', 'E', 'D', 'E'};
enum { VERSION = 1, HEADER = 24, ROW = 16, REVISION_AT = 16, ALIGNED = 8 };

void api_arrays_clear(api_arrays *arrays)
{
    he_mem_free(arrays->arrays);
    api_text_clear(&arrays->bytes);
    *arrays = (api_arrays){.count = 0};
}

static size_t size_of(uint32_t type)
{
    return type == API_PACKED_U32 ? sizeof(uint32_t) : sizeof(double);
}

static size_t padded(size_t bytes)
{
    return (bytes + ALIGNED - 1) / ALIGNED * ALIGNED;
}

/* --- reading --- */

__attribute__((format(printf, 3, 4))) static bool refuse(api_problem *problem, size_t place,
                                                         const char *format, ...)
{
    char text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return api_problem_set(problem, HE_BAD_VALUE, "byte %zu: %s", place, text);
}

static uint32_t u32_at(api_bytes body, size_t at)
{
    uint32_t value;
    memcpy(&value, body.at + at, sizeof value);
    return value;
}

static uint64_t u64_at(api_bytes body, size_t at)
{
    uint64_t value;
    memcpy(&value, body.at + at, sizeof value);
    return value;
}

/* Checks that the bytes from `from` to `to` - 1 are zeros. */
static bool check_padding(api_bytes body, size_t from, size_t to, api_problem *problem)
{
    if (to > body.length) {
        return refuse(problem, body.length, "the body ends within the zeros after a part of it");
    }
    for (size_t i = from; i < to; i++) {
        if (body.at[i] != 0) {
            return refuse(problem, i, "this must be a zero, up to a multiple of %d bytes",
                          (int)ALIGNED);
        }
    }
    return true;
}

/* Reads the description of an array at byte `row`, and places the array at byte *at. */
static bool take_array(api_bytes body, size_t row, size_t *at, api_numbers *out,
                       api_problem *problem)
{
    const uint32_t type = u32_at(body, row), width = u32_at(body, row + 4);
    const uint64_t items = u64_at(body, row + 8);
    if (type != API_PACKED_U32 && type != API_PACKED_F64) {
        return refuse(problem, row, "%u is not a type of numbers; 1 is u32, 2 is f64", type);
    }
    if (width != 1 && !(width == 3 && type == API_PACKED_F64)) {
        return refuse(problem, row + 4,
                      "an item of the array has %u numbers; it must have 1, or 3 of type f64",
                      width);
    }
    if (items > (body.length - *at) / (width * size_of(type))) {
        return refuse(problem, row + 8,
                      "the array has %llu items, which are more than the body has bytes for",
                      (unsigned long long)items);
    }
    const size_t bytes = (size_t)items * width * size_of(type);
    *out = (api_numbers){type, width, (size_t)items, {body.at + *at}};
    const size_t end = *at + bytes;
    *at = padded(end);
    return check_padding(body, end, *at, problem);
}

bool api_packed_open(api_bytes body, api_arrays *out, api_bytes *json, api_problem *problem)
{
    assert((uintptr_t)body.at % ALIGNED == 0);
    if (body.length < HEADER) {
        return refuse(problem, body.length, "the header has %d bytes", (int)HEADER);
    }
    if (memcmp(body.at, magic, sizeof magic) != 0) {
        return refuse(problem, 0, "the body must begin with \"HEDE\"");
    }
    if (u32_at(body, 4) != VERSION) {
        return refuse(problem, 4, "%u is not a known version of this layout; there is only 1",
                      u32_at(body, 4));
    }
    if (u64_at(body, REVISION_AT) != 0) {
        return refuse(problem, REVISION_AT, "these 8 bytes must be zeros in a request");
    }
    const size_t text = u32_at(body, 8), count = u32_at(body, 12);
    if (count > (body.length - HEADER) / ROW) {
        return refuse(problem, 12, "the body is too short for the rows of %zu arrays", count);
    }
    const size_t begin = HEADER + count * ROW;
    if (text > body.length - begin) {
        return refuse(problem, 8, "the body is too short for a JSON text of %zu bytes", text);
    }
    size_t at = padded(begin + text);
    if (!check_padding(body, begin + text, at, problem)) {
        return false;
    }
    out->arrays = he_mem_array(NULL, count, sizeof *out->arrays);
    if (out->arrays == NULL) {
        return api_problem_set(problem, HE_NO_MEMORY, "no memory for %zu arrays", count);
    }
    for (out->count = 0; out->count < count; out->count++) {
        if (!take_array(body, HEADER + out->count * ROW, &at, &out->arrays[out->count], problem)) {
            return false;
        }
    }
    *json = (api_bytes){body.at + begin, text};
    return at == body.length || refuse(problem, at, "the body must end here, after the last array");
}

/* --- writing --- */

size_t api_packed_add(api_arrays *arrays, uint32_t type, uint32_t width, const void *numbers,
                      size_t count)
{
    static const char zeros[ALIGNED] = {0};
    const size_t bytes = count * width * size_of(type);
    if (arrays->count == arrays->capacity) {
        const size_t grown = he_mem_grown(arrays->capacity, arrays->count + 1);
        api_numbers *more = he_mem_array(arrays->arrays, grown, sizeof *more);
        if (more == NULL) {
            arrays->bytes.failed = true;
            return 0;
        }
        arrays->arrays = more;
        arrays->capacity = grown;
    }
    arrays->arrays[arrays->count] = (api_numbers){type, width, count, {NULL}};
    api_text_add(&arrays->bytes, numbers, bytes);
    api_text_add(&arrays->bytes, zeros, padded(bytes) - bytes);
    return arrays->count++;
}

static void add_u32(api_text *out, size_t value)
{
    const uint32_t number = (uint32_t)value;
    api_text_add(out, (const char *)&number, sizeof number);
}

static void add_u64(api_text *out, uint64_t value)
{
    api_text_add(out, (const char *)&value, sizeof value);
}

void api_packed_write(const api_arrays *arrays, const api_text *json, api_text *out)
{
    static const char zeros[ALIGNED] = {0};
    api_text_add(out, magic, sizeof magic);
    add_u32(out, VERSION);
    add_u32(out, json->length);
    add_u32(out, arrays->count);
    add_u64(out, 0);
    for (size_t i = 0; i < arrays->count; i++) {
        add_u32(out, arrays->arrays[i].type);
        add_u32(out, arrays->arrays[i].width);
        add_u64(out, arrays->arrays[i].count);
    }
    api_text_add(out, json->bytes, json->length);
    api_text_add(out, zeros, padded(out->length) - out->length);
    api_text_add(out, arrays->bytes.bytes, arrays->bytes.length);
    out->failed = out->failed || arrays->bytes.failed || json->failed;
}

void api_packed_fill(api_text *body, uint64_t revision)
{
    memcpy(body->bytes + REVISION_AT, &revision, sizeof revision);
}
