/* named_meshes.h - the other meshes that the operations of a request name, as `append` does.
 *
 * other_mesh.h says when they are looked up. A snapshot of each is taken before the edited mesh is
 * locked. The edited mesh may itself be one of them; its snapshot is then its state before the
 * edit. */
#ifndef HE_API_WRITE_NAMED_MESHES_H
#define HE_API_WRITE_NAMED_MESHES_H

#include "api/ask/other_mesh.h"
#include "api/write/decode_op.h"

typedef struct api_named_meshes {
    api_meshes meshes; /* the function that finds these meshes; passed to api_decode_op */
    api_exchange *asker;
    api_other_mesh other[API_MAX_NAMED_MESHES];
    size_t count;
    /* The description (name, revision and so on) of each mesh at the time of its snapshot. */
    st_shown shown[API_MAX_NAMED_MESHES];
    /* How many of these meshes are not in memory; unless this is 0, api_named_meshes_load must be
     * called. */
    size_t cold;
} api_named_meshes;

/* Initializes an empty list. The function `find` of its member `meshes` adds each mesh once, and
 * refuses a mesh that does not exist and more meshes than API_MAX_NAMED_MESHES. */
void api_named_meshes_init(api_named_meshes *named, api_exchange *asker);
/* Loads the meshes that are not in memory; the call may block. On failure returns false with
 * x->problem filled. */
bool api_named_meshes_load(api_exchange *x, api_named_meshes *named);
/* Returns the present number of elements of all other meshes that operations name, from which the
 * cost of the request is estimated. */
uint64_t api_named_meshes_elements(const api_named_meshes *named);
/* Returns true if an earlier revision is named, whose snapshot a worker thread must not take. */
bool api_named_meshes_reach_back(const api_named_meshes *named);
/* Takes a snapshot of each mesh; returns false with x->problem filled. api_named_meshes_release
 * releases the snapshots; api_named_meshes_clear also releases the references to the meshes. */
bool api_named_meshes_take(api_exchange *x, api_named_meshes *named);
void api_named_meshes_release(api_named_meshes *named);
void api_named_meshes_clear(api_named_meshes *named);

#endif
