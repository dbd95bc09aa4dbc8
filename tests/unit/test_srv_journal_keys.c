/* Keys of requests in a folder: those of the last day come back, whole or not at all. */
#include "tests/store_folder.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

enum { DAY = 24 * 3600, MOST = 16 };

static char folder[FOLDER_PATH];
static he_mesh *content;
static told_journal told;

static void open_store(void)
{
    st_sqlite_opened out;
    const st_sqlite_options options = {.folder = folder, .release = "test"};
    assert_true(st_sqlite_open(&options, &out));
    told_begin(&told, &out.journal);
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
    char texts[MOST][32];
    st_kept_key keys[MOST];
    size_t count, most; /* none is taken beyond `most` */
} taken;

static bool take(void *context, const st_kept_key *key)
{
    taken *t = context;
    if (t->count == t->most) {
        return false;
    }
    snprintf(t->texts[t->count], sizeof t->texts[0], "%s", key->key.text);
    t->keys[t->count++] = *key;
    return true;
}

static taken keys_of(const char *id)
{
    taken t = {.most = MOST};
    assert_int_equal(told.journal.keys(told.journal.self, id, take, &t), ST_OK);
    return t;
}

static void append(kept_mesh *mesh, st_record record, const char *text, double time, bool of_store)
{
    const st_record_key key = {
        .text = text, .digest = {7, (uint64_t)time}, .time = time, .of_store = of_store};
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
    /* They go with their mesh, but what made it stays made. */
    told_wait(&told, kept_append(&told.journal, kept_remove(&a), &a, NULL, 0));
    assert_int_equal(keys_of("a").count, 0);
    assert_int_equal(keys_of(NULL).count, 2);
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
    /* Two rows went with it: that of the creation, and the oldest of the edits. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(keys_come_back_with_what_they_were_for, setup, teardown),
        cmocka_unit_test_setup_teardown(keys_older_than_a_day_go, setup, teardown),
        cmocka_unit_test_setup_teardown(without_memory_to_take_them_the_reading_ends, setup,
                                        teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
