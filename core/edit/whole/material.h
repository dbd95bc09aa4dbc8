/* material.h - a material made, changed or deleted, and given to faces or taken from them.
 *
 * Like every edit it is recorded and undone bit for bit: a row of the table that changes is one
 * record, a name that the faces' attribute `material` has no label for yet is a column put in the
 * place of that one. */
#ifndef HE_EDIT_WHOLE_MATERIAL_H
#define HE_EDIT_WHOLE_MATERIAL_H

#include "mesh/mesh.h"

/* What is to be changed; NULL leaves a thing as it is, or as in he_plain_look where the material is
 * new. */
typedef struct he_material_change {
    const char *rename;
    bool replace; /* what is not said is as in he_plain_look, whatever it was */
    const double *base_color;
    bool opaque_too; /* base_color has four numbers: else the opacity stays */
    const double *metallic, *roughness;
    const double *emission;
    const bool *two_sided;
    const uint32_t *faces; /* that get it */
    size_t face_count;
} he_material_change;

/* material_set: V, E and F stay. The material of this name, made where there is none, is changed.
 * With `rename` faces that have it have it under the new name. Faces get it in their attribute
 * `material`, made where there is none: uint32 of one component, with labels of which "" is none.
 *
 * The name "" stands for none: with faces, and nothing else, those have no material afterwards.
 *
 * Refused: HE_BAD_VALUE for a name or number that no material has (mesh/material.h), and for a new
 * name that there is already; HE_LIMIT beyond HE_MATERIALS; HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT,
 * HE_REPEATED_ELEMENT of faces; HE_ATTRIBUTE_CLASH where faces have another kind of attribute
 * `material`. HE_NO_MEMORY. */
HE_NODISCARD he_status he_material_set(he_mesh *m, const char *name,
                                       const he_material_change *change, he_error *err);

/* material_delete: V, E and F stay. The material of this name is no more: its row of the table
 * goes, and its name from the labels of the faces' attribute. Faces that had it have the material
 * `to` instead, or none where that is NULL.
 *
 * Refused: HE_BAD_VALUE where there is no material of this name, or none called `to`, or both are
 * one; HE_ATTRIBUTE_CLASH where faces have another kind of attribute `material`. HE_NO_MEMORY. */
HE_NODISCARD he_status he_material_delete(he_mesh *m, const char *name, const char *to,
                                          he_error *err);

#endif
