/* shape_schemas.h - the schemas of bodies such as {"shape":"cube","size":2}, made from the table of
 * shapes. */
#ifndef HE_API_DESCRIBE_SHAPE_SCHEMAS_H
#define HE_API_DESCRIBE_SHAPE_SCHEMAS_H

#include "api/json/json_out.h"

/* Writes members of components.schemas: one for each shape, such as shape_cube, and their union
 * `shape`. */
void api_shape_schemas_write(api_out *out);

#endif
