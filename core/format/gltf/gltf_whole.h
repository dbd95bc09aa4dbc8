/* gltf_whole.h - reassembles a mesh that hedge has written as groups of faces (glb_groups.h).
 *
 *     "extras": {"hedge": {
 *         "primitive": {"attributes": {...}, "indices": 2, "mode": 4, "extras": {"hedge": {...}}},
 *         "order": 7,
 *         "materials": ["steel", "glass"]}}
 *
 * are at the root of the asset. `primitive` has all faces (gltf_private.h), in the order of the
 * primitives of the scene, from which other programs read them; `order`, an accessor of
 * UNSIGNED_INT SCALAR, has the number in the mesh of each of these faces. hedge uses these extras
 * if the
 * scene is as hedge wrote it: nodes have no transformations, primitives have the attributes of
 * `primitive`, their triangles are consecutive ranges of its triangles, and the materials have
 * the names listed here. Otherwise the scene is read like any other, with a warning. */
#ifndef HE_FORMAT_GLTF_GLTF_WHOLE_H
#define HE_FORMAT_GLTF_GLTF_WHOLE_H

#include "format/gltf/gltf_surface.h"

/* Adds the primitive of all faces to an empty soup, if the scene (a JSON value, or HE_NONE) is as
 * hedge wrote it, and sets *whole to true; else sets *whole to false. Returns the errors of
 * he_gltf_add_primitive. */
HE_NODISCARD he_status he_gltf_add_whole(he_gltf_surface *surface, uint32_t scene, bool *whole,
                                         he_error *err);
/* Sorts the faces into their original order; must be called after he_gltf_surface_finish. If the
 * stored order is not valid, the faces stay as they are, with a warning.
 * Returns HE_LIMIT if a limit would be exceeded.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_gltf_order_whole(he_gltf_surface *surface, he_error *err);

#endif
