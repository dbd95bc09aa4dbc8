/* gltf_scene.h - walks the nodes of a glTF scene, each of which may place a mesh. */
#ifndef HE_FORMAT_GLTF_GLTF_SCENE_H
#define HE_FORMAT_GLTF_GLTF_SCENE_H

#include "format/gltf/gltf_asset.h"

enum { HE_GLTF_DEPTH = 1 << 16 }; /* at most how many levels deep nodes may lie inside nodes */

/* Adds the meshes of one scene to the import: the scene that the asset's member `scene` names, or
 * the first one if there is no such member. An asset without scenes gives the meshes of all its
 * nodes; an asset without nodes gives all its meshes. The mesh of a node comes before those of its
 * children, which are in the order of the file. Returns the errors of he_gltf_add_mesh, too.
 * Returns HE_BAD_VALUE if a node is reached twice or is inside itself.
 * Returns HE_BAD_INDEX if an index refers to an object that does not exist.
 * Returns HE_LIMIT if a limit would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_gltf_read_scene(he_gltf *asset, he_error *err);

#endif
