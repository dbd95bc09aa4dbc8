/* mtl.h - the material library of OBJ files (MTL): the row's part for format.c, and a reader that
 * fills a table of materials.
 *
 * Read:
 *   newmtl NAME         a material; the rest of the line
 *   Kd r g b            base colour; one number stands for three
 *   Ke r g b            emission
 *   d a | Tr 1-a        opacity; d counts where both are there
 *   Pm, Pr              metallic, roughness
 *   illum               passed over: it says which of the others a renderer looks at
 *   map_*, bump, disp, decal, norm, refl    noted with the name of the file, and not held
 *   Ka, Ks, Ns, Ni, Tf and others           noted as ignored
 *
 * What is not said is as in he_plain_look. The format names no space of its colours: they are taken
 * and written as linear, number for number, as Blender, assimp and obj2gltf do, while three.js
 * takes them for sRGB. A number out of range is set to the end of its
 * range, with a note; of two materials of one name the first counts, with a note where they differ.
 *
 * Written: all rows, with every number. That a material shows both sides has no place: it is noted.
 */
#ifndef HE_FORMAT_OBJ_MTL_H
#define HE_FORMAT_OBJ_MTL_H

#include "format/io/format.h"

/* Add the materials of a library to those of an import. Places of notes are not of its lines, which
 * are of another file than the import's. HE_SYNTAX, with the line, where a line is none of a
 * library's, and where there is no newmtl at all in what is not empty; HE_LIMIT, HE_UNSUPPORTED for
 * UTF-16, HE_NO_MEMORY. What was read before a failure stays. */
HE_NODISCARD he_status he_mtl_read(const char *bytes, size_t n, he_import *into, he_error *err);

/* The attribute of a mesh that says by which names its OBJ file called its libraries: uint32 with
 * labels, a component for each line of mtllib, at most HE_COLUMN_COMPONENTS. */
#define HE_OBJ_LIBRARY "mtllib"

/* The names by which an OBJ file of the mesh calls its library: those, else "materials.mtl"; none
 * where there is no table either. Returns how many. */
size_t he_mtl_names(const he_mesh *mesh, const char *names[HE_COLUMN_COMPONENTS]);

/* Could these be the first bytes of a library? No file is: it belongs to one. */
bool he_mtl_sniff(const char *bytes, size_t n);
extern const he_writing he_mtl_writing;

#endif
