/* operations.h - writes the operation table (op/op.h) as JSON: for clients, and as schemas. */
#ifndef HE_API_DESCRIBE_OPERATIONS_H
#define HE_API_DESCRIBE_OPERATIONS_H

#include "api/json/json_out.h"

/* Writes the body of GET /v1/operations. */
void api_operations_write(api_out *out);
/* Writes schemas into an open components.schemas: op_NAME for each row, `operation` for any of
 * them, `done` for the results of any operation. */
void api_operation_schemas_write(api_out *out);

#endif
