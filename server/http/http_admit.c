#include "server/http/http_admit.h"

#include "system/random.h"

#include <string.h>

void srv_ids_init(srv_ids *ids)
{
    st_random_id(ids->prefix, SRV_ID_PREFIX);
    atomic_init(&ids->next, 0);
}

static bool is_id_character(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' ||
           c == '_' || c == '-';
}

void srv_admit_name(const srv_head *head, srv_ids *ids, char out[SRV_REQUEST_ID + 1])
{
    const srv_field *given = srv_head_find(head, "X-Request-Id");
    bool fits = given != NULL && given->value_length > 0 && given->value_length <= SRV_REQUEST_ID;
    for (size_t i = 0; fits && i < given->value_length; i++) {
        fits = is_id_character(given->value[i]);
    }
    if (fits) {
        memcpy(out, given->value, given->value_length);
        out[given->value_length] = '\0';
        return;
    }
    /* A new id is the prefix, a hyphen and the counter in hexadecimal. printf would be slower. */
    uint64_t number = atomic_fetch_add_explicit(&ids->next, 1, memory_order_relaxed);
    char *at = out + SRV_ID_PREFIX;
    memcpy(out, ids->prefix, SRV_ID_PREFIX);
    *at++ = '-';
    int shift = 60;
    while (shift > 0 && number >> shift == 0) {
        shift -= 4;
    }
    for (; shift >= 0; shift -= 4) {
        *at++ = "0123456789abcdef"[number >> shift & 15];
    }
    *at = '\0';
}

static const char *field_value(const srv_head *head, const char *name)
{
    const srv_field *field = srv_head_find(head, name);
    return field == NULL ? NULL : field->value;
}

bool srv_admit_proxied(const srv_policy *policy, const srv_head *head, srv_client *client,
                       api_problem *problem)
{
    srv_forwarding told = {0};
    srv_scheme scheme = SRV_SCHEME_UNKNOWN;
    for (size_t i = 0; i < head->field_count; i++) {
        srv_forwarding_read(&told, &policy->proxies, head->fields[i].name, head->fields[i].value);
    }
    const char *wrong = srv_forwarding_end(&told, client->address, &scheme);
    if (wrong != NULL) {
        return api_problem_set(problem, API_BAD_HEADER, "%s", wrong);
    }
    client->scheme = scheme == SRV_SCHEME_UNKNOWN ? client->scheme : scheme;
    return true;
}

bool srv_admit(const srv_policy *policy, const srv_head *head, const srv_framing *framing,
               srv_client *client, api_problem *problem)
{
    const char *host = framing->host;
    size_t length = host == NULL ? 0 : strlen(host);
    if (framing->authority != NULL &&
        !srv_policy_host(policy, framing->authority, framing->authority_length, problem)) {
        return false;
    }
    const srv_sender sender = {
        .method = head->method,
        .host = host,
        .origin = field_value(head, "Origin"),
        .fetch_site = field_value(head, "Sec-Fetch-Site"),
        .scheme = client->scheme,
    };
    client->cors = srv_policy_cors(policy, sender.origin);
    client->told_name = client->scheme == SRV_SCHEME_HTTPS && srv_policy_is_name(policy, host);
    return srv_policy_host(policy, host, length, problem) &&
           srv_policy_origin(policy, &sender, problem);
}
