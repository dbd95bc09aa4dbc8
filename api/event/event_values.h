/* event_values.h - the new values of all elements that a change wrote, with which a client can keep
 * an exact copy of the mesh up to date.
 *
 *     "values":{"vertices":[[id,x,y,z,halfedge]],"halfedges":[[id,next,prev,origin,face]],
 *               "faces":[[id,halfedge]],"attributes":{"faces":{"group":[[id,v,...]]}}}
 *
 * There is one row for each element that the delta touches, in ascending order, with its values
 * after the change; absent links are null. Half-edges along a hole have rows here, although the
 * member `modified` of the change does not list them. Attribute values that are not finite are
 * null. */
#ifndef HE_API_EVENT_EVENT_VALUES_H
#define HE_API_EVENT_EVENT_VALUES_H

#include "api/json/json_out.h"
#include "mesh/delta.h"

/* Writes what a delta changed into an object that the caller has begun: the member `values`, and
 * attributes_added and attributes_dropped if attributes were added or removed. `mesh` is the mesh
 * after the delta was applied, or, with `undone`, after it was undone.
 * Returns HE_NO_MEMORY if memory is out; the text written so far is then unusable. */
HE_NODISCARD he_status api_write_values(api_out *out, const he_mesh *mesh, const he_delta *delta,
                                        bool undone, he_error *err);

#endif
