#include "api/write/named_meshes.h"

#include "api/header/path.h"
#include "api/request/gate.h"

#include <string.h>

static bool refuse_absent(const api_in *at, const char *id)
{
    api_in_fail(at, API_NO_SUCH_MESH, "no mesh has the id \"%.64s\"", id);
    at->problem->status = 422;
    return false;
}

static bool find(void *context, const api_in *at, const char *id, const he_mesh **out)
{
    api_named_meshes *o = context;
    o->asker->shows_all = true;
    for (size_t i = 0; i < o->count; i++) {
        if (strcmp(o->other[i].id, id) == 0) {
            *out = o->other[i].content;
            return true;
        }
    }
    if (o->count == API_MAX_NAMED_MESHES) {
        return api_in_fail(at, HE_LIMIT, "a request may use at most %d other meshes",
                           (int)API_MAX_NAMED_MESHES);
    }
    api_named_mesh *other = &o->other[o->count];
    bool is_there = api_path_is_mesh_id(id) && api_gate_sees(o->asker, id);
    st_status status = is_there ? st_find(o->asker->store, id, &other->mesh) : ST_ABSENT;
    if (status == ST_COLD) {
        other->mesh = NULL;
        o->cold++;
    } else if (status != ST_OK) {
        return refuse_absent(at, id);
    }
    memcpy(other->id, id, strlen(id) + 1);
    other->snapshot = NULL;
    other->content = NULL;
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

static bool fail_absent(api_exchange *x, const char *id)
{
    api_fail(x, API_NO_SUCH_MESH, "no mesh has the id \"%s\"", id);
    x->problem.status = 422;
    return false;
}

bool api_named_meshes_load(api_exchange *x, api_named_meshes *o)
{
    for (size_t i = 0; i < o->count; i++) {
        api_named_mesh *other = &o->other[i];
        st_status status = other->mesh != NULL ? ST_OK : st_load(x->store, other->id, &other->mesh);
        if (status != ST_OK) {
            other->mesh = NULL;
            return status == ST_ABSENT ? fail_absent(x, other->id) : api_fail_store(x, status);
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

bool api_named_meshes_take(api_exchange *x, api_named_meshes *o)
{
    for (size_t i = 0; i < o->count; i++) {
        api_named_mesh *other = &o->other[i];
        st_mesh_info info;
        st_status status = st_snapshot_take(other->mesh, &other->snapshot);
        if (status != ST_OK) {
            other->snapshot = NULL;
            return api_fail_store(x, status);
        }
        other->content = st_snapshot_content(other->snapshot, &info);
        o->shown[i] = st_shown_of(&info);
        if (info.lost) {
            return api_fail_store(x, ST_LOST);
        }
        if (info.removed) {
            return fail_absent(x, other->id);
        }
        if (info.unreadable != ST_OK) {
            return api_fail(x, info.unreadable == ST_NEWER ? API_MESH_NEWER : API_MESH_DAMAGED,
                            "mesh \"%s\": %s", other->id, st_damage(other->mesh));
        }
    }
    return true;
}

void api_named_meshes_release(api_named_meshes *o)
{
    for (size_t i = 0; i < o->count; i++) {
        if (o->other[i].snapshot != NULL) {
            st_snapshot_release(o->other[i].snapshot);
            o->other[i].snapshot = NULL;
            o->other[i].content = NULL;
        }
    }
}

void api_named_meshes_clear(api_named_meshes *o)
{
    api_named_meshes_release(o);
    for (size_t i = 0; i < o->count; i++) {
        st_release(o->other[i].mesh);
    }
    o->count = 0;
    o->cold = 0;
}
