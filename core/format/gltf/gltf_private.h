/* gltf_private.h - data of a primitive that glTF cannot represent, in the `extras` of files written
 * by hedge.
 *
 *     "extras": {"hedge": {
 *         "copies": 2,
 *         "polygons": {"degrees": 3, "corners": 4},
 *         "columns": [{"domain": "face", "name": "material", "type": "uint32", "components": 1,
 *                      "rule": "copy", "accessor": 5, "labels": ["", "steel"]}, ...]}}
 *
 * Numbers such as 3 name accessors of UNSIGNED_INT SCALAR. `copies` names, for each of the last
 * vertices, the one that it is a copy of, made because corners have different values (io/splits.h);
 * the mesh does not have these copies, and no index here names them. `degrees` has one number a
 * polygon, in their order; `corners` their vertices. The triangles for other programs are those of
 * the polygons, in their order. A column's accessor has the words of its rows as they are in memory
 * (a bool is a word), little-endian: of vertices, of faces, or of halfedges: the corners in the
 * order of `corners`.
 *
 * All of it is checked, because a program that changed the file may have kept the extras. Copies at
 * other positions than their vertices, polygons that do not match the triangles and columns of a
 * wrong number of rows are ignored with a note, and so are all extras if the node transforms the
 * mesh. */
#ifndef HE_FORMAT_GLTF_GLTF_PRIVATE_H
#define HE_FORMAT_GLTF_GLTF_PRIVATE_H

#include "format/gltf/gltf_attribute.h"

bool he_gltf_has_private(const he_gltf *asset, uint32_t primitive);
/* Finds which vertices of a primitive are copies, from its extras. Must be called before the
 * vertices are added. p->private says whether the extras are valid so far. Fails only for lack of
 * memory, a limit or cancellation. */
HE_NODISCARD he_status he_gltf_open_private(he_gltf_surface *surface, he_gltf_primitive *p,
                                            he_error *err);
/* Adds the attributes and the polygons from the extras, in place of the triangles. Must be called
 * after the vertices are added, and only if p->private is set; p->exact and p->polygons say what
 * was added. Returns the errors of he_gltf_open_private. */
HE_NODISCARD he_status he_gltf_read_private(he_gltf_surface *surface, he_gltf_primitive *p,
                                            he_error *err);

#endif
