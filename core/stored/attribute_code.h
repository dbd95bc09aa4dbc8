/* attribute_code.h - the stored form (stored.h) of an attribute's head (its type, name and default)
 * and labels, and of a material. Only core/stored uses it. */
#ifndef HE_STORED_ATTRIBUTE_CODE_H
#define HE_STORED_ATTRIBUTE_CODE_H

#include "mesh/column.h"
#include "mesh/material.h"
#include "stored/bytes.h"

/* Bytes of a stored material before its name: HE_MATERIAL_FIXED for nine numbers and a flag, and up
 * to HE_MATERIAL_HEAD with the length of the name. */
enum { HE_MATERIAL_FIXED = 9 * 8 + 1, HE_MATERIAL_HEAD = HE_MATERIAL_FIXED + 2 };
enum { HE_HEAD_ROOM = 5 + HE_COLUMN_NAME + HE_COLUMN_ROW_BYTES };

size_t he_head_bytes(const he_column *column);
unsigned char *he_head_put(unsigned char *to, const he_column *column);
size_t he_labels_bytes(const he_labels *labels); /* NULL means no labels */
unsigned char *he_labels_put(unsigned char *to, const he_labels *labels);
size_t he_varint_bytes(uint64_t value);
size_t he_material_code_bytes(const he_material *material);
/* Writes all of a material except the characters of its name, which the caller writes next. */
unsigned char *he_material_put_head(unsigned char *to, const he_material *material);

/* Reads the head of an attribute and makes its column, without rows.
 * Returns HE_CORRUPT if the bytes are not valid.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_head_take(he_cursor *c, he_column **out, he_error *err);
HE_NODISCARD he_status he_labels_take(he_cursor *c, he_labels **out, he_error *err);
HE_NODISCARD he_status he_material_take(he_cursor *c, he_material **out, he_error *err);

#endif
