#include "tests/api/cubes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

api_bench *cubes_begin(void)
{
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=n", "{\"shape\":\"cube\"}")));
    return b;
}

he_mesh *cubes_copy(api_bench *b, const char *id)
{
    st_mesh *mesh = NULL;
    he_mesh *copy = NULL;
    assert_int_equal(st_find(bench_store(b), id, &mesh), ST_OK);
    assert_int_equal(he_mesh_copy(st_read_begin(mesh, NULL), &copy, NULL), HE_OK);
    st_read_end(mesh);
    st_release(mesh);
    return copy;
}

void cubes_expect(api_bench *b, const he_mesh *mesh, const char *id)
{
    he_mesh *now = cubes_copy(b, id);
    assert_true(he_mesh_equal(mesh, now));
    he_mesh_free(now);
}
