/* append.h - appends all elements, attributes and materials of another mesh to a mesh. */
#ifndef HE_EDIT_WHOLE_APPEND_H
#define HE_EDIT_WHOLE_APPEND_H

#include "mesh/mesh.h"

/* The new ids of the elements that were appended, in the order of their ids in the other mesh; {0}
 * at first. The new ids of each kind are consecutive, and half-edge 2e of an edge becomes half-edge
 * 2e' of the new edge e'. */
typedef struct he_appended {
    he_ids vertices, edges, faces;
} he_appended;

/* append adds the elements, attributes and materials of the mesh `other`, which is not changed, to
 * this mesh `m`: V, E and F grow by the numbers of `other`. No old element of this mesh is changed
 * or merged. New elements have no parents.
 *
 *        o---o                       o---o
 *        |   |    +    o       --->  |   |    o
 *        o---o        / \            o---o   / \
 *                    o---o                  o---o
 *
 * ATTRIBUTES are matched by domain and name. If both meshes have an attribute, its type and number
 * of components must be equal, and either both have labels or neither has. Values are copied, and
 * labels that this mesh lacks are added after its own. The default and the rule that the attribute
 * has in this mesh stay. New elements have the default of an attribute that only this mesh has. An
 * attribute that only the other mesh has is added; old elements have its default. An attribute
 * whose domain is the mesh itself is added only if this mesh has none of that name.
 *
 * MATERIALS. A material of the other mesh is added unless this mesh has an equal material of that
 * name. If this mesh has a different material of that name, the added material is called NAME_2,
 * NAME_3 and so on, and the new faces use the new name.
 *
 * `other` must not be `m`. `out` may be NULL; otherwise he_appended_clear frees it.
 * Returns HE_LIMIT if there would be more than HE_MATERIALS materials.
 * Returns HE_ATTRIBUTE_CLASH if attributes of equal domain and name do not match as stated above.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_append(he_mesh *m, const he_mesh *other, he_appended *out, he_error *err);
void he_appended_clear(he_appended *appended);

#endif
