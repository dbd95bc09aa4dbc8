#include "api/document/upload.h"

#include "algo/shape.h"
#include "api/document/document_in.h"
#include "api/document/parts.h"
#include "api/document/repairs.h"
#include "api/json/attribute_value.h"
#include "api/json/known_names.h"
#include "api/request/admit.h"
#include "format/io/foreign.h"
#include "format/io/format.h"
#include "mesh/walk.h"
#include "query/open_seams.h"
#include "query/topology.h"

#include <stdio.h>
#include <string.h>

/* How many of the first bytes of a file are enough to recognise its format. */
enum { SNIFF_BYTES = 512 };

/* A guess of how many bytes a file has for each vertex or corner; used only to estimate time. */
enum { ELEMENT_BYTES = 5 };

/* The progress (0 to 1) that is reached after each step of making a mesh. After FILL_SHARE, only
 * the summary remains to be computed. */
static const double READ_SHARE = 0.2, SHAPE_SHARE = 0.2, REPAIR_SHARE = 0.45, BUILD_SHARE = 0.7,
                    FILL_SHARE = 0.75;

typedef struct attribute {
    he_kind domain;
    char name[HE_COLUMN_NAME];
} attribute;

typedef struct upload {
    he_limits limits;
    /* The reader of the body is one of `document` and `reader`; both are NULL until the first bytes
     * have shown the format of the body. */
    api_document_in *document;
    he_reader *reader;
    const he_format *format; /* the format that `reader` reads */
    api_parts *parts;        /* reads a multipart body; NULL if the body is not multipart */
    char head[SNIFF_BYTES];  /* the first bytes of the body */
    size_t head_length;

    bool has_import;
    he_import import;
    const he_shape *shape;
    double args[HE_SHAPE_PARAMS];
    const char *name;

    he_report report;
    he_repair_plan plan;
    he_repaired repaired;
    size_t vertices, faces; /* numbers of vertices and faces that were read, before repairs */
    attribute *attributes;
    size_t attribute_count;
    he_ids bowties;
    uint64_t seams;      /* number of edges that would be joined by the repair weld */
    uint64_t isolated;   /* number of vertices without a face */
    he_ids isolated_ids; /* ids of the first vertices without a face */
} upload;

static void free_upload(void *state)
{
    upload *u = state;
    api_document_in_free(u->document);
    he_reader_free(u->reader);
    api_parts_free(u->parts);
    if (u->has_import) {
        he_import_clear(&u->import);
    }
    he_repaired_clear(&u->repaired);
    he_ids_clear(&u->bowties);
    he_ids_clear(&u->isolated_ids);
    he_mem_free(u->attributes);
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
    if (!api_repairs_read(x, &u->plan)) {
        return false;
    }
    if (strcmp(x->media_in, API_MULTIPART) == 0) {
        u->parts = api_parts_new(x);
        return u->parts != NULL;
    }
    const char *name = api_param_text(x, "format");
    if (name == NULL && strcmp(x->media_in, "application/octet-stream") == 0) {
        return true; /* the first bytes of the body will show the format */
    }
    if (strcmp(name != NULL ? name : x->media_in, name != NULL ? "json" : "application/json") ==
        0) {
        return open_document(x, u);
    }
    const he_format *format =
        name != NULL ? he_format_find(name) : he_format_of_media_type(x->media_in);
    if (format == NULL || format->reading == NULL) {
        char text[80];
        snprintf(text, sizeof text, "%s is not a format this server reads",
                 name != NULL ? name : x->media_in);
        return api_refuse_format(x, text);
    }
    return open_reader(x, u, format);
}

/* Refuses a file that its reader has refused. If the first bytes show something that is no mesh,
 * the message says only that, without a position; if they show another format, the message names
 * that format, too. (Text in UTF-16 is reported by the readers.) */
static bool fail_reading(api_exchange *x, const upload *u, he_error *err)
{
    const char *foreign = he_foreign_find(u->head, u->head_length);
    const he_format *looks = he_format_sniff(u->head, u->head_length);
    size_t length = strlen(err->text);
    bool unread = err->status == HE_SYNTAX || err->status == HE_BAD_VALUE ||
                  err->status == HE_NOT_FINITE || err->status == HE_LIMIT;
    if (foreign != NULL && unread) {
        snprintf(err->text, sizeof err->text, "the body is %s", foreign);
        err->status = HE_SYNTAX;
        err->place = HE_PLACE_NONE;
        err->kind = HE_KIND_COUNT;
    } else if (looks != NULL && looks != u->format) {
        snprintf(err->text + length, sizeof err->text - length,
                 "; the body looks like a file of the format %s", looks->name);
    }
    return api_fail_core(x, err);
}

