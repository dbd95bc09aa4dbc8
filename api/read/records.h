/* records.h - the tables of JSON members (api/json/record.h) from which the handlers in api/read
 * write their answers. */
#ifndef HE_API_READ_RECORDS_H
#define HE_API_READ_RECORDS_H

#include "api/json/record.h"

/* The JSON members of the history, of an entry in it, and of the object in the entry that counts
 * changed elements. */
extern const api_record api_history_record, api_entry_record, api_counted_record;
/* The JSON members of the list of attributes, and of an answer with values of an attribute. */
extern const api_record api_attribute_list_record, api_attribute_values_record;
/* The JSON members of the list of materials. */
extern const api_record api_material_list_record;
/* The JSON members of a page of meshes, of jobs, and of elements of each he_kind up to HE_FACE. */
extern const api_record api_mesh_page_record, api_job_page_record, api_page_records[HE_FACE + 1];
/* The JSON members of the answers of GET .../boundaries and GET .../components, and of the objects
 * that they list. */
extern const api_record api_boundaries_record, api_loop_record, api_components_record,
    api_component_record;
/* The JSON members of the answers of GET /v1/token, POST /v1/tickets and POST /v1/admin/reload. */
extern const api_record api_token_record, api_ticket_record, api_reloaded_record;

#endif
