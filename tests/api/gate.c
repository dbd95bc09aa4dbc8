#include "tests/api/gate.h"

#include "tests/api/request.h"

#include "api/describe/routes.h"
#include "api/token/token_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* The secret of each token is the token's name followed by this word. A search for the word finds a
 * secret that an answer reveals. */
#define SECRET "-s3cr3t"

static const struct {
    const char *name;
    api_role role;
    const char *more;
} holders[] = {
    {"reader", API_ROLE_READ, ""},
    {"writer", API_ROLE_WRITE, ""},
    {"boss", API_ROLE_ADMIN, ""},
    {"meter", API_ROLE_METRICS, ""},
    {"late", API_ROLE_ADMIN, " expires=2001-01-01"},
    {"left", API_ROLE_WRITE, " prefix=left-"},
    {"right", API_ROLE_WRITE, " prefix=right-,also-right."},
};
enum { HOLDERS = sizeof holders / sizeof *holders, FILE_BYTES = 4096, TARGET = 300 };

typedef struct world {
    api_bench *bench;
    char file[FILE_BYTES];
    size_t findings;
    bool tells;
} world;

static void found(world *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void found(world *w, const char *format, ...)
{
    w->findings++;
    if (w->tells) {
        va_list arguments;
        va_start(arguments, format);
        vprint_error(format, arguments);
        va_end(arguments);
        print_error("\n");
    }
}

/* --- requests --- */

static void secret_of(const char *name, char out[80])
{
    snprintf(out, 80, "%s" SECRET, name);
}

/* Writes a file of tokens with all rows of the table of tokens, except the one named `without`
 * unless that is NULL. */
static void write_file(char out[FILE_BYTES], const char *without)
{
    size_t used = 0;
    for (size_t i = 0; i < HOLDERS; i++) {
        char secret[80], line[API_TOKEN_SHORT_LINE];
        secret_of(holders[i].name, secret);
        api_token_file_line(holders[i].name, holders[i].role, secret, line);
        if (without == NULL || strcmp(without, holders[i].name) != 0) {
            used +=
                (size_t)snprintf(out + used, FILE_BYTES - used, "%s%s\n", line, holders[i].more);
        }
    }
}

/* Sends a request and requires that the answer contains no secret of any token. */
static bench_reply ask_with(world *w, const char *method, const char *target,
                            const char *const *headers, const char *body)
{
    bench_reply r = bench_send(w->bench, method, target, headers, body);
    bool tells = strstr(r.body, SECRET) != NULL;
    for (size_t i = 0; i < r.header_count; i++) {
        tells = tells || strstr(r.headers[i].value, SECRET) != NULL;
    }
    if (tells) {
        found(w, "%s %s answers with a token", method, target);
    }
    return r;
}

static bench_reply ask(world *w, const char *name, const char *method, const char *target,
                       const char *body)
{
    char secret[80], authorization[100];
    secret_of(name, secret);
    snprintf(authorization, sizeof authorization, "Bearer %s", secret);
    const char *const headers[] = {"Authorization", authorization, NULL};
    return ask_with(w, method, target, headers, body);
}

/* A request with the token whose name is `name`, and the status that its answer must have. */
typedef struct attempt {
    const char *name, *method, *target, *body;
    int status;
} attempt;

static void must(world *w, const attempt *a)
{
    bench_reply r = ask(w, a->name, a->method, a->target, a->body);
    if (r.status != a->status) {
        found(w, "%s: %s %s is %d and not %d: %.200s", a->name, a->method, a->target, r.status,
              a->status, r.body);
    }
    bench_done(r);
}

static const char *code_of(const bench_reply *r)
{
    const cJSON *code = cJSON_GetObjectItem(r->json, "code");
    return cJSON_IsString(code) ? code->valuestring : "";
}

/* --- routes --- */

static const struct {
    const char *name, *value;
} variables[] = {{"{id}", "0"},       {"{domain}", "faces"}, {"{name}", "a"},
                 {"{revision}", "2"}, {"{asset}", "x.js"},   {"{code}", "closed_fan"}};

static void replace(char text[TARGET], const char *what, const char *by)
{
    char *at = strstr(text, what);
    if (at != NULL) {
        char rest[TARGET];
        snprintf(rest, sizeof rest, "%s", at + strlen(what));
        snprintf(at, (size_t)(text + TARGET - at), "%s%s", by, rest);
    }
}

static void target_of(const api_route *route, const char *mesh, const char *job, char out[TARGET])
{
    snprintf(out, TARGET, "%s", route->path);
    replace(out, "{mesh}", mesh);
    replace(out, "{job}", job);
    for (size_t i = 0; i < sizeof variables / sizeof *variables; i++) {
        replace(out, variables[i].name, variables[i].value);
    }
}

/* Returns a body that the route accepts; if the route writes, the body is one that changes
 * something. */
static const char *body_of(const api_route *route)
{
    static const struct {
        const char *name, *body;
    } bodies[] = {{"query_mesh", "{\"queries\":[]}"},
                  {"traverse_mesh", "{\"walk\":\"loop\",\"from\":{\"halfedge\":0}}"},
                  {"compare_mesh", "{\"with\":1}"},
                  {"apply_edits", "{\"op\":\"face_poke\",\"face\":0}"},
                  {"replace_attribute", "{\"type\":\"bool\"}"},
                  {"update_attribute", "{\"ids\":\"all\",\"value\":true}"},
                  {"update_mesh", "{\"name\":\"new\"}"},
                  {"name_revision", "{\"name\":\"new\"}"},
                  {"put_presence", "{\"client\":\"gate\"}"},
                  {"replace_mesh", "{\"shape\":\"cube\"}"},
                  {"create_mesh", "{\"shape\":\"cube\"}"}};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        if (strcmp(route->name, bodies[i].name) == 0) {
            return bodies[i].body;
        }
    }
    return route->body_kind == API_BODY_NONE ? NULL : "{}";
}