static bool feed(api_exchange *x, upload *u, const char *bytes, size_t length)
{
    if (u->document != NULL) {
        return api_document_in_feed(u->document, bytes, length, &x->problem);
    }
    he_error err = {0};
    return he_reader_feed(u->reader, bytes, length, &err) == HE_OK || fail_reading(x, u, &err);
}

/* Chooses a reader by the first bytes of the body, which have arrived, and passes these bytes to
 * the reader. */
static bool choose(api_exchange *x, upload *u)
{
    size_t blank = 0;
    while (blank < u->head_length && strchr(" \t\r\n", u->head[blank]) != NULL) {
        blank++;
    }
    /* A glTF file is JSON, too, but has a member that mesh documents do not have. */
    const he_format *gltf = he_format_find("gltf");
    bool json =
        blank < u->head_length && u->head[blank] == '{' && !gltf->sniff(u->head, u->head_length);
    const char *foreign = he_foreign_find(u->head, u->head_length);
    const he_format *format =
        json || foreign != NULL ? NULL : he_format_sniff(u->head, u->head_length);
    if (foreign != NULL) {
        api_fail(x, API_UNSUPPORTED_MEDIA_TYPE, "the body is %s", foreign);
        x->problem.supported = x->route->consumes;
        return false;
    }
    if (!json && (format == NULL || format->reading == NULL)) {
        return api_refuse_format(
            x, "the format cannot be recognized from the first bytes; name it with ?format=");
    }
    return (json ? open_document(x, u) : open_reader(x, u, format)) &&
           feed(x, u, u->head, u->head_length);
}

static bool is_open(const upload *u)
{
    return u->document != NULL || u->reader != NULL;
}

/* Copies the first bytes of the body to `head`, as many as fit, and returns how many were
 * copied. */
static size_t keep_head(upload *u, const char *bytes, size_t length)
{
    size_t room = sizeof u->head - u->head_length, take = length < room ? length : room;
    memcpy(u->head + u->head_length, bytes, take);
    u->head_length += take;
    return take;
}

static bool open_part(api_exchange *x, upload *u, const api_part_kind *kind)
{
    return kind->format == NULL ? open_document(x, u) : open_reader(x, u, kind->format);
}

static bool feed_part(api_exchange *x, upload *u, const api_parts_piece *piece)
{
    keep_head(u, piece->bytes, piece->length);
    return feed(x, u, piece->bytes, piece->length);
}

static bool feed_parts(api_exchange *x, upload *u, const char *bytes, size_t length)
{
    const char *end = bytes + length;
    for (bool good = true; good;) {
        api_parts_piece piece;
        switch (api_parts_next(x, u->parts, &bytes, end, &piece)) {
        case API_PARTS_MORE:
            return true;
        case API_PARTS_OPEN:
            good = open_part(x, u, &piece.kind);
            break;
        case API_PARTS_BYTES:
            good = feed_part(x, u, &piece);
            break;
        case API_PARTS_BAD:
            return false;
        }
    }
    return false;
}

/* Ends a multipart body. If it is known only now which file is the mesh file, reads that file. Then
 * passes the other files to its reader. */
static bool end_parts(api_exchange *x, upload *u)
{
    api_parts_piece late;
    if (!api_parts_end(x, u->parts, &late) ||
        (late.bytes != NULL && !(open_part(x, u, &late.kind) && feed_part(x, u, &late)))) {
        return false;
    }
    if (u->reader != NULL) {
        he_reader_beside(u->reader, api_parts_beside(u->parts));
    }
    return true;
}

