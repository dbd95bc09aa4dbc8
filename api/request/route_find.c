/* Which row of the table answers a request, and how the values of its parameters read. */
#include "api/request/route.h"

#include <string.h>

bool api_choices_parse(const char *const *choices, const char *list, unsigned *out)
{
    *out = 0;
    for (const char *at = list;; at++) {
        size_t length = strcspn(at, ","), i = 0;
        while (choices[i] != NULL &&
               (strlen(choices[i]) != length || memcmp(choices[i], at, length) != 0)) {
            i++;
        }
        if (choices[i] == NULL || (*out >> i & 1) != 0) {
            return false;
        }
        *out |= 1u << i;
        at += length;
        if (*at == '\0') {
            return true;
        }
    }
}

static bool match_variable(const char *variable, const char *segment, api_variables *out)
{
    switch (variable[1]) {
    case 'm':
        out->mesh = segment;
        return true;
    case 'i':
        out->id = segment;
        return true;
    case 'r':
        out->relation = segment;
        return true;
    case 'c':
        out->code = segment;
        return true;
    case 'j':
        out->job = segment;
        return true;
    case 'n':
        out->name = segment;
        return true;
    default: /* {kind}, {domain} */
        for (he_kind kind = HE_VERTEX; kind <= (variable[1] == 'd' ? HE_MESH_KIND : HE_FACE);
             kind++) {
            if (strcmp(segment, he_kind_plural(kind)) == 0) {
                out->kind = kind;
                out->has_kind = true;
                return true;
            }
        }
        return false;
    }
}

/* Every request passes here once a row, so the first byte that differs ends it. */
static bool match(const char *template, const api_path *path, api_variables *out)
{
    size_t i = 0;
    bool is_name = false; /* the segment before: only a name may hold a slash */
    *out = (api_variables){0};
    const char *at = template[1] == '\0' ? template + 1 : template;
    while (*at == '/') {
        at++;
        if (i == path->count) {
            return false;
        }
        const char *segment = path->segments[i++];
        if (*at != '{') {
            while (*at == *segment && *at != '\0') {
                at++;
                segment++;
            }
            if (*segment != '\0' || (*at != '/' && *at != '\0')) {
                return false;
            }
            is_name = false;
        } else if (at[1] == 'a') { /* {asset} */
            return !path->has_slash;
        } else if (match_variable(at, segment, out)) {
            is_name = at[1] == 'n';
            at = strchr(at, '}') + 1;
        } else {
            return false;
        }
    }
    return i == path->count && (is_name || !path->has_slash);
}

static void add_method(char *allow, const char *method)
{
    if (allow[0] != '\0') {
        strncat(allow, ", ", API_ALLOW - strlen(allow) - 1);
    }
    strncat(allow, method, API_ALLOW - strlen(allow) - 1);
}

const api_route *api_route_find(api_route_table table, const char *method, const api_path *path,
                                api_variables *out, char allow[API_ALLOW])
{
    const char *wanted = strcmp(method, "HEAD") == 0 ? "GET" : method;
    const api_route *routes = table.rows;
    size_t count = table.count;
    allow[0] = '\0';
    for (size_t i = 0; i < count; i++) {
        const api_route *route = &routes[i];
        /* Other methods matter only to a request that finds no row: see below. */
        if (route->method[0] == wanted[0] && strcmp(route->method, wanted) == 0 &&
            match(route->path, path, out)) {
            return route;
        }
    }
    for (size_t i = 0; i < count; i++) {
        if (match(routes[i].path, path, out)) {
            add_method(allow, routes[i].method);
            if (strcmp(routes[i].method, "GET") == 0) {
                add_method(allow, "HEAD");
            }
        }
    }
    if (allow[0] != '\0') {
        add_method(allow, "OPTIONS");
    }
    return NULL;
}

const char *const *api_relations(he_kind kind)
{
    static const char *const of_vertex[] = {"vertices", "outgoing", "incoming",
                                            "edges",    "faces",    NULL};
    static const char *const of_halfedge[] = {"loop", "ring", NULL};
    static const char *const of_edge[] = {"vertices", "halfedges", "faces", NULL};
    static const char *const of_face[] = {"vertices", "halfedges", "edges", "faces", NULL};
    static const char *const of_mesh[] = {NULL};
    switch (kind) {
    case HE_VERTEX:
        return of_vertex;
    case HE_HALFEDGE:
        return of_halfedge;
    case HE_EDGE:
        return of_edge;
    case HE_FACE:
        return of_face;
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return of_mesh;
}
