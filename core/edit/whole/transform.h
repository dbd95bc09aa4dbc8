/* transform.h - an affine map applied to positions. */
#ifndef HE_EDIT_WHOLE_TRANSFORM_H
#define HE_EDIT_WHOLE_TRANSFORM_H

#include "mesh/mesh.h"

/* transform: no element comes or goes. Each listed vertex p goes to the first three rows of
 * matrix * (p, 1); `matrix` is row-major and its last row must be 0 0 0 1. A NULL list means every
 * live vertex. Attributes `normal` turn along (normals.h), others are left alone, and a mirroring
 * matrix does not reverse faces.
 *
 *     | m0  m1  m2  m3  |   | x |
 *     | m4  m5  m6  m7  | * | y |
 *     | m8  m9  m10 m11 |   | z |
 *     | 0   0   0   1   |   | 1 |
 *
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT;
 * HE_NOT_FINITE for a result that is not finite; HE_LOCKED_ELEMENT for a locked vertex, even one
 * that would come to where it is; HE_BAD_VALUE for another last row. HE_NO_MEMORY. */
HE_NODISCARD he_status he_transform(he_mesh *m, const double matrix[16], const uint32_t *vertices,
                                    size_t count, he_error *err);

#endif
