/* token.c - GET /v1/token, POST /v1/tickets and POST /v1/admin/reload: the rights of a request's
 * token, a ticket that replaces the token, and reading the token file again. */
#include "api/request/handlers.h"

#include "api/read/records.h"
#include "api/request/gate.h"
#include "system/clock.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* The values of the JSON members that describe the rights of a token. */
typedef struct rights {
    const api_token *token; /* the request's token; NULL: the server has no tokens */
    const char *name, *role;
    bool ends;
    double expires;
} rights;

static void write_prefixes(api_out *out, const void *value)
{
    const api_token *token = ((const rights *)value)->token;
    api_out_array_begin(out);
    for (size_t i = 0; token != NULL && i < token->prefix_count; i++) {
        api_out_string(out, token->prefixes[i]);
    }
    api_out_array_end(out);
}

static const api_field token_fields[] = {
    API_FIELD("name", "text?", rights, name, .required = true,
              .doc = "The name of the token; null if the server needs no tokens."),
    API_FIELD("role", "#role_name", rights, role, .required = true),
    API_FIELD_MADE("prefixes", "*text", write_prefixes, .required = true,
                   .doc = "The token can use only meshes whose ids begin with one of these "
                          "prefixes; if the list is empty, it can use all meshes."),
    API_FIELD("expires", "time?", rights, expires, .required = true,
              .known = API_KNOWN(rights, ends),
              .doc = "When the token expires; null if it never does."),
};
const api_record api_token_record = API_RECORD("token", token_fields);

typedef struct ticket {
    const char *path;
    double expires;
} ticket;

static const api_field ticket_fields[] = {
    API_FIELD("path", "text", ticket, path, .required = true,
              .doc = "The path of the request, with the ticket added at its end."),
    API_FIELD("expires", "time", ticket, expires, .required = true),
};
const api_record api_ticket_record = API_RECORD("ticket", ticket_fields);

typedef struct reloaded {
    bool needs_tokens;
    uint64_t tokens;
} reloaded;

static const api_field reloaded_fields[] = {
    API_FIELD("tokens", "count?", reloaded, tokens, .required = true,
              .known = API_KNOWN(reloaded, needs_tokens),
              .doc = "How many tokens are accepted after the file was read again; null if the "
                     "server needs no tokens."),
};
const api_record api_reloaded_record = API_RECORD("reloaded", reloaded_fields);

/* Answers with the rights of the request's token. On a server without tokens every client is an
 * admin. */
void api_token_get(api_exchange *x)
{
    const api_token *token = x->token;
    const rights value = {.token = token,
                          .name = token == NULL ? NULL : token->name,
                          .role = api_role_name(token == NULL ? API_ROLE_ADMIN : token->role),
                          .ends = token != NULL && isfinite(token->expires),
                          .expires = token == NULL ? 0 : token->expires};
    api_record_write(&x->out, &api_token_record, &value);
    api_answer_json(x, 200);
}

/* Checks the target of a ticket: a raw path with its query, as it will appear in the request line
 * of a GET. */
static bool check_target(api_exchange *x, const api_in *in, const char *target)
{
    const size_t most = API_MAX_URI - sizeof "?" API_TICKET - API_TOKEN_TEXT;
    const char *mark = strchr(target, '?');
    const char *query = mark == NULL ? "" : mark + 1;
    char allow[API_ALLOW];
    api_path path;
    api_variables variables;
    char *raw = api_arena_copy(&x->arena, target, strcspn(target, "?"));
    if (raw == NULL) {
        return api_fail_memory(x);
    }
    for (const char *c = target; *c != '\0'; c++) {
        if (*c <= ' ' || *c > '~' || *c == '#') {
            return api_in_fail(
                in, API_BAD_PATH,
                "byte %zu of the path for the ticket is a character that a path cannot contain",
                (size_t)(c - target));
        }
    }
    if (raw[0] != '/') {
        return api_in_fail(in, API_BAD_PATH, "the path for the ticket must begin with \"/\"");
    }
    if (strlen(target) > most) {
        return api_in_fail(in, API_BAD_PATH,
                           "the path for the ticket has %zu characters; at most %zu are allowed",
                           strlen(target), most);
    }
    if (api_gate_ticket(query) != NULL) {
        return api_in_fail(in, API_BAD_PATH,
                           "the path already has the query parameter \"ticket\", which the server "
                           "adds");
    }
    if (!api_path_split(raw, &x->arena, &path, &x->problem)) {
        x->problem.status = x->problem.code == HE_NO_MEMORY ? 0 : 400;
        api_in_point(in);
        return false;
    }
    const api_route *route = api_route_find(x->service->routes, "GET", &path, &variables, allow);
    if (route == NULL) {
        return api_in_fail(in, API_BAD_PATH, "no route answers GET \"%.150s\"", raw);
    }
    return route->role != API_ROLE_OPEN ||
           api_in_fail(in, API_BAD_PATH, "GET \"%.150s\" needs no ticket", raw);
}

void api_tickets_post(api_exchange *x)
{
    static const char *const members[] = {"path", NULL};
    const char *target;
    api_ticket made;
    api_in in;
    if (!api_in_only(&x->root, members) || !api_in_need(&x->root, "path", &in) ||
        !api_in_string(&in, API_MAX_URI, &target) || !check_target(x, &in, target)) {
        return;
    }
    if (!api_tickets_make(x->service->tickets, x->token, target, st_clock_utc(), &made)) {
        api_fail(x, API_TOO_MANY_TICKETS, "too many tickets are waiting to be used");
        return;
    }
    char *whole = api_arena_array(&x->arena, strlen(target) + sizeof made.text + 10, 1);
    if (whole == NULL) {
        api_fail_memory(x);
        return;
    }
    (void)snprintf(whole, strlen(target) + sizeof made.text + 10, "%s%c" API_TICKET "%s", target,
                   strchr(target, '?') == NULL ? '?' : '&', made.text);
    api_record_write(&x->out, &api_ticket_record, &(ticket){whole, made.expires});
    api_answer_json(x, 200);
}

static void reload(api_exchange *x)
{
    const api_options *options = &x->service->options;
    char message[API_PROBLEM_DETAIL];
    if (options->reload != NULL &&
        !options->reload(options->reload_context, message, sizeof message)) {
        api_fail(x, API_RELOAD_FAILED, "%s", message);
        return;
    }
    const reloaded value = {.needs_tokens = options->tokens != NULL,
                            .tokens =
                                options->tokens == NULL ? 0 : api_tokens_count(options->tokens)};
    api_record_write(&x->out, &api_reloaded_record, &value);
    api_answer_json(x, 200);
}

void api_admin_reload(api_exchange *x)
{
    api_defer(x, reload); /* reload() reads files, so it must not run on a worker thread */
}
