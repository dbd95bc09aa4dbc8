/* Tests of the records that the store gives to the journal: a mesh must be restorable from its
 * records alone. */
#include "tests/slow_journal.h"
#include "tests/unit/dense.h"
#include "tests/writing.h"

#include "edit/local/poke.h"
#include "mesh/compact.h"
#include "store/publish/limits.h"
#include "stored/stored.h"
#include "tests/failing.h"

enum { BUDGET = 1 << 20 };

static slow_journal journal;
static st_store *store;
static st_mesh *mesh;

static void open_store(uint64_t budget)
{
    store = st_store_new(&(st_store_options){
        .undo_budget = budget, .max_meshes = 4, .journal = slow_journal_open_keeping(&journal)});
    assert_non_null(store);
}

static int setup(void **state)
{
    (void)state;
    open_store(BUDGET);
    st_key key = {.text = "a-key", .digest = {5, 6}};
    st_keyed *keyed;
    assert_int_equal(st_keyed_begin(store, NULL, &key, &keyed), ST_KEYED_NEW);
    assert_int_equal(
        st_create(store, "m", "first", fixture_mesh("012,023"), &(st_cause){.keyed = keyed}, &mesh),
        ST_OK);
    assert_string_equal(journal.record.key->text, "a-key");
    assert_int_equal(journal.record.key->digest[1], 6);
    assert_true(journal.record.key->of_store && journal.record.key->time > 0);
    st_keyed_end(keyed);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    st_release(mesh);
    assert_int_equal(journal.out, 0);
    st_store_free(store);
    return 0;
}

static he_mesh *copy_of_content(void)
{
    he_mesh *copy = NULL;
    assert_int_equal(he_mesh_copy(st_read_begin(mesh, NULL), &copy, NULL), HE_OK);
    st_read_end(mesh);
    return copy;
}

/* Requires that the newest record has these properties, and that it names the present name,
 * revision and counts of the mesh. Returns the record. */
static const st_record *expect(st_record_kind kind, bool barrier, const char *ops, uint64_t inverts)
{
    const st_record *r = &journal.record;
    st_mesh_info info;
    const he_mesh *content = st_read_begin(mesh, &info);
    assert_int_equal(r->kind, kind);
    assert_true(r->barrier == barrier);
    assert_string_equal(r->ops, ops);
    assert_int_equal(r->inverts, inverts);
    assert_string_equal(r->id, info.id);
    assert_string_equal(r->name, info.name);
    assert_true(r->incarnation == info.incarnation);
    assert_true(r->number == info.record && r->revision == info.revision);
    assert_true(r->metadata == info.metadata);
    assert_true(r->created == info.created && r->time == info.modified);
    for (int k = 0; k < HE_KIND_COUNT; k++) {
        assert_int_equal(r->issued[k], he_mesh_issued(content, (he_kind)k));
    }
    assert_int_equal(r->counts.vertices, he_mesh_vertices(content));
    assert_int_equal(r->counts.edges, he_mesh_edges(content));
    assert_int_equal(r->counts.faces, he_mesh_faces(content));
    assert_int_equal(r->counts.boundary, he_mesh_boundary_halfedges(content));
    assert_true(r->bytes == he_mesh_bytes(content));
    assert_true(r->body == NULL || (r->body == journal.room->bytes && r->body_size > 0 &&
                                    r->body_size <= journal.room->size));
    st_read_end(mesh);
    return r;
}

/* Requires that the newest record is an edit, and that its body transforms `before` into the
 * present state of the mesh. */
static void expect_edit(he_mesh *before, bool barrier, const char *ops)
{
    const st_record *r = expect(ST_RECORD_EDIT, barrier, ops, 0);
    he_delta *delta = NULL;
    assert_int_equal(he_stored_edit_forward(r->body, r->body_size, r->issued, before, &delta, NULL),
                     HE_OK);
    assert_true(he_mesh_equal(before, st_read_begin(mesh, NULL)));
    st_read_end(mesh);
    he_delta_free(delta);
    he_mesh_free(before);
}

