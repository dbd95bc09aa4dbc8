#include "fuzz/service.h"

#include "fuzz/fuzz.h"
#include "unit/fixture.h"

/* The budget of the service for undo and the size of its largest upload, in bytes. They are small
 * because the inputs are small. */
enum { UNDO_BUDGET = 8 << 20, UPLOAD = 64 << 10 };

static void create(api_bench *b, const char *target, const char *body)
{
    assert_int_equal(
        fuzz_service_send(b, &(bench_request){"PUT", target, NULL, body, strlen(body)}), 201);
}

api_bench *fuzz_service_new(void)
{
    api_bench *b = bench_new_within(UNDO_BUDGET, UPLOAD);
    create(b, "/v1/meshes/m", "{\"shape\":\"grid\",\"columns\":3,\"rows\":3}");
    create(b, "/v1/meshes/cube", "{\"shape\":\"cube\"}");
    create(b, "/v1/meshes/bowtie",
           "{\"vertices\":[[0,0,0],[1,0,0],[1,1,0],[-1,0,0],[-1,-1,1]],\"faces\":[[0,1,2],[0,3,4]],"
           "\"attributes\":[{\"domain\":\"faces\",\"name\":\"material\",\"type\":\"uint32\","
           "\"labels\":[\"a\",\"b\"],\"values\":[0,1]}]}");
    return b;
}

he_mesh *fuzz_service_mesh(api_bench *b, const char *id)
{
    st_store *store = bench_store(b);
    st_mesh_info info;
    st_mesh *stored;
    he_mesh *copy = NULL;
    if (st_find(store, id, &stored) != ST_OK) {
        return NULL;
    }
    const he_mesh *content = st_read_begin(stored, &info);
    assert_int_equal(he_mesh_copy(content, &copy, NULL), HE_OK);
    st_read_end(stored);
    st_release(stored);
    fixture_check(copy);
    return copy;
}

static size_t count(const char *bytes, size_t size, const char *word)
{
    size_t found = 0, length = strlen(word);
    for (size_t i = 0; i + length <= size; i++) {
        found += memcmp(bytes + i, word, length) == 0;
    }
    return found;
}

bool fuzz_service_refines(const void *bytes, size_t size)
{
    return count(bytes, size, "subdivide") > 2 || count(bytes, size, "\"steps\"") > 0;
}

int fuzz_service_send(api_bench *b, const bench_request *request)
{
    const char *method = request->method, *target = request->target;
    bench_reply r;
    assert_true(bench_try(b, request, &r));
    int status = r.status;
    FUZZ_REQUIRE(status >= 200 && status < 600 && status != 500 && status != 507,
                 "%s %s: %d %.300s", method, target, status, r.body);
    if (status >= 400) {
        const char *type = bench_header(&r, "Content-Type");
        FUZZ_REQUIRE(strcmp(type, "application/problem+json") == 0, "%s %s: %d is %s", method,
                     target, status, type);
    }
    bench_reply_free(&r);
    bench_run_jobs(b, BENCH_JOBS);
    return status;
}
