#include "format/io/format.h"

#include "format/gltf/gltf.h"
#include "format/io/pieces.h"
#include "format/obj/mtl.h"
#include "format/obj/obj.h"
#include "format/off/off.h"
#include "format/ply/ply.h"
#include "format/stl/stl.h"

#include <string.h>

#define LIST(...) ((const char *const[]){__VA_ARGS__, NULL})

static const he_format formats[] = {
    {
        .name = "glb",
        .doc = "glTF 2.0 in its binary container; its buffers are inside the file or in files that "
               "come with it",
        .media_types = LIST("model/gltf-binary"),
        .extensions = LIST("glb"),
        .encodings = LIST("binary", "meshopt"),
        .carries = LIST("triangles", "polygons in extras", "isolated vertices", "vertex attributes",
                        "halfedge normal", "halfedge tangent", "halfedge uv", "halfedge color",
                        "face object", "face group", "face material", "materials",
                        "face attributes in extras", "halfedge attributes in extras"),
        .sniff = he_glb_sniff,
        .reading = &he_glb_reading,
        .writing = &he_glb_writing,
    },
    {
        .name = "gltf",
        .doc = "glTF 2.0 as JSON; its buffers are in data: URIs or in files that come with it",
        .media_types = LIST("model/gltf+json"),
        .extensions = LIST("gltf"),
        .encodings = LIST("ascii"),
        .carries = LIST("triangles"),
        .sniff = he_gltf_sniff,
        .reading = &he_gltf_reading,
    },
    {
        .name = "off",
        .doc = "Object File Format (OFF) with any of the prefixes ST, C and N; the form BINARY is "
               "only read",
        .media_types = LIST("model/x-off", "text/x-off", "application/x-off"),
        .extensions = LIST("off"),
        .encodings = LIST("ascii"),
        .carries = LIST("polygons", "isolated vertices", "vertex color", "vertex normal",
                        "vertex uv", "face color"),
        .sniff = he_off_sniff,
        .reading = &he_off_reading,
        .writing = &he_off_writing,
    },
    {
        .name = "ply",
        .doc = "Polygon File Format (Stanford); written as binary little-endian unless the request "
               "asks for another encoding",
        .media_types = LIST("model/ply", "application/ply"),
        .extensions = LIST("ply"),
        .encodings = LIST("binary", "ascii", "binary_big_endian"),
        .carries = LIST("polygons", "isolated vertices", "vertex color", "vertex normal",
                        "vertex uv", "halfedge color", "halfedge normal", "halfedge uv",
                        "face color", "face normal", "face uv",
                        "vertex attributes of one component", "face attributes of one component"),
        .sniff = he_ply_sniff,
        .reading = &he_ply_reading,
        .writing = &he_ply_writing,
    },
    {
        .name = "stl",
        .doc = "Triangles for stereolithography; corners at equal positions become one vertex",
        .media_types = LIST("model/stl", "application/sla", "application/vnd.ms-pki.stl"),
        .extensions = LIST("stl"),
        .encodings = LIST("binary", "ascii"),
        .carries = LIST("triangles"),
        .sniff = he_stl_sniff,
        .reading = &he_stl_reading,
        .writing = &he_stl_writing,
    },
    {
        .name = "obj",
        .doc =
            "Wavefront OBJ, polygons only; the materials are in a separate file of the format mtl",
        .media_types = LIST("model/obj", "text/x-obj"),
        .extensions = LIST("obj"),
        .encodings = LIST("ascii"),
        .carries = LIST("polygons", "isolated vertices", "vertex color", "vertex normal",
                        "vertex uv", "halfedge normal", "halfedge uv", "face object", "face group",
                        "face material", "face smoothing"),
        .sniff = he_obj_sniff,
        .reading = &he_obj_reading,
        .writing = &he_obj_writing,
    },
    {
        .name = "mtl",
        .doc = "Material library of Wavefront OBJ; it is read only together with its OBJ file",
        .media_types = LIST("model/mtl"),
        .extensions = LIST("mtl"),
        .encodings = LIST("ascii"),
        .carries = LIST("materials"),
        .sniff = he_mtl_sniff,
        .writing = &he_mtl_writing,
    },
};

const he_format *he_format_at(size_t i)
{
    return i < sizeof formats / sizeof *formats ? &formats[i] : NULL;
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + ('a' - 'A')) : c;
}

