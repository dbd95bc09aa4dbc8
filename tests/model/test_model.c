/* Random edits compared with the oracle, from every start of starts.h. After each edit, success or
 * refusal, counts, ids, cycles, ends, links and rings must be as oracle.h says, and he_check must
 * pass. A refusal or a failed allocation must leave the mesh unchanged. Undo, redo and rollback
 * must restore it bit for bit. The reported sets must be those found by comparing both states. On
 * every start, large ones too, all this is checked for the whole mesh after every edit.
 *
 * Each start has its share of the edits. The outcomes are printed by start and by operation, and in
 * total at the end. With ENOUGH edits every operation must have succeeded; with ALL every operation
 * must have succeeded from every start but files and the far mesh, and every declared refusal must
 * have occurred.
 *
 * EDITS (50000) and SEED (from the clock) come from the environment. */
#include "mesh/check.h"
#include "mesh/delta.h"
#include "model/calls.h"
#include "model/limits.h"
#include "model/marks.h"
#include "model/net.h"
#include "model/starts.h"
#include "tests/failing.h"
#include "tests/sanitized.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { STEPS = 12, ENOUGH = 20000, ALL = 1000000 };

/* An edit that can be undone, and the mesh before it. */
typedef struct step {
    he_delta *delta;
    he_mesh *before;
} step;

typedef struct world {
    uint64_t seed;
    md_random random;
    const md_start *start;
    md_tally *tally; /* the outcomes for this start */
    uint32_t faces_at_first;
    or_mesh *oracle;
    he_mesh *mesh;
    step step[STEPS];
    size_t steps;
    md_call call;
} world;

/* --- failing --- */

static void show_faces(const or_mesh *o)
{
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive) {
            print_error("  face %u:", f);
            for (uint32_t i = 0; i < o->face[f].count; i++) {
                print_error(" %u", o->face[f].v[i]);
            }
            print_error("\n");
        }
    }
}

static void stop(const world *w, const char *what, const char *detail)
{
    char text[MD_CALL_TEXT];
    md_describe(&w->call, text);
    print_error("SEED=%" PRIu64 ", start %s, edit %" PRIu64 ": %s\n%s: %s\n", w->seed,
                w->start->name, w->tally->edits, text, what, detail);
    if (he_mesh_faces(w->mesh) < 40) {
        print_error("the oracle's faces now:\n");
        show_faces(w->oracle);
    }
    fail_msg("%s", what);
}

static void require(const world *w, bool holds, const char *what)
{
    if (!holds) {
        stop(w, what, "");
    }
}

static he_mesh *copy_of(const world *w)
{
    he_mesh *copy = NULL;
    require(w, he_mesh_copy(w->mesh, &copy, NULL) == HE_OK, "the mesh could not be copied");
    return copy;
}

/* --- allocations that fail --- */

/* Runs the call with the first, second, third ... allocation failing, and in half of the runs also
 * all later ones, until one run succeeds. If a call makes very many allocations, not all are
 * tried. */
static he_status run_starved(world *w, const he_mesh *before, const he_delta *delta,
                             he_results *results, he_error *err)
{
    md_row_tally *t = &w->tally->row[w->call.row];
    failing f = {.may_succeed = true, .sparse = 50, .lasts = md_chance(&w->random, 50)};
    he_status status = HE_NO_MEMORY;
    while (failing_next(&f)) {
        status = he_op_run(w->call.op, w->mesh, w->call.args, results, err);
        require(w, status != HE_NO_MEMORY || failing_count() >= f.n,
                "out of memory although no allocation failed");
        if (failing_end(&f, status != HE_NO_MEMORY)) {
            break;
        }
        f.lasts = md_chance(&w->random, 50);
        t->starved = (uint32_t)f.n > t->starved ? (uint32_t)f.n : t->starved;
        require(w, he_mesh_equal(w->mesh, before), "a failed allocation changed the mesh");
        require(w, delta == NULL || (delta->count == 0 && delta->object_count == 0),
                "a failed allocation left records");
        require(w, f.n < 100000, "allocations without end");
    }
    return status;
}

/* --- undo --- */

static void forget_steps(world *w)
{
    for (size_t i = 0; i < w->steps; i++) {
        he_delta_free(w->step[i].delta);
        he_mesh_free(w->step[i].before);
    }
    w->steps = 0;
}

