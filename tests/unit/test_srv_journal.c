/* Tests of the journal in a folder (core/journal/sqlite) without a store: all records that were
 * appended must be there after a restart, and an error must say what is damaged. */
#include "tests/store_sql.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "stored/stored.h"
#include "model/random.h"
#include "tests/seed.h"

#include <unistd.h>

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

static st_sqlite_opened opened;

static void open_in(told_journal *told, const char *where)
{
    if (!st_sqlite_open(&(st_sqlite_options){.folder = where, .release = "test"}, &opened)) {
        fail_msg("%s", opened.message);
    }
    told_begin(told, &opened.journal);
}

static void open_store(told_journal *told)
{
    open_in(told, folder);
}

/* --- meshes --- */

static kept_mesh mesh_as(const char *id, const he_mesh *content)
{
    static uint64_t incarnations = 1000;
    kept_mesh mesh = {.content = content, .incarnation = ++incarnations};
    (void)snprintf(mesh.id, sizeof mesh.id, "%s", id);
    (void)snprintf(mesh.name, sizeof mesh.name, "name of %s", id);
    return mesh;
}

/* The result of loading a mesh: its base (the record with all mesh data, from which the mesh is
 * loaded), and how many records of each kind follow the base. */
typedef struct loaded {
    st_status status;
    st_card card;
    st_record base;
    he_mesh *content;
    unsigned records, edits, renames, staged;
    uint64_t last; /* number of the last record that was read */
    char name[ST_MESH_NAME + 1];
    unsigned char body[64]; /* body of the last edit */
    size_t body_size;
    he_mesh *staged_content;
} loaded;

static void loaded_clear(loaded *l)
{
    he_mesh_free(l->content);
    he_mesh_free(l->staged_content);
}

/* Reads the next record of a mesh, or the next part of its data. If it is damaged, marks the mesh
 * as damaged, as the store does. */
static st_status read_piece(const st_journal *j, st_reader *reader, st_piece *out)
{
    st_status status = j->read(reader, out);
    if (status == ST_DAMAGED) {
        j->condemn(reader, out->why);
    }
    return status;
}

/* Reads the parts of mesh data, which follow the record of the data. */
static st_status load_parts(const st_journal *j, st_reader *reader, uint64_t parts, he_mesh **out)
{
    he_stored_reader *content;
    st_status status = ST_OK;
    assert_int_equal(he_stored_reader_new(parts * HE_STORED_PART, &content, NULL), HE_OK);
    for (uint64_t i = 0; i < parts && status == ST_OK; i++) {
        st_piece piece;
        status = read_piece(j, reader, &piece);
        if (status == ST_OK) {
            assert_int_equal(piece.kind, ST_PIECE_PART);
            assert_int_equal(
                he_stored_reader_part(content, piece.coding, piece.bytes, piece.size, NULL), HE_OK);
        }
    }
    if (status == ST_OK) {
        assert_int_equal(he_stored_reader_end(content, out, NULL), HE_OK);
    }
    he_stored_reader_free(content);
    return status;
}

static st_status load_record(const st_journal *j, st_reader *reader, const st_piece *piece,
                             loaded *l)
{
    const st_record *record = &piece->record;
    l->records++;
    l->last = record->number;
    if (record->kind == ST_RECORD_RENAME) {
        l->renames++;
        (void)snprintf(l->name, sizeof l->name, "%s", record->name);
    } else if (record->kind == ST_RECORD_EDIT) {
        l->edits++;
        l->body_size = record->body_size;
        assert_true(record->body_size <= sizeof l->body);
        if (record->body_size > 0) {
            memcpy(l->body, record->body, record->body_size);
        }
    }
    if (record->stage == NULL) {
        return ST_OK;
    }
    l->staged++;
    he_mesh_free(l->staged_content);
    l->staged_content = NULL;
    return load_parts(j, reader, piece->parts, &l->staged_content);
}

