/* event_values.h - the values a change wrote, so that a copy can follow link for link.
 *
 *     "values":{"vertices":[[id,x,y,z,halfedge]],"halfedges":[[id,next,prev,origin,face]],
 *               "faces":[[id,halfedge]],"attributes":{"faces":{"group":[[id,v,...]]}}}
 *
 * Rows are those the records of a delta touch, ascending, with their values after it; absent links
 * are null. They are more than the sets of `modified` name: a half-edge along a hole is in none of
 * those. Of attributes that are not finite null is said. */
#ifndef HE_API_EVENT_EVENT_VALUES_H
#define HE_API_EVENT_EVENT_VALUES_H

#include "api/json/json_out.h"
#include "mesh/delta.h"

/* The members values, and attributes_added and attributes_dropped where columns came or went, of
 * an object that is open. `mesh` is in the state after `delta`, or before it when it was undone.
 * HE_NO_MEMORY: what was written so far is good for nothing. */
HE_NODISCARD he_status api_write_values(api_out *out, const he_mesh *mesh, const he_delta *delta,
                                        bool undone, he_error *err);

#endif
