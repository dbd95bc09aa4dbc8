/* POST .../compare: the distance between two meshes, or from an earlier revision. */
#include "tests/api/request.h"

#include "tests/failing.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define COMPARE "/v1/meshes/box/compare"

/* --- locks ---
 *
 * The linker redirects the functions that take the shared lock of a mesh. A thread that holds the
 * lock of one mesh and waits for that of another can wait for ever, if writers wait for both. */

static _Thread_local unsigned held; /* how many locks this thread holds */
static _Atomic unsigned nested, taken;

static void note_lock(void)
{
    taken++;
    nested += held > 0;
}

const he_mesh *__wrap_st_read_begin(st_mesh *mesh, st_mesh_info *info);
const he_mesh *__real_st_read_begin(st_mesh *mesh, st_mesh_info *info);
const he_mesh *__wrap_st_read_begin(st_mesh *mesh, st_mesh_info *info)
{
    note_lock();
    held++;
    return __real_st_read_begin(mesh, info);
}

void __wrap_st_read_end(st_mesh *mesh);
void __real_st_read_end(st_mesh *mesh);
void __wrap_st_read_end(st_mesh *mesh)
{
    held--;
    __real_st_read_end(mesh);
}

uint64_t __wrap_st_read_card(st_mesh *mesh, st_mesh_info *info);
uint64_t __real_st_read_card(st_mesh *mesh, st_mesh_info *info);
uint64_t __wrap_st_read_card(st_mesh *mesh, st_mesh_info *info)
{
    note_lock();
    return __real_st_read_card(mesh, info);
}

uint64_t __wrap_st_elements_at(st_mesh *mesh, uint64_t revision);
uint64_t __real_st_elements_at(st_mesh *mesh, uint64_t revision);
uint64_t __wrap_st_elements_at(st_mesh *mesh, uint64_t revision)
{
    note_lock();
    return __real_st_elements_at(mesh, revision);
}

st_status __wrap_st_snapshot_take(st_mesh *mesh, st_snapshot **out);
st_status __real_st_snapshot_take(st_mesh *mesh, st_snapshot **out);
st_status __wrap_st_snapshot_take(st_mesh *mesh, st_snapshot **out)
{
    note_lock();
    return __real_st_snapshot_take(mesh, out);
}

st_status __wrap_st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out);
st_status __real_st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out);
st_status __wrap_st_snapshot_at(st_mesh *mesh, uint64_t revision, st_snapshot **out)
{
    note_lock();
    return __real_st_snapshot_at(mesh, revision, out);
}

/* --- comparing --- */

static double number(const cJSON *object, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, name);
    assert_true(cJSON_IsNumber(value));
    return value->valuedouble;
}

static const cJSON *member(const cJSON *object, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, name);
    assert_non_null(value);
    return value;
}

static void require_near(double value, double wanted)
{
    if (!(fabs(value - wanted) <= 1e-12)) {
        fail_msg("%.17g is not %.17g", value, wanted);
    }
}

/* Makes the cube `box` of revision 2, whose vertices were moved by 1/4 along x after revision 1,
 * and a copy of revision 1, `first`. */
static api_bench *begin(void)
{
    static const char moved[] =
        "{\"op\":\"transform\",\"matrix\":[1,0,0,0.25, 0,1,0,0, 0,0,1,0, 0,0,0,1]}";
    api_bench *b = bench_new();
    assert_non_null(b);
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/box", NULL, "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes/box/copy", "{\"id\":\"first\"}")));
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/box/edits", moved)));
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/none", NULL,
                                            "{\"vertices\":[[0,0,0]],\"faces\":[]}")));
    return b;
}

static void require_shifted(const cJSON *json, double bound)
{
    require_near(number(json, "lower"), 0.25);
    require_near(number(json, "upper"), 0.25);
    require_near(number(json, "bound"), bound);
    assert_true(cJSON_IsTrue(member(json, "complete")));
    static const char *const sides[] = {"forward", "backward"};
    for (int i = 0; i < 2; i++) {
        const cJSON *side = member(json, sides[i]), *place = member(side, "place");
        require_near(number(side, "lower"), 0.25);
        assert_true(number(side, "mean") > 0 && number(side, "mean") < number(side, "rms"));
        double sum = 0;
        for (const cJSON *share = member(side, "histogram")->child; share; share = share->next) {
            sum += share->valuedouble;
        }
        require_near(sum, 1);
        assert_true(number(place, "face") < 6 && number(place, "near_face") < 6);
        const double from = cJSON_GetArrayItem(member(place, "point"), 0)->valuedouble;
        const double to = cJSON_GetArrayItem(member(place, "near_point"), 0)->valuedouble;
        require_near(fabs(from - to), 0.25);
    }
}

