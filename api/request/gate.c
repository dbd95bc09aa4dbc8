#include "api/request/gate.h"

#include "api/request/rating.h"
#include "system/clock.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

/* Finds the token in `Bearer TOKEN` (RFC 9110 11.4 and RFC 6750 2.1): a scheme, blanks, and a
 * token. Returns its length, or 0 if anything but blanks follows it; libmicrohttpd does not remove
 * blanks at the end of a header. Sets *text to NULL if there is no header or another scheme. */
static size_t read_bearer(const char *header, const char **text)
{
    static const char scheme[] = "bearer";
    const size_t length = sizeof scheme - 1;
    *text = NULL;
    if (header == NULL || strncasecmp(header, scheme, length) != 0 || header[length] != ' ') {
        return 0;
    }
    *text = header + length + strspn(header + length, " ");
    const size_t token = strcspn(*text, " \t");
    return (*text)[token + strspn(*text + token, " \t")] == '\0' ? token : 0;
}

/* Refuses a request without a valid token. The attempt is counted for the client's address, so that
 * guessing tokens is limited like other requests. */
static bool refuse_unknown(api_exchange *x, bool has_token)
{
    if (!api_rating_enter(x)) {
        return false;
    }
    x->has_bad_token = has_token;
    return has_token
               ? api_fail(x, API_UNAUTHORIZED, "the token is unknown, expired or revoked")
               : api_fail(x, API_UNAUTHORIZED, "the header Authorization: Bearer TOKEN is missing");
}

static bool refuse_role(api_exchange *x, api_role needed)
{
    const char *role = api_role_name(needed);
    api_fail(x, API_FORBIDDEN, "this request needs a token with the role \"%s\"", role);
    x->problem.role = role;
    return false;
}

/* Returns true if the token may do a dry run of this write. A dry run is a read, but the server
 * knows only from the body that it is one. */
static bool may_rehearse(const api_exchange *x)
{
    return (x->route->flags & API_REHEARSED) != 0 && api_role_allows(x->token->role, API_ROLE_READ);
}

const char *api_gate_ticket(const char *query)
{
    const char *last = strrchr(query, '&');
    last = last == NULL ? query : last + 1;
    return strncmp(last, API_TICKET, strlen(API_TICKET)) == 0 ? last : NULL;
}

/* Finds the token by the ticket in the query, and removes the ticket from the query, because the
 * ticket was made for the query without the ticket. */
static bool take_ticket(api_exchange *x, const char *ticket)
{
    const char *path = x->request.path, *query = x->request.query;
    const bool alone = ticket == query;
    int length = alone ? 0 : (int)(ticket - query) - 1;
    size_t size = strlen(path) + (size_t)length + 2;
    char *target = api_arena_array(&x->arena, size, 1);
    if (target == NULL) {
        return api_fail_memory(x);
    }
    (void)snprintf(target, size, "%s%s%.*s", path, alone ? "" : "?", length, query);
    x->request.query = target + strlen(path) + (alone ? 0 : 1);
    return (strcmp(x->request.method, "GET") == 0 &&
            api_tickets_take(x->service->tickets, ticket + strlen(API_TICKET), target,
                             st_clock_utc(), &x->token)) ||
           refuse_unknown(x, true);
}

/* Finds the token by the header Authorization. */
static bool take_bearer(api_exchange *x, const char *header)
{
    const char *text;
    size_t length = read_bearer(header, &text);
    if (text != NULL) {
        x->token = api_tokens_find(x->service->options.tokens, text, length, st_clock_utc());
    }
    return x->token != NULL || refuse_unknown(x, text != NULL);
}

static bool has_role(api_exchange *x)
{
    if (api_role_allows(x->token->role, x->route->role)) {
        return true;
    }
    x->rehearses_only = may_rehearse(x);
    return x->rehearses_only || refuse_role(x, x->route->role);
}

static bool enter(api_exchange *x)
{
    bool asks = x->service->options.tokens != NULL;
    const char *header = x->request.headers[API_HEADER_AUTHORIZATION];
    const char *ticket = header == NULL ? api_gate_ticket(x->request.query) : NULL;
    /* The header's value, a secret, is removed from the exchange because it is not needed any
     * more. */
    x->request.headers[API_HEADER_AUTHORIZATION] = NULL;
    if (x->route->role == API_ROLE_OPEN || (!asks && ticket == NULL)) {
        return api_rating_enter(x);
    }
    return (ticket != NULL ? take_ticket(x, ticket) : take_bearer(x, header)) &&
           api_rating_enter(x) && (!asks || has_role(x));
}

bool api_gate_enter(api_exchange *x)
{
    x->at_gate = !enter(x);
    return !x->at_gate;
}

bool api_gate_sees(const api_exchange *x, const char *mesh)
{
    return x->service->options.tokens == NULL ||
           (x->token != NULL && api_token_sees(x->token, mesh));
}

bool api_gate_may_create(api_exchange *x, const char *mesh)
{
    return api_gate_sees(x, mesh) ||
           api_fail(x, API_PREFIX, "the id must begin with one of the prefixes of the token");
}

bool api_gate_may_change(api_exchange *x)
{
    return !x->rehearses_only || refuse_role(x, API_ROLE_WRITE);
}

const char *api_gate_challenge(const api_exchange *x)
{
    if (x->problem.code == API_UNAUTHORIZED) {
        return x->has_bad_token ? "Bearer realm=\"hedge\", error=\"invalid_token\""
                                : "Bearer realm=\"hedge\"";
    }
    if (x->problem.code != API_FORBIDDEN || x->problem.role == NULL) {
        return NULL;
    }
#define SCOPE(role) "Bearer realm=\"hedge\", error=\"insufficient_scope\", scope=\"" role "\""
    static const char *const scopes[] = {[API_ROLE_ADMIN] = SCOPE("admin"),
                                         [API_ROLE_WRITE] = SCOPE("write"),
                                         [API_ROLE_READ] = SCOPE("read"),
                                         [API_ROLE_METRICS] = SCOPE("metrics")};
#undef SCOPE
    api_role role;
    return api_role_find(x->problem.role, strlen(x->problem.role), &role) ? scopes[role] : NULL;
}
