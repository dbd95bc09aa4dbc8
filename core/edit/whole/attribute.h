/* attribute.h - edits of attribute columns, and of their values.
 *
 * Like all edits, these are recorded in the delta and can be undone bit for bit. Adding or dropping
 * a column makes one record, which keeps the column; changing a value makes one record for each of
 * its 32-bit words. A value is a row of the column: as many little-endian numbers of the column's
 * type as it has components.
 *
 * Every function may return HE_NO_MEMORY; the mesh is then as it was. */
#ifndef HE_EDIT_WHOLE_ATTRIBUTE_H
#define HE_EDIT_WHOLE_ATTRIBUTE_H

#include "mesh/column.h"

/* Adds the column `takes` to the mesh; it replaces a column with its domain and name. On success
 * the mesh owns `takes`. If the column has fewer rows than the mesh has elements, the missing rows
 * get its default. Rows of deleted elements must hold the default already: see
 * he_attribute_settle. */
HE_NODISCARD he_status he_attribute_put(he_mesh *m, he_column *takes, he_error *err);
/* Removes an attribute column from the mesh. */
HE_NODISCARD he_status he_attribute_drop(he_mesh *m, const he_column *column, he_error *err);

/* Writes the values of `count` elements: `values` has a row for each element, or, with `same`, one
 * row for all of them. If `ids` is NULL, the elements are all live ones in the order of ids, and
 * `count` must be their number. A column whose domain is the mesh itself has one row, with id 0.
 *
 * If the edit is refused, nothing changes.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice. */
HE_NODISCARD he_status he_attribute_write(he_mesh *m, const he_column *column, const uint32_t *ids,
                                          size_t count, const void *values, bool same,
                                          he_error *err);

/* Fills a column that is not part of the mesh yet: the `count` rows at `values` go to the live
 * elements in the order of ids, and all other issued rows get the default.
 * Returns HE_BAD_VALUE if `count` is not the number of live elements. */
HE_NODISCARD he_status he_attribute_fill(const he_mesh *m, he_column *column, const void *values,
                                         size_t count, he_error *err);
/* Sets the rows of deleted elements to the default, in a column that is not part of the mesh
 * yet. */
void he_attribute_settle(const he_mesh *m, he_column *column);

/* Checks that `count` rows hold allowed values of the column's type. On failure *at is the index of
 * the first bad number, counted over all rows and components.
 * Returns HE_BAD_VALUE if a bool is neither 0 nor 1, or if an index into the column's labels is too
 * large.
 * Returns HE_NOT_FINITE if a number is not finite. */
HE_NODISCARD he_status he_attribute_check(const he_column *column, const void *values, size_t count,
                                          size_t *at, he_error *err);

#endif
