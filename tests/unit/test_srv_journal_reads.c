/* Tests of reading a mesh from the journal of a folder: how much memory it takes, what happens if
 * the mesh changes meanwhile, and that records of a newer release stay as they are. */
#include "tests/store_sql.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "journal/crc32c.h"
#include "journal/record_bytes.h"
#include "stored/stored.h"
#include "system/memory.h"

#include <sqlite3.h>

static char folder[FOLDER_PATH];
static he_mesh *content;

static int make_folder(void **state)
{
    (void)state;
    folder_make(folder);
    content = script_mesh("012", NULL);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    folder_remove(folder);
    he_mesh_free(content);
    return 0;
}

static kept_mesh mesh_as(const char *id)
{
    static uint64_t incarnations = 7000;
    kept_mesh mesh = {.name = "name", .content = content, .incarnation = ++incarnations};
    (void)snprintf(mesh.id, sizeof mesh.id, "%s", id);
    return mesh;
}

static sqlite3 *open_database(void)
{
    char path[2 * FOLDER_PATH];
    sqlite3 *db;
    (void)snprintf(path, sizeof path, "%s/hedge.db", folder);
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    return db;
}

/* --- memory --- */

/* Appends edits of `each` bytes, until they have `bytes` bytes together and are on the disk, then
 * reads all these edits. */
static void write_and_read(told_journal *told, kept_mesh *mesh, size_t bytes, size_t each)
{
    const st_journal *j = &told->journal;
    unsigned char *body = calloc(each, 1);
    uint64_t position = 0;
    for (size_t done = 0; done < bytes; done += each) {
        position = kept_append(j, kept_edit(mesh), mesh, body, each);
        assert_int_not_equal(position, 0);
        if (done % (64 * each) == 0) {
            told_wait(told, position); /* otherwise the queue would overflow */
        }
    }
    told_wait(told, position);
    free(body);
    st_reader *reader = NULL;
    st_card card;
    st_piece piece;
    assert_int_equal(j->open(j->self, mesh->id, &card, &reader), ST_OK);
    do {
        assert_int_equal(j->read(reader, &piece), ST_OK);
    } while (piece.kind != ST_PIECE_END);
    j->shut(reader);
}

/* Memory that SQLite allocates is never refused, even beyond the budget. If SQLite used much of a
 * small budget to cache the file, no memory would be left for meshes. */
static void sqlite_keeps_little_of_a_small_memory_budget(void **state)
{
    (void)state;
    enum { BUDGET = 16 << 20, WRITTEN = 12 << 20, EACH = 8 << 10 };
    told_journal told;
    kept_mesh mesh = mesh_as("m");
    st_memory_install(BUDGET);
    told_open(&told, folder);
    const uint64_t before = st_memory_used();
    assert_int_not_equal(kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0), 0);
    write_and_read(&told, &mesh, WRITTEN, EACH);
    const uint64_t kept = st_memory_used() - before;
    told_end(&told);
    he_mem_set_hook(NULL);
    print_message("note: %.0f KiB are kept of 12 MiB\n", (double)kept / 1024);
    assert_true(kept < BUDGET / 8);
}

/* --- meshes that change while they are read --- */

/* Opens a reader of a mesh, then changes the mesh: `change` is 0 for an edit, 1 for new mesh data,
 * 2 if the mesh is deleted and created again. Then reports that the reader has found damage, and
 * returns whether the mesh that now has the id counts as damaged. */
static bool is_condemned_after(int change, bool restarts)
{
    told_journal told;
    kept_mesh mesh = mesh_as("m"), anew = mesh_as("m");
    st_reader *reader = NULL;
    st_card card;
    told_open(&told, folder);
    const st_journal *j = &told.journal;
    kept_append(j, kept_content(&mesh), &mesh, NULL, 0);
    assert_int_equal(j->open(j->self, "m", &card, &reader), ST_OK);
    if (change == 0) {
        kept_append(j, kept_edit(&mesh), &mesh, "xyz", 3);
    } else if (change == 1) {
        kept_append(j, kept_content(&mesh), &mesh, NULL, 0);
    } else {
        kept_append(j, kept_remove(&mesh), &mesh, NULL, 0);
        kept_append(j, kept_content(&anew), &anew, NULL, 0);
    }
    assert_int_equal(j->open(j->self, "m", &card, NULL), ST_OK);
    j->condemn(reader, "it is none");
    j->shut(reader);
    if (restarts) {
        told_end(&told);
        told_open(&told, folder);
    }
    st_status status = j->open(j->self, "m", &card, NULL);
    assert_true(status == ST_OK || strcmp(card.damage, "it is none") == 0);
    told_end(&told);
    folder_remove(folder);
    folder_make(folder);
    return status == ST_DAMAGED;
}

