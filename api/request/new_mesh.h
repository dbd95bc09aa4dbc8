/* new_mesh.h - makes a mesh for a request, under an id that the request's token may use. */
#ifndef HE_API_REQUEST_NEW_MESH_H
#define HE_API_REQUEST_NEW_MESH_H

#include "api/request/exchange.h"

/* Makes a mesh with st_create_from, with the request's Idempotency-Key. If `id` is NULL, the server
 * chooses an id, which begins with the token's first prefix if the token has prefixes. On success
 * the mesh owns `content`, its data. */
st_status api_mesh_new(api_exchange *x, const char *id, const char *name, he_mesh *content,
                       const st_shown *from, st_mesh **out);

#endif
