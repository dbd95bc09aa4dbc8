/* schemas.h - the component schemas of the OpenAPI document: the shapes of the API's bodies. */
#ifndef HE_API_DESCRIBE_SCHEMAS_H
#define HE_API_DESCRIBE_SCHEMAS_H

#include "api/json/json_out.h"

/* Writes the members of components.schemas into the object that is open. */
void api_schemas_write(api_out *out);

/* Both write {"$ref":"#/components/GROUP/NAME"}; the second one writes a key first and always uses
 * "schemas". */
void api_schema_ref(api_out *out, const char *group, const char *name);
void api_schema_ref_key(api_out *out, const char *key, const char *name);
/* Writes only the member "$ref" of the group "schemas", into the object that is open. */
void api_schema_reference(api_out *out, const char *name);

/* Writes the schema `name`: the union of the schemas PREFIX_VALUE, one for each of the values,
 * which end in NULL. The member `member` says which of them an object is. */
void api_schema_union(api_out *out, const char *name, const char *member, const char *prefix,
                      const char *const *values);
/* Writes a list of strings, which ends in NULL, under a key such as "enum". */
void api_schema_choices(api_out *out, const char *key, const char *const *choices);

#endif
