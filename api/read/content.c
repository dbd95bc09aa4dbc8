/* content.c - GET .../content: answers with a mesh as a file or a JSON document, which is made from
 * a snapshot while it is sent. */
#include "api/request/handlers.h"

#include "api/document/document_out.h"
#include "api/request/mesh_access.h"
#include "format/io/format.h"
#include "format/obj/mtl.h"
#include "geometry/long_faces_keep.h"

#include <stdio.h>
#include <string.h>

/* The writer of the answer: `writer` for a file format, or `document` for a JSON document. It is
 * freed with the exchange. */
typedef struct content {
    he_writer *writer;
    api_document_out *document;
} content;

static void free_content(void *stream)
{
    content *c = stream;
    he_writer_free(c->writer);
    api_document_out_free(c->document);
    he_mem_free(c);
}

static int64_t read_content(void *stream, char *buffer, size_t size)
{
    content *c = stream;
    return c->document != NULL ? api_document_out_read(c->document, buffer, size)
                               : (int64_t)he_writer_read(c->writer, buffer, size);
}

static bool find_encoding(api_exchange *x, const he_format *format, const char *what,
                          const char *name, size_t *encoding)
{
    int found = format == NULL ? -1 : he_format_encoding(format, name);
    if (found < 0) {
        return api_fail(x, API_BAD_PARAMETER, "%s has no %s \"%s\"",
                        format == NULL ? "json" : format->name, what, name);
    }
    *encoding = (size_t)found;
    return true;
}

/* Finds the index of the encoding that ?encoding= or ?compress= names: a compressed form is listed
 * as an encoding of its own. */
static bool choose_encoding(api_exchange *x, const he_format *format, size_t *encoding)
{
    const char *name = api_param_text(x, "encoding"), *packed = api_param_text(x, "compress");
    *encoding = 0;
    return (name == NULL || find_encoding(x, format, "encoding", name, encoding)) &&
           (packed == NULL || find_encoding(x, format, "compression", packed, encoding));
}

/* Finds the format that the client wants; `*format` is NULL for a JSON document. Returns false if
 * the client accepts none. */
static bool choose(api_exchange *x, const he_format **format)
{
    const char *name = api_param_text(x, "format");
    if (name == NULL) {
        int offer = api_media_choose(x->request.headers[API_HEADER_ACCEPT], x->route->produces);
        if (offer < 0) {
            return api_fail_accept(x);
        }
        name = x->route->produces[offer];
        *format = he_format_of_media_type(name);
        return true;
    }
    *format = he_format_find(name);
    if (strcmp(name, "json") != 0 && (*format == NULL || (*format)->writing == NULL)) {
        return api_fail(x, API_BAD_PARAMETER, "\"%s\" is not a format this server writes", name);
    }
    return true;
}

/* The maximum size of the header that lists warnings, and of the words "and N more" at its end. The
 * size allows for reverse proxies that have 4 KiB for all headers of an answer, as nginx by
 * default. */
enum { MOST_WARNINGS = 2000, MORE_WARNINGS = 40 };

/* Adds a header that lists what the file format cannot represent, so that the client knows what is
 * lost. */
static void answer_losses(api_exchange *x, const he_warnings *warnings)
{
    char list[MOST_WARNINGS + 1] = "", text[HE_WARNING_TEXT];
    size_t length = 0, said = 0;
    for (; said < warnings->count; said++) {
        size_t size = he_warning_text(&warnings->items[said], text, sizeof text);
        if (length + strlen("; ") + size + MORE_WARNINGS > MOST_WARNINGS) {
            break;
        }
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%s",
                                   said > 0 ? "; " : "", text);
    }
    uint64_t left = warnings->count - said + warnings->more;
    if (left > 0) {
        snprintf(list + length, sizeof list - length, "; and %llu more", (unsigned long long)left);
    }
    if (warnings->count > 0) {
        api_answer_header(x, "Export-Warnings", list);
    }
}

enum { REPRESENTATION = 40 };

/* The format and encoding that the client wants. */
typedef struct choice {
    const he_format *format; /* NULL: the JSON document */
    size_t encoding;
    char representation[REPRESENTATION];
} choice;

bool api_content_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    choice *c = api_arena_array(&x->arena, 1, sizeof *c);
    if (c == NULL) {
        return api_fail_memory(x);
    }
    *c = (choice){.format = NULL};
    if (!choose(x, &c->format) || !choose_encoding(x, c->format, &c->encoding)) {
        return false;
    }
    snprintf(c->representation, sizeof c->representation, "%s%s%s",
             c->format == NULL ? "json" : c->format->name, c->encoding > 0 ? "_" : "",
             c->encoding > 0 ? c->format->encodings[c->encoding] : "");
    x->state = c;
    x->reading.tag = c->representation;
    return api_cost_of_mesh(x, mesh, out);
}

static bool begin(api_exchange *x, const choice *chosen, content *c)
{
    const he_format *format = chosen->format;
    he_error err = {0};
    if (format == NULL) {
        c->document = api_document_out_new(x->content, x->info.name);
        return c->document != NULL || api_fail_memory(x);
    }
    /* If the request runs as a job, preparing the writer takes about half of the time. */
    he_progress_span(&x->progress, 0.5);
    bool long_faces = format->writing != NULL && format->writing->cuts;
    if ((long_faces && he_long_faces_keep(x->content, &x->progress, &err) != HE_OK) ||
        he_writer_new(format, x->content, chosen->encoding, &x->progress, &c->writer, &err) !=
            HE_OK) {
        return api_fail_core(x, &err);
    }
    answer_losses(x, he_writer_warnings(c->writer));
    return true;
}

/* Returns true if a name is safe in a header, a shell and a file system. */
static bool is_plain(const char *name)
{
    size_t length =
        strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-");
    return name[length] == '\0' && length > 0 && length <= HE_BESIDE_NAME && name[0] != '.';
}

/* Suggests a file name to the client. A material library (format mtl) gets the name by which the
 * mesh's OBJ file refers to it. */
static void name_file(api_exchange *x, const he_format *format)
{
    const char *names[HE_COLUMN_COMPONENTS];
    /* Range requests are not supported: a file is made while it is sent, so a part of it would cost
     * as much as the whole. */
    api_answer_header(x, "Accept-Ranges", "none");
    bool library = format != NULL && strcmp(format->name, "mtl") == 0;
    if (library && he_mtl_names(x->content, names) > 0 && is_plain(names[0])) {
        api_answer_header_format(x, "Content-Disposition", "inline; filename=\"%s\"", names[0]);
        return;
    }
    api_answer_header_format(x, "Content-Disposition", "inline; filename=\"%s.%s\"", x->info.id,
                             format == NULL ? "json" : format->extensions[0]);
}

void api_content_get(api_exchange *x)
{
    const choice *chosen = x->state;
    const he_format *format = chosen->format;
    content *c = he_mem_zero(1, sizeof *c);
    if (c == NULL) {
        api_fail_memory(x);
        return;
    }
    if (!api_keep_mesh(x) || !begin(x, chosen, c)) {
        free_content(c);
        return;
    }
    name_file(x, format);
    const api_stream stream = {-1, read_content, c, free_content};
    api_answer_stream(x, 200, format == NULL ? "application/json" : format->media_types[0],
                      &stream);
}
