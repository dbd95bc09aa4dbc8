/* served.c - finds the route and the problem by which the metrics count a request that has
 * ended. */
#include "api/request/exchange.h"

api_metrics *api_metrics_of(const api_service *service)
{
    return service->metrics;
}

void api_served_as(const api_service *service, const api_exchange *x, api_served *served)
{
    const api_route *route = x == NULL ? NULL : x->route;
    served->route = route == NULL ? API_NO_ROUTE : (int)(route - service->table.rows);
    if (x != NULL) {
        served->code = x->problem.code;
    }
}
