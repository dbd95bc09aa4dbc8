#include "api/request/admit.h"

#include "api/json/known_names.h"
#include "api/json/seen_text.h"
#include "api/request/content_encoding.h"
#include "api/request/gate.h"
#include "api/request/rating.h"
#include "format/text/number.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

static bool refuse_parameter(api_exchange *x, const api_parameter *parameter, const char *value)
{
    char taken[128] = "true, false";
    if (parameter->type == API_PARAM_U64) {
        snprintf(taken, sizeof taken, "a whole number from %.0f to %.0f", parameter->min,
                 parameter->max);
    } else if (parameter->type == API_PARAM_NAME && api_unseen_character(value) != 0) {
        return api_fail(x, API_BAD_PARAMETER,
                        "\"%s\" cannot have the character U+%04X, which controls how text is shown",
                        parameter->name, api_unseen_character(value));
    } else if (parameter->type == API_PARAM_TEXT || parameter->type == API_PARAM_NAME) {
        snprintf(taken, sizeof taken, "at most %.0f bytes", parameter->max);
    } else if (parameter->type == API_PARAM_NUMBER) {
        char least[HE_NUMBER_TEXT], most[HE_NUMBER_TEXT];
        int least_bytes = (int)he_double_print(parameter->min, least);
        int most_bytes = (int)he_double_print(parameter->max, most);
        snprintf(taken, sizeof taken, "a number from %.*s to %.*s", least_bytes, least, most_bytes,
                 most);
    } else if (parameter->choices != NULL) {
        bool many = parameter->type == API_PARAM_CHOICES;
        size_t used = (size_t)snprintf(taken, sizeof taken, "%s", many ? "some of " : "");
        size_t begin = used;
        for (const char *const *c = parameter->choices; *c != NULL && used < sizeof taken; c++) {
            used += (size_t)snprintf(taken + used, sizeof taken - used, "%s%s",
                                     used > begin ? ", " : "", *c);
        }
    }
    return api_fail(x, API_BAD_PARAMETER, "\"%s\" cannot be \"%.100s\": %s", parameter->name, value,
                    taken);
}

static bool check_parameter(api_exchange *x, const api_parameter *parameter, const char *value)
{
    const char *end = value + strlen(value);
    size_t used = 0;
    bool good = false;
    switch (parameter->type) {
    case API_PARAM_TEXT:
        good = strlen(value) <= (size_t)parameter->max;
        break;
    case API_PARAM_NAME:
        good = strlen(value) <= (size_t)parameter->max && api_unseen_character(value) == 0;
        break;
    case API_PARAM_FLAG:
        good = strcmp(value, "true") == 0 || strcmp(value, "false") == 0;
        break;
    case API_PARAM_U64: {
        uint64_t number;
        good = he_u64_parse(value, end, &number, &used) == HE_OK && value + used == end &&
               (double)number >= parameter->min && (double)number <= parameter->max;
        break;
    }
    case API_PARAM_NUMBER: {
        double number;
        good = he_double_parse(value, end, HE_JSON_NUMBER, &number, &used) == HE_OK &&
               value + used == end && number >= parameter->min && number <= parameter->max;
        break;
    }
    case API_PARAM_CHOICES: {
        unsigned set;
        good = api_choices_parse(parameter->choices, value, &set);
        break;
    }
    case API_PARAM_CHOICE:
        good = api_param_choice(x, parameter->name) >= 0;
        break;
    }
    return good || refuse_parameter(x, parameter, value);
}

static bool refuse_unknown(api_exchange *x, const char *name)
{
    api_known_names known = {.wanted = name};
    for (size_t i = 0; x->route->parameters[i] != NULL; i++) {
        api_known_names_add(&known, x->route->parameters[i]->name);
    }
    return api_fail(x, API_UNKNOWN_PARAMETER, "this path has no query parameter \"%.60s\"%s", name,
                    api_known_names_text(&known));
}

static bool check_query(api_exchange *x)
{
    if (x->route->flags & API_OWN_QUERY) {
        return true;
    }
    if (!api_query_split(x->request.query, &x->arena, &x->query, &x->problem)) {
        return false;
    }
    for (size_t i = 0; i < x->query.count; i++) {
        const api_pair *pair = &x->query.pairs[i];
        const api_parameter *const *parameter = x->route->parameters;
        while (*parameter != NULL && strcmp((*parameter)->name, pair->name) != 0) {
            parameter++;
        }
        if (*parameter == NULL) {
            return refuse_unknown(x, pair->name);
        }
        for (size_t j = 0; j < i; j++) {
            if (strcmp(x->query.pairs[j].name, pair->name) == 0) {
                return api_fail(x, API_REPEATED_PARAMETER, "\"%s\" is given twice", pair->name);
            }
        }
        if (!check_parameter(x, *parameter, pair->value)) {
            return false;
        }
    }
    return true;
}

