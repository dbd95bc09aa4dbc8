/* Lists of edits are sent as bodies of POST .../edits to an open mesh, a closed one and one with a
 * bow-tie (a vertex with two fans of faces). A refused list must leave the mesh unchanged in every
 * bit; after a list that succeeds the mesh must pass he_check, and undo must restore the earlier
 * mesh. */
#include "fuzz/fuzz.h"
#include "fuzz/service.h"
#include "unit/fixture.h"

static void edit(api_bench *b, const char *id, const char *body, size_t size)
{
    char target[64];
    he_mesh *before = fuzz_service_mesh(b, id);
    (void)snprintf(target, sizeof target, "/v1/meshes/%s/edits", id);
    int status = fuzz_service_send(b, &(bench_request){"POST", target, NULL, body, size});
    he_mesh *after = fuzz_service_mesh(b, id);
    FUZZ_REQUIRE(status == 200 || he_mesh_equal(before, after), "%d, and the mesh changed", status);
    (void)snprintf(target, sizeof target, "/v1/meshes/%s/undo", id);
    status = fuzz_service_send(b, &(bench_request){"POST", target, NULL, NULL, 0});
    he_mesh *undone = fuzz_service_mesh(b, id);
    /* undo answers 409 and changes nothing if the list was refused, or if it contained `compact`,
     * which ends the history */
    FUZZ_REQUIRE(status == 409 ? he_mesh_equal(undone, after)
                               : status == 200 && he_mesh_equal_live(undone, before),
                 "undo gives %d, and leads elsewhere", status);
    he_mesh_free(before);
    he_mesh_free(after);
    he_mesh_free(undone);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    static const char *const ids[] = {"m", "cube", "bowtie"};
    if (fuzz_service_refines(bytes, size)) {
        return;
    }
    api_bench *b = fuzz_service_new();
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) {
        edit(b, ids[i], (const char *)bytes, size);
    }
    bench_free(b);
}
