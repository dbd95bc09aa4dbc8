#include "api/json/problem.h"

#include "api/limits.h"
#include "repair/repair.h"
#include "system/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct code_row {
    const char *slug;
    int http;
    const char *title, *explanation;
} code_row;

static const code_row rows[API_CODE_COUNT - HE_STATUS_COUNT] = {
#define CODE_ROW(constant, slug, status, title, text) \
    [API_##constant - HE_STATUS_COUNT] = {slug, status, title, text},
    API_CODE_MAP(CODE_ROW)
#undef CODE_ROW
};

/* The HTTP status of each refusal of core. Refusals that are not listed are about topology: they
 * get 422, and their title names the rule that the edit would break. */
static const struct {
    int http;
    const char *explanation;
} core_rows[HE_STATUS_COUNT] = {
    [HE_OK] = {200, ""},
    [HE_NO_MEMORY] = {507, "The server had no memory for the request. Nothing was changed."},
    [HE_IDS_EXHAUSTED] = {507,
                          "The mesh has used up its ids, which have 32 bits and are not reused. "
                          "The operation `compact` gives all elements new ids without gaps."},
    [HE_LIMIT] = {413,
                  "The request contains more than a limit allows; the detail names the limit."},
    [HE_CANCELLED] = {503, "The request was cancelled before it was done. Nothing was changed."},
    [HE_SYNTAX] = {400, "The file does not follow its format; the detail says where."},
    [HE_BAD_VALUE] = {400, "A number, string or count is not allowed here; the detail gives the "
                           "value and what is allowed."},
    [HE_NOT_FINITE] = {400, "Numbers must fit a double: NaN and infinity are refused, and so is a "
                            "number that would become NaN or infinity."},
    [HE_BAD_INDEX] =
        {422,
         "A face uses the index of a vertex that the body does not have. Indices count from 0."},
    [HE_UNSUPPORTED] = {422, "The file is well formed but uses a feature of its format that the "
                             "server does not support; the detail names the feature."},
    [HE_BEYOND_FLOAT] = {422, "The format holds positions as floats, and a coordinate of the mesh "
                              "is larger than the largest float, about 3.4e38. The formats obj, "
                              "off, ply and json, and stl with encoding=ascii, can hold it."},
    [HE_CORRUPT] = {500, "A mesh in the server breaks an invariant that must always hold. GET "
                         "/v1/meshes/{mesh}/check lists the broken invariants."},
    [HE_NO_SUCH_ELEMENT] = {422, "No element of this mesh ever had the id. The status is 404 if "
                                 "the id is in the path, and 422 if it is in the body."},
    [HE_DELETED_ELEMENT] = {422,
                            "The element with this id was deleted; ids are not reused. The status "
                            "is 410 if the id is in the path, and 422 if it is in the body."},
    [HE_REPEATED_ELEMENT] = {422, "A list names the same element twice."},
    [HE_TOO_FEW_CORNERS] = {422, "Faces are polygons of three corners or more."},
    [HE_REPEATED_CORNER] = {422, "The corners of a face must be different vertices."},
    [HE_NONMANIFOLD_EDGE] = {422, "An edge may have at most two faces, one on each side."},
    [HE_ORIENTATION] = {422, "Two faces that share an edge must run along it in opposite "
                             "directions, so that they have the same orientation."},
    [HE_NOT_ORIENTABLE] = {422, "Some faces form a strip that cannot be oriented, like a Moebius "
                                "strip: whichever faces are reversed, two neighbours have opposite "
                                "orientations. repair=orient,split cuts the mesh there."},
    [HE_DOUBLED_EDGE] = {422, "Two vertices may be joined by at most one edge."},
    [HE_CLOSED_FAN] = {422, "The faces around a vertex must form one closed fan or any number of "
                            "open fans: a closed fan may not share its vertex with another fan."},
    [HE_FEATURE_EDGE] = {422,
                         "Edges whose bool attribute `feature` is true form lines that keep their "
                         "shape: such an edge cannot be flipped, and a collapse may only merge two "
                         "vertices along a line, or move a vertex beside a line onto it."},
    [HE_LOCKED_ELEMENT] =
        {422, "An element whose bool attribute `locked` is true cannot be deleted; a locked vertex "
              "keeps its position, a locked edge its ends and a locked face its corners. Cutting "
              "the element is allowed. Set the attribute to false to unlock it."},
    [HE_ISOLATED_VERTEX] = {422, "The dual of a mesh has no face for a vertex without faces: add a "
                                 "face to the vertex, or delete it."},
    [HE_NO_RIM] =
        {422, "The operations that extrude or inset faces need an outline around the given faces. "
              "All faces of a closed component together have no outline: leave out a face."},
    [HE_RIM_MEETS_ITSELF] =
        {422,
         "The outline of the faces may pass each vertex only once. If parts of the faces touch at "
         "a vertex, add the faces between these parts, or edit one part after the other."},
    [HE_NO_FACES] = {422, "Only surfaces can be compared: both meshes need at least one face."},
    [HE_NO_NORMAL] =
        {422, "A face without an area has no normal, and several faces whose vector areas add up "
              "to zero have no common normal. Give a vector or a factor instead of a distance."},
    [HE_NOT_TRIANGLE] =
        {422, "Every face must be a triangle for this operation: use `triangulate` first."},
    [HE_NO_SUCH_ATTRIBUTE] = {422, "The mesh has no attribute with this name in this domain; GET "
                                   ".../attributes lists its attributes. The status is 404 if the "
                                   "attribute is in the path, and 422 if it is in the body."},
    [HE_ATTRIBUTE_CLASH] = {422,
                            "Attributes with the same name on the same kind of element must have "
                            "the same type and number of components, and either both or neither "
                            "must have labels. Rename or delete one of the two attributes."},
    [HE_LINK_CONDITION] =
        {422, "Collapsing the edge would make an edge with three faces, two edges between the same "
              "vertices or a face that uses a vertex twice: the common neighbours of the edge's "
              "ends must be exactly the corners opposite the edge."},
};

static bool is_core(int code)
{
    return code < HE_STATUS_COUNT;
}

const char *api_code_slug(int code)
{
    return is_core(code) ? he_status_slug((he_status)code) : rows[code - HE_STATUS_COUNT].slug;
}

const char *api_code_title(int code)
{
    return is_core(code) ? he_status_title((he_status)code) : rows[code - HE_STATUS_COUNT].title;
}

const char *api_code_explanation(int code)
{
    if (!is_core(code)) {
        return rows[code - HE_STATUS_COUNT].explanation;
    }
    return core_rows[code].explanation != NULL
               ? core_rows[code].explanation
               : "The request is well formed, but the mesh does not allow it at this element: the "
                 "title states the rule, and the problem names the element. Nothing was changed.";
}

int api_code_http(int code)
{
    if (!is_core(code)) {
        return rows[code - HE_STATUS_COUNT].http;
    }
    return core_rows[code].http != 0 ? core_rows[code].http : 422;
}

int api_code_find(const char *slug)
{
    for (int code = HE_OK + 1; code < API_CODE_COUNT; code++) {
        if (strcmp(api_code_slug(code), slug) == 0) {
            return code;
        }
    }
    return -1;
}

/* Shortens a text that was cut off by the end of its buffer, so that it ends with a whole UTF-8
 * character. */
static void end_whole(char *text, size_t size, int wanted)
{
    if (wanted < 0) {
        text[0] = '\0';
    } else if ((size_t)wanted >= size) {
        size_t end = size - 1;
        while (end > 0 && ((unsigned char)text[end - 1] & 0xC0) == 0x80) {
            end--;
        }
        if (end > 0 && (unsigned char)text[end - 1] >= 0xC0) {
            end--;
        }
        text[end] = '\0';
    }
}

bool api_problem_set(api_problem *problem, int code, const char *format, ...)
{
    if (problem->code != HE_OK) {
        return false;
    }
    *problem = (api_problem){.code = code, .kind = HE_KIND_COUNT};
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(problem->detail, sizeof problem->detail, format, arguments);
    va_end(arguments);
    end_whole(problem->detail, sizeof problem->detail, length);
    return false;
}

bool api_problem_set_lost(api_problem *problem, const st_wait *wait, bool changed)
{
    if (wait->end != ST_WAIT_LOST) {
        return api_problem_set(problem, API_NOT_READY,
                               "the server stopped before the change was on the disk");
    }
    if (!changed) {
        return api_problem_set(
            problem, API_STORE_LOST,
            "the answer would show an earlier change that could not be saved: %s", wait->reason);
    }
    int code = wait->status == ST_FULL ? API_STORE_FULL : API_STORE_FAILED;
    return api_problem_set(problem, code, "the change was lost: %s", wait->reason);
}

void api_problem_set_pointer(api_problem *problem, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(problem->pointer, sizeof problem->pointer, format, arguments);
    va_end(arguments);
    end_whole(problem->pointer, sizeof problem->pointer, length);
    problem->has_pointer = true;
}

void api_problem_set_repairs(api_problem *problem, unsigned repairs)
{
    size_t used = strlen(problem->detail);
    problem->repairs = repairs;
    for (unsigned r = 0, named = 0; r < HE_REPAIR_COUNT; r++) {
        if ((repairs >> r & 1) != 0) {
            int length = snprintf(problem->detail + used, sizeof problem->detail - used, "%s%s",
                                  named++ == 0 ? "; the body is accepted with repair=" : ",",
                                  he_repair_names[r]);
            used += length > 0 ? (size_t)length : 0;
            used = used < sizeof problem->detail ? used : sizeof problem->detail - 1;
        }
    }
}

bool api_problem_set_core(api_problem *problem, const he_error *err)
{
    if (problem->code != HE_OK) {
        return false;
    }
    switch (err->place) {
    case HE_PLACE_NONE:
        api_problem_set(problem, (int)err->status, "%s", err->text);
        break;
    case HE_PLACE_LINE:
        api_problem_set(problem, (int)err->status, "line %llu: %s", (unsigned long long)err->at,
                        err->text);
        break;
    case HE_PLACE_BYTE:
        api_problem_set(problem, (int)err->status, "byte %llu: %s", (unsigned long long)err->at,
                        err->text);
        break;
    }
    problem->has_element = err->kind < HE_MESH_KIND;
    problem->kind = err->kind;
    problem->id = err->id;
    return false;
}

bool api_problem_set_path(api_problem *problem, const he_error *err)
{
    bool first = problem->code == HE_OK;
    api_problem_set_core(problem, err);
    if (first && err->status == HE_NO_SUCH_ELEMENT) {
        problem->status = 404;
    } else if (first && err->status == HE_DELETED_ELEMENT) {
        problem->status = 410;
    }
    return false;
}

int api_problem_http(const api_problem *problem)
{
    return problem->status != 0 ? problem->status : api_code_http(problem->code);
}

const char *api_problem_retry(const api_problem *problem, char out[API_RETRY])
{
    if (problem->retry != 0) {
        (void)snprintf(out, API_RETRY, "%llu", (unsigned long long)problem->retry);
        return out;
    }
    switch (problem->code) {
    case API_STORE_LOST:
        return "0";
    case API_MESH_BUSY:
    case API_IDEMPOTENCY_BUSY:
        return "1";
    default:
        return api_problem_http(problem) == 503 || api_problem_http(problem) == 429 ? "1" : NULL;
    }
}

void api_defect_pointer(const he_defect *defect, char out[API_DEFECT_POINTER])
{
    const char *list = defect->kind == HE_FACE ? "faces" : "vertices";
    if (defect->corner != HE_NONE && defect->kind == HE_FACE) {
        snprintf(out, API_DEFECT_POINTER, "/%s/%u/%u", list, defect->id, defect->corner);
    } else {
        snprintf(out, API_DEFECT_POINTER, "/%s/%u", list, defect->id);
    }
}

/* Replaces HE_NO_MEMORY by API_MEMORY_BUDGET if the memory budget is used up: a function that runs
 * out of memory does not know whether the budget or the machine's memory is the reason, but the
 * client should. */
static int named_code(int code)
{
    return code == HE_NO_MEMORY && st_memory_was_over_budget() ? API_MEMORY_BUDGET : code;
}

const char *api_problem_unwritten(void)
{
    return st_memory_was_over_budget()
               ? "{\"type\":\"/problems/memory_budget\",\"title\":\"The memory budget is used up\","
                 "\"status\":507,\"detail\":\"no memory for the "
                 "request\",\"code\":\"memory_budget\"}"
               : "{\"type\":\"/problems/no_memory\",\"title\":\"Out of memory\",\"status\":507,"
                 "\"detail\":\"no memory for the request\",\"code\":\"no_memory\"}";
}

/* --- writing a problem --- */

/* The values of the JSON members of an element that a problem is about. */
typedef struct shown_element {
    const char *kind;
    uint32_t id;
    const char *code, *detail, *pointer; /* NULL: none */
} shown_element;

static const api_field element_fields[] = {
    API_FIELD("kind", "#element_kind", shown_element, kind, .required = true),
    API_FIELD("id", "id", shown_element, id, .required = true),
    API_FIELD("code", "text", shown_element, code, .required = false),
    API_FIELD("detail", "text", shown_element, detail, .required = false),
    API_FIELD("pointer", "text", shown_element, pointer, .required = false),
};
const api_record api_problem_element_record = API_RECORD("problem_element", element_fields);

/* The values of the JSON members of a problem. */
typedef struct shown_problem {
    const api_problem *problem;
    char type[64];
    const char *title;
    int status;
    const char *detail, *code, *pointer, *role;
    bool has_element, has_report, has_repairs, has_revision;
    shown_element element;
    uint64_t total, revision;
    const char *const *supported;
    const char *request_id;
} shown_problem;

static void write_elements(api_out *out, const void *value)
{
    const api_problem *problem = ((const shown_problem *)value)->problem;
    const he_report *report = problem->report;
    api_out_array_begin(out);
    for (size_t i = 0; i < report->total && i < API_PROBLEM_ELEMENTS && i < HE_REPORT_DEFECTS;
         i++) {
        const he_defect *defect = &report->defects[i];
        char text[HE_ERROR_TEXT], pointer[API_DEFECT_POINTER];
        he_defect_text(defect, text, sizeof text);
        api_defect_pointer(defect, pointer);
        api_record_write(out, &api_problem_element_record,
                         &(shown_element){.kind = he_kind_name(defect->kind),
                                          .id = defect->id,
                                          .code = he_status_slug(defect->reason),
                                          .detail = text,
                                          .pointer = problem->report_pointers ? pointer : NULL});
    }
    api_out_array_end(out);
}

static void write_repairs(api_out *out, const void *value)
{
    const unsigned repairs = ((const shown_problem *)value)->problem->repairs;
    api_out_array_begin(out);
    for (unsigned r = 0; r < HE_REPAIR_COUNT; r++) {
        if ((repairs >> r & 1) != 0) {
            api_out_string(out, he_repair_names[r]);
        }
    }
    api_out_array_end(out);
}

static const api_field problem_fields[] = {
    API_FIELD("type", "text", shown_problem, type, .required = true,
              .doc = "The path of a page of this server that explains the code."),
    API_FIELD("title", "text", shown_problem, title, .required = true),
    API_FIELD("status", "integer", shown_problem, status, .required = true),
    API_FIELD("detail", "text", shown_problem, detail, .required = true),
    API_FIELD("code", "text", shown_problem, code, .required = true,
              .doc = "A name for programs, which stays the same in later releases."),
    API_FIELD("pointer", "text", shown_problem, pointer,
              .doc = "A JSON pointer (RFC 6901) to the wrong value in the body."),
    API_FIELD("role", "#role_name", shown_problem, role,
              .doc = "The role that the token would need."),
    API_FIELD_RECORD("element", "#problem_element", shown_problem, element,
                     &api_problem_element_record, .known = API_KNOWN(shown_problem, has_element)),
    API_FIELD_MADE("elements", "*#problem_element", write_elements,
                   .known = API_KNOWN(shown_problem, has_report),
                   .doc =
                       "The elements that the problem is about; at most the first 100 are listed."),
    API_FIELD("total", "count", shown_problem, total, .known = API_KNOWN(shown_problem, has_report),
              .doc = "The number of elements that the problem is about."),
    API_FIELD_MADE("repair", "*#repair_name", write_repairs,
                   .known = API_KNOWN(shown_problem, has_repairs),
                   .doc = "The repairs with which the server would accept the body, as values of "
                          "the parameter `repair`."),
    API_FIELD("revision", "count", shown_problem, revision,
              .known = API_KNOWN(shown_problem, has_revision),
              .doc = "The present revision of the mesh, if the status is 412."),
    API_FIELD("supported", "*text", shown_problem, supported,
              .doc = "The supported media types or content codings, if the status is 406 or 415."),
    API_FIELD("request_id", "text", shown_problem, request_id, .required = false),
};
const api_record api_problem_record = API_RECORD("problem", problem_fields);

void api_problem_write(const api_problem *problem, const char *request_id, api_text *text)
{
    api_out out;
    const int code = named_code(problem->code);
    const char *slug = api_code_slug(code);
    shown_problem shown = {.problem = problem,
                           .title = api_code_title(code),
                           .status = api_problem_http(problem),
                           .detail = problem->detail,
                           .code = slug,
                           .pointer = problem->has_pointer ? problem->pointer : NULL,
                           .role = problem->role,
                           .has_element = problem->has_element,
                           .has_report = problem->report != NULL,
                           .has_repairs = problem->repairs != 0,
                           .has_revision = problem->has_revision,
                           .supported = problem->supported,
                           .total = problem->report == NULL ? 0 : problem->report->total,
                           .revision = problem->revision,
                           .request_id = request_id};
    snprintf(shown.type, sizeof shown.type, "/problems/%s", slug);
    if (problem->has_element) {
        shown.element = (shown_element){.kind = he_kind_name(problem->kind), .id = problem->id};
    }
    api_out_init(&out, text);
    api_record_write(&out, &api_problem_record, &shown);
}

void api_problem_page(int code, api_text *text)
{
    api_text_add_string(text, "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
                              "<meta name=\"viewport\" content=\"width=device-width\">\n<title>");
    api_text_add_html(text, api_code_title(code));
    api_text_add_string(text, "</title>\n<h1>");
    api_text_add_html(text, api_code_title(code));
    api_text_add_format(text, "</h1>\n<p><code>%s</code>, HTTP status %d</p>\n<p>",
                        api_code_slug(code), api_code_http(code));
    api_text_add_html(text, api_code_explanation(code));
    api_text_add_string(text, "</p>\n</html>\n");
}
