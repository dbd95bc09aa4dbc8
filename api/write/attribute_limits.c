#include "api/write/attribute_limits.h"

#include "api/limits.h"

api_attribute_count api_count_attributes(const he_mesh *mesh)
{
    api_attribute_count count = {0, 0};
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        const he_column *column = he_mesh_column(mesh, i);
        if (column != NULL) {
            size_t labels = column->labels != NULL ? he_labels_count(column->labels) : 0;
            count.columns++;
            count.labels = labels > count.labels ? labels : count.labels;
        }
    }
    return count;
}

bool api_within_attributes(api_attribute_count before, const he_mesh *mesh, const api_in *in)
{
    const api_attribute_count after = api_count_attributes(mesh);
    if (after.columns > before.columns && after.columns > API_MAX_ATTRIBUTES) {
        return api_in_fail(in, HE_LIMIT,
                           "the mesh would have %zu attributes; at most %d are allowed",
                           after.columns, (int)API_MAX_ATTRIBUTES);
    }
    if (after.labels > before.labels && after.labels > API_MAX_LABELS) {
        return api_in_fail(in, HE_LIMIT,
                           "an attribute would have %zu labels; at most %d are allowed",
                           after.labels, (int)API_MAX_LABELS);
    }
    return true;
}
