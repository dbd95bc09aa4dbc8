/* operations.h - writes the operation table (op/op.h) as JSON, for clients and for the OpenAPI
 * document. */
#ifndef HE_API_DESCRIBE_OPERATIONS_H
#define HE_API_DESCRIBE_OPERATIONS_H

#include "api/json/record.h"

/* The JSON members of the body of GET /v1/operations, and of the objects in it: an operation, a
 * parameter and a result. */
extern const api_record api_operations_record, api_operation_row_record, api_parameter_record,
    api_result_record;

/* Writes the body of GET /v1/operations. */
void api_operations_write(api_out *out);
/* Writes schemas into the object components.schemas, which the caller has begun: op_NAME for each
 * operation and done_NAME for its results; `operation`, the union of all op_NAME; and `done`, the
 * union of all done_NAME. */
void api_operation_schemas_write(api_out *out);

#endif