static void a_mesh_made_anew_is_not_condemned_for_its_predecessor(void **state)
{
    (void)state;
    for (int restarts = 0; restarts < 2; restarts++) {
        assert_true(is_condemned_after(0, restarts != 0));
        assert_false(is_condemned_after(1, restarts != 0));
        assert_false(is_condemned_after(2, restarts != 0));
    }
}

/* Changes the version number of a record on the disk and corrects its checksum. */
static void set_version(unsigned char version)
{
    unsigned char bytes[256];
    sqlite3 *db = open_database();
    sqlite3_stmt *s;
    assert_int_equal(
        sqlite3_prepare_v2(db, "SELECT bytes FROM record WHERE number = 4", -1, &s, NULL),
        SQLITE_OK);
    assert_int_equal(sqlite3_step(s), SQLITE_ROW);
    const size_t size = (size_t)sqlite3_column_bytes(s, 0);
    assert_true(size <= sizeof bytes);
    memcpy(bytes, sqlite3_column_blob(s, 0), size);
    sqlite3_finalize(s);
    bytes[4] = version;
    const uint32_t sum = st_crc32c(0, bytes + 4, size - 4);
    memcpy(bytes, &sum, sizeof sum);
    assert_int_equal(
        sqlite3_prepare_v2(db, "UPDATE record SET bytes = ?1 WHERE number = 4", -1, &s, NULL),
        SQLITE_OK);
    assert_int_equal(sqlite3_bind_blob(s, 1, bytes, (int)size, SQLITE_STATIC), SQLITE_OK);
    assert_int_equal(sqlite3_step(s), SQLITE_DONE);
    sqlite3_finalize(s);
    sqlite3_close(db);
}

static char why[ST_DAMAGE];

static st_status read_to_end(void)
{
    told_journal told;
    st_reader *reader = NULL;
    st_piece piece = {.kind = ST_PIECE_BASE};
    st_card card;
    told_open(&told, folder);
    const st_journal *j = &told.journal;
    st_status status = j->open(j->self, "m", &card, &reader);
    while (status == ST_OK && piece.kind != ST_PIECE_END) {
        status = j->read(reader, &piece);
    }
    (void)snprintf(why, sizeof why, "%s", piece.why == NULL ? "" : piece.why);
    j->shut(reader);
    told_end(&told);
    return status;
}

static void a_record_of_a_newer_release_is_refused_with_both_versions(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = mesh_as("m");
    told_open(&told, folder);
    kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0);
    for (int i = 0; i < 5; i++) {
        kept_append(&told.journal, kept_edit(&mesh), &mesh, "xyz", 3);
    }
    told_end(&told);
    char newer[32];
    char newest[32];
    (void)snprintf(newer, sizeof newer, "version %d", ST_FRAME_VERSION + 1);
    (void)snprintf(newest, sizeof newest, "version %d", ST_FRAME_VERSION);
    set_version(ST_FRAME_VERSION + 1);
    assert_int_equal(read_to_end(), ST_NEWER);
    if (strstr(why, "record 4, byte") == NULL || strstr(why, newer) == NULL ||
        strstr(why, newest) == NULL) {
        fail_msg("\"%s\" does not name the record and both versions", why);
    }
    set_version(1);
    assert_int_equal(read_to_end(), ST_OK);
}

/* Mesh data was written to the disk as a new base (the record from which a mesh is loaded). Before
 * this base was used, a PUT replaced the data of the mesh: the unused base must be deleted. */
