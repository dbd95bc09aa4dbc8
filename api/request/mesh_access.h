/* mesh_access.h - how a handler comes by the mesh that it reads.
 *
 * A row of the table of routes says what its handler reads (api_reads) and what that costs. Before
 * the handler runs, the mesh is obtained here: the present one or an earlier revision
 * (at_revision.h), on a worker, on a thread that may block, or in a job. The handler finds it in
 * x->content with x->info of the same revision, and gives nothing back. It is entered once, but for
 * what api_begin_elsewhere says.
 *
 * A handler that changes a mesh begins a write of it (api_write_begin, api_write_claim). What its
 * row has to know of the content before, such as how large it is, `cost` finds here
 * (API_READS_BEFORE). So do the row's `begin`, before the body comes, with what `begin_reads` says.
 */
#ifndef HE_API_REQUEST_MESH_ACCESS_H
#define HE_API_REQUEST_MESH_ACCESS_H

#include "api/request/exchange.h"

/* Obtain what x->reading asks for and run its handler. What is wrong is the problem (404, 410,
 * 507); what the client has already is answered 304; what costs too much for a worker, or is to be
 * a job, leaves this function in x->deferred. */
void api_read(api_exchange *x);
/* Runs the row's `begin` with what it reads. */
void api_read_at_head(api_exchange *x);
/* Reads the mesh by `reading` instead of by the row of the route. A handler that has changed the
 * mesh calls it to answer with what another route reads. */
void api_read_as(api_exchange *x, const api_reading *reading);

/* --- for handlers that read --- */
/* The mesh at hand is to live as long as the exchange, for an answer that is pulled. A lock is
 * given back, so that this is called also before what takes long: x->content is a snapshot from
 * then on. False with the problem filled when there is no memory for it. */
bool api_keep_mesh(api_exchange *x);
/* What the handler found on its way is too much for a worker. It returns, what it wrote is dropped,
 * and it is entered anew on a thread that may block. */
void api_begin_elsewhere(api_exchange *x);

/* --- for `cost` of a row --- */
/* The whole mesh is looked at. */
bool api_cost_of_mesh(api_exchange *x, const he_mesh *mesh, api_cost *out);

#endif
