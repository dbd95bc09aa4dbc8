/* column.h - attribute columns. A column has one value for each element of its domain; a value has
 * 1 to 16 components of one type. A row of the column is the value of one element.
 *
 * The domain of a column is vertices, half-edges (the values of a corner belong to the half-edge
 * that leaves the corner inside its face), edges, faces, or the mesh (one row). Values are stored
 * in the machine's byte order, which is little-endian on all machines that hedge supports. A column
 * with labels (strings) is categorical: its values are indices of labels, such as the names of
 * groups or materials of a file.
 *
 * The rule of a column decides the values of elements that an edit makes. With the rule `copy`, a
 * new element gets the value of its parent (the face that was split, the edge that was cut). With
 * `interpolate`, the value is interpolated linearly between the two ends at a split, and is the
 * mean at a collapse. With `default`, a new element gets the column's default value. When vertices
 * are welded, the mean is never taken, whatever the rule: values that differ become values of
 * corners (edit/piece/keep.h). */
#ifndef HE_MESH_COLUMN_H
#define HE_MESH_COLUMN_H

#include "mesh/mesh.h"

typedef enum he_type { HE_BOOL, HE_INT32, HE_UINT32, HE_FLOAT, HE_DOUBLE, HE_TYPE_COUNT } he_type;
typedef enum he_rule { HE_COPY, HE_INTERPOLATE, HE_DEFAULT, HE_RULE_COUNT } he_rule;

enum { HE_COLUMN_NAME = 64, HE_COLUMN_COMPONENTS = 16, HE_COLUMN_ROW_BYTES = 128 };

/* The name of the face attribute whose labels are names of materials (material.h). */
#define HE_MATERIAL_ATTRIBUTE "material"

/* The strings of a categorical column, shared by reference count between copies of a mesh. */
typedef struct he_labels he_labels;

/* The schema of an attribute: what its values mean, without the values. */
typedef struct he_column_schema {
    const char *name; /* UTF-8 of 1 to HE_COLUMN_NAME - 1 bytes, ended by NUL */
    he_kind domain;
    he_type type;
    uint32_t components; /* 1 to HE_COLUMN_COMPONENTS */
    he_rule rule;
} he_column_schema;

/* Describes the positions of the vertices as a column named "position", of three doubles. */
extern const he_column_schema he_position_schema;

struct he_column {
    char name[HE_COLUMN_NAME]; /* UTF-8, ends in NUL */
    he_kind domain;
    he_type type;
    he_rule rule;
    uint32_t components;
    /* bytes of one value: components * size of the type */
    uint32_t row_bytes;
    unsigned char fallback[HE_COLUMN_ROW_BYTES]; /* the default value of an element */
    /* The strings (labels) of which each value is an index; NULL if the column is
     * not categorical. */
    he_labels *labels;
    unsigned char *data;
    /* number of rows in memory; elements without a row in memory have the default value */
    size_t rows;
    size_t capacity; /* number of rows that fit into the allocated memory */
};

const char *he_type_name(he_type type); /* "bool", "int32", "uint32", "float", "double" */
size_t he_type_bytes(he_type type);
const char *he_rule_name(he_rule rule); /* "copy", "interpolate", "default" */

/* Makes a column without values. Its default value is zero.
 * Returns HE_BAD_VALUE if the name is empty or too long, or `components` is outside 1..16. */
HE_NODISCARD he_status he_column_new(const he_column_schema *schema, he_column **out,
                                     he_error *err);
void he_column_free(he_column *column);
/* Makes a column with the name, domain, type, rule, default and labels of `column`, and with `rows`
 * rows of the default value. */
HE_NODISCARD he_status he_column_like(const he_column *column, size_t rows, he_column **out,
                                      he_error *err);
HE_NODISCARD he_status he_column_copy(const he_column *column, he_column **out, he_error *err);
/* Returns the number of rows for which an array should be allocated when it must grow so that
 * `rows` fit. Small arrays grow by half, because that needs few allocations; large ones grow by an
 * eighth, because a mesh keeps its spare memory, and the system moves large blocks by changing page
 * tables instead of copying. */
