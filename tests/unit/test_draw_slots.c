/* The triangles of all faces are stored in the slots of one array, and the triangles of one face
 * fill neighbouring slots. The test adds and removes faces of all sizes. */
#include "query_specimens.h"

#include "draw/draw_slots.h"
#include "edit/local/erase.h"
#include "edit/local/face_add.h"
#include "edit/local/vertex.h"
#include "model/random.h"
#include "tests/seed.h"
#include "tests/failing.h"

#include <math.h>
#include <time.h>

enum { VERTICES = 3000, FACES = 60 };

/* The tested mesh with its delta and its slots. Its vertices lie on a circle; its faces have
 * different sizes, and each face uses a row of neighbouring vertices. */
typedef struct world {
    he_mesh *m;
    he_delta *delta;
    he_draw_slots *slots;
    uint64_t revision;
    md_random r;
    bool taken[VERTICES];
    uint32_t face[FACES], begin[FACES], corners[FACES];
    int faces;
} world;

static void open_world(world *w, uint64_t seed)
{
    *w = (world){.revision = 1, .r = {seed}};
    w->m = he_mesh_new();
    w->delta = he_delta_new();
    assert_true(w->m != NULL && w->delta != NULL);
    for (int i = 0; i < VERTICES; i++) {
        double angle = 2 * acos(-1) * i / VERTICES;
        he_vertex v;
        assert_int_equal(he_vertex_add(w->m, (he_vec3){cos(angle), sin(angle), 0}, &v, NULL),
                         HE_OK);
    }
    assert_int_equal(he_draw_slots_new(w->m, 7, 1, &w->slots, NULL), HE_OK);
    he_mesh_record(w->m, w->delta);
}

static void close_world(world *w)
{
    he_draw_slots_free(w->slots);
    he_mesh_record(w->m, NULL);
    he_delta_free(w->delta);
    he_mesh_free(w->m);
}

static void add_face(world *w)
{
    uint32_t corners = md_chance(&w->r, 70) ? md_from(&w->r, 3, 12) : md_from(&w->r, 13, 250);
    uint32_t begin = md_below(&w->r, VERTICES - corners), ids[250];
    bool free_there = w->faces < FACES;
    for (uint32_t i = 0; i < corners; i++) {
        free_there = free_there && !w->taken[begin + i];
        ids[i] = begin + i;
    }
    if (!free_there) {
        return;
    }
    he_face face;
    he_ids edges = {0};
    assert_int_equal(he_face_add(w->m, ids, corners, &face, &edges, NULL), HE_OK);
    he_ids_clear(&edges);
    memset(w->taken + begin, true, corners * sizeof *w->taken);
    w->face[w->faces] = face.i;
    w->begin[w->faces] = begin;
    w->corners[w->faces++] = corners;
}

static void delete_face(world *w)
{
    if (w->faces == 0) {
        return;
    }
    uint32_t k = md_below(&w->r, (uint32_t)w->faces);
    assert_int_equal(he_face_delete(w->m, &w->face[k], 1, HE_KEEP_ISOLATED, NULL), HE_OK);
    memset(w->taken + w->begin[k], false, w->corners[k] * sizeof *w->taken);
    w->faces--;
    w->face[k] = w->face[w->faces];
    w->begin[k] = w->begin[w->faces];
    w->corners[k] = w->corners[w->faces];
}

static he_status advance(world *w, uint64_t most)
{
    he_touched touched = {0};
    he_status status = he_touched_add(&touched, w->m, w->delta, NULL);
    if (status == HE_OK) {
        status = he_draw_slots_advance(w->slots, w->m, &touched, w->revision + 1, most, NULL);
    }
    he_touched_clear(&touched);
    return status;
}

/* Requires that the triangles of each face fill slots next to each other, and that no other slot is
 * in use. */