static void a_mesh_is_compared_with_another_one_and_with_its_past(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply r =
        bench_expect(200, bench_post(b, COMPARE, "{\"with\":\"first\",\"bound\":0.01,\"bins\":5}"));
    require_shifted(r.json, 0.01);
    assert_string_equal(bench_text(&r, "with"), "first");
    assert_int_equal(number(r.json, "revision"), 2);
    assert_int_equal(number(r.json, "with_revision"), 1);
    assert_int_equal(cJSON_GetArraySize(member(member(r.json, "forward"), "histogram")), 5);
    require_near(number(r.json, "bin_width"), 0.05);
    bench_done(r);
    r = bench_expect(200, bench_post(b, COMPARE, "{\"with\":1,\"bound\":0.01}"));
    require_shifted(r.json, 0.01);
    assert_string_equal(bench_text(&r, "with"), "box");
    assert_int_equal(cJSON_GetArraySize(member(member(r.json, "forward"), "histogram")), 32);
    bench_done(r);
    r = bench_expect(200, bench_post(b, COMPARE "?revision=1", "{\"with\":2,\"bound\":0.01}"));
    require_shifted(r.json, 0.01);
    assert_int_equal(number(r.json, "revision"), 1);
    assert_int_equal(number(r.json, "with_revision"), 2);
    bench_done(r);
    r = bench_expect(200, bench_post(b, COMPARE "?revision=1", "{\"with\":\"first\"}"));
    require_near(number(r.json, "upper"), 0);
    assert_int_equal(number(member(r.json, "forward"), "equal_triangles"), 12);
    bench_done(r);
    bench_free(b);
}

static void without_bins_there_are_neither_means_nor_histograms(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply r =
        bench_expect(200, bench_post(b, COMPARE, "{\"with\":1,\"bound\":0.01,\"bins\":0}"));
    require_near(number(r.json, "lower"), 0.25);
    require_near(number(r.json, "upper"), 0.25);
    require_near(number(r.json, "bin_width"), 0);
    static const char *const sides[] = {"forward", "backward"};
    for (int i = 0; i < 2; i++) {
        const cJSON *side = member(r.json, sides[i]);
        require_near(number(side, "lower"), 0.25);
        assert_false(cJSON_HasObjectItem(side, "mean") || cJSON_HasObjectItem(side, "rms"));
        assert_int_equal(cJSON_GetArraySize(member(side, "histogram")), 0);
    }
    bench_done(r);
    bench_free(b);
}

static void the_default_bound_is_a_thousandth_of_the_diagonal(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply r = bench_expect(200, bench_post(b, COMPARE, "{\"with\":1}"));
    bench_reply box = bench_expect(200, bench_get(b, "/v1/meshes/first"));
    const cJSON *bounds = member(box.json, "bbox");
    const double side = cJSON_GetArrayItem(member(bounds, "max"), 0)->valuedouble -
                        cJSON_GetArrayItem(member(bounds, "min"), 0)->valuedouble;
    require_near(number(r.json, "bound"),
                 sqrt((side + 0.25) * (side + 0.25) + 2 * side * side) / 1000);
    bench_done(box);
    bench_done(r);
    bench_free(b);
}

static void no_thread_waits_for_a_second_mesh(void **state)
{
    (void)state;
    static const char *const bodies[] = {"{\"with\":\"first\"}", "{\"with\":\"box\"}",
                                         "{\"with\":1}", "{\"with\":2}"};
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        const unsigned before = taken;
        nested = 0;
        bench_done(bench_expect(200, bench_post(b, COMPARE, bodies[i])));
        bench_done(bench_expect(200, bench_post(b, COMPARE "?revision=1", bodies[i])));
        if (nested != 0) {
            fail_msg("%s: a lock is taken while another one is held", bodies[i]);
        }
        assert_true(taken >= before + 4);
    }
    bench_free(b);
}