static const api_route *row_of(const char *method, const char *path)
{
    const char *served = strcmp(method, "HEAD") == 0 ? "GET" : method;
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *row = &api_routes().rows[i];
        if (strcmp(row->path, path) == 0 && strcmp(row->method, served) == 0) {
            return row;
        }
    }
    return NULL;
}

/* --- set-up --- */

static void begin(world *w)
{
    write_file(w->file, NULL);
    w->bench = bench_new_guarded(w->file);
    static const char *const meshes[] = {"left-m", "right-m", "also-right.m", "m"};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        char target[TARGET];
        snprintf(target, sizeof target, "/v1/meshes/%s", meshes[i]);
        must(w, &(attempt){"boss", "PUT", target, "{\"shape\":\"cube\"}", 201});
        snprintf(target, sizeof target, "/v1/meshes/%s/attributes/faces/a", meshes[i]);
        must(w, &(attempt){"boss", "PUT", target, "{\"type\":\"bool\"}", 201});
    }
}

/* Returns whether two answers are equal when the name `a` in the first one and the name `b` in the
 * second one are taken as equal. */
static bool are_alike(const bench_reply *x, const char *a, const bench_reply *y, const char *b)
{
    bool alike = x->status == y->status && x->header_count == y->header_count;
    for (size_t i = 0; alike && i < x->header_count; i++) {
        alike = strcmp(x->headers[i].name, y->headers[i].name) == 0 &&
                strcmp(x->headers[i].value, y->headers[i].value) == 0;
    }
    const char *p = x->body, *q = y->body;
    while (alike && (*p != '\0' || *q != '\0')) {
        if (a[0] != '\0' && strncmp(p, a, strlen(a)) == 0 && strncmp(q, b, strlen(b)) == 0) {
            p += strlen(a);
            q += strlen(b);
        } else {
            alike = *p++ == *q++;
        }
    }
    return alike;
}

