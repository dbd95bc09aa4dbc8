/* stl.h - STL, triangles for stereolithography: the functions for its row in the table of formats
 * (format.c). What is "noted" is reported as a warning (warnings.h).
 *
 *     solid NAME                         binary, little-endian:
 *       facet normal x y z                 80 bytes of anything
 *         outer loop                       uint32    facets
 *           vertex x y z                   50 bytes a facet:
 *           vertex x y z                     float x 3       normal
 *           vertex x y z                     float x 3 x 3   corners
 *         endloop                            uint16          "attribute"
 *       endfacet
 *     endsolid NAME
 *
 * READING. The format has no vertices: corners at equal positions become one vertex (weld.h), and a
 * warning says how many corners were merged with others. Vertices are numbered in the order of
 * their first corners. Normals are ignored, because the corners define them. A file that begins
 * with "solid" is text unless it has a NUL near its beginning.
 *
 * In ASCII letter case does not matter, nor do line ends, except after solid, endsolid and the
 * normal. There may be several solids; their names become the face attribute "object". Unknown
 * words are noted and skipped to the end of their line.
 *
 * In binary up to 49 bytes may follow the last facet; they are noted, and so are attribute bytes
 * other than 0.
 *
 * Reading returns HE_SYNTAX if a facet does not have three corners, the file ends inside a facet,
 * or there are fewer or more facets than declared. Returns HE_BAD_VALUE if no mesh can have that
 * number of facets. A facet with two equal corners is left for he_build to refuse.
 *
 * WRITING. Polygons are cut into triangles as geometry/triangulation.h chooses them, in the order
 * of the faces. Warnings say how many faces were cut, how many vertices are in no face, how many
 * are at the position of another vertex and will be merged with it when the file is read, and in
 * binary how many positions were rounded to floats. */
#ifndef HE_FORMAT_STL_STL_H
#define HE_FORMAT_STL_STL_H

#include "format/io/format.h"

bool he_stl_sniff(const char *bytes, size_t n);
extern const he_reading he_stl_reading;
extern const he_writing he_stl_writing;

#endif