static void keep_step(world *w, he_delta *delta, he_mesh *before)
{
    if (w->steps == STEPS) {
        he_delta_free(w->step[0].delta);
        he_mesh_free(w->step[0].before);
        memmove(&w->step[0], &w->step[1], (STEPS - 1) * sizeof w->step[0]);
        w->steps--;
    }
    w->step[w->steps++] = (step){delta, before};
}

static void require_net(const world *w, const he_mesh *was, const he_delta *delta, bool undone)
{
    char text[MD_NET_TEXT] = "";
    he_changes changes = {0};
    require(w, he_changes_find(w->mesh, delta, 0, delta->count, undone, &changes, NULL) == HE_OK,
            "he_changes_find failed");
    if (changes.replaced) {
        require(w, w->call.op->size == HE_OP_WHOLE || undone, "a local edit replaced");
    } else if (!md_net_matches(was, w->mesh, &changes, text)) {
        stop(w, undone ? "the sets of an undo are wrong" : "the sets of an edit are wrong", text);
    }
    he_changes_clear(&changes);
}

/* Undoes a random number of steps and redoes them. */
static void undo_and_redo(world *w)
{
    if (w->steps == 0) {
        return;
    }
    he_mesh *now = copy_of(w);
    size_t to = md_below(&w->random, (uint32_t)w->steps);
    for (size_t i = w->steps; i-- > to;) {
        he_mesh *was = copy_of(w);
        he_delta_undo(w->step[i].delta, w->mesh);
        require(w, he_mesh_equal_live(w->mesh, w->step[i].before), "undo led elsewhere");
        require_net(w, was, w->step[i].delta, true);
        he_mesh_free(was);
    }
    he_problem problem;
    size_t problems = 0;
    require(w, he_check(w->mesh, &problem, 1, &problems, NULL) == HE_OK && problems == 0,
            "undo led to a mesh that fails the check");
    for (size_t i = to; i < w->steps; i++) {
        he_delta_redo(w->step[i].delta, w->mesh);
        const he_mesh *then = i + 1 < w->steps ? w->step[i + 1].before : now;
        require(w, he_mesh_equal_live(w->mesh, then), "redo led elsewhere");
    }
    require(w, he_mesh_equal(w->mesh, now), "undo and redo are not each other's inverse");
    he_mesh_free(now);
    w->tally->undone += w->steps - to;
}

/* Runs the call and rolls it back, as a dry run does: the mesh must be unchanged. */
static void rehearse(world *w, const he_mesh *before)
{
    he_results results = {0};
    he_error err = {0};
    he_savepoint mark = he_delta_mark(w->mesh);
    he_status status = he_op_run(w->call.op, w->mesh, w->call.args, &results, &err);
    he_delta_rollback(w->mesh, mark);
    require(w, he_mesh_equal(w->mesh, before), "rollback led elsewhere");
    w->tally->rolled_back += status == HE_OK;
    he_results_clear(&results);
}

/* --- one edit --- */

static void require_declared_change(const world *w, const he_mesh *before)
{
    static const he_kind kinds[3] = {HE_VERTEX, HE_EDGE, HE_FACE};
    for (int i = 0; i < 3; i++) {
        int change = (int)he_mesh_count(w->mesh, kinds[i]) - (int)he_mesh_count(before, kinds[i]);
        if (w->call.op->change[i] != HE_VARIES && w->call.op->change[i] != change) {
            stop(w, "counts moved otherwise than declared", he_kind_plural(kinds[i]));
        }
    }
}

/* If exactly one element of a kind is new, the result called vertex, edge or face must be this
 * element. */
static void require_results(const world *w, const he_mesh *before, const he_results *results)
{
    for (size_t i = 0; i < he_op_results(w->call.op); i++) {
        const he_result_row *row = &w->call.op->results[i];
        if (row->type != HE_RESULT_ELEMENT || !results->present[i] || row->kind == HE_HALFEDGE ||
            strcmp(row->name, he_kind_name(row->kind)) != 0) {
            continue;
        }
        uint32_t first = he_mesh_issued(before, row->kind);
        if (he_mesh_issued(w->mesh, row->kind) == first + 1 && results->id[i] != first) {
            stop(w, "a result names another element than the new one", row->name);
        }
    }
}

