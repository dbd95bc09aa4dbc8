/* schemas.h - the component schemas of the OpenAPI document: the shapes of the API's bodies. */
#ifndef HE_API_DESCRIBE_SCHEMAS_H
#define HE_API_DESCRIBE_SCHEMAS_H

#include "api/json/json_out.h"

/* Writes the members of components.schemas into the open object. */
void api_schemas_write(api_out *out);

/* Both write {"$ref":"#/components/GROUP/NAME"}; the second one writes a key first and always uses
 * "schemas". */
void api_schema_ref(api_out *out, const char *group, const char *name);
void api_schema_ref_key(api_out *out, const char *key, const char *name);
/* Writes a list of strings, which ends in NULL, under a key such as "enum". */
void api_schema_choices(api_out *out, const char *key, const char *const *choices);

#endif
