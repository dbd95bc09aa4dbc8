/* create.c - POST /v1/meshes and PUT /v1/meshes/{mesh}: creates a mesh, or replaces its content. */
#include "api/request/handlers.h"

#include "api/request/gate.h"
#include "api/request/new_mesh.h"

#include "api/document/summary.h"
#include "api/document/upload.h"

/* Reads a piece of the body of a POST or PUT. */
static void body(api_exchange *x, const char *bytes, size_t length)
{
    if (x->problem.code == HE_OK) {
        api_upload_feed(x, bytes, length);
    }
}

/* Refuses an invalid id before the client has sent the body. */
void api_meshes_create_begin(api_exchange *x)
{
    const char *id = api_param_text(x, "id");
    if (id == NULL || !api_path_is_mesh_id(id) || api_gate_may_create(x, id)) {
        api_upload_begin(x);
    }
}

void api_meshes_create_body(api_exchange *x, const char *bytes, size_t length)
{
    body(x, bytes, length);
}

/* If the mesh was deleted while the body of a PUT arrived, the PUT creates the mesh instead of
 * replacing it. */
static bool forget_removed(api_exchange *x)
{
    if (x->problem.code != API_NO_SUCH_MESH) {
        return false;
    }
    x->problem = (api_problem){0};
    st_release(x->mesh);
    x->mesh = NULL;
    return true;
}

/* Refuses failed preconditions before the client has sent the body. */
void api_mesh_put_begin(api_exchange *x)
{
    /* The preconditions of a mesh that is not in memory are checked after the body has arrived. */
    bool good = x->is_cold;
    if (x->mesh != NULL) {
        good = (!x->info.busy || api_fail_store(x, ST_BUSY)) && api_preconditions_hold(x, NULL);
    } else if (!x->is_cold) {
        good = api_precondition_absent(x);
    }
    if (good) {
        api_upload_begin(x);
    }
}

void api_mesh_put_body(api_exchange *x, const char *bytes, size_t length)
{
    body(x, bytes, length);
}

/* A mesh that is not stored yet, so that no other request can change it, and its summary. */
typedef struct made {
    he_mesh *mesh;
    api_summary summary;
} made;

static bool build(api_exchange *x, made *out)
{
    if (!api_upload_build(x, &out->mesh)) {
        return false;
    }
    he_mesh_set_progress(out->mesh, &x->progress);
    he_progress_span(&x->progress, 1);
    if (!api_summary_find(x, out->mesh, &out->summary)) {
        he_mesh_free(out->mesh);
        return false;
    }
    he_mesh_set_progress(out->mesh, NULL);
    return true;
}

/* Returns the name that the request gives to a new mesh, or "". */
static const char *first_name(const api_exchange *x)
{
    const char *name = api_upload_name(x);
    return name == NULL ? "" : name;
}

/* Stores a new mesh; on success the store owns `mesh`. If `id` is NULL, the store chooses one. */
static st_status store_new(api_exchange *x, const char *id, he_mesh *mesh)
{
    return api_mesh_new(x, id, first_name(x), mesh, NULL, &x->mesh);
}

static void create(api_exchange *x)
{
    const char *id = api_param_text(x, "id");
    made m;
    if (!build(x, &m)) {
        return;
    }
    st_status status = store_new(x, id, m.mesh);
    if (status == ST_OK) {
        api_answer_created(x, first_name(x), &m.summary, api_upload_write_report);
    } else {
        he_mesh_free(m.mesh);
        api_fail_store(x, status);
    }
}

/* Replaces a damaged mesh. The new mesh gets the id of the damaged one, and also its name unless
 * the request has a name. Returns false if the damaged mesh was deleted meanwhile. */
