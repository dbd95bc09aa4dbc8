/* gltf_file.h - GLB files built from JSON, written with ' for ", and from the bytes of a square:
 *
 *     3---2      byte 0: the corners as floats, 48: triangles 0 1 2, 0 2 3 of 16 bits,
 *     | / |      60: the strip 0 1 3 2 of 8 bits, 64: the fan 0 1 2 3 of 32 bits,
 *     0---1      80: four colours of 3 bytes at a stride of 4 */
#ifndef TESTS_UNIT_GLTF_FILE_H
#define TESTS_UNIT_GLTF_FILE_H

#include "unit/format_fixture.h"

typedef struct glb_file {
    unsigned char bytes[16384];
    size_t length;
    size_t json; /* offset of the JSON text in the file */
    size_t bin;
} glb_file;

static inline void glb_word(glb_file *f, uint32_t word)
{
    assert_true(f->length + 4 <= sizeof f->bytes);
    for (unsigned shift = 0; shift < 32; shift += 8) {
        f->bytes[f->length++] = (unsigned char)(word >> shift);
    }
}

/* Makes a file of a JSON chunk and a binary chunk; with `bin` NULL there is no binary chunk. */
static inline void glb_make(glb_file *f, const char *json, const void *bin, size_t size)
{
    size_t length = strlen(json), padded = (length + 3) / 4 * 4;
    f->length = 0;
    glb_word(f, 0x46546C67);
    glb_word(f, 2);
    glb_word(f, (uint32_t)(20 + padded + (bin != NULL ? 8 + size : 0)));
    glb_word(f, (uint32_t)padded);
    glb_word(f, 0x4E4F534A);
    f->json = f->length;
    assert_true(f->length + padded + 8 + size <= sizeof f->bytes);
    for (size_t i = 0; i < padded; i++) {
        char c = i < length ? json[i] : ' ';
        f->bytes[f->length++] = (unsigned char)(c == '\'' ? '"' : c);
    }
    f->bin = 0;
    if (bin != NULL) {
        glb_word(f, (uint32_t)size);
        glb_word(f, 0x004E4942);
        f->bin = f->length;
        memcpy(f->bytes + f->length, bin, size);
        f->length += size;
    }
}

#define SQUARE_BYTES 96
static const double square[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

static inline void square_bin(unsigned char bin[SQUARE_BYTES])
{
    static const uint16_t triangles[6] = {0, 1, 2, 0, 2, 3};
    static const uint32_t fan[4] = {0, 1, 2, 3};
    memset(bin, 0, SQUARE_BYTES);
    for (size_t i = 0; i < 12; i++) {
        float value = (float)square[i / 3][i % 3];
        memcpy(bin + 4 * i, &value, sizeof value);
    }
    memcpy(bin + 48, triangles, sizeof triangles);
    memcpy(bin + 60, (unsigned char[]){0, 1, 3, 2}, 4);
    memcpy(bin + 64, fan, sizeof fan);
    memcpy(bin + 80, (unsigned char[]){255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9, 51, 102, 204, 9},
           16);
}

#define ASSET   "'asset':{'version':'2.0'}"
#define BUFFERS "'buffers':[{'byteLength':96}]"
#define VIEWS                                                                                   \
    "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':12}," \
    "{'buffer':0,'byteOffset':60,'byteLength':4},{'buffer':0,'byteOffset':64,'byteLength':16}," \
    "{'buffer':0,'byteOffset':80,'byteLength':16,'byteStride':4}]"
/* the accessors of the square: 0 positions, 1 triangles, 2 strip, 3 fan, 4 colours */
#define ACCESSOR_LIST                                                  \
    "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"   \
    "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'}," \
    "{'bufferView':2,'componentType':5121,'count':4,'type':'SCALAR'}," \
    "{'bufferView':3,'componentType':5125,'count':4,'type':'SCALAR'}," \
    "{'bufferView':4,'componentType':5121,'count':4,'type':'VEC3','normalized':true}"
#define ACCESSORS "'accessors':[" ACCESSOR_LIST "]"
#define DATA      ASSET "," BUFFERS "," VIEWS "," ACCESSORS
#define PRIMITIVE "{'attributes':{'POSITION':0},'indices':1}"
#define MESHES    "'meshes':[{'primitives':[" PRIMITIVE "]}]"

static inline he_status read_square(const char *json, he_import *import, he_error *err)
{
    unsigned char bin[SQUARE_BYTES];
    glb_file f;
    square_bin(bin);
    glb_make(&f, json, bin, sizeof bin);
    return read_bytes("glb", f.bytes, f.length, import, err);
}

static inline he_import square_import(const char *json)
{
    he_import import = {0};
    he_error err = {0};
    if (read_square(json, &import, &err) != HE_OK) {
        fail_msg("%s\nbyte %llu: %s", json, (unsigned long long)err.at, err.text);
    }
    return import;
}

/* Requires that the file is refused with a byte offset, and that the message has these words, which
 * include the path in the JSON. */
static inline void expect_json_refused(const char *json, he_status wanted, const char *words)
{
    he_import import = {0};
    he_error err = {0};
    he_status status = read_square(json, &import, &err);
    if (status != wanted || err.place != HE_PLACE_BYTE || strstr(err.text, words) == NULL) {
        fail_msg("%s\ngot %s, place %d, byte %llu: %s\nwanted %s, %s", json, he_status_slug(status),
                 (int)err.place, (unsigned long long)err.at, err.text, he_status_slug(wanted),
                 words);
    }
}

#endif
