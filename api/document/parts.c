#include "api/document/parts.h"

#include "api/header/multipart.h"
#include "api/request/idempotency.h"

#include <string.h>

/* How many of the first bytes of a file are enough to recognise its format. */
enum { SNIFF_BYTES = 512 };

typedef struct part {
    char *name;
    api_part_kind kind; /* how to read the file, as far as its name or its media type says */
    /* The content of the file. It is empty if the file was known to be the mesh file when it began,
     * because its bytes were passed on. */
    api_text bytes;
} part;

struct api_parts {
    api_multipart *multipart;
    const char *wanted; /* the value of ?format=, or NULL */
    part parts[API_MAX_PARTS];
    size_t count;
    size_t candidates; /* how many files could be the mesh file */
    part *mesh;        /* the first file that could be the mesh file */
    he_beside_file files[API_MAX_PARTS];
    he_beside beside;
};

api_parts *api_parts_new(api_exchange *x)
{
    api_parts *p = he_mem_zero(1, sizeof *p);
    if (p == NULL) {
        api_fail_memory(x);
        return NULL;
    }
    p->wanted = api_param_text(x, "format");
    p->multipart = api_multipart_new(x->request.headers[API_HEADER_CONTENT_TYPE], &x->problem);
    if (p->multipart == NULL) {
        api_parts_free(p);
        return NULL;
    }
    return p;
}

void api_parts_free(api_parts *p)
{
    if (p == NULL) {
        return;
    }
    for (size_t i = 0; i < p->count; i++) {
        he_mem_free(p->parts[i].name);
        api_text_clear(&p->parts[i].bytes);
    }
    api_multipart_free(p->multipart);
    he_mem_free(p);
}

/* --- choosing the mesh file --- */

static const char *extension_of(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot == NULL || strpbrk(dot, "/\\") != NULL ? "" : dot + 1;
}

static api_part_kind kind_of(const char *name, const char *type)
{
    const char *extension = extension_of(name);
    const he_format *format = he_format_of_extension(extension);
    bool json = api_equal_nocase(extension, "json");
    if (format == NULL && !json && type != NULL) {
        format = he_format_of_media_type(type);
        json = format == NULL && api_media_is(type, "application/json");
    }
    return (api_part_kind){json || (format != NULL && format->reading != NULL), format};
}

static api_part_kind kind_of_bytes(const api_text *bytes)
{
    size_t length = bytes->length < SNIFF_BYTES ? bytes->length : (size_t)SNIFF_BYTES;
    const he_format *format = length == 0 ? NULL : he_format_sniff(bytes->bytes, length);
    size_t blank = 0;
    while (blank < length && strchr(" \t\r\n", bytes->bytes[blank]) != NULL) {
        blank++;
    }
    bool json = format == NULL && blank < length && bytes->bytes[blank] == '{';
    return (api_part_kind){json || (format != NULL && format->reading != NULL), format};
}

static bool is_wanted(const api_parts *p, const api_part_kind *kind)
{
    return kind->is_mesh &&
           (p->wanted == NULL ||
            strcmp(kind->format == NULL ? "json" : kind->format->name, p->wanted) == 0);
}

static bool refuse(api_exchange *x, const api_parts *p)
{
    char names[256];
    he_beside_file files[API_MAX_PARTS];
    he_beside listed = {files, 0};
    for (size_t i = 0; i < p->count; i++) {
        if (p->candidates == 0 || is_wanted(p, &p->parts[i].kind)) {
            files[listed.count++] = (he_beside_file){.name = p->parts[i].name};
        }
    }
    he_beside_list(&listed, names, sizeof names);
    if (p->candidates > 0) {
        return api_fail(x, API_UNCLEAR_PARTS,
                        "each of these files could be the mesh: %s; send only one of them, or "
                        "choose with ?format=",
                        names);
    }
    return api_fail(
        x, API_UNCLEAR_PARTS,
        "none of the files is %s%s, judging by their names, media types and first bytes: %s",
        p->wanted == NULL ? "in a format that the server reads" : "in the format ",
        p->wanted == NULL ? "" : p->wanted, names);
}

/* Returns true for a file that belongs to another file and is no mesh itself, such as a texture. */
static bool is_companion(const char *name)
{
    const char *extension = extension_of(name);
    return api_equal_nocase(extension, "bin") || api_equal_nocase(extension, "mtl");
}

/* Finds the mesh file by the first bytes of the files. It is called if no file's name or media type
 * shows that it is a mesh file. */