static void succeeded(world *w, uint64_t expected, he_mesh *before, he_delta *delta,
                      const he_results *results)
{
    char text[OR_TEXT] = "";
    if (expected != 0) {
        stop(w, "hedge accepted what the oracle refuses",
             he_status_slug((he_status)__builtin_ctzll(expected)));
    }
    w->tally->row[w->call.row].done++;
    if (!md_follow(&w->call, w->oracle, results, text)) {
        stop(w, "hedge did what the oracle does not", text);
    }
    if (strcmp(w->call.op->name, "compact") != 0 && !or_adopt(w->oracle, w->mesh, text)) {
        stop(w, "hedge made something else", text);
    }
    if (!or_matches(w->oracle, w->mesh, text)) {
        stop(w, "hedge's mesh is not the oracle's", text);
    }
    require_declared_change(w, before);
    require_results(w, before, results);
    if (delta == NULL) {
        forget_steps(w);
        he_mesh_free(before);
        return;
    }
    require_net(w, before, delta, false);
    keep_step(w, delta, before);
}

static void refused(world *w, uint64_t expected, he_status status, const he_error *err,
                    he_mesh *before, he_delta *delta)
{
    char text[HE_ERROR_TEXT + 64];
    (void)snprintf(text, sizeof text, "%s (%s)", he_status_slug(status), err->text);
    if (((expected | w->oracle->may) & OR_BIT(status)) == 0) {
        stop(w, expected != 0 ? "hedge gives a reason that does not apply" : "hedge refuses", text);
    }
    if (expected == 0) {
        or_decline(w->oracle);
    }
    if (!he_op_declares(w->call.op, status)) {
        stop(w, "the row does not declare this refusal", text);
    }
    require(w, err->status == status && err->text[0] != '\0', "a refusal without its error");
    require(w, he_mesh_equal(w->mesh, before), "a refusal changed the mesh");
    require(w, delta == NULL || (delta->count == 0 && delta->object_count == 0),
            "a refusal left records");
    w->tally->row[w->call.row].refused[status]++;
    he_delta_free(delta);
    he_mesh_free(before);
}

/* Returns whether the oracle's tables have room for an edit. It is assumed to make at most some
 * hundred elements, or some elements for each corner of the longest face or hole and for each
 * neighbour of a vertex. */
static bool has_room(const world *w)
{
    const or_mesh *o = w->oracle;
    uint32_t most = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        most = o->face[f].alive && o->face[f].count > most ? o->face[f].count : most;
    }
    for (uint32_t v = 0; v < o->vertices; v++) {
        most = or_degree(o, v) > most ? or_degree(o, v) : most;
    }
    return o->vertices + most + 12 < OR_VERTICES && o->edges + 3 * most + 300 < OR_EDGES &&
           o->faces + 2 * most + 300 < OR_FACES && or_live_faces(o) < w->faces_at_first + 100;
}

static void edit(world *w)
{
    int tries = 0;
    bool room = has_room(w);
    while (!md_draw(&w->call, w->oracle, w->mesh, &w->random, w->start->far, room)) {
        require(w, ++tries < 10000, "no call suits this mesh");
    }
    he_mesh *before = copy_of(w);
    he_delta *delta = md_chance(&w->random, 80) ? he_delta_new() : NULL;
    (void)he_mesh_record(w->mesh, delta);
    if (delta != NULL && md_chance(&w->random, 5)) {
        rehearse(w, before);
    }
    md_read_marks(w->oracle, w->mesh);
    uint64_t expected = md_play(&w->call, w->oracle, w->mesh);
    he_results results = {0};
    he_error err = {0};
    he_status status = md_chance(&w->random, 3)
                           ? run_starved(w, before, delta, &results, &err)
                           : he_op_run(w->call.op, w->mesh, w->call.args, &results, &err);
    (void)he_mesh_record(w->mesh, NULL);
    w->tally->edits++;
    if (status == HE_OK) {
        succeeded(w, expected, before, delta, &results);
    } else {
        refused(w, expected, status, &err, before, delta);
    }
    he_results_clear(&results);
    w->tally->faces =
        he_mesh_faces(w->mesh) > w->tally->faces ? he_mesh_faces(w->mesh) : w->tally->faces;
    if (md_chance(&w->random, 4)) {
        undo_and_redo(w);
    }
}

/* --- the run --- */

