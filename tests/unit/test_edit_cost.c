/* The daemon estimates the cost of an operation before a thread runs it. */
#include "fixture.h"

#include "algo/shape.h"
#include "api/write/edit_cost.h"

enum { LONG = 5000 };

/* Returns a cone, whose base is one face with LONG corners and whose tip is a vertex with LONG
 * edges. */
static he_mesh *cone(void)
{
    double args[HE_SHAPE_PARAMS];
    he_soup soup;
    he_mesh *m = NULL;
    const he_shape *shape = he_shape_find("cone", 4);
    he_shape_defaults(shape, args);
    args[0] = LONG;
    assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_OK);
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &m, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    return m;
}

static uint32_t find_face(const he_mesh *m, bool is_long)
{
    uint32_t f = 0;
    while ((he_face_degree(m, (he_face){f}) > 3) != is_long) {
        f++;
    }
    return f;
}

static bool exceeds(const he_mesh *m, const char *name, const char *param, uint32_t id,
                    uint64_t most)
{
    api_edit_cost cost = {.count = 0};
    api_call call = {.op = he_op_find(name, strlen(name))};
    assert_non_null(call.op);
    he_op_defaults(call.op, call.args);
    for (size_t i = 0; i < he_op_params(call.op); i++) {
        if (strcmp(call.op->params[i].name, param) == 0) {
            call.args[i].given = true;
            call.args[i].id = id;
            call.args[i].ids = &id;
            call.args[i].count = 1;
        }
    }
    assert_int_equal(api_edit_cost_add(&cost, &call, NULL), HE_OK);
    bool result = api_edit_cost_exceeds(&cost, m, most);
    api_edit_cost_clear(&cost);
    return result;
}

static void what_lies_about_neighbours_counts_where_it_is_looked_at(void **state)
{
    (void)state;
    he_mesh *m = cone();
    uint32_t base = find_face(m, true), side = find_face(m, false);
    /* `rim` is a half-edge along the cone's base. `other` is the twin of `rim` and belongs to a
     * triangle at the cone's tip. */
    he_halfedge rim = he_face_halfedge(m, (he_face){base});
    uint32_t corner = he_origin(m, rim).i, edge = he_edge_of(rim).i;
    uint32_t other = he_twin(rim).i;
    const struct {
        const char *name, *param;
        uint32_t id;
        bool reaches;
    } cases[] = {
        {"vertex_move", "vertex", corner, false},
        {"vertex_bevel", "vertex", corner, false},
        {"vertex_dissolve", "vertex", corner, true},
        {"vertex_delete", "vertex", corner, true},
        {"vertex_weld", "vertex", corner, true},
        {"edge_collapse", "edge", edge, true},
        {"edge_collapse", "halfedge", rim.i, true},
        {"face_join", "edge", edge, true},
        {"edge_weld", "a", edge, true},
        {"face_delete", "face", side, false},
        {"face_poke", "face", base, true},
        {"face_collapse", "face", side, true},
        {"face_inset", "face", side, true},
        {"loop_join", "a", other, true}, /* the half-edge `other` belongs to a triangle that has the
                                            cone's tip as a corner */
        {"loop_join", "b", rim.i, true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        print_message("%s %s\n", cases[i].name, cases[i].param);
        assert_true(exceeds(m, cases[i].name, cases[i].param, cases[i].id, 100) ==
                    cases[i].reaches);
        assert_false(exceeds(m, cases[i].name, cases[i].param, cases[i].id, 20 * LONG));
        /* An operation with invalid ids is refused at once, so its estimated cost is 0. */
        assert_false(exceeds(m, cases[i].name, cases[i].param, HE_MAX_ROWS, 0));
    }
    he_mesh_free(m);
}

/* Returns the estimated number of steps of an operation whose first parameter is an element, or a
 * list of elements. */
static uint64_t steps_of(const he_mesh *m, const char *name, const uint32_t *ids, size_t count,
                         api_hubs *hubs)
{
    api_call call = {.op = he_op_find(name, strlen(name))};
    assert_non_null(call.op);
    he_op_defaults(call.op, call.args);
    call.args[0].given = true;
    call.args[0].id = ids[0];
    call.args[0].ids = ids;
    call.args[0].count = count;
    return api_edit_cost_steps(&call, m, UINT64_MAX / 2, hubs);
}

static void a_list_is_charged_for_the_hubs_it_walks_about(void **state)
{
    (void)state;
    he_mesh *m = cone();
    uint32_t base = find_face(m, true), side = find_face(m, false);
    he_halfedge rim = he_face_halfedge(m, (he_face){base});
    uint32_t ends[2] = {he_origin(m, rim).i, he_target(m, rim).i}, none = HE_MAX_ROWS;
    uint32_t spoke = he_edge_of(he_swing_ccw(m, rim)).i;
    api_hubs hubs = {.slots = {{0}}};
    /* edge_split and vertex_move change only a few elements near their arguments, so the estimate
     * must not count the many edges of the cone's tip. */
    assert_int_equal(steps_of(m, "edge_split", &spoke, 1, &hubs), 0);
    assert_int_equal(steps_of(m, "vertex_move", ends, 2, &hubs), 0);
    /* The weld visits all edges of the cone's tip (a neighbour of both vertices) and all corners of
     * the base. It does so four times: twice for each of the two vertices. */
    uint64_t weld = steps_of(m, "vertex_weld", ends, 2, &hubs);
    assert_true(weld > 4 * LONG && weld < 20 * LONG);
    /* A second estimate of the same weld finds the degrees of vertices in the cache `hubs`. It must
     * be equal to the first estimate. */
    assert_true(steps_of(m, "vertex_weld", ends, 2, &hubs) == weld);
    assert_int_equal(steps_of(m, "vertex_weld", &none, 1, &hubs), 0);
    assert_true(steps_of(m, "face_split", &base, 1, &hubs) == LONG);
    assert_true(steps_of(m, "face_split", &side, 1, &hubs) == 3);
    assert_true(steps_of(m, "face_collapse", &side, 1, &hubs) > LONG);
    /* The estimate for a list of all elements must not exceed a few passes over the whole mesh. */
    uint32_t *all = he_mem_array(NULL, LONG, sizeof *all);
    assert_non_null(all);
    for (uint32_t i = 0; i < LONG; i++) {
        all[i] = i;
    }
    assert_true(steps_of(m, "vertex_weld", all, LONG, &hubs) ==
                8 * (uint64_t)he_mesh_count(m, HE_HALFEDGE));
    he_mem_free(all);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_lies_about_neighbours_counts_where_it_is_looked_at),
        cmocka_unit_test(a_list_is_charged_for_the_hubs_it_walks_about),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
