/* off.h - Object File Format, the row's parts for format.c.
 *
 *     [ST][C][N]OFF        in any order; may be missing: then the counts come first
 *     V F E                on the same line or a later one; E is ignored and may be missing
 *     x y z [normal] [colour] [s t]        a line for each vertex
 *     n v1 ... vn [colour]                 a line for each face
 *
 * Comments run from # to the end of the line, anywhere. A face may go on on the next line, and a
 * vertex whose position does. A vertex that ends with its position, or its normal, is read without
 * the rest, with a note, in files where none goes on. Colours have 3 or 4 numbers; they become the
 * attribute "color" of vertices and faces: integers count from 0 to 255 where all of a kind are
 * written so (colors.h). They are written as four fractions. Normals and texture coordinates become
 * the vertex attributes "normal" and "uv", v upward. A single number in place of a colour (an index
 * into a colour map) and numbers the header does not announce are noted and left out.
 *
 * Behind "OFF BINARY", which may have the prefixes, the body is that of off_binary.h, with a note.
 *
 * HE_SYNTAX: fewer vertices or faces than announced, or anything after the last face: a count
 * that lies would lose faces. HE_BAD_INDEX: a corner below 0 or not below V. HE_BAD_VALUE: a
 * count that no mesh can have. HE_UNSUPPORTED: 4OFF and nOFF. */
#ifndef HE_FORMAT_OFF_OFF_H
#define HE_FORMAT_OFF_OFF_H

#include "format/io/format.h"

bool he_off_sniff(const char *bytes, size_t n);
extern const he_reading he_off_reading;
extern const he_writing he_off_writing;

#endif
