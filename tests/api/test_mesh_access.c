/* The handler of a route that reads a mesh is called once per request, and finds the requested
 * state of the mesh in x->content. */
#include "tests/api/request.h"

#include "api/request/mesh_access.h"
#include "draw/draw_slots.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* --- a table of routes for this test --- */

static struct {
    unsigned entered;
    api_phase phase;
    uint64_t revision;
    uint32_t faces;
    bool locked;
} seen;

static void look(api_exchange *x)
{
    seen.entered++;
    seen.phase = x->phase;
    seen.revision = x->info.revision;
    assert_non_null(x->content);
    seen.faces = he_mesh_faces(x->content);
    seen.locked = x->snapshot == NULL;
    api_answer_empty(x, 204);
}

static void look_at_the_card(api_exchange *x)
{
    seen.entered++;
    assert_null(x->content);
    assert_non_null(x->mesh);
    api_answer_empty(x, 204);
}

static void leave_the_worker(api_exchange *x)
{
    bool on_worker = x->phase == API_PHASE_BODY;
    api_out_string(&x->out, "to be dropped");
    look(x);
    if (on_worker) {
        x->answered = false;
        api_begin_elsewhere(x);
    } else {
        assert_true(x->text.length > 0);
    }
}

static bool is_dear(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    (void)x;
    assert_true(he_mesh_faces(mesh) > 0);
    out->elements = API_COSTLY_ELEMENTS + 1;
    return true;
}

static bool is_refused(api_exchange *x, const he_mesh *mesh, api_cost *out)
{
    (void)mesh;
    (void)out;
    return api_fail(x, API_BAD_PARAMETER, "it can be told beforehand");
}

static const char *const nothing[] = {"application/json", NULL};
static const api_parameter revision = {"revision", API_PARAM_U64, 1, 9, NULL, "Earlier."};

#define ROW(word, ...)                                                                        \
    {                                                                                         \
        .method = "GET", .path = "/meshes/{mesh}/" word, .name = (word), .produces = nothing, \
        .parameters = {&revision}, .statuses = {204}, __VA_ARGS__                             \
    }

static const api_route rows[] = {
    ROW("card", .run = look_at_the_card, .reads = API_READS_CARD),
    ROW("locked", .run = look, .reads = API_READS_LOCKED),
    ROW("view", .run = look, .reads = API_READS_VIEW),
    ROW("snapshot", .run = look, .reads = API_READS_SNAPSHOT),
    ROW("dear", .run = look, .reads = API_READS_VIEW, .cost = is_dear),
    ROW("dear_locked", .run = look, .reads = API_READS_LOCKED, .cost = is_dear),
    ROW("refused", .run = look, .reads = API_READS_SNAPSHOT, .cost = is_refused),
    ROW("known", .run = look, .reads = API_READS_SNAPSHOT, .cost = is_dear, .tag = "known"),
    ROW("leaves", .run = leave_the_worker, .reads = API_READS_LOCKED),
};

/* --- requests --- */

/* Makes a bench with a mesh that has six faces at revision 1 and nine at revision 2. */
static api_bench *bench_of_two_revisions(void)
{
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"cube\"}")));
    bench_reply r = bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}");
    bench_done(bench_expect(200, r));
    return b;
}

/* Sends a request to a route of the test's table and returns the status of the answer. `*step`
 * becomes the step that the request needed after its head was read: API_READY, or API_WORK if a
 * worker had to run; this function then does that work. */
static int ask(api_service *service, const char *word, const char *query, const char *tag,
               api_step *step)
{
    char path[64];
    snprintf(path, sizeof path, "/meshes/m/%s", word);
    memset(&seen, 0, sizeof seen);
    const api_request request = {.method = "GET",
                                 .path = path,
                                 .query = query,
                                 .request_id = "r",
                                 .headers = {[API_HEADER_IF_NONE_MATCH] = tag}};
    api_exchange *x = api_begin(service, &request, step);
    assert_non_null(x);
    *step = *step == API_MORE ? api_end(x) : *step;
    if (*step == API_WORK) {
        assert_int_equal(api_work(x), API_READY);
    }
    int status = api_answer_of(x)->status;
    assert_null(x->content);
    api_free(x);
    return status;
}

static api_service *service_of_rows(api_bench *b)
{
    api_route_table table = {rows, sizeof rows / sizeof *rows};
    api_service *service =
        api_service_new(bench_store(b), table, &(api_options){.version = "test"});
    assert_non_null(service);
    return service;
}

static void a_handler_is_entered_once_with_what_its_row_asks_for(void **state)
{
    (void)state;
    static const struct {
        const char *word, *query;
        api_phase phase;
        bool locked;
        uint64_t revision;
    } cases[] = {
        {"locked", "", API_PHASE_BODY, true, 2},
        {"view", "", API_PHASE_BODY, true, 2},
        {"snapshot", "", API_PHASE_BODY, false, 2},
        {"dear", "", API_PHASE_WORK, false, 2},
        {"dear_locked", "", API_PHASE_WORK, true, 2},
        {"locked", "revision=1", API_PHASE_WORK, false, 1},
        {"dear", "revision=1", API_PHASE_WORK, false, 1},
        {"snapshot", "revision=2", API_PHASE_BODY, false, 2},
    };
    api_bench *b = bench_of_two_revisions();
    api_service *service = service_of_rows(b);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_step step;
        assert_int_equal(ask(service, cases[i].word, cases[i].query, NULL, &step), 204);
        assert_int_equal(step, cases[i].phase == API_PHASE_BODY ? API_READY : API_WORK);
        assert_int_equal(seen.entered, 1);
        assert_int_equal(seen.phase, cases[i].phase);
        assert_int_equal(seen.locked, cases[i].locked);
        assert_int_equal(seen.revision, cases[i].revision);
        assert_int_equal(seen.faces, cases[i].revision == 1 ? 6 : 9);
    }
    api_service_free(service);
    bench_free(b);
}

