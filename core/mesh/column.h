/* column.h - attribute columns: one typed value of 1 to 16 components a row.
 *
 * A column belongs to a domain: vertices, half-edges (a corner's values belong to the half-edge
 * that leaves it inside its face), edges, faces, or the mesh (one row). Values are stored in the
 * machine's byte order, little-endian wherever hedge runs. A column with labels is categorical:
 * its values index the labels (groups, materials of a file).
 *
 * Its rule says what an edit gives to elements it makes:
 *   copy         the parent's value (the face that was split, the edge that was cut)
 *   interpolate  linear between the two ends at a split, the mean at a collapse
 *   default      the column's default
 * A weld takes no mean, whatever the rule: what differs goes to corners (edit/piece/keep.h). */
#ifndef HE_MESH_COLUMN_H
#define HE_MESH_COLUMN_H

#include "mesh/mesh.h"

typedef enum he_type { HE_BOOL, HE_INT32, HE_UINT32, HE_FLOAT, HE_DOUBLE, HE_TYPE_COUNT } he_type;
typedef enum he_rule { HE_COPY, HE_INTERPOLATE, HE_DEFAULT, HE_RULE_COUNT } he_rule;

enum { HE_COLUMN_NAME = 64, HE_COLUMN_COMPONENTS = 16, HE_COLUMN_ROW_BYTES = 128 };

/* The attribute of faces whose labels name materials (material.h). */
#define HE_MATERIAL_ATTRIBUTE "material"

/* Strings of a categorical column, shared by reference count between copies of a mesh. */
typedef struct he_labels he_labels;

struct he_column {
    char name[HE_COLUMN_NAME]; /* UTF-8, ends in NUL */
    he_kind domain;
    he_type type;
    he_rule rule;
    uint32_t components;
    uint32_t row_bytes;                          /* components * size of type */
    unsigned char fallback[HE_COLUMN_ROW_BYTES]; /* the default row */
    he_labels *labels;                           /* NULL unless categorical */
    unsigned char *data;
    size_t rows;     /* stored; every row beyond holds the default */
    size_t capacity; /* rows that fit */
};

const char *he_type_name(he_type type); /* "bool", "int32", "uint32", "float", "double" */
size_t he_type_bytes(he_type type);
const char *he_rule_name(he_rule rule); /* "copy", "interpolate", "default" */

/* A column without rows; its default row is zero. Fails with HE_BAD_VALUE on an empty or too
 * long name, or components outside 1..16. */
HE_NODISCARD he_status he_column_new(const char *name, he_kind domain, he_type type,
                                     uint32_t components, he_rule rule, he_column **out,
                                     he_error *err);
void he_column_free(he_column *column);
/* One of the same kind and labels with `rows` rows that hold the default. */
HE_NODISCARD he_status he_column_like(const he_column *column, size_t rows, he_column **out,
                                      he_error *err);
HE_NODISCARD he_status he_column_copy(const he_column *column, he_column **out, he_error *err);
/* The capacity to grow to so that `rows` fit: half as much again while there are few, an eighth
 * where there are many, since a mesh keeps its slack and large blocks are moved by their page
 * tables. */
size_t he_rows_grown(size_t capacity, size_t rows);
/* Make room for `rows` rows in all. */
HE_NODISCARD he_status he_column_reserve(he_column *column, size_t rows, he_error *err);
/* Append rows that hold the default. */
HE_NODISCARD he_status he_column_extend(he_column *column, size_t rows, he_error *err);
/* The value of any row, stored or not. */
static inline const unsigned char *he_column_value(const he_column *column, size_t row)
{
    return row < column->rows ? column->data + row * column->row_bytes : column->fallback;
}
/* A stored row. */
static inline unsigned char *he_column_row(const he_column *column, size_t row)
{
    return column->data + row * column->row_bytes;
}
size_t he_column_bytes(const he_column *column);
/* Bytes of the rows alone, without spare capacity. */
size_t he_column_rows_bytes(const he_column *column);
bool he_column_same_kind(const he_column *a, const he_column *b); /* all but the rows */
/* Do rows of one mean the same in the other: type, components, labels? */
bool he_column_same_values(const he_column *a, const he_column *b);
/* Is it of the kind that HE_MATERIAL_ATTRIBUTE is: uint32 of one component, with labels? */
bool he_is_material_column(const he_column *column);
/* Is it the attribute "normal", of three floats or doubles? */
bool he_is_normal_column(const he_column *column);
/* Make a row of such a column point the other way: all its signs are turned. */
void he_normal_negate(const he_column *column, unsigned char *row);
/* One of corners under another name that is else of the kind of `column`, with so many rows. */
HE_NODISCARD he_status he_column_for_corners(const he_column *column, const char *name, size_t rows,
                                             he_column **out, he_error *err);
/* NAME for number 1, else NAME_2 and so on, the name cut where that is too long. */
void he_column_number_name(const char *name, unsigned number, char out[HE_COLUMN_NAME]);

he_labels *he_labels_new(void); /* one reference; NULL when memory is out */
he_labels *he_labels_retain(he_labels *labels);
void he_labels_release(he_labels *labels);
size_t he_labels_count(const he_labels *labels);
/* What labels cost that only the asker holds; 0 where others hold them too, and for NULL. */
size_t he_labels_own_bytes(const he_labels *labels);
const char *he_labels_get(const he_labels *labels, size_t i);
/* Returns whether both hold equal strings in one order. NULL equals NULL alone. */
bool he_labels_equal(const he_labels *a, const he_labels *b);
/* The index of a string that is there; false where it is not. */
bool he_labels_find(const he_labels *labels, const char *text, size_t length, uint32_t *out);
/* The index of a string, added when new. Only while nobody else holds a reference. */
HE_NODISCARD he_status he_labels_add(he_labels *labels, const char *text, size_t length,
                                     uint32_t *out, he_error *err);

#endif
