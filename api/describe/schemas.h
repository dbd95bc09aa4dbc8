/* schemas.h - the component schemas of the OpenAPI document, which describe the JSON bodies of
 * requests and answers. */
#ifndef HE_API_DESCRIBE_SCHEMAS_H
#define HE_API_DESCRIBE_SCHEMAS_H

#include "api/json/json_out.h"

/* Writes the members of components.schemas into an object that the caller has begun. */
void api_schemas_write(api_out *out);

/* Writes {"$ref":"#/components/GROUP/NAME"}. api_schema_ref_key writes `key` first and has the
 * group "schemas". */
void api_schema_ref(api_out *out, const char *group, const char *name);
void api_schema_ref_key(api_out *out, const char *key, const char *name);
/* Writes only the member "$ref", for the group "schemas", into an object that the caller has
 * begun. */
void api_schema_reference(api_out *out, const char *name);

/* Writes the schema `name`: a union that has, for each of `values` (which end in NULL), the schema
 * PREFIX_VALUE. The value of an object's member `member` tells which schema the object has. */
void api_schema_union(api_out *out, const char *name, const char *member, const char *prefix,
                      const char *const *values);
/* Writes a list of strings, which ends in NULL, under a key such as "enum". */
void api_schema_choices(api_out *out, const char *key, const char *const *choices);

#endif
