/* Operations that run once for each item of a list, compared with the same operations one after
 * another: the mesh must be equal in every bit, and so must the results. If one of the items is
 * refused, the list must be refused at this item, for the same reason, and the mesh must be as it
 * was; so it must be after a failed allocation. Undo must restore it.
 *
 * The operations are drawn as in test_model.c, on every start of starts.h. DRAWS (60000) and SEED
 * (from the clock) come from the environment. With ENOUGH draws, a list of every operation that
 * takes one must have succeeded. */
#include "mesh/check.h"
#include "mesh/delta.h"
#include "model/calls.h"
#include "model/starts.h"
#include "model/tally.h"
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
#include <time.h>

#include <cmocka.h>

enum { MOST = 4, ENOUGH = 1000000 };

/* Calls of one operation that differ only in what may be a column. */
typedef struct group {
    md_call calls[MOST];
    size_t count;
} group;

/* The columns that are made of the calls of a group. */
typedef struct columns {
    he_arg args[HE_OP_PARAMS];
    uint32_t ids[HE_OP_PARAMS][MOST * MD_LIST];
    uint32_t ends[MOST];
    he_vec3 points[HE_OP_PARAMS][MOST];
    double numbers[HE_OP_PARAMS][MOST];
} columns;

typedef struct world {
    uint64_t seed;
    md_random random;
    const char *start;
    const he_op *op;
    uint64_t done[MD_ROWS], refused[MD_ROWS];
} world;

static void require(const world *w, bool holds, const char *what)
{
    if (!holds) {
        fail_msg("SEED=%" PRIu64 ", start %s, a list of %s: %s", w->seed, w->start, w->op->name,
                 what);
    }
}

static he_mesh *copy_of(const he_mesh *mesh)
{
    he_mesh *copy = NULL;
    assert_int_equal(he_mesh_copy(mesh, &copy, NULL), HE_OK);
    return copy;
}

/* --- from calls to columns --- */

/* Returns the parameter that can be a list in a call, or NULL if none was given. */
static const he_param *list_of(const md_call *c)
{
    for (size_t i = 0; i < he_op_params(c->op); i++) {
        if (c->op->params[i].each != NULL && c->args[i].given) {
            return &c->op->params[i];
        }
    }
    return NULL;
}

/* Returns true if two calls can be items of one list. */
static bool are_alike(const md_call *a, const md_call *b)
{
    for (size_t i = 0; i < he_op_params(a->op); i++) {
        const he_param *param = &a->op->params[i];
        const he_arg *x = &a->args[i], *y = &b->args[i];
        const bool may_differ = he_op_is_column(param) || param->each != NULL;
        if (x->given != y->given || (!may_differ && x->choice != y->choice)) {
            return false;
        }
    }
    return true;
}

static void make_column(const group *g, size_t i, columns *to)
{
    const he_op *op = g->calls[0].op;
    he_arg *column = &to->args[i];
    *column = (he_arg){.given = true, .list = true, .count = g->count, .id = HE_NONE};
    if (op->params[i].type == HE_PARAM_CYCLE) {
        column->count = 0;
        column->rows = g->count;
        column->ends = to->ends;
    }
    for (size_t k = 0; k < g->count; k++) {
        const he_arg *arg = &g->calls[k].args[i];
        switch (op->params[i].type) {
        case HE_PARAM_ELEMENT:
            to->ids[i][k] = arg->id;
            break;
        case HE_PARAM_POINT:
            to->points[i][k] = g->calls[k].points[i][0];
            break;
        case HE_PARAM_NUMBER:
            to->numbers[i][k] = arg->number;
            break;
        case HE_PARAM_FLAG:
            to->numbers[i][k] = arg->flag;
            break;
        case HE_PARAM_CHOICE:
            to->numbers[i][k] = arg->choice;
            break;
        case HE_PARAM_CYCLE:
            memcpy(&to->ids[i][column->count], g->calls[k].ids[i], arg->count * sizeof(uint32_t));
            column->count += arg->count;
            to->ends[k] = (uint32_t)column->count;
            break;
        case HE_PARAM_ELEMENTS:
        case HE_PARAM_POINTS:
        case HE_PARAM_MATRIX:
        case HE_PARAM_POLYGON:
        case HE_PARAM_TEXT:
        case HE_PARAM_COLOR:
        case HE_PARAM_MESH:
            fail_msg("a column without a type");
        }
    }
    column->ids = to->ids[i];
    column->points = to->points[i];
    column->numbers = to->numbers[i];
}

