/* stl.h - STL, triangles as stereolithography takes them, the row's parts for format.c.
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
 * READING. The format has no vertices: corners at equal positions are one (weld.h), and a note says
 * how many were. Vertices are numbered as they first appear. Normals are passed over: the corners
 * give them. A file that begins with "solid" is text unless it has a NUL near its beginning.
 *
 * In ascii letter case does not matter, nor where lines end, but after solid, endsolid and the
 * normal. There may be several solids; their names become the face attribute "object". Words that
 * do not belong are noted and passed over to the end of their line.
 *
 * In binary up to 49 bytes may follow the last facet; they are noted, as are attribute bytes other
 * than 0.
 *
 * HE_SYNTAX: a facet that does not have three corners; a file that ends inside one; fewer or more
 * facets than announced. HE_BAD_VALUE: a number of facets that no mesh can have. A facet with two
 * equal corners is left for he_build to refuse.
 *
 * WRITING. Polygons are cut into triangles as geometry/triangulation.h chooses them, in the order
 * of the faces. Notes say how many were, how many vertices are not in any face, how many lie where
 * another one does and will be one with it, and in binary how many positions were rounded to
 * floats. */
#ifndef HE_FORMAT_STL_STL_H
#define HE_FORMAT_STL_STL_H

#include "format/io/format.h"

bool he_stl_sniff(const char *bytes, size_t n);
extern const he_reading he_stl_reading;
extern const he_writing he_stl_writing;

#endif