/* Makes `edits` random edits of one mesh. */
static void live(world *w, uint64_t edits)
{
    char text[OR_TEXT] = "";
    w->mesh = md_begin(w->start, w->oracle, &w->random);
    assert_non_null(w->mesh);
    assert_true(md_mark(w->mesh, &w->random));
    w->call.op = he_op_at(0);
    he_op_defaults(w->call.op, w->call.args);
    if (!or_matches(w->oracle, w->mesh, text)) {
        stop(w, "the built mesh is not the oracle's", text);
    }
    w->faces_at_first = he_mesh_faces(w->mesh);
    uint32_t life = md_from(&w->random, 10, 150);
    for (uint32_t i = 0; i < life && w->tally->edits < edits; i++) {
        if (he_mesh_faces(w->mesh) == 0 && md_chance(&w->random, 20)) {
            break;
        }
        edit(w);
    }
    forget_steps(w);
    he_mesh_free(w->mesh);
    w->tally->meshes++;
}

static void start_from(world *w, const md_start *start, uint64_t edits, md_tally *tally)
{
    char name[MD_START_NAME + 16];
    w->start = start;
    w->tally = tally;
    while (tally->edits < edits) {
        live(w, edits);
    }
    (void)snprintf(name, sizeof name, "%s%s", start->file == NULL ? "note: start " : "start ",
                   start->name);
    md_tally_print(tally, name);
    md_tally_print_rows(tally, "    ");
    (void)fflush(stdout);
}

/* Requires that every operation has succeeded. Starts from files are left out, because they get too
 * few edits for rare operations, and the mesh with huge coordinates, which does not suit all
 * operations. */
static void require_all_rows(const md_start *start, const md_tally *tally)
{
    if (start->file == NULL && !start->far && md_tally_idle(tally) > 0) {
        fail_msg("from start %s %zu rows never succeeded", start->name, md_tally_idle(tally));
    }
}

static void run_limits(md_tally *all)
{
    md_tally tally = {.edits = 0};
    const char *wrong = md_limits_run(&tally);
    if (wrong != NULL) {
        fail_msg("an edit that takes too long: %s", wrong);
    }
    md_tally_print(&tally, "note: start limits");
    md_tally_add(all, &tally);
}

static void every_edit_agrees_with_the_oracle(void **state)
{
    (void)state;
    world *w = calloc(1, sizeof *w);
    md_tally *all = calloc(1, sizeof *all);
    md_tally *files = calloc(1, sizeof *files);
    assert_true(w != NULL && all != NULL && files != NULL);
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    uint64_t edits = seed_setting("EDITS", SANITIZED ? 20000 : 50000);
    w->seed = seed_setting("SEED", (uint64_t)now.tv_sec * 1000003u + (uint64_t)now.tv_nsec);
    w->random.state = w->seed;
    w->oracle = or_new();
    printf("note: SEED=%" PRIu64 " EDITS=%" PRIu64 "\n", w->seed, edits);
    (void)fflush(stdout);
    assert_true(he_op_count() <= MD_ROWS);
    if (md_missing() != NULL) {
        fail_msg("tests/model/calls.c has no line for %s", md_missing());
    }
    md_starts starts = md_starts_find();
    double share = 0;
    for (size_t i = 0; i < starts.count; i++) {
        md_tally *tally = calloc(1, sizeof *tally);
        assert_non_null(tally);
        uint64_t done = all->edits;
        share += starts.start[i].share;
        uint64_t until = i + 1 < starts.count ? (uint64_t)(share * (double)edits) : edits;
        start_from(w, &starts.start[i], until > done ? until - done : 0, tally);
        md_tally_add(all, tally);
        if (edits >= ALL) {
            require_all_rows(&starts.start[i], tally);
        }
        if (starts.start[i].file != NULL) {
            md_tally_add(files, tally);
        }
        free(tally);
    }
    printf("note: %zu ", starts.files);
    md_tally_print(files, "files");
    if (edits >= ALL) {
        run_limits(all);
    }
    md_tally_print(all, "note: in all");
    md_tally_print_rows(all, "note: ");
    (void)fflush(stdout);
    if (edits >= ENOUGH) {
        assert_int_equal(md_tally_idle(all), 0);
    }
    if (edits >= ALL) {
        assert_int_equal(md_tally_missing(all), 0);
    }
    md_starts_clear(&starts);
    or_free(w->oracle);
    free(files);
    free(all);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_edit_agrees_with_the_oracle)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
