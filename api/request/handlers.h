/* handlers.h - the handlers, which the rows of routes.c name. exchange.h says what is prepared
 * before a handler runs. A handler whose row declares a cost has a second function that estimates
 * it (api_reading in route.h). */
#ifndef HE_API_REQUEST_HANDLERS_H
#define HE_API_REQUEST_HANDLERS_H

#include "api/request/exchange.h"

/* pages.c: pages and documents that are not about a mesh. */
void api_live_get(api_exchange *x);
void api_ready_get(api_exchange *x);
void api_version_get(api_exchange *x);
void api_index_get(api_exchange *x);
void api_metrics_get(api_exchange *x);
void api_page_get(api_exchange *x); /* serves "/", "/docs/..." and "/assets/..." */
void api_problems_get(api_exchange *x);
void api_problem_get(api_exchange *x);
void api_operations_get(api_exchange *x);
void api_openapi_get(api_exchange *x);

/* The rights of a token, tickets, and reading the token file again (token.c). */
void api_token_get(api_exchange *x);
void api_tickets_post(api_exchange *x);
void api_admin_reload(api_exchange *x);

/* The backup of the store (backup.c). */
void api_admin_backup(api_exchange *x);

/* Jobs. These handlers use x->job_id. */
void api_jobs_list(api_exchange *x);
void api_job_get(api_exchange *x);
void api_job_delete(api_exchange *x);
void api_job_result(api_exchange *x);
void api_job_events(api_exchange *x);

/* The list of meshes, and new meshes. */
void api_meshes_list(api_exchange *x);
void api_meshes_create_begin(api_exchange *x);
void api_meshes_create_body(api_exchange *x, const char *bytes, size_t length);
void api_meshes_create(api_exchange *x);

/* One mesh as a whole. */
void api_mesh_patch(api_exchange *x);
void api_mesh_put_begin(api_exchange *x);
void api_mesh_put_body(api_exchange *x, const char *bytes, size_t length);
void api_mesh_put(api_exchange *x);
void api_mesh_delete(api_exchange *x);
void api_mesh_delete_cold(api_exchange *x, st_cold *cold);
void api_content_get(api_exchange *x);
bool api_content_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_geometry_get(api_exchange *x);
bool api_geometry_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_progressive_get(api_exchange *x);
bool api_progressive_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_mesh_copy(api_exchange *x);
bool api_mesh_copy_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);

/* The clients that show themselves at a mesh (presence.c). */
void api_clients_list(api_exchange *x);
void api_clients_list_cold(api_exchange *x, st_cold *cold);
void api_client_put(api_exchange *x);
void api_client_put_cold(api_exchange *x, st_cold *cold);

/* Elements of a mesh. These handlers use x->kind, x->id, and the route's relation. */
void api_elements_list(api_exchange *x);
bool api_elements_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_element_get(api_exchange *x);
void api_relation_get(api_exchange *x);

/* Attributes of a mesh. These handlers use x->kind and x->attribute. */
void api_attributes_list(api_exchange *x);
void api_materials_list(api_exchange *x);
void api_attribute_get(api_exchange *x);
bool api_attribute_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_attribute_put_begin(api_exchange *x);
void api_attribute_put_body(api_exchange *x, const char *bytes, size_t length);
void api_attribute_put(api_exchange *x);
void api_attribute_patch(api_exchange *x);
void api_attribute_delete(api_exchange *x);

/* Questions about a mesh. */
void api_query_post(api_exchange *x);
bool api_query_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_traverse_post(api_exchange *x);
bool api_traverse_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
bool api_deform_decode(api_exchange *x);
void api_deform_post(api_exchange *x);
bool api_deform_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_boundaries_get(api_exchange *x);
void api_components_get(api_exchange *x);
void api_check_get(api_exchange *x);
bool api_check_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
bool api_compare_decode(api_exchange *x);
bool api_compare_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_compare_post(api_exchange *x);

/* Edits and history. */
bool api_edits_decode(api_exchange *x);
bool api_edits_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_edits_post(api_exchange *x);
void api_edits_list(api_exchange *x);
void api_moment_patch(api_exchange *x);
bool api_undo_decode(api_exchange *x);
bool api_redo_decode(api_exchange *x);
bool api_undo_cost(api_exchange *x, const he_mesh *mesh, api_cost *out);
void api_undo_post(api_exchange *x);
void api_events_get(api_exchange *x);

#endif