/* --- what must hold --- */

/* Sends requests without a valid token: all routes that need a token must give the same answer,
 * whether the mesh in the path exists or not. */
static void try_strangers(world *w)
{
    static const char *const methods[] = {"GET",   "HEAD",   "POST",    "PUT",
                                          "PATCH", "DELETE", "OPTIONS", "TRACE"};
    static const char *const strangers[] = {NULL,          "Basic Ym9zczpib3Nz",
                                            "Bearer boss", "Bearer late" SECRET,
                                            "Bearer ",     "bearer  boss" SECRET " more"};
    enum { STRANGERS = sizeof strangers / sizeof *strangers };
    bench_reply first[STRANGERS] = {{0}};
    for (size_t i = 0; i < api_routes().count; i++) {
        const char *path = api_routes().rows[i].path;
        for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
            const api_route *row = row_of(methods[m], path);
            for (size_t s = 0; s < 2 * STRANGERS; s++) {
                char target[TARGET];
                target_of(&api_routes().rows[i], s % 2 == 0 ? "left-m" : "left-0", "none", target);
                const char *const headers[] = {strangers[s / 2] == NULL ? NULL : "Authorization",
                                               strangers[s / 2], NULL};
                bench_reply r =
                    ask_with(w, methods[m], target, headers, row == NULL ? NULL : body_of(row));
                bool refused = r.status == 401;
                if (row == NULL && r.status != 405 && r.status != 204) {
                    found(w, "a stranger's %s %s is %d", methods[m], target, r.status);
                } else if (row != NULL && refused != (row->role != API_ROLE_OPEN)) {
                    found(w, "a stranger's %s %s is %d", methods[m], target, r.status);
                } else if (refused && first[s / 2].body == NULL) {
                    first[s / 2] = r;
                    continue;
                } else if (refused && !are_alike(&r, "", &first[s / 2], "")) {
                    found(w, "a stranger's %s %s differs: %s", methods[m], target, r.body);
                }
                bench_done(r);
            }
        }
    }
    /* An answer must not tell that a token has expired: it must equal the answer to an unknown
     * token. */
    if (first[2].body != NULL && first[3].body != NULL &&
        !are_alike(&first[2], "", &first[3], "")) {
        found(w, "an expired token is told from a wrong one");
    }
    for (size_t s = 0; s < STRANGERS; s++) {
        const char *challenge = bench_header(&first[s], "WWW-Authenticate");
        const char *wanted =
            s < 2 ? "Bearer realm=\"hedge\"" : "Bearer realm=\"hedge\", error=\"invalid_token\"";
        if (strcmp(challenge, wanted) != 0) {
            found(w, "the challenge is %s", challenge);
        }
        bench_done(first[s]);
    }
}

static double revision_of(world *w, const char *mesh)
{
    char target[TARGET];
    snprintf(target, sizeof target, "/v1/meshes/%s", mesh);
    bench_reply r = ask(w, "boss", "GET", target, NULL);
    const cJSON *revision = cJSON_GetObjectItem(r.json, "revision");
    double number = cJSON_IsNumber(revision) ? revision->valuedouble : -1;
    bench_done(r);
    return number;
}

/* The name of the scheme has no case, and blanks around the token do not belong to it. */
static void try_spellings(world *w)
{
    static const char *const spellings[] = {"BEARER boss" SECRET, "bearer   boss" SECRET,
                                            "Bearer boss" SECRET " \t"};
    for (size_t i = 0; i < sizeof spellings / sizeof *spellings; i++) {
        const char *const headers[] = {"Authorization", spellings[i], NULL};
        bench_reply r = ask_with(w, "GET", "/v1/token", headers, NULL);
        if (r.status != 200) {
            found(w, "\"%s\" is %d: %.200s", spellings[i], r.status, r.body);
        }
        bench_done(r);
    }
}