static loaded load(const st_journal *j, const char *id)
{
    loaded l = {.records = 0};
    st_reader *reader = NULL;
    st_piece piece;
    l.status = j->open(j->self, id, &l.card, &reader);
    if (l.status != ST_OK) {
        return l;
    }
    l.status = read_piece(j, reader, &piece);
    if (l.status == ST_OK) {
        assert_int_equal(piece.kind, ST_PIECE_BASE);
        assert_string_equal(piece.record.id, id);
        assert_true(piece.record.incarnation == l.card.incarnation);
        l.base = piece.record;
        l.base.name = l.base.ops = l.base.id = NULL;
        (void)snprintf(l.name, sizeof l.name, "%s", piece.record.name);
        l.last = l.base.number;
        l.status = load_parts(j, reader, piece.parts, &l.content);
    }
    while (l.status == ST_OK) {
        l.status = read_piece(j, reader, &piece);
        if (l.status != ST_OK || piece.kind == ST_PIECE_END) {
            break;
        }
        assert_int_equal(piece.kind, ST_PIECE_RECORD);
        l.status = load_record(j, reader, &piece, &l);
    }
    j->shut(reader);
    return l;
}

/* --- restarts --- */

static void what_was_appended_is_there_after_a_restart(void **state)
{
    (void)state;
    told_journal told;
    he_mesh *content = script_mesh("012,023,034,045", NULL);
    kept_mesh a = mesh_as("a", content), b = mesh_as("b", content);
    open_store(&told);
    const uint64_t secret[2] = {told.journal.secret[0], told.journal.secret[1]};
    const st_journal *j = &told.journal;
    kept_append(j, kept_content(&a), &a, NULL, 0);
    kept_append(j, kept_content(&b), &b, NULL, 0);
    for (unsigned char i = 0; i < 50; i++) {
        const unsigned char body[] = {i, 1, 2, 3};
        kept_append(j, kept_edit(&a), &a, body, sizeof body);
    }
    uint64_t last = kept_append(j, kept_rename(&a, "another"), &a, NULL, 0);
    assert_int_equal(j->count(j->self), 2);
    told_wait(&told, last);
    told_end(&told);

    open_store(&told);
    j = &told.journal;
    assert_memory_equal(secret, j->secret, sizeof secret);
    assert_true(told.position == last);
    assert_int_equal(j->count(j->self), 2);
    loaded l = load(j, "a");
    assert_int_equal(l.status, ST_OK);
    assert_true(he_mesh_equal(l.content, content));
    assert_int_equal(l.edits, 50);
    assert_int_equal(l.renames, 1);
    assert_true(l.last == a.number && l.card.record == a.number);
    assert_true(l.card.revision == a.revision && l.card.metadata == 2);
    assert_true(l.card.incarnation == a.incarnation && l.card.created == 1000);
    assert_string_equal(l.card.name, "another");
    assert_string_equal(l.name, "another");
    assert_int_equal(l.body[0], 49);
    assert_int_equal(l.card.counts.faces, he_mesh_faces(content));
    loaded_clear(&l);
    /* The positions of new records after the restart must be higher than all positions before the
     * restart. */
    assert_true(kept_append(j, kept_edit(&b), &b, "x", 1) == last + 1);
    l = load(j, "b");
    assert_int_equal(l.status, ST_OK);
    assert_int_equal(l.edits, 1);
    loaded_clear(&l);
    told_end(&told);
    he_mesh_free(content);
}

static void cards_are_listed_in_the_order_of_ids(void **state)
{
    (void)state;
    told_journal told;
    he_mesh *content = script_mesh("012", NULL);
    static const char *const ids[] = {"m", "a", "z", "b", "Z"};
    open_store(&told);
    const st_journal *j = &told.journal;
    kept_mesh removed = mesh_as("c", content);
    kept_append(j, kept_content(&removed), &removed, NULL, 0);
    for (size_t i = 0; i < 5; i++) {
        kept_mesh mesh = mesh_as(ids[i], content);
        kept_append(j, kept_content(&mesh), &mesh, NULL, 0);
    }
    told_wait(&told, kept_append(j, kept_remove(&removed), &removed, NULL, 0));
    st_card cards[3];
    size_t count;
    assert_int_equal(j->list(j->self, "", cards, 3, &count), ST_OK);
    assert_int_equal(count, 3);
    assert_string_equal(cards[0].id, "Z");
    assert_string_equal(cards[1].id, "a");
    assert_string_equal(cards[2].id, "b");
    assert_int_equal(j->list(j->self, "b", cards, 3, &count), ST_OK);
    assert_int_equal(count, 2);
    assert_string_equal(cards[0].id, "m");
    assert_string_equal(cards[1].name, "name of z");
    assert_int_equal(j->count(j->self), 5);
    st_card card;
    assert_int_equal(j->open(j->self, "c", &card, NULL), ST_ABSENT);
    assert_int_equal(j->open(j->self, "z", &card, NULL), ST_OK);
    /* The id of a deleted mesh can be used again. The new mesh has another incarnation number. */
    kept_mesh again = mesh_as("c", content);
    kept_append(j, kept_content(&again), &again, NULL, 0);
    assert_int_equal(j->open(j->self, "c", &card, NULL), ST_OK);
    assert_true(card.incarnation == again.incarnation);
    told_end(&told);
    he_mesh_free(content);
}

