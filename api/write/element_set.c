#include "api/write/element_set.h"

#include "api/limits.h"
#include "mesh/column.h"

#include <math.h>
#include <string.h>

/* Reads a whole number that an int32 or a uint32 can be. */
static bool read_number(const api_in *member, api_set *out)
{
    double value = 0;
    out->is_number = true;
    if (!api_in_number(member, &value)) {
        return false;
    }
    if (value != floor(value) || value < INT32_MIN || value > UINT32_MAX) {
        return api_in_fail(member, HE_BAD_VALUE,
                           "the value in a set must be true or a whole number from %lld to %llu",
                           (long long)INT32_MIN, (unsigned long long)UINT32_MAX);
    }
    out->number = (int64_t)value;
    return true;
}

bool api_in_set(const api_in *in, api_set *out)
{
    api_in member, second;
    bool flag;
    if (!api_in_object(in)) {
        return false;
    }
    if (!api_in_first(in, &member)) {
        return api_in_fail(in, API_MISSING_MEMBER,
                           "a set must name an attribute of type bool or of whole numbers, such as "
                           "{\"selected\":true} or {\"patch\":3}");
    }
    second = member;
    if (api_in_next(&second)) {
        return api_in_fail(&second, API_UNKNOWN_MEMBER, "a set must name exactly one attribute");
    }
    *out = (api_set){.name = api_in_name(&member)};
    if (api_in_is_number(&member)) {
        return read_number(&member, out);
    }
    if (!api_in_bool(&member, &flag)) {
        return false;
    }
    return flag || api_in_fail(&member, HE_BAD_VALUE,
                               "the value of a bool attribute in a set must be true");
}

/* Returns whether the attribute can have the value that a set names. */
static bool fits(const he_column *column, const api_set *set)
{
    return column->components == 1 &&
           (set->is_number ? column->type == HE_INT32 || column->type == HE_UINT32
                           : column->type == HE_BOOL);
}

static bool is_in(const he_column *column, const api_set *set, uint32_t id)
{
    const unsigned char *at = he_column_value(column, id);
    uint32_t bits = 0;
    if (!set->is_number) {
        return *at != 0;
    }
    memcpy(&bits, at, sizeof bits);
    return set->number == (column->type == HE_INT32 ? (int64_t)(int32_t)bits : (int64_t)bits);
}

bool api_find_set(const api_in *in, const he_mesh *mesh, he_kind kind, api_arena *arena,
                  uint32_t **ids, size_t *count)
{
    api_set set;
    if (!api_in_set(in, &set)) {
        return false;
    }
    const he_column *column = he_mesh_find_column(mesh, kind, set.name);
    if (column == NULL) {
        return api_in_fail(in, HE_NO_SUCH_ATTRIBUTE, "%s have no attribute \"%.80s\"",
                           he_kind_plural(kind), set.name);
    }
    if (!fits(column, &set)) {
        return api_in_fail(in, API_WRONG_TYPE,
                           "this set needs an attribute of type %s with one component, but \"%s\" "
                           "has %u of type %s",
                           set.is_number ? "int32 or uint32" : "bool", set.name, column->components,
                           he_type_name(column->type));
    }
    const uint32_t issued = he_mesh_issued(mesh, kind);
    size_t found = 0;
    for (uint32_t id = 0; id < issued; id++) {
        found += is_in(column, &set, id) && he_mesh_is_live(mesh, kind, id);
    }
    if (found > API_MAX_IDS) {
        return api_in_fail(in, HE_LIMIT, "the set has more than %d elements", (int)API_MAX_IDS);
    }
    uint32_t *list = api_arena_array(arena, found + 1, sizeof *list);
    if (list == NULL) {
        return api_in_fail(in, HE_NO_MEMORY, "no memory for a set of %zu elements", found);
    }
    size_t n = 0;
    for (uint32_t id = 0; id < issued; id++) {
        if (is_in(column, &set, id) && he_mesh_is_live(mesh, kind, id)) {
            list[n++] = id;
        }
    }
    *ids = list;
    *count = n;
    return true;
}