/* A refusal because the token's role is too small must name the sufficient role, and the request
 * must change nothing; a token with the sufficient role must be admitted. */
static void try_roles(world *w)
{
    double before = revision_of(w, "m");
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *row = &api_routes().rows[i];
        for (size_t h = 0; h < HOLDERS; h++) {
            if (holders[h].more[0] != '\0') {
                continue;
            }
            api_role has = holders[h].role, needs = row->role;
            bool allowed = needs == API_ROLE_OPEN || has == API_ROLE_ADMIN || has == needs ||
                           (has == API_ROLE_WRITE && needs == API_ROLE_READ);
            char target[TARGET];
            target_of(row, allowed ? "none" : "m", "none", target);
            bench_reply r = ask(w, holders[h].name, row->method, target, body_of(row));
            const cJSON *role = cJSON_GetObjectItem(r.json, "role");
            bool named = cJSON_IsString(role) &&
                         strcmp(role->valuestring, api_role_name(needs)) == 0 &&
                         strcmp(code_of(&r), "forbidden") == 0 &&
                         strstr(bench_header(&r, "WWW-Authenticate"), api_role_name(needs)) != NULL;
            if (allowed ? r.status == 401 || r.status == 403 : r.status != 403 || !named) {
                found(w, "%s's %s %s is %d: %.200s", holders[h].name, row->method, target, r.status,
                      r.body);
            }
            bench_done(r);
        }
    }
    if (revision_of(w, "m") != before) {
        found(w, "a token that may not has changed a mesh");
    }
}

/* A dry run of an edit changes nothing, so a token with the role `read` must be admitted. */
static void try_rehearsals(world *w)
{
    double before = revision_of(w, "m");
    static const attempt attempts[] = {
        {"reader", "POST", "/v1/meshes/m/edits",
         "{\"op\":\"face_poke\",\"face\":0,\"dry_run\":true}", 200},
        {"reader", "POST", "/v1/meshes/m/edits",
         "{\"ops\":[{\"op\":\"face_poke\",\"face\":0}],\"dry_run\":true}", 200},
        {"reader", "POST", "/v1/meshes/m/edits",
         "{\"op\":\"face_poke\",\"face\":0,\"dry_run\":false}", 403},
        {"reader", "PUT", "/v1/meshes/m/attributes/faces/b", "{\"type\":\"bool\",\"dry_run\":true}",
         200},
        {"reader", "PUT", "/v1/meshes/m/attributes/faces/b", "{\"type\":\"bool\"}", 403},
        {"reader", "PATCH", "/v1/meshes/m/attributes/faces/a",
         "{\"ids\":\"all\",\"value\":true,\"dry_run\":true}", 200},
        {"reader", "DELETE", "/v1/meshes/m/attributes/faces/a?dry_run=true", NULL, 200},
        {"meter", "POST", "/v1/meshes/m/edits",
         "{\"op\":\"face_poke\",\"face\":0,\"dry_run\":true}", 403},
    };
    for (size_t i = 0; i < sizeof attempts / sizeof *attempts; i++) {
        must(w, &attempts[i]);
    }
    if (revision_of(w, "m") != before) {
        found(w, "a dry run has changed a mesh");
    }
}

/* A mesh whose id has none of the prefixes of the token must be answered with the same bytes as a
 * mesh that does not exist. */