static void expect_content(bool renamed)
{
    const st_record *r = &journal.record;
    he_mesh *content = NULL;
    if (!renamed) {
        (void)expect(ST_RECORD_CONTENT, true, "", 0);
    }
    assert_int_equal(r->kind, ST_RECORD_CONTENT);
    assert_int_equal(he_stored_content_read(r->body, r->body_size, &content, NULL), HE_OK);
    assert_true(he_mesh_equal(content, st_read_begin(mesh, NULL)));
    st_read_end(mesh);
    he_mesh_free(content);
}

static void poke(uint32_t face)
{
    st_write w;
    he_vertex made;
    he_mesh *content = writing_begin(mesh, &w);
    assert_non_null(content);
    assert_int_equal(he_face_poke(content, (he_face){face}, NULL, &made, NULL, NULL, NULL), HE_OK);
    assert_true(writing_commit(&w, "face_poke", NULL));
}

static void a_mesh_can_be_made_again_from_its_records(void **state)
{
    (void)state;
    expect_content(false);
    assert_null(journal.record.stage);

    he_mesh *before = copy_of_content();
    poke(0);
    expect_edit(before, false, "face_poke");
    assert_true(journal.record.tally.known);
    assert_int_equal(journal.record.tally.created[0], 1);
    poke(1);

    /* Two edits are undone and redone; each step must be a separate record. */
    assert_int_equal(writing_step(mesh, ST_UNDO, 1), ST_OK);
    assert_null(expect(ST_RECORD_UNDO, false, "", 3)->body);
    assert_int_equal(writing_step(mesh, ST_REDO, 1), ST_OK);
    assert_null(expect(ST_RECORD_REDO, false, "", 3)->body);
    assert_int_equal(journal.newest, 5);
    assert_int_equal(writing_step(mesh, ST_UNDO, 2), ST_OK);
    assert_int_equal(journal.newest, 7);
    assert_int_equal(journal.groups, 6);
    assert_int_equal(journal.record.inverts, 3);
    assert_int_equal(journal.record.revision, 6);

    before = copy_of_content();
    st_write w;
    he_mesh *content = writing_begin(mesh, &w);
    assert_int_equal(he_compact(content, NULL, NULL), HE_OK);
    assert_true(writing_commit(&w, "compact", NULL));
    expect_edit(before, true, "compact");

    assert_int_equal(writing_replace(mesh, fixture_mesh("0123"), "second", NULL), ST_OK);
    expect_content(true);
    assert_string_equal(journal.record.name, "second");
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    st_write_rename(&w, "third");
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    assert_null(expect(ST_RECORD_RENAME, false, "", 0)->body);
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    assert_int_equal(st_write_moment(&w, w.info.revision, "now"), ST_OK);
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    assert_null(expect(ST_RECORD_MOMENT, false, "", 0)->body);
    assert_int_equal(journal.record.named, journal.record.revision);
    assert_int_equal(writing_remove(mesh), ST_OK);
    assert_null(expect(ST_RECORD_REMOVE, false, "", 0)->body);
}

/* If an edit is too large for the undo history, its record must say so, so that no later start
 * offers to undo the edit. */
static void an_edit_beyond_the_undo_budget_says_so(void **state)
{
    (void)state;
    (void)teardown(NULL);
    open_store(1);
    assert_int_equal(st_create(store, "m", NULL, fixture_mesh("012,023"), NULL, &mesh), ST_OK);
    he_mesh *before = copy_of_content();
    poke(0);
    expect_edit(before, true, "face_poke");
}

/* --- large mesh data, which is written to the disk before its record --- */

static he_mesh *large(void)
{
    he_mesh *made = dense_grid(120, NULL, 1);
    assert_true(he_stored_content_bound(made) > ST_BODY_BYTES);
    return made;
}

static void make_large(void)
{
    he_mesh *made = large();
    st_stage *stage = NULL;
    st_write w;
    assert_int_equal(st_store_stage(store, made, &stage), ST_OK);
    assert_non_null(stage);
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    st_write_replace(&w, made, stage);
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
}

static void expect_staged(st_record_kind kind, bool barrier, const char *ops)
{
    assert_null(expect(kind, barrier, ops, 0)->body);
    assert_non_null(slow_journal_staged(&journal));
    assert_true(he_mesh_equal(slow_journal_staged(&journal), st_read_begin(mesh, NULL)));
    st_read_end(mesh);
    assert_int_equal(journal.out, 0);
}

