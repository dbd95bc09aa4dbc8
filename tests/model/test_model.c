/* Random edits against the oracle: after each, success or refusal, counts, ids, cycles, ends, links
 * and rings must be what oracle.h says; a refusal or a failed allocation must leave the mesh as it
 * was; undo, redo and rollback must lead back bit for bit; the reported sets must be the ones a
 * comparison of both states finds.
 *
 * EDITS (100000) and SEED (from the clock) come from the environment. */
#include "mesh/delta.h"
#include "mesh/mem.h"
#include "model/calls.h"
#include "model/marks.h"
#include "model/net.h"
#include "model/shapes.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { STEPS = 12, ROWS = 256, ENOUGH = 20000 };

/* An edit that can be undone, and the mesh before it. */
typedef struct step {
    he_delta *delta;
    he_mesh *before;
} step;

typedef struct tally {
    uint64_t done;
    uint64_t refused[HE_STATUS_COUNT];
    uint32_t starved; /* the highest N for which the N-th allocation failed */
} tally;

typedef struct world {
    uint64_t seed, meshes, edits, steps_undone, rehearsals;
    md_random random;
    or_mesh *oracle;
    he_mesh *mesh;
    step step[STEPS];
    size_t steps;
    md_call call;
    tally tally[ROWS];
} world;

/* --- failing ------------------------------------------------------------------------------- */

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
    print_error("SEED=%" PRIu64 ", edit %" PRIu64 ": %s\n%s: %s\n", w->seed, w->edits, text, what,
                detail);
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

/* --- allocations that fail ------------------------------------------------------------------ */

typedef struct famine {
    uint32_t left; /* allocations that succeed */
    bool lasts;    /* do those after the first failure fail too? */
    bool struck;
} famine;

static void *resize_until(void *context, void *memory, size_t size)
{
    famine *f = context;
    if (size == 0) {
        free(memory);
        return NULL;
    }
    if (f->left == 0 && (!f->struck || f->lasts)) {
        f->struck = true;
        return NULL;
    }
    f->left -= f->left > 0;
    return realloc(memory, size);
}

/* Run the call with the first, second, third ... allocation failing, until one runs to its end. */
static he_status run_starved(world *w, const he_mesh *before, const he_delta *delta,
                             he_results *results, he_error *err)
{
    tally *t = &w->tally[w->call.row];
    for (uint32_t n = 0;; n++) {
        famine f = {.left = n, .lasts = md_chance(&w->random, 50)};
        const he_mem_hook hook = {resize_until, &f};
        he_mem_set_hook(&hook);
        he_status status = he_op_run(w->call.op, w->mesh, w->call.args, results, err);
        he_mem_set_hook(NULL);
        if (status != HE_NO_MEMORY) {
            return status;
        }
        t->starved = n + 1 > t->starved ? n + 1 : t->starved;
        require(w, f.struck, "out of memory although no allocation failed");
        require(w, he_mesh_equal(w->mesh, before), "a failed allocation changed the mesh");
        require(w, delta == NULL || (delta->count == 0 && delta->object_count == 0),
                "a failed allocation left records");
        require(w, n < 1000, "allocations without end");
    }
}

/* --- undo ----------------------------------------------------------------------------------- */

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
        require(w, strcmp(w->call.op->name, "compact") == 0 || undone, "a local edit replaced");
    } else if (!md_net_matches(was, w->mesh, &changes, text)) {
        stop(w, undone ? "the sets of an undo are wrong" : "the sets of an edit are wrong", text);
    }
    he_changes_clear(&changes);
}

/* Back a random number of steps and forth again. */
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
    for (size_t i = to; i < w->steps; i++) {
        he_delta_redo(w->step[i].delta, w->mesh);
        const he_mesh *then = i + 1 < w->steps ? w->step[i + 1].before : now;
        require(w, he_mesh_equal_live(w->mesh, then), "redo led elsewhere");
    }
    require(w, he_mesh_equal(w->mesh, now), "undo and redo are not each other's inverse");
    he_mesh_free(now);
    w->steps_undone += w->steps - to;
}

/* Run the call and take it back as if it had never been published. */
static void rehearse(world *w, const he_mesh *before)
{
    he_results results = {0};
    he_error err = {0};
    he_savepoint mark = he_delta_mark(w->mesh);
    he_status status = he_op_run(w->call.op, w->mesh, w->call.args, &results, &err);
    he_delta_rollback(w->mesh, mark);
    require(w, he_mesh_equal(w->mesh, before), "rollback led elsewhere");
    w->rehearsals += status == HE_OK;
    he_results_clear(&results);
}

