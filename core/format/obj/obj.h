/* obj.h - Wavefront OBJ: the functions for its row in the table of formats (format.c). What is
 * "noted" is reported as a warning (warnings.h).
 *
 * Read                      as
 *   v x y z                   a vertex
 *   v x y z w                 a vertex; a weight w other than 1 is noted and ignored
 *   v x y z r g b [a]         with the vertex attribute "color" (colors.h)
 *   vt u [v [w]]              half-edge attribute "uv", v upward: two doubles, or three if a corner
 *                             has a w other than 0
 *   vn x y z                  half-edge attribute "normal"
 *   f, fo                     a face; corners v, v/vt, v//vn, v/vt/vn, also mixed and with a slash
 *                             at the end; negative indices count back from the last element so
 *                             far, positive ones may name later elements
 *   o, g, usemtl              face attributes "object", "group", "material": the rest of the line
 *   s n | on | off            face attribute "smoothing"
 *   mtllib                    attribute "mtllib" of the mesh, which keeps the name; materials of
 *                             a library that came with the file (mtl.h); else this is noted. No
 *                             file is ever opened
 *   l, p, curves, others      noted and ignored, as are lines that begin with $; any other line
 *                             that does not begin with a word is HE_SYNTAX
 *
 * Reading returns HE_BAD_INDEX if an index is 0, or too large when the file has ended. Returns
 * HE_SYNTAX if no line was understood; a file of comments is an empty mesh. If some corners have a
 * texture coordinate or normal, those without one get zeros and a warning.
 *
 * Written: mtllib if the mesh has materials or came with the name of a library; v, with three
 * numbers of a colour if vertices have colours; vt and vn (values of corners whose bits are equal
 * are written once); then faces, with o, g, usemtl and s where they change. A line of v never has
 * seven numbers, because other programs refuse that. */
#ifndef HE_FORMAT_OBJ_OBJ_H
#define HE_FORMAT_OBJ_OBJ_H

#include "format/io/format.h"

bool he_obj_sniff(const char *bytes, size_t n);
extern const he_reading he_obj_reading;
extern const he_writing he_obj_writing;

#endif
