/* meshes.c - requests to one mesh that do not change its content: rename, delete, copy. */
#include "api/request/handlers.h"

#include "api/document/summary.h"
#include "api/request/gate.h"
#include "api/request/new_mesh.h"

#include <stdio.h>
#include <string.h>

static const char *const patch_members[] = {"name", NULL};

/* Changes the name of a mesh. By RFC 7396, null removes a member, which makes the name empty. */
void api_mesh_patch(api_exchange *x)
{
    const char *name = NULL;
    api_in member;
    if (!api_in_only(&x->root, patch_members)) {
        return;
    }
    if (api_in_find(&x->root, "name", &member)) {
        name = "";
        if (!api_in_is_null(&member) && !api_in_seen_name(&member, ST_MESH_NAME, &name)) {
            return;
        }
    }
    if (!api_write_begin(x, NULL)) {
        return;
    }
    if (name != NULL && strcmp(name, x->info.name) != 0) {
        st_write_rename(&x->write, name);
        if (!api_write_commit(x, NULL)) {
            return;
        }
    } else {
        st_write_abort(&x->write);
        api_publish(x, 204);
    }
    api_answer_etag(x, "summary");
    if (!api_answer_minimal(x)) {
        api_answer_summary(x);
    }
}

void api_mesh_delete(api_exchange *x)
{
    /* Beginning a write checks the preconditions of the request, as for any write. */
    if (!api_write_begin(x, NULL)) {
        return;
    }
    st_write_remove(&x->write);
    if (api_write_commit(x, NULL)) {
        api_answer_empty(x, 204);
    }
}

void api_mesh_delete_cold(api_exchange *x, st_cold *cold)
{
    if (!api_preconditions_hold(x, NULL) || !api_gate_may_change(x)) {
        return;
    }
    const st_status status = st_cold_remove(cold);
    if (status != ST_OK) {
        (void)api_fail_store(x, status);
        return;
    }
    x->info = cold->info;
    api_publish(x, 204);
    api_answer_empty(x, 204);
}

static const char *const copy_members[] = {"id", "name", NULL};

/* The id and the name that the client wants for the copy. A NULL id is chosen by the server; with a
 * NULL name the copy gets the name of the original. */
typedef struct copy_request {
    const char *id, *name;
} copy_request;

static bool read_copy(api_exchange *x, copy_request *r)
{
    api_in member;
    if (!x->has_root) {
        return true;
    }
    if (!api_in_only(&x->root, copy_members)) {
        return false;
    }
    if (api_in_find(&x->root, "id", &member)) {
        if (!api_in_string(&member, ST_MESH_ID, &r->id)) {
            return false;
        }
        if (!api_path_is_mesh_id(r->id)) {
            return api_in_fail(&member, API_BAD_ID, "\"%s\" cannot be the id of a mesh", r->id);
        }
        if (!api_gate_may_create(x, r->id)) {
            api_in_point(&member);
            return false;
        }
    }
    return !api_in_find(&x->root, "name", &member) ||
           api_in_seen_name(&member, ST_MESH_NAME, &r->name);
}

/* The progress (0 to 1) that is reached after copying the mesh; then the summary is computed. */
static const double COPY_SHARE = 0.4;

bool api_mesh_copy_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    copy_request *r = api_arena_array(&x->arena, 1, sizeof *r);
    if (r == NULL) {
        return api_fail_memory(x);
    }
    *r = (copy_request){NULL, NULL};
    x->state = r;
    uint64_t elements = api_elements_of(mesh);
    out->elements = st_store_waits_for_disk(x->store) ? UINT64_MAX : elements;
    out->seconds = (double)elements / API_COPY_PER_SECOND;
    return read_copy(x, r) && api_preconditions_hold(x, NULL);
}

/* Copies the content of a mesh and computes the summary of the copy, which is not stored yet, so
 * that no other request can change it. */
static bool make_copy(api_exchange *x, he_mesh **out, api_summary *summary)
{
    he_mesh *fresh = NULL;
    he_error err = {0};
    he_progress_span(&x->progress, COPY_SHARE);
    if (he_mesh_copy_with_progress(x->content, &x->progress, &fresh, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    he_progress_span(&x->progress, 1);
    if (!api_summary_find(x, fresh, summary)) {
        he_mesh_free(fresh);
        return false;
    }
    he_mesh_set_progress(fresh, NULL);
    *out = fresh;
    return true;
}

void api_mesh_copy(api_exchange *x)
{
    const copy_request *r = x->state;
    he_mesh *fresh = NULL;
    st_mesh *made = NULL;
    api_summary summary;
    if (!api_preconditions_hold(x, NULL) || !make_copy(x, &fresh, &summary)) {
        return;
    }
    char name[ST_MESH_NAME + 1];
    snprintf(name, sizeof name, "%s", r->name != NULL ? r->name : x->info.name);
    const st_shown from = st_shown_of(&x->info);
    st_status stored = api_mesh_new(x, r->id, name, fresh, &from, &made);
    if (stored != ST_OK) {
        he_mesh_free(fresh);
        api_fail_store(x, stored);
        return;
    }
    st_release(x->mesh);
    x->mesh = made;
    api_answer_created(x, name, &summary, NULL);
}
