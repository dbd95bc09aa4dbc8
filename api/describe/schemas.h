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

/* These functions write the discriminator of a union: ..._add is called for each value of `member`,
 * with the name of the schema that the value stands for. */
void api_schema_discriminator_begin(api_out *out, const char *member);
void api_schema_discriminator_add(api_out *out, const char *value, const char *name);
void api_schema_discriminator_end(api_out *out);
/* Writes a list of strings, which ends in NULL, under a key such as "enum". */
void api_schema_choices(api_out *out, const char *key, const char *const *choices);

#endif
