/* list.h - checks lists of element ids that come from clients: each id must be live and listed only
 * once. */
#ifndef HE_EDIT_PIECE_LIST_H
#define HE_EDIT_PIECE_LIST_H

#include "mesh/mesh.h"

/* Finds the index of the first id that also occurs earlier in the list; *at is `count` if all ids
 * differ. Takes time linear in the length of the list.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_list_repeat(const uint32_t *ids, size_t count, size_t *at, he_error *err);

/* Checks that all elements of a list are live and listed once; an error names the first bad id.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns the status that the caller passes as `repeated` if an element is listed twice.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_list_require(const he_mesh *m, he_kind kind, const uint32_t *ids,
                                       size_t count, he_status repeated, he_error *err);

#endif
