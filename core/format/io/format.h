/* format.h - mesh files: bytes in, bytes out.
 *
 * THE TABLE. One row a format: names, how to recognise it, its reader and writer. A new format is a
 * new row in format.c.
 *
 * READING. The bytes come in pieces of any size, as they arrive, and are not kept. Only for a
 * format whose parts refer to each other in any order, the reader keeps them until the end of the
 * file:
 *
 *     he_reader_new -> he_reader_feed ... -> he_reader_finish -> he_import -> he_build
 *
 * build/build.h declares he_build. If a file refers to other files, the caller gives those that
 * came with it before it finishes (he_reader_beside).
 *
 * An import, the result of a reader, is a polygon soup, warnings about what was ignored, and the
 * place of each vertex and face in the input. A reader refuses errors of the text itself (syntax,
 * indices, numbers, counts). Faces that only a half-edge mesh cannot represent, such as those of
 * two corners, are left for he_build to refuse or for a repair, and he_import_locate then adds the
 * line. Memory is proportional to the bytes fed and bounded by the limits; no count in a file makes
 * the reader allocate before the bytes for it have come.
 *
 * WRITING pulls from a mesh, which must not change meanwhile:
 *
 *     he_writer_new -> he_writer_read ... -> 0
 *
 * Live vertices are numbered 0, 1, 2... in the order of their ids, and faces are written in the
 * order of their ids. The document is never in memory as a whole. What the format cannot
 * represent is known from the start (he_writer_warnings). After he_writer_new nothing can fail. */
#ifndef HE_FORMAT_IO_FORMAT_H
#define HE_FORMAT_IO_FORMAT_H

#include "build/build.h"
#include "format/io/beside.h"
#include "format/io/source_map.h"
#include "format/text/warnings.h"

typedef struct he_import {
    he_soup soup;
    he_warnings warnings;
    he_source_map vertices, faces;
    double edges;        /* number of edges that the file declares, if edges_line is not 0 */
    uint64_t edges_line; /* line that declares the number of edges, 0 if none does */
    /* The files that came together with the file being read; NULL if there are none. */
    he_beside *beside;
} he_import;

void he_import_clear(he_import *import);
/* Adds the place in the input (a line or a byte) to an error that names a vertex or face, such as
 * an error of he_build. */
void he_import_locate(const he_import *import, he_error *err);

/* The functions of a format's reader. `open` makes the reader's `state`, which the other
 * functions get. `into` is the import that the reader fills; it outlives `state`. After a call
 * has failed, only `close` is called. */
typedef struct he_reading {
    he_status (*open)(he_import *into, void **state, he_error *err);
    he_status (*feed)(void *state, const void *bytes, size_t n, he_error *err);
    he_status (*finish)(void *state, he_error *err);
    void (*close)(void *state);
    bool at_end; /* true if `feed` only stores the bytes; `finish` then parses them and reports to
                  * the soup's `progress` */
} he_reading;

/* The functions of a format's writer (he_writing). `step` writes the next bytes at `*p`, where
 * at least HE_WRITE_ROOM bytes are free up to `end`, and advances `*p`. It returns false after
 * the last bytes. */
enum { HE_WRITE_ROOM = 512 };

typedef struct he_writing {
    he_status (*open)(const he_mesh *mesh, size_t encoding, he_progress *progress,
                      he_warnings *warnings, void **state, he_error *err);
    bool (*step)(void *state, char **p, const char *end);
    void (*close)(void *state);
    /* Takes the next rows out of the document, at most `rows`, so that another thread can write
     * them: `piece`, which has room for `state_bytes` bytes, becomes a state that writes these rows
     * and no others, and `state` goes on after them. The piece uses the memory of `state`, and is
     * not closed. Returns false, and changes nothing, if no row begins where the document stands.
     * NULL if the writer cannot do so. */
    bool (*cut)(void *state, void *piece, uint32_t rows);
    size_t state_bytes; /* size of the struct to which `state` points */
    bool cuts; /* true if the writer cuts polygons into triangles (export_triangles.h); the caller
                * may then first fill the mesh's cache of long faces (long_faces.h) */
} he_writing;