static void look_inside(api_parts *p)
{
    for (size_t i = 0; i < p->count; i++) {
        part *one = &p->parts[i];
        one->kind = kind_of_bytes(&one->bytes);
        if (p->count == 1 && p->wanted != NULL) {
            one->kind = (api_part_kind){true, he_format_find(p->wanted)};
        } else if (is_companion(one->name)) {
            one->kind.is_mesh = false;
        }
        if (is_wanted(p, &one->kind) && p->candidates++ == 0) {
            p->mesh = one;
        }
    }
}

/* --- reading the parts of the body --- */

static bool is_taken(const api_parts *p, const char *name)
{
    for (size_t i = 0; i < p->count; i++) {
        if (strcmp(p->parts[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

static void hash_text(api_exchange *x, const char *text)
{
    api_idempotency_add(x, text == NULL ? "" : text, text == NULL ? 1 : strlen(text) + 1);
}

static api_parts_step begin(api_exchange *x, api_parts *p, const api_part *head,
                            api_parts_piece *out)
{
    char quoted[HE_WARNING_SUBJECT];
    size_t length = strlen(head->name);
    if (is_taken(p, head->name)) {
        he_quote(head->name, head->name + length, quoted, sizeof quoted);
        api_fail(x, API_BAD_MULTIPART, "two files are named \"%s\"", quoted);
        return API_PARTS_BAD;
    }
    part *one = &p->parts[p->count];
    *one = (part){.name = he_mem_alloc(length + 1), .kind = kind_of(head->name, head->type)};
    if (one->name == NULL) {
        api_fail_memory(x);
        return API_PARTS_BAD;
    }
    p->count++;
    memcpy(one->name, head->name, length + 1);
    hash_text(x, head->name);
    hash_text(x, head->type);
    if (!is_wanted(p, &one->kind) || p->candidates++ > 0) {
        return API_PARTS_MORE;
    }
    p->mesh = one;
    out->kind = one->kind;
    return API_PARTS_OPEN;
}

static api_parts_step take(api_exchange *x, api_parts *p, const char *bytes, size_t length,
                           api_parts_piece *out)
{
    part *one = &p->parts[p->count - 1];
    api_idempotency_add(x, bytes, length);
    if (one == p->mesh) {
        out->bytes = bytes;
        out->length = length;
        return API_PARTS_BYTES;
    }
    if (is_wanted(p, &one->kind)) {
        /* This is a second mesh file: the body will be refused, but only when all of it was
         * read. */
        return API_PARTS_MORE;
    }
    api_text_add(&one->bytes, bytes, length);
    if (one->bytes.failed) {
        api_fail_memory(x);
        return API_PARTS_BAD;
    }
    return API_PARTS_MORE;
}

api_parts_step api_parts_next(api_exchange *x, api_parts *p, const char **at, const char *end,
                              api_parts_piece *out)
{
    api_parts_step step = API_PARTS_MORE;
    while (step == API_PARTS_MORE) {
        api_multipart_piece piece;
        switch (api_multipart_next(p->multipart, at, end, &piece, &x->problem)) {
        case API_MULTIPART_MORE:
            return API_PARTS_MORE;
        case API_MULTIPART_BEGIN:
            step = begin(x, p, &piece.part, out);
            break;
        case API_MULTIPART_BYTES:
            step = take(x, p, piece.bytes, piece.length, out);
            break;
        case API_MULTIPART_END:
            hash_text(x, "");
            break;
        case API_MULTIPART_BAD:
            return API_PARTS_BAD;
        }
    }
    return step;
}

bool api_parts_end(api_exchange *x, api_parts *p, api_parts_piece *out)
{
    *out = (api_parts_piece){.bytes = NULL};
    if (!api_multipart_end(p->multipart, &x->problem)) {
        return false;
    }
    if (p->candidates == 0) {
        look_inside(p);
        if (p->candidates == 1) {
            const api_text *bytes = &p->mesh->bytes;
            *out = (api_parts_piece){p->mesh->kind, bytes->bytes == NULL ? "" : bytes->bytes,
                                     bytes->length};
        }
    }
    if (p->candidates != 1) {
        return refuse(x, p);
    }
    p->beside = (he_beside){p->files, 0};
    for (size_t i = 0; i < p->count; i++) {
        const part *one = &p->parts[i];
        if (one != p->mesh) {
            p->files[p->beside.count++] =
                (he_beside_file){.name = one->name,
                                 .bytes = one->bytes.bytes == NULL ? "" : one->bytes.bytes,
                                 .length = one->bytes.length};
        }
    }
    return true;
}

he_beside *api_parts_beside(api_parts *p)
{
    return &p->beside;
}
