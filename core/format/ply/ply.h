/* ply.h - Polygon File Format (the Stanford triangle format), the row's parts for format.c.
 *
 *     ply
 *     format ascii 1.0              or binary_little_endian, binary_big_endian
 *     element vertex V              rows of this element, in the order of the header
 *     property float x              char, uchar, short, ushort, int, uint, float, double, or
 *     property list uchar int vertex_indices       int8, uint8 ... float32, float64
 *     end_header
 *
 * READING. Elements in any order, properties in any order and of any type. Of "vertex", x, y and z
 * are the position; of "face", the list vertex_indices or vertex_index has the corners; of
 * "tristrips", the same list has strips of triangles, each begun by -1, with every second triangle
 * turned round. Such a list may be of floats or doubles that are whole, with a note. Other numbers
 * of vertices and faces become attributes of that name; those of a normal, a colour and a texture
 * coordinate become one together (ply_groups.h).
 *
 * Whole numbers are int32 or uint32, those of a colour floats of 0 to 1, others keep their type; a
 * group of several types is double. A list "texcoord" of faces, of two floats or doubles a corner,
 * is the half-edge attribute uv. Values that are not finite are set to 0 and noted, in a position
 * refused. Other lists, elements of other names, numbers behind a row and bytes behind the last row
 * are noted and left out; comments, obj_info and lines that begin with # are passed over. In ascii
 * each row is a line, and positions have the digits that are written, whatever the property's type
 * says.
 *
 * HE_SYNTAX: fewer rows than announced; rows without properties, which would take no bytes;
 * vertices without a position, faces without corners. HE_BAD_INDEX: a corner below 0 or not below
 * V. HE_BAD_VALUE: a count that no mesh or list can have, a value its property cannot. HE_LIMIT:
 * more than HE_PLY_ELEMENTS or HE_PLY_PROPERTIES. Errors of the header and in ascii have a line,
 * those in binary a byte.
 *
 * WRITING. Positions are float where each is one exactly, else double; so they read back to the
 * same bits. Colours are uchar, and a note counts those that lie between two bytes. Attributes of
 * one component keep their name; of several only normal, color and uv (as s, t) have one. Those
 * of corners come before those of vertices, with marks that bring them back (ply_groups.h). */
#ifndef HE_FORMAT_PLY_PLY_H
#define HE_FORMAT_PLY_PLY_H

#include "format/io/format.h"

bool he_ply_sniff(const char *bytes, size_t n);
extern const he_reading he_ply_reading;
extern const he_writing he_ply_writing;

#endif
