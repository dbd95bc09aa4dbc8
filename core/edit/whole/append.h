/* append.h - the content of another mesh brought into this one. */
#ifndef HE_EDIT_WHOLE_APPEND_H
#define HE_EDIT_WHOLE_APPEND_H

#include "mesh/mesh.h"

/* The new ids of the other mesh's live elements, in the order of their old ones; {0} at first.
 * Each kind's are consecutive, and half-edge 2e of an edge stays the first of its new one. */
typedef struct he_appended {
    he_ids vertices, edges, faces;
} he_appended;

/* append: V, E and F grow by those of `other`, which stays as it is. Nothing that was there is
 * touched, nothing is merged; parents are not noted, since they are of another mesh.
 *
 *        o---o                       o---o
 *        |   |    +    o       --->  |   |    o
 *        o---o        / \            o---o   / \
 *                    o---o                  o---o
 *
 * ATTRIBUTES are matched by domain and name. Where both meshes have one, its type and number of
 * components must be the same, and either both have labels or neither: values are carried over, and
 * labels that this mesh lacks come after its own. Its default and rule stay. One that only this
 * mesh has is at its default on what is new. One that only the other mesh has is added, and at its
 * default on what was there. Values of the mesh's own domain are taken only where this mesh has
 * none of that name.
 *
 * MATERIALS. Rows of the other mesh's table that this mesh has are those; others are added, under
 * NAME_2 and so on where a row here looks different and has the name, and faces name them so.
 *
 * Refused: HE_LIMIT where there would be more than HE_MATERIALS, HE_ATTRIBUTE_CLASH where
 * attributes of one domain and name differ as above. HE_NO_MEMORY, HE_IDS_EXHAUSTED, HE_CANCELLED.
 * `other` is not `m`. `out` may be NULL, else he_appended_clear frees it. */
HE_NODISCARD he_status he_append(he_mesh *m, const he_mesh *other, he_appended *out, he_error *err);
void he_appended_clear(he_appended *appended);

#endif