/* --- mesh data in parts, new base records, and deleting what is no longer needed --- */

static he_mesh *large_mesh(void)
{
    he_mesh *mesh = script_mesh("012,023,034,045", NULL);
    for (int i = 0; i < 6; i++) {
        script_prepare(mesh, "subdivide scheme=loop");
    }
    return mesh;
}

/* Opens the store and appends a new mesh "a" with this mesh data. */
static kept_mesh open_with_mesh(told_journal *told, const he_mesh *content)
{
    kept_mesh mesh = mesh_as("a", content);
    open_store(told);
    kept_append(&told->journal, kept_content(&mesh), &mesh, NULL, 0);
    return mesh;
}

static void a_staged_content_is_that_of_its_record(void **state)
{
    (void)state;
    told_journal told;
    he_mesh *small = script_mesh("012", NULL), *large = large_mesh();
    kept_mesh mesh = open_with_mesh(&told, small);
    st_stage *stage;
    const st_journal *j = &told.journal;
    kept_append(j, kept_edit(&mesh), &mesh, "x", 1);
    /* The edit replaces the mesh data and can be undone, so the old base (the record with all old
     * mesh data) must stay. */
    assert_int_equal(j->stage(j->self, large, &stage), ST_OK);
    st_record record = kept_edit(&mesh);
    record.stage = stage;
    kept_append(j, record, &mesh, NULL, 0);
    loaded l = load(j, "a");
    assert_int_equal(l.status, ST_OK);
    assert_true(he_mesh_equal(l.content, small) && he_mesh_equal(l.staged_content, large));
    assert_int_equal(l.staged, 1);
    assert_true(l.base.number == 1);
    loaded_clear(&l);
    /* A PUT replaces the mesh data and cannot be undone, so all earlier records of the mesh must be
     * deleted. */
    assert_int_equal(j->stage(j->self, large, &stage), ST_OK);
    record = kept_content(&mesh);
    record.stage = stage;
    kept_append(j, record, &mesh, NULL, 0);
    kept_append(j, kept_edit(&mesh), &mesh, "y", 1);
    l = load(j, "a");
    assert_int_equal(l.status, ST_OK);
    assert_true(he_mesh_equal(l.content, large));
    assert_int_equal(l.records, 1);
    assert_true(l.base.number == 4);
    loaded_clear(&l);
    store_sql_wait_for_purge(folder, &told);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM record"), 1);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM snapshot"), 1);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM part"), he_stored_parts(large));
    /* Mesh data that was written to the disk, but never belonged to a record, must be deleted. */
    assert_int_equal(j->stage(j->self, large, &stage), ST_OK);
    j->unstage(j->self, stage);
    kept_append(j, kept_edit(&mesh), &mesh, "z", 1);
    store_sql_wait_for_purge(folder, &told);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM part"), he_stored_parts(large));
    /* After a mesh is deleted, none of its records and none of the parts of its data may be
     * left. */
    kept_append(j, kept_remove(&mesh), &mesh, NULL, 0);
    store_sql_wait_for_purge(folder, &told);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM part"), 0);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM record"), 0);
    told_end(&told);
    he_mesh_free(small);
    he_mesh_free(large);
}

/* Overwrites the first page of a table; the store must be closed. */
static void spoil(const char *table)
{
    enum { PAGE = 4096 };
    char query[96];
    size_t size;
    (void)snprintf(query, sizeof query, "SELECT rootpage FROM sqlite_schema WHERE name = '%s'",
                   table);
    const size_t at = ((size_t)store_sql_number(folder, query) - 1) * PAGE;
    unsigned char *bytes = folder_read(folder, "hedge.db", &size);
    assert_true(at + PAGE <= size);
    memset(bytes + at, 0xff, PAGE);
    folder_write(folder, "hedge.db", bytes, size);
    free(bytes);
}

