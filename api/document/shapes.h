/* shapes.h - the schema of {"shape": ...}, made from the table of shapes. */
#ifndef HE_API_DOCUMENT_SHAPES_H
#define HE_API_DOCUMENT_SHAPES_H

#include "api/json/json_out.h"

/* Writes the schema called "shape" into components/schemas of the OpenAPI document: one alternative
 * for each shape. */
void api_shape_schema_write(api_out *out);

#endif
