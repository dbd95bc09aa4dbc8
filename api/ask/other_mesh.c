#include "api/ask/other_mesh.h"

#include "api/header/path.h"
#include "api/request/gate.h"

#include <string.h>

/* A mesh that a body names and that does not exist is no 404: the path was found. */
static bool refuse_absent(api_exchange *x, const char *id)
{
    api_fail(x, API_NO_SUCH_MESH, "no mesh has the id \"%.64s\"", id);
    x->problem.status = 422;
    return false;
}

static bool refuse_ahead(api_exchange *x, const api_other_mesh *other)
{
    api_fail(x, API_NO_SUCH_REVISION, "mesh \"%s\" has no revision %llu yet", other->id,
             (unsigned long long)other->revision);
    x->problem.status = 422;
    return false;
}

/* Checks that a mesh in memory has reached the wanted revision. */
static bool has_reached(api_exchange *x, const api_other_mesh *other)
{
    st_mesh_info info;
    if (other->mesh == NULL || other->revision == 0) {
        return true;
    }
    (void)st_read_card(other->mesh, &info);
    return other->revision <= info.revision || refuse_ahead(x, other);
}

bool api_other_mesh_find(api_exchange *x, const api_in *at, const char *id, uint64_t revision,
                         api_other_mesh *out)
{
    api_other_mesh other = {.revision = revision};
    x->shows_all = true;
    const bool is_there = api_path_is_mesh_id(id) && api_gate_sees(x, id);
    const st_status status = is_there ? st_find(x->store, id, &other.mesh) : ST_ABSENT;
    if (status != ST_OK && status != ST_COLD) {
        refuse_absent(x, id);
        api_in_point(at);
        return false;
    }
    other.mesh = status == ST_OK ? other.mesh : NULL;
    memcpy(other.id, id, strlen(id) + 1);
    if (!has_reached(x, &other)) {
        st_release(other.mesh);
        api_in_point(at);
        return false;
    }
    *out = other;
    return true;
}

bool api_other_mesh_load(api_exchange *x, api_other_mesh *other)
{
    const st_status status =
        other->mesh != NULL ? ST_OK : st_load(x->store, other->id, &other->mesh);
    if (status != ST_OK) {
        other->mesh = NULL;
        return status == ST_ABSENT ? refuse_absent(x, other->id) : api_fail_store(x, status);
    }
    return true;
}

static bool take(api_exchange *x, api_other_mesh *other)
{
    const st_status status = other->revision == 0
                                 ? st_snapshot_take(other->mesh, &other->snapshot)
                                 : st_snapshot_at(other->mesh, other->revision, &other->snapshot);
    if (status == ST_OK) {
        return true;
    }
    other->snapshot = NULL;
    if (status == ST_GONE) {
        return api_fail(x, API_REVISION_GONE, "the history does not reach back to revision %llu",
                        (unsigned long long)other->revision);
    }
    if (status == ST_AHEAD) {
        return refuse_ahead(x, other);
    }
    return api_fail_store(x, status);
}

bool api_other_mesh_take(api_exchange *x, api_other_mesh *other)
{
    if (!take(x, other)) {
        return false;
    }
    other->content = st_snapshot_content(other->snapshot, &other->info);
    if (other->info.lost) {
        return api_fail_store(x, ST_LOST);
    }
    if (other->info.removed) {
        return refuse_absent(x, other->id);
    }
    if (other->info.unreadable != ST_OK) {
        return api_fail(x, other->info.unreadable == ST_NEWER ? API_MESH_NEWER : API_MESH_DAMAGED,
                        "mesh \"%s\": %s", other->id, st_damage(other->mesh));
    }
    return true;
}

void api_other_mesh_release(api_other_mesh *other)
{
    if (other->snapshot != NULL) {
        st_snapshot_release(other->snapshot);
        other->snapshot = NULL;
        other->content = NULL;
    }
}

void api_other_mesh_clear(api_other_mesh *other)
{
    api_other_mesh_release(other);
    st_release(other->mesh);
    other->mesh = NULL;
}
