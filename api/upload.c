#include "api/upload.h"

#include "algo/shape.h"
#include "api/document_in.h"
#include "format/format.h"
#include "query/topology.h"

#include <string.h>

/* Enough to tell any format by. */
enum { SNIFF_BYTES = 512 };

/* Of the making of a mesh; what is left is its summary's. */
static const double SHAPE_SHARE = 0.2, BUILD_SHARE = 0.7;

typedef struct upload {
    he_limits limits;
    /* exactly one of these reads; neither while the first bytes are gathered */
    api_document_in *document;
    he_reader *reader;
    const he_format *format; /* of the reader */
    char head[SNIFF_BYTES];
    size_t head_length;

    bool has_import;
    he_import import;
    const he_shape *shape;
    double args[HE_SHAPE_PARAMS];
    const char *name;

    he_report report;
    uint64_t vertices, faces; /* as read */
    he_ids bowties;
} upload;

static void free_upload(void *state)
{
    upload *u = state;
    api_document_in_free(u->document);
    he_reader_free(u->reader);
    if (u->has_import) {
        he_import_clear(&u->import);
    }
    he_ids_clear(&u->bowties);
    he_mem_free(u);
}

static bool open_document(api_exchange *x, upload *u)
{
    u->document = api_document_in_new(&u->limits);
    return u->document != NULL || api_fail_memory(x);
}

static bool open_reader(api_exchange *x, upload *u, const he_format *format)
{
    he_error err = {0};
    u->format = format;
    return he_reader_new(format, &u->limits, &u->reader, &err) == HE_OK || api_fail_core(x, &err);
}

bool api_upload_begin(api_exchange *x)
{
    upload *u = he_mem_zero(1, sizeof *u);
    if (u == NULL) {
        return api_fail_memory(x);
    }
    x->state = u;
    x->free_state = free_upload;
    u->limits.bytes = 4 * x->service->options.max_upload;
    const char *name = api_param_text(x, "format");
    if (name == NULL && strcmp(x->media_in, "application/octet-stream") == 0) {
        return true; /* the first bytes will tell */
    }
    if (strcmp(name != NULL ? name : x->media_in, name != NULL ? "json" : "application/json") ==
        0) {
        return open_document(x, u);
    }
    const he_format *format =
        name != NULL ? he_format_find(name) : he_format_of_media_type(x->media_in);
    if (format == NULL || format->reading == NULL) {
        return api_fail(x, API_UNSUPPORTED_MEDIA_TYPE, "%s is not a format this server reads",
                        name != NULL ? name : x->media_in);
    }
    return open_reader(x, u, format);
}

static bool feed(api_exchange *x, upload *u, const char *bytes, size_t length)
{
    if (u->document != NULL) {
        return api_document_in_feed(u->document, bytes, length, &x->problem);
    }
    he_error err = {0};
    return he_reader_feed(u->reader, bytes, length, &err) == HE_OK || api_fail_core(x, &err);
}

/* Choose a reader by what has arrived, and let it read that. */
static bool choose(api_exchange *x, upload *u)
{
    size_t blank = 0;
    while (blank < u->head_length && strchr(" \t\r\n", u->head[blank]) != NULL) {
        blank++;
    }
    /* glTF is JSON too, with a member that our document has not */
    const he_format *gltf = he_format_find("gltf");
    bool json =
        blank < u->head_length && u->head[blank] == '{' && !gltf->sniff(u->head, u->head_length);
    const he_format *format = json ? NULL : he_format_sniff(u->head, u->head_length);
    if (!json && (format == NULL || format->reading == NULL)) {
        api_fail(x, API_UNSUPPORTED_MEDIA_TYPE,
                 "the first bytes are of no format this server reads: say ?format=");
        x->problem.supported = x->route->consumes;
        return false;
    }
    return (json ? open_document(x, u) : open_reader(x, u, format)) &&
           feed(x, u, u->head, u->head_length);
}

static bool is_open(const upload *u)
{
    return u->document != NULL || u->reader != NULL;
}

