/* operations.h - the operation table (op/op.h) as JSON: for clients, and as schemas. */
#ifndef HE_API_DESCRIBE_OPERATIONS_H
#define HE_API_DESCRIBE_OPERATIONS_H

#include "api/json/json_out.h"

/* The body of GET /v1/operations. */
void api_operations_write(api_out *out);
/* Into an open components.schemas: op_NAME for each row, `operation` for any of them in a list,
 * `edit_one` for one that is an edit by itself, `done` for what any of them gives back. */
void api_operation_schemas_write(api_out *out);

#endif
