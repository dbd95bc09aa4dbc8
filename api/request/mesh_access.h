/* mesh_access.h - how a handler gets the mesh that it reads.
 *
 * A row of the table of routes says what its handler reads (api_reads) and what that costs. Before
 * the handler runs, api_read obtains the mesh: the present one or an earlier revision
 * (at_revision.h), on a worker thread, on a thread that may block, or in a job. The handler finds
 * the mesh in x->content, described by x->info, and need not release it. A handler is called once,
 * unless it calls api_begin_elsewhere.
 *
 * A handler that changes a mesh begins a write (api_write_begin, api_write_claim). What it must
 * know about the mesh before that, such as its size, is found by the row's `cost`
 * (API_READS_BEFORE). For the row's `begin`, which is called before the body arrives,
 * api_read_at_head obtains what `begin_reads` says. */
#ifndef HE_API_REQUEST_MESH_ACCESS_H
#define HE_API_REQUEST_MESH_ACCESS_H

#include "api/request/exchange.h"

/* Obtains the mesh as x->reading says, and runs the handler. A failure fills the problem (404, 410,
 * 507). If the client has the representation already, the answer is 304. If the work is too costly
 * for a worker thread or becomes a job, the handler does not run: x->deferred is set to api_read,
 * which is then called on another thread. */
void api_read(api_exchange *x);
/* Obtains the mesh as the member `begin_reads` of the route's row says, and calls the row's
 * function `begin`. */
void api_read_at_head(api_exchange *x);
/* Does what api_read does, with `reading` instead of what the route's row says. A handler that has
 * changed the mesh calls this function to answer as another route would. */
void api_read_as(api_exchange *x, const api_reading *reading);

/* --- for handlers that read --- */
/* Keeps the mesh as long as the exchange, for a streamed answer. If the mesh was read under the
 * shared lock, the lock is released and x->content becomes a snapshot. So handlers also call this
 * function before long work. Returns false with the problem filled when memory is out. */
bool api_keep_mesh(api_exchange *x);
/* A handler that finds that its work takes too long for a worker thread calls this function and
 * returns. Its output is dropped, and the handler is called again on a thread that may block. */
void api_begin_elsewhere(api_exchange *x);

/* --- for the member `cost` of a route --- */
/* Sets the cost of a handler that visits the whole mesh: the number of elements of the mesh. */
bool api_cost_of_mesh(api_exchange *x, const he_mesh *mesh, api_cost *out);

#endif