static void check_slots(const world *w)
{
    const he_draw_slots *s = w->slots;
    uint32_t live = 0;
    assert_int_equal(s->faces, w->m->c.faces.issued);
    assert_int_equal(s->vertices, w->m->c.vertices.issued);
    for (uint32_t f = 0; f < s->faces; f++) {
        if (!he_face_is_live(w->m, (he_face){f})) {
            assert_true(s->first[f] == HE_NONE);
            continue;
        }
        uint32_t length = he_face_degree(w->m, (he_face){f}) - 2;
        for (uint32_t i = 0; i < length; i++) {
            assert_true(s->first[f] + i < s->count && s->owner[s->first[f] + i] == f);
        }
        live += length;
    }
    uint32_t owned = 0;
    for (uint32_t slot = 0; slot < s->count; slot++) {
        owned += (s->owner[slot] & HE_DRAW_SLOT_DEAD) == 0;
    }
    assert_int_equal(owned, live);
    assert_int_equal(s->dead, s->count - live);
}

static bool is_listed(const he_ids *list, uint32_t id)
{
    for (size_t i = 0; i < list->count; i++) {
        assert_true(i == 0 || list->ids[i - 1] < list->ids[i]);
        if (list->ids[i] == id) {
            return true;
        }
    }
    return false;
}

static uint32_t owner_of(const uint32_t *owner, uint32_t slot)
{
    return (owner[slot] & HE_DRAW_SLOT_DEAD) != 0 ? HE_NONE : owner[slot];
}

/* Requires that the list of changed slots contains each slot that belonged to another face in
 * `before`. If the list contains any slot of a face, it must also contain the first slot of this
 * face. */
static void check_changes(const world *w, const uint32_t *before, uint32_t count)
{
    he_ids vertices = {0}, slots = {0};
    const he_draw_slots *s = w->slots;
    he_status status = he_draw_slots_changed(s, w->revision, UINT64_MAX, &vertices, &slots, NULL);
    if (status != HE_UNSUPPORTED) {
        assert_int_equal(status, HE_OK);
        for (uint32_t slot = 0; slot < s->count; slot++) {
            uint32_t was = slot < count ? owner_of(before, slot) : HE_NONE;
            if (was != owner_of(s->owner, slot)) {
                assert_true(is_listed(&slots, slot));
            }
        }
        for (size_t i = 0; i < slots.count; i++) {
            uint32_t face = owner_of(s->owner, slots.ids[i]);
            if (face != HE_NONE) {
                assert_true(is_listed(&slots, s->first[face]));
            }
        }
    }
    he_ids_clear(&vertices);
    he_ids_clear(&slots);
}

static void each_face_keeps_its_slots_together_and_changes_are_listed(void **state)
{
    (void)state;
    uint32_t layouts = 0, reused = 0;
    world w;
    open_world(&w, seed_of_run());
    for (int round = 0; round < 4000; round++) {
        uint32_t count = w.slots->count, *before = malloc((count + 1) * sizeof *before);
        assert_non_null(before);
        if (count > 0) {
            memcpy(before, w.slots->owner, count * sizeof *before);
        }
        for (uint32_t n = md_from(&w.r, 1, 4); n > 0; n--) {
            if (md_chance(&w.r, 55)) {
                add_face(&w);
            } else {
                delete_face(&w);
            }
        }
        he_status status = advance(&w, UINT64_MAX);
        check_slots(&w);
        if (status == HE_UNSUPPORTED) {
            assert_true(w.slots->dead > w.slots->count / 2);
            he_draw_slots_free(w.slots);
            assert_int_equal(he_draw_slots_new(w.m, 7, w.revision + 1, &w.slots, NULL), HE_OK);
            assert_int_equal(w.slots->dead, 0);
            layouts++;
        } else {
            assert_int_equal(status, HE_OK);
            check_changes(&w, before, count);
            reused += w.slots->count == count && w.delta->count > 0;
        }
        w.revision++;
        he_delta_empty(w.delta);
        free(before);
    }
    assert_true(reused > 100);
    printf("note: %u layouts, %u steps within the slots there were\n", layouts, reused);
    close_world(&w);
}

static void an_advance_over_its_limit_leaves_the_slots_unchanged(void **state)
{
    (void)state;
    world w;
    open_world(&w, 3);
    while (w.faces < 10) {
        add_face(&w);
    }
    uint32_t count = w.slots->count;
    assert_int_equal(advance(&w, 20), HE_LIMIT);
    assert_true(w.slots->count == count && w.slots->revision == 1);
    assert_int_equal(advance(&w, UINT64_MAX), HE_OK);
    assert_true(w.slots->revision == 2);
    check_slots(&w);
    close_world(&w);
}

