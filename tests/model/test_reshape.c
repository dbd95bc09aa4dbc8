/* Random meshes through each operation of reshape.h, and compared with what they were: scans,
 * solids with sharp edges, sheets with holes, bow-ties, slivers, hubs, meshes far from the origin
 * or with huge and tiny coordinates, and meshes of polygons, all with random marks and attributes.
 *
 * Each call runs to its end, and then again on an equal mesh, where a random one of its reports of
 * progress cancels it. It must hold that
 *
 *     success        he_check passes; every coordinate, number of an attribute and result is
 * finite; undo leads back and redo forward bit for bit; a dry run would have left the mesh as it
 * was refusal        the row declares the reason, which has a sentence; the mesh is bit-identical
 *     cancelled      the mesh is bit-identical; if the last steps could not be cancelled, it is the
 *                    one that was made without
 *
 * With ENOUGH meshes each operation must have succeeded and been cancelled, with MANY also been
 * refused.
 *
 * ROUNDS (70) is the number of meshes, each of which goes through all operations. SEED (from the
 * clock) is that of the first mesh: mesh number n of a run is the first one of SEED + n. ONLY names
 * one operation. With VERBOSE=1 each call is printed before it runs. */
#include "compare/compare.h"
#include "geometry/vec3.h"
#include "mesh/check.h"
#include "mesh/column.h"
#include "mesh/delta.h"
#include "model/reshape.h"
#include "model/shapes.h"
#include "tests/seed.h"
#include "tests/unit/dense.h"
#include "tests/unit/random_meshes.h"

#include <inttypes.h>
#include <math.h>

enum { ENOUGH = 50, MANY = 1000, USUAL_ROUNDS = 70 };

typedef struct tally {
    uint64_t done, refused, cancelled, late; /* late: cancelled too late to stop */
} tally;

typedef struct world {
    uint64_t seed;
    const char *family;
    md_random random;
    or_mesh *oracle; /* for meshes of polygons */
    md_reshape what;
    tally tally[MD_RESHAPES], compared;
} world;

static void stop(const world *w, const char *what, const char *detail)
{
    char text[MD_CALL_TEXT] = "compare";
    if (w->what.call.op != NULL) {
        md_describe(&w->what.call, text);
    }
    fail_msg("SEED=%" PRIu64 ", %s: %s\n%s: %s", w->seed, w->family, text, what, detail);
}

static void require(const world *w, bool holds, const char *what)
{
    if (!holds) {
        stop(w, what, "");
    }
}

/* --- what must hold --- */

static bool is_finite_row(const he_column *column, uint32_t row)
{
    const unsigned char *at = he_column_value(column, row);
    for (uint32_t k = 0; k < column->components; k++) {
        double x = 0;
        if (column->type == HE_FLOAT) {
            float narrow;
            memcpy(&narrow, at + k * sizeof narrow, sizeof narrow);
            x = (double)narrow;
        } else if (column->type == HE_DOUBLE) {
            memcpy(&x, at + k * sizeof x, sizeof x);
        }
        if (!isfinite(x)) {
            return false;
        }
    }
    return true;
}

static void require_finite(const world *w, const he_mesh *m)
{
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        require(w,
                !he_mesh_is_live(m, HE_VERTEX, v) ||
                    he_vec3_is_finite(he_position(m, (he_vertex){v})),
                "a coordinate is not finite");
    }
    for (size_t i = 0; i < he_mesh_columns(m); i++) {
        const he_column *column = he_mesh_column(m, i);
        for (uint32_t row = 0; column != NULL && row < column->rows; row++) {
            require(w, is_finite_row(column, row), "a number of an attribute is not finite");
        }
    }
}

static void require_results(const world *w, const he_mesh *m, const he_results *results)
{
    const he_op *op = w->what.call.op;
    for (size_t i = 0; i < he_op_results(op); i++) {
        const he_result_row *row = &op->results[i];
        if (results->present[i] && row->type == HE_RESULT_NUMBER && !isfinite(results->number[i])) {
            stop(w, "a result is not finite", row->name);
        }
        if (results->present[i] && row->type == HE_RESULT_ELEMENT && results->id[i] != HE_NONE &&
            !he_mesh_is_live(m, row->kind, results->id[i])) {
            stop(w, "a result is not a live element", row->name);
        }
    }
}

