/* Which thread makes a snapshot of a mesh: never a worker if the mesh is large. No snapshot is made
 * at all if the client already has the present state. */
#include "tests/api/request.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static int snapshots;

/* The linker replaces calls of the functions below by calls of the wrappers in this file (see the
 * Makefile), which count them. */
st_status __real_st_snapshot_take(st_mesh *mesh, st_snapshot **out);
st_status __wrap_st_snapshot_take(st_mesh *mesh, st_snapshot **out);
st_status __real_st_snapshot_held(st_mesh *mesh, st_snapshot **out);
st_status __wrap_st_snapshot_held(st_mesh *mesh, st_snapshot **out);

st_status __wrap_st_snapshot_take(st_mesh *mesh, st_snapshot **out)
{
    snapshots++;
    return __real_st_snapshot_take(mesh, out);
}

st_status __wrap_st_snapshot_held(st_mesh *mesh, st_snapshot **out)
{
    snapshots++;
    return __real_st_snapshot_held(mesh, out);
}

typedef struct fixture {
    api_bench *bench;
    api_service *service;
} fixture;

static void begin(fixture *f, const char *shape)
{
    f->bench = bench_new();
    bench_reply r = bench_send(f->bench, "POST", "/v1/meshes?id=m", NULL, shape);
    assert_int_equal(r.status, 201);
    bench_reply_free(&r);
    f->service =
        api_service_new(bench_store(f->bench), api_routes(), &(api_options){.version = "0"});
    assert_non_null(f->service);
}

static void end(fixture *f)
{
    api_service_free(f->service);
    bench_free(f->bench);
}

static const struct {
    const char *method, *path, *accept;
    int status;
} cases[] = {
    {"GET", "/v1/meshes/m/content", NULL, 200},
    {"GET", "/v1/meshes/m/content", "model/stl", 200},
    {"GET", "/v1/meshes/m/geometry", NULL, 200},
    {"GET", "/v1/meshes/m/faces", "application/x-ndjson", 200},
    {"GET", "/v1/meshes/m/boundaries", NULL, 200},
    {"GET", "/v1/meshes/m/components", NULL, 200},
    {"GET", "/v1/meshes/m/check", NULL, 200},
    {"POST", "/v1/meshes/m/copy", NULL, 201},
};

/* Begins request number `i` of the table on a worker; `none` is the value of its header
 * If-None-Match. */
static api_exchange *send(fixture *f, size_t i, const char *none, api_step *step)
{
    api_request request = {
        .method = cases[i].method,
        .path = cases[i].path,
        .query = "",
        .request_id = "r",
        .headers = {[API_HEADER_ACCEPT] = cases[i].accept, [API_HEADER_IF_NONE_MATCH] = none}};
    api_exchange *x = api_begin(f->service, &request, step);
    assert_non_null(x);
    if (*step == API_MORE) {
        *step = api_end(x);
    }
    return x;
}

static void a_worker_makes_no_snapshot_of_a_large_mesh(void **state)
{
    (void)state;
    fixture f;
    begin(&f, "{\"shape\":\"grid\",\"columns\":100,\"rows\":100}");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_step step;
        snapshots = 0;
        api_exchange *x = send(&f, i, NULL, &step);
        assert_int_equal(step, API_WORK);
        assert_int_equal(snapshots, 0);
        api_work(x);
        assert_int_equal(snapshots, 1);
        assert_int_equal(api_answer_of(x)->status, cases[i].status);
        api_free(x);
    }
    end(&f);
}

static void nobody_makes_one_for_whom_nothing_changed(void **state)
{
    (void)state;
    static const char *const shapes[] = {"{\"shape\":\"grid\",\"columns\":100,\"rows\":100}",
                                         "{\"shape\":\"cube\"}"};
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        fixture f;
        begin(&f, shapes[s]);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            api_step step;
            if (cases[i].status != 200) {
                continue;
            }
            /* The first request computes everything that the entity tag is made from, such as the
             * layout of the arrays, so that the second request can be answered from the tag
             * alone. */
            api_exchange *x = send(&f, i, NULL, &step);
            if (step == API_WORK) {
                api_work(x);
            }
            api_free(x);
            snapshots = 0;
            x = send(&f, i, "*", &step);
            if (step == API_WORK) {
                api_work(x);
            }
            assert_int_equal(api_answer_of(x)->status, 304);
            assert_int_equal(snapshots, 0);
            api_free(x);
        }
        end(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_worker_makes_no_snapshot_of_a_large_mesh),
        cmocka_unit_test(nobody_makes_one_for_whom_nothing_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
