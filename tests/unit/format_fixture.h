/* format_fixture.h - reads files given as literals in pieces of all sizes, and checks the results.
 */
#ifndef TESTS_UNIT_FORMAT_FIXTURE_H
#define TESTS_UNIT_FORMAT_FIXTURE_H

#include "unit/fixture.h"

#include "format/io/format.h"

/* A file, of the format with this name. */
typedef struct format_file {
    const char *format;
    const void *bytes;
    size_t length;
} format_file;

/* Reads a file in pieces of `piece` bytes; 0: in one piece. `limits` may be NULL. */
he_status read_pieces(const format_file *file, size_t piece, const he_limits *limits,
                      he_import *out, he_error *err);

/* Requires that two attributes are equal: name, place, type, labels and values. */
void expect_same_columns(const he_column *a, const he_column *b);

/* Requires that two imports are equal: soup, attributes, places and warnings. */
void expect_same_imports(const he_import *a, const he_import *b);

/* Reads a file whole, byte by byte and in small pieces: status, error and import must be equal each
 * time. */
he_status read_bytes(const char *format, const void *text, size_t length, he_import *out,
                     he_error *err);

/* Reads a file of text with read_bytes(), which must succeed; the caller must clear the import. */
he_import read_text(const char *format, const char *text);

/* Requires that the file is refused at this line, and that the message has these words. */
void expect_bytes_refused(const format_file *file, he_status wanted, uint64_t line,
                          const char *words);

/* Requires that a file of text is refused at this line, and that the message has these words. */
void expect_refused(const char *format, const char *text, he_status wanted, uint64_t line,
                    const char *words);

/* Requires that the file is refused at this byte, and that the message has these words. */
void expect_refused_at_byte(const format_file *file, he_status wanted, uint64_t at,
                            const char *words);

/* Requires these numbers of vertices, faces and corners. */
void expect_counts(const he_import *import, size_t vertices, size_t faces, size_t corners);

/* Requires exactly these corners. */
void expect_corners(const he_import *import, const uint32_t *corners, size_t count);

/* Returns the attribute of the import with this name, NULL if there is none. */
const he_column *find_column(const he_import *import, he_kind domain, const char *name);

/* An expected attribute: where it is, its name, the numbers in each row, and its rows. */
typedef struct attribute_shape {
    he_kind domain;
    const char *name;
    uint32_t components;
    size_t rows;
} attribute_shape;

/* Requires that the import has an attribute of this shape and type, and returns it. */
const he_column *expect_shape(const he_import *import, const attribute_shape *shape, he_type type);

/* Requires an attribute of this shape with exactly these values, row by row. */
void expect_doubles(const he_import *import, const attribute_shape *shape, const double *values);

/* Requires colours that are equal to these bytes, in the precision of the attribute's type. */
void expect_bytes(const he_import *import, he_kind domain, uint32_t components,
                  const unsigned char *values, size_t rows);

/* Requires an attribute of this shape with exactly these values, row by row. */
void expect_u32s(const he_import *import, const attribute_shape *shape, const uint32_t *values);

/* Returns the label that the attribute of this name gives to a face. */
const char *face_label(const he_import *import, const char *name, size_t face);

/* Returns the warning with this code about this subject, NULL if there is none. */
const he_warning *find_warning(const he_warnings *warnings, const char *code, const char *subject);

/* Requires a warning that stands for `count` places, the first of them at this line. */
void expect_warning(const he_import *import, const char *code, const char *subject, uint64_t count,
                    uint64_t line);

/* Makes a mesh of the import, and checks it; the caller must free it. */
he_mesh *build_import(he_import *import);

/* Makes a mesh of a file of text; the caller must free it. */
he_mesh *mesh_of_text(const char *format, const char *text);

/* Writes a mesh file through a buffer of `size` bytes; returns its text, ended by NUL, which the
 * caller must free. */
char *write_encoded(const char *format, const char *encoding, const he_mesh *mesh, size_t size,
                    he_warnings *warnings, size_t *out_length);

/* Writes a mesh file of text through a buffer of `size` bytes, like write_encoded(). */
char *write_pieces(const char *format, const he_mesh *mesh, size_t size, he_warnings *warnings);

/* Writes a mesh file, which may contain any bytes, through buffers of several sizes: the results
 * must be equal. The caller must free the result. */
char *write_bytes(const char *format, const char *encoding, const he_mesh *mesh,
                  he_warnings *warnings, size_t *length);

/* Writes a mesh file of text through buffers of several sizes, like write_bytes(). */
char *write_text(const char *format, const he_mesh *mesh, he_warnings *warnings);

#endif