/* --- one edit ------------------------------------------------------------------------------- */

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

/* A result called vertex, edge or face is the one the edit made, where it made just one. */
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
    w->tally[w->call.row].done++;
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
    w->tally[w->call.row].refused[status]++;
    he_delta_free(delta);
    he_mesh_free(before);
}

static bool has_room(const or_mesh *o)
{
    return o->vertices < OR_VERTICES - 12 && o->edges < OR_EDGES - 300 &&
           o->faces < OR_FACES - 300 && or_live_faces(o) < 120;
}

static void edit(world *w)
{
    int tries = 0;
    while (!md_draw(&w->call, w->oracle, w->mesh, &w->random, has_room(w->oracle))) {
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
    w->edits++;
    if (status == HE_OK) {
        succeeded(w, expected, before, delta, &results);
    } else {
        refused(w, expected, status, &err, before, delta);
    }
    he_results_clear(&results);
    if (md_chance(&w->random, 4)) {
        undo_and_redo(w);
    }
}

/* --- the run -------------------------------------------------------------------------------- */

static void show_row(const he_op *op, const tally *t)
{
    char given[512] = "";
    char missing[512] = "";
    size_t g = 0;
    size_t n = 0;
    for (int s = 0; s < HE_STATUS_COUNT; s++) {
        const char *slug = he_status_slug((he_status)s);
        if (t->refused[s] > 0 && g < sizeof given) {
            g += (size_t)snprintf(given + g, sizeof given - g, " %s %" PRIu64, slug, t->refused[s]);
        }
    }
    for (size_t i = 0; i < HE_OP_REFUSALS && op->refusals[i] != HE_OK; i++) {
        if (t->refused[op->refusals[i]] == 0 && n < sizeof missing) {
            n += (size_t)snprintf(missing + n, sizeof missing - n, " %s",
                                  he_status_slug(op->refusals[i]));
        }
    }
    printf("note: %-16s %7" PRIu64 " done, N-th allocation up to %u; refused:%s%s%s\n", op->name,
           t->done, t->starved, g > 0 ? given : " never", n > 0 ? "; never:" : "", missing);
}

static uint64_t number_from(const char *name, uint64_t fallback)
{
    const char *text = getenv(name);
    return text != NULL && text[0] != '\0' ? strtoull(text, NULL, 10) : fallback;
}

static void every_edit_agrees_with_the_oracle(void **state)
{
    (void)state;
    world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    uint64_t edits = number_from("EDITS", 100000);
    w->seed = number_from("SEED", (uint64_t)now.tv_sec * 1000003u + (uint64_t)now.tv_nsec);
    w->random.state = w->seed;
    w->oracle = or_new();
    printf("note: SEED=%" PRIu64 " EDITS=%" PRIu64 "\n", w->seed, edits);
    (void)fflush(stdout);
    assert_true(he_op_count() <= ROWS);
    if (md_missing() != NULL) {
        fail_msg("tests/model/calls.c has no line for %s", md_missing());
    }
    while (w->edits < edits) {
        char text[OR_TEXT] = "";
        md_shape(w->oracle, &w->random);
        w->mesh = md_build(w->oracle);
        assert_non_null(w->mesh);
        assert_true(md_mark(w->mesh, &w->random));
        w->call.op = he_op_at(0);
        he_op_defaults(w->call.op, w->call.args);
        if (!or_matches(w->oracle, w->mesh, text)) {
            stop(w, "the built mesh is not the oracle's", text);
        }
        uint32_t life = md_from(&w->random, 10, 150);
        for (uint32_t i = 0; i < life && w->edits < edits; i++) {
            if (he_mesh_faces(w->mesh) == 0 && md_chance(&w->random, 20)) {
                break;
            }
            edit(w);
        }
        forget_steps(w);
        he_mesh_free(w->mesh);
        w->meshes++;
    }
    printf("note: %" PRIu64 " edits on %" PRIu64 " meshes, %" PRIu64 " steps undone and redone, "
           "%" PRIu64 " rolled back\n",
           w->edits, w->meshes, w->steps_undone, w->rehearsals);
    size_t idle = 0;
    for (size_t i = 0; i < he_op_count(); i++) {
        show_row(he_op_at(i), &w->tally[i]);
        idle += w->tally[i].done == 0;
    }
    if (edits >= ENOUGH) {
        assert_int_equal(idle, 0);
    }
    or_free(w->oracle);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_edit_agrees_with_the_oracle)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
