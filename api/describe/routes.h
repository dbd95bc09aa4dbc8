/* routes.h - the table of routes. */
#ifndef HE_API_DESCRIBE_ROUTES_H
#define HE_API_DESCRIBE_ROUTES_H

#include "api/request/route.h"

/* Returns the table of routes. The server passes it to api_service_new. */
api_route_table api_routes(void);
/* Returns the HTTP statuses that every route may answer, including those with which the server
 * itself refuses requests; the list ends in 0. */
const int *api_route_common(void);

#endif
