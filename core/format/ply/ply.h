/* ply.h - Polygon File Format (the Stanford triangle format): the functions for its row in the
 * table of formats (format.c). What is "noted" is reported as a warning (warnings.h).
 *
 *     ply
 *     format ascii 1.0              or binary_little_endian, binary_big_endian
 *     element vertex V              rows of this element, in the order of the header
 *     property float x              char, uchar, short, ushort, int, uint, float, double, or
 *     property list uchar int vertex_indices       int8, uint8 ... float32, float64
 *     end_header
 *
 * READING. Elements in any order, properties in any order and of any type. In "vertex", x, y and z
 * are the position; in "face", the list vertex_indices or vertex_index has the corners; in
 * "tristrips", such a list has strips of triangles, each begun by -1, with every second triangle
 * reversed. These lists may be of floats or doubles that are whole, with a warning. Other numbers
 * of vertices and faces become attributes of that name; those of a normal, a colour and a texture
 * coordinate together become one attribute (ply_groups.h).
 *
 * Whole numbers are int32 or uint32, those of a colour floats of 0 to 1, others keep their type; a
 * group of several types is double. A list "texcoord" of faces, of two floats or doubles a corner,
 * is the half-edge attribute uv. Values that are not finite are set to 0 and noted; in a position
 * they are refused. Other lists, elements of other names, numbers after a row and bytes after the
 * last row are noted and ignored; comments, obj_info and lines that begin with # are skipped. In
 * ascii each row is a line, and positions have the digits that are written, whatever the property's
 * type says.
 *
 * Reading returns HE_SYNTAX if there are fewer rows than announced, rows without properties (which
 * would take no bytes), vertices without a position or faces without corners; HE_BAD_INDEX if a
 * corner is below 0 or not below V; HE_BAD_VALUE if no mesh or list can have such a count, or no
 * property such a value; HE_LIMIT if there are more than HE_PLY_ELEMENTS or HE_PLY_PROPERTIES.
 * Errors of the header and in ASCII name a line, those in binary a byte.
 *
 * WRITING. Positions are float if each is one exactly, else double, so they read back to the same
 * bits. Colours are uchar, and a warning counts those that no byte represents exactly. Attributes
 * of one component keep their name; of several only normal, color and uv (as s, t) have one.
 * Attributes of corners take precedence over those of vertices, and are marked so that they are
 * read back as such (ply_groups.h). */
#ifndef HE_FORMAT_PLY_PLY_H
#define HE_FORMAT_PLY_PLY_H

#include "format/io/format.h"

bool he_ply_sniff(const char *bytes, size_t n);
extern const he_reading he_ply_reading;
extern const he_writing he_ply_writing;

#endif
