/* schemas.h - the component schemas of the OpenAPI document: the shapes of the API's bodies. */
#ifndef HE_API_SCHEMAS_H
#define HE_API_SCHEMAS_H

#include "api/json_out.h"

/* The members of components.schemas into the open object. */
void api_schemas_write(api_out *out);

#endif
