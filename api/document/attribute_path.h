/* attribute_path.h - finds the attribute that the path of a request names (by x->kind and
 * x->attribute). */
#ifndef HE_API_DOCUMENT_ATTRIBUTE_PATH_H
#define HE_API_DOCUMENT_ATTRIBUTE_PATH_H

#include "api/request/exchange.h"
#include "mesh/column.h"

/* The name under which the positions of vertices are read and written like an attribute; no
 * attribute may have it. */
#define API_POSITION "position"

/* Returns true if the request's path names the positions of vertices. */
bool api_attribute_is_position(const api_exchange *x);

/* Finds the attribute that the request's path names, or describes the positions of vertices as a
 * column (he_mesh_position_column), which lives as long as the request. Returns NULL with
 * no_such_attribute if there is no such attribute, or when memory is out. */
const he_column *api_attribute_find(api_exchange *x, const he_mesh *mesh);

/* Writes the path of the attribute that the request's path names, percent-encoded, for the header
 * Location. */
void api_attribute_path(const api_exchange *x, char out[API_LOCATION]);

#endif
