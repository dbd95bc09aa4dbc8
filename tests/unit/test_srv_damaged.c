/* Tests of meshes that cannot be loaded from the journal. The store must name a damaged mesh, and
 * it must be possible to delete and to replace the mesh. A mesh that a newer release of hedge wrote
 * must not be changed. */
#include "tests/kept_journal.h"
#include "tests/model/random.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"
#include "tests/unit/kept_store.h"
#include "tests/writing.h"

#include "store/table.h"

static kept_journal *journal;

static st_store *open_store(void)
{
    return kept_store_open(journal, 1 << 20, NULL);
}

static void expect_damaged(st_store *store, const char *part)
{
    st_mesh *mesh = NULL;
    st_write w;
    assert_int_equal(st_load(store, "m", &mesh), ST_OK);
    if (strstr(st_damage(mesh), part) == NULL) {
        fail_msg("\"%s\" does not say \"%s\"", st_damage(mesh), part);
    }
    assert_true(kept_journal_facts(journal, "m").condemned);
    assert_int_equal(st_write_claim(mesh, NULL, &w), ST_DAMAGED);
    assert_non_null(writing_begin(mesh, &w));
    st_write_rename(&w, "no");
    assert_int_equal(st_write_commit(&w, NULL), ST_DAMAGED);
    st_card card;
    size_t count;
    assert_int_equal(st_cards(store, "", &card, 1, &count), ST_OK);
    assert_int_equal(count, 1);
    assert_string_equal(card.damage, st_damage(mesh));
    assert_true(card.counts.vertices > 0);
    st_release(mesh);
}

static void make_damaged(kept_damage how)
{
    journal = kept_journal_new();
    st_store *store = open_store();
    st_mesh *mesh = kept_store_make(store, "m");
    md_random random = {3};
    for (unsigned i = 0; i < 10; i++) {
        char move[64];
        st_write w;
        snprintf(move, sizeof move, "vertex_move vertex=%u to=%u,1,2", md_below(&random, 5), i);
        script_prepare(writing_begin(mesh, &w), move);
        assert_true(writing_commit(&w, "vertex_move", NULL));
    }
    st_release(mesh);
    st_store_free(store);
    kept_journal_damage(journal, "m", 4, how, how == KEPT_NEWER ? 0 : 5);
}

static void what_is_damaged_is_named(void **state)
{
    (void)state;
    static const char *const parts[] = {[KEPT_CUT] = "record 6, at its byte",
                                        [KEPT_TURNED] = "record 6",
                                        [KEPT_SUM] = "its sum is wrong"};
    for (int how = KEPT_CUT; how <= KEPT_SUM; how++) {
        make_damaged((kept_damage)how);
        for (int again = 0; again < 2; again++) {
            st_store *store = open_store();
            expect_damaged(store, parts[how]);
            expect_damaged(store, parts[how]);
            st_store_free(store);
        }
        kept_journal_free(journal);
    }
}

static void a_mesh_of_a_newer_release_is_named_and_left_as_it_is(void **state)
{
    (void)state;
    make_damaged(KEPT_NEWER);
    for (int again = 0; again < 2; again++) {
        st_store *store = open_store();
        st_mesh *mesh = NULL;
        st_write w;
        assert_int_equal(st_load(store, "m", &mesh), ST_OK);
        assert_int_equal(st_unreadable(mesh), ST_NEWER);
        assert_non_null(
            strstr(st_damage(mesh),
                   "the stored edit has version 3, but this release reads up to version 2"));
        assert_int_equal(st_write_claim(mesh, NULL, &w), ST_NEWER);
        assert_non_null(writing_begin(mesh, &w));
        st_write_rename(&w, "no");
        assert_int_equal(st_write_commit(&w, NULL), ST_NEWER);
        assert_false(kept_journal_facts(journal, "m").condemned);
        st_release(mesh);
        st_store_free(store);
    }
    /* The record again has a version that this release can read: the mesh must be readable
     * again. */
    kept_journal_damage(journal, "m", 4, KEPT_NEWER, 0);
    st_store *store = open_store();
    st_release(kept_store_load(store, "m"));
    st_store_free(store);
    kept_journal_free(journal);
}

static void a_damaged_mesh_can_be_removed(void **state)
{
    (void)state;
    st_mesh *mesh = NULL;
    make_damaged(KEPT_CUT);
    st_store *store = open_store();
    assert_int_equal(st_load(store, "m", &mesh), ST_OK);
    assert_int_equal(writing_remove(mesh), ST_OK);
    st_release(mesh);
    assert_int_equal(st_store_count(store), 0);
    assert_int_equal(st_load(store, "m", &mesh), ST_ABSENT);
    st_release(kept_store_make(store, "m"));
    st_store_free(store);
    kept_journal_free(journal);
}

static void a_damaged_mesh_can_be_replaced(void **state)
{
    (void)state;
    st_mesh *mesh = NULL, *fresh = NULL, *late = NULL;
    make_damaged(KEPT_SUM);
    st_store *store = open_store();
    assert_int_equal(st_load(store, "m", &mesh), ST_OK);
    he_mesh *content = fixture_mesh("012");
    kept_journal_refuse(journal, ST_FULL);
    assert_int_equal(st_create_over(store, mesh, "anew", content, NULL, &fresh), ST_FULL);
    kept_journal_refuse(journal, ST_OK);
    assert_int_equal(st_create_over(store, mesh, "anew", content, NULL, &fresh), ST_OK);
    content = fixture_mesh("012");
    assert_int_equal(st_create_over(store, mesh, "late", content, NULL, &late), ST_ABSENT);
    he_mesh_free(content);
    st_release(mesh);
    assert_int_equal(st_store_count(store), 1);
    assert_int_equal(st_find(store, "m", &mesh), ST_OK);
    assert_ptr_equal(mesh, fresh);
    st_release(mesh);
    st_store *other = open_store();
    mesh = kept_store_load(other, "m");
    kept_store_expect_same(fresh, mesh);
    st_release(mesh);
    st_release(fresh);
    st_store_free(other);
    st_store_free(store);
    kept_journal_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_damaged_is_named),
        cmocka_unit_test(a_mesh_of_a_newer_release_is_named_and_left_as_it_is),
        cmocka_unit_test(a_damaged_mesh_can_be_removed),
        cmocka_unit_test(a_damaged_mesh_can_be_replaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
