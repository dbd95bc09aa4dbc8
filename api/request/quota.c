#include "api/request/quota.h"

#include "base/mem.h"

#include <string.h>

bool api_service_apply_quotas(api_service *service)
{
    api_token_list tokens = {NULL, 0};
    api_tokens *set = service->options.tokens;
    if (set == NULL) {
        return true;
    }
    st_holder_limit *limits = NULL;
    bool good = api_tokens_all(set, &tokens);
    if (good && tokens.count > 0) {
        limits = he_mem_array(NULL, tokens.count, sizeof *limits);
        good = limits != NULL;
    }
    for (size_t i = 0; i < tokens.count && good; i++) {
        const api_token *token = tokens.items[i];
        limits[i] = (st_holder_limit){.name = token->name,
                                      .meshes = api_token_limit(token, API_LIMIT_MESHES),
                                      .bytes = api_token_limit(token, API_LIMIT_MESH_BYTES)};
    }
    good = good && st_limit_holders(service->store, limits, tokens.count) == ST_OK;
    he_mem_free(limits);
    api_token_list_clear(&tokens);
    return good;
}

static bool refuse_bytes(api_exchange *x, const st_usage *usage)
{
    api_limited_count(&x->service->limited, API_CLIENT_TOKEN, API_LIMIT_MESH_BYTES);
    return api_fail(
        x, API_QUOTA,
        "the meshes of this token may take %llu bytes of memory together, and now take %llu",
        (unsigned long long)usage->most_bytes, (unsigned long long)usage->bytes);
}

bool api_quota_fail_new(api_exchange *x)
{
    st_usage usage;
    st_holder_usage(x->store, api_cause(x).holder, &usage);
    if (usage.most_meshes == 0 || usage.meshes < usage.most_meshes) {
        return refuse_bytes(x, &usage);
    }
    api_limited_count(&x->service->limited, API_CLIENT_TOKEN, API_LIMIT_MESHES);
    return api_fail(x, API_QUOTA, "this token may have %llu meshes, and has %llu already",
                    (unsigned long long)usage.most_meshes, (unsigned long long)usage.meshes);
}

bool api_quota_fail(api_exchange *x)
{
    const char *holder = st_holder_of(x->mesh);
    st_usage usage;
    if (strcmp(api_cause(x).holder, holder) == 0) {
        st_holder_usage(x->store, holder, &usage);
        return refuse_bytes(x, &usage);
    }
    api_limited_count(&x->service->limited, API_CLIENT_TOKEN, API_LIMIT_MESH_BYTES);
    return api_fail(x, API_QUOTA,
                    "the meshes of the token that created this mesh may not take more memory");
}