bool api_upload_feed(api_exchange *x, const char *bytes, size_t length)
{
    upload *u = x->state;
    if (!is_open(u)) {
        size_t room = sizeof u->head - u->head_length, take = length < room ? length : room;
        memcpy(u->head + u->head_length, bytes, take);
        u->head_length += take;
        if (u->head_length < sizeof u->head) {
            return true;
        }
        if (!choose(x, u)) {
            return false;
        }
        bytes += take;
        length -= take;
    }
    return length == 0 || feed(x, u, bytes, length);
}

/* {"shape":"cube","size":2,"name":"..."}: the members are the shape's parameters. */
static bool read_shape(upload *u, const api_in *rest, const api_in *shape)
{
    const char *name, *names[HE_SHAPE_PARAMS + 3] = {"shape", "name"};
    if (!api_in_string(shape, API_MAX_KEY, &name)) {
        return false;
    }
    u->shape = he_shape_find(name, strlen(name));
    if (u->shape == NULL) {
        return api_in_fail(shape, HE_BAD_VALUE, "there is no shape \"%s\"", name);
    }
    size_t count = he_shape_params(u->shape);
    for (size_t i = 0; i < count; i++) {
        names[2 + i] = u->shape->params[i].name;
    }
    if (!api_in_only(rest, names)) {
        return false;
    }
    he_shape_defaults(u->shape, u->args);
    for (size_t i = 0; i < count; i++) {
        const he_shape_param *param = &u->shape->params[i];
        api_in member;
        bool flag;
        if (!api_in_find(rest, param->name, &member)) {
            continue;
        }
        if (param->type == HE_SHAPE_FLAG) {
            if (!api_in_bool(&member, &flag)) {
                return false;
            }
            u->args[i] = flag;
        } else if (!api_in_number(&member, &u->args[i])) {
            return false;
        }
    }
    he_error err = {0};
    size_t at = 0;
    if (he_shape_check(u->shape, u->args, &at, &err) != HE_OK) {
        api_in member;
        if (api_in_find(rest, u->shape->params[at].name, &member)) {
            return api_in_fail(&member, err.status, "%s", err.text);
        }
        return api_in_fail(rest, err.status, "%s", err.text);
    }
    return true;
}

static bool end_document(upload *u)
{
    const api_in *rest = api_document_in_rest(u->document);
    api_in member;
    if (api_in_find(rest, "name", &member) && !api_in_is_null(&member) &&
        !api_in_string(&member, API_MESH_NAME, &u->name)) {
        return false;
    }
    if (!api_in_find(rest, "shape", &member)) {
        return api_in_only(rest, (const char *const[]){"name", NULL});
    }
    if (api_document_in_has_vertices(u->document) || api_document_in_has_faces(u->document)) {
        return api_in_fail(&member, API_CONFLICTING_MEMBERS,
                           "a shape makes its own vertices and faces: give either");
    }
    return read_shape(u, rest, &member);
}