static void require_sound(const world *w, const he_mesh *m)
{
    he_problem problem;
    size_t problems = 0;
    require(w, he_check(m, &problem, 1, &problems, NULL) == HE_OK, "no memory to check");
    if (problems > 0) {
        stop(w, "the check fails", problem.text);
    }
    require_finite(w, m);
}

static void require_refusal(const world *w, he_status status, const he_error *err)
{
    if (!he_op_declares(w->what.call.op, status) || status == HE_CANCELLED ||
        status == HE_NO_MEMORY) {
        stop(w, "this refusal is not declared", err->text);
    }
    require(w, err->status == status && err->text[0] != '\0', "a refusal without a sentence");
}

/* --- progress --- */

/* Counts reports of progress, and cancels the work at one of them. */
typedef struct reports {
    uint64_t count, cancel_at; /* 0: never */
    double last;
    bool is_orderly; /* what is done was never less than before, and never outside of 0 to 1 */
} reports;

static bool tell(void *context, const char *phase, double done)
{
    reports *r = context;
    r->is_orderly &= phase != NULL && done >= r->last && done <= 1;
    r->last = done;
    return ++r->count != r->cancel_at;
}

static he_progress watch_of(reports *r, uint64_t cancel_at)
{
    he_progress progress;
    *r = (reports){.cancel_at = cancel_at, .is_orderly = true};
    he_progress_init(&progress, tell, r);
    return progress;
}

static he_status run(const world *w, he_mesh *m, reports *r, uint64_t cancel_at, he_error *err,
                     he_results *results)
{
    he_progress progress = watch_of(r, cancel_at);
    he_mesh_set_progress(m, &progress);
    const he_status status = he_op_run(w->what.call.op, m, w->what.call.args, results, err);
    he_mesh_set_progress(m, NULL);
    require(w, r->is_orderly, "progress went backwards");
    return status;
}

/* Runs the call again on a copy of `before`, and cancels it at a random report. Without a
 * cancellation it ended with `status`, and made `after`. */
static void cancel(world *w, const he_mesh *before, const he_mesh *after, he_status status,
                   uint64_t count, tally *t)
{
    reports r;
    he_results results = {0};
    he_error err = {0};
    he_mesh *m = dense_copy(before);
    const uint64_t at = 1 + md_below(&w->random, (uint32_t)count);
    const he_status second = run(w, m, &r, at, &err, &results);
    if (second == HE_CANCELLED) {
        require(w, he_mesh_equal(m, before), "a cancelled call changed the mesh");
        require(w, r.count == at, "it went on after it was cancelled");
        require(w, err.status == HE_CANCELLED && err.text[0] != '\0', "cancelled without a word");
        t->cancelled++;
    } else {
        require(w, second == status, "a late cancellation changed the outcome");
        require(w, he_mesh_equal(m, after), "a late cancellation changed what was made");
        t->late++;
    }
    he_results_clear(&results);
    he_mesh_free(m);
}

/* --- an operation --- */

static void require_undo(const world *w, he_mesh *m, he_delta *delta, const he_mesh *before)
{
    he_mesh *after = dense_copy(m);
    he_delta_undo(delta, m);
    require(w, he_mesh_equal_live(m, before), "undo leads elsewhere");
    he_delta_redo(delta, m);
    require(w, he_mesh_equal(m, after), "redo leads elsewhere");
    he_mesh_free(after);
}

/* Runs the call as a dry run does. */
static void rehearse(const world *w, he_mesh *m, const he_mesh *before, he_status status)
{
    he_results results = {0};
    he_error err = {0};
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    (void)he_mesh_record(m, delta);
    const he_savepoint mark = he_delta_mark(m);
    require(w, he_op_run(w->what.call.op, m, w->what.call.args, &results, &err) == status,
            "a second run has another outcome");
    he_delta_rollback(m, mark);
    (void)he_mesh_record(m, NULL);
    require(w, he_mesh_equal(m, before), "rollback leads elsewhere");
    he_delta_free(delta);
    he_results_clear(&results);
}