static void claim(st_write *w)
{
    assert_int_equal(st_write_claim(mesh, NULL, w), ST_OK);
    assert_int_equal(st_write_copy(w, NULL, NULL), HE_OK);
}

static void compact_claimed(st_write *w)
{
    claim(w);
    assert_int_equal(he_compact(w->content, NULL, NULL), HE_OK);
    assert_int_equal(st_write_changes(w, NULL), HE_OK);
}

static void a_large_content_is_staged(void **state)
{
    (void)state;
    st_write w;
    make_large();
    expect_staged(ST_RECORD_CONTENT, true, "");
    compact_claimed(&w);
    assert_int_equal(st_write_commit(&w, "compact"), ST_OK);
    expect_staged(ST_RECORD_EDIT, true, "compact");
    /* A large edit that does not replace the mesh data must be encoded without holding the lock of
     * the mesh. */
    claim(&w);
    assert_int_equal(he_face_poke(w.content, (he_face){0}, NULL, NULL, NULL, NULL, NULL), HE_OK);
    he_mesh *before = copy_of_content();
    assert_int_equal(st_write_changes(&w, NULL), HE_OK);
    assert_int_equal(st_write_commit(&w, "face_poke"), ST_OK);
    expect_edit(before, false, "face_poke");

    st_mesh *made = NULL;
    assert_int_equal(st_create(store, "n", NULL, large(), NULL, &made), ST_OK);
    assert_non_null(slow_journal_staged(&journal));
    /* The id that the new mesh should get is in use. The mesh data that was already written to the
     * disk for the new mesh must be released. */
    he_mesh *again = large();
    assert_int_equal(st_create(store, "n", NULL, again, NULL, &made), ST_TAKEN);
    assert_int_equal(journal.out, 0);
    he_mesh_free(again);
    st_release(made);
}

static void a_refused_stage_changes_nothing(void **state)
{
    (void)state;
    make_large();
    st_write w;
    st_mesh *made = NULL;
    st_stage *stage = NULL;
    he_mesh *before = copy_of_content(), *other = large();
    uint64_t groups = journal.groups;
    compact_claimed(&w);
    journal.refuse = ST_FULL;
    assert_int_equal(st_write_commit(&w, "compact"), ST_FULL);
    assert_int_equal(st_create(store, "n", NULL, other, NULL, &made), ST_FULL);
    assert_int_equal(st_store_stage(store, other, &stage), ST_FULL);
    assert_null(stage);
    journal.refuse = ST_OK;
    assert_true(journal.groups == groups);
    assert_true(he_mesh_equal(before, st_read_begin(mesh, NULL)));
    st_read_end(mesh);
    /* The commit was refused, but it ended the long edit, so another long edit can begin. */
    compact_claimed(&w);
    /* If the mesh is deleted during a long edit, the mesh data that the edit has written to the
     * disk must be released. */
    assert_int_equal(writing_remove(mesh), ST_OK);
    assert_int_equal(st_write_commit(&w, "compact"), ST_ABSENT);
    assert_int_equal(journal.out, 0);
    he_mesh_free(before);
    he_mesh_free(other);
}

/* Each allocation during a long edit fails in turn, including the allocations of the journal: the
 * edit must be refused, and nothing may change. */
static void every_allocation_of_a_claim_may_fail(void **state)
{
    (void)state;
    make_large();
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        failing_pause();
        he_mesh *before = copy_of_content();
        st_write w;
        compact_claimed(&w);
        failing_resume();
        st_status status = st_write_commit(&w, "compact");
        assert_true(status == ST_OK || (status == ST_NO_MEMORY && f.n < 100));
        if (!failing_end(&f, status == ST_OK)) {
            assert_true(he_mesh_equal(before, st_read_begin(mesh, NULL)));
            st_read_end(mesh);
        }
        assert_int_equal(journal.out, 0);
        assert_true(status != ST_OK || f.n > 2);
        he_mesh_free(before);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_mesh_can_be_made_again_from_its_records, setup, teardown),
        cmocka_unit_test_setup_teardown(an_edit_beyond_the_undo_budget_says_so, setup, teardown),
        cmocka_unit_test_setup_teardown(a_large_content_is_staged, setup, teardown),
        cmocka_unit_test_setup_teardown(a_refused_stage_changes_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(every_allocation_of_a_claim_may_fail, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
