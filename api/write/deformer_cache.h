/* deformer_cache.h - the factored system of equations of a mesh, by which deformations of the same
 * revision, with the same handles and fixed vertices, are computed again and again.
 *
 * The last system is kept with the mesh, until another one replaces it or memory is short. A
 * request that has got a system can use it until it releases it, even if the system is no longer
 * kept. */
#ifndef HE_API_WRITE_DEFORMER_CACHE_H
#define HE_API_WRITE_DEFORMER_CACHE_H

#include "api/request/exchange.h"
#include "deform/deform.h"

typedef struct api_deformer api_deformer;

/* Takes the kept system if it is that of x->content and of the sets, which were checked; else makes
 * it and keeps it. Returns what he_deformer_make returns. */
HE_NODISCARD he_status api_deformer_take(api_exchange *x, const he_deform_sets *sets,
                                         api_deformer **out, he_error *err);
void api_deformer_release(api_deformer *entry); /* takes NULL */
const he_deformer *api_deformer_get(const api_deformer *entry);

#endif
