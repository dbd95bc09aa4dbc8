/* GET .../progressive: a coarse mesh and the way back, made from a snapshot; see progressive_rows.h
 * for its bytes. It is made anew for each answer, and the same each time: nothing is kept. While it
 * is made, by as many threads as there are for long work, it takes about three times the mesh;
 * while it is sent, what is still to be sent. */
#include "api/handlers.h"

#include "api/progressive_rows.h"
#include "query/geometry.h"

#include <inttypes.h>
#include <stdio.h>

static void free_progressive(void *stream)
{
    api_progressive_clear(stream);
    he_mem_free(stream);
}

static int64_t read_progressive(void *stream, char *buffer, size_t size)
{
    return (int64_t)api_progressive_read(stream, buffer, size);
}

/* Both parameters make another representation. */
enum { REPRESENTATION = 64 };

static void name_representation(api_exchange *x, char out[REPRESENTATION])
{
    snprintf(out, REPRESENTATION, "progressive-%" PRIu64 "-%" PRIu64, api_param_u64(x, "faces", 0),
             api_param_u64(x, "splits", HE_MAX_ROWS));
}

static bool make(api_exchange *x, const he_mesh *mesh, api_progressive *p)
{
    he_error err = {0};
    he_box box = {0};
    uint32_t faces = (uint32_t)api_param_u64(x, "faces", 0);
    if (he_progressive_new(mesh, faces, &x->watch, &p->mesh, &err) != HE_OK) {
        return api_fail_core(x, &err);
    }
    if (he_mesh_box(mesh, &box)) {
        p->low = box.min;
        p->high = box.max;
    }
    for (he_kind kind = HE_VERTEX; kind < HE_KIND_COUNT; kind++) {
        p->issued[kind] = he_mesh_issued(mesh, kind);
    }
    uint64_t most = api_param_u64(x, "splits", HE_MAX_ROWS);
    p->revision = x->info.revision;
    p->wanted = p->mesh.count < most ? p->mesh.count : (size_t)most;
    return api_progressive_write(p, &err) == HE_OK || api_fail_core(x, &err);
}

void api_progressive_get(api_exchange *x)
{
    char representation[REPRESENTATION];
    const he_mesh *mesh;
    name_representation(x, representation);
    if (api_not_modified_yet(x, representation)) {
        return;
    }
    api_snapshot *snapshot = api_snapshot_of(x, &mesh);
    if (snapshot == NULL) {
        return;
    }
    if (!api_not_modified(x, representation)) {
        api_progressive *p = he_mem_zero(1, sizeof *p);
        if (p == NULL) {
            api_fail_memory(x);
        } else if (make(x, mesh, p)) {
            api_answer_stream(x, 200, "application/octet-stream", api_progressive_bytes(p),
                              read_progressive, p, free_progressive);
        } else {
            free_progressive(p);
        }
    }
    x->store->snapshot_release(x->store->self, snapshot);
}
