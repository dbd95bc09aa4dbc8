/* progressive.c - GET .../progressive: a coarse mesh and the splits that refine it, made from a
 * snapshot. progressive_rows.h describes the layout. Each answer is computed anew, with equal
 * results for equal requests. The computation is parallel and needs about three times the memory of
 * the mesh; the answer, while it is sent, needs only the memory of the part that is still to be
 * sent. */
#include "api/request/handlers.h"

#include "api/read/progressive_rows.h"
#include "api/request/mesh_access.h"
#include "base/siphash.h"
#include "geometry/geometry.h"

#include <inttypes.h>
#include <math.h>
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

static he_decimate_options options_of(const api_exchange *x)
{
    return (he_decimate_options){.faces = (uint32_t)api_param_u64(x, "faces", 0),
                                 .max_error = api_param_number(x, "max_error", INFINITY),
                                 .boundary_weight =
                                     api_param_number(x, "boundary_weight", HE_BOUNDARY_WEIGHT)};
}

/* The length of the representation's name in the ETag. Each combination of parameters is a
 * representation of its own, whose name contains a hash of the parameters. */
enum { REPRESENTATION = 32 };

static void name_representation(api_exchange *x, char out[REPRESENTATION])
{
    static const uint64_t key[2] = {0, 0};
    const he_decimate_options options = options_of(x);
    const uint64_t splits = api_param_u64(x, "splits", HE_MAX_ROWS);
    uint64_t sum[2];
    he_siphash hash;
    he_siphash_begin(&hash, key);
    he_siphash_add(&hash, &options.faces, sizeof options.faces);
    he_siphash_add(&hash, &options.max_error, sizeof options.max_error);
    he_siphash_add(&hash, &options.boundary_weight, sizeof options.boundary_weight);
    he_siphash_add(&hash, &splits, sizeof splits);
    he_siphash_end(&hash, sum);
    snprintf(out, REPRESENTATION, "progressive-%016" PRIx64, sum[0]);
}

static bool make(api_exchange *x, const he_mesh *mesh, api_progressive *p)
{
    he_error err = {0};
    he_box box = {0};
    const he_decimate_options options = options_of(x);
    if (he_progressive_new(mesh, &options, &x->progress, &p->mesh, &err) != HE_OK) {
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
    return api_progressive_write(p, &x->progress, &err) == HE_OK || api_fail_core(x, &err);
}

/* Returns false if the counts of the mesh show that not all faces are triangles. */
static bool may_be_triangles(const he_mesh *mesh)
{
    uint64_t corners = 2 * (uint64_t)he_mesh_edges(mesh) - he_mesh_boundary_halfedges(mesh);
    return corners == 3 * (uint64_t)he_mesh_faces(mesh);
}

bool api_progressive_cost(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    char *representation = api_arena_array(&x->arena, REPRESENTATION, 1);
    if (representation == NULL) {
        return api_fail_memory(x);
    }
    name_representation(x, representation);
    x->reading.tag = representation;
    out->elements = api_elements_of(mesh);
    double work = may_be_triangles(mesh) ? (double)out->elements : 0;
    out->seconds = work / API_PROGRESSIVE_PER_SECOND;
    return true;
}

void api_progressive_get(api_exchange *x)
{
    api_progressive *p = he_mem_zero(1, sizeof *p);
    if (p == NULL) {
        api_fail_memory(x);
    } else if (make(x, x->content, p)) {
        const api_stream stream = {api_progressive_bytes(p), read_progressive, p, free_progressive};
        api_answer_stream(x, 200, "application/octet-stream", &stream);
    } else {
        free_progressive(p);
    }
}
