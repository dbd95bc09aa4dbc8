/* format.h - mesh files: bytes in, bytes out.
 *
 * THE TABLE. One row a format: names, how to recognise it, its reader and writer. A new format is a
 * new row in format.c.
 *
 * READING. The bytes come in pieces of any size, as they arrive, and are not kept, save by a format
 * whose parts name each other in any order, until it is finished:
 *
 *     he_reader_new -> he_reader_feed ... -> he_reader_finish -> he_import -> he_build
 * (build/build.h)
 *
 * What a file refers to lies in others: those that came with it are given before it is finished
 * (he_reader_beside).
 *
 * An import is a polygon soup, notes on what was passed over, and the place of each vertex and
 * face in the input. A reader refuses what is wrong in the text itself (syntax, indices, numbers,
 * counts); what only the structure cannot hold, faces of two corners included, is left for
 * he_build to refuse or for a repair, and he_import_locate then adds the line.
 * Memory is proportional to the bytes fed and bounded by the limits; no number in a file is
 * believed before the bytes for it have come.
 *
 * WRITING pulls from a mesh, which must not change meanwhile:
 *
 *     he_writer_new -> he_writer_read ... -> 0
 *
 * Live vertices are numbered 0, 1, 2... in the order of their ids, faces are written in the order
 * of theirs. The document is never held as a whole. What the format cannot carry is known from the
 * start (he_writer_notes). After he_writer_new nothing can fail. */
#ifndef HE_FORMAT_IO_FORMAT_H
#define HE_FORMAT_IO_FORMAT_H

#include "build/build.h"
#include "format/io/beside.h"
#include "format/io/places.h"
#include "format/text/notes.h"

typedef struct he_import {
    he_soup soup;
    he_notes notes;
    he_places vertices, faces;
    double edges;        /* how many the file says it has, */
    uint64_t edges_line; /* and where; 0: it does not say */
    he_beside *beside;   /* while it is read: the files that came with it; may be NULL */
} he_import;

void he_import_clear(he_import *import);
/* Give an error that names a vertex or face of the input, such as he_build's, its place there. */
void he_import_locate(const he_import *import, he_error *err);

/* What a format's reader does; `state` is its own. `into` is the import to fill, which outlives the
 * state. A failed call is the last but for close. */
typedef struct he_reading {
    he_status (*open)(he_import *into, void **state, he_error *err);
    he_status (*feed)(void *state, const void *bytes, size_t n, he_error *err);
    he_status (*finish)(void *state, he_error *err);
    void (*close)(void *state);
    bool at_end; /* feed only keeps the bytes: finish reads, and tells the soup's watch */
} he_reading;

/* What a format's writer does. `step` writes some of what comes next at `*p`, from where at least
 * HE_WRITE_ROOM bytes are free up to `end`, and moves it. False when that was the last. */
enum { HE_WRITE_ROOM = 512 };

typedef struct he_writing {
    he_status (*open)(const he_mesh *mesh, size_t encoding, he_watch *watch, he_notes *notes,
                      void **state, he_error *err);
    bool (*step)(void *state, char **p, const char *end);
    void (*close)(void *state);
    bool cuts; /* polygons are cut into triangles (cuts.h): long_faces.h may do that before */
} he_writing;

typedef struct he_format {
    const char *name;
    const char *doc;
    const char *const *media_types; /* NULL ends these lists; the first is what an export says */
    const char *const *extensions;
    const char *const *encodings; /* that the writer knows, the default first */
    const char *const *carries;   /* what is kept: "polygons", or an attribute as "face color" */
    /* Could these be the first bytes of such a file? */
    bool (*sniff)(const char *bytes, size_t n);
    const he_reading *reading; /* NULL: cannot be read */
    const he_writing *writing; /* NULL: cannot be written */
} he_format;

/* The rows, in the order in which they are tried on unknown bytes. NULL beyond the last. */
const he_format *he_format_at(size_t i);
/* These return NULL where there is none. A media type may be followed by parameters; letter case
 * does not matter in either. An extension is without its dot. */
const he_format *he_format_find(const char *name);
const he_format *he_format_of_media_type(const char *type);
const he_format *he_format_of_extension(const char *extension);
const he_format *he_format_sniff(const void *bytes, size_t n);
/* The number of an encoding of a format, -1 where there is none. */
int he_format_encoding(const he_format *format, const char *encoding);

typedef struct he_reader he_reader;

/* `limits` may be NULL. HE_UNSUPPORTED when the format cannot be read, HE_NO_MEMORY. */
HE_NODISCARD he_status he_reader_new(const he_format *format, const he_limits *limits,
                                     he_reader **out, he_error *err);
void he_reader_free(he_reader *reader);
/* HE_SYNTAX, HE_BAD_INDEX, HE_BAD_VALUE, HE_NOT_FINITE, HE_UNSUPPORTED with a line or byte;
 * HE_LIMIT; HE_NO_MEMORY. After a failure every further call fails with the same error. */
HE_NODISCARD he_status he_reader_feed(he_reader *reader, const void *bytes, size_t n,
                                      he_error *err);
/* The files that came with this one, before finish and as long as the reader lives; those that it
 * does not name are noted as ignored_file. `beside` may be NULL. */
void he_reader_beside(he_reader *reader, he_beside *beside);
/* Will finishing take about as long as reading the bytes does? Then it may be watched. */
bool he_reader_reads_at_end(const he_reader *reader);
void he_reader_watch(he_reader *reader, he_watch *watch);
/* The end of the input: the import is the caller's to clear. The reader is then only to be freed.
 * Fails as he_reader_feed does, and with HE_CANCELLED. */
HE_NODISCARD he_status he_reader_finish(he_reader *reader, he_import *out, he_error *err);

typedef struct he_writer he_writer;

/* `encoding` is an index into the format's list; `watch` (NULL: none) is told of what is found
 * before the first byte, which costs the mesh. HE_UNSUPPORTED when the format cannot be written,
 * HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_writer_new(const he_format *format, const he_mesh *mesh, size_t encoding,
                                     he_watch *watch, he_writer **out, he_error *err);
void he_writer_free(he_writer *writer);
/* The next bytes of the document, at most `size`; 0 at the end. */
size_t he_writer_read(he_writer *writer, void *buffer, size_t size);
/* What the document does not carry. */
const he_notes *he_writer_notes(const he_writer *writer);

#endif
