/* The sum of the changes of several edits of a large mesh, with many records: he_changes_sum then
 * marks changed words and elements with bits, and must join them with edits that write all
 * positions at once. What it lists is compared with the differences between copies of the mesh. */
#include "tests/unit/dense.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/stored_trip.h"

#include "edit/local/collapse.h"
#include "edit/local/flip.h"
#include "edit/local/split.h"
#include "edit/whole/positions.h"
#include "mesh/write.h"
#include "tests/model/random.h"
#include "tests/seed.h"

enum {
    SIDE = 130
}; /* a grid of this side has so many vertices that one record can move them all */
enum { EDITS = 3, STEPS = 6 };

static bool is_live(const he_mesh *m, he_kind kind, uint32_t id)
{
    return id < he_mesh_issued(m, kind) && he_mesh_is_live(m, kind, id);
}

static bool vertex_differs(const he_mesh *a, const he_mesh *b, uint32_t v)
{
    return memcmp((const char *)&a->c.position[v], (const char *)&b->c.position[v],
                  sizeof *a->c.position) != 0 ||
           a->c.vertex_halfedge[v] != b->c.vertex_halfedge[v];
}

static bool edge_differs(const he_mesh *a, const he_mesh *b, uint32_t e)
{
    bool differs = false;
    for (uint32_t h = 2 * e; h < 2 * e + 2; h++) {
        differs |= a->c.origin[h] != b->c.origin[h] || a->c.face[h] != b->c.face[h];
    }
    return differs;
}

static bool face_differs(const he_mesh *a, const he_mesh *b, uint32_t f)
{
    const uint32_t start = a->c.face_halfedge[f];
    uint32_t h = start;
    bool differs = start != b->c.face_halfedge[f];
    while (!differs) {
        differs = a->c.origin[h] != b->c.origin[h] || a->c.next[h] != b->c.next[h];
        h = a->c.next[h];
        if (h == start) {
            break;
        }
    }
    return differs;
}

static bool differs(const he_mesh *a, const he_mesh *b, he_kind kind, uint32_t id)
{
    return kind == HE_VERTEX ? vertex_differs(a, b, id)
           : kind == HE_EDGE ? edge_differs(a, b, id)
                             : face_differs(a, b, id);
}

/* Returns true if the next id of a list is `id`, and passes over it. Since the ids are asked for in
 * order, a list that is not sorted or has repeats is never passed to its end. */
static bool takes_next(const he_ids *list, size_t *at, uint32_t id)
{
    const bool is_next = *at < list->count && list->ids[*at] == id;
    *at += is_next ? 1 : 0;
    return is_next;
}

static void compare_kind(const he_mesh *from, const he_mesh *to, const he_changes *changes,
                         he_kind kind)
{
    size_t created = 0, deleted = 0, modified = 0;
    for (uint32_t id = 0; id < he_mesh_issued(to, kind); id++) {
        const bool was = is_live(from, kind, id), is = is_live(to, kind, id);
        const bool has_changed = was && is && differs(from, to, kind, id);
        if (takes_next(&changes->created[kind], &created, id) != (!was && is) ||
            takes_next(&changes->deleted[kind], &deleted, id) != (was && !is) ||
            takes_next(&changes->modified[kind], &modified, id) != has_changed) {
            fail_msg("element %u of kind %d: was live %d, is live %d, differs %d", id, (int)kind,
                     was, is, has_changed);
        }
    }
    assert_int_equal(created, changes->created[kind].count);
    assert_int_equal(deleted, changes->deleted[kind].count);
    assert_int_equal(modified, changes->modified[kind].count);
}

static void compare_sum(const he_mesh *from, const he_mesh *to, const he_change_part *parts,
                        size_t count)
{
    he_changes changes;
    assert_int_equal(he_changes_sum(to, parts, count, &changes, NULL), HE_OK);
    compare_kind(from, to, &changes, HE_VERTEX);
    compare_kind(from, to, &changes, HE_EDGE);
    compare_kind(from, to, &changes, HE_FACE);
    he_changes_clear(&changes);
}

/* Makes many local edits of random elements; those that are refused change nothing. */
static void edit_elements(he_mesh *m, md_random *random)
{
    const uint32_t what = md_below(random, 3), most = md_chance(random, 50) ? 2000 : 10;
    for (uint32_t left = 1 + md_below(random, most); left > 0; left--) {
        he_status status = HE_OK;
        const he_edge e = {md_below(random, he_mesh_issued(m, HE_EDGE))};
        if (what == 0) {
            status = he_edge_flip(m, e, NULL);
        } else if (what == 1) {
            status = he_edge_split(m, e, 0.5, NULL, NULL);
        } else {
            status = he_edge_collapse(m, (he_halfedge){2 * e.i}, 0.5, NULL, NULL, NULL);
        }
        (void)status;
    }
}

