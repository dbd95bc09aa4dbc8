/* gltf_material.h - reads the materials of glTF assets into a soup's table.
 *
 * Factors of glTF are the numbers of mesh/material.h. With alphaMode OPAQUE the opacity is 1;
 * KHR_materials_emissive_strength is multiplied into the emission; the diffuse factor of
 * KHR_materials_pbrSpecularGlossiness is the base colour, if the material has no other. Textures
 * and other extensions are ignored with a warning (gltf_asset.c). A number that is not valid is
 * replaced by the default, one out of range by the end of the range, with a warning. */
#ifndef HE_FORMAT_GLTF_GLTF_MATERIAL_H
#define HE_FORMAT_GLTF_GLTF_MATERIAL_H

#include "format/gltf/gltf_asset.h"

enum { HE_GLTF_NAME = 1024 };

/* Fills the soup's table of materials. *names, which the caller owns, gets a name for each material
 * of the asset in order: its own, material_N if it has none, and NAME_2 and so on if another
 * material has that name. Materials after the first HE_MATERIALS get names but are not put into the
 * table, with a warning. Returns HE_LIMIT if a limit would be exceeded.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_gltf_read_materials(he_gltf *asset, he_labels **names, he_error *err);

#endif