static void a_base_before_the_base_leaves_nothing(void **state)
{
    (void)state;
    told_journal told;
    kept_mesh mesh = mesh_as("m");
    st_stage *stage;
    told_open(&told, folder);
    const st_journal *j = &told.journal;
    kept_append(j, kept_content(&mesh), &mesh, NULL, 0);
    st_record facts = kept_edit(&mesh);
    kept_append(j, facts, &mesh, "xyz", 3);
    assert_int_equal(j->stage(j->self, content, &stage), ST_OK);
    st_record put = kept_content(&mesh);
    kept_append(j, put, &mesh, NULL, 0);
    facts.kind = ST_RECORD_CONTENT;
    j->rebase(j->self, stage, &facts, facts.revision);
    told_wait(&told, kept_append(j, kept_edit(&mesh), &mesh, "xyz", 3));
    told_end(&told);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM snapshot"), 0);
}

/* Reads the mesh "a". Requires that it has its base (the record with all mesh data), then record 2,
 * an edit whose parts have `bytes` bytes together, then record 3. */
static void expect_parts_of_edit(const st_journal *j, const unsigned char *bytes, size_t size)
{
    st_reader *reader = NULL;
    st_card card;
    st_piece piece;
    size_t read = 0;
    assert_int_equal(j->open(j->self, "a", &card, &reader), ST_OK);
    do {
        assert_int_equal(j->read(reader, &piece), ST_OK);
    } while (piece.kind != ST_PIECE_RECORD);
    assert_true(piece.record.staged_edit && piece.record.stage != NULL && piece.record.barrier);
    assert_null(piece.record.body);
    for (uint64_t parts = piece.parts; parts > 0; parts--) {
        assert_int_equal(j->read(reader, &piece), ST_OK);
        assert_int_equal(piece.kind, ST_PIECE_PART);
        assert_int_equal(piece.coding, HE_CODING_PLAIN);
        assert_true(piece.size <= size - read);
        assert_memory_equal(piece.bytes, bytes + read, piece.size);
        read += piece.size;
    }
    assert_int_equal(read, size);
    assert_int_equal(j->read(reader, &piece), ST_OK);
    assert_true(piece.kind == ST_PIECE_RECORD && piece.record.number == 3);
    assert_int_equal(j->read(reader, &piece), ST_OK);
    assert_int_equal(piece.kind, ST_PIECE_END);
    j->shut(reader);
}

static void a_staged_edit_comes_back_in_parts_and_is_no_base(void **state)
{
    (void)state;
    enum { SIZE = 3 * HE_STORED_PART + 17 };
    told_journal told;
    kept_mesh mesh = mesh_as("a");
    unsigned char *bytes = malloc(SIZE);
    st_stage *stage;
    assert_non_null(bytes);
    told_open(&told, folder);
    kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0);
    for (size_t i = 0; i < SIZE; i++) {
        bytes[i] = (unsigned char)(i * 7 / 5);
    }
    assert_int_equal(told.journal.stage_edit(told.journal.self, bytes, SIZE, &stage), ST_OK);
    st_record record = kept_edit(&mesh);
    record.stage = stage;
    record.body_size = SIZE;
    record.staged_edit = record.barrier = true;
    kept_append(&told.journal, record, &mesh, NULL, 0);
    told_wait(&told, kept_append(&told.journal, kept_edit(&mesh), &mesh, "x", 1));
    told_end(&told);
    told_open(&told, folder);
    expect_parts_of_edit(&told.journal, bytes, SIZE);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM part"), 4);
    /* After a PUT has replaced the mesh data, the parts of older records must be deleted. */
    kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0);
    store_sql_wait_for_purge(folder, &told);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM part"), 0);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM snapshot"), 0);
    told_end(&told);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define STORE_TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        STORE_TEST(sqlite_keeps_little_of_a_small_memory_budget),
        STORE_TEST(a_mesh_made_anew_is_not_condemned_for_its_predecessor),
        STORE_TEST(a_record_of_a_newer_release_is_refused_with_both_versions),
        STORE_TEST(a_base_before_the_base_leaves_nothing),
        STORE_TEST(a_staged_edit_comes_back_in_parts_and_is_no_base),
#undef STORE_TEST
    };
    return cmocka_run_group_tests_name("journal while it is read", tests, NULL, NULL);
}
