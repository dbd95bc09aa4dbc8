/* presence.c - PUT and GET .../presence: what clients show of themselves to the other clients of a
 * mesh. */
#include "api/request/handlers.h"

#include "api/request/mesh_access.h"

/* Answers with the list of the clients that are at the mesh. */
static void answer(api_exchange *x)
{
    api_presences_write(x->service->presences, x->info.incarnation, &x->out);
    api_answer_json(x, 200);
}

/* Reads the description of the mesh, which must be in memory. */
static bool has_mesh(api_exchange *x)
{
    (void)st_read_card(x->mesh, &x->info);
    x->has_info = !x->info.removed && !x->info.lost;
    return x->has_info || api_fail_store(x, x->info.lost ? ST_LOST : ST_ABSENT);
}

/* The name of the client's token is the name that it shows. */
static const char *name_by_token(const api_exchange *x, api_presence *presence)
{
    if (x->token == NULL) {
        return "";
    }
    st_copy_text(presence->name, x->token->name, API_PRESENCE_NAME);
    return x->token->name;
}

static bool put(api_exchange *x, const char *holder, const api_presence *presence)
{
    switch (api_presences_put(x->service->presences, &x->info, holder, presence)) {
    case API_PRESENCE_PUT:
        break;
    case API_PRESENCE_TAKEN:
        return api_fail(x, API_CLIENT_TAKEN, "a client with another token has the id \"%s\"",
                        presence->client);
    case API_PRESENCE_FULL:
        return api_fail(x, API_TOO_MANY_PRESENT, "too many clients show themselves");
    case API_PRESENCE_FULL_OF_TOKEN:
        return api_fail(x, API_TOO_MANY_PRESENT,
                        "%d clients with this token show themselves at this mesh already",
                        API_MAX_PRESENT_OF_TOKEN);
    case API_PRESENCE_NO_MEMORY:
        return api_fail_memory(x);
    }
    return true;
}

static void show(api_exchange *x)
{
    api_presence presence;
    bool leaves;
    if (x->received > API_MAX_PRESENCE) {
        api_fail(x, API_BODY_TOO_LARGE, "what a client shows of itself may have %d bytes at most",
                 API_MAX_PRESENCE);
        return;
    }
    if (!api_presence_read(&x->root, &presence, &leaves)) {
        return;
    }
    const char *holder = name_by_token(x, &presence);
    if (leaves) {
        api_presences_leave(x->service->presences, &x->info, holder, presence.client);
    } else if (!put(x, holder, &presence)) {
        return;
    }
    if (!api_answer_minimal(x)) {
        answer(x);
    }
}

void api_clients_list(api_exchange *x)
{
    if (has_mesh(x)) {
        answer(x);
    }
}

void api_clients_list_cold(api_exchange *x, st_cold *cold)
{
    (void)cold;
    answer(x);
}

void api_client_put(api_exchange *x)
{
    if (has_mesh(x)) {
        show(x);
    }
}

void api_client_put_cold(api_exchange *x, st_cold *cold)
{
    (void)cold;
    show(x);
}
