#include "unit/ply_file.h"

const ply_type ply_types[TYPES] = {
    {{"char", "int8"}, 1, true, false, HE_INT32},
    {{"uchar", "uint8"}, 1, false, false, HE_UINT32},
    {{"short", "int16"}, 2, true, false, HE_INT32},
    {{"ushort", "uint16"}, 2, false, false, HE_UINT32},
    {{"int", "int32"}, 4, true, false, HE_INT32},
    {{"uint", "uint32"}, 4, false, false, HE_UINT32},
    {{"float", "float32"}, 4, true, true, HE_FLOAT},
    {{"double", "float64"}, 8, true, true, HE_DOUBLE},
};

const double ply_square[4][3] = {{0, 0, 1}, {2, 0, 3}, {2, 5, 0}, {0, 5, 7}};

void ply_put_text(ply_file *f, const char *text)
{
    size_t length = strlen(text);
    assert_true(f->length + length <= sizeof f->bytes);
    memcpy(f->bytes + f->length, text, length);
    f->length += length;
}

void ply_put_value(ply_file *f, size_t type, double value)
{
    char text[64];
    uint64_t bits = (uint64_t)(int64_t)value;
    float single = (float)value;
    uint32_t half;
    memcpy(&half, &single, sizeof half);
    if (f->encoding == TEXT) {
        snprintf(text, sizeof text, "%.17g ", value);
        ply_put_text(f, text);
        return;
    }
    if (ply_types[type].is_float && ply_types[type].size == 4) {
        bits = half;
    } else if (ply_types[type].is_float) {
        memcpy(&bits, &value, sizeof bits);
    }
    assert_true(f->length + ply_types[type].size <= sizeof f->bytes);
    for (size_t i = 0; i < ply_types[type].size; i++) {
        size_t place = f->encoding == LEAST_FIRST ? i : ply_types[type].size - 1 - i;
        f->bytes[f->length++] = (char)(bits >> (8 * place));
    }
}

void ply_end_row(ply_file *f)
{
    if (f->encoding == TEXT) {
        ply_put_text(f, "\n");
    }
}

void ply_begin(ply_file *f, ply_encoding e, const char *header)
{
    f->length = 0;
    f->encoding = e;
    ply_put_text(f, e == TEXT ? ASCII : e == LEAST_FIRST ? LITTLE : BIG);
    ply_put_text(f, header);
}

he_import ply_read(const ply_file *f)
{
    he_import import = {0};
    he_error err = {0};
    if (read_bytes("ply", f->bytes, f->length, &import, &err) != HE_OK) {
        fail_msg("%.200s: %s", f->bytes, err.text);
    }
    return import;
}