static void what_is_too_damaged_to_be_deleted_stops_nobody(void **state)
{
    (void)state;
    told_journal told;
    st_stage *stage;
    st_card card;
    he_mesh *small = script_mesh("012", NULL), *large = large_mesh();
    kept_mesh a = mesh_as("a", large), b = mesh_as("b", small);
    open_store(&told);
    assert_int_equal(told.journal.stage(told.journal.self, large, &stage), ST_OK);
    st_record record = kept_content(&a);
    record.stage = stage;
    kept_append(&told.journal, record, &a, NULL, 0);
    kept_append(&told.journal, kept_content(&b), &b, NULL, 0);
    told_end(&told);
    spoil("part");
    open_store(&told);
    told_wait(&told, kept_append(&told.journal, kept_remove(&a), &a, NULL, 0));
    store_sql_wait_for_purge(folder, &told);
    told_wait(&told, kept_append(&told.journal, kept_edit(&b), &b, "x", 1));
    assert_int_equal(told_losses(&told), 0);
    told_end(&told);
    open_store(&told);
    assert_int_equal(told.journal.open(told.journal.self, "a", &card, NULL), ST_ABSENT);
    loaded l = load(&told.journal, "b");
    assert_true(l.status == ST_OK && l.edits == 1);
    loaded_clear(&l);
    told_end(&told);
    he_mesh_free(small);
    he_mesh_free(large);
}

static void a_rebase_shortens_the_log_and_no_more(void **state)
{
    (void)state;
    told_journal told;
    he_mesh *small = script_mesh("012", NULL), *large = large_mesh();
    kept_mesh mesh = open_with_mesh(&told, small);
    st_stage *stage;
    const st_journal *j = &told.journal;
    for (unsigned char i = 0; i < 20; i++) {
        kept_append(j, kept_edit(&mesh), &mesh, &i, 1);
    }
    /* the new base (a record with all mesh data) holds the state after record 22, although records
     * 23 and 24 follow */
    kept_mesh behind = mesh;
    st_record facts = kept_edit(&behind);
    facts.name = mesh.name;
    facts.inverts = 3;
    kept_append(j, kept_edit(&mesh), &mesh, "b", 1);
    kept_append(j, kept_edit(&mesh), &mesh, "c", 1);
    assert_int_equal(j->stage(j->self, large, &stage), ST_OK);
    j->rebase(j->self, stage, &facts, facts.revision);
    loaded l = load(j, "a");
    /* The load may have begun before the journal had the new base, so the result of the load is not
     * checked. */
    loaded_clear(&l);
    told_wait(&told, kept_append(j, kept_edit(&mesh), &mesh, "d", 1));
    l = load(j, "a");
    assert_int_equal(l.status, ST_OK);
    assert_true(l.base.number == 22 && l.base.inverts == 3);
    assert_true(he_mesh_equal(l.content, large));
    assert_int_equal(l.edits, 2);
    assert_string_equal(l.name, mesh.name);
    loaded_clear(&l);
    store_sql_wait_for_purge(folder, &told);
    assert_int_equal(store_sql_number(folder, "SELECT min(number) FROM record"), 23);
    /* A new base (a record with all mesh data) has the number of one record and the revision of
     * another: it must be ignored and deleted. */
    assert_int_equal(j->stage(j->self, large, &stage), ST_OK);
    facts.number = 23;
    j->rebase(j->self, stage, &facts, facts.revision);
    told_wait(&told, kept_append(j, kept_edit(&mesh), &mesh, "e", 1));
    store_sql_wait_for_purge(folder, &told);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM snapshot"), 1);
    assert_int_equal(store_sql_number(folder, "SELECT count(*) FROM part"), he_stored_parts(large));
    told_end(&told);
    open_store(&told);
    l = load(&told.journal, "a");
    assert_int_equal(l.status, ST_OK);
    assert_int_equal(l.edits, 3);
    loaded_clear(&l);
    told_end(&told);
    he_mesh_free(small);
    he_mesh_free(large);
}

/* --- damage --- */