bool api_upload_end(api_exchange *x)
{
    upload *u = x->state;
    u->name = api_param_text(x, "name");
    if (!is_open(u) && !choose(x, u)) {
        return false;
    }
    if (u->document != NULL) {
        return api_document_in_end(u->document, &x->problem) && end_document(u);
    }
    he_error err = {0};
    if (he_reader_finish(u->reader, &u->import, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    u->has_import = true;
    return true;
}

static he_soup *soup_of(upload *u)
{
    return u->document != NULL ? api_document_in_soup(u->document) : &u->import.soup;
}

uint64_t api_upload_elements(const api_exchange *x)
{
    upload *u = x->state;
    if (u->shape != NULL) {
        he_shape_size size = u->shape->size(u->args);
        return size.vertices + size.corners;
    }
    const he_soup *soup = soup_of(u);
    return soup->vertex_count + soup->corner_count;
}

const char *api_upload_name(const api_exchange *x)
{
    const upload *u = x->state;
    return u->name;
}

static bool refuse(api_exchange *x, upload *u, he_error *err)
{
    if (u->document == NULL) {
        he_import_locate(&u->import, err);
    }
    api_fail_core(x, err);
    if (u->report.total > 0) {
        x->problem.report = &u->report;
        x->problem.report_pointers = u->document != NULL;
        if (u->document != NULL) {
            char pointer[API_DEFECT_POINTER];
            api_defect_pointer(&u->report.defects[0], pointer);
            api_problem_set_pointer(&x->problem, "%s", pointer);
        }
    }
    return false;
}

bool api_upload_build(api_exchange *x, he_mesh **out)
{
    upload *u = x->state;
    he_soup made, *soup = soup_of(u);
    he_error err = {0};
    he_mesh *mesh = NULL;
    u->limits.watch = x->watch;
    if (u->shape != NULL) {
        he_watch_span(x->watch, SHAPE_SHARE);
        if (he_shape_make(u->shape, u->args, &u->limits, &made, &err) != HE_OK) {
            return api_fail_core(x, &err);
        }
        soup = &made;
    }
    soup->limits.watch = x->watch;
    u->vertices = soup->vertex_count;
    u->faces = soup->face_count;
    he_watch_span(x->watch, BUILD_SHARE);
    he_status status = he_build(soup, HE_BUILD_TAKE, &mesh, &u->report, &err);
    if (soup == &made) {
        he_soup_clear(&made);
    }
    if (status != HE_OK) {
        return refuse(x, u, &err);
    }
    if (u->document != NULL && !api_document_in_attributes(u->document, mesh, &x->problem)) {
        he_mesh_free(mesh);
        return false;
    }
    if (he_bowties_find(mesh, &u->bowties, &err) != HE_OK) {
        he_mesh_free(mesh);
        return api_fail_core(x, &err);
    }
    *out = mesh;
    return true;
}

static void write_note(api_out *out, const he_note *note)
{
    char text[HE_ERROR_TEXT];
    he_note_text(note, text, sizeof text);
    api_out_object_begin(out);
    api_out_key_string(out, "code", note->code);
    api_out_key_string(out, "detail", text);
    api_out_key_u64(out, "count", note->count);
    if (note->place != HE_PLACE_NONE) {
        api_out_key_u64(out, note->place == HE_PLACE_LINE ? "line" : "byte", note->at);
    }
    api_out_object_end(out);
}

static void write_bowties(api_out *out, const he_ids *bowties)
{
    size_t named =
        bowties->count < API_PROBLEM_ELEMENTS ? bowties->count : (size_t)API_PROBLEM_ELEMENTS;
    api_out_object_begin(out);
    api_out_key_string(out, "code", "bowtie");
    api_out_key_string(out, "detail", "fans of faces meet at a vertex without sharing an edge");
    api_out_key_u64(out, "count", bowties->count);
    api_out_key_ids(out, "vertices", bowties->ids, named);
    api_out_object_end(out);
}

void api_upload_write_report(api_exchange *x)
{
    const upload *u = x->state;
    api_out *out = &x->out;
    api_out_key(out, "import");
    api_out_object_begin(out);
    api_out_key_string(out, "format",
                       u->format != NULL  ? u->format->name
                       : u->shape != NULL ? "shape"
                                          : "json");
    api_out_key_u64(out, "vertices", u->vertices);
    api_out_key_u64(out, "faces", u->faces);
    api_out_key(out, "repairs");
    api_out_array_begin(out);
    api_out_array_end(out);
    api_out_key(out, "warnings");
    api_out_array_begin(out);
    for (size_t i = 0; u->has_import && i < u->import.notes.count; i++) {
        write_note(out, &u->import.notes.items[i]);
    }
    if (u->bowties.count > 0) {
        write_bowties(out, &u->bowties);
    }
    api_out_array_end(out);
    if (u->has_import && u->import.notes.more > 0) {
        api_out_key_u64(out, "more_warnings", u->import.notes.more);
    }
    api_out_object_end(out);
}
