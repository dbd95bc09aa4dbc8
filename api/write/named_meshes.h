/* named_meshes.h - other meshes that a request names, as the operation `append` does.
 *
 * While the request is decoded, each mesh is found and a reference held. One snapshot of each is
 * taken later, on a thread that may block and before any lock is held, because the locks of two
 * meshes are never held together. A mesh may name itself; its snapshot is then its state before the
 * edit. */
#ifndef HE_API_WRITE_NAMED_MESHES_H
#define HE_API_WRITE_NAMED_MESHES_H

#include "api/request/exchange.h"
#include "api/write/decode_op.h"

typedef struct api_named_mesh {
    char id[ST_MESH_ID + 1];
    st_mesh *mesh;
    st_snapshot *snapshot; /* NULL until taken */
    const he_mesh *content;
} api_named_mesh;

typedef struct api_named_meshes {
    api_meshes meshes; /* for the scope of api_decode_op */
    api_exchange *asker;
    api_named_mesh other[API_MAX_NAMED_MESHES];
    size_t count;
    st_shown shown[API_MAX_NAMED_MESHES]; /* what the snapshots show */
    size_t cold; /* meshes that are not in memory: call api_named_meshes_load first */
} api_named_meshes;

/* Initializes the list. Each mesh is listed once. The `find` of `meshes` refuses a mesh that does
 * not exist and more than API_MAX_NAMED_MESHES. */
void api_named_meshes_init(api_named_meshes *named, api_exchange *asker);
/* Loads those meshes that are not in memory. Blocks. Returns false with x->problem filled. */
bool api_named_meshes_load(api_exchange *x, api_named_meshes *named);
/* Returns the present number of elements of all these meshes, to choose where the work is done. */
uint64_t api_named_meshes_elements(const api_named_meshes *named);
/* Takes a snapshot of each mesh; returns false with x->problem filled. api_named_meshes_release
 * gives the snapshots back; api_named_meshes_clear gives the references back, too. */
bool api_named_meshes_take(api_exchange *x, api_named_meshes *named);
void api_named_meshes_release(api_named_meshes *named);
void api_named_meshes_clear(api_named_meshes *named);

#endif
