#include "api/request/rating.h"

#include "system/clock.h"

static bool refuse(api_exchange *x, api_client_kind kind)
{
    const api_rate_left *requests = &x->rate_state.requests, *bytes = &x->rate_state.bytes;
    const bool by_requests = requests->wait >= bytes->wait;
    const char *whose = api_client_kind_name(kind);
    const uint64_t wait = by_requests ? requests->wait : bytes->wait;
    api_limited_count(&x->service->limited, kind,
                      by_requests ? API_LIMIT_REQUESTS : API_LIMIT_BYTES);
    if (by_requests) {
        api_fail(x, API_RATE_LIMIT, "the %s is limited to %llu requests a second", whose,
                 (unsigned long long)x->rate.requests);
    } else {
        api_fail(x, API_RATE_LIMIT, "the %s is limited to %llu bytes a second", whose,
                 (unsigned long long)x->rate.bytes);
    }
    x->problem.retry = wait;
    return false;
}

static bool refuse_connection(api_exchange *x)
{
    api_limited_count(&x->service->limited, API_CLIENT_ADDRESS, API_LIMIT_CONNECTIONS);
    return api_fail(
        x, API_TOO_MANY_CONNECTIONS, "the address is limited to %llu open connections",
        (unsigned long long)x->service->options.address_limits.most[API_LIMIT_CONNECTIONS]);
}

bool api_rating_enter(api_exchange *x)
{
    const api_service *service = x->service;
    const api_options *options = &service->options;
    const uint64_t *most = options->address_limits.most;
    api_client_kind kind = API_CLIENT_ADDRESS;
    api_rates *rates = service->address_rates;
    x->rate = (api_rate){most[API_LIMIT_REQUESTS], most[API_LIMIT_BYTES], options->limit_burst};
    x->rate_key = x->request.client;
    if (x->token != NULL) {
        kind = API_CLIENT_TOKEN;
        rates = service->token_rates;
        x->rate.requests = api_token_limit(x->token, API_LIMIT_REQUESTS);
        x->rate.bytes = api_token_limit(x->token, API_LIMIT_BYTES);
        x->rate_key = x->token->rate_key;
    }
    const bool is_free = x->route != NULL && (x->route->flags & API_UNLIMITED) != 0;
    if (x->request.is_beyond && !is_free) {
        return refuse_connection(x);
    }
    if (is_free || (x->rate.requests == 0 && x->rate.bytes == 0)) {
        return true;
    }
    x->rates = rates;
    return api_rates_admit(rates, &x->rate_key, &x->rate, st_clock_micros(), &x->rate_state) ||
           refuse(x, kind);
}

void api_rating_charge(api_exchange *x, uint64_t bytes)
{
    if (x->rates != NULL && x->rate.bytes != 0 && bytes > 0 && x->problem.code != API_RATE_LIMIT) {
        api_rates_charge(x->rates, &x->rate_key, &x->rate, bytes, st_clock_micros());
    }
}

void api_rate_fields_of(const api_exchange *x, api_rate_fields *out)
{
    out->policy[0] = out->left[0] = '\0';
    if (x->rates != NULL) {
        api_rate_policy(&x->rate, out->policy);
        api_rate_field(&x->rate, &x->rate_state, out->left);
    }
}
