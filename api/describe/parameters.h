/* parameters.h - descriptions of the query parameters that routes have.
 *
 * The rows of api/describe/routes.c point to them. A parameter that means the same on several
 * routes is defined only once. */
#ifndef HE_API_DESCRIBE_PARAMETERS_H
#define HE_API_DESCRIBE_PARAMETERS_H

#include "api/request/route.h"

extern const api_parameter api_parameter_limit, api_parameter_cursor, api_parameter_revision,
    api_parameter_since, api_parameter_drawn, api_parameter_base_faces, api_parameter_most_error,
    api_parameter_boundary_weight, api_parameter_most_splits, api_parameter_layout,
    api_parameter_turning, api_parameter_last_seen, api_parameter_format, api_parameter_format_out,
    api_parameter_encoding, api_parameter_compress, api_parameter_name, api_parameter_repair,
    api_parameter_tolerance, api_parameter_hole_edges, api_parameter_identity, api_parameter_by,
    api_parameter_ids, api_parameter_type, api_parameter_type_out, api_parameter_type_in,
    api_parameter_components, api_parameter_meets, api_parameter_merge, api_parameter_flat,
    api_parameter_sort, api_parameter_contains, api_parameter_small, api_parameter_dry_run,
    api_parameter_rule, api_parameter_embed;

#endif
