/* attribute.h - attribute columns as a whole, and values of elements, as edits.
 *
 * Like every edit these are recorded and undone bit for bit: a column that comes or goes is one
 * record that keeps the column, a value that changes is one record for each of its words. Values
 * are rows of the column: `components` numbers of its type, little-endian.
 *
 * All may fail with HE_NO_MEMORY, and leave the mesh as it was. */
#ifndef HE_EDIT_WHOLE_ATTRIBUTE_H
#define HE_EDIT_WHOLE_ATTRIBUTE_H

#include "mesh/column.h"

/* Add a column, in the place of one of the same domain and name where there is one. `takes` belongs
 * to the mesh from success on. Rows it lacks get its default; those of dead elements must hold it,
 * see he_attribute_settle. */
HE_NODISCARD he_status he_attribute_put(he_mesh *m, he_column *takes, he_error *err);
/* Take a column of the mesh away. */
HE_NODISCARD he_status he_attribute_drop(he_mesh *m, const he_column *column, he_error *err);

/* Write values of elements: `count` rows at `values`, or with `same` one row for all of them. NULL
 * ids stand for every live element, in the order of ids, and `count` is their number. A column of
 * the mesh's own domain has the one id 0.
 *
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT. */
HE_NODISCARD he_status he_attribute_write(he_mesh *m, const he_column *column, const uint32_t *ids,
                                          size_t count, const void *values, bool same,
                                          he_error *err);

/* Give a column that is not the mesh's yet one row for each id of its domain, live or dead:
 * `count` rows at `values` go to the live elements in the order of ids, all others get the default.
 * Refused: HE_BAD_VALUE when `count` is not the number of live elements. */
HE_NODISCARD he_status he_attribute_fill(const he_mesh *m, he_column *column, const void *values,
                                         size_t count, he_error *err);
/* The rows of dead elements of a column that is not the mesh's yet become the default. */
void he_attribute_settle(const he_mesh *m, he_column *column);

/* Are `count` rows values of the column's type? HE_BAD_VALUE for a bool that is neither 0 nor 1,
 * and for an index beyond the labels; HE_NOT_FINITE. `*at` is the number that is wrong, counted
 * over all components. */
HE_NODISCARD he_status he_attribute_check(const he_column *column, const void *values, size_t count,
                                          size_t *at, he_error *err);

#endif
