/* GET /v1/token and POST /v1/admin/reload: which token a request has, and reading their file
 * again. */
#include "api/request/handlers.h"

#include <math.h>

/* Where no tokens are asked for, everybody is what an admin is. */
void api_token_get(api_exchange *x)
{
    const api_token *token = x->token;
    api_out *out = &x->out;
    api_out_object_begin(out);
    api_out_key(out, "name");
    if (token != NULL) {
        api_out_string(out, token->name);
    } else {
        api_out_null(out);
    }
    api_out_key_string(out, "role", api_role_name(token == NULL ? API_ROLE_ADMIN : token->role));
    api_out_key(out, "prefixes");
    api_out_array_begin(out);
    for (size_t i = 0; token != NULL && i < token->prefix_count; i++) {
        api_out_string(out, token->prefixes[i]);
    }
    api_out_array_end(out);
    api_out_key(out, "expires");
    if (token != NULL && isfinite(token->expires)) {
        api_out_time(out, token->expires);
    } else {
        api_out_null(out);
    }
    api_out_object_end(out);
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
    api_out_object_begin(&x->out);
    api_out_key(&x->out, "tokens");
    if (options->tokens != NULL) {
        api_out_u64(&x->out, api_tokens_count(options->tokens));
    } else {
        api_out_null(&x->out);
    }
    api_out_object_end(&x->out);
    api_answer_json(x, 200);
}

void api_admin_reload(api_exchange *x)
{
    api_defer(x, reload); /* it reads files */
}