/* Makes columns of all arguments that may be columns. */
static void make_columns(const group *g, columns *to)
{
    const md_call *first = &g->calls[0];
    memcpy(to->args, first->args, sizeof to->args);
    for (size_t i = 0; i < he_op_params(first->op); i++) {
        const he_param *param = &first->op->params[i];
        if (first->args[i].given && (he_op_is_column(param) || param == list_of(first))) {
            make_column(g, i, to);
        }
    }
}

/* A call points into itself, so that a copy must be mended. */
static void mend(md_call *c)
{
    for (size_t i = 0; i < he_op_params(c->op); i++) {
        he_arg *arg = &c->args[i];
        arg->ids = arg->ids == NULL ? NULL : c->ids[i];
        arg->points = arg->points == NULL ? NULL : c->points[i];
    }
}

/* --- the comparison --- */

static uint64_t bits(double number)
{
    uint64_t all;
    memcpy(&all, &number, sizeof all);
    return all;
}

/* Compares the results of run `k` of a list with those of the same operation on its own. */
static void compare_results(const world *w, const he_results *list, const he_results *one, size_t k)
{
    for (size_t i = 0; i < he_op_results(w->op); i++) {
        const he_ids *ids = &list->list[i];
        switch (w->op->results[i].type) {
        case HE_RESULT_ELEMENT:
            require(w, ids->count == list->runs && ids->ids[k] == one->id[i], "another element");
            break;
        case HE_RESULT_ELEMENTS: {
            const uint32_t from = k == 0 ? 0 : list->ends[i].ids[k - 1];
            const uint32_t to = list->ends[i].ids[k];
            require(w, to - from == one->list[i].count, "a list of another length");
            require(w,
                    to == from || memcmp(ids->ids + from, one->list[i].ids,
                                         (to - from) * sizeof(uint32_t)) == 0,
                    "other elements");
            break;
        }
        case HE_RESULT_NUMBER:
            require(w,
                    one->present[i] ? bits(list->numbers[i][k]) == bits(one->number[i])
                                    : isnan(list->numbers[i][k]),
                    "another number");
            break;
        case HE_RESULT_MAP:
        case HE_RESULT_COUNTS:
        case HE_RESULT_CHOICE:
            fail_msg("no such result of a list is known");
        }
    }
}

/* Runs the list with the first, second, third ... allocation failing, until one run succeeds. */
static void starve(const world *w, const columns *c, const he_mesh *before)
{
    he_mesh *mesh = copy_of(before);
    failing f = {.may_succeed = true, .sparse = 50};
    he_status status = HE_NO_MEMORY;
    while (failing_next(&f)) {
        he_results results = {0};
        status = he_op_run(w->op, mesh, c->args, &results, NULL);
        he_results_clear(&results);
        if (failing_end(&f, status != HE_NO_MEMORY)) {
            break;
        }
        require(w, he_mesh_equal(mesh, before), "a failed allocation changed the mesh");
    }
    he_mesh_free(mesh);
}

static void check_mesh(const world *w, const he_mesh *mesh)
{
    he_problem problem;
    size_t problems = 0;
    require(w, he_check(mesh, &problem, 1, &problems, NULL) == HE_OK && problems == 0,
            "the mesh fails the check");
}

