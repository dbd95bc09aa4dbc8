/* material.h - makes, changes and deletes materials, and assigns them to faces.
 *
 * These edits are recorded in the delta and can be undone bit for bit: each changed entry of the
 * table of materials makes one record. If the face attribute `material` has no label for a name
 * yet, its column is replaced by one that has the label. */
#ifndef HE_EDIT_WHOLE_MATERIAL_H
#define HE_EDIT_WHOLE_MATERIAL_H

#include "mesh/mesh.h"

/* The changes to a material. A NULL member leaves that value as it is; in a new material it means
 * the value of he_plain_look. */
typedef struct he_material_change {
    const char *rename;
    /* true: members that are NULL set the values of he_plain_look, as in a new material */
    bool replace;
    const double *base_color;
    /* True if `base_color` has four numbers, of which the fourth is the opacity; false if it has
     * three and the opacity stays as it is. */
    bool opaque_too;
    const double *metallic, *roughness;
    const double *emission;
    const bool *two_sided;
    const uint32_t *faces; /* faces that get the material */
    size_t face_count;
} he_material_change;

/* material_set: V, E and F stay. Changes the material called `name`, or makes it. If `rename` is
 * given, the faces that have the material keep it under the new name. The listed faces get the
 * material in their attribute `material`. If that attribute does not exist, it is made: uint32, one
 * component, with labels, of which "" means no material.
 *
 * If `name` is "", the listed faces have no material afterwards; no other change may be given then.
 *
 * Returns HE_BAD_VALUE if a name or number is not allowed (mesh/material.h), or the new name exists
 * already.
 * Returns HE_LIMIT if there would be more than HE_MATERIALS.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT or HE_REPEATED_ELEMENT if a face is not live or
 * is listed twice.
 * Returns HE_ATTRIBUTE_CLASH if faces have an attribute `material` of another type.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_material_set(he_mesh *m, const char *name,
                                       const he_material_change *change, he_error *err);

/* material_delete: V, E and F stay. Deletes the material called `name` from the table of materials,
 * and its name from the labels of the face attribute `material`. Faces that had the material get
 * the material `to`, or none if `to` is NULL.
 *
 * Returns HE_BAD_VALUE if there is no material of this name, or none called `to`, or if both names
 * are equal.
 * Returns HE_ATTRIBUTE_CLASH if faces have an attribute `material` of another type.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_material_delete(he_mesh *m, const char *name, const char *to,
                                          he_error *err);

#endif