static bool check_variables(api_exchange *x, const api_variables *variables)
{
    if (variables->mesh != NULL) {
        if (!api_path_is_mesh_id(variables->mesh)) {
            bool creates = (x->route->flags & API_MAY_CREATE) != 0;
            return api_fail(x, creates ? API_BAD_ID : API_NO_SUCH_MESH,
                            "\"%.100s\" cannot be the id of a mesh", variables->mesh);
        }
        x->mesh_id = variables->mesh;
    }
    x->kind = variables->domain != HE_KIND_COUNT ? variables->domain : x->route->kind;
    if (variables->id != NULL && !api_path_id(variables->id, &x->id)) {
        api_fail(x, HE_NO_SUCH_ELEMENT, "\"%.100s\" is not the id of an element", variables->id);
        x->problem.status = 404;
        return false;
    }
    if (variables->revision != NULL && !api_path_revision(variables->revision, &x->revision)) {
        return api_fail(x, API_NO_SUCH_REVISION, "\"%.100s\" is not a revision",
                        variables->revision);
    }
    x->code = variables->code;
    x->attribute = variables->name;
    x->job_id = variables->job;
    return true;
}

/* Returns true if the request comes from a page of another site. Any page can make a browser send
 * such a request, by an image or a link. The page cannot read the answer, but the server would have
 * to compute it. */
static bool is_of_other_site(const api_exchange *x)
{
    const char *site = x->request.headers[API_HEADER_SEC_FETCH_SITE];
    return site != NULL && !x->request.has_consent && api_equal_nocase(site, "cross-site");
}

static bool refuse_path(api_exchange *x, const api_path *path)
{
    char list[API_CHOICES];
    const char *missed = api_route_choices(x->service->routes, path, list);
    if (path->has_slash) {
        return api_fail(x, API_BAD_PATH,
                        "an escaped slash is allowed only in the name of an attribute");
    }
    if (list[0] == '\0') {
        return api_fail(x, API_NO_SUCH_ROUTE, "the server has no path \"%.150s\"", x->request.path);
    }
    if (missed == NULL) {
        return api_fail(x, API_NO_SUCH_ROUTE, "the path must continue with one of %s", list);
    }
    return api_fail(x, API_NO_SUCH_ROUTE, "\"%.50s\" is not one of %s", missed, list);
}

/* Redirects a GET whose path has one '/' too many at its end, such as "/docs/", to the path without
 * it. The reference in Location is relative, so that it is correct behind a proxy that adds a
 * prefix. */
static bool redirect_to_route(api_exchange *x)
{
    const char *raw = x->request.path, *query = x->request.query;
    size_t length = strlen(raw);
    const bool reads =
        strcmp(x->request.method, "GET") == 0 || strcmp(x->request.method, "HEAD") == 0;
    if (!reads || length < 3 || raw[length - 1] != '/' || raw[length - 2] == '/') {
        return false;
    }
    char trimmed[API_MAX_URI + 1];
    snprintf(trimmed, sizeof trimmed, "%.*s", (int)(length - 1), raw);
    api_path path;
    api_variables variables;
    api_problem ignored = {0};
    if (!api_path_split(trimmed, &x->arena, &path, &ignored) ||
        api_route_find(x->service->routes, "GET", &path, &variables, x->allow) == NULL) {
        return false;
    }
    if (api_rating_enter(x)) {
        char location[API_MAX_URI + 8]; /* path and query together have API_MAX_URI bytes at most */
        snprintf(location, sizeof location, "../%s%s%s", strrchr(trimmed, '/') + 1,
                 query[0] != '\0' ? "?" : "", query);
        api_answer_empty(x, 308);
        api_answer_header(x, "Location", location);
    }
    return true;
}

