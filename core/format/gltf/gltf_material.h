/* gltf_material.h - materials of glTF assets made rows of a soup's table.
 *
 * Their factors are those of mesh/material.h. An alphaMode of OPAQUE leaves the opacity out, so it
 * is 1 then; KHR_materials_emissive_strength is taken into the emission; of
 * KHR_materials_pbrSpecularGlossiness the diffuse factor is the base colour, where a material says
 * nothing else. Textures and other extensions are noted and not held (gltf_asset.c). A number that
 * is none, or out of range, is set to its default or the end of its range with a note. */
#ifndef HE_FORMAT_GLTF_GLTF_MATERIAL_H
#define HE_FORMAT_GLTF_GLTF_MATERIAL_H

#include "format/gltf/gltf_asset.h"

enum { HE_GLTF_NAME = 1024 };

/* Fill the table, and *names, the caller's, with a name for each material in their order: its own,
 * material_N where it has none, and NAME_2 and so on where another has it. Beyond HE_MATERIALS
 * there are names without rows, with a note. HE_LIMIT, HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_gltf_read_materials(he_gltf *asset, he_labels **names, he_error *err);

#endif
