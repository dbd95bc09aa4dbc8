#include "server/boot/reload.h"

#include "server/boot/parts.h"
#include "server/tokens.h"

static bool reload_tokens(srv_parts *parts, char *message, size_t size)
{
    if (parts->tokens == NULL) {
        return true;
    }
    if (!srv_tokens_read(parts->tokens, parts->config->tokens, message, size)) {
        return false;
    }
    /* At the start there is no service yet, which applies them when it is made. */
    const bool applied = parts->service == NULL || api_service_apply_quotas(parts->service);
    if (!applied) {
        snprintf(message, size, "no memory for the quotas of the tokens");
    }
    return applied;
}

/* What is read again, in this order. */
static bool (*const reloads[])(srv_parts *parts, char *message, size_t size) = {
    reload_tokens,
};

bool srv_reload(void *context, char *message, size_t size)
{
    char later[320]; /* messages of failures after the first, which is the one that is told */
    bool ok = true;
    for (size_t i = 0; i < sizeof reloads / sizeof *reloads; i++) {
        ok = reloads[i](context, ok ? message : later, ok ? size : sizeof later) && ok;
    }
    return ok;
}

void srv_reload_told(void *context)
{
    const srv_parts *parts = context;
    char message[320];
    if (!srv_reload(context, message, sizeof message)) {
        fprintf(stderr, "hedged: %s; those before stay in force\n", message);
    } else if (parts->tokens != NULL) {
        fprintf(stderr, "hedged: %zu tokens are in force, read again from %s\n",
                api_tokens_count(parts->tokens), parts->config->tokens);
    }
}