/* Returns a random point, or the one that the vertex had at first, so that changes cancel out. */
static he_vec3 point_for(const he_mesh *first, uint32_t v, md_random *random)
{
    return is_live(first, HE_VERTEX, v) && md_chance(random, 50)
               ? he_position(first, (he_vertex){v})
               : (he_vec3){md_unit(random), md_below(random, 3), md_unit(random)};
}

/* Moves some vertices, each by records of its words. */
static void move_some(he_mesh *m, const he_mesh *first, md_random *random)
{
    for (uint32_t left = 1 + md_below(random, 2000); left > 0; left--) {
        const he_vertex v = {md_below(random, he_mesh_issued(m, HE_VERTEX))};
        if (he_vertex_is_live(m, v)) {
            assert_int_equal(he_reserve(m, (he_reservation){.positions = 1}, NULL), HE_OK);
            he_set_position(m, v, point_for(first, v.i, random));
        }
    }
}

/* Moves most vertices by one call, which makes one record of all positions. */
static void move_all(he_mesh *m, const he_mesh *first, md_random *random)
{
    const uint32_t count = he_mesh_issued(m, HE_VERTEX);
    he_vec3 *points = he_mem_array(NULL, count, sizeof *points);
    assert_non_null(points);
    const bool random_points = md_chance(random, 60);
    for (uint32_t v = 0; v < count; v++) {
        points[v] = he_position(m, (he_vertex){v});
        if (random_points) {
            points[v] = point_for(first, v, random);
        } else {
            points[v].z += 0.1;
        }
    }
    assert_int_equal(he_positions_write(m, NULL, count, points, false, NULL), HE_OK);
    he_mem_free(points);
}

static he_delta *edit(he_mesh *m, const he_mesh *first, md_random *random)
{
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    he_mesh_record(m, delta);
    for (uint32_t left = 1 + md_below(random, STEPS); left > 0; left--) {
        const uint32_t what = md_below(random, 4);
        if (what < 2) {
            edit_elements(m, random);
        } else if (what == 2) {
            move_some(m, first, random);
        } else {
            move_all(m, first, random);
        }
    }
    he_mesh_record(m, NULL);
    return delta;
}

/* Returns how many records of a delta write all positions. */
static unsigned moves_of(const he_delta *delta)
{
    unsigned moves = 0;
    for (size_t i = 0; i < delta->count; i++) {
        moves += delta->records[i].column == HE_COL_POSITIONS;
    }
    return moves;
}

static void sums_of_many_records_equal_the_differences(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    unsigned moves = 0;
    for (int round = 0; round < 6; round++) {
        he_mesh *m = dense_grid(SIDE, dense_waves, 1), *after[EDITS + 1] = {copy_of(m)};
        he_delta *deltas[EDITS];
        he_change_part parts[EDITS], back[EDITS];
        for (size_t i = 0; i < EDITS; i++) {
            deltas[i] = edit(m, after[0], &random);
            moves += moves_of(deltas[i]);
            after[i + 1] = copy_of(m);
            parts[i] = (he_change_part){deltas[i], 0, deltas[i]->count, false};
            back[EDITS - 1 - i] = (he_change_part){deltas[i], 0, deltas[i]->count, true};
            for (size_t from = 0; from <= i; from++) {
                compare_sum(after[from], m, parts + from, i + 1 - from);
            }
        }
        stored_trip(after[EDITS - 1], deltas[EDITS - 1], after[EDITS]);
        for (size_t i = EDITS; i > 0; i--) {
            he_delta_undo(deltas[i - 1], m);
            assert_true(he_mesh_equal_live(m, after[i - 1]));
            compare_sum(after[EDITS], m, back, EDITS + 1 - i);
        }
        for (size_t i = 0; i < EDITS; i++) {
            he_delta_redo(deltas[i], m);
            he_delta_free(deltas[i]);
        }
        assert_true(he_mesh_equal(m, after[EDITS]));
        for (size_t i = 0; i <= EDITS; i++) {
            he_mesh_free(after[i]);
        }
        he_mesh_free(m);
    }
    print_message("note: %u records of all positions\n", moves);
    assert_true(moves > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_of_many_records_equal_the_differences),
    };
    return cmocka_run_group_tests_name("changes", tests, NULL, NULL);
}