size_t he_rows_grown(size_t capacity, size_t rows);
/* Allocates memory for `rows` values in all. */
HE_NODISCARD he_status he_column_reserve(he_column *column, size_t rows, he_error *err);
/* Appends `rows` default values to the column. */
HE_NODISCARD he_status he_column_extend(he_column *column, size_t rows, he_error *err);
/* Returns the value of a row, or the default value if the row is not in memory. */
static inline const unsigned char *he_column_value(const he_column *column, size_t row)
{
    return row < column->rows ? column->data + row * column->row_bytes : column->fallback;
}
/* Returns the value in a row; the row must be in memory. */
static inline unsigned char *he_column_row(const he_column *column, size_t row)
{
    return column->data + row * column->row_bytes;
}
/* Returns one component of the value of a row. */
double he_column_number(const he_column *column, size_t row, uint32_t component);
/* Writes a number, which must not be NaN, as one component of `value`, which has the type of the
 * column: for integers and booleans it is rounded to the nearest value of their range. */
void he_column_put_number(const he_column *column, uint32_t component, double number,
                          unsigned char *value);
/* Writes the weighted sum of the values of n rows to `out`, or their mean if `weights` is NULL. The
 * result has the type of the column: integers and booleans are rounded to the nearest value, and a
 * sum that rounding errors have pushed out of the type's range is clamped. */
void he_column_blend(const he_column *column, const uint32_t *rows, const double *weights, size_t n,
                     unsigned char *out);
size_t he_column_bytes(const he_column *column);
/* Returns the size in bytes of a column with all its rows, without labels and spare memory. */
size_t he_column_rows_bytes(const he_column *column);
bool he_column_same_kind(
    const he_column *a,
    const he_column *b); /* compares name, domain, type, components, rule, default and labels */
/* Returns true if a value of one column can be copied byte for byte to the other column: the
 * columns have equal types and components, and share their labels. */
bool he_column_same_values(const he_column *a, const he_column *b);
/* Returns true if the column can be the material attribute: uint32, one component, with labels. */
bool he_is_material_column(const he_column *column);
/* Returns true if the column is the attribute "normal", of three floats or doubles. */
bool he_is_normal_column(const he_column *column);
/* Reverses the direction of a normal: `row` is a value of the attribute "normal". */
void he_normal_negate(const he_column *column, unsigned char *row);
/* Makes a column of half-edges called `name`, with `rows` rows of the default value. Its type,
 * components, rule, default and labels are those of `column`. */
HE_NODISCARD he_status he_column_for_corners(const he_column *column, const char *name, size_t rows,
                                             he_column **out, he_error *err);
/* Makes a numbered name: writes NAME for number 1, else NAME_2 and so on; a name that is too long
 * is cut. */
void he_column_number_name(const char *name, unsigned number, char out[HE_COLUMN_NAME]);

/* Returns an empty list of labels with one reference; NULL if memory is out. */
he_labels *he_labels_new(void);
he_labels *he_labels_retain(he_labels *labels);
void he_labels_release(he_labels *labels);
size_t he_labels_count(const he_labels *labels);
/* Returns how many bytes would be freed if the caller released its reference to the labels: 0 while
 * other references to the labels exist, and 0 for NULL. */
size_t he_labels_own_bytes(const he_labels *labels);
const char *he_labels_get(const he_labels *labels, size_t i);
/* Returns true if two lists of labels have equal strings in the same order. NULL equals only
 * NULL. */
bool he_labels_equal(const he_labels *a, const he_labels *b);
/* Finds the index of a string in a list of labels. Returns false if the list does not contain the
 * string. */
bool he_labels_find(const he_labels *labels, const char *text, size_t length, uint32_t *out);
/* Finds the index of a string in a list of labels, and adds the string if it is new. The caller
 * must hold the only reference to the list. */
HE_NODISCARD he_status he_labels_add(he_labels *labels, const char *text, size_t length,
                                     uint32_t *out, he_error *err);

#endif
