/* attribute_path.h - finds the attribute that the path of a request names (by x->kind and
 * x->attribute). */
#ifndef HE_API_DOCUMENT_ATTRIBUTE_PATH_H
#define HE_API_DOCUMENT_ATTRIBUTE_PATH_H

#include "api/request/exchange.h"
#include "mesh/column.h"

/* The name that stands for the positions of vertices; no attribute may have it. */
#define API_POSITION "position"

/* Finds the attribute that the request's path names. Returns NULL with no_such_attribute if there
 * is none. */
const he_column *api_attribute_find(api_exchange *x, const he_mesh *mesh);

/* Writes the path of the attribute that the request's path names, percent-encoded, for the header
 * Location. */
void api_attribute_path(const api_exchange *x, char out[API_LOCATION]);

#endif
