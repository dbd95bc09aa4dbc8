#include "api/write/named_meshes.h"

#include <string.h>

static bool find(void *context, const api_in *at, const char *id, uint64_t revision,
                 const he_mesh **out)
{
    api_named_meshes *o = context;
    id = id == NULL ? o->asker->mesh_id : id;
    o->asker->shows_all = true;
    for (size_t i = 0; i < o->count; i++) {
        if (strcmp(o->other[i].id, id) == 0 && o->other[i].revision == revision) {
            *out = o->other[i].content;
            return true;
        }
    }
    if (o->count == API_MAX_NAMED_MESHES) {
        return api_in_fail(at, HE_LIMIT, "a request may use at most %d other meshes",
                           (int)API_MAX_NAMED_MESHES);
    }
    api_other_mesh *other = &o->other[o->count];
    if (!api_other_mesh_find(o->asker, at, id, revision, other)) {
        return false;
    }
    o->cold += other->mesh == NULL;
    o->count++;
    *out = NULL;
    return true;
}

void api_named_meshes_init(api_named_meshes *o, api_exchange *asker)
{
    o->meshes = (api_meshes){find, o};
    o->asker = asker;
    o->count = 0;
    o->cold = 0;
}

bool api_named_meshes_load(api_exchange *x, api_named_meshes *o)
{
    for (size_t i = 0; i < o->count; i++) {
        if (!api_other_mesh_load(x, &o->other[i])) {
            return false;
        }
    }
    o->cold = 0;
    return true;
}

uint64_t api_named_meshes_elements(const api_named_meshes *o)
{
    uint64_t elements = 0;
    for (size_t i = 0; i < o->count; i++) {
        st_mesh_info info;
        elements += st_read_card(o->other[i].mesh, &info);
    }
    return elements;
}

bool api_named_meshes_reach_back(const api_named_meshes *o)
{
    bool reaches = false;
    for (size_t i = 0; i < o->count; i++) {
        reaches |= o->other[i].revision != 0;
    }
    return reaches;
}

bool api_named_meshes_take(api_exchange *x, api_named_meshes *o)
{
    for (size_t i = 0; i < o->count; i++) {
        if (!api_other_mesh_take(x, &o->other[i])) {
            return false;
        }
        o->shown[i] = st_shown_of(&o->other[i].info);
    }
    return true;
}

void api_named_meshes_release(api_named_meshes *o)
{
    for (size_t i = 0; i < o->count; i++) {
        api_other_mesh_release(&o->other[i]);
    }
}

void api_named_meshes_clear(api_named_meshes *o)
{
    for (size_t i = 0; i < o->count; i++) {
        api_other_mesh_clear(&o->other[i]);
    }
    o->count = 0;
    o->cold = 0;
}