/* Makes a store of two meshes, "good" and "bad", and closes it. */
static void make_two(void)
{
    told_journal told;
    he_mesh *content = script_mesh("012,023", NULL), *large = large_mesh();
    kept_mesh good = mesh_as("good", content), bad = mesh_as("bad", content);
    open_store(&told);
    const st_journal *j = &told.journal;
    kept_append(j, kept_content(&good), &good, NULL, 0);
    kept_append(j, kept_content(&bad), &bad, NULL, 0);
    for (int i = 0; i < 5; i++) {
        kept_append(j, kept_edit(&bad), &bad, "xyz", 3);
        kept_append(j, kept_edit(&good), &good, "xyz", 3);
    }
    st_stage *stage;
    assert_int_equal(j->stage(j->self, large, &stage), ST_OK);
    st_record record = kept_edit(&bad);
    record.stage = stage;
    kept_append(j, record, &bad, NULL, 0);
    told_end(&told);
    he_mesh_free(content);
    he_mesh_free(large);
}

static void damage_is_named_and_stays_with_its_mesh(void **state)
{
    (void)state;
    static const struct {
        const char *sql, *says;
    } damages[] = {
        {"DELETE FROM record WHERE mesh = 2 AND number = 4", "record 4 is missing"},
        {"DELETE FROM record WHERE mesh = 2 AND number = 7",
         "the last record is number 6, but the mesh should have 7"},
        {"DELETE FROM record WHERE mesh = 2 AND number = 1", "record 1, from which"},
        {"UPDATE record SET bytes = (SELECT bytes FROM record WHERE mesh = 1 AND number = 3) "
         "WHERE mesh = 2 AND number = 3",
         "the chain of records breaks at record 3"},
        {"UPDATE record SET bytes = (SELECT bytes FROM record WHERE mesh = 1 AND number = 1) "
         "WHERE mesh = 2 AND number = 1",
         "record 1 belongs to another mesh"},
        {"UPDATE record SET bytes = (SELECT bytes FROM record WHERE mesh = 2 AND number = 3) "
         "WHERE mesh = 2 AND number = 4",
         "record 4 the store has a record with the number 3"},
        {"UPDATE record SET bytes = x'00' WHERE mesh = 2 AND number = 2", "record 2, byte"},
        {"DELETE FROM part WHERE part = 0", "part 0 of the mesh data after record 7"},
        {"DELETE FROM part WHERE part = 2", "part 2 of the mesh data after record 7 has"},
        {"UPDATE part SET bytes = x'0011223344556677' WHERE part = 1", "part 1 of the mesh data"},
        {"DELETE FROM snapshot", "the mesh data of record 7 is missing"},
        {"UPDATE snapshot SET parts = parts - 1", "the snapshot of record 7 has a wrong checksum"},
        {"UPDATE mesh SET faces = faces + 1 WHERE id = 'bad'", "wrong checksum"},
        {"UPDATE mesh SET damage = 'so says the card' WHERE id = 'bad'", "wrong checksum"},
    };
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        told_journal told;
        make_two();
        store_sql_run(folder, damages[i].sql);
        open_store(&told);
        const st_journal *j = &told.journal;
        loaded l = load(j, "bad");
        assert_int_equal(l.status, ST_DAMAGED);
        loaded_clear(&l);
        st_card at_once;
        assert_int_equal(j->open(j->self, "bad", &at_once, NULL), ST_DAMAGED);
        assert_true(at_once.damage[0] != '\0');
        /* After damage was found in the data of a mesh, the entry of this mesh in the list of
         * meshes must describe the damage. */
        kept_mesh other = mesh_as("other", NULL);
        he_mesh *content = script_mesh("012", NULL);
        other.content = content;
        told_wait(&told, kept_append(j, kept_content(&other), &other, NULL, 0));
        st_card card;
        assert_int_equal(j->open(j->self, "bad", &card, NULL), ST_DAMAGED);
        if (strstr(card.damage, damages[i].says) == NULL) {
            fail_msg("%s: \"%s\" is not in \"%s\"", damages[i].sql, damages[i].says, card.damage);
        }
        l = load(j, "good");
        assert_int_equal(l.status, ST_OK);
        assert_int_equal(l.edits, 5);
        loaded_clear(&l);
        /* What the list of meshes says about a damaged mesh must be enough to delete the mesh and
         * to create it again. */
        kept_mesh bad = {.incarnation = card.incarnation, .number = card.record};
        memcpy(bad.id, card.id, sizeof bad.id);
        bad.revision = card.revision;
        told_wait(&told, kept_append(j, kept_remove(&bad), &bad, NULL, 0));
        kept_mesh again = mesh_as("bad", content);
        told_wait(&told, kept_append(j, kept_content(&again), &again, NULL, 0));
        l = load(j, "bad");
        assert_int_equal(l.status, ST_OK);
        loaded_clear(&l);
        assert_int_equal(told_losses(&told), 0);
        told_end(&told);
        he_mesh_free(content);
        folder_remove(folder);
        folder_make(folder);
    }
}

