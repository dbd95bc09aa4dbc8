/* samples.h - a few meshes to look at, for `hedged --samples`. */
#ifndef HE_SERVER_SAMPLES_H
#define HE_SERVER_SAMPLES_H

#include "store/store.h"

/* Makes cube, icosphere and torus under these ids, each with its shape's default parameters, unless
 * an id is taken. HE_NO_MEMORY. */
HE_NODISCARD he_status srv_samples_add(st_store *store, he_error *err);

#endif
