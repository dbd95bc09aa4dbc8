/* Random selections and segmentations of random meshes, compared with the oracle element by
 * element: meshes of all families of starts.h and of the corpus, some of them flattened to slivers,
 * moved far from the origin, or with coordinates rounded to whole numbers. An operation that is
 * cancelled at a random time, or out of memory, must change nothing; undo and redo must lead back
 * and forth bit for bit.
 *
 * MESHES (1000) and SEED (from the clock) come from the environment. */
#include "mesh/check.h"
#include "mesh/delta.h"
#include "model/calls_segment.h"
#include "model/calls_select.h"
#include "model/marks.h"
#include "model/shapes.h"
#include "model/starts.h"
#include "tests/failing.h"
#include "tests/sanitized.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { TIMES = 8 }; /* how many operations on each mesh */

typedef struct world {
    md_random random;
    or_mesh *oracle;
    he_mesh *mesh;
    const char *start, *shape;
    uint64_t round;
    md_call call;
    /* How many operations were made, refused, cancelled and out of memory, and how many elements
     * were compared and left to rounding. */
    uint64_t made, refused, cancelled, starved, compared, vague;
} world;

static void stop(const world *w, const char *what, const char *detail)
{
    char text[MD_CALL_TEXT];
    md_describe(&w->call, text);
    fail_msg("mesh %" PRIu64 ", start %s, %s: %s\n%s %s", w->round, w->start, w->shape, text, what,
             detail);
}

static void require(const world *w, bool holds, const char *what)
{
    if (!holds) {
        stop(w, what, "");
    }
}

/* --- meshes --- */

typedef struct warp {
    const char *name;
    void (*move)(he_vec3 *p, md_random *r);
} warp;

static void keep(he_vec3 *p, md_random *r)
{
    (void)p, (void)r;
}
static void flatten(he_vec3 *p, md_random *r)
{
    (void)r;
    p->z *= 1e-9;
    p->x += 1e3 * p->y;
}
static void move_away(he_vec3 *p, md_random *r)
{
    (void)r;
    p->x += 1e8;
    p->y -= 3e8;
}
static void round_off(he_vec3 *p, md_random *r)
{
    (void)r;
    *p = (he_vec3){floor(p->x), floor(p->y), floor(p->z)};
}
static void shake(he_vec3 *p, md_random *r)
{
    p->z += 1e-3 * md_unit(r);
}
static const warp warps[] = {{"as it is", keep},
                             {"as slivers", flatten},
                             {"far away", move_away},
                             {"of whole numbers", round_off},
                             {"with noise", shake}};

static he_mesh *make_mesh(world *w, const md_start *start)
{
    const warp *how = &warps[md_below(&w->random, sizeof warps / sizeof *warps)];
    w->start = start->name;
    w->shape = start->fill == NULL ? "as it is" : how->name;
    if (start->fill == NULL) {
        return md_begin(start, w->oracle, &w->random);
    }
    or_empty(w->oracle);
    md_shape(w->oracle, &w->random, start->fill);
    for (uint32_t v = 0; v < w->oracle->vertices; v++) {
        how->move(&w->oracle->vertex[v].at, &w->random);
    }
    return md_build(w->oracle);
}

static he_mesh *copy_of(const world *w)
{
    he_mesh *copy = NULL;
    require(w, he_mesh_copy(w->mesh, &copy, NULL) == HE_OK, "the mesh could not be copied");
    return copy;
}

/* --- failures --- */

static bool count_down(void *context, const char *phase, double done)
{
    uint32_t *left = context;
    (void)phase, (void)done;
    return *left > 0 && (*left)--;
}

static he_status run(world *w, he_results *results, he_error *err)
{
    return he_op_run(w->call.op, w->mesh, w->call.args, results, err);
}

/* Runs the call with a watch that cancels it after a few reports of progress. */
static void cancel(world *w, const he_mesh *before)
{
    uint32_t left = md_below(&w->random, 6);
    he_results results = {0};
    he_progress progress;
    he_progress_init(&progress, count_down, &left);
    he_savepoint mark = he_delta_mark(w->mesh);
    he_mesh_set_progress(w->mesh, &progress);
    he_status status = run(w, &results, NULL);
    he_mesh_set_progress(w->mesh, NULL);
    if (status == HE_CANCELLED) {
        require(w, he_mesh_equal(w->mesh, before), "a cancelled operation changed the mesh");
        w->cancelled++;
    }
    he_delta_rollback(w->mesh, mark);
    require(w, he_mesh_equal(w->mesh, before), "rollback led elsewhere");
    he_results_clear(&results);
}

static void starve(world *w, const he_mesh *before)
{
    he_results results = {0};
    he_savepoint mark = he_delta_mark(w->mesh);
    failing_at((long)md_from(&w->random, 1, 12));
    he_status status = run(w, &results, NULL);
    failing_off();
    if (status == HE_NO_MEMORY) {
        require(w, he_mesh_equal(w->mesh, before), "a failed allocation changed the mesh");
        w->starved++;
    }
    he_delta_rollback(w->mesh, mark);
    he_results_clear(&results);
}

/* --- one selection --- */

static void compare(world *w, const he_mesh *before, const or_verdict *verdict,
                    const he_results *results)
{
    const he_kind kind = md_select_kind(&w->call);
    uint32_t selected = 0, added = 0, removed = 0;
    for (uint32_t id = 0; id < he_mesh_issued(w->mesh, kind); id++) {
        const bool live = he_mesh_is_live(w->mesh, kind, id);
        const bool is = live && md_select_has(&w->call, w->mesh, id);
        const bool was = live && md_select_has(&w->call, before, id);
        selected += is;
        added += is && !was;
        removed += was && !is;
        w->compared += live;
        w->vague += live && verdict[id] == OR_EITHER;
        if (verdict[id] != OR_EITHER && is != (verdict[id] == OR_YES)) {
            char text[64];
            (void)snprintf(text, sizeof text, "%s %u, which is %sselected", he_kind_name(kind), id,
                           is ? "" : "not ");
            stop(w, "the oracle disagrees about", text);
        }
    }
    require(w,
            results->number[0] == selected && results->number[1] == added &&
                results->number[2] == removed,
            "the numbers reported are wrong");
}