/* --- stores that a start must refuse --- */

static void expect_refused(const char *where, const char *says)
{
    st_sqlite_opened refused;
    assert_false(
        st_sqlite_open(&(st_sqlite_options){.folder = where, .release = "1.2.3"}, &refused));
    if (strstr(refused.message, says) == NULL) {
        fail_msg("\"%s\" is not in \"%s\"", says, refused.message);
    }
}

static void a_second_opener_is_told_who_has_the_folder(void **state)
{
    (void)state;
    told_journal told;
    char who[64];
    (void)snprintf(who, sizeof who, "in use by process %ld on", (long)getpid());
    open_store(&told);
    expect_refused(folder, who);
    told_end(&told);
    open_store(&told);
    told_end(&told);
}

static void other_files_are_refused_by_name(void **state)
{
    (void)state;
    make_two();
    store_sql_run(folder, "PRAGMA user_version = 7");
    expect_refused(folder,
                   "have version 7, but this hedged 1.2.3 supports them only up to version 4");
    store_sql_run(folder, "PRAGMA user_version = 4; PRAGMA application_id = 5");
    expect_refused(folder, "is not a store of hedged");
    store_sql_run(folder, "PRAGMA application_id = 0x68656467; UPDATE state SET position = 1");
    expect_refused(folder, "is damaged");
    folder_write(folder, "hedge.db", (const unsigned char *)"no database at all", 18);
    expect_refused(folder, "is damaged");
    char path[2 * FOLDER_PATH];
    (void)snprintf(path, sizeof path, "%s/hedge.db", folder);
    (void)unlink(path);
    expect_refused(folder, "but no hedge.db");
    expect_refused("/proc/1/no/folder", "cannot make");
}

/* The start must read every page of the table of keys and so find the damage. Otherwise every later
 * write to this table would fail. */
static void a_damaged_table_of_keys_refuses_the_start(void **state)
{
    (void)state;
    make_two();
    spoil("kept");
    expect_refused(folder, "`hedged --restore` puts a backup in its place");
}

/* --- a write-ahead log that is truncated or damaged --- */

enum { EDITS = 4 };

/* Opens a copy of the store whose write-ahead log is damaged. Then either opening must fail with a
 * message, or the mesh must be marked as damaged, or every acknowledged edit must be there. Returns
 * true if every edit is there. */
static bool open_copy(const char *copy, const char *what, size_t at)
{
    st_sqlite_opened out;
    told_journal told;
    if (!st_sqlite_open(&(st_sqlite_options){.folder = copy, .release = "test"}, &out)) {
        assert_true(out.message[0] != '\0');
        return false;
    }
    told_begin(&told, &out.journal);
    loaded l = load(&told.journal, "a");
    if (l.status != ST_OK && l.status != ST_DAMAGED) {
        fail_msg("%s at %zu: status %d", what, at, (int)l.status);
    }
    if (l.status == ST_OK && (l.edits != EDITS || l.body[0] != EDITS - 1)) {
        fail_msg("%s at %zu: %u edits", what, at, l.edits);
    }
    bool whole = l.status == ST_OK;
    loaded_clear(&l);
    told_end(&told);
    return whole;
}

/* Copies the files that a store leaves when it is killed by kill -9. The store has a mesh "a" and
 * some acknowledged edits. */
static void make_killed(const char *copy)
{
    told_journal told;
    he_mesh *content = script_mesh("012,023", NULL);
    kept_mesh mesh = mesh_as("a", content);
    open_store(&told);
    uint64_t last = kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0);
    for (unsigned i = 0; i < EDITS; i++) {
        const unsigned char byte = (unsigned char)i;
        told_wait(&told, last);
        last = kept_append(&told.journal, kept_edit(&mesh), &mesh, &byte, 1);
    }
    told_wait(&told, last);
    folder_copy(folder, copy);
    told_end(&told);
    he_mesh_free(content);
}

