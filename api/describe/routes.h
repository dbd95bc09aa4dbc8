/* routes.h - the table of routes. */
#ifndef HE_API_DESCRIBE_ROUTES_H
#define HE_API_DESCRIBE_ROUTES_H

#include "api/request/route.h"

/* Returns the table of routes, which api_service_new() is given. */
api_route_table api_routes(void);
/* Returns the statuses that every route may answer, including those that the server causes; ends in
 * 0. */
const int *api_route_common(void);

#endif
