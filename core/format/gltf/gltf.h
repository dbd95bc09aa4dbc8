/* gltf.h - glTF 2.0: the functions for two rows of the table of formats (format.c), for GLB, the
 * binary container, and for JSON. What is "noted" is reported as a warning (warnings.h).
 *
 *     "glTF" 2 length            twelve bytes
 *     length "JSON" ...          a chunk: the asset
 *     length "BIN\0" ...         a chunk that may be missing: buffer 0 of the asset
 *
 * A length that is no multiple of 4 is noted; the next chunk may then follow directly, or aligned.
 *
 * READING. A buffer is the BIN chunk, a data: URI in base64 or a file that came with this one
 * (io/beside.h). Images are noted and ignored; no file is ever opened.
 *
 * Each node of the scene that has a mesh adds the mesh, transformed by the product of the matrices
 * of the node and its ancestors, so a mesh of several nodes is added several times. Each primitive
 * adds all its vertices, in the order of the file, then its triangles, strip or fan; one without
 * indices uses the vertices in order. Vertices that share a position stay separate. If the
 * transformation of a node mirrors, triangles are reversed so that they still face outward, which
 * is noted. A rotation whose quaternion has another length than 1 is normalised, which is noted.
 * Points and lines are noted and ignored, as are skins, animations and morph targets.
 *
 * Attributes of vertices are those of gltf_attribute.h; of faces, "object" is the name of the node,
 * else of the mesh, and "material" that of the material. Materials are rows of the table
 * (gltf_material.h). Files written by hedge have polygons, and everything else that glTF cannot
 * represent, in `extras`, a member for data of applications (gltf_private.h).
 *
 * Reading refuses other versions; extensions that are required and change geometry, except
 * KHR_mesh_quantization and EXT_meshopt_compression, which it reads; references beyond a list, view
 * or buffer; numbers outside their range; directions that are no floats, without
 * KHR_mesh_quantization; nodes that are reached twice or are inside themselves; and scenes that
 * take more memory than gltf_asset.h allows. Errors name the byte, and the path in the JSON.
 *
 * WRITING. The file has a mesh for each object and group of faces, and in this mesh a primitive for
 * each material. All primitives share all vertices, which are floats in the order of ids; each has
 * its own triangles (glb_groups.h). The materials are the rows of the table and the names that have
 * no row. normal, tangent, uv, color, joints and weights of vertices, and other attributes of
 * floats, are glTF attributes of the names under which they are read. Attributes of corners with
 * one of these six names are written too, and take precedence over attributes of vertices with that
 * name: if corners of a vertex differ, copies of it follow all vertices (splits.h). All other
 * attributes, and those of faces and corners, are in extras, unless glTF preserves them exactly.
 * Extras also have the polygons, and say which vertices are copies. glTF allows TEXCOORD_1 only
 * with TEXCOORD_0, and joints only with weights; an attribute that would break this gets a name of
 * its own, such as _uv1 for uv1 without uv. Other programs ignore extras; hedge reads back
 * everything except the last digits of positions, and attributes of edges and of the mesh.
 *
 * The encoding "meshopt" is compressed by EXT_meshopt_compression; all compressed data is in memory
 * before the first byte is written. No number is rounded, but a triangle may begin at another of
 * its corners, unless the mesh has attributes of corners. */
#ifndef HE_FORMAT_GLTF_GLTF_H
#define HE_FORMAT_GLTF_GLTF_H

#include "format/io/format.h"

bool he_glb_sniff(const char *bytes, size_t n);
bool he_gltf_sniff(const char *bytes, size_t n);
extern const he_reading he_glb_reading, he_gltf_reading;
extern const he_writing he_glb_writing;
/* The encodings of a GLB. */
enum { HE_GLB_PLAIN, HE_GLB_MESHOPT };

#endif
