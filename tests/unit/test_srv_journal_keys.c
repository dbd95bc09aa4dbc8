/* Tests of Idempotency-Keys in the journal of a folder: a start must restore either all keys of the
 * last 24 hours or none of them. */
#include "tests/store_sql.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

enum { DAY = 24 * 3600, MOST = 16 };

static char folder[FOLDER_PATH];
static he_mesh *content;
static told_journal told;

static void open_with(uint64_t keys)
{
    st_sqlite_opened out;
    const st_sqlite_options options = {.folder = folder, .release = "test", .keys = keys};
    assert_true(st_sqlite_open(&options, &out));
    told_begin(&told, &out.journal);
}

static void open_store(void)
{
    open_with(0);
}

static int setup(void **state)
{
    (void)state;
    folder_make(folder);
    content = script_mesh("012,023,034", NULL);
    open_store();
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    told_end(&told);
    folder_remove(folder);
    he_mesh_free(content);
    return 0;
}

typedef struct taken {
    char texts[MOST][32], holders[MOST][32];
    st_kept_key keys[MOST];
    size_t count, most; /* `most`: the number of keys that `take` accepts */
} taken;

static bool take(void *context, const st_kept_key *key)
{
    taken *t = context;
    if (t->count == t->most) {
        return false;
    }
    snprintf(t->texts[t->count], sizeof t->texts[0], "%s", key->key.text);
    snprintf(t->holders[t->count], sizeof t->holders[0], "%s", key->key.holder);
    t->keys[t->count++] = *key;
    return true;
}

static taken keys_of(const char *id)
{
    taken t = {.most = MOST};
    assert_int_equal(told.journal.keys(told.journal.self, id, take, &t), ST_OK);
    return t;
}

static const char *holder = NULL; /* name of the token that sends the next requests */

static void append(kept_mesh *mesh, st_record record, const char *text, double time, bool of_store)
{
    const st_record_key key = {.text = text,
                               .digest = {7, (uint64_t)time},
                               .time = time,
                               .of_store = of_store,
                               .holder = holder};
    record.key = &key;
    record.time = time;
    uint64_t position = kept_append(&told.journal, record, mesh, record.number == 1 ? NULL : "x",
                                    record.number == 1 ? 0 : 1);
    assert_true(position > 0);
    told_wait(&told, position);
}

static void keys_come_back_with_what_they_were_for(void **state)
{
    (void)state;
    kept_mesh a = {.id = "a", .name = "", .content = content, .incarnation = 11};
    kept_mesh b = {.id = "b", .name = "", .content = content, .incarnation = 12};
    append(&a, kept_content(&a), "makes-a", 100, true);
    append(&b, kept_content(&b), "makes-b", 101, true);
    append(&a, kept_edit(&a), "first", 102, false);
    append(&a, kept_edit(&a), "second", 103, false);
    for (int again = 0; again < 2; again++) {
        taken of_store = keys_of(NULL), of_a = keys_of("a");
        assert_int_equal(of_store.count, 2);
        assert_string_equal(of_store.texts[0], "makes-a");
        assert_true(of_store.keys[0].key.of_store && of_store.keys[0].incarnation == 11);
        assert_string_equal(of_store.texts[1], "makes-b");
        assert_int_equal(of_a.count, 2);
        assert_string_equal(of_a.texts[0], "first");
        assert_string_equal(of_a.texts[1], "second");
        assert_true(of_a.keys[1].revision == 3 && !of_a.keys[1].key.of_store);
        assert_true(of_a.keys[1].key.digest[0] == 7 && of_a.keys[1].key.digest[1] == 103);
        assert_int_equal(keys_of("b").count, 0);
        assert_int_equal(keys_of("none").count, 0);
        told_end(&told);
        open_store();
    }
    /* When a mesh is deleted, its keys must be deleted, too, except the key of the request that
     * created the mesh. */
    told_wait(&told, kept_append(&told.journal, kept_remove(&a), &a, NULL, 0));
    assert_int_equal(keys_of("a").count, 0);
    assert_int_equal(keys_of(NULL).count, 2);
}

