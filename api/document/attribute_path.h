/* attribute_path.h - the attribute a path names: x->kind and x->attribute. */
#ifndef HE_API_DOCUMENT_ATTRIBUTE_PATH_H
#define HE_API_DOCUMENT_ATTRIBUTE_PATH_H

#include "api/request/exchange.h"
#include "mesh/column.h"

/* Built in, and so no attribute's name. */
#define API_POSITION "position"

/* NULL and no_such_attribute where there is none. */
const he_column *api_attribute_find(api_exchange *x, const he_mesh *mesh);

/* The path itself, with everything escaped that may need it. */
void api_attribute_path(const api_exchange *x, char out[API_LOCATION]);

#endif
