#include "api/header/path.h"

#include "base/utf8.h"
#include "store/store.h"

#include <string.h>

static int hex(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Returns a copy of `raw` in the arena with percent escapes decoded. Returns NULL with the problem
 * filled if the result is not allowed (path.h) or memory is out. */
static const char *decode(api_bytes raw, int code, bool slash, api_arena *arena,
                          api_problem *problem)
{
    char *out = api_arena_alloc(arena, raw.length + 1);
    if (out == NULL) {
        api_problem_set(problem, HE_NO_MEMORY, "no memory to read the request line");
        return NULL;
    }
    size_t used = 0;
    for (size_t i = 0; i < raw.length; i++) {
        char c = raw.at[i];
        if (c == '%') {
            int high = i + 2 < raw.length ? hex(raw.at[i + 1]) : -1;
            int low = high >= 0 ? hex(raw.at[i + 2]) : -1;
            if (low < 0) {
                api_problem_set(
                    problem, code,
                    "a '%%' in the path or query must be followed by two hexadecimal digits");
                return NULL;
            }
            c = (char)(high * 16 + low);
            i += 2;
            if (c == '\0' || (c == '/' && !slash)) {
                api_problem_set(
                    problem, code,
                    "the path or query has an escaped %s, which is not allowed in this place",
                    c == '\0' ? "null character" : "slash");
                return NULL;
            }
        }
        out[used++] = c;
    }
    out[used] = '\0';
    if (!he_is_utf8(out, used)) {
        api_problem_set(problem, code, "the path or query is not UTF-8");
        return NULL;
    }
    return out;
}

bool api_path_split(const char *raw, api_arena *arena, api_path *out, api_problem *problem)
{
    if (raw[0] != '/') {
        return api_problem_set(problem, API_BAD_PATH, "the path does not begin with '/'");
    }
    api_path path = {.count = 0};
    for (const char *at = raw + 1; raw[1] != '\0'; at++) {
        const char *end = strchr(at, '/');
        size_t length = end == NULL ? strlen(at) : (size_t)(end - at);
        if (length == 0) {
            return api_problem_set(problem, API_NO_SUCH_ROUTE, "a segment of the path is empty");
        }
        if (path.count == API_MAX_SEGMENTS || length > 3 * (size_t)API_MAX_SEGMENT) {
            return api_problem_set(problem, API_NO_SUCH_ROUTE,
                                   "the path is longer than any path of this server");
        }
        const char *segment =
            decode((api_bytes){at, length}, API_BAD_PATH, end == NULL, arena, problem);
        if (segment == NULL) {
            return false;
        }
        if (strlen(segment) > API_MAX_SEGMENT) {
            return api_problem_set(problem, API_NO_SUCH_ROUTE,
                                   "the path is longer than any path of this server");
        }
        path.segments[path.count++] = segment;
        if (end == NULL) {
            path.has_slash = strchr(segment, '/') != NULL;
            break;
        }
        at = end;
    }
    *out = path;
    return true;
}

bool api_query_split(const char *raw, api_arena *arena, api_query *out, api_problem *problem)
{
    api_query query = {.count = 0};
    while (*raw != '\0') {
        size_t length = strcspn(raw, "&");
        const char *equals = memchr(raw, '=', length);
        if (equals == NULL || equals == raw) {
            return api_problem_set(problem, API_BAD_QUERY,
                                   "the query must be name=value pairs separated by '&'");
        }
        if (query.count == API_MAX_PARAMETERS) {
            return api_problem_set(problem, API_BAD_QUERY, "there are more than %d parameters",
                                   API_MAX_PARAMETERS);
        }
        api_pair *pair = &query.pairs[query.count++];
        const api_bytes name = {raw, (size_t)(equals - raw)};
        const api_bytes value = {equals + 1, (size_t)(raw + length - equals - 1)};
        pair->name = decode(name, API_BAD_QUERY, true, arena, problem);
        if (pair->name == NULL) {
            return false;
        }
        pair->value = decode(value, API_BAD_QUERY, true, arena, problem);
        if (pair->value == NULL) {
            return false;
        }
        raw += length;
        if (*raw == '&' && *++raw == '\0') {
            return api_problem_set(problem, API_BAD_QUERY, "the query ends in '&'");
        }
    }
    *out = query;
    return true;
}

bool api_path_id(const char *text, uint32_t *out)
{
    uint64_t value = 0;
    size_t length = strlen(text);
    if (length < 1 || length > 10) {
        return false;
    }
    for (; *text != '\0'; text++) {
        if (*text < '0' || *text > '9') {
            return false;
        }
        value = value * 10 + (uint64_t)(*text - '0');
    }
    if (value >= HE_DEAD) {
        return false;
    }
    *out = (uint32_t)value;
    return true;
}

bool api_path_revision(const char *text, uint64_t *out)
{
    enum { DIGITS = 16 };
    uint64_t value = 0;
    const size_t length = strlen(text);
    if (length > DIGITS || strspn(text, "0123456789") != length) {
        return false;
    }
    for (; *text != '\0'; text++) {
        value = value * 10 + (uint64_t)(*text - '0');
    }
    *out = value;
    return value >= 1 && value <= (uint64_t)1 << 53;
}

bool api_path_is_mesh_id(const char *text)
{
    size_t length = 0;
    for (char c = text[0]; (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
         c = text[length]) {
        length++;
    }
    return length >= 1 && length <= ST_MESH_ID && text[length] == '\0' && strcmp(text, ".") != 0 &&
           strcmp(text, "..") != 0;
}