static void try_prefixes(world *w)
{
    double before = revision_of(w, "left-m");
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *row = &api_routes().rows[i];
        if (strstr(row->path, "{mesh}") == NULL) {
            continue;
        }
        char there[TARGET], absent[TARGET], own[TARGET];
        target_of(row, "left-m", "none", there);
        target_of(row, "left-0", "none", absent);
        target_of(row, "right-0", "none", own);
        bool creates = (row->flags & API_MAY_CREATE) != 0;
        bench_reply a = ask(w, "right", row->method, there, body_of(row));
        bench_reply b = ask(w, "right", row->method, absent, body_of(row));
        if (a.status != (creates ? 403 : 404) ||
            strcmp(code_of(&a), creates ? "prefix" : "no_such_mesh") != 0 ||
            !are_alike(&a, "left-m", &b, "left-0")) {
            found(w, "%s %s tells: %d %.200s", row->method, there, a.status, a.body);
        }
        if (!creates) {
            bench_reply c = ask(w, "right", row->method, own, body_of(row));
            if (!are_alike(&a, "left-m", &c, "right-0")) {
                found(w, "%s %s is not as if it were not there: %.200s", row->method, there,
                      a.body);
            }
            bench_done(c);
        }
        bench_done(a);
        bench_done(b);
    }
    if (revision_of(w, "left-m") != before) {
        found(w, "a mesh outside the prefixes was changed");
    }
    must(w, &(attempt){"right", "GET", "/v1/meshes/right-m", NULL, 200});
    must(w, &(attempt){"right", "GET", "/v1/meshes/also-right.m", NULL, 200});
}

/* Requires that the list of meshes, read page by page with the token named `name`, consists of the
 * ids `wanted` in their order. */
static void try_list(world *w, const char *name, const char *wanted)
{
    char target[TARGET] = "/v1/meshes?limit=1", ids[400] = "";
    for (size_t pages = 0; pages < 20 && target[0] != '\0'; pages++) {
        bench_reply r = ask(w, name, "GET", target, NULL);
        const cJSON *item, *next = cJSON_GetObjectItem(r.json, "next");
        cJSON_ArrayForEach(item, cJSON_GetObjectItem(r.json, "items"))
        {
            const cJSON *id = cJSON_GetObjectItem(item, "id");
            size_t used = strlen(ids);
            snprintf(ids + used, sizeof ids - used, "%s ", id->valuestring);
        }
        bool sees_server = cJSON_GetObjectItem(r.json, "listeners") != NULL;
        if (sees_server != (strcmp(name, "boss") == 0)) {
            found(w, "%s's list tells of the server: %s", name, r.body);
        }
        target[0] = '\0';
        if (cJSON_IsString(next)) {
            snprintf(target, sizeof target, "/v1/meshes?limit=1&cursor=%s", next->valuestring);
        }
        bench_done(r);
    }
    if (strcmp(ids, wanted) != 0) {
        found(w, "%s's list is %s and not %s", name, ids, wanted);
    }
}

static void try_bodies_and_ids(world *w)
{
    static const char *const appends[] = {"{\"op\":\"append\",\"mesh\":\"left-m\"}",
                                          "{\"op\":\"append\",\"mesh\":\"left-0\"}"};
    bench_reply a = ask(w, "right", "POST", "/v1/meshes/right-m/edits", appends[0]);
    bench_reply b = ask(w, "right", "POST", "/v1/meshes/right-m/edits", appends[1]);
    if (a.status != 422 || !are_alike(&a, "left-m", &b, "left-0")) {
        found(w, "append tells: %d %.200s", a.status, a.body);
    }
    bench_done(a);
    bench_done(b);
    static const char *const compares[] = {"{\"with\":\"left-m\"}", "{\"with\":\"left-0\"}"};
    a = ask(w, "right", "POST", "/v1/meshes/right-m/compare", compares[0]);
    b = ask(w, "right", "POST", "/v1/meshes/right-m/compare", compares[1]);
    if (a.status != 422 || !are_alike(&a, "left-m", &b, "left-0")) {
        found(w, "compare tells: %d %.200s", a.status, a.body);
    }
    bench_done(a);
    bench_done(b);
    static const struct {
        const char *target, *body;
    } creates[] = {{"/v1/meshes?id=left-m", "{\"shape\":\"cube\"}"},
                   {"/v1/meshes?id=left-0", "{\"shape\":\"cube\"}"},
                   {"/v1/meshes/right-m/copy", "{\"id\":\"left-m\"}"},
                   {"/v1/meshes/right-m/copy", "{\"id\":\"left-0\"}"}};
    for (size_t i = 0; i < sizeof creates / sizeof *creates; i++) {
        bench_reply r = ask(w, "right", "POST", creates[i].target, creates[i].body);
        if (r.status != 403 || strcmp(code_of(&r), "prefix") != 0) {
            found(w, "right makes %s: %d %.200s", creates[i].target, r.status, r.body);
        }
        bench_done(r);
    }
    must(w, &(attempt){"boss", "GET", "/v1/meshes/left-0", NULL, 404});
    static const char *const makes[] = {"/v1/meshes", "/v1/meshes/right-m/copy"};
    for (size_t i = 0; i < 2; i++) {
        bench_reply r = ask(w, "right", "POST", makes[i], i == 0 ? "{\"shape\":\"cube\"}" : NULL);
        const char *location = bench_header(&r, "Location");
        if (r.status != 201 || strncmp(location, "/v1/meshes/right-", 17) != 0) {
            found(w, "right's new mesh is at %s: %d", location, r.status);
        } else {
            must(w, &(attempt){"right", "DELETE", location, NULL, 204});
        }
        bench_done(r);
    }
}

