/* routes.h - the table of routes. */
#ifndef HE_API_DESCRIBE_ROUTES_H
#define HE_API_DESCRIBE_ROUTES_H

#include "api/request/route.h"

/* What api_service_new() is given. */
api_route_table api_routes(void);
/* Statuses any route may answer, those included that the server finds reasons for; ends in 0. */
const int *api_route_common(void);

#endif
