/* POST /v1/meshes and PUT /v1/meshes/{mesh}: making and replacing the content of a mesh. */
#include "api/handlers.h"

#include "api/summary.h"
#include "api/upload.h"

/* Both routes read alike; what differs is where the mesh goes. */
static void begin(api_exchange *x)
{
    api_upload_begin(x);
}

static void body(api_exchange *x, const char *bytes, size_t length)
{
    if (x->problem.code == HE_OK) {
        api_upload_feed(x, bytes, length);
    }
}

void api_meshes_create_begin(api_exchange *x)
{
    begin(x);
}

void api_meshes_create_body(api_exchange *x, const char *bytes, size_t length)
{
    body(x, bytes, length);
}

void api_mesh_put_begin(api_exchange *x)
{
    begin(x);
}

void api_mesh_put_body(api_exchange *x, const char *bytes, size_t length)
{
    body(x, bytes, length);
}

/* Put a new mesh into the store, and answer 201. `id` NULL lets the store choose. */
static void store_new(api_exchange *x, const char *id, he_mesh *mesh)
{
    const char *name = api_upload_name(x);
    api_store_status status =
        x->store->create(x->store->self, id, name == NULL ? "" : name, mesh, &x->mesh);
    if (status != API_STORE_OK) {
        he_mesh_free(mesh);
        api_fail_store(x, status);
        return;
    }
    if (api_read_begin(x) != NULL) {
        api_read_end(x);
        api_answer_header_format(x, "Location", "/v1/meshes/%s", x->info.id);
        api_answer_summary(x, 201, api_upload_write_report);
    }
}

static void create(api_exchange *x)
{
    he_mesh *mesh;
    if (api_upload_build(x, &mesh)) {
        store_new(x, NULL, mesh);
    }
}

static void replace(api_exchange *x, he_mesh *mesh)
{
    he_delta *delta;
    if (api_write_begin(x, NULL, &delta) == NULL) {
        he_mesh_free(mesh);
        return;
    }
    const char *name = api_upload_name(x);
    x->store->replace(x->store->self, x->mesh, mesh, &x->info);
    if (name != NULL) {
        x->store->rename(x->store->self, x->mesh, name, &x->info);
    }
    x->store->write_end(x->store->self, x->mesh);
    api_answer_summary(x, 200, api_upload_write_report);
}

static void put(api_exchange *x)
{
    he_mesh *mesh;
    if (x->mesh == NULL && !api_precondition_absent(x)) {
        return;
    }
    if (!api_upload_build(x, &mesh)) {
        return;
    }
    if (x->mesh != NULL) {
        replace(x, mesh);
    } else {
        store_new(x, x->mesh_id, mesh);
    }
}

static void finish(api_exchange *x, void (*make)(api_exchange *x))
{
    if (!api_upload_end(x)) {
        return;
    }
    if (api_is_costly(x, api_upload_elements(x), API_COSTLY_ELEMENTS)) {
        api_defer(x, make);
    } else {
        make(x);
    }
}

void api_meshes_create(api_exchange *x)
{
    finish(x, create);
}

void api_mesh_put(api_exchange *x)
{
    finish(x, put);
}
