/* schemas.h - the component schemas of the OpenAPI document: the shapes of the API's bodies. */
#ifndef HE_API_DESCRIBE_SCHEMAS_H
#define HE_API_DESCRIBE_SCHEMAS_H

#include "api/json/json_out.h"

/* The members of components.schemas into the open object. */
void api_schemas_write(api_out *out);

/* {"$ref":"#/components/GROUP/NAME"}, and the same with its key before ("schemas" only). */
void api_schema_ref(api_out *out, const char *group, const char *name);
void api_schema_ref_key(api_out *out, const char *key, const char *name);
/* A list of strings, which ends in NULL, under a key such as "enum". */
void api_schema_choices(api_out *out, const char *key, const char *const *choices);

#endif
