/* The readers of glTF, as JSON and in its binary container: reader.h says what must hold. The bytes
 * before the first zero byte and those after it are also put into a container with correct lengths,
 * because random changes to a container are mostly refused for its lengths alone. */
#include "fuzz/fuzz.h"
#include "fuzz/reader.h"

#include <stdlib.h>
#include <string.h>

static void put_u32(uint8_t *at, size_t value)
{
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(value >> 8 * i);
    }
}

/* Writes one chunk of a container, filled up to a multiple of four bytes; returns where the chunk
 * ends. */
static uint8_t *put_chunk(uint8_t *at, const char *type, char fill, const uint8_t *bytes,
                          size_t size)
{
    size_t whole = (size + 3) / 4 * 4;
    put_u32(at, whole);
    memcpy(at + 4, type, 4);
    memset(at + 8, fill, whole);
    if (size > 0) {
        memcpy(at + 8, bytes, size);
    }
    return at + 8 + whole;
}

static void read_contained(const uint8_t *bytes, size_t size)
{
    const uint8_t *zero = memchr(bytes, '\0', size);
    size_t json = zero == NULL ? size : (size_t)(zero - bytes),
           rest = zero == NULL ? 0 : size - json - 1;
    uint8_t *file = malloc(12 + 8 + json + 3 + 8 + rest + 3);
    if (file == NULL) {
        abort();
    }
    memcpy(file, "glTF\2\0\0\0", 8);
    uint8_t *end = put_chunk(file + 12, "JSON", ' ', bytes, json);
    if (zero != NULL) {
        end = put_chunk(end, "BIN", '\0', zero + 1, rest);
    }
    put_u32(file + 8, (size_t)(end - file));
    fuzz_reader("glb", file, (size_t)(end - file));
    free(file);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    if (size >= 4 && memcmp(bytes, "glTF", 4) == 0) {
        fuzz_reader("glb", bytes, size);
        return;
    }
    fuzz_reader("gltf", bytes, size);
    read_contained(bytes, size);
}
