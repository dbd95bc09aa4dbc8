/* attribute_octets.h - the values of an attribute, or the positions of vertices, as binary data. */
#ifndef HE_API_READ_ATTRIBUTE_OCTETS_H
#define HE_API_READ_ATTRIBUTE_OCTETS_H

#include "api/request/exchange.h"
#include "mesh/column.h"

/* Checks the query of a request for binary data: only `revision`, `ids` and `type` may be given,
 * and `type` must be the column's type, or float for a column of doubles, or double for one of
 * floats. Returns false with bad_parameter. */
bool api_attribute_octets_admit(api_exchange *x, const he_column *column);

/* Answers with the values of the attribute that the path names: those of the `count` live elements
 * in `ids`, or, if it is NULL, a value for each issued id. Refuses with 422 if a double is too
 * large for the float that was asked for. */
void api_attribute_octets(api_exchange *x, const uint32_t *ids, size_t count);

#endif