/* Returns true if `text`, without the parameters that may follow a media type, is `word`. Letter
 * case does not matter. */
static bool same_word(const char *word, const char *text)
{
    while (*word != '\0' && lower(*text) == *word) {
        word++;
        text++;
    }
    while (*text == ' ' || *text == '\t') {
        text++;
    }
    return *word == '\0' && (*text == '\0' || *text == ';');
}

static int position(const char *const *list, const char *text)
{
    for (int i = 0; list[i] != NULL; i++) {
        if (same_word(list[i], text)) {
            return i;
        }
    }
    return -1;
}

const he_format *he_format_find(const char *name)
{
    const he_format *format;
    for (size_t i = 0; (format = he_format_at(i)) != NULL; i++) {
        if (strcmp(format->name, name) == 0) {
            return format;
        }
    }
    return NULL;
}

const he_format *he_format_of_media_type(const char *type)
{
    const he_format *format;
    for (size_t i = 0; (format = he_format_at(i)) != NULL; i++) {
        if (position(format->media_types, type) >= 0) {
            return format;
        }
    }
    return NULL;
}

const he_format *he_format_of_extension(const char *extension)
{
    const he_format *format;
    for (size_t i = 0; (format = he_format_at(i)) != NULL; i++) {
        if (position(format->extensions, extension) >= 0) {
            return format;
        }
    }
    return NULL;
}

const he_format *he_format_sniff(const void *bytes, size_t n)
{
    const he_format *format;
    for (size_t i = 0; (format = he_format_at(i)) != NULL; i++) {
        if (format->sniff(bytes, n)) {
            return format;
        }
    }
    return NULL;
}

int he_format_encoding(const he_format *format, const char *encoding)
{
    return position(format->encodings, encoding);
}

void he_import_clear(he_import *import)
{
    he_soup_clear(&import->soup);
    he_source_map_clear(&import->vertices);
    he_source_map_clear(&import->faces);
    import->warnings = (he_warnings){0};
}

void he_import_locate(const he_import *import, he_error *err)
{
    const he_source_map *map = NULL;
    if (err->place != HE_PLACE_NONE) {
        return;
    }
    if (err->kind == HE_VERTEX) {
        map = &import->vertices;
    } else if (err->kind == HE_FACE) {
        map = &import->faces;
    }
    if (map != NULL && map->count > 0) {
        err->place = map->unit;
        err->at = he_source_map_find(map, err->id);
    }
}

struct he_reader {
    const he_reading *reading;
    void *state;
    he_import import;
    he_error failure; /* the error of the first call that failed; its status is HE_OK if none has
                         failed */
};

he_status he_reader_new(const he_format *format, const he_limits *limits, he_reader **out,
                        he_error *err)
{
    if (format->reading == NULL) {
        return he_fail_plain(err, HE_UNSUPPORTED, "%s files cannot be read", format->name);
    }
    he_reader *reader = he_mem_zero(1, sizeof *reader);
    if (reader == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read the file");
    }
    he_soup_init(&reader->import.soup, limits);
    reader->reading = format->reading;
    he_status status = reader->reading->open(&reader->import, &reader->state, err);
    if (status != HE_OK) {
        he_mem_free(reader);
        return status;
    }
    *out = reader;
    return HE_OK;
}

void he_reader_free(he_reader *reader)
{
    if (reader != NULL) {
        if (reader->state != NULL) {
            reader->reading->close(reader->state);
        }
        he_import_clear(&reader->import);
        he_mem_free(reader);
    }
}

/* Returns `status`. If that is a failure, stores the error, so that all later calls of the reader
 * return it. */
static he_status settle(he_reader *reader, he_status status, const he_error *failure, he_error *err)
{
    if (status != HE_OK) {
        reader->failure = *failure;
        if (err != NULL) {
            *err = *failure;
        }
    }
    return status;
}

he_status he_reader_feed(he_reader *reader, const void *bytes, size_t n, he_error *err)
{
    he_error failure = reader->failure;
    he_status status = failure.status;
    if (status == HE_OK && n > 0) {
        status = reader->reading->feed(reader->state, bytes, n, &failure);
    }
    return settle(reader, status, &failure, err);
}

