/* attribute.h - edits of attribute columns, and of their values.
 *
 * Like every edit these are recorded and undone bit for bit: adding or dropping a column is one
 * record that keeps the column, changing a value is one record for each of its words. Values are
 * rows of the column: `components` numbers of its type, little-endian.
 *
 * Every function may return HE_NO_MEMORY; the mesh is then as it was. */
#ifndef HE_EDIT_WHOLE_ATTRIBUTE_H
#define HE_EDIT_WHOLE_ATTRIBUTE_H

#include "mesh/column.h"

/* Adds a column, replacing one of the same domain and name. On success the mesh owns `takes`. Rows
 * it lacks get its default; those of dead elements must have it, see he_attribute_settle. */
HE_NODISCARD he_status he_attribute_put(he_mesh *m, he_column *takes, he_error *err);
/* Removes a column from the mesh. */
HE_NODISCARD he_status he_attribute_drop(he_mesh *m, const he_column *column, he_error *err);

/* Writes values of elements: `count` rows at `values`, or with `same` one row for all of them. NULL
 * ids mean every live element, in the order of ids, and `count` is their number. A column of the
 * mesh's own domain has the one id 0.
 *
 * All or nothing: a refusal changes nothing.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice. */
HE_NODISCARD he_status he_attribute_write(he_mesh *m, const he_column *column, const uint32_t *ids,
                                          size_t count, const void *values, bool same,
                                          he_error *err);

/* Fills a column that is not the mesh's yet: `count` rows at `values` go to the live elements in
 * the order of ids, all other issued rows get the default.
 * Returns HE_BAD_VALUE if `count` is not the number of live elements. */
HE_NODISCARD he_status he_attribute_fill(const he_mesh *m, he_column *column, const void *values,
                                         size_t count, he_error *err);
/* Sets the rows of dead elements to the default, in a column that is not the mesh's yet. */
void he_attribute_settle(const he_mesh *m, he_column *column);

/* Checks that `count` rows are values of the column's type. `*at` is the index of the bad number,
 * counted over all components.
 * Returns HE_BAD_VALUE if a bool is neither 0 nor 1, or an index is beyond the labels.
 * Returns HE_NOT_FINITE if a number is not finite. */
HE_NODISCARD he_status he_attribute_check(const he_column *column, const void *values, size_t count,
                                          size_t *at, he_error *err);

#endif
