/* transform.h - applies an affine map to positions. */
#ifndef HE_EDIT_WHOLE_TRANSFORM_H
#define HE_EDIT_WHOLE_TRANSFORM_H

#include "mesh/mesh.h"

/* transform maps vertices affinely; no element is made or deleted. The new position of a listed
 * vertex p is given by the first three numbers of matrix * (p, 1); `matrix` is row-major and its
 * last row must be 0 0 0 1. If `vertices` is NULL, all live vertices are mapped. Attributes called
 * `normal` are transformed as well (normals.h); no other attribute is. Faces are not reversed, even
 * if the matrix is a reflection.
 *
 *     | m0  m1  m2  m3  |   | x |
 *     | m4  m5  m6  m7  | * | y |
 *     | m8  m9  m10 m11 |   | z |
 *     | 0   0   0   1   |   | 1 |
 *
 * If the edit is refused, nothing changes.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_NOT_FINITE if a result is not finite.
 * Returns HE_LOCKED_ELEMENT if a vertex is locked, even if its position would not change.
 * Returns HE_BAD_VALUE if the last row of the matrix is not 0 0 0 1.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_transform(he_mesh *m, const double matrix[16], const uint32_t *vertices,
                                    size_t count, he_error *err);

#endif
