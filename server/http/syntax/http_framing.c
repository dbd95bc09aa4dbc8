#include "server/http/syntax/http_framing.h"

#include <string.h>
#include <strings.h>

const srv_field *srv_head_find(const srv_head *head, const char *name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < head->field_count; i++) {
        const srv_field *field = &head->fields[i];
        if (field->name_length == length && strncasecmp(field->name, name, length) == 0) {
            return field;
        }
    }
    return NULL;
}

static bool split_target(const char *target, bool secure, srv_framing *out, api_problem *problem)
{
    const char *path = target;
    const size_t scheme = strncasecmp(target, "http://", 7) == 0              ? 7
                          : secure && strncasecmp(target, "https://", 8) == 0 ? 8
                                                                              : 0;
    if (scheme > 0) {
        out->authority = target + scheme;
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

static uint64_t number_of(const srv_field *field)
{
    uint64_t value = 0;
    for (size_t i = 0; i < field->value_length; i++) {
        value = value * 10 + (uint64_t)(field->value[i] - '0');
    }
    return value;
}

bool srv_framing_read(const srv_head *head, bool secure, srv_framing *out, api_problem *problem)
{
    const srv_field *length = srv_head_find(head, "Content-Length");
    const srv_field *host = srv_head_find(head, "Host");
    srv_framing framing = {
        .path = "/",
        .path_length = 1,
        .query = "",
        .host = host == NULL ? NULL : host->value,
        .chunked = srv_head_find(head, "Transfer-Encoding") != NULL,
        .has_length = length != NULL,
        .length = length == NULL ? 0 : number_of(length),
    };
    bool ok = split_target(head->target, secure, &framing, problem);
    *out = framing;
    return ok;
}
