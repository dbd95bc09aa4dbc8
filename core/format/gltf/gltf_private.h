/* gltf_private.h - what a primitive carries beyond glTF, in the files that were written here.
 *
 *     "extras": {"hedge": {
 *         "copies": 2,
 *         "polygons": {"degrees": 3, "corners": 4},
 *         "columns": [{"domain": "face", "name": "material", "type": "uint32", "components": 1,
 *                      "rule": "copy", "accessor": 5, "labels": ["", "steel"]}, ...]}}
 *
 * Numbers such as 3 name accessors of UNSIGNED_INT SCALAR. `copies` has for each of the last
 * vertices the one that it is a copy of, made since corners say different things (io/splits.h): so
 * many vertices less has the mesh, and no index here names them. `degrees` has one number a
 * polygon, in their order; `corners` their vertices. The triangles that other readers see are those
 * of the polygons, one after another. A column's accessor has the words of its rows as they are in
 * memory (a bool is a word), little-endian: of vertices, of faces, or of halfedges: the corners in
 * the order of `corners`.
 *
 * None of it is believed: a program that changed the file may have kept it. Copies at other
 * positions than their vertices, polygons that are not those of the triangles and columns of a
 * wrong number of rows are ignored with a note, all of it where the node moves the mesh. */
#ifndef HE_FORMAT_GLTF_GLTF_PRIVATE_H
#define HE_FORMAT_GLTF_GLTF_PRIVATE_H

#include "format/gltf/gltf_attribute.h"

bool he_gltf_has_private(const he_gltf *asset, uint32_t primitive);
/* Before its vertices are added: which of them are copies; p->private says whether the extras fit
 * so far. Fails only as memory, limits and the watch do. */
HE_NODISCARD he_status he_gltf_open_private(he_gltf_surface *surface, he_gltf_primitive *p,
                                            he_error *err);
/* After that, where p->private: add its columns, and its polygons, so that the triangles need not
 * be; p->exact and p->polygons say so. Fails likewise. */
HE_NODISCARD he_status he_gltf_read_private(he_gltf_surface *surface, he_gltf_primitive *p,
                                            he_error *err);

#endif
