/* off.h - Object File Format: the functions for its row in the table of formats (format.c). What is
 * "noted" is reported as a warning (warnings.h).
 *
 *     [ST][C][N]OFF        in any order; may be missing: then the counts come first
 *     V F E                on the same line or a later one; E is ignored and may be missing
 *     x y z [normal] [colour] [s t]        a line for each vertex
 *     n v1 ... vn [colour]                 a line for each face
 *
 * Comments run from # to the end of the line, anywhere. A face may continue on the next line, and
 * so may a vertex after its position. A vertex that ends with its position, or its normal, is read
 * without the values that are missing, which is noted; but not in a file in which some vertex
 * continues on the next line. Colours have 3 or 4 numbers; they become the attribute "color" of
 * vertices and faces: integers count from 0 to 255 if all numbers of all vertices, or of all faces,
 * are integers (colors.h). Colours are written as four fractions. Normals and texture coordinates
 * become the vertex attributes "normal" and "uv", v upward. A single number in place of a colour
 * (an index into a colour map) and numbers that the header does not declare are noted and ignored.
 *
 * After "OFF BINARY", which may have the prefixes, the body has the form of off_binary.h; it is
 * noted that the body is read as big-endian.
 *
 * Reading returns HE_SYNTAX if there are fewer vertices or faces than declared, or anything after
 * the last face, because a wrong count would lose faces. Returns HE_BAD_INDEX if a corner is below
 * 0 or not below V. Returns HE_BAD_VALUE if no mesh can have such a count. Returns HE_UNSUPPORTED
 * for 4OFF and nOFF. */
#ifndef HE_FORMAT_OFF_OFF_H
#define HE_FORMAT_OFF_OFF_H

#include "format/io/format.h"

bool he_off_sniff(const char *bytes, size_t n);
extern const he_reading he_off_reading;
extern const he_writing he_off_writing;

#endif
