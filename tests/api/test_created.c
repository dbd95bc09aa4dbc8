/* The answer to a request that creates a mesh shows the mesh as it was created, even if another
 * request changes it before the answer is written. */
#include "edit/local/erase.h"
#include "tests/api/request.h"
#include "tests/writing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static int vertices_of(const bench_reply *summary)
{
    const cJSON *counts = cJSON_GetObjectItem(summary->json, "counts");
    return cJSON_GetObjectItem(counts, "vertices")->valueint;
}

/* If set, a second request changes the new mesh after it was created and before the first request,
 * which created it, is answered. The linker replaces calls of st_create_from by calls of the
 * wrapper in this file (see the Makefile). */
static bool meddling;
static uint32_t victim; /* the vertex of the new mesh that the second request deletes */

st_status __real_st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content,
                                st_mesh **out);
st_status __wrap_st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content,
                                st_mesh **out);

st_status __wrap_st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content,
                                st_mesh **out)
{
    st_status status = __real_st_create_from(store, made, content, out);
    if (status == ST_OK && meddling) {
        st_write w;
        assert_non_null(writing_begin(*out, &w));
        assert_int_equal(he_vertex_delete(w.content, (he_vertex){victim}, HE_DROP_ISOLATED, NULL),
                         HE_OK);
        assert_true(writing_commit(&w, "vertex_delete", NULL));
        assert_int_equal(st_write_begin(*out, NULL, &w), ST_OK);
        st_write_rename(&w, "theirs");
        assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    }
    return status;
}

static void what_was_made_is_shown_as_it_was_made(void **state)
{
    (void)state;
    static const char *const made[][3] = {
        {"POST", "/v1/meshes?name=mine", "{\"shape\":\"cube\"}"},
        {"PUT", "/v1/meshes/new?name=mine", "{\"shape\":\"cube\"}"},
        {"POST", "/v1/meshes/new/copy", "{\"name\":\"mine\"}"},
    };
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof made / sizeof made[0]; i++) {
        meddling = true;
        /* A second writer deletes vertex i of the i-th mesh. Vertex 1 is already missing in the
         * third mesh, which is a copy of the second mesh, so a different vertex must be deleted
         * there. */
        victim = (uint32_t)i;
        bench_reply r = bench_expect(201, bench_send(b, made[i][0], made[i][1], NULL, made[i][2]));
        meddling = false;
        assert_non_null(strstr(bench_header(&r, "ETag"), "-1-1-summary"));
        assert_string_equal(bench_text(&r, "name"), "mine");
        assert_non_null(strstr(r.body, "\"revision\":1,"));
        char path[128];
        snprintf(path, sizeof path, "/v1/meshes/%s", bench_text(&r, "id"));
        int vertices = vertices_of(&r);
        bench_reply_free(&r);
        /* The summary in the first answer must not be cached as the present one: the next GET shows
         * the changed mesh. */
        r = bench_expect(200, bench_get(b, path));
        assert_non_null(strstr(r.body, "\"revision\":2,"));
        assert_true(vertices_of(&r) < vertices);
        bench_reply_free(&r);
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_made_is_shown_as_it_was_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
