/* list.h - lists of ids that come from callers: are they live, is none named twice? */
#ifndef HE_EDIT_PIECE_LIST_H
#define HE_EDIT_PIECE_LIST_H

#include "mesh/mesh.h"

/* The index of the first id that an earlier place of the list holds too; `count` when all differ.
 * Fails only with HE_NO_MEMORY. Linear in the list, wherever in a mesh its ids are. */
HE_NODISCARD he_status he_list_repeat(const uint32_t *ids, size_t count, size_t *at, he_error *err);

/* HE_OK, or what is wrong with the first bad id: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, and
 * `repeated` for one named twice. HE_NO_MEMORY. */
HE_NODISCARD he_status he_list_require(const he_mesh *m, he_kind kind, const uint32_t *ids,
                                       size_t count, he_status repeated, he_error *err);

#endif