static bool find_route(api_exchange *x)
{
    api_path path;
    api_variables variables;
    if (strlen(x->request.path) + strlen(x->request.query) > API_MAX_URI) {
        return api_fail(x, API_URI_TOO_LONG, "path and query are longer than %d characters",
                        API_MAX_URI);
    }
    if (redirect_to_route(x) || !api_path_split(x->request.path, &x->arena, &path, &x->problem)) {
        return false;
    }
    x->route = api_route_find(x->service->routes, x->request.method, &path, &variables, x->allow);
    if (x->route == NULL && !api_rating_enter(x)) {
        return false;
    }
    if (x->route == NULL && x->allow[0] == '\0') {
        return refuse_path(x, &path);
    }
    if (x->route == NULL && strcmp(x->request.method, "OPTIONS") == 0) {
        api_answer_empty(x, 204);
        api_answer_header(x, "Allow", x->allow);
        return false;
    }
    if (x->route == NULL) {
        return api_fail(x, API_METHOD_NOT_ALLOWED, "this path does not support %.20s, only %s",
                        x->request.method, x->allow);
    }
    x->answer.route = x->route->path;
    x->head = strcmp(x->request.method, "HEAD") == 0;
    if ((x->route->flags & API_EXPENSIVE) && is_of_other_site(x)) {
        return api_fail(x, API_FOREIGN_ORIGIN,
                        "the header Sec-Fetch-Site says that a page of another site sent this "
                        "request, which is too expensive for such pages");
    }
    return api_gate_enter(x) && check_variables(x, &variables) && check_query(x);
}

/* Refuses a request to a mesh that does not exist, or to a damaged one, which can only be deleted
 * or replaced. */
static bool take_mesh(api_exchange *x, st_status status)
{
    bool rids = (x->route->flags & (API_MAY_CREATE | API_INTERRUPTS)) != 0;
    if (status == ST_OK && st_unreadable(x->mesh) != ST_OK && !rids) {
        status = st_unreadable(x->mesh);
    } else if (status == ST_OK) {
        return true;
    } else {
        x->mesh = NULL;
    }
    return (status == ST_ABSENT && (x->route->flags & API_MAY_CREATE)) || api_fail_store(x, status);
}

static bool find_mesh(api_exchange *x)
{
    if (x->mesh_id == NULL) {
        return true;
    }
    if (!api_gate_sees(x, x->mesh_id)) {
        return (x->route->flags & API_MAY_CREATE) ? api_gate_may_create(x, x->mesh_id)
                                                  : api_fail_store(x, ST_ABSENT);
    }
    st_status status = st_find(x->store, x->mesh_id, &x->mesh);
    x->is_cold = status == ST_COLD;
    return x->is_cold || take_mesh(x, status);
}

bool api_answer_from_card(api_exchange *x)
{
    const bool may = (x->route->flags & API_WRITES) || x->route->reads == API_READS_CARD ||
                     x->head || x->request.headers[API_HEADER_IF_NONE_MATCH] != NULL;
    st_mesh *mesh = NULL;
    st_cold cold;
    if (x->route->cold == NULL || !may) {
        return false;
    }
    const st_status status = st_cold_begin(x->store, x->mesh_id, &mesh, &cold);
    if (status == ST_ABSENT) {
        (void)api_fail_store(x, status);
        return true;
    }
    if (status != ST_OK || mesh != NULL) {
        st_release(mesh);
        /* The caller then loads the mesh, which finds the mesh data or reports the error. */
        return false;
    }
    x->info = cold.info;
    x->has_info = true;
    x->route->cold(x, &cold);
    st_cold_end(&cold);
    x->has_info = x->answered || x->problem.code != HE_OK;
    return x->has_info;
}

bool api_load_mesh(api_exchange *x)
{
    x->is_cold = false;
    return take_mesh(x, st_load(x->store, x->mesh_id, &x->mesh));
}

uint64_t api_body_cap(const api_exchange *x)
{
    switch (x->route->body_kind) {
    case API_BODY_NONE:
        return 0;
    case API_BODY_OPTION:
    case API_BODY_CONTROL:
        return API_MAX_CONTROL;
    case API_BODY_EDITS:
        return API_MAX_EDITS;
    case API_BODY_UPLOAD:
        return x->service->options.max_upload;
    }
    return 0;
}

bool api_refuse_size(api_exchange *x)
{
    if (x->route->body_kind == API_BODY_NONE) {
        return api_fail(x, API_UNEXPECTED_BODY,
                        "a request with the method %s must not have a body on this path",
                        x->request.method);
    }
    return api_fail(x, API_BODY_TOO_LARGE,
                    x->decompressor == NULL ? "the body exceeds %llu bytes"
                                            : "the body decompresses to more than %llu bytes",
                    (unsigned long long)api_body_cap(x));
}

