/* order.h - permutes the faces of a soup. */
#ifndef HE_BUILD_ORDER_H
#define HE_BUILD_ORDER_H

#include "build/build.h"

/* Permutes the faces of a soup: face i becomes face number[i], with its corners and attributes;
 * `number` must be a permutation. All corners of the faces must have been added.
 * Returns HE_NO_MEMORY if memory is out; the caller can then only clear the soup. */
HE_NODISCARD he_status he_soup_order_faces(he_soup *soup, const uint32_t *number, he_error *err);

#endif