bool api_upload_feed(api_exchange *x, const char *bytes, size_t length)
{
    upload *u = x->state;
    if (u->parts != NULL) {
        return feed_parts(x, u, bytes, length);
    }
    size_t take = keep_head(u, bytes, length);
    if (!is_open(u)) {
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

static bool refuse_shape(const api_in *at, const char *name)
{
    api_known_names known = {.wanted = name};
    for (size_t i = 0; i < he_shape_count(); i++) {
        api_known_names_add(&known, he_shape_at(i)->name);
    }
    return api_in_fail(at, HE_BAD_VALUE, "there is no shape \"%.60s\"%s", name,
                       api_known_names_text(&known));
}

/* Reads {"shape":"cube","size":2,"name":"..."}: the name of a shape, its parameters, and the name
 * of the mesh. */
static bool read_shape(upload *u, const api_in *rest, const api_in *shape)
{
    const char *name, *names[HE_SHAPE_PARAMS + 3] = {"shape", "name"};
    if (!api_in_string(shape, API_MAX_KEY, &name)) {
        return false;
    }
    u->shape = he_shape_find(name, strlen(name));
    if (u->shape == NULL) {
        return refuse_shape(shape, name);
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
        !api_in_seen_name(&member, ST_MESH_NAME, &u->name)) {
        return false;
    }
    if (!api_in_find(rest, "shape", &member)) {
        return api_in_only(rest, (const char *const[]){"name", NULL});
    }
    if (api_document_in_has_vertices(u->document) || api_document_in_has_faces(u->document)) {
        return api_in_fail(&member, API_CONFLICTING_MEMBERS,
                           "give either \"shape\", or \"vertices\" and \"faces\"");
    }
    return read_shape(u, rest, &member);
}

static bool finish_reading(api_exchange *x, upload *u)
{
    he_error err = {0};
    if (he_reader_finish(u->reader, &u->import, &err) != HE_OK) {
        return fail_reading(x, u, &err);
    }
    u->has_import = true;
    api_parts_free(u->parts);
    u->parts = NULL;
    return true;
}

/* Returns true if the file will be read only when the mesh is made (finish_reading). */
static bool is_unread(const upload *u)
{
    return u->reader != NULL && !u->has_import;
}

bool api_upload_end(api_exchange *x)
{
    upload *u = x->state;
    u->name = api_param_text(x, "name");
    if (u->parts != NULL ? !end_parts(x, u) : !is_open(u) && !choose(x, u)) {
        return false;
    }
    if (u->document != NULL) {
        return api_document_in_end(u->document, &x->problem) && end_document(u);
    }
    return he_reader_reads_at_end(u->reader) || finish_reading(x, u);
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
    uint64_t elements =
        is_unread(u) ? x->received / ELEMENT_BYTES : soup->vertex_count + soup->corner_count;
    /* Repairs take about as long as building the mesh does. */
    return u->plan.which == 0 ? elements : 2 * elements;
}

bool api_upload_is_guessed(const api_exchange *x)
{
    return is_unread(x->state);
}

const char *api_upload_name(const api_exchange *x)
{
    const upload *u = x->state;
    return u->name;
}

/* Finds the repairs with which the body would be accepted. When memory is out it finds none, so
 * that the original refusal is sent. Returns HE_CANCELLED if the work was cancelled. */
static he_status advise(upload *u, unsigned *which, he_error *err)
{
    *which = 0;
    if (u->document != NULL && api_document_in_has_edges(u->document)) {
        return HE_OK;
    }
    he_status status = he_repair_advise(soup_of(u), u->plan.which, which, err);
    *which = status == HE_OK ? *which : 0;
    return status == HE_CANCELLED ? status : HE_OK;
}

/* Adds the places of the defects in the body to the problem. */
static void name_defects(api_exchange *x, upload *u)
{
    x->problem.report = &u->report;
    x->problem.report_pointers = u->document != NULL;
    if (u->document != NULL) {
        char pointer[API_DEFECT_POINTER];
        api_defect_pointer(&u->report.defects[0], pointer);
        api_problem_set_pointer(&x->problem, "%s", pointer);
    }
}

/* Refuses the body. The defects that were found are sent only if they are the reason of the
 * refusal: work that was cancelled or ran out of memory may have found some before that. */
static bool refuse(api_exchange *x, upload *u, he_error *err)
{
    bool reported = u->report.total > 0 && err->status == u->report.defects[0].reason;
    unsigned which = 0;
    he_error given_up = {0};
    if ((reported || err->status == HE_NOT_ORIENTABLE) &&
        advise(u, &which, &given_up) == HE_CANCELLED) {
        return api_fail_core(x, &given_up);
    }
    if (reported) {
        he_repaired_report(&u->repaired, &u->report);
        he_report_fail(&u->report, err);
    }
    if (u->document == NULL && u->shape == NULL) {
        he_import_locate(&u->import, err);
    }
    api_fail_core(x, err);
    if (reported) {
        name_defects(x, u);
    }
    if (which != 0) {
        api_problem_set_repairs(&x->problem, which);
    }
    return false;
}

/* Counts the vertices without a face and keeps the ids of the first ones. */
static he_status find_isolated(upload *u, const he_mesh *mesh, he_error *err)
{
    he_status status = HE_OK;
    uint32_t count = he_mesh_issued(mesh, HE_VERTEX);
    for (uint32_t v = 0; v < count && status == HE_OK; v++) {
        if (he_vertex_halfedge(mesh, (he_vertex){v}).i != HE_NONE) {
            continue;
        }
        if (u->isolated++ < API_PROBLEM_ELEMENTS) {
            status = he_ids_add(&u->isolated_ids, v, err);
        }
    }
    return status;
}

static he_status name_attributes(upload *u, const he_mesh *mesh, he_error *err)
{
    size_t count = he_mesh_columns(mesh);
    u->attributes = he_mem_zero(count + 1, sizeof *u->attributes);
    if (u->attributes == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to name %zu attributes", count);
    }
    for (size_t i = 0; i < count; i++) {
        const he_column *column = he_mesh_column(mesh, i);
        if (column != NULL) {
            attribute *a = &u->attributes[u->attribute_count++];
            a->domain = column->domain;
            memcpy(a->name, column->name, sizeof a->name);
        }
    }
    return HE_OK;
}

/* Adds a warning if an OFF file declares a wrong number of edges, which is known only when the mesh
 * is built. */
static void note_edges(upload *u, const he_mesh *mesh)
{
    const he_import *import = &u->import;
    if (u->has_import && u->plan.which == 0 && import->edges_line != 0 && import->edges != 0 &&
        import->edges != (double)he_mesh_count(mesh, HE_EDGE)) {
        he_warnings_add(&u->import.warnings,
                        &(he_occurrence){.code = "edge_count",
                                         .text = "the number of edges in the header of the file is "
                                                 "ignored, because the mesh has a different number",
                                         .place = HE_PLACE_LINE,
                                         .at = import->edges_line});
    }
}

/* Completes a mesh that was built from the soup (the vertices and faces as read): adds its
 * attributes, applies the repairs that need a mesh, and finds what the report of the import warns
 * of. */
static bool finish(api_exchange *x, upload *u, he_mesh *mesh)
{
    he_error err = {0};
    if (u->document != NULL &&
        !api_document_in_attributes(u->document, mesh, he_repaired_soup(&u->repaired),
                                    &x->problem)) {
        return false;
    }
    he_mesh_set_progress(mesh, &x->progress);
    he_progress_span(&x->progress, FILL_SHARE);
    he_status status = he_repair_mesh(mesh, &u->plan, &u->repaired, &err);
    if (status == HE_OK) {
        status = he_bowties_find(mesh, &u->bowties, &err);
    }
    if (status == HE_OK) {
        status = find_isolated(u, mesh, &err);
    }
    if (status == HE_OK) {
        status = he_open_seams_count(mesh, &u->seams, &err);
    }
    if (status == HE_OK) {
        status = name_attributes(u, mesh, &err);
    }
    note_edges(u, mesh);
    he_mesh_set_progress(mesh, NULL);
    return status == HE_OK || api_fail_core(x, &err);
}

bool api_upload_build(api_exchange *x, he_mesh **out)
{
    upload *u = x->state;
    he_soup made, *soup = soup_of(u);
    he_error err = {0};
    he_mesh *mesh = NULL;
    u->limits.progress = &x->progress;
    if (is_unread(u)) {
        he_progress_span(&x->progress, READ_SHARE);
        he_reader_set_progress(u->reader, &x->progress);
        if (!finish_reading(x, u)) {
            return false;
        }
    }
    if (u->shape != NULL) {
        he_progress_span(&x->progress, SHAPE_SHARE);
        if (he_shape_make(u->shape, u->args, &u->limits, &made, &err) != HE_OK) {
            return api_fail_core(x, &err);
        }
        soup = &made;
    }
    soup->limits.progress = &x->progress;
    u->vertices = soup->vertex_count;
    u->faces = soup->face_count;
    he_status status = HE_OK;
    if (u->plan.which != 0) {
        if (u->document != NULL && !api_document_in_lend(u->document, &x->problem)) {
            return false;
        }
        he_progress_span(&x->progress, REPAIR_SHARE);
        status = he_repair_soup(soup, &u->plan, &u->repaired, &err);
    }
    if (status == HE_OK) {
        he_progress_span(&x->progress, BUILD_SHARE);
        status = he_build(soup, HE_BUILD_TAKE, &mesh, &u->report, &err);
    }
    if (soup == &made) {
        he_soup_clear(&made);
    }
    if (status != HE_OK) {
        return refuse(x, u, &err);
    }
    if (!finish(x, u, mesh)) {
        he_mesh_free(mesh);
        return false;
    }
    *out = mesh;
    return true;
}

/* The values of the JSON members of a warning. */
typedef struct shown_warning {
    const char *code, *detail;
    uint64_t count;
    uint64_t at; /* line or byte where the warning first occurred */
    bool has_line, has_byte, has_lines, has_bytes, has_vertices;
    /* All warnings of the reader of the file, with the places where they occurred; `warning` is the
     * index of the shown one. */
    const he_warnings *warnings;
    size_t warning;
    const uint32_t *vertices;
    size_t named; /* number of ids in `vertices` */
} shown_warning;

/* Writes the lines or bytes where a warning occurred, as far as they were recorded. */
static void write_spots(api_out *out, const void *value)
{
    const shown_warning *w = value;
    api_out_array_begin(out);
    for (size_t k = 0; k < w->warnings->spot_count; k++) {
        if (w->warnings->spots[k].warning == w->warning) {
            api_out_u64(out, w->warnings->spots[k].at);
        }
    }
    api_out_array_end(out);
}

static void write_warned(api_out *out, const void *value)
{
    const shown_warning *w = value;
    api_out_ids(out, w->vertices, w->named);
}

static const api_field warning_fields[] = {
    API_FIELD("code", "text", shown_warning, code, .required = true),
    API_FIELD("detail", "text", shown_warning, detail, .required = true),
    API_FIELD("count", "count", shown_warning, count, .required = true,
              .doc = "How often the warning occurred."),
    API_FIELD("line", "count", shown_warning, at, .known = API_KNOWN(shown_warning, has_line),
              .doc = "The first line where it occurred, if the body is text."),
    API_FIELD("byte", "count", shown_warning, at, .known = API_KNOWN(shown_warning, has_byte),
              .doc = "The first byte where it occurred, if the body is binary."),
    API_FIELD_MADE("lines", "*count", write_spots, .known = API_KNOWN(shown_warning, has_lines),
                   .doc = "The lines where it occurred, if the body is text; at most 100 for all "
                          "warnings together."),
    API_FIELD_MADE("bytes", "*count", write_spots, .known = API_KNOWN(shown_warning, has_bytes),
                   .doc = "The bytes where it occurred, if the body is binary; at most 100 for all "
                          "warnings together."),
    API_FIELD_MADE("vertices", "*id", write_warned, .known = API_KNOWN(shown_warning, has_vertices),
                   .doc = "For the warnings bowtie and isolated_vertices: the first 100 vertices "
                          "that they are about."),
};
const api_record api_warning_record = API_RECORD("warning", warning_fields);

static void write_warning(api_out *out, const he_warnings *warnings, size_t i)
{
    char text[HE_WARNING_TEXT];
    const he_warning *warning = &warnings->items[i];
    const bool many = warning->count != 1;
    he_warning_text(warning, text, sizeof text);
    const shown_warning value = {.code = warning->code,
                                 .detail = text,
                                 .count = warning->count,
                                 .at = warning->at,
                                 .has_line = warning->place == HE_PLACE_LINE,
                                 .has_byte = warning->place == HE_PLACE_BYTE,
                                 .has_lines = many && warning->place == HE_PLACE_LINE,
                                 .has_bytes = many && warning->place == HE_PLACE_BYTE,
                                 .warnings = warnings,
                                 .warning = i};
    api_record_write(out, &api_warning_record, &value);
}

/* Writes a warning about vertices of the mesh, with the place of the first vertex in the file. The
 * caller sets code, detail and count. */
static void write_vertices(api_out *out, const upload *u, shown_warning value, const he_ids *ids)
{
    const he_source_map *map = u->has_import ? &u->import.vertices : NULL;
    if (value.count == 0) {
        return;
    }
    value.has_vertices = true;
    value.vertices = ids->ids;
    value.named = ids->count < API_PROBLEM_ELEMENTS ? ids->count : (size_t)API_PROBLEM_ELEMENTS;
    if (map != NULL && map->unit != HE_PLACE_NONE && map->count > 0) {
        uint32_t v = ids->ids[0];
        v = u->repaired.vertex_from == NULL ? v : u->repaired.vertex_from[v];
        value.has_line = map->unit == HE_PLACE_LINE;
        value.has_byte = !value.has_line;
        value.at = he_source_map_find(map, v);
    }
    api_record_write(out, &api_warning_record, &value);
}

/* Writes a warning about open seams: edges that lie in one place but are not connected. Programs
 * that write a vertex several times, once for each combination of attribute values of its corners,
 * leave such seams. */
static void write_seams(api_out *out, const upload *u)
{
    const shown_warning value = {.code = "open_seams",
                                 .detail =
                                     "faces are not connected although their edges coincide: "
                                     "repair=weld joins them and keeps the values of their corners",
                                 .count = u->seams};
    if (u->seams > 0) {
        api_record_write(out, &api_warning_record, &value);
    }
}

/* The values of the JSON members of the report of an import. */
typedef struct report {
    const upload *u;
    const char *format;
    uint64_t vertices, faces, more;
    bool has_attributes;
} report;

static void write_attributes(api_out *out, const void *value)
{
    const upload *u = ((const report *)value)->u;
    api_out_array_begin(out);
    for (size_t i = 0; i < u->attribute_count; i++) {
        const api_shown_column shown = {.domain = he_kind_plural(u->attributes[i].domain),
                                        .name = u->attributes[i].name};
        api_record_write(out, &api_attribute_read_record, &shown);
    }
    api_out_array_end(out);
}

static void write_repairs(api_out *out, const void *value)
{
    const upload *u = ((const report *)value)->u;
    api_repairs_write(out, &u->plan, &u->repaired, u->has_import ? &u->import : NULL);
}

static void write_warnings(api_out *out, const void *value)
{
    const upload *u = ((const report *)value)->u;
    const shown_warning bowties = {.code = "bowtie",
                                   .detail = "fans of faces share a vertex but no edge",
                                   .count = u->bowties.count};
    const shown_warning isolated = {.code = "isolated_vertices",
                                    .detail = "these vertices belong to no face",
                                    .count = u->isolated};
    api_out_array_begin(out);
    for (size_t i = 0; u->has_import && i < u->import.warnings.count; i++) {
        write_warning(out, &u->import.warnings, i);
    }
    write_vertices(out, u, bowties, &u->bowties);
    write_vertices(out, u, isolated, &u->isolated_ids);
    write_seams(out, u);
    api_out_array_end(out);
}

static const api_field import_fields[] = {
    API_FIELD("format", "text", report, format, .required = true),
    API_FIELD("vertices", "count", report, vertices, .required = true),
    API_FIELD("faces", "count", report, faces, .required = true),
    API_FIELD_MADE("attributes", "*#attribute_read", write_attributes,
                   .known = API_KNOWN(report, has_attributes),
                   .doc = "The attributes that the mesh got from the body."),
    API_FIELD_MADE("repairs", "*#repair", write_repairs, .required = true,
                   .doc = "The repairs that were asked for, in the order in which they were made."),
    API_FIELD_MADE("warnings", "*#warning", write_warnings, .required = true),
    API_FIELD("more_warnings", "count", report, more, .zero_is_none = true,
              .doc = "How many warnings are not listed."),
};
const api_record api_import_record = API_RECORD("import", import_fields);

void api_upload_write_report(api_exchange *x)
{
    const upload *u = x->state;
    const report value = {.u = u,
                          .format = u->format != NULL  ? u->format->name
                                    : u->shape != NULL ? "shape"
                                                       : "json",
                          .vertices = u->vertices,
                          .faces = u->faces,
                          .more = u->has_import ? u->import.warnings.more : 0,
                          .has_attributes = u->attribute_count > 0};
    api_out_key(&x->out, "import");
    api_record_write(&x->out, &api_import_record, &value);
}
