/* format_fixture.h - reads mesh files, which tests give as string literals, in pieces of all sizes,
 * and checks the results. */
#ifndef TESTS_UNIT_FORMAT_FIXTURE_H
#define TESTS_UNIT_FORMAT_FIXTURE_H

#include "unit/fixture.h"

#include "format/io/format.h"

/* The bytes of a file in memory, and the name of its format. */
typedef struct format_file {
    const char *format;
    const void *bytes;
    size_t length;
} format_file;

/* Reads a file in pieces of `piece` bytes, or in one piece if `piece` is 0. `limits` may be
 * NULL. */
he_status read_pieces(const format_file *file, size_t piece, const he_limits *limits,
                      he_import *out, he_error *err);

/* Requires that two attributes have equal names, kinds of elements, types, labels and values. */
void expect_same_columns(const he_column *a, const he_column *b);

/* Requires that the results of reading two files are equal: faces, attributes, places and
 * warnings. */
void expect_same_imports(const he_import *a, const he_import *b);

/* Reads a file as a whole, byte by byte, and in small pieces. Each time the status, the error and
 * the result must be equal. */
he_status read_bytes(const char *format, const void *text, size_t length, he_import *out,
                     he_error *err);

/* Reads a text file with read_bytes(), which must succeed; the caller must clear the result. */
he_import read_text(const char *format, const char *text);

/* Requires that reading the file fails with an error at line `line` whose message contains
 * `words`. */
void expect_bytes_refused(const format_file *file, he_status wanted, uint64_t line,
                          const char *words);

/* Requires that reading a text file fails with an error at line `line` whose message contains
 * `words`. */
void expect_refused(const char *format, const char *text, he_status wanted, uint64_t line,
                    const char *words);

/* Requires that reading the file fails with an error at byte `at` whose message contains
 * `words`. */
void expect_refused_at_byte(const format_file *file, he_status wanted, uint64_t at,
                            const char *words);

/* Requires that the file that was read has these numbers of vertices, faces and face corners. */
void expect_counts(const he_import *import, size_t vertices, size_t faces, size_t corners);

/* Requires that the corners of all faces together are exactly the vertices in `corners`. */
void expect_corners(const he_import *import, const uint32_t *corners, size_t count);

/* Returns the attribute that was read with this name for this kind of element, or NULL. */
const he_column *find_column(const he_import *import, he_kind domain, const char *name);

/* An attribute that a test expects: the kind of elements that have it, its name, how many numbers a
 * row has, and how many rows there are. */
typedef struct attribute_shape {
    he_kind domain;
    const char *name;
    uint32_t components;
    size_t rows;
} attribute_shape;

/* Requires that the file that was read has an attribute of this shape and type, and returns it. */
const he_column *expect_shape(const he_import *import, const attribute_shape *shape, he_type type);

/* Requires an attribute of doubles with this shape and exactly these values, row by row. */
void expect_doubles(const he_import *import, const attribute_shape *shape, const double *values);

/* Requires an attribute of colours that are equal to these bytes, up to the precision of the
 * attribute's type. */
void expect_bytes(const he_import *import, he_kind domain, uint32_t components,
                  const unsigned char *values, size_t rows);

/* Requires an attribute of 32-bit integers with this shape and exactly these values, row by row. */
void expect_u32s(const he_import *import, const attribute_shape *shape, const uint32_t *values);

/* Returns the label of a face in the attribute `name`, whose values are labels. */
const char *face_label(const he_import *import, const char *name, size_t face);

/* Returns the warning with this code about this subject, or NULL if there is none. */
const he_warning *find_warning(const he_warnings *warnings, const char *code, const char *subject);

/* Requires a warning that reports `count` places in the file, the first of them at line `line`. */
void expect_warning(const he_import *import, const char *code, const char *subject, uint64_t count,
                    uint64_t line);

/* Makes a mesh of a file that was read, and checks the mesh; the caller must free it. */
he_mesh *build_import(he_import *import);

/* Reads a text file and makes a mesh of it; the caller must free the mesh. */
he_mesh *mesh_of_text(const char *format, const char *text);

/* Writes a mesh to a file in memory through a buffer of `size` bytes; returns the bytes of the
 * file, ended by NUL, which the caller must free. */
char *write_encoded(const char *format, const char *encoding, const he_mesh *mesh, size_t size,
                    he_warnings *warnings, size_t *out_length);

/* Writes a mesh as a text file through a buffer of `size` bytes, like write_encoded(). */
char *write_pieces(const char *format, const he_mesh *mesh, size_t size, he_warnings *warnings);

/* Writes a mesh to files in memory through buffers of several sizes; the files must be equal.
 * Returns the bytes of one of the equal files, which may have any values; the caller must free
 * them. */
char *write_bytes(const char *format, const char *encoding, const he_mesh *mesh,
                  he_warnings *warnings, size_t *length);

/* Writes a mesh as a text file through buffers of several sizes, like write_bytes(). */
char *write_text(const char *format, const he_mesh *mesh, he_warnings *warnings);

#endif
