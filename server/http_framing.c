#include "server/http_framing.h"

#include "api/limits.h"

#include <string.h>
#include <strings.h>

enum { MAX_METHOD = 16, MAX_LENGTH_DIGITS = 19 };

static bool is_token(const char *text, size_t length)
{
    static const char marks[] = "!#$%&'*+-.^_`|~";
    for (size_t i = 0; i < length; i++) {
        char c = text[i];
        bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (!word && (c == '\0' || strchr(marks, c) == NULL)) {
            return false;
        }
    }
    return length > 0;
}

static bool is_field_value(const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)text[i];
        if ((c < 0x20 && c != '\t') || c == 0x7F) {
            return false;
        }
    }
    return true;
}

static bool is_named(const srv_field *field, const char *name)
{
    return strlen(name) == field->name_length &&
           strncasecmp(field->name, name, field->name_length) == 0;
}

static size_t stored(const srv_head *head)
{
    return head->field_count < SRV_MAX_FIELDS ? head->field_count : SRV_MAX_FIELDS;
}

const srv_field *srv_head_find(const srv_head *head, const char *name)
{
    for (size_t i = 0; i < stored(head); i++) {
        if (is_named(&head->fields[i], name)) {
            return &head->fields[i];
        }
    }
    return NULL;
}

/* The only field of this name, NULL when absent; *repeated when there is another. */
static const srv_field *find_single(const srv_head *head, const char *name, bool *repeated)
{
    const srv_field *found = NULL;
    for (size_t i = 0; i < stored(head); i++) {
        if (is_named(&head->fields[i], name)) {
            *repeated = *repeated || found != NULL;
            found = &head->fields[i];
        }
    }
    return found;
}

static bool check_line(const srv_head *head, srv_framing *out, api_problem *problem)
{
    size_t length = strlen(head->method);
    if (length > MAX_METHOD || !is_token(head->method, length)) {
        return api_problem_set(problem, API_BAD_FRAMING,
                               "the method is not a token of 1 to %d "
                               "characters",
                               MAX_METHOD);
    }
    out->http_1_0 = strcmp(head->version, "HTTP/1.0") == 0;
    if (!out->http_1_0 && strcmp(head->version, "HTTP/1.1") != 0) {
        return api_problem_set(problem, API_BAD_FRAMING,
                               "the version is neither HTTP/1.0 nor HTTP/1.1");
    }
    length = strlen(head->target);
    if (length > API_MAX_URI) {
        return api_problem_set(problem, API_URI_TOO_LONG, "%zu characters are more than %d", length,
                               API_MAX_URI);
    }
    return true;
}

static bool check_target(const char *target, srv_framing *out, api_problem *problem)
{
    for (const unsigned char *c = (const unsigned char *)target; *c != '\0'; c++) {
        if (*c <= 0x20 || *c >= 0x7F || *c == '#') {
            return api_problem_set(problem, API_BAD_PATH,
                                   "byte %u of the request target must be percent-encoded",
                                   (unsigned)*c);
        }
    }
    const char *path = target;
    if (strncasecmp(target, "http://", 7) == 0) {
        out->authority = target + 7;
        out->authority_length = strcspn(out->authority, "/?");
        path = out->authority + out->authority_length;
    }
    out->path = path;
    out->path_length = strcspn(path, "?");
    out->query = path[out->path_length] == '?' ? path + out->path_length + 1 : "";
    if (path[0] == '/') {
        return true;
    }
    if (out->authority != NULL && path[0] == '\0') {
        out->path = "/";
        out->path_length = 1;
        return true;
    }
    return api_problem_set(problem, API_BAD_PATH, "the request target does not begin with '/'");
}

static bool check_fields(const srv_head *head, api_problem *problem)
{
    if (head->field_count > SRV_MAX_FIELDS) {
        return api_problem_set(problem, API_HEADERS_TOO_LARGE, "%zu headers are more than %d",
                               head->field_count, SRV_MAX_FIELDS);
    }
    if (head->bytes > SRV_MAX_HEAD) {
        return api_problem_set(problem, API_HEADERS_TOO_LARGE,
                               "%zu bytes of headers are more than %d", head->bytes, SRV_MAX_HEAD);
    }
    for (size_t i = 0; i < head->field_count; i++) {
        const srv_field *field = &head->fields[i];
        if (!is_token(field->name, field->name_length)) {
            return api_problem_set(problem, API_BAD_FRAMING, "the name of header %zu is no token",
                                   i + 1);
        }
        if (!is_field_value(field->value, field->value_length)) {
            return api_problem_set(problem, API_BAD_FRAMING,
                                   "the value of %.40s holds a control character", field->name);
        }
    }
    return true;
}

static bool parse_length(const srv_field *field, uint64_t *out)
{
    if (field->value_length == 0 || field->value_length > MAX_LENGTH_DIGITS) {
        return false;
    }
    uint64_t value = 0;
    for (size_t i = 0; i < field->value_length; i++) {
        char c = field->value[i];
        if (c < '0' || c > '9') {
            return false;
        }
        value = value * 10 + (uint64_t)(c - '0');
    }
    *out = value;
    return true;
}

static bool check_body(const srv_head *head, srv_framing *out, api_problem *problem)
{
    bool repeated = false;
    const srv_field *length = find_single(head, "Content-Length", &repeated);
    const srv_field *coding = find_single(head, "Transfer-Encoding", &repeated);
    const srv_field *host = find_single(head, "Host", &repeated);
    if (repeated) {
        return api_problem_set(problem, API_BAD_FRAMING,
                               "Content-Length, Transfer-Encoding or "
                               "Host is given twice");
    }
    if (length != NULL && coding != NULL) {
        return api_problem_set(problem, API_BAD_FRAMING,
                               "Content-Length and Transfer-Encoding exclude each other");
    }
    if (coding != NULL) {
        bool chunked = coding->value_length == 7 && strncasecmp(coding->value, "chunked", 7) == 0;
        if (!chunked || out->http_1_0) {
            return api_problem_set(problem, API_BAD_FRAMING,
                                   "Transfer-Encoding may only be chunked, in HTTP/1.1");
        }
    }
    if (length != NULL && !parse_length(length, &out->length)) {
        return api_problem_set(problem, API_BAD_FRAMING,
                               "Content-Length must be 1 to %d decimal digits", MAX_LENGTH_DIGITS);
    }
    if (host == NULL && !out->http_1_0) {
        return api_problem_set(problem, API_BAD_FRAMING, "HTTP/1.1 needs a Host header");
    }
    out->chunked = coding != NULL;
    out->has_length = length != NULL;
    out->host = host == NULL ? NULL : host->value;
    return true;
}

bool srv_framing_check(const srv_head *head, srv_framing *out, api_problem *problem)
{
    srv_framing framing = {.path = "/", .path_length = 1, .query = ""};
    bool ok = check_line(head, &framing, problem) &&
              check_target(head->target, &framing, problem) && check_fields(head, problem) &&
              check_body(head, &framing, problem);
    *out = framing;
    return ok;
}
