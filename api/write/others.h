/* others.h - meshes that a request names beside its own, as `append` does.
 *
 * While the request is decoded each is found and referred to; what it holds is taken later, as one
 * snapshot each, on a thread that may block and before any lock is held: the locks of two meshes
 * are never held together. A mesh may name itself, and is then taken as it was. */
#ifndef HE_API_WRITE_OTHERS_H
#define HE_API_WRITE_OTHERS_H

#include "api/request/exchange.h"
#include "api/write/decode_op.h"

typedef struct api_other {
    char id[ST_MESH_ID + 1];
    st_mesh *mesh;
    st_snapshot *snapshot; /* NULL until it is taken */
    const he_mesh *content;
} api_other;

typedef struct api_others {
    api_meshes meshes; /* give this to api_decode_op */
    api_exchange *asker;
    api_other other[API_MAX_OTHERS];
    size_t count;
    st_shown shown[API_MAX_OTHERS]; /* by their snapshots */
    size_t cold; /* of them are not in memory: api_others_load, before anything else is asked */
} api_others;

/* The first named one counts; naming more than API_MAX_OTHERS is refused as they are found, and so
 * is one that does not exist. */
void api_others_init(api_others *others, api_exchange *asker);
/* Find those that are not in memory. Waits; false with x->problem filled. */
bool api_others_load(api_exchange *x, api_others *others);
/* Of all of them now, for choosing where the work is done. */
uint64_t api_others_elements(const api_others *others);
/* Take snapshots; false with x->problem filled. They are given back by release, and the references
 * by clear, which does both. */
bool api_others_take(api_exchange *x, api_others *others);
void api_others_release(api_others *others);
void api_others_clear(api_others *others);

#endif
