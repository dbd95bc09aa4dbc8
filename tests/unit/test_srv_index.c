/* Tests of the start of a store: it must compare the list of meshes with the indexes of the
 * database (sqlite_index.c), whatever the number of meshes. */
#include "tests/pace.h"
#include "tests/sanitized.h"
#include "tests/store_sql.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "journal/sqlite/sqlite_schema.h"

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

static bool starts(const char *where, char message[ST_SQLITE_MESSAGE])
{
    st_sqlite_opened out;
    const bool opened =
        st_sqlite_open(&(st_sqlite_options){.folder = where, .release = "test"}, &out);
    (void)snprintf(message, ST_SQLITE_MESSAGE, "%s", out.message);
    if (opened) {
        out.journal.close(out.journal.self);
    }
    return opened;
}

static void expect_start(const char *where)
{
    char message[ST_SQLITE_MESSAGE];
    if (!starts(where, message)) {
        fail_msg("%s", message);
    }
}

/* SQL that moves changed pages from the write-ahead log into the database file. It must run on the
 * connection that changed the pages, because a new connection may find that the schema is
 * damaged. */
#define CHECKPOINT "; PRAGMA wal_checkpoint(TRUNCATE)"

/* Makes a store whose list has this many meshes. The meshes have wrong checksums, but the start of
 * a store does not check them. */
static void make_store(size_t meshes)
{
    char text[1024];
    const st_progress progress = {.commits = 5, .position = 5, .meshes = meshes};
    expect_start(folder);
    (void)snprintf(
        text, sizeof text,
        "BEGIN; WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < %zu) "
        "INSERT INTO mesh(id, name, incarnation, origin, metadata, revision, record, chain, "
        "created, modified, vertices, edges, faces, boundary, bytes, base, damage, sum) "
        "SELECT 'needle-' || (i * 7919 %% 1000003), '', i * 7919 %% 1000003, 1, 1, 1, 1, 1, 1, 1, "
        "1, 1, 1, 1, 1, 1, '', 1 FROM n; "
        "UPDATE state SET commits = 5, position = 5, meshes = %zu, sum = %lu; COMMIT" CHECKPOINT,
        meshes, meshes, (unsigned long)st_progress_sum(&progress));
    store_sql_run(folder, text);
}

/* Finds the places in the database file where the table and its indexes store the id. At one place
 * after another, flips a bit of the id, and requires that the store then refuses to start. Returns
 * the number of places. */
static unsigned expect_refusals(const char *id)
{
    size_t size;
    unsigned places = 0;
    unsigned char *bytes = folder_read(folder, "hedge.db", &size);
    for (size_t at = 0; at + strlen(id) <= size; at++) {
        char message[ST_SQLITE_MESSAGE];
        if (memcmp(bytes + at, id, strlen(id)) != 0) {
            continue;
        }
        places++;
        bytes[at + 7] ^= 1;
        folder_write(folder, "hedge.db", bytes, size);
        assert_false(starts(folder, message));
        assert_non_null(strstr(message, "is damaged"));
        bytes[at + 7] ^= 1;
    }
    folder_write(folder, "hedge.db", bytes, size);
    free(bytes);
    return places;
}

static void an_index_that_has_lost_a_mesh_refuses_the_start(void **state)
{
    (void)state;
    make_store(1000);
    expect_start(folder);
    /* the table and four of its five indexes have the id */
    assert_true(expect_refusals("needle-79190") >= 5);
    expect_start(folder);
    /* In the schema of the database, one index of the table of meshes now has the first page of
     * another index. */
    store_sql_run(
        folder, "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET rootpage = (SELECT rootpage "
                "FROM sqlite_schema WHERE name = 'sqlite_autoindex_mesh_1') "
                "WHERE name = 'sqlite_autoindex_mesh_2'" CHECKPOINT);
    char message[ST_SQLITE_MESSAGE];
    assert_false(starts(folder, message));
    assert_non_null(strstr(message, "is damaged"));
}

static void many_meshes_are_no_reason_not_to_look(void **state)
{
    (void)state;
    /* SQLite is not instrumented, so a sanitizer would only watch how the file is searched. */
    enum { MANY = SANITIZED ? 21000 : 210000 };
    make_store(MANY);
    const double begun = pace_seconds();
    expect_start(folder);
    printf("note: the start of a store of %d meshes took %.2f s\n", MANY, pace_seconds() - begun);
    /* the table and four of its five indexes have the id */
    assert_true(expect_refusals("needle-79190") >= 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define STORE_TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        STORE_TEST(an_index_that_has_lost_a_mesh_refuses_the_start),
        STORE_TEST(many_meshes_are_no_reason_not_to_look),
#undef STORE_TEST
    };
    return cmocka_run_group_tests_name("index", tests, NULL, NULL);
}
