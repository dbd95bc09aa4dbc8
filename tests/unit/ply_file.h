/* ply_file.h - builds a PLY file value by value, in any encoding. */
#ifndef TESTS_UNIT_PLY_FILE_H
#define TESTS_UNIT_PLY_FILE_H

#include "unit/format_fixture.h"

#define LITTLE "ply\nformat binary_little_endian 1.0\n"
#define BIG    "ply\nformat binary_big_endian 1.0\n"
#define ASCII  "ply\nformat ascii 1.0\n"
#define XYZ    "property float x\nproperty float y\nproperty float z\n"
#define CORNER "property list uchar int vertex_indices\n"

typedef enum ply_encoding { TEXT, LEAST_FIRST, MOST_FIRST } ply_encoding;

typedef struct ply_file {
    char bytes[8192];
    size_t length;
    ply_encoding encoding;
} ply_file;

/* Appends text. */
void ply_put_text(ply_file *f, const char *text);

/* A number type of PLY: its two names, and the type of an attribute that is read from such
 * numbers. */
typedef struct ply_type {
    const char *names[2];
    size_t size;
    bool is_signed, is_float;
    he_type column;
} ply_type;

enum { TYPES = 8, WHOLE_TYPES = 6, UCHAR = 1, INT = 4, UINT = 5, FLOAT = 6, DOUBLE = 7 };
extern const ply_type ply_types[TYPES];

/* Appends a value of the type ply_types[type] in the encoding of the file. */
void ply_put_value(ply_file *f, size_t type, double value);

/* Ends the values of one element: appends a line break if the encoding is text, otherwise
 * nothing. */
void ply_end_row(ply_file *f);

/* Begins a file: appends the two lines that name the encoding, then the other lines of the
 * header. */
void ply_begin(ply_file *f, ply_encoding e, const char *header);

/* Reads the PLY file that was built; reading must succeed. */
he_import ply_read(const ply_file *f);

/* positions of four corners, whose coordinates are whole numbers */
extern const double ply_square[4][3];

#endif