static void what_cannot_be_compared_is_refused(void **state)
{
    (void)state;
    static const struct {
        int status;
        const char *body, *code, *pointer;
    } rows[] = {
        {422, "{\"with\":\"absent\"}", "no_such_mesh", "/with"},
        {422, "{\"with\":\"no id!\"}", "no_such_mesh", "/with"},
        {422, "{\"with\":3}", "no_such_revision", "/with"},
        {422, "{\"with\":\"none\"}", "no_faces", NULL},
        {400, "{}", "missing_member", NULL},
        {400, "{\"with\":0}", "bad_value", "/with"},
        {400, "{\"with\":1.5}", "bad_value", "/with"},
        {400, "{\"with\":true}", "wrong_type", "/with"},
        {400, "{\"with\":1,\"bound\":0}", "bad_value", "/bound"},
        {400, "{\"with\":1,\"bound\":-1}", "bad_value", "/bound"},
        {400, "{\"with\":1,\"bins\":-1}", "bad_value", "/bins"},
        {400, "{\"with\":1,\"bins\":257}", "bad_value", "/bins"},
        {400, "{\"with\":1,\"into\":\"x\"}", "unknown_member", "/into"},
    };
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        print_message("%s\n", rows[i].body);
        bench_reply r = bench_expect(rows[i].status, bench_post(b, COMPARE, rows[i].body));
        assert_string_equal(bench_text(&r, "code"), rows[i].code);
        if (rows[i].pointer != NULL) {
            assert_string_equal(bench_text(&r, "pointer"), rows[i].pointer);
        }
        bench_done(r);
    }
    bench_done(bench_expect(422, bench_post(b, "/v1/meshes/none/compare", "{\"with\":\"box\"}")));
    bench_free(b);
}

static void an_operation_takes_an_earlier_revision_as_the_other_mesh(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply r = bench_expect(
        200, bench_post(b, "/v1/meshes/box/edits", "{\"op\":\"deviation\",\"with\":1}"));
    const cJSON *done = member(r.json, "results")->child;
    require_near(number(done, "largest"), 0.25);
    require_near(number(done, "least"), 0); /* the other vertices moved along edges */
    bench_done(r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/box/attributes/vertices/deviation"));
    assert_int_equal(cJSON_GetArraySize(member(r.json, "values")), 8);
    bench_done(r);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/box/undo", NULL)));
    bench_done(bench_expect(404, bench_get(b, "/v1/meshes/box/attributes/vertices/deviation")));
    r = bench_expect(200, bench_post(b, "/v1/meshes/box/edits",
                                     "{\"ops\":[{\"op\":\"append\",\"mesh\":1},"
                                     "{\"op\":\"append\",\"mesh\":\"box\"}]}"));
    assert_int_equal(cJSON_GetArraySize(member(member(r.json, "created"), "vertices")), 16);
    bench_done(r);
    r = bench_expect(422,
                     bench_post(b, "/v1/meshes/box/edits", "{\"op\":\"deviation\",\"with\":99}"));
    assert_string_equal(bench_text(&r, "code"), "no_such_revision");
    bench_done(r);
    bench_done(bench_expect(
        400, bench_post(b, "/v1/meshes/box/edits", "{\"op\":\"deviation\",\"with\":0}")));
    bench_free(b);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    api_bench *b = begin();
    failing f = {.may_succeed = true};
    static const char body[] = "{\"with\":1,\"bound\":0.1}";
    static const char *const headers[] = {"Content-Type", "application/json", NULL};
    while (failing_next(&f)) {
        bench_reply r;
        const bool any =
            bench_try(b, &(bench_request){"POST", COMPARE, headers, body, sizeof body - 1}, &r);
        failing_end(&f, any && r.status == 200);
        if (any) {
            assert_true(r.status == 200 || r.status == 507);
            bench_reply_free(&r);
        }
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_is_compared_with_another_one_and_with_its_past),
        cmocka_unit_test(without_bins_there_are_neither_means_nor_histograms),
        cmocka_unit_test(the_default_bound_is_a_thousandth_of_the_diagonal),
        cmocka_unit_test(no_thread_waits_for_a_second_mesh),
        cmocka_unit_test(what_cannot_be_compared_is_refused),
        cmocka_unit_test(an_operation_takes_an_earlier_revision_as_the_other_mesh),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("compare", tests, NULL, NULL);
}
