/* sample_meshes.h - the sample meshes of `hedged --samples`. */
#ifndef HE_SERVER_SAMPLE_MESHES_H
#define HE_SERVER_SAMPLE_MESHES_H

#include "store/store.h"

/* Makes the meshes cube, icosphere and torus with the default parameters of their shapes, except
 * those whose id exists already.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status srv_sample_meshes_add(st_store *store, he_error *err);

#endif