/* Runs a random call of an operation on a mesh. If it succeeds, the mesh is afterwards the new
 * one. */
static void reshape(world *w, size_t which, he_mesh *m)
{
    reports r;
    he_results results = {0};
    he_error err = {0};
    he_mesh *before = dense_copy(m);
    he_delta *delta = he_delta_new();
    tally *t = &w->tally[which];
    assert_non_null(delta);
    md_reshape_draw(&w->what, which, m, &w->random);
    if (getenv("VERBOSE") != NULL) {
        char text[MD_CALL_TEXT];
        md_describe(&w->what.call, text);
        printf("SEED=%" PRIu64 " %s, %u faces: %s\n", w->seed, w->family, he_mesh_faces(m), text);
        (void)fflush(stdout);
    }
    (void)he_mesh_record(m, delta);
    const he_status status = run(w, m, &r, 0, &err, &results);
    (void)he_mesh_record(m, NULL);
    if (status == HE_OK) {
        t->done++;
        require_sound(w, m);
        require_results(w, m, &results);
        require_undo(w, m, delta, before);
    } else {
        t->refused++;
        require_refusal(w, status, &err);
        require(w, he_mesh_equal(m, before), "a refusal changed the mesh");
        require(w, delta->count == 0 && delta->object_count == 0, "a refusal left records");
    }
    if (r.count > 0) {
        cancel(w, before, m, status, r.count, t);
    }
    if (md_chance(&w->random, 10)) {
        he_mesh *same = dense_copy(before);
        rehearse(w, same, before, status);
        he_mesh_free(same);
    }
    md_reshape_clear(&w->what);
    w->what.call.op = NULL;
    he_results_clear(&results);
    he_delta_free(delta);
    he_mesh_free(before);
}

/* --- comparing --- */

static void require_side(const world *w, const he_one_sided *side)
{
    double sum = 0;
    for (size_t i = 0; i < HE_COMPARE_BINS; i++) {
        require(w, isfinite(side->share[i]) && side->share[i] >= 0, "a share is no number");
        sum += side->share[i];
    }
    require(w, fabs(sum - 1) < 1e-9 || sum == 0, "the shares are not 1 together");
    require(w, isfinite(side->upper) && side->lower >= 0 && side->lower <= side->upper,
            "the bounds are no bounds");
    require(w,
            side->mean >= 0 && side->rms >= side->mean * (1 - 1e-9) && isfinite(side->rms) &&
                side->mean <= side->upper * (1 + 1e-9),
            "the means are no means");
    require(w, he_vec3_is_finite(side->place.point) && he_vec3_is_finite(side->place.near_point),
            "the place is no point");
}

/* Compares what an operation made with what was there before, and cancels a second comparison. */
static void compare(world *w, const he_mesh *before, const he_mesh *after)
{
    reports r;
    he_comparison found = {.lower = -1}, again = {.lower = -1};
    he_error err = {0};
    he_compared surfaces[2] = {{before, NULL}, {after, NULL}};
    he_bvh *trees[2] = {NULL, NULL};
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(he_bvh_new(surfaces[i].mesh, NULL, &trees[i], NULL), HE_OK);
        surfaces[i].tree = trees[i];
    }
    const double usual = he_compare_default_bound(surfaces);
    const he_compare_options options = {
        .bound = usual > 0 ? usual : 1, .bins = 1 + md_below(&w->random, 20), .most_pieces = 20000};
    he_progress progress = watch_of(&r, 0);
    const he_status status = he_compare(surfaces, &options, &progress, &found, &err);
    if (status == HE_OK) {
        w->compared.done++;
        require_side(w, &found.side[0]);
        require_side(w, &found.side[1]);
        require(w, found.lower <= found.upper && isfinite(found.bin_width), "no bounds");
    } else {
        w->compared.refused++;
        require(w, status == HE_NO_FACES || status == HE_LIMIT || status == HE_NOT_FINITE,
                "this refusal is not declared");
        require(w, found.lower < 0 && err.text[0] != '\0', "a refusal wrote an answer");
    }
    if (r.count > 0) {
        progress = watch_of(&r, 1 + md_below(&w->random, (uint32_t)r.count));
        const he_status second = he_compare(surfaces, &options, &progress, &again, &err);
        require(w, second == HE_CANCELLED || second == status, "cancelling changed the outcome");
        require(w, second != HE_CANCELLED || again.lower < 0, "a cancelled call has an answer");
        w->compared.cancelled += second == HE_CANCELLED;
        w->compared.late += second != HE_CANCELLED;
    }
    he_bvh_free(trees[0]);
    he_bvh_free(trees[1]);
}