typedef struct he_format {
    const char *name;
    const char *doc;
    const char *const
        /* Media types of the format, of which exports get the first; NULL ends this list and the
         * lists below. */
        *media_types;
    const char *const *extensions;
    const char *const *encodings; /* encodings of the writer, the default first */
    const char *const *carries;   /* what a file preserves, such as "polygons" or "face color" */
    /* Returns true if `bytes` could be the first bytes of a file in this format. */
    bool (*sniff)(const char *bytes, size_t n);
    const he_reading *reading; /* the format's reader; NULL: the format cannot be read */
    const he_writing *writing; /* the format's writer; NULL: the format cannot be written */
} he_format;

/* Returns the i-th format of the table; NULL after the last. A file of unknown format is tested
 * for each format in this order. */
const he_format *he_format_at(size_t i);
/* These functions find a format by its name, media type, file extension or first bytes, and return
 * NULL if there is none. A media type may be followed by parameters. Letter case does not matter,
 * except in a name; an extension has no dot. */
const he_format *he_format_find(const char *name);
const he_format *he_format_of_media_type(const char *type);
const he_format *he_format_of_extension(const char *extension);
const he_format *he_format_sniff(const void *bytes, size_t n);
/* Returns the index of an encoding in the format's list of encodings, or -1 if the list does not
 * have it. */
int he_format_encoding(const he_format *format, const char *encoding);

typedef struct he_reader he_reader;

/* Makes a reader for a format. `limits` may be NULL.
 * Returns HE_UNSUPPORTED if the format cannot be read.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_reader_new(const he_format *format, const he_limits *limits,
                                     he_reader **out, he_error *err);
void he_reader_free(he_reader *reader);
/* Feeds a piece of the input to a reader. Errors of the input name a line or byte. After a failure
 * every further call fails with the same error.
 * Returns HE_SYNTAX, HE_BAD_INDEX, HE_BAD_VALUE, HE_NOT_FINITE or HE_UNSUPPORTED if the input is
 * not valid.
 * Returns HE_LIMIT if a limit would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_reader_feed(he_reader *reader, const void *bytes, size_t n,
                                      he_error *err);
/* Sets the files that came together with the input, before he_reader_finish is called; they must
 * stay as long as the reader. For each file that the input does not name, a warning `ignored_file`
 * is added. `beside` may be NULL. */
void he_reader_beside(he_reader *reader, he_beside *beside);
/* Returns true if he_reader_finish takes about as long as feeding the bytes. The caller should then
 * set a callback for progress with he_reader_set_progress. */
bool he_reader_reads_at_end(const he_reader *reader);
void he_reader_set_progress(he_reader *reader, he_progress *progress);
/* Ends the input and gets the import, which the caller clears; after this the reader can only be
 * freed. Returns the errors of he_reader_feed, too.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_reader_finish(he_reader *reader, he_import *out, he_error *err);

typedef struct he_writer he_writer;

/* Makes a writer of a mesh in a format. `encoding` is an index into the format's list of encodings.
 * The call takes time linear in the mesh, and reports progress to `progress`, which may be NULL. If
 * `progress` lends threads, they must be there as long as the writer: he_writer_read then writes
 * large meshes on several threads. The file is the same, byte by byte.
 * Returns HE_UNSUPPORTED if the format cannot be written.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_writer_new(const he_format *format, const he_mesh *mesh, size_t encoding,
                                     he_progress *progress, he_writer **out, he_error *err);
void he_writer_free(he_writer *writer);
/* Writes the next bytes of the file, at most `size`. Returns their number; 0 at the end. */
size_t he_writer_read(he_writer *writer, void *buffer, size_t size);
/* Returns the warnings about parts of the mesh that the file cannot represent. */
const he_warnings *he_writer_warnings(const he_writer *writer);

#endif