static void compare(world *w, const he_mesh *before, const group *g, const columns *c)
{
    he_mesh *single = copy_of(before), *listed = copy_of(before);
    he_results ones[MOST] = {{.each = false}}, list = {.each = false};
    he_error err = {0}, list_err = {0};
    he_status status = HE_OK;
    size_t done = 0;
    while (done < g->count && status == HE_OK) {
        status = he_op_run(w->op, single, g->calls[done].args, &ones[done], &err);
        done += status == HE_OK;
    }
    he_delta *delta = md_chance(&w->random, 50) ? he_delta_new() : NULL;
    (void)he_mesh_record(listed, delta);
    require(w, he_op_run(w->op, listed, c->args, &list, &list_err) == status, "another outcome");
    (void)he_mesh_record(listed, NULL);
    require(w, list.runs == done, "another item is refused");
    if (status == HE_OK) {
        w->done[he_op_number(w->op)]++;
        require(w, list.each && he_mesh_equal(single, listed), "another mesh");
        for (size_t k = 0; k < done; k++) {
            compare_results(w, &list, &ones[k], k);
        }
        check_mesh(w, listed);
    } else {
        w->refused[he_op_number(w->op)]++;
        require(w,
                strcmp(err.text, list_err.text) == 0 && err.kind == list_err.kind &&
                    err.id == list_err.id,
                "another reason");
        require(w, he_mesh_equal(listed, before), "a refusal changed the mesh");
        require(w, delta == NULL || delta->count == 0, "a refusal left records");
    }
    if (delta != NULL) {
        he_delta_undo(delta, listed);
        require(w, he_mesh_equal_live(listed, before), "undo led elsewhere");
        he_delta_free(delta);
    }
    for (size_t k = 0; k < g->count; k++) {
        he_results_clear(&ones[k]);
    }
    he_results_clear(&list);
    he_mesh_free(single);
    he_mesh_free(listed);
}

/* --- the run --- */

static void add(world *w, group groups[MD_ROWS], const md_call *c, const he_mesh *mesh)
{
    static columns made;
    group *g = &groups[c->row];
    if (list_of(c) == NULL || (g->count > 0 && !are_alike(&g->calls[0], c))) {
        return;
    }
    g->calls[g->count] = *c;
    mend(&g->calls[g->count++]);
    /* A list of one item, sometimes, and else one of up to MOST items. */
    if (g->count < MOST && !md_chance(&w->random, 30)) {
        return;
    }
    w->op = c->op;
    make_columns(g, &made);
    compare(w, mesh, g, &made);
    if (md_chance(&w->random, 10)) {
        starve(w, &made, mesh);
    }
    g->count = 0;
}

static void draw_from(world *w, const md_start *start, uint64_t draws)
{
    static group groups[MD_ROWS];
    static md_call call;
    for (uint64_t drawn = 0; drawn < draws;) {
        or_mesh *oracle = or_new();
        he_mesh *mesh = md_begin(start, oracle, &w->random);
        assert_non_null(mesh);
        memset(groups, 0, sizeof groups);
        for (int i = 0; i < 2000 && drawn < draws; i++, drawn++) {
            if (md_draw(&call, oracle, mesh, &w->random, start->far, true)) {
                add(w, groups, &call, mesh);
            }
        }
        he_mesh_free(mesh);
        or_free(oracle);
    }
}

static void a_list_does_what_its_items_do_one_after_another(void **state)
{
    (void)state;
    world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    const uint64_t draws = seed_setting("DRAWS", SANITIZED ? 20000 : 60000);
    w->seed = seed_setting("SEED", (uint64_t)now.tv_sec * 1000003u + (uint64_t)now.tv_nsec);
    w->random.state = w->seed;
    printf("note: SEED=%" PRIu64 " DRAWS=%" PRIu64 "\n", w->seed, draws);
    md_starts starts = md_starts_find();
    for (size_t i = 0; i < starts.count - starts.files; i++) {
        w->start = starts.start[i].name;
        draw_from(w, &starts.start[i], draws / (starts.count - starts.files));
    }
    md_starts_clear(&starts);
    uint64_t done = 0, refused = 0;
    for (size_t row = 0; row < he_op_count(); row++) {
        const he_op *op = he_op_at(row);
        bool each = false;
        for (size_t i = 0; i < he_op_params(op); i++) {
            each = each || op->params[i].each != NULL;
        }
        if (each && draws >= ENOUGH && w->done[row] == 0) {
            fail_msg("SEED=%" PRIu64 ": no list of %s succeeded", w->seed, op->name);
        }
        done += w->done[row];
        refused += w->refused[row];
    }
    printf("note: %" PRIu64 " lists done, %" PRIu64 " refused\n", done, refused);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_list_does_what_its_items_do_one_after_another)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
