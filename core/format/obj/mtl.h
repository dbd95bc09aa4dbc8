/* mtl.h - the material library of OBJ files (MTL): the functions for its row in the table of
 * formats (format.c), and a reader that fills a table of materials. What is "noted" is reported as
 * a warning (warnings.h).
 *
 * Read:
 *   newmtl NAME         a material; the name is the rest of the line
 *   Kd r g b            base colour; one number stands for three equal ones
 *   Ke r g b            emission
 *   d a | Tr 1-a        opacity; d takes precedence
 *   Pm, Pr              metallic, roughness
 *   illum               ignored: it only says which of the other values a renderer uses
 *   map_*, bump, disp, decal, norm, refl    noted with the name of the file, and not stored
 *   Ka, Ks, Ns, Ni, Tf and others           noted as ignored
 *
 * Missing values are those of he_plain_look. The format defines no colour space: colours are read
 * and written as linear, number for number, as Blender, assimp and obj2gltf do, while three.js
 * takes them for sRGB. A number out of range is set to the end of its range, which is noted; of two
 * materials with one name the second is ignored, which is noted if they differ.
 *
 * Written: all rows of the mesh's table of materials, with every number. The format cannot say
 * that a material shows both sides, which is noted. */
#ifndef HE_FORMAT_OBJ_MTL_H
#define HE_FORMAT_OBJ_MTL_H

#include "format/io/format.h"

/* Adds the materials of a library to those of an import. Warnings about the library name no lines,
 * because these would be taken for lines of the file that is imported. After a failure the
 * materials read so far stay.
 * Returns HE_SYNTAX, with the line, if a line cannot occur in a library, or if a library that is
 * not empty has no newmtl.
 * Returns HE_LIMIT if there are too many materials.
 * Returns HE_UNSUPPORTED if the text is UTF-16.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_mtl_read(const char *bytes, size_t n, he_import *into, he_error *err);

/* The attribute of a mesh that keeps the names of the material libraries in its OBJ file: uint32
 * with labels, and a component for each line of mtllib, at most HE_COLUMN_COMPONENTS. */
#define HE_OBJ_LIBRARY "mtllib"

/* Lists the names that an OBJ file written from the mesh gives its material libraries: those of the
 * attribute mtllib; without that attribute, "materials.mtl" if the mesh has materials, and none if
 * it has no materials. Returns the number of names. */
size_t he_mtl_names(const he_mesh *mesh, const char *names[HE_COLUMN_COMPONENTS]);

/* Returns false: a library is read only beside the file it belongs to, so its bytes are never
 * sniffed. */
bool he_mtl_sniff(const char *bytes, size_t n);
extern const he_writing he_mtl_writing;

#endif