/* All positions are 0 at first, so a new vertex at the origin needs no change of its position. Even
 * so, the slots must report that the vertex lies outside the frame of the drawn coordinates. */
static void a_vertex_outside_the_frame_ends_the_layout(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012");
    for (uint32_t v = 0; v < 3; v++) {
        m->c.position[v].x += 1000;
    }
    he_draw_slots *slots;
    assert_int_equal(he_draw_slots_new(m, 1, 1, &slots, NULL), HE_OK);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    he_vertex v;
    assert_int_equal(he_vertex_add(m, (he_vec3){0, 0, 0}, &v, NULL), HE_OK);
    he_touched touched = {0};
    assert_int_equal(he_touched_add(&touched, m, delta, NULL), HE_OK);
    assert_int_equal(he_draw_slots_advance(slots, m, &touched, 2, UINT64_MAX, NULL),
                     HE_UNSUPPORTED);
    he_touched_clear(&touched);
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    he_draw_slots_free(slots);
    he_mesh_free(m);
}

/* The list of changes must have a limited length: the oldest changes are forgotten first. */
static void the_oldest_changes_are_forgotten_and_memory_stays_bounded(void **state)
{
    (void)state;
    world w;
    open_world(&w, 4);
    uint32_t vertex = 5;
    size_t most = 0;
    for (int i = 0; i < 3 * HE_DRAW_SLOT_CHANGES; i++) {
        he_vec3 by = {i % 2 == 0 ? 0.01 : -0.01, 0, 0};
        assert_int_equal(he_vertex_move(w.m, &vertex, 1, HE_MOVE_BY, &by, 1, NULL), HE_OK);
        assert_int_equal(advance(&w, UINT64_MAX), HE_OK);
        he_delta_empty(w.delta);
        w.revision++;
        most = w.slots->step_count > most ? w.slots->step_count : most;
    }
    assert_true(most <= VERTICES / 2 + HE_DRAW_SLOT_CHANGES);
    assert_true(w.slots->known > 1 && w.slots->known < w.revision - 1000);
    he_ids vertices = {0}, slots = {0};
    assert_int_equal(
        he_draw_slots_changed(w.slots, w.slots->known - 1, UINT64_MAX, &vertices, &slots, NULL),
        HE_UNSUPPORTED);
    assert_int_equal(
        he_draw_slots_changed(w.slots, w.slots->known, UINT64_MAX, &vertices, &slots, NULL), HE_OK);
    he_ids none = {0};
    assert_int_equal(he_draw_slots_changed(w.slots, w.slots->known, 1000, &none, &none, NULL),
                     HE_LIMIT);
    assert_true(vertices.count == 1 && vertices.ids[0] == vertex && slots.count == 0);
    he_ids_clear(&vertices);
    he_ids_clear(&slots);
    close_world(&w);
}

static void slots_without_memory_stay_as_they_were(void **state)
{
    (void)state;
    world w;
    open_world(&w, 5);
    while (w.faces < 20) {
        add_face(&w);
    }
    failing making = {.what = "making"};
    while (failing_next(&making)) {
        he_draw_slots *slots;
        if (failing_status(&making, he_draw_slots_new(w.m, 1, 1, &slots, NULL))) {
            he_draw_slots_free(slots);
        }
    }
    assert_true(making.n > 3);
    failing advancing = {.what = "advancing"};
    while (failing_next(&advancing)) {
        if (!failing_status(&advancing, advance(&w, UINT64_MAX))) {
            assert_true(w.slots->revision == 1 && w.slots->count == 0);
        }
    }
    assert_true(advancing.n > 5);
    check_slots(&w);
    close_world(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_face_keeps_its_slots_together_and_changes_are_listed),
        cmocka_unit_test(an_advance_over_its_limit_leaves_the_slots_unchanged),
        cmocka_unit_test(a_vertex_outside_the_frame_ends_the_layout),
        cmocka_unit_test(the_oldest_changes_are_forgotten_and_memory_stays_bounded),
        cmocka_unit_test(slots_without_memory_stay_as_they_were),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