static void keys_of_one_text_are_those_of_their_holders(void **state)
{
    (void)state;
    static const char *const holders[] = {NULL, "alice", "bob"};
    kept_mesh a = {.id = "a", .name = "", .content = content, .incarnation = 11};
    append(&a, kept_content(&a), "makes-a", 100, true);
    for (size_t i = 0; i < 3; i++) {
        holder = holders[i];
        append(&a, kept_edit(&a), "same", 101 + (double)i, false);
    }
    holder = NULL;
    for (int again = 0; again < 2; again++) {
        taken of_a = keys_of("a");
        assert_int_equal(of_a.count, 3);
        for (size_t i = 0; i < 3; i++) {
            assert_string_equal(of_a.texts[i], "same");
            assert_string_equal(of_a.holders[i], i == 0 ? "" : holders[i]);
        }
        told_end(&told);
        open_store();
    }
}

static void keys_older_than_a_day_go(void **state)
{
    (void)state;
    kept_mesh a = {.id = "a", .name = "", .content = content, .incarnation = 11};
    append(&a, kept_content(&a), "makes", 100, true);
    for (int i = 0; i < 6; i++) {
        char text[16];
        snprintf(text, sizeof text, "old-%d", i);
        append(&a, kept_edit(&a), text, 101 + i, false);
    }
    append(&a, kept_edit(&a), "new", 200 + DAY, false);
    taken t = keys_of("a");
    assert_int_equal(t.count, 1);
    assert_string_equal(t.texts[0], "new");
    /* When the newest key was appended, the two oldest keys were deleted: the key of the creation,
     * and the oldest key of an edit. */
    assert_int_equal(keys_of(NULL).count, 0);
}

static void without_memory_to_take_them_the_reading_ends(void **state)
{
    (void)state;
    kept_mesh a = {.id = "a", .name = "", .content = content, .incarnation = 11};
    append(&a, kept_content(&a), "makes", 100, true);
    append(&a, kept_edit(&a), "one", 101, false);
    append(&a, kept_edit(&a), "two", 102, false);
    taken t = {.most = 1};
    assert_int_equal(told.journal.keys(told.journal.self, "a", take, &t), ST_NO_MEMORY);
    assert_int_equal(t.count, 1);
    assert_int_equal(keys_of("a").count, 2);
}

static int64_t rows(void)
{
    return store_sql_number(folder, "SELECT count(*) FROM kept");
}

/* Appends the key of a request that changed nothing, so no record of a change has this key. */
static uint64_t note(const kept_mesh *mesh, const char *text, double time)
{
    const st_kept_key kept = {.key = {.text = text, .digest = {7, (uint64_t)time}, .time = time},
                              .id = mesh->id,
                              .incarnation = mesh->incarnation,
                              .revision = mesh->revision,
                              .metadata = mesh->metadata};
    uint64_t position = 0;
    st_status status;
    do {
        status = told.journal.note(told.journal.self, &(st_note){.kept = &kept}, &position);
    } while (status == ST_BEHIND);
    assert_int_equal(status, ST_OK);
    return position;
}

static void a_key_of_a_request_that_changed_nothing_is_kept(void **state)
{
    (void)state;
    kept_mesh a = {.id = "a", .name = "", .content = content, .incarnation = 11};
    append(&a, kept_content(&a), "makes", 100, true);
    told_wait(&told, note(&a, "nothing", 101));
    append(&a, kept_edit(&a), "edit", 102, false);
    kept_mesh gone = {.id = "gone", .name = "", .content = content, .incarnation = 12};
    told_wait(&told, note(&gone, "of none", 103));
    for (int again = 0; again < 2; again++) {
        taken t = keys_of("a");
        assert_int_equal(t.count, 2);
        assert_string_equal(t.texts[0], "nothing");
        assert_true(t.keys[0].revision == 1 && !t.keys[0].key.of_store);
        assert_string_equal(t.texts[1], "edit");
        assert_int_equal(rows(), 3);
        told_end(&told);
        open_store();
    }
}

