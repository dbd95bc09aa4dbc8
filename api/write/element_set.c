#include "api/write/element_set.h"

#include "api/limits.h"
#include "mesh/column.h"

bool api_in_set(const api_in *in, const char **name)
{
    api_in member, second;
    bool flag;
    if (!api_in_object(in)) {
        return false;
    }
    if (!api_in_first(in, &member)) {
        return api_in_fail(
            in, API_MISSING_MEMBER,
            "a set must name an attribute of type bool, such as {\"selected\":true}");
    }
    second = member;
    if (api_in_next(&second)) {
        return api_in_fail(&second, API_UNKNOWN_MEMBER, "a set must name exactly one attribute");
    }
    if (!api_in_bool(&member, &flag)) {
        return false;
    }
    if (!flag) {
        return api_in_fail(&member, HE_BAD_VALUE,
                           "the value of the attribute in a set must be true");
    }
    *name = api_in_name(&member);
    return true;
}

bool api_find_set(const api_in *in, const he_mesh *mesh, he_kind kind, api_arena *arena,
                  uint32_t **ids, size_t *count)
{
    const char *name;
    if (!api_in_set(in, &name)) {
        return false;
    }
    const he_column *column = he_mesh_find_column(mesh, kind, name);
    if (column == NULL) {
        api_in_fail(in, API_NO_SUCH_ATTRIBUTE, "%s have no attribute \"%.80s\"",
                    he_kind_plural(kind), name);
        in->problem->status = 422;
        return false;
    }
    if (column->type != HE_BOOL || column->components != 1) {
        return api_in_fail(in, API_WRONG_TYPE,
                           "a set needs an attribute of type bool with one component, but \"%s\" "
                           "has another type or several components",
                           name);
    }
    size_t found = 0;
    for (size_t i = 0; i < column->rows; i++) {
        found += column->data[i] != 0; /* rows of deleted elements have the default value, false */
    }
    uint32_t issued = he_mesh_issued(mesh, kind);
    found = column->fallback[0] ? issued : found;
    if (found > API_MAX_IDS) {
        return api_in_fail(in, HE_LIMIT, "the set has more than %d elements", (int)API_MAX_IDS);
    }
    uint32_t *list = api_arena_array(arena, found + 1, sizeof *list);
    if (list == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for a set of %zu elements", found);
    }
    size_t n = 0;
    for (uint32_t id = 0; id < issued && n < found; id++) {
        if (*he_column_value(column, id) != 0 && he_mesh_is_live(mesh, kind, id)) {
            list[n++] = id;
        }
    }
    *ids = list;
    *count = n;
    return true;
}
