/* others.h - other meshes that a request names, as the operation `append` does.
 *
 * While the request is decoded, each mesh is found and a reference held. One snapshot of each is
 * taken later, on a thread that may block and before any lock is held, because the locks of two
 * meshes are never held together. A mesh may name itself; its snapshot is then its state before the
 * edit. */
#ifndef HE_API_WRITE_OTHERS_H
#define HE_API_WRITE_OTHERS_H

#include "api/request/exchange.h"
#include "api/write/decode_op.h"

typedef struct api_other {
    char id[ST_MESH_ID + 1];
    st_mesh *mesh;
    st_snapshot *snapshot; /* NULL until taken */
    const he_mesh *content;
} api_other;

typedef struct api_others {
    api_meshes meshes; /* for the scope of api_decode_op */
    api_exchange *asker;
    api_other other[API_MAX_OTHERS];
    size_t count;
    st_shown shown[API_MAX_OTHERS]; /* what the snapshots show */
    size_t cold;                    /* meshes that are not in memory: call api_others_load first */
} api_others;

/* Initializes the list. Each mesh is listed once. The `find` of `meshes` refuses a mesh that does
 * not exist and more than API_MAX_OTHERS. */
void api_others_init(api_others *others, api_exchange *asker);
/* Loads those meshes that are not in memory. Blocks. Returns false with x->problem filled. */
bool api_others_load(api_exchange *x, api_others *others);
/* Returns the present number of elements of all these meshes, to choose where the work is done. */
uint64_t api_others_elements(const api_others *others);
/* Takes a snapshot of each mesh; returns false with x->problem filled. api_others_release gives the
 * snapshots back; api_others_clear gives the references back, too. */
bool api_others_take(api_exchange *x, api_others *others);
void api_others_release(api_others *others);
void api_others_clear(api_others *others);

#endif