/* A job must exist only for the token that began it and for tokens with the role `admin`; to other
 * tokens it is an unknown job. */
static void try_jobs(world *w)
{
    static const char left[] = "Bearer left" SECRET;
    static const char *const async[] = {"Authorization", left, "Prefer", "respond-async", NULL};
    static const char *const ends[] = {"", "/result", "/events"};
    bench_reply made = ask_with(w, "POST", "/v1/meshes/left-m/query", async, "{\"queries\":[]}");
    char job[TARGET], id[TARGET];
    snprintf(job, sizeof job, "%s", bench_header(&made, "Location"));
    snprintf(id, sizeof id, "%s", made.status == 202 ? job + strlen("/v1/jobs/") : "");
    if (made.status != 202) {
        found(w, "left's job is not begun: %d %.200s", made.status, made.body);
    }
    bench_done(made);
    for (size_t i = 0; i < 4; i++) {
        char there[TARGET + 10], absent[TARGET];
        snprintf(there, sizeof there, "%s%s", job, i < 3 ? ends[i] : "");
        snprintf(absent, sizeof absent, "/v1/jobs/none%s", i < 3 ? ends[i] : "");
        const char *method = i < 3 ? "GET" : "DELETE";
        bench_reply a = ask(w, "right", method, there, NULL);
        bench_reply b = ask(w, "right", method, absent, NULL);
        if (a.status != 404 || !are_alike(&a, id, &b, "none")) {
            found(w, "right's %s %s is %d: %.200s", method, there, a.status, a.body);
        }
        bench_done(a);
        bench_done(b);
    }
    static const char *const viewers[] = {"right", "reader", "left", "boss"};
    for (size_t i = 0; i < 4; i++) {
        bench_reply r = ask(w, viewers[i], "GET", "/v1/jobs", NULL);
        if ((strstr(r.body, id) != NULL) != (i >= 2)) {
            found(w, "%s's jobs: %.300s", viewers[i], r.body);
        }
        bench_done(r);
        must(w, &(attempt){viewers[i], "GET", job, NULL, i < 2 ? 404 : 200});
    }
    must(w, &(attempt){"left", "DELETE", job, NULL, 202});
    bench_run_jobs(w->bench, BENCH_JOBS);
}

static void set_flag(void *context)
{
    *(bool *)context = true;
}

/* Reads an event stream up to the point where it has no more to send at present; returns false at
 * the end of the stream. */
static bool read_on(const api_source *live, char *out, size_t size)
{
    int64_t got;
    size_t used = 0;
    while ((got = live->read(live->self, out + used, size - 1 - used)) > 0) {
        used += (size_t)got;
    }
    out[used] = '\0';
    return got == API_READ_WAIT;
}

