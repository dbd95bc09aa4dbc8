/* append.h - appends the content of another mesh to this one. */
#ifndef HE_EDIT_WHOLE_APPEND_H
#define HE_EDIT_WHOLE_APPEND_H

#include "mesh/mesh.h"

/* The new ids of the elements that were appended, in the order of their ids in the other mesh; {0}
 * at first. The ids of each kind are consecutive, and half-edge 2e of an edge becomes the first
 * half-edge of the new edge. */
typedef struct he_appended {
    he_ids vertices, edges, faces;
} he_appended;

/* append: V, E and F grow by those of `other`, which stays as it is. No old element is changed or
 * merged; parents are not recorded, since they are of another mesh.
 *
 *        o---o                       o---o
 *        |   |    +    o       --->  |   |    o
 *        o---o        / \            o---o   / \
 *                    o---o                  o---o
 *
 * ATTRIBUTES are matched by domain and name. If both meshes have one, type and number of components
 * must be equal, and either both have labels or neither: values are copied, and labels that this
 * mesh lacks are added after its own. Its default and rule stay. New elements have the default of
 * an attribute that only this mesh has. An attribute that only the other mesh has is added; old
 * elements have its default. Attributes of the mesh itself are added only if this mesh has none of
 * that name.
 *
 * MATERIALS. Rows of the other mesh's table that this mesh has too are shared; others are added, as
 * NAME_2 and so on if a different row of this mesh has the name, and the new faces use that name.
 *
 * `other` must not be `m`. `out` may be NULL; otherwise he_appended_clear frees it.
 * Returns HE_LIMIT if there would be more than HE_MATERIALS materials.
 * Returns HE_ATTRIBUTE_CLASH if attributes of one domain and name do not match as above.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_append(he_mesh *m, const he_mesh *other, he_appended *out, he_error *err);
void he_appended_clear(he_appended *appended);

#endif
