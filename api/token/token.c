#include "api/token/token.h"

#include "base/mem.h"
#include "system/random.h"

#include <nettle/memops.h>
#include <nettle/sha2.h>
#include <string.h>

api_token *api_token_hold(api_token *token)
{
    if (token != NULL) {
        atomic_fetch_add_explicit(&token->uses, 1, memory_order_relaxed);
    }
    return token;
}

void api_token_release(api_token *token)
{
    if (token != NULL && atomic_fetch_sub_explicit(&token->uses, 1, memory_order_acq_rel) == 1) {
        he_mem_free(token);
    }
}

const char *api_role_name(api_role role)
{
    switch (role) {
    case API_ROLE_ADMIN:
        return "admin";
    case API_ROLE_WRITE:
        return "write";
    case API_ROLE_READ:
        return "read";
    case API_ROLE_METRICS:
        return "metrics";
    case API_ROLE_OPEN:
        break;
    }
    return "open";
}

bool api_role_allows(api_role has, api_role needs)
{
    bool reads = needs == API_ROLE_READ && has == API_ROLE_WRITE;
    return needs == API_ROLE_OPEN || has == API_ROLE_ADMIN || has == needs || reads;
}

uint64_t api_token_limit(const api_token *token, api_limit limit)
{
    return token == NULL ? 0 : atomic_load_explicit(&token->limits[limit], memory_order_relaxed);
}

bool api_token_is_current(const api_token *token, double now)
{
    return !atomic_load_explicit(&token->revoked, memory_order_relaxed) && now < token->expires;
}

bool api_token_is_equal(const unsigned char *a, const unsigned char *b, size_t length)
{
    return memeql_sec(a, b, length) != 0;
}

bool api_token_matches(const api_token *token, const unsigned char hash[API_TOKEN_HASH])
{
    return api_token_is_equal(token->hash, hash, API_TOKEN_HASH);
}

static bool begins_with(const char *text, const char *prefix)
{
    return strncmp(text, prefix, strlen(prefix)) == 0;
}

bool api_token_sees(const api_token *token, const char *mesh)
{
    bool sees = token == NULL || token->prefix_count == 0;
    for (size_t i = 0; !sees && i < token->prefix_count; i++) {
        sees = begins_with(mesh, token->prefixes[i]);
    }
    return sees;
}

bool api_token_owns(const api_token *token, const char *holder, const char *mesh)
{
    bool is_admin = token == NULL || token->role == API_ROLE_ADMIN;
    return is_admin ||
           (strcmp(token->name, holder) == 0 && (mesh[0] == '\0' || api_token_sees(token, mesh)));
}

size_t api_token_ranges(const api_token *token, const char *out[API_TOKEN_PREFIXES])
{
    size_t count = 0, kept = 0;
    for (size_t i = 0; i < token->prefix_count; i++) {
        size_t at = count++;
        for (; at > 0 && strcmp(out[at - 1], token->prefixes[i]) > 0; at--) {
            out[at] = out[at - 1];
        }
        out[at] = token->prefixes[i];
    }
    for (size_t i = 0; i < count; i++) {
        if (kept == 0 || !begins_with(out[i], out[kept - 1])) {
            out[kept++] = out[i];
        }
    }
    return kept;
}

void api_token_hash(const char *text, size_t length, unsigned char out[API_TOKEN_HASH])
{
    struct sha256_ctx hash;
    sha256_init(&hash);
    sha256_update(&hash, length, (const uint8_t *)text);
    sha256_digest(&hash, API_TOKEN_HASH, out);
}

void api_token_make(char out[API_TOKEN_TEXT + 1])
{
    memcpy(out, "hedge_", 6);
    st_random_id(out + 6, API_TOKEN_RANDOM);
}
