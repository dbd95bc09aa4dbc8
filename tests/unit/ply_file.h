/* ply_file.h - builds a PLY file value by value, in any encoding. Include this header once per
 * program: its functions are static. */
#ifndef TESTS_UNIT_PLY_FILE_H
#define TESTS_UNIT_PLY_FILE_H

#include "unit/format_fixture.h"

#define LITTLE "ply\nformat binary_little_endian 1.0\n"
#define BIG    "ply\nformat binary_big_endian 1.0\n"
#define ASCII  "ply\nformat ascii 1.0\n"
#define XYZ    "property float x\nproperty float y\nproperty float z\n"
#define CORNER "property list uchar int vertex_indices\n"

typedef enum encoding { TEXT, LEAST_FIRST, MOST_FIRST } encoding;

typedef struct file {
    char bytes[8192];
    size_t length;
    encoding encoding;
} file;

static inline void put_text(file *f, const char *text)
{
    size_t length = strlen(text);
    assert_true(f->length + length <= sizeof f->bytes);
    memcpy(f->bytes + f->length, text, length);
    f->length += length;
}

static const struct {
    const char *names[2];
    size_t size;
    bool is_signed, is_float;
    he_type column;
} types[] = {
    {{"char", "int8"}, 1, true, false, HE_INT32},
    {{"uchar", "uint8"}, 1, false, false, HE_UINT32},
    {{"short", "int16"}, 2, true, false, HE_INT32},
    {{"ushort", "uint16"}, 2, false, false, HE_UINT32},
    {{"int", "int32"}, 4, true, false, HE_INT32},
    {{"uint", "uint32"}, 4, false, false, HE_UINT32},
    {{"float", "float32"}, 4, true, true, HE_FLOAT},
    {{"double", "float64"}, 8, true, true, HE_DOUBLE},
};

enum { TYPES = 8, WHOLE_TYPES = 6, UCHAR = 1, INT = 4, UINT = 5, FLOAT = 6, DOUBLE = 7 };

static inline void put_value(file *f, size_t type, double value)
{
    char text[64];
    uint64_t bits = (uint64_t)(int64_t)value;
    float single = (float)value;
    uint32_t half;
    memcpy(&half, &single, sizeof half);
    if (f->encoding == TEXT) {
        snprintf(text, sizeof text, "%.17g ", value);
        put_text(f, text);
        return;
    }
    if (types[type].is_float && types[type].size == 4) {
        bits = half;
    } else if (types[type].is_float) {
        memcpy(&bits, &value, sizeof bits);
    }
    assert_true(f->length + types[type].size <= sizeof f->bytes);
    for (size_t i = 0; i < types[type].size; i++) {
        size_t place = f->encoding == LEAST_FIRST ? i : types[type].size - 1 - i;
        f->bytes[f->length++] = (char)(bits >> (8 * place));
    }
}

static inline void end_row(file *f)
{
    if (f->encoding == TEXT) {
        put_text(f, "\n");
    }
}

static inline void begin(file *f, encoding e, const char *header)
{
    f->length = 0;
    f->encoding = e;
    put_text(f, e == TEXT ? ASCII : e == LEAST_FIRST ? LITTLE : BIG);
    put_text(f, header);
}

static inline he_import read_file(const file *f)
{
    he_import import = {0};
    he_error err = {0};
    if (read_bytes("ply", f->bytes, f->length, &import, &err) != HE_OK) {
        fail_msg("%.200s: %s", f->bytes, err.text);
    }
    return import;
}

static const double square[4][3] = {{0, 0, 1}, {2, 0, 3}, {2, 5, 0}, {0, 5, 7}};

#endif