/* Runs the call that was drawn, and perhaps before that with a watch that cancels it or without
 * memory. `refused` is the set of refusals that apply. Returns whether it succeeded; then the mesh
 * has changed, and undo and redo have been tried. */
static bool run_checked(world *w, uint64_t refused, const he_mesh *before, he_results *results)
{
    he_delta *delta = he_delta_new();
    he_error err = {0};
    assert_non_null(delta);
    (void)he_mesh_record(w->mesh, delta);
    if (md_chance(&w->random, 30)) {
        cancel(w, before);
    }
    if (md_chance(&w->random, 20)) {
        starve(w, before);
    }
    const he_status status = run(w, results, &err);
    (void)he_mesh_record(w->mesh, NULL);
    if (status != HE_OK) {
        if ((refused & OR_BIT(status)) == 0) {
            stop(w, "is refused:", err.text);
        }
        require(w, he_mesh_equal(w->mesh, before) && delta->count == 0,
                "a refusal changed the mesh");
        w->refused++;
    } else {
        require(w, refused == 0, "is not refused");
        he_mesh *after = copy_of(w);
        he_delta_undo(delta, w->mesh);
        require(w, he_mesh_equal(w->mesh, before), "undo led elsewhere");
        he_delta_redo(delta, w->mesh);
        require(w, he_mesh_equal(w->mesh, after), "redo led elsewhere");
        he_mesh_free(after);
        w->made++;
    }
    he_delta_free(delta);
    return status == HE_OK;
}

static void begin(world *w, const char *operation)
{
    w->call.op = he_op_find(operation, strlen(operation));
    assert_non_null(w->call.op);
    w->call.row = he_op_number(w->call.op);
    he_op_defaults(w->call.op, w->call.args);
    md_read_marks(w->oracle, w->mesh);
}

static void select_once(world *w)
{
    static or_verdict verdict[OR_ROWS];
    md_draft draft = {&w->call, w->oracle, w->mesh, &w->random, false};
    he_mesh *before = copy_of(w);
    he_results results = {0};
    begin(w, "select");
    (void)md_select_draw(&draft);
    const uint64_t refused = md_select_foresee(&w->call, w->oracle, w->mesh, verdict);
    if (run_checked(w, refused, before, &results)) {
        compare(w, before, verdict, &results);
    }
    he_results_clear(&results);
    he_mesh_free(before);
}

static void segment_once(world *w)
{
    md_draft draft = {&w->call, w->oracle, w->mesh, &w->random, false};
    he_mesh *before = copy_of(w);
    he_results results = {0};
    char text[OR_TEXT] = "";
    begin(w, "segment");
    (void)md_segment_draw(&draft);
    if (run_checked(w, md_segment_refusals(&w->call, w->mesh), before, &results)) {
        w->compared += he_mesh_faces(w->mesh);
        if (!md_segment_is_right(&w->call, w->oracle, w->mesh, text)) {
            stop(w, text, "");
        }
        require(w, isfinite(results.number[2]) && results.number[2] >= 0,
                "the deviation is not a number");
    }
    he_results_clear(&results);
    he_mesh_free(before);
}

static void each_result_is_that_of_the_oracle(void (*once)(world *w), const char *what)
{
    world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    const uint64_t seed = seed_of_run(), meshes = seed_setting("MESHES", SANITIZED ? 300 : 1000);
    w->oracle = or_new();
    assert_non_null(w->oracle);
    md_starts starts = md_starts_find();
    for (w->round = 0; w->round < meshes; w->round++) {
        w->random.state = seed + w->round;
        const md_start *start = &starts.start[md_below(&w->random, (uint32_t)starts.count)];
        w->mesh = start->far ? NULL : make_mesh(w, start);
        if (w->mesh == NULL) {
            continue;
        }
        assert_true(md_mark(w->mesh, &w->random));
        for (int i = 0; i < TIMES; i++) {
            once(w);
        }
        he_problem problem;
        size_t problems = 0;
        require(w, he_check(w->mesh, &problem, 1, &problems, NULL) == HE_OK && problems == 0,
                "the check fails");
        he_mesh_free(w->mesh);
    }
    printf("note: %" PRIu64 " meshes, %" PRIu64 " %s, %" PRIu64 " refused, %" PRIu64
           " cancelled, %" PRIu64 " out of memory; %" PRIu64 " elements compared, %" PRIu64
           " left to rounding\n",
           meshes, w->made, what, w->refused, w->cancelled, w->starved, w->compared, w->vague);
    assert_true(w->vague * 5 < w->compared);
    assert_true(w->made > w->refused && w->cancelled > 0 && w->starved > 0);
    md_starts_clear(&starts);
    or_free(w->oracle);
    free(w);
}

static void each_rule_selects_what_the_oracle_selects(void **state)
{
    (void)state;
    each_result_is_that_of_the_oracle(select_once, "selections");
}

static void patches_are_connected_and_end_where_they_must(void **state)
{
    (void)state;
    each_result_is_that_of_the_oracle(segment_once, "segmentations");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_rule_selects_what_the_oracle_selects),
        cmocka_unit_test(patches_are_connected_and_end_where_they_must),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
