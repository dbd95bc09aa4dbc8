/* view.h - the mesh that a question is asked of.
 *
 * On a worker it is read under the shared lock, for as long as the worker may take. On a thread of
 * the job pool it is a snapshot, so that nobody waits to write while a large mesh is searched. */
#ifndef HE_API_REQUEST_VIEW_H
#define HE_API_REQUEST_VIEW_H

#include "api/request/exchange.h"

typedef struct api_view {
    const he_mesh *mesh;
    st_snapshot *snapshot; /* NULL: under the lock */
} api_view;

/* With x->info filled. On false the problem is filled and there is nothing to end. */
bool api_view_begin(api_exchange *x, api_view *view);
void api_view_end(api_exchange *x, api_view *view);

#endif
