/* mesh_access.h - how a handler gets the mesh that it reads.
 *
 * A row of the table of routes says what its handler reads (api_reads) and what that costs. Before
 * the handler runs, the mesh is obtained here: the present one or an earlier revision
 * (at_revision.h), on a worker, on a thread that may block, or in a job. The handler finds it in
 * x->content, with x->info of the same revision, and releases nothing. It is called once, unless it
 * calls api_begin_elsewhere.
 *
 * A handler that changes a mesh begins a write (api_write_begin, api_write_claim). If its row needs
 * facts of the content before that, such as its size, `cost` finds them (API_READS_BEFORE). The
 * row's `begin`, called before the body arrives, gets what `begin_reads` says.
 */
#ifndef HE_API_REQUEST_MESH_ACCESS_H
#define HE_API_REQUEST_MESH_ACCESS_H

#include "api/request/exchange.h"

/* Obtains what x->reading says the handler reads, and runs the handler. A failure fills the problem
 * (404, 410, 507). A representation that the client has already is answered 304. Work that is too
 * costly for a worker, or becomes a job, stores this function in x->deferred. */
void api_read(api_exchange *x);
/* Runs the row's `begin` with the mesh that it reads. */
void api_read_at_head(api_exchange *x);
/* Reads the mesh by `reading` instead of by the route's row. A handler that has changed the mesh
 * calls it to answer with the representation of another route. */
void api_read_as(api_exchange *x, const api_reading *reading);

/* --- for handlers that read --- */
/* Keeps the mesh as long as the exchange, for a streamed answer. A shared lock is released:
 * x->content is a snapshot from then on, so handlers call this also before long work. Returns false
 * with the problem filled when memory is out. */
bool api_keep_mesh(api_exchange *x);
/* A handler that finds its work too much for a worker calls this and returns: its output
 * is dropped, and it is called again on a thread that may block. */
void api_begin_elsewhere(api_exchange *x);

/* --- for `cost` of a row --- */
/* Estimates the cost of a handler that visits the whole mesh. */
bool api_cost_of_mesh(api_exchange *x, const he_mesh *mesh, api_cost *out);

#endif
