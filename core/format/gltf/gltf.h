/* gltf.h - glTF 2.0, as GLB (the binary container) and as JSON: the rows' parts for format.c.
 *
 *     "glTF" 2 length            twelve bytes
 *     length "JSON" ...          a chunk: the asset
 *     length "BIN\0" ...         a chunk that may be missing: its buffer 0
 *
 * A length that is no multiple of 4 is noted; the next chunk may then come at once, or aligned.
 *
 * READING. Everything comes from the bytes themselves: a buffer is the BIN chunk, a data: URI in
 * base64 or a file that came with this one (io/beside.h). Images are noted; nothing is ever opened.
 *
 * Each node of the scene that has a mesh adds it, moved by the product of the matrices above it, so
 * a mesh of several nodes comes several times. Each primitive adds all its vertices, in the order
 * of the file, then its triangles, strip or fan; one without indices takes the vertices as they
 * come. Vertices that share a position stay apart. Where a node mirrors, triangles are turned over,
 * so that they face out as before, with a note. A rotation that is a quaternion of another length
 * than 1 is made one of that length, with a note. Points and lines are noted and left out, as are
 * skins, animations and morph targets: a mesh is as its node places it.
 *
 * Attributes of vertices are those of gltf_attribute.h; of faces, "object" is the name of the node,
 * else of the mesh, and "material" that of the material. Materials are rows of the table
 * (gltf_material.h). Polygons
 * and all that glTF has no place for are in the extras of files that were written here
 * (gltf_private.h).
 *
 * Refused: other versions; extensions that are required and change geometry (KHR_mesh_quantization
 * and EXT_meshopt_compression are read); what refers beyond its list, view or buffer; numbers
 * outside their range; directions that are no floats, without that extension; nodes that are
 * reached twice or are inside themselves; and scenes that make more than gltf_asset.h allows. The
 * errors have the byte, and the path in the JSON.
 *
 * WRITING. A mesh for each object and group of faces, in it a primitive for each material, all of
 * them with all vertices, in the order of ids, as floats, and each with its triangles
 * (glb_groups.h). Materials are rows of the table and names that are not in it.
 * normal, tangent, uv, color, joints and weights of vertices and other attributes of floats are
 * glTF attributes as they are read. Of corners those of that list are, before those of vertices of
 * the same name: where corners of a vertex differ, there are copies of it behind all vertices
 * (splits.h). All others, those of faces and corners too, are also in extras unless that is the
 * same. So are polygons, and which vertices are copies. Numbers have no gaps and joints come with
 * weights; what cannot has a name of its own, as _uv1 where there is no uv. Other programs ignore
 * extras, so this program reads back all but the positions' last digits, attributes of edges and of
 * the mesh.
 *
 * As "meshopt" the same in EXT_meshopt_compression, whose streams are held as a whole. No number is
 * rounded, but a triangle may begin at another of its corners; where corners have values they keep
 * their order. */
#ifndef HE_FORMAT_GLTF_GLTF_H
#define HE_FORMAT_GLTF_GLTF_H

#include "format/io/format.h"

bool he_glb_sniff(const char *bytes, size_t n);
bool he_gltf_sniff(const char *bytes, size_t n);
extern const he_reading he_glb_reading, he_gltf_reading;
extern const he_writing he_glb_writing;
/* Its encodings. */
enum { HE_GLB_PLAIN, HE_GLB_MESHOPT };

#endif
