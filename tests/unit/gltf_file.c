#include "unit/gltf_file.h"

const double glb_square[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

void glb_word(glb_file *f, uint32_t word)
{
    assert_true(f->length + 4 <= sizeof f->bytes);
    for (unsigned shift = 0; shift < 32; shift += 8) {
        f->bytes[f->length++] = (unsigned char)(word >> shift);
    }
}

void glb_make(glb_file *f, const char *json, const void *bin, size_t size)
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

void glb_square_bin(unsigned char bin[SQUARE_BYTES])
{
    static const uint16_t triangles[6] = {0, 1, 2, 0, 2, 3};
    static const uint32_t fan[4] = {0, 1, 2, 3};
    memset(bin, 0, SQUARE_BYTES);
    for (size_t i = 0; i < 12; i++) {
        float value = (float)glb_square[i / 3][i % 3];
        memcpy(bin + 4 * i, &value, sizeof value);
    }
    memcpy(bin + 48, triangles, sizeof triangles);
    memcpy(bin + 60, (unsigned char[]){0, 1, 3, 2}, 4);
    memcpy(bin + 64, fan, sizeof fan);
    memcpy(bin + 80, (unsigned char[]){255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9, 51, 102, 204, 9},
           16);
}

static he_status read_square(const char *json, he_import *import, he_error *err)
{
    unsigned char bin[SQUARE_BYTES];
    glb_file f;
    glb_square_bin(bin);
    glb_make(&f, json, bin, sizeof bin);
    return read_bytes("glb", f.bytes, f.length, import, err);
}

he_import glb_square_import(const char *json)
{
    he_import import = {0};
    he_error err = {0};
    if (read_square(json, &import, &err) != HE_OK) {
        fail_msg("%s\nbyte %llu: %s", json, (unsigned long long)err.at, err.text);
    }
    return import;
}

void glb_expect_refused(const char *json, he_status wanted, const char *words)
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
