/* list.h - checks lists of ids from callers: live elements, none twice. */
#ifndef HE_EDIT_PIECE_LIST_H
#define HE_EDIT_PIECE_LIST_H

#include "mesh/mesh.h"

/* Finds the index of the first id that is in the list before; `count` if all differ. Linear in the
 * list, whatever its ids are.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_list_repeat(const uint32_t *ids, size_t count, size_t *at, he_error *err);

/* Checks a list; an error is about its first bad id.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns the error `repeated` if an element is listed twice.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_list_require(const he_mesh *m, he_kind kind, const uint32_t *ids,
                                       size_t count, he_status repeated, he_error *err);

#endif
