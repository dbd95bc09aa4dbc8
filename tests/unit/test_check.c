/* he_check finds broken invariants of a mesh: the test breaks each invariant in turn, and he_check
 * must report it. */
#include "fixture.h"

#include "mesh/write.h"
#include "tests/failing.h"

#include <math.h>

/* Requires that the checker reports the invariant `rule`, which the caller has broken in a valid
 * mesh; the checker may report other invariants, too. */
static void expect_rule(he_mesh *m, int rule)
{
    he_problem problems[32];
    size_t total = 0;
    assert_int_equal(he_check(m, problems, 32, &total, NULL), HE_OK);
    bool named = false;
    for (size_t i = 0; i < total && i < 32; i++) {
        named |= problems[i].rule == rule;
        assert_true(strlen(problems[i].text) > 5);
    }
    if (!named) {
        fail_msg("I%d is not among the %zu problems", rule, total);
    }
    he_problem first;
    size_t one = 0;
    assert_int_equal(he_check(m, &first, 1, &one, NULL), HE_OK);
    assert_true(one > 0);
    assert_int_equal(first.rule, problems[0].rule);
    he_mesh_free(m);
}

static void each_broken_rule_is_found_and_named(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    m->c.next[0] = 77;
    expect_rule(m, 1);
    m = fixture_mesh("012,023");
    m->c.origin[3] = HE_DEAD;
    expect_rule(m, 1);
    m = fixture_mesh("012,023");
    m->c.prev[0] = 0;
    expect_rule(m, 2);
    m = fixture_mesh("012,034");
    m->c.origin[2] = 4;
    expect_rule(m, 3);
    m = fixture_mesh("012,023");
    m->c.face[2] = 1;
    expect_rule(m, 4);
    m = fixture_mesh("012,034");
    m->c.face[0] = m->c.face[2] = m->c.face[4] = HE_NONE;
    expect_rule(m, 5);
    m = fixture_mesh("012,023");
    m->c.face_halfedge[0] = m->c.face_halfedge[1];
    expect_rule(m, 6);
    m = fixture_mesh("012,023");
    m->c.vertex_halfedge[1] = m->c.vertex_halfedge[0];
    expect_rule(m, 8);
    m = fixture_mesh("012,023");
    m->c.vertex_halfedge[0] = he_swing_ccw(m, (he_halfedge){m->c.vertex_halfedge[0]}).i;
    expect_rule(m, 8);
    m = fixture_mesh("012,023");
    m->c.position[2].y = INFINITY;
    expect_rule(m, 11);
    m = fixture_mesh("012,023");
    m->c.faces.live = 3;
    expect_rule(m, 12);
    m = fixture_mesh("012,023");
    m->c.boundary_halfedges++;
    expect_rule(m, 12);
}

/* A vertex has two open fans of faces, but its boundary links form two loops: walking around the
 * vertex from one fan never comes to the other (invariant I9). */
static void fans_in_separate_boundary_loops_are_found(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,034");
    he_halfedge a = he_vertex_halfedge(m, (he_vertex){0}), b = a;
    do {
        b = he_swing_ccw(m, b);
    } while (!he_is_boundary_halfedge(m, b));
    he_halfedge into_a = he_prev(m, a), into_b = he_prev(m, b);
    he_link(m, into_a, b);
    he_link(m, into_b, a);
    expect_rule(m, 9);
}

/* Two triangles have two equal corners, but no common edge: the edge 0-1 exists twice. */
static void an_edge_that_exists_twice_is_found(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,345");
    he_halfedge h = he_find_halfedge(m, (he_vertex){3}, (he_vertex){4});
    m->c.origin[h.i] = 0;
    m->c.origin[he_twin(he_prev(m, h)).i] = 0;
    h = he_next(m, h);
    m->c.origin[h.i] = 1;
    m->c.origin[he_twin(he_prev(m, h)).i] = 1;
    he_problem problems[32];
    size_t total = 0;
    assert_int_equal(he_check(m, problems, 32, &total, NULL), HE_OK);
    assert_true(total > 0);
    he_mesh_free(m);
}

static void a_face_that_visits_a_vertex_twice_is_found(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("0123");
    m->c.origin[he_face_halfedge(m, (he_face){0}).i] = 2;
    expect_rule(m, 7);
}

/* Even if links are set to random values, he_check must terminate and not read out of bounds. */
static void a_check_of_random_links_ends_and_stays_in_range(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int round = 0; round < 20000; round++) {
        he_mesh *m = fixture_mesh("0123,7654,1045,2156,3267");
        uint32_t *columns[] = {m->c.next, m->c.prev, m->c.origin, m->c.face};
        for (int k = 0; k < 3; k++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            uint32_t h = (uint32_t)(seed >> 33) % 24;
            columns[seed >> 20 & 3][h] = (uint32_t)(seed >> 50) % 26;
        }
        size_t total = 0;
        he_problem problems[4];
        assert_int_equal(he_check(m, problems, 4, &total, NULL), HE_OK);
        he_mesh_free(m);
    }
}

static void a_check_without_memory_is_refused_and_reports_nothing(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    failing f = {0};
    while (failing_next(&f)) {
        size_t total = 5;
        he_problem problem;
        bool done = failing_status(&f, he_check(m, &problem, 1, &total, NULL));
        assert_int_equal(total, done ? 0 : 5);
    }
    assert_true(f.n > 3);
    fixture_check(m);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_broken_rule_is_found_and_named),
        cmocka_unit_test(fans_in_separate_boundary_loops_are_found),
        cmocka_unit_test(an_edge_that_exists_twice_is_found),
        cmocka_unit_test(a_face_that_visits_a_vertex_twice_is_found),
        cmocka_unit_test(a_check_of_random_links_ends_and_stays_in_range),
        cmocka_unit_test(a_check_without_memory_is_refused_and_reports_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
