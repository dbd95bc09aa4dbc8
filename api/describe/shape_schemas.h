/* shape_schemas.h - the schemas of {"shape": ...}, made from the table of shapes. */
#ifndef HE_API_DESCRIBE_SHAPE_SCHEMAS_H
#define HE_API_DESCRIBE_SHAPE_SCHEMAS_H

#include "api/json/json_out.h"

/* Writes members of components/schemas: shape_cube and its like, and their union `shape`. */
void api_shape_schemas_write(api_out *out);

#endif
