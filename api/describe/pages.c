#include "api/describe/openapi.h"
#include "api/describe/operations.h"
#include "api/request/handlers.h"

#include <stdio.h>
#include <string.h>

/* The Content-Security-Policy of the viewer page, which may run its own scripts and connect to its
 * own server only. */
static const char viewer_policy[] =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
    "require-trusted-types-for 'script'; trusted-types 'none'";
static const char text_policy[] =
    "default-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

void api_live_get(api_exchange *x)
{
    api_out_object_begin(&x->out);
    api_out_key_string(&x->out, "status", "alive");
    api_out_object_end(&x->out);
    api_answer_json(x, 200);
}

void api_ready_get(api_exchange *x)
{
    const api_options *options = &x->service->options;
    st_health health;
    if (options->ready != NULL && !options->ready(options->ready_context)) {
        api_fail(x, API_NOT_READY, "the server is starting or stopping");
        return;
    }
    st_store_health(x->store, &health);
    if (health.status == ST_FAILED) {
        api_fail(x, API_STORE_FAILED, "the disk failed%s%s: start the server again",
                 health.reason[0] == '\0' ? "" : ", ", health.reason);
        return;
    }
    api_out_object_begin(&x->out);
    api_out_key_string(&x->out, "status", "ready");
    api_out_key_string(&x->out, "store", health.status == ST_FULL ? "full" : "writable");
    const bool full = options->is_full != NULL && options->is_full(options->ready_context);
    api_out_key_string(&x->out, "memory", full ? "full" : "free");
    api_out_object_end(&x->out);
    api_answer_json(x, 200);
}

void api_version_get(api_exchange *x)
{
    api_out_object_begin(&x->out);
    api_out_key_string(&x->out, "name", "hedged");
    api_out_key_string(&x->out, "version", x->service->options.version);
    api_out_object_end(&x->out);
    api_answer_json(x, 200);
}

void api_index_get(api_exchange *x)
{
    static const char *const links[][2] = {
        {"meshes", "/v1/meshes"},        {"jobs", "/v1/jobs"}, {"operations", "/v1/operations"},
        {"openapi", "/v1/openapi.json"}, {"docs", "/docs"},
    };
    api_out_object_begin(&x->out);
    api_out_key_string(&x->out, "name", "hedged");
    api_out_key_string(&x->out, "version", x->service->options.version);
    for (size_t i = 0; i < sizeof links / sizeof *links; i++) {
        api_out_key_string(&x->out, links[i][0], links[i][1]);
    }
    api_out_object_end(&x->out);
    api_answer_json(x, 200);
}

void api_page_get(api_exchange *x)
{
    const api_options *options = &x->service->options;
    const char *bytes, *type, *etag = NULL;
    size_t length;
    bool immutable = false;
    /* The raw path is used, because names of assets need no escapes and are looked up in a
     * table. */
    if (options->asset == NULL || !options->asset(options->asset_context, x->request.path, &bytes,
                                                  &length, &type, &etag, &immutable)) {
        api_fail(x, API_NO_SUCH_ROUTE, "the server has no path \"%.150s\"", x->request.path);
        return;
    }
    api_answer_header(x, "Cache-Control",
                      immutable ? "public, max-age=31536000, immutable" : "no-cache");
    if (strncmp(type, "text/html", 9) == 0) {
        api_answer_header(x, "Content-Security-Policy", viewer_policy);
        api_answer_header(x, "Referrer-Policy", "no-referrer");
    }
    if (etag == NULL || !api_not_modified_since(x, etag)) {
        api_answer_bytes(x, 200, type, bytes, length);
    }
}

void api_problem_get(api_exchange *x)
{
    int code = api_code_find(x->code);
    if (code < 0) {
        api_fail(x, API_NO_SUCH_ROUTE, "no problem has the code \"%.100s\"", x->code);
        return;
    }
    api_problem_page(code, &x->text);
    api_answer_header(x, "Content-Security-Policy", text_policy);
    api_answer_text(x, 200, "text/html; charset=utf-8");
}

void api_operations_get(api_exchange *x)
{
    api_operations_write(&x->out);
    api_answer_json(x, 200);
}

void api_openapi_get(api_exchange *x)
{
    api_openapi_write(&x->out, x->service->options.version, x->service->options.public_url);
    api_answer_json(x, 200);
}
