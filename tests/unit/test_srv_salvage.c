/* Tests of what can be recovered from a store whose database file is damaged
 * (core/journal/sqlite/sqlite_salvage.c). */
#include "tests/kept_journal.h"
#include "tests/store_folder.h"
#include "tests/writing.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "journal/sqlite/sqlite_backup.h"
#include "store/store.h"
#include "tests/failing.h"

#include <unistd.h>

enum { MESHES = 300, PAGE = 4096 };

static char folder[FOLDER_PATH];

static int make_folder(void **state)
{
    (void)state;
    folder_make(folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    folder_remove(folder);
    return 0;
}

static st_store *store_over(const st_journal *journal)
{
    st_store *store = st_store_new(
        &(st_store_options){.undo_budget = UINT64_MAX, .max_meshes = MESHES, .journal = *journal});
    assert_non_null(store);
    return store;
}

static void move_vertex(st_mesh *mesh, unsigned to)
{
    char text[64];
    st_write w;
    (void)snprintf(text, sizeof text, "vertex_move vertex=1 to=%u,1,2", to);
    (void)script_run(writing_begin(mesh, &w), text, NULL, NULL);
    assert_true(writing_commit(&w, "vertex_move", NULL));
}

/* Makes a store of several meshes with several edits each, so that every table of the database
 * takes more than one page. */
static void make_store(void)
{
    st_sqlite_opened out;
    if (!st_sqlite_open(&(st_sqlite_options){.folder = folder, .release = "test"}, &out)) {
        fail_msg("%s", out.message);
    }
    st_store *store = store_over(&out.journal);
    for (unsigned i = 0; i < MESHES; i++) {
        char id[16];
        st_mesh *mesh;
        (void)snprintf(id, sizeof id, "mesh-%03u", i);
        assert_int_equal(
            st_create(store, id, "a name", script_mesh("012,023,034", NULL), NULL, &mesh), ST_OK);
        for (unsigned edit = 0; edit < 3; edit++) {
            move_vertex(mesh, edit + 5);
        }
        st_release(mesh);
    }
    st_store_free(store);
}

typedef struct found {
    unsigned faults, listed, whole, part, none;
} found;

static void count_fault(void *context, const char *what)
{
    found *f = context;
    f->faults++;
    assert_true(what[0] != '\0');
}

static void read_one(st_store *store, const st_card *card, found *f)
{
    st_mesh *mesh = NULL;
    st_mesh_info info;
    char damage[ST_DAMAGE];
    st_status status = st_salvage(store, card->id, &mesh, damage);
    f->listed++;
    if (status != ST_OK) {
        assert_true(status == ST_FAILED || status == ST_ABSENT || damage[0] != '\0');
        f->none++;
        return;
    }
    (void)st_read_begin(mesh, &info);
    st_read_end(mesh);
    const bool whole = damage[0] == '\0' && card->damage[0] == '\0';
    assert_true(!whole || info.revision == 4);
    f->whole += whole;
    f->part += !whole;
    st_release(mesh);
}

/* Recovers everything that can be read from the store. Returns false if the database file is
 * refused as a whole. */
static bool read_all(const char *file, found *f)
{
    st_sqlite_opened out;
    st_card cards[64];
    char after[ST_MESH_ID + 1] = "";
    size_t count = 64;
    *f = (found){.faults = 0};
    if (!st_sqlite_look(file, &out)) {
        assert_true(out.message[0] != '\0');
        return false;
    }
    const unsigned told = st_sqlite_faults(&out.journal, count_fault, f);
    assert_int_equal(told, f->faults);
    st_store *store = store_over(&out.journal);
    while (count == 64) {
        assert_int_equal(out.journal.list(out.journal.self, after, cards, 64, &count), ST_OK);
        for (size_t i = 0; i < count; i++) {
            read_one(store, &cards[i], f);
            memcpy(after, cards[i].id, sizeof after);
        }
    }
    st_store_free(store);
    return true;
}

/* The test overwrites each page of the database file in turn. Only what was on this page may be
 * lost; everything else must be recovered. */
static void a_damaged_page_costs_what_was_on_it(void **state)
{
    (void)state;
    char file[2 * FOLDER_PATH];
    size_t size;
    unsigned refused = 0, lists = 0, named = 0, least = MESHES;
    make_store();
    (void)snprintf(file, sizeof file, "%s/hedge.db", folder);
    unsigned char *bytes = folder_read(folder, "hedge.db", &size);
    found f;
    assert_true(read_all(file, &f));
    assert_true(f.faults == 0 && f.whole == MESHES && f.listed == MESHES);
    for (size_t page = 0; page < size / PAGE; page++) {
        unsigned char was[PAGE];
        memcpy(was, bytes + page * PAGE, PAGE);
        memset(bytes + page * PAGE, 0xaa, PAGE);
        folder_write(folder, "hedge.db", bytes, size);
        memcpy(bytes + page * PAGE, was, PAGE);
        if (!read_all(file, &f)) {
            refused++;
            continue;
        }
        /* If the overwritten page was in use, damage must be reported; if the page was free, all
         * meshes must be recovered. */
        assert_true(f.faults > 0 || f.whole == MESHES);
        named += f.faults > 0;
        if (f.listed < MESHES / 2) {
            lists++; /* all entries of the list of meshes are reached through the overwritten page
                      */
        } else if (f.whole + f.part >= MESHES / 2) {
            least = f.whole < least ? f.whole : least;
        } else {
            lists++; /* all records are reached through the overwritten page */
        }
    }
    printf("note: %zu pages: %u refused, %u named, %u led to all of a table; else %u of %d meshes "
           "at least are whole\n",
           size / PAGE, refused, named, lists, least, MESHES);
    assert_int_equal(refused, 1);
    /* There may be at most three pages through which a whole table is reached: the first page of
     * the table of meshes, the first page of the table of records, and one page below that. */
    assert_true(lists <= 3);
    assert_true(named + refused + 8 > size / PAGE);
    assert_true(least > MESHES / 2);
    free(bytes);
}

/* --- one mesh --- */

static kept_journal *make_damaged(size_t n, kept_damage how, size_t at)
{
    kept_journal *journal = kept_journal_new();
    const st_journal kept = kept_journal_open(journal);
    st_store *store = store_over(&kept);
    st_mesh *mesh;
    assert_int_equal(st_create(store, "m", "a name", script_mesh("012,023,034", NULL), NULL, &mesh),
                     ST_OK);
    for (unsigned i = 0; i < 8; i++) {
        move_vertex(mesh, i + 5);
    }
    st_release(mesh);
    st_store_free(store);
    kept_journal_damage(journal, "m", n, how, at);
    return journal;
}

static void a_damaged_mesh_is_read_up_to_the_damage(void **state)
{
    (void)state;
    static const kept_damage ways[] = {KEPT_CUT, KEPT_SUM, KEPT_TURNED};
    for (size_t way = 0; way < sizeof ways / sizeof *ways; way++) {
        for (unsigned n = 0; n < 8; n++) {
            kept_journal *journal = make_damaged(n, ways[way], 0);
            const st_journal kept = kept_journal_open(journal);
            st_store *store = store_over(&kept);
            st_mesh *mesh;
            st_mesh_info info;
            char damage[ST_DAMAGE], record[32];
            assert_int_equal(st_salvage(store, "m", &mesh, damage), ST_OK);
            (void)snprintf(record, sizeof record, "record %u", n + 2);
            assert_non_null(strstr(damage, record));
            const he_mesh *content = st_read_begin(mesh, &info);
            assert_int_equal(info.revision, n + 1);
            assert_string_equal(info.name, "a name");
            const double x = he_position(content, (he_vertex){1}).x;
            assert_true(n == 0 ? x < 5 : x == n + 4);
            st_read_end(mesh);
            st_release(mesh);
            st_store_free(store);
            kept_journal_free(journal);
        }
    }
}

static void what_a_newer_release_wrote_is_not_guessed(void **state)
{
    (void)state;
    kept_journal *journal = make_damaged(3, KEPT_NEWER, 0);
    const st_journal kept = kept_journal_open(journal);
    st_store *store = store_over(&kept);
    st_mesh *mesh = NULL;
    char damage[ST_DAMAGE];
    assert_int_equal(st_salvage(store, "m", &mesh, damage), ST_NEWER);
    assert_non_null(strstr(damage, "version 3"));
    assert_int_equal(st_salvage(store, "none", &mesh, damage), ST_ABSENT);
    assert_null(mesh);
    st_store_free(store);
    kept_journal_free(journal);
}

static void without_memory_nothing_is_said_of_a_mesh(void **state)
{
    (void)state;
    kept_journal *journal = make_damaged(4, KEPT_CUT, 0);
    const st_journal kept = kept_journal_open(journal);
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        failing_pause();
        st_store *store = store_over(&kept);
        st_mesh *mesh = NULL;
        char damage[ST_DAMAGE];
        failing_resume();
        st_status status = st_salvage(store, "m", &mesh, damage);
        assert_true(failing_end(&f, status == ST_OK) || (status == ST_NO_MEMORY && mesh == NULL));
        st_release(mesh);
        st_store_free(store);
    }
    kept_journal_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_damaged_page_costs_what_was_on_it, make_folder,
                                        remove_folder),
        cmocka_unit_test(a_damaged_mesh_is_read_up_to_the_damage),
        cmocka_unit_test(what_a_newer_release_wrote_is_not_guessed),
        cmocka_unit_test(without_memory_nothing_is_said_of_a_mesh),
    };
    return cmocka_run_group_tests_name("salvage", tests, NULL, NULL);
}