static bool replace_damaged(api_exchange *x, const made *m)
{
    st_mesh *fresh = NULL;
    char name[ST_MESH_NAME + 1];
    (void)st_read_card(x->mesh, &x->info);
    x->has_info = true;
    if (!x->info.removed && !api_preconditions_hold(x, NULL)) {
        he_mesh_free(m->mesh);
        return true;
    }
    st_copy_text(name, api_upload_name(x) != NULL ? api_upload_name(x) : x->info.name,
                 ST_MESH_NAME);
    const st_cause cause = api_cause(x);
    st_status status = st_create_over(x->store, x->mesh, name, m->mesh, &cause, &fresh);
    if (status == ST_OK) {
        st_release(x->mesh);
        x->mesh = fresh;
        api_answer_created(x, name, &m->summary, api_upload_write_report);
        return true;
    }
    if (status != ST_ABSENT) {
        he_mesh_free(m->mesh);
    }
    api_fail_store(x, status);
    return status != ST_ABSENT;
}

/* Replaces the content of a mesh. Returns false, with nothing changed, if the mesh was deleted
 * meanwhile. */
static bool replace(api_exchange *x, const made *m)
{
    if (st_unreadable(x->mesh) != ST_OK) {
        return replace_damaged(x, m);
    }
    st_stage *stage;
    st_status status = st_store_stage(x->store, m->mesh, &stage);
    if (status != ST_OK) {
        he_mesh_free(m->mesh);
        return !api_fail_store(x, status);
    }
    if (!api_write_begin(x, NULL)) {
        bool removed = x->problem.code == API_NO_SUCH_MESH;
        st_store_unstage(x->store, stage);
        if (!removed) {
            he_mesh_free(m->mesh);
        }
        return !removed;
    }
    const char *name = api_upload_name(x);
    st_write_replace(&x->write, m->mesh, stage);
    if (name != NULL) {
        st_write_rename(&x->write, name);
    }
    if (!api_write_commit(x, NULL)) {
        return true;
    }
    api_answer_etag(x, "summary");
    if (!api_answer_minimal(x)) {
        api_answer_stored(x, 200, &m->summary, api_upload_write_report);
    }
    return true;
}

/* Creates the mesh under the id in the path. Returns false, with nothing changed, if another
 * request has created a mesh with this id meanwhile; x->mesh then refers to that mesh. */
static bool create_named(api_exchange *x, const made *m)
{
    if (!api_precondition_absent(x)) {
        he_mesh_free(m->mesh);
        return true;
    }
    st_status status = store_new(x, x->mesh_id, m->mesh);
    if (status == ST_OK) {
        api_answer_created(x, first_name(x), &m->summary, api_upload_write_report);
        return true;
    }
    if (status == ST_TAKEN) {
        status = st_load(x->store, x->mesh_id, &x->mesh);
        if (status == ST_OK || status == ST_ABSENT) {
            return false;
        }
    }
    he_mesh_free(m->mesh);
    api_fail_store(x, status);
    return true;
}

/* Stores the mesh of a PUT. Other requests may create or delete a mesh with this id meanwhile, so
 * this tries in turn to replace and to create it. */
static void put(api_exchange *x)
{
    made m;
    if ((x->mesh == NULL && !api_precondition_absent(x)) || !build(x, &m)) {
        return;
    }
    while (x->mesh == NULL ? !create_named(x, &m) : !replace(x, &m)) {
        forget_removed(x);
    }
}

static void finish(api_exchange *x, void (*make)(api_exchange *x))
{
    if (!api_upload_end(x)) {
        return;
    }
    uint64_t elements = api_upload_elements(x);
    bool costly = elements > API_COSTLY_ELEMENTS || api_upload_is_guessed(x) ||
                  st_store_waits_for_disk(x->store);
    api_run_long(x, make, costly, (double)elements / API_IMPORT_PER_SECOND);
}

void api_meshes_create(api_exchange *x)
{
    const char *id = api_param_text(x, "id");
    if (id != NULL && !api_path_is_mesh_id(id)) {
        api_fail(x, API_BAD_ID, "\"%.100s\" cannot be the id of a mesh", id);
        return;
    }
    finish(x, create);
}

void api_mesh_put(api_exchange *x)
{
    finish(x, put);
}
