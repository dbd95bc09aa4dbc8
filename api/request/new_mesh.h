/* new_mesh.h - making a mesh for a request, under an id that its token may use. */
#ifndef HE_API_REQUEST_NEW_MESH_H
#define HE_API_REQUEST_NEW_MESH_H

#include "api/request/exchange.h"

/* Makes a mesh with st_create_from, with the request's Idempotency-Key. If `id` is NULL the server
 * chooses one, which begins with the first prefix of the token, if it has prefixes. Takes `content`
 * on success. */
st_status api_mesh_new(api_exchange *x, const char *id, const char *name, he_mesh *content,
                       const st_shown *from, st_mesh **out);

#endif
