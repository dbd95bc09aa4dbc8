/* other_mesh.h - a mesh that a request names beside the mesh in its path.
 *
 * While the request is decoded, the mesh is looked up, and a reference to it is held. A snapshot is
 * taken later, on a thread that may block, and while no other mesh is locked, because the locks of
 * two meshes are never held together. The mesh in the path may itself be named. */
#ifndef HE_API_ASK_OTHER_MESH_H
#define HE_API_ASK_OTHER_MESH_H

#include "api/request/exchange.h"

/* {0} names no mesh. */
typedef struct api_other_mesh {
    char id[ST_MESH_ID + 1];
    uint64_t revision; /* the revision of which a snapshot is taken; 0: the present one */
    st_mesh *mesh;     /* NULL if the mesh is not in memory */
    st_snapshot *snapshot;
    const he_mesh *content; /* that of the snapshot; NULL until api_other_mesh_take */
    st_mesh_info info;      /* description of the mesh at the time of the snapshot */
} api_other_mesh;

/* Looks up a mesh that the value at `at` of the request names; `revision` is 0 for the present one.
 * If it is not in memory, `mesh` stays NULL, and api_other_mesh_load must be called. Returns false
 * with x->problem filled (422) if there is no such mesh, or no such revision yet. */
bool api_other_mesh_find(api_exchange *x, const api_in *at, const char *id, uint64_t revision,
                         api_other_mesh *out);
/* Loads the mesh unless it is in memory; the call may block. On failure returns false with
 * x->problem filled. */
bool api_other_mesh_load(api_exchange *x, api_other_mesh *other);
/* Takes the snapshot; returns false with x->problem filled. api_other_mesh_release releases it;
 * api_other_mesh_clear also releases the reference to the mesh. */
bool api_other_mesh_take(api_exchange *x, api_other_mesh *other);
void api_other_mesh_release(api_other_mesh *other);
void api_other_mesh_clear(api_other_mesh *other);

#endif