bool api_refuse_empty(api_exchange *x)
{
    if (x->attribute != NULL) {
        return api_fail(x, API_MISSING_BODY,
                        "the body is empty: send the values as JSON, or as octets if there are "
                        "elements to have values");
    }
    return x->route->body_kind == API_BODY_UPLOAD
               ? api_fail(
                     x, API_MISSING_BODY,
                     "the body is empty: send the bytes of a mesh file, a mesh document or the "
                     "name of a shape")
               : api_fail(x, API_MISSING_BODY, "%s needs a body here", x->request.method);
}

bool api_refuse_format(api_exchange *x, const char *detail)
{
    const api_parameter *format = NULL;
    for (size_t i = 0; format == NULL && x->route->parameters[i] != NULL; i++) {
        bool found = strcmp(x->route->parameters[i]->name, "format") == 0;
        format = found ? x->route->parameters[i] : NULL;
    }
    char names[100] = "";
    for (size_t i = 0, used = 0; format != NULL && format->choices[i] != NULL; i++) {
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "",
                                 format->choices[i]);
        assert(used < sizeof names);
    }
    api_fail(x, API_UNSUPPORTED_MEDIA_TYPE, "%s: give the format with ?format=, one of %s", detail,
             names);
    x->problem.supported = x->route->consumes;
    return false;
}

/* Returns true if a Content-Type says nothing about the body: curl -T sends none, and curl
 * --data-binary sends that of a form for any file. */
static bool is_generic(const char *type)
{
    return type == NULL || api_media_is(type, "text/plain") ||
           api_media_is(type, "application/x-www-form-urlencoded");
}

static bool check_content_type(api_exchange *x)
{
    const char *type = x->request.headers[API_HEADER_CONTENT_TYPE];
    for (const char *const *known = x->route->consumes; type != NULL && *known != NULL; known++) {
        if (api_media_is(type, *known)) {
            x->media_in = *known;
            return true;
        }
    }
    char text[160] = "the body has no Content-Type";
    if (type != NULL) {
        snprintf(text, sizeof text, "this path does not accept the Content-Type \"%.100s\"", type);
    }
    if (x->route->body_kind == API_BODY_UPLOAD) {
        if (is_generic(type) && api_param_text(x, "format") != NULL) {
            x->media_in = "application/octet-stream";
            return true;
        }
        return api_refuse_format(x, text);
    }
    api_fail(x, API_UNSUPPORTED_MEDIA_TYPE, "%s", text);
    x->problem.supported = x->route->consumes;
    return false;
}

static bool check_body(api_exchange *x)
{
    const api_request *r = &x->request;
    bool empty = !r->has_body || (r->has_length && r->length == 0);
    if (empty) {
        bool optional =
            x->route->body_kind == API_BODY_NONE || x->route->body_kind == API_BODY_OPTION;
        /* A form on any page of the web can send an empty body, but only with the Content-Type of a
         * form. Such a request is refused like one with a body of that type. */
        bool typed = x->route->body_kind == API_BODY_OPTION &&
                     x->request.headers[API_HEADER_CONTENT_TYPE] != NULL && !check_content_type(x);
        return (optional && !typed) || (!typed && api_refuse_empty(x));
    }
    if (r->has_length && r->length > api_body_cap(x)) {
        return api_refuse_size(x);
    }
    /* A body of unknown length may turn out to be empty; it then counts as no body. */
    return x->route->body_kind == API_BODY_NONE ||
           (api_content_encoding_body(x) && check_content_type(x));
}

static bool check_accept(api_exchange *x)
{
    const char *accept = x->request.headers[API_HEADER_ACCEPT];
    if (accept != NULL && accept[strspn(accept, " \t")] == '\0') {
        accept = NULL;
    }
    if (x->route->flags & API_OWN_ACCEPT) {
        return true;
    }
    int choice = api_media_choose(accept, x->route->produces);
    if (choice < 0) {
        return api_fail_accept(x);
    }
    x->media_out = x->route->produces[choice];
    return true;
}

bool api_admit(api_exchange *x)
{
    return find_route(x) && find_mesh(x) && check_body(x) && check_accept(x) &&
           api_content_encoding_accept(x);
}
