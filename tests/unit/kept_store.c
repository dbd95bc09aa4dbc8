#include "tests/unit/kept_store.h"

#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"

st_store *kept_store_open(kept_journal *journal, uint64_t budget, st_pool *pool)
{
    st_store *store = st_store_new(&(st_store_options){.undo_budget = budget,
                                                       .max_meshes = 1000,
                                                       .journal = kept_journal_open(journal),
                                                       .pool = pool,
                                                       .base_bytes = 1});
    assert_non_null(store);
    return store;
}

st_mesh *kept_store_load(st_store *store, const char *id)
{
    st_mesh *mesh = NULL;
    assert_int_equal(st_find(store, id, &mesh), ST_COLD);
    st_status status = st_load(store, id, &mesh);
    if (status != ST_OK || st_damage(mesh)[0] != '\0') {
        fail_msg("loading is %d: %s", status, status == ST_OK ? st_damage(mesh) : "");
    }
    return mesh;
}

st_mesh *kept_store_make(st_store *store, const char *id)
{
    st_mesh *mesh;
    he_mesh *content = script_mesh("012,023,034,045,051", NULL);
    script_add_columns(content);
    assert_int_equal(st_create(store, id, "as made", content, NULL, &mesh), ST_OK);
    return mesh;
}

static void expect_entries(st_mesh *was, st_mesh *is)
{
    st_history a, b;
    st_entry x, y;
    size_t i = 0;
    st_history_reach(was, &a);
    st_history_reach(is, &b);
    assert_int_equal(a.oldest, b.oldest);
    assert_int_equal(a.dropped, b.dropped);
    while (st_history_entry(was, i, &x)) {
        assert_true(st_history_entry(is, i, &y));
        assert_int_equal(x.revision, y.revision);
        assert_int_equal(x.inverts, y.inverts);
        assert_int_equal(x.action, y.action);
        assert_string_equal(x.ops, y.ops);
        assert_string_equal(x.name, y.name);
        assert_int_equal(x.state, y.state);
        assert_int_equal(x.undoable, y.undoable);
        assert_true(x.time == y.time);
        assert_memory_equal(&x.tally, &y.tally, sizeof x.tally);
        i++;
    }
    assert_false(st_history_entry(is, i, &y));
}

void kept_store_expect_same(st_mesh *was, st_mesh *is)
{
    st_mesh_info a, b;
    const he_mesh *m = st_read_begin(was, &a), *n = st_read_begin(is, &b);
    assert_true(he_mesh_equal(m, n));
    assert_string_equal(a.id, b.id);
    assert_string_equal(a.name, b.name);
    assert_int_equal(a.incarnation, b.incarnation);
    assert_int_equal(a.metadata, b.metadata);
    assert_int_equal(a.revision, b.revision);
    assert_int_equal(a.record, b.record);
    assert_true(a.created == b.created && a.modified == b.modified);
    assert_int_equal(a.undo, b.undo);
    assert_int_equal(a.redo, b.redo);
    expect_entries(was, is);
    st_read_end(was);
    st_read_end(is);
}