static void what_can_be_told_beforehand_enters_no_handler(void **state)
{
    (void)state;
    api_bench *b = bench_of_two_revisions();
    api_service *service = service_of_rows(b);
    api_step step;
    assert_int_equal(ask(service, "card", "", NULL, &step), 204);
    assert_int_equal(seen.entered, 1);
    assert_int_equal(ask(service, "refused", "", NULL, &step), 400);
    assert_int_equal(seen.entered, 0);
    assert_int_equal(step, API_READY);
    assert_int_equal(ask(service, "known", "", "*", &step), 304);
    assert_int_equal(seen.entered, 0);
    assert_int_equal(step, API_READY);
    assert_int_equal(ask(service, "known", "revision=1", "*", &step), 304);
    assert_int_equal(seen.entered, 0);
    assert_int_equal(ask(service, "locked", "revision=3", NULL, &step), 404);
    assert_int_equal(seen.entered, 0);
    api_service_free(service);
    bench_free(b);
}

static void a_handler_that_leaves_the_worker_is_entered_anew(void **state)
{
    (void)state;
    api_bench *b = bench_of_two_revisions();
    api_service *service = service_of_rows(b);
    api_step step;
    assert_int_equal(ask(service, "leaves", "", NULL, &step), 204);
    assert_int_equal(step, API_WORK);
    assert_int_equal(seen.entered, 2);
    assert_int_equal(seen.phase, API_PHASE_WORK);
    api_service_free(service);
    bench_free(b);
}

/* --- each route of the API declares what it reads --- */

static void rows_that_read_content_say_so(void **state)
{
    (void)state;
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *row = &api_routes().rows[i];
        bool of_mesh = strncmp(row->path, "/v1/meshes/{mesh}", 17) == 0;
        bool reads = row->reads != API_READS_NONE;
        bool content = reads && row->reads != API_READS_CARD;
        bool earlier = false;
        for (const api_parameter *const *p = row->parameters; *p != NULL; p++) {
            earlier |= strcmp((*p)->name, "revision") == 0;
        }
        bool writes = (row->flags & API_WRITES) != 0, before = row->reads == API_READS_BEFORE;
        if (strcmp(row->method, "DELETE") != 0 && of_mesh && !writes) {
            assert_true(reads);
        }
        assert_true(!before || (writes && row->cost != NULL));
        assert_true(row->begin != NULL || row->begin_reads == API_READS_NONE);
        assert_true(row->begin_reads <= API_READS_LOCKED && row->begin_reads != API_READS_BEFORE);
        assert_true(!earlier || content);
        assert_true(content || (row->cost == NULL && row->tag == NULL));
        assert_false(content && !before && (row->flags & API_COSTLY));
        assert_true(!content || of_mesh);
    }
}

/* --- two requests compute the layout of the arrays at the same time --- */

/* If not NULL, this bench sends a second request while the first one computes the layout of the
 * mesh's arrays; the second request computes the layout, too. */
static api_bench *interrupted;
static uint64_t others_layout;

static uint64_t layout_of(const bench_reply *r)
{
    uint64_t layout = 0;
    for (int i = 7; i >= 0; i--) {
        layout = layout << 8 | (unsigned char)r->body[80 + i];
    }
    return layout;
}

he_status __real_he_draw_slots_new(const he_mesh *mesh, uint64_t layout, uint64_t at,
                                   he_draw_slots **out, he_error *err);
he_status __wrap_he_draw_slots_new(const he_mesh *mesh, uint64_t layout, uint64_t at,
                                   he_draw_slots **out, he_error *err);
he_status __wrap_he_draw_slots_new(const he_mesh *mesh, uint64_t layout, uint64_t at,
                                   he_draw_slots **out, he_error *err)
{
    api_bench *b = interrupted;
    if (b != NULL) {
        interrupted = NULL;
        bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/geometry"));
        others_layout = layout_of(&r);
        bench_done(r);
    }
    return __real_he_draw_slots_new(mesh, layout, at, out, err);
}

static void of_two_that_make_slots_both_answer_with_the_first(void **state)
{
    (void)state;
    interrupted = bench_of_two_revisions();
    api_bench *b = interrupted;
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/geometry"));
    assert_null(interrupted);
    assert_true(others_layout != 0 && layout_of(&r) == others_layout);
    bench_done(r);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_handler_is_entered_once_with_what_its_row_asks_for),
        cmocka_unit_test(what_can_be_told_beforehand_enters_no_handler),
        cmocka_unit_test(a_handler_that_leaves_the_worker_is_entered_anew),
        cmocka_unit_test(rows_that_read_content_say_so),
        cmocka_unit_test(of_two_that_make_slots_both_answer_with_the_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