static bool count_key(void *context, const st_kept_key *key)
{
    uint64_t *at = context;
    assert_true(key->key.digest[1] > at[1]); /* keys must come in the order of their times */
    at[1] = key->key.digest[1];
    at[0]++;
    return true;
}

/* A damaged key must be reported: otherwise a repeated request with this key might silently be
 * executed again. */
static void a_damaged_key_is_told(void **state)
{
    (void)state;
    st_health health = {.status = ST_OK};
    kept_mesh a = {.id = "a", .name = "", .content = content, .incarnation = 11};
    append(&a, kept_content(&a), "makes", 100, true);
    append(&a, kept_edit(&a), "first", 102, false);
    append(&a, kept_edit(&a), "second", 103, false);
    told_end(&told);
    store_sql_run(folder, "UPDATE kept SET revision = revision + 1 WHERE text = 'second'");
    open_store();
    told.journal.health(told.journal.self, &health);
    assert_int_equal(health.damaged_keys, 1);
    taken t = keys_of("a");
    assert_int_equal(t.count, 2);
    assert_true(!t.keys[0].is_damaged && t.keys[1].is_damaged);
    assert_string_equal(t.texts[1], "second");
}

static void of_one_mesh_the_newest_are_kept(void **state)
{
    (void)state;
    enum { KEYS = ST_KEPT_KEYS + 3000, SLACK = 1000 };
    kept_mesh a = {.id = "a", .name = "", .content = content, .incarnation = 11};
    append(&a, kept_content(&a), "makes", 100, true);
    uint64_t last = 0, counts[2] = {0, 0};
    for (int i = 0; i < KEYS; i++) {
        char text[32];
        snprintf(text, sizeof text, "key-%d", i);
        last = note(&a, text, 1000 + i);
    }
    told_wait(&told, last);
    assert_true(rows() <= ST_KEPT_KEYS + SLACK);
    assert_int_equal(told.journal.keys(told.journal.self, "a", count_key, counts), ST_OK);
    assert_int_equal(counts[0], ST_KEPT_KEYS);
    assert_int_equal(counts[1], 1000 + KEYS - 1);
    assert_int_equal(keys_of(NULL).count, 1);
}

static void of_all_meshes_the_newest_are_kept(void **state)
{
    (void)state;
    enum { MESHES = 20, MOST_KEYS = 10 };
    told_end(&told);
    open_with(MOST_KEYS);
    for (int i = 0; i < MESHES; i++) {
        kept_mesh a = {.name = "", .content = content, .incarnation = 11 + (uint64_t)i};
        snprintf(a.id, sizeof a.id, "m%d", i);
        append(&a, kept_content(&a), a.id, 100 + i, true);
        if (i == MESHES / 2) { /* after a restart, the journal counts the keys again */
            told_end(&told);
            open_with(MOST_KEYS);
        }
    }
    taken t = keys_of(NULL);
    assert_in_range(t.count, MOST_KEYS - 1, MOST_KEYS);
    assert_string_equal(t.texts[t.count - 1], "m19");
    assert_int_equal(rows(), (int64_t)t.count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(keys_come_back_with_what_they_were_for, setup, teardown),
        cmocka_unit_test_setup_teardown(keys_of_one_text_are_those_of_their_holders, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(keys_older_than_a_day_go, setup, teardown),
        cmocka_unit_test_setup_teardown(a_key_of_a_request_that_changed_nothing_is_kept, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(a_damaged_key_is_told, setup, teardown),
        cmocka_unit_test_setup_teardown(of_one_mesh_the_newest_are_kept, setup, teardown),
        cmocka_unit_test_setup_teardown(of_all_meshes_the_newest_are_kept, setup, teardown),
        cmocka_unit_test_setup_teardown(without_memory_to_take_them_the_reading_ends, setup,
                                        teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