static void a_cut_log_is_refused_or_whole(void **state)
{
    (void)state;
    char copy[FOLDER_PATH];
    size_t size;
    unsigned refused = 0, whole = 0;
    folder_make(copy);
    make_killed(copy);
    unsigned char *db = folder_read(copy, "hedge.db", &size);
    size_t db_size = size, mark_size;
    unsigned char *mark = folder_read(copy, "hedge.mark", &mark_size);
    unsigned char *log = folder_read(copy, "hedge.db-wal", &size);
    assert_non_null(log);
    for (size_t cut = 0; cut < size; cut += 509) {
        folder_write(copy, "hedge.db", db, db_size);
        folder_write(copy, "hedge.mark", mark, mark_size);
        folder_write(copy, "hedge.db-wal", log, cut);
        if (open_copy(copy, "cut", cut)) {
            whole++;
        } else {
            refused++;
        }
    }
    printf("note: the -wal of %zu bytes cut at %u places: %u refused, %u whole\n", size,
           refused + whole, refused, whole);
    assert_true(refused > 0);
    free(db);
    free(mark);
    free(log);
    folder_remove(copy);
}

static void a_flipped_bit_is_refused_or_named_or_harmless(void **state)
{
    (void)state;
    static const char *const files[] = {"hedge.db", "hedge.db-wal", "hedge.mark"};
    enum { FILES = sizeof files / sizeof *files, FLIPS = 150 };
    char copy[FOLDER_PATH];
    unsigned char *bytes[FILES];
    size_t sizes[FILES];
    unsigned refused = 0, whole = 0;
    md_random random = {seed_of_run()};
    folder_make(copy);
    make_killed(copy);
    for (size_t i = 0; i < FILES; i++) {
        bytes[i] = folder_read(copy, files[i], &sizes[i]);
        assert_non_null(bytes[i]);
    }
    for (unsigned n = 0; n < FLIPS; n++) {
        size_t file = n % FILES;
        size_t bit = (size_t)md_bits(&random) % (8 * sizes[file]);
        bytes[file][bit / 8] ^= (unsigned char)(1u << bit % 8);
        for (size_t i = 0; i < FILES; i++) {
            folder_write(copy, files[i], bytes[i], sizes[i]);
        }
        if (open_copy(copy, files[file], bit)) {
            whole++;
        } else {
            refused++;
        }
        bytes[file][bit / 8] ^= (unsigned char)(1u << bit % 8);
    }
    printf("note: %u bits flipped: %u refused or named, %u read nothing wrong\n", FLIPS, refused,
           whole);
    for (size_t i = 0; i < FILES; i++) {
        free(bytes[i]);
    }
    folder_remove(copy);
}

/* A process may be killed while it makes a new store: the next start must then make the store from
 * the beginning. */
static void a_store_is_new_until_its_first_start_is_over(void **state)
{
    (void)state;
    told_journal told;
    he_mesh *cube = fixture_mesh("0123");
    kept_mesh mesh = mesh_as("m", cube);
    open_store(&told);
    assert_true(opened.made);
    assert_int_not_equal(kept_append(&told.journal, kept_content(&mesh), &mesh, NULL, 0), 0);
    told_end(&told);
    open_store(&told);
    assert_true(opened.made);
    told.journal.begun(told.journal.self);
    told_end(&told);
    open_store(&told);
    assert_false(opened.made);
    told_end(&told);
    he_mesh_free(cube);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define STORE_TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        STORE_TEST(what_was_appended_is_there_after_a_restart),
        STORE_TEST(cards_are_listed_in_the_order_of_ids),
        STORE_TEST(a_staged_content_is_that_of_its_record),
        STORE_TEST(what_is_too_damaged_to_be_deleted_stops_nobody),
        STORE_TEST(a_rebase_shortens_the_log_and_no_more),
        STORE_TEST(damage_is_named_and_stays_with_its_mesh),
        STORE_TEST(a_store_is_new_until_its_first_start_is_over),
        STORE_TEST(a_second_opener_is_told_who_has_the_folder),
        STORE_TEST(other_files_are_refused_by_name),
        STORE_TEST(a_damaged_table_of_keys_refuses_the_start),
        STORE_TEST(a_cut_log_is_refused_or_whole),
        STORE_TEST(a_flipped_bit_is_refused_or_named_or_harmless),
#undef STORE_TEST
    };
    return cmocka_run_group_tests_name("journal", tests, NULL, NULL);
}
