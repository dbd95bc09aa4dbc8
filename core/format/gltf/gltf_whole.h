/* gltf_whole.h - a mesh that was written here with its faces told apart (glb_groups.h), put
 * together again.
 *
 *     "extras": {"hedge": {
 *         "primitive": {"attributes": {...}, "indices": 2, "mode": 4, "extras": {"hedge": {...}}},
 *         "order": 7,
 *         "materials": ["steel", "glass"]}}
 *
 * stand at the root of the asset. The primitive is all faces as one (gltf_private.h), in the order
 * of the primitives that other programs see; `order`, an accessor of UNSIGNED_INT SCALAR, has for
 * each face its number in the mesh. It is taken where the scene is as it was written: nodes that
 * nothing moves, primitives with these attributes whose triangles are those of the primitive one
 * after another, and materials of these names. Else the scene is read as any other, with a note. */
#ifndef HE_FORMAT_GLTF_GLTF_WHOLE_H
#define HE_FORMAT_GLTF_GLTF_WHOLE_H

#include "format/gltf/gltf_surface.h"

/* Add the primitive to an empty soup, where the scene (a value of the JSON, or HE_NONE) is as it
 * was written; *whole says so. Fails as he_gltf_add_primitive does. */
HE_NODISCARD he_status he_gltf_add_whole(he_gltf_surface *surface, uint32_t scene, bool *whole,
                                         he_error *err);
/* After he_gltf_surface_finish: put the faces in their order. An order that is none leaves them as
 * they are, with a note. HE_LIMIT, HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_gltf_order_whole(he_gltf_surface *surface, he_error *err);

#endif
