/* openapi.h - the OpenAPI 3.1 document, generated from the operation table and the route table. */
#ifndef HE_API_DESCRIBE_OPENAPI_H
#define HE_API_DESCRIBE_OPENAPI_H

#include "api/json/json_out.h"

/* Writes the document. `version` is the version of the server, `url` its public address or NULL. */
void api_openapi_write(api_out *out, const char *version, const char *url);

#endif
