#include "api/request/exchange.h"

/* Makes the buckets for the rates of tokens if the server has tokens, because a token file that is
 * read later may set limits; and the buckets of addresses if these have limits. */
static bool make_rates(api_service *service, const api_options *options)
{
    const uint64_t *most = options->address_limits.most;
    const bool addresses = most[API_LIMIT_REQUESTS] != 0 || most[API_LIMIT_BYTES] != 0;
    service->token_rates = options->tokens == NULL ? NULL : api_rates_new(API_TOKEN_RATES);
    service->address_rates = addresses ? api_rates_new(API_ADDRESS_RATES) : NULL;
    return (service->token_rates != NULL || options->tokens == NULL) &&
           (service->address_rates != NULL || !addresses);
}

api_service *api_service_new(st_store *store, api_route_table routes, const api_options *options)
{
    api_in_setup();
    api_service *service = he_mem_zero(1, sizeof *service);
    if (service != NULL) {
        service->table = routes;
        service->routes = api_route_tree_new(routes);
        service->tickets = api_tickets_new();
        service->metrics = api_metrics_new(routes.count);
        service->presences = api_presences_new(store);
    }
    if (service != NULL &&
        !(service->routes != NULL && service->tickets != NULL && service->metrics != NULL &&
          service->presences != NULL && make_rates(service, options))) {
        api_service_free(service);
        service = NULL;
    }
    if (service != NULL) {
        service->store = store;
        service->options = *options;
        service->options.limit_burst = options->limit_burst == 0 ? 1 : options->limit_burst;
        service->backfills.pool = options->pool;
        if (service->options.max_upload == 0) {
            service->options.max_upload = API_DEFAULT_UPLOAD;
        }
        if (service->options.version == NULL) {
            service->options.version = "0";
        }
    }
    if (service != NULL && !api_service_apply_quotas(service)) {
        api_service_free(service);
        service = NULL;
    }
    return service;
}

void api_service_free(api_service *service)
{
    if (service != NULL) {
        api_kept_free(service->operations);
        api_kept_free(service->problems);
        api_kept_free(service->openapi);
        api_route_tree_free(service->routes);
        api_tickets_free(service->tickets);
        api_presences_free(service->presences);
        api_rates_free(service->token_rates);
        api_rates_free(service->address_rates);
        api_metrics_free(service->metrics);
        st_spares_clear(&service->exchanges);
        st_spares_clear(&service->edits);
    }
    he_mem_free(service);
}

api_presences *api_service_presences(const api_service *service)
{
    return service->presences;
}

api_limited *api_service_limited(api_service *service)
{
    return &service->limited;
}
