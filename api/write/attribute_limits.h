/* attribute_limits.h - checks that an operation has not added too many attributes or labels. */
#ifndef HE_API_WRITE_ATTRIBUTE_LIMITS_H
#define HE_API_WRITE_ATTRIBUTE_LIMITS_H

#include "api/json/json_in.h"
#include "mesh/mesh.h"

typedef struct api_attribute_count {
    size_t columns, labels; /* `labels` is the highest number of labels of an attribute */
} api_attribute_count;

api_attribute_count api_count_attributes(const he_mesh *mesh);
/* Checks that the operation `in` has not added too many attributes or labels to the mesh, which had
 * `before` of them. An operation may add attributes of another mesh, the attribute `material` with
 * the first material, or attributes for corners that a weld keeps apart. If there are too many,
 * refuses with HE_LIMIT and returns false. */
bool api_within_attributes(api_attribute_count before, const he_mesh *mesh, const api_in *in);

#endif