/* A reload of the file of tokens that revokes a token must wake the event streams opened with it:
 * they send their closing message and end. Streams of other tokens must continue. */
static void try_streams(world *w)
{
    static const char *const names[] = {"left", "boss"};
    api_exchange *streams[2];
    bool woken[2] = {false, false};
    char text[4096], file[FILE_BYTES];
    for (size_t i = 0; i < 2; i++) {
        char authorization[100];
        snprintf(authorization, sizeof authorization, "Bearer %s" SECRET, names[i]);
        const api_request request = {.method = "GET",
                                     .path = "/v1/meshes/left-m/events",
                                     .query = "",
                                     .request_id = "test",
                                     .headers = {[API_HEADER_AUTHORIZATION] = authorization}};
        streams[i] = api_handle(bench_service(w->bench), &request, NULL, 0);
        const api_source *live = api_answer_of(streams[i])->live;
        if (live != NULL) {
            live->start(live->self, set_flag, &woken[i]);
            if (!read_on(live, text, sizeof text)) {
                found(w, "%s's stream ends at once: %s", names[i], text);
            }
        } else {
            found(w, "%s has no stream", names[i]);
        }
    }
    write_file(file, "left");
    bench_change_tokens(w->bench, file);
    must(w, &(attempt){"boss", "POST", "/v1/admin/reload", NULL, 200});
    must(w, &(attempt){"left", "GET", "/v1/meshes/left-m", NULL, 401});
    if (!woken[0] || woken[1]) {
        found(w, "the streams woken are %d and %d", woken[0], woken[1]);
    }
    for (size_t i = 0; i < 2; i++) {
        const api_source *live = api_answer_of(streams[i])->live;
        if (live != NULL) {
            bool goes_on = read_on(live, text, sizeof text);
            bool said = strstr(text, "event: bye\ndata: {\"reason\":\"token\"}\n\n") != NULL;
            if (goes_on != (i == 1) || said != (i == 0)) {
                found(w, "%s's stream says %s", names[i], text);
            }
        }
        api_free(streams[i]);
    }
    bench_change_tokens(w->bench, w->file);
    must(w, &(attempt){"boss", "POST", "/v1/admin/reload", NULL, 200});
    must(w, &(attempt){"left", "GET", "/v1/meshes/left-m", NULL, 200});
}

static void try_url(world *w, const char *method, const char *target, int status)
{
    bench_reply r = ask_with(w, method, target, NULL, NULL);
    if (r.status != status) {
        found(w, "%s with a ticket is %d and not %d: %.200s", method, r.status, status, r.body);
    }
    bench_done(r);
}

/* Requests a ticket, which lets a browser open a URL without a header Authorization; `url` becomes
 * the path with the ticket in its query. */
static void ask_ticket(world *w, const char *name, const char *target, char url[TARGET])
{
    char body[TARGET + 20];
    snprintf(body, sizeof body, "{\"path\":\"%s\"}", target);
    bench_reply r = ask(w, name, "POST", "/v1/tickets", body);
    const cJSON *path = cJSON_GetObjectItem(r.json, "path");
    snprintf(url, TARGET, "%s", cJSON_IsString(path) ? path->valuestring : target);
    if (r.status != 200 || strncmp(url, target, strlen(target)) != 0) {
        found(w, "%s's ticket for %s: %d %.200s", name, target, r.status, r.body);
    }
    bench_done(r);
}