void he_reader_beside(he_reader *reader, he_beside *beside)
{
    reader->import.beside = beside;
}

static void note_unused(he_import *import)
{
    const he_beside *beside = import->beside;
    for (size_t i = 0; beside != NULL && i < beside->count; i++) {
        const he_beside_file *file = &beside->files[i];
        if (!file->used) {
            he_warnings_add(
                &import->warnings,
                &(he_occurrence){
                    .code = "ignored_file",
                    .text = "file % is ignored, because no other file of the request refers to it",
                    .subject = file->name,
                    .length = strlen(file->name)});
        }
    }
}

bool he_reader_reads_at_end(const he_reader *reader)
{
    return reader->reading->at_end;
}

void he_reader_set_progress(he_reader *reader, he_progress *progress)
{
    reader->import.soup.limits.progress = progress;
}

he_status he_reader_finish(he_reader *reader, he_import *out, he_error *err)
{
    he_error failure = reader->failure;
    he_status status = failure.status;
    if (status == HE_OK) {
        status = reader->reading->finish(reader->state, &failure);
    }
    if (status == HE_OK) {
        note_unused(&reader->import);
        reader->import.beside = NULL;
        *out = reader->import;
        reader->import = (he_import){0};
        /* The state of the format's reader is freed before the mesh is built, to save memory. */
        reader->reading->close(reader->state);
        reader->state = NULL;
    }
    return settle(reader, status, &failure, err);
}

struct he_writer {
    const he_writing *writing;
    void *state;
    he_pieces *pieces; /* NULL if one thread writes the document */
    bool ended;
    he_warnings warnings;
    /* Bytes of the document that did not fit into the caller's last buffer; the next call returns
     * them first. */
    size_t spare_from, spare_to;
    char spare[HE_WRITE_ROOM];
};

he_status he_writer_new(const he_format *format, const he_mesh *mesh, size_t encoding,
                        he_progress *progress, he_writer **out, he_error *err)
{
    if (format->writing == NULL) {
        return he_fail_plain(err, HE_UNSUPPORTED, "%s files cannot be written", format->name);
    }
    he_writer *writer = he_mem_zero(1, sizeof *writer);
    if (writer == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to write the file");
    }
    writer->writing = format->writing;
    he_status status =
        writer->writing->open(mesh, encoding, progress, &writer->warnings, &writer->state, err);
    if (status != HE_OK) {
        he_mem_free(writer);
        return status;
    }
    writer->pieces = he_pieces_new(writer->writing, mesh, progress);
    *out = writer;
    return HE_OK;
}

void he_writer_free(he_writer *writer)
{
    if (writer != NULL) {
        he_pieces_free(writer->pieces);
        writer->writing->close(writer->state);
        he_mem_free(writer);
    }
}

/* Writes the next bytes of the document into the buffer. Returns 0 only at the end of the
 * document. */
static size_t fill(he_writer *writer, char *buffer, size_t room)
{
    char *p = buffer, *end = buffer + room;
    while (!writer->ended && end - p >= HE_WRITE_ROOM) {
        if (!he_pieces_write(writer->pieces, writer->state, &p, end)) {
            /* With pieces, a step is short, so that it soon comes to the beginning of a row. */
            const char *stop = writer->pieces != NULL ? p + HE_WRITE_ROOM : end;
            writer->ended = !writer->writing->step(writer->state, &p, stop);
        }
    }
    return (size_t)(p - buffer);
}

size_t he_writer_read(he_writer *writer, void *buffer, size_t size)
{
    char *bytes = buffer;
    size_t done = 0;
    while (done < size) {
        size_t spare = writer->spare_to - writer->spare_from;
        if (spare > 0) {
            size_t n = spare < size - done ? spare : size - done;
            memcpy(bytes + done, writer->spare + writer->spare_from, n);
            writer->spare_from += n;
            done += n;
        } else if (size - done >= HE_WRITE_ROOM) {
            size_t n = fill(writer, bytes + done, size - done);
            if (n == 0) {
                break;
            }
            done += n;
        } else {
            writer->spare_from = 0;
            writer->spare_to = fill(writer, writer->spare, sizeof writer->spare);
            if (writer->spare_to == 0) {
                break;
            }
        }
    }
    return done;
}

const he_warnings *he_writer_warnings(const he_writer *writer)
{
    return &writer->warnings;
}
