/* gltf_scene.h - the nodes of a glTF scene, each of which may place a mesh. */
#ifndef HE_FORMAT_GLTF_GLTF_SCENE_H
#define HE_FORMAT_GLTF_GLTF_SCENE_H

#include "format/gltf/gltf_asset.h"

enum { HE_GLTF_DEPTH = 1 << 16 }; /* of nodes inside nodes */

/* Fill the import with the meshes of the scene `scene` names, else the first one, else of the nodes
 * that are no children, else all meshes. A node's mesh comes before its children's, in the order of
 * the file. HE_BAD_VALUE for a node that is reached twice or inside itself, HE_BAD_INDEX, HE_LIMIT,
 * HE_NO_MEMORY and what he_gltf_add_mesh gives. */
HE_NODISCARD he_status he_gltf_read_scene(he_gltf *asset, he_error *err);

#endif