/* --- the run --- */

static he_mesh *make_mesh(world *w, size_t family)
{
    he_mesh *m = NULL;
    if (family < RANDOM_FAMILIES) {
        w->family = random_families[family].name;
        m = random_families[family].make(&w->random);
    } else {
        w->family = "polygons";
        md_shape(w->oracle, &w->random, md_fill_mixed);
        m = md_build(w->oracle);
    }
    assert_non_null(m);
    random_decorate(m, &w->random);
    return m;
}

/* Lets one mesh through all operations: mostly as it is, sometimes as the last one left it. */
static void pass(world *w, size_t family, const char *only)
{
    he_mesh *m = make_mesh(w, family);
    require_sound(w, m);
    const size_t compared = md_below(&w->random, MD_RESHAPES);
    for (size_t i = 0; i < MD_RESHAPES; i++) {
        if (only != NULL && strcmp(only, md_reshapes[i]) != 0) {
            continue;
        }
        he_mesh *made = dense_copy(m);
        reshape(w, i, made);
        if (i == compared) {
            compare(w, m, made);
        }
        if (md_chance(&w->random, 25) && he_mesh_faces(made) < 5000) {
            he_mesh *old = m;
            m = made;
            made = old;
        }
        he_mesh_free(made);
    }
    he_mesh_free(m);
}

static void show(const char *name, const tally *t)
{
    printf("note: %-10s %6" PRIu64 " done, %5" PRIu64 " refused, %6" PRIu64 " cancelled, %5" PRIu64
           " too late to cancel\n",
           name, t->done, t->refused, t->cancelled, t->late);
}

static void random_meshes_survive_every_operation(void **state)
{
    (void)state;
    const uint64_t seed = seed_of_run(), rounds = seed_setting("ROUNDS", USUAL_ROUNDS);
    const char *only = getenv("ONLY");
    world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    w->oracle = or_new();
    for (uint64_t i = 0; i < rounds; i++) {
        w->seed = seed + i;
        w->random.state = w->seed;
        pass(w, w->seed % (RANDOM_FAMILIES + 1), only);
    }
    printf("note: %" PRIu64 " meshes through each operation\n", rounds);
    for (size_t i = 0; i < MD_RESHAPES; i++) {
        const tally *t = &w->tally[i];
        show(md_reshapes[i], t);
        if (only == NULL) {
            assert_true(rounds < ENOUGH || (t->done > 0 && t->cancelled > 0));
            assert_true(rounds < MANY || t->refused > 0);
        }
    }
    show("compare", &w->compared);
    assert_true(only != NULL || rounds < ENOUGH || w->compared.done > 0);
    assert_true(only != NULL || rounds < MANY || w->compared.cancelled > 0);
    or_free(w->oracle);
    free(w);
}

/* In these rounds a small mesh is asked for holes with half a million faces. */
static void small_holes_are_not_filled_with_very_many_faces(void **state)
{
    (void)state;
    static const uint64_t seeds[] = {29001255, 29001650};
    world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    w->oracle = or_new();
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++) {
        w->random.state = w->seed = seeds[i];
        pass(w, w->seed % (RANDOM_FAMILIES + 1), NULL);
    }
    or_free(w->oracle);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_holes_are_not_filled_with_very_many_faces),
        cmocka_unit_test(random_meshes_survive_every_operation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
