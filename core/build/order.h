/* order.h - the faces of a soup in another order. */
#ifndef HE_BUILD_ORDER_H
#define HE_BUILD_ORDER_H

#include "build/build.h"

/* Face i becomes face number[i], with its corners and attributes; `number` has each number once. No
 * face is open. HE_NO_MEMORY: then the soup is good only to be cleared. */
HE_NODISCARD he_status he_soup_order_faces(he_soup *soup, const uint32_t *number, he_error *err);

#endif
