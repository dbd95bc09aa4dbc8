/* gltf_private.h - data of a primitive that glTF cannot represent, in the `extras` of files written
 * by hedge.
 *
 *     "extras": {"hedge": {
 *         "copies": 2,
 *         "polygons": {"degrees": 3, "corners": 4},
 *         "columns": [{"domain": "face", "name": "material", "type": "uint32", "components": 1,
 *                      "rule": "copy", "accessor": 5, "labels": ["", "steel"]}, ...]}}
 *
 * Numbers such as 3 are indices of accessors of UNSIGNED_INT SCALAR.
 *
 * The last vertices of the primitive may be copies of other vertices, made because corners at one
 * vertex have different values (io/splits.h). For each copy the accessor `copies` has the vertex
 * that was copied. The mesh does not get the copies, and no index in these extras refers to them.
 *
 * `degrees` has the degree of each polygon, `corners` the vertices of their corners. The triangles
 * for other programs are those into which the polygons were cut, in the order of the polygons.
 *
 * A column's accessor has the values of an attribute as they are in memory, little-endian (but a
 * bool takes a word): one for each vertex, for each face, or, with the domain "halfedge", for each
 * corner in the order of `corners`.
 *
 * All extras are checked, because a program that changed the file may have kept them. Copies at
 * other positions than their vertices, polygons that do not match the triangles and columns of a
 * wrong number of rows are ignored with a warning, and so are all extras if the node transforms the
 * mesh. */
#ifndef HE_FORMAT_GLTF_GLTF_PRIVATE_H
#define HE_FORMAT_GLTF_GLTF_PRIVATE_H

#include "format/gltf/gltf_attribute.h"

bool he_gltf_has_private(const he_gltf *asset, uint32_t primitive);
/* Finds in the extras of a primitive which of its vertices are copies. Must be called before the
 * vertices are added. p->private says whether the extras are valid as far as they were read. Fails
 * only for lack of memory, a limit or cancellation. */
HE_NODISCARD he_status he_gltf_open_private(he_gltf_surface *surface, he_gltf_primitive *p,
                                            he_error *err);
/* Adds the attributes and the polygons from the extras, in place of the triangles. Must be called
 * after the vertices are added, and only if p->private is set; p->exact and p->polygons say what
 * was added. Returns the errors of he_gltf_open_private. */
HE_NODISCARD he_status he_gltf_read_private(he_gltf_surface *surface, he_gltf_primitive *p,
                                            he_error *err);

#endif