/* A ticket must allow one GET of its path, with the rights of the token that requested it. */
static void try_tickets(world *w)
{
    char url[TARGET], other[TARGET], file[FILE_BYTES];
    ask_ticket(w, "left", "/v1/meshes/left-m/content?format=obj", url);
    const char *ticket = strstr(url, "&ticket=");
    snprintf(other, sizeof other, "/v1/meshes/left-m/content?format=off%s",
             ticket == NULL ? "" : ticket);
    try_url(w, "GET", other, 401);
    snprintf(other, sizeof other, "/v1/meshes/left-m?%s", ticket == NULL ? "" : ticket + 1);
    try_url(w, "GET", other, 401);
    snprintf(other, sizeof other, "%s", url);
    other[strlen(other) - 1] ^= 1;
    try_url(w, "GET", other, 401);
    try_url(w, "HEAD", url, 401);
    try_url(w, "POST", url, 405);
    try_url(w, "GET", url, 200);
    try_url(w, "GET", url, 401);
    ask_ticket(w, "right", "/v1/meshes/left-m", url);
    try_url(w, "GET", url, 404);
    ask_ticket(w, "right", "/v1/meshes/right-m", url);
    try_url(w, "GET", url, 200);
    must(w, &(attempt){"meter", "POST", "/v1/tickets", "{\"path\":\"/v1/meshes\"}", 403});
    must(w, &(attempt){"left", "POST", "/v1/tickets", "{\"path\":\"/v1/meshes?ticket=x\"}", 400});
    must(w, &(attempt){"left", "POST", "/v1/tickets", "{\"path\":\"/v1/meshes/m x\"}", 400});
    must(w, &(attempt){"left", "POST", "/v1/tickets", "{\"path\":\"//evil.example/\"}", 400});
    must(w, &(attempt){"left", "POST", "/v1/tickets", "{\"path\":\"/v1/meshes/m/undo\"}", 400});
    must(w, &(attempt){"left", "POST", "/v1/tickets", "{\"path\":\"/version\"}", 400});
    ask_ticket(w, "left", "/v1/meshes/left-m?", url);
    try_url(w, "GET", url, 200);
    ask_ticket(w, "left", "/v1/meshes/left-m", url);
    write_file(file, "left");
    bench_change_tokens(w->bench, file);
    must(w, &(attempt){"boss", "POST", "/v1/admin/reload", NULL, 200});
    try_url(w, "GET", url, 401);
    bench_change_tokens(w->bench, w->file);
    must(w, &(attempt){"boss", "POST", "/v1/admin/reload", NULL, 200});
}

/* Idempotency keys belong to a token: equal keys of two tokens must be independent, in requests
 * about a mesh and in requests that create one. */
static void try_keys(world *w)
{
    static const struct {
        const char *target, *body;
    } rows[] = {{"/v1/meshes/left-m/edits", "{\"op\":\"face_poke\",\"face\":0}"},
                {"/v1/meshes", "{\"shape\":\"cube\"}"}};
    static const struct {
        const char *name;
        bool again;
    } sends[] = {{"left", false}, {"writer", false}, {"left", true}, {"writer", true}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (size_t s = 0; s < sizeof sends / sizeof *sends; s++) {
            char authorization[100];
            snprintf(authorization, sizeof authorization, "Bearer %s" SECRET, sends[s].name);
            const char *const headers[] = {"Authorization", authorization, "Idempotency-Key", "one",
                                           NULL};
            bench_reply r = ask_with(w, "POST", rows[i].target, headers, rows[i].body);
            bool again = strcmp(bench_header(&r, "Idempotency-Replayed"), "true") == 0;
            if (r.status >= 300 || again != sends[s].again) {
                found(w, "%s's key at %s: %d, replayed %d", sends[s].name, rows[i].target, r.status,
                      again);
            }
            bench_done(r);
        }
    }
}

size_t gate_findings(bool tell)
{
    world w = {.tells = tell};
    begin(&w);
    try_list(&w, "right", "also-right.m right-m ");
    try_list(&w, "left", "left-m ");
    try_list(&w, "boss", "also-right.m left-m m right-m ");
    try_strangers(&w);
    try_spellings(&w);
    try_roles(&w);
    try_rehearsals(&w);
    try_prefixes(&w);
    try_bodies_and_ids(&w);
    try_jobs(&w);
    try_streams(&w);
    try_tickets(&w);
    try_keys(&w);
    bench_free(w.bench);
    return w.findings;
}
