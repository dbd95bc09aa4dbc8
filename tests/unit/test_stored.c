/* Tests of meshes and edits as bytes (core/stored): reading must restore exactly what was written,
 * and damaged bytes must be refused with a reason and an offset. test_op_table.c converts every
 * operation to bytes and back.
 *  `test_stored --write FOLDER` writes the golden files (expected bytes) of a new version of the
 * format; the golden files of a released version must never change. They are also the first
 * inputs of the fuzzer fuzz_stored. */
#include "tests/unit/edit_log.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"
#include "tests/unit/stored_trip.h"

#include "mesh/compact.h"
#include "mesh/content.h"
#include "mesh/write.h"
#include "stored/stored.h"
#include "tests/seed.h"
#include "tests/failing.h"

#define GOLDEN "tests/fuzz/seeds/stored"

enum { ENTRIES = 60, GOLDEN_MOST = 65536 };

/* --- logs of random edits --- */

/* Replays the log from its first entry, and encodes each edit at the state to which it applies. */
static void code_log(const edit_log *log, stored_bytes *coded)
{
    he_mesh *m = copy_of(log->entries[0].after);
    for (size_t i = 1; i < log->count; i++) {
        const edit_log_entry *e = &log->entries[i];
        uint32_t issued[HE_KIND_COUNT];
        if (e->undo) {
            he_delta_undo(log->steps[e->step], m);
        } else if (coded[e->step].bytes != NULL) {
            he_delta_redo(log->steps[e->step], m);
        } else {
            edit_log_marks(e->after, issued);
            assert_int_equal(he_delta_forward(log->steps[e->step], m, issued, NULL, NULL), HE_OK);
            coded[e->step] = stored_edit(log->steps[e->step], m);
        }
    }
    he_mesh_free(m);
}

/* Applies entry i of the log from encoded bytes alone, as the start of a store does. If the entry
 * is an undo, the function also sets how many ids were ever issued, because a delta that was read
 * from bytes does not always contain this number. */
static he_status apply_coded(const edit_log *log, size_t i, const stored_bytes *coded,
                             he_delta **deltas, he_mesh *m)
{
    const edit_log_entry *e = &log->entries[i];
    uint32_t issued[HE_KIND_COUNT];
    edit_log_marks(e->after, issued);
    if (!e->undo && deltas[e->step] == NULL) {
        return he_stored_edit_forward(coded[e->step].bytes, coded[e->step].size, issued, m,
                                      &deltas[e->step], NULL);
    }
    if (e->undo) {
        he_delta_undo(deltas[e->step], m);
    } else {
        he_delta_redo(deltas[e->step], m);
    }
    return he_content_issue(&m->c, issued, NULL);
}

static edit_log *undone_log(md_random *random)
{
    edit_log *log = edit_log_random(random, ENTRIES);
    while (log->done_count > 0) {
        edit_log_undo(log);
    }
    return log;
}

static void free_all(stored_bytes *coded, he_delta **deltas)
{
    for (size_t i = 0; i < EDIT_LOG_MOST; i++) {
        free(coded[i].bytes);
        he_delta_free(deltas[i]);
    }
}

static void a_log_is_the_same_after_a_restart(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    for (int round = 0; round < 20; round++) {
        edit_log *log = undone_log(&random);
        stored_bytes coded[EDIT_LOG_MOST] = {{NULL, 0}};
        he_delta *deltas[EDIT_LOG_MOST] = {NULL};
        code_log(log, coded);
        stored_bytes content = stored_content(log->entries[0].after);
        he_mesh *m = stored_load(content);
        for (size_t i = 1; i < log->count; i++) {
            assert_int_equal(apply_coded(log, i, coded, deltas, m), HE_OK);
            assert_true(he_mesh_equal(m, log->entries[i].after));
            assert_valid(m);
        }
        free_all(coded, deltas);
        free(content.bytes);
        he_mesh_free(m);
        edit_log_free(log);
    }
}

static void without_memory_nothing_is_read_and_nothing_changes(void **state)
{
    (void)state;
    md_random random = {5};
    edit_log *log = undone_log(&random);
    stored_bytes coded[EDIT_LOG_MOST] = {{NULL, 0}};
    code_log(log, coded);
    stored_bytes content = stored_content(log->entries[0].after);
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        failing_pause();
        he_delta *deltas[EDIT_LOG_MOST] = {NULL};
        he_mesh *m = NULL;
        size_t i = 0;
        failing_resume();
        he_status status = he_stored_content_read(content.bytes, content.size, &m, NULL);
        while (status == HE_OK && i + 1 < log->count) {
            i++;
            status = apply_coded(log, i, coded, deltas, m);
        }
        /* If shrinking a block fails, the block stays as it is, so reading may succeed
         * nevertheless. */
        failing_status(&f, status);
        assert_true(m != NULL || i == 0);
        if (m != NULL && status == HE_OK) {
            assert_true(he_mesh_equal(m, log->entries[i].after));
        } else if (m != NULL && !log->entries[i].undo) {
            assert_true(he_mesh_equal(m, log->entries[i - 1].after));
        }
        for (size_t k = 0; k < EDIT_LOG_MOST; k++) {
            he_delta_free(deltas[k]);
        }
        he_mesh_free(m);
    }
    he_delta *none[EDIT_LOG_MOST] = {NULL};
    free_all(coded, none);
    free(content.bytes);
    edit_log_free(log);
}

/* --- single edits, also as golden files --- */

static he_column *labelled_column(const he_mesh *m)
{
    static const char *const texts[] = {"stone", "w\xc3\xb6\x6f\x64", ""};
    he_column *column;
    assert_int_equal(he_column_new(&(he_column_schema){"material", HE_FACE, HE_UINT32, 1, HE_COPY},
                                   &column, NULL),
                     HE_OK);
    column->labels = he_labels_new();
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        uint32_t index;
        assert_int_equal(he_labels_add(column->labels, texts[i], strlen(texts[i]), &index, NULL),
                         HE_OK);
    }
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_FACE), NULL), HE_OK);
    for (size_t row = 0; row < column->rows; row++) {
        column->data[4 * row] = (unsigned char)(row % 3);
    }
    return column;
}

/* Adds a column, writes a value to it, adds faces, and removes the column again. Then adds another
 * column, which stays. */
static void change_columns(he_mesh *m)
{
    const uint32_t value = 2;
    assert_int_equal(he_mesh_add_column(m, labelled_column(m), NULL), HE_OK);
    size_t slot = he_mesh_column_slot(m, he_mesh_find_column(m, HE_FACE, "material"));
    assert_int_equal(he_reserve_values(m, slot, 1, NULL), HE_OK);
    he_set_attribute(m, slot, 0, &value);
    script_prepare(m, "face_poke face=0");
    assert_int_equal(he_mesh_drop_column(m, slot, NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, labelled_column(m), NULL), HE_OK);
    assert_int_equal(he_reserve_values(m, slot, 1, NULL), HE_OK);
    he_set_attribute(m, slot, 1, &value);
}

static void drop_columns(he_mesh *m)
{
    for (size_t i = 0; i < he_mesh_columns(m); i++) {
        assert_int_equal(he_mesh_drop_column(m, i, NULL), HE_OK);
    }
}

/* Adds materials to the table of materials, changes the table twice and deletes some materials,
 * which leaves a free entry in the middle of the table. */
static void change_materials(he_mesh *m)
{
    script_prepare(m, "material_set name=red base_color=1,0,0,0.5 metallic=0.25 roughness=0.5 "
                      "emission=2,0,0 two_sided=1;"
                      "material_set name=blue faces=0,1;"
                      "material_set name=w\xc3\xb6\x6f\x64;"
                      "material_set name=red roughness=0.75;"
                      "material_set name=red rename=rot face=2");
    assert_int_equal(he_mesh_put_material(m, 1, NULL, NULL), HE_OK);
}

/* Moves all vertices twice at once, and one of them before, between and after. */
static void write_positions(he_mesh *m)
{
    script_prepare(m, "vertex_move vertex=1 by=0.5,0,1");
    for (int turn = 0; turn < 2; turn++) {
        he_column present, *moved;
        he_mesh_position_column(m, &present);
        assert_int_equal(he_column_copy(&present, &moved, NULL), HE_OK);
        for (size_t i = 0; i < 3 * moved->rows; i++) {
            const double value = turn + (double)i / 8;
            memcpy(moved->data + i * sizeof value, &value, sizeof value);
        }
        assert_int_equal(he_exchange_positions(m, moved, NULL), HE_OK);
        script_prepare(m, "vertex_move vertex=2 by=0.5,0,1");
    }
}

static void compact(he_mesh *m)
{
    script_prepare(m, "face_delete face=0");
    assert_int_equal(he_compact(m, NULL, NULL), HE_OK);
}

typedef struct specimen {
    const char *name;
    const char *operation;
    void (*change)(he_mesh *m);
    bool columns;   /* whether the mesh has the columns of script_add_columns */
    bool materials; /* whether the mesh has materials, with a free entry among them in the table */
} specimen;

static const specimen specimens[] = {
    {"vertex_move", "vertex_move vertex=1 by=0.5,0,1", NULL, false, false},
    {"edge_flip", "edge_flip edge=0-2", NULL, false, false},
    {"face_poke", "face_poke face=0", NULL, false, false},
    {"edge_split", "edge_split edge=0-2 t=0.25", NULL, true, false},
    {"edge_collapse", "edge_collapse edge=0-1", NULL, true, false},
    {"vertex_delete", "vertex_delete vertex=0", NULL, false, false},
    {"subdivide", "subdivide scheme=loop", NULL, false, false},
    {"columns", NULL, change_columns, false, false},
    {"columns_dropped", NULL, drop_columns, true, false},
    {"compact", NULL, compact, false, false},
    {"positions", NULL, write_positions, false, false},
    {"material_set", "material_set name=red roughness=0.125 face=3", NULL, false, true},
    {"materials", NULL, change_materials, false, false},
    {"materials_compact", NULL, compact, false, true},
};
enum { SPECIMENS = sizeof specimens / sizeof *specimens };

typedef struct specimen_run {
    he_mesh *before, *after;
    he_delta *delta;
    stored_bytes content, edit;
    uint32_t issued[HE_KIND_COUNT];
} specimen_run;

static specimen_run run_of(const specimen *s)
{
    specimen_run run = {.after = script_mesh("012,023,034,045", NULL), .delta = he_delta_new()};
    assert_non_null(run.delta);
    if (s->columns) {
        script_add_columns(run.after);
    }
    if (s->materials) {
        change_materials(run.after);
    }
    run.before = copy_of(run.after);
    he_mesh_record(run.after, run.delta);
    if (s->operation != NULL) {
        script_prepare(run.after, s->operation);
    } else {
        s->change(run.after);
    }
    he_mesh_record(run.after, NULL);
    run.content = stored_content(run.before);
    run.edit = stored_edit(run.delta, run.after);
    edit_log_marks(run.after, run.issued);
    return run;
}

static void run_clear(specimen_run *run)
{
    he_mesh_free(run->before);
    he_mesh_free(run->after);
    he_delta_free(run->delta);
    free(run->content.bytes);
    free(run->edit.bytes);
}

static void contents_and_edits_come_back_from_their_bytes(void **state)
{
    (void)state;
    for (size_t i = 0; i < SPECIMENS; i++) {
        specimen_run run = run_of(&specimens[i]);
        stored_trip(run.before, run.delta, run.after);
        run_clear(&run);
    }
}

/* Writes a golden file (the expected bytes of an edit) to memory: the length of the encoded mesh,
 * the encoded mesh, how many ids were issued after the edit, and the encoded edit. Returns the size
 * of the file. */
static size_t golden_of(const specimen *s, unsigned char *to)
{
    specimen_run run = run_of(s);
    const uint32_t words[] = {run.issued[HE_VERTEX], run.issued[HE_EDGE], run.issued[HE_FACE]};
    uint32_t length = (uint32_t)run.content.size;
    size_t size = sizeof length + run.content.size + sizeof words + run.edit.size;
    assert_true(size <= GOLDEN_MOST);
    memcpy(to, &length, sizeof length);
    memcpy(to + sizeof length, run.content.bytes, length);
    memcpy(to + sizeof length + length, words, sizeof words);
    memcpy(to + sizeof length + length + sizeof words, run.edit.bytes, run.edit.size);
    run_clear(&run);
    return size;
}

/* Reads the golden files (expected bytes of each version of the format) and encodes the meshes in
 * them again, which must give the same bytes. The test runs no operations on meshes, because the
 * results of operations may change. */
static void golden_files_are_read_and_written_again(void **state)
{
    (void)state;
    unsigned char *bytes = malloc(GOLDEN_MOST);
    for (size_t i = 0; i < SPECIMENS; i++) {
        char path[256];
        (void)snprintf(path, sizeof path, GOLDEN "/%s", specimens[i].name);
        FILE *file = fopen(path, "rb");
        if (file == NULL) {
            fail_msg("%s is missing", path);
        }
        size_t size = fread(bytes, 1, GOLDEN_MOST, file);
        (void)fclose(file);
        uint32_t length, words[3];
        assert_true(size > sizeof length);
        memcpy(&length, bytes, sizeof length);
        assert_true(size - sizeof length > length + sizeof words);
        memcpy(words, bytes + sizeof length + length, sizeof words);
        const uint32_t issued[HE_KIND_COUNT] = {
            [HE_VERTEX] = words[0], [HE_EDGE] = words[1], [HE_FACE] = words[2]};
        stored_bytes content = {bytes + sizeof length, length};
        stored_bytes edit = {content.bytes + length + sizeof words,
                             size - sizeof length - length - sizeof words};
        he_mesh *m = stored_load(content);
        stored_bytes again = stored_content(m);
        assert_int_equal(again.size, content.size);
        assert_memory_equal(again.bytes, content.bytes, content.size);
        free(again.bytes);
        he_delta *delta = NULL;
        assert_int_equal(he_stored_edit_forward(edit.bytes, edit.size, issued, m, &delta, NULL),
                         HE_OK);
        assert_valid(m);
        again = stored_edit(delta, m);
        assert_int_equal(again.size, edit.size);
        assert_memory_equal(again.bytes, edit.bytes, edit.size);
        free(again.bytes);
        he_delta_free(delta);
        he_mesh_free(m);
    }
    free(bytes);
}

static int write_golden_files(const char *folder)
{
    unsigned char *bytes = malloc(GOLDEN_MOST);
    bool good = bytes != NULL;
    for (size_t i = 0; i < SPECIMENS && good; i++) {
        char path[256];
        (void)snprintf(path, sizeof path, "%s/%s", folder, specimens[i].name);
        FILE *file = fopen(path, "wb");
        size_t size = golden_of(&specimens[i], bytes);
        good = file != NULL && fwrite(bytes, 1, size, file) == size;
        good = file != NULL && fclose(file) == 0 && good;
    }
    free(bytes);
    return good ? 0 : 1;
}

/* --- damage --- */

typedef struct tally {
    unsigned refused, same, other;
} tally;

static void expect_named(he_status status, const he_error *err, size_t size)
{
    assert_true(status == HE_CORRUPT || status == HE_UNSUPPORTED);
    assert_int_equal(err->status, status);
    assert_int_equal(err->place, HE_PLACE_BYTE);
    assert_true(err->at <= size);
    assert_true(err->text[0] != '\0');
}

/* Reads the damaged bytes of an edit. Either the bytes must be refused and the mesh must stay
 * unchanged, or the edit must be applied so that undo restores the mesh: if one bit of a value is
 * flipped, the bytes are another valid edit, and only the checksum of its record can detect the
 * damage. */
static void read_damaged(const specimen_run *run, stored_bytes damaged, tally *seen)
{
    he_mesh *m = copy_of(run->before);
    he_delta *delta = NULL;
    he_error err = {.status = HE_OK};
    unsigned char *exact = malloc(damaged.size + 1);
    /* The memory block ends where the bytes end, so that a sanitizer detects reads past the end. */
    memcpy(exact + 1, damaged.bytes, damaged.size);
    he_status status =
        he_stored_edit_forward(exact + 1, damaged.size, run->issued, m, &delta, &err);
    if (status != HE_OK) {
        expect_named(status, &err, damaged.size + run->content.size + 65536);
        assert_true(he_mesh_equal(m, run->before));
        seen->refused++;
    } else {
        seen->same += he_mesh_equal(m, run->after);
        seen->other += !he_mesh_equal(m, run->after);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal_live(m, run->before));
    }
    he_delta_free(delta);
    he_mesh_free(m);
    free(exact);
}

static void a_damaged_edit_is_refused_or_can_be_undone(void **state)
{
    (void)state;
    tally cuts = {0}, bits = {0};
    for (size_t i = 0; i < SPECIMENS; i++) {
        specimen_run run = run_of(&specimens[i]);
        for (size_t size = 0; size < run.edit.size; size++) {
            read_damaged(&run, (stored_bytes){run.edit.bytes, size}, &cuts);
        }
        for (size_t bit = 0; bit < 8 * run.edit.size; bit++) {
            run.edit.bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
            read_damaged(&run, run.edit, &bits);
            run.edit.bytes[bit / 8] ^= (unsigned char)(1u << bit % 8);
        }
        run_clear(&run);
    }
    assert_int_equal(cuts.same + cuts.other, 0);
    printf("note: %u edits cut short: all refused; %u with a bit flipped: %u refused, %u do the "
           "same, %u something else\n",
           cuts.refused, bits.refused + bits.same + bits.other, bits.refused, bits.same,
           bits.other);
}

static void a_damaged_content_is_refused_or_is_another_mesh(void **state)
{
    (void)state;
    tally bits = {0};
    for (size_t i = 0; i < SPECIMENS; i++) {
        specimen_run run = run_of(&specimens[i]);
        stored_bytes content = stored_content(run.after);
        for (size_t at = 0; at < 9 * content.size; at++) {
            size_t size = at < content.size ? at : content.size, bit = at - content.size;
            unsigned char *exact = malloc(size + 1);
            he_mesh *m = NULL;
            he_error err = {.status = HE_OK};
            memcpy(exact + 1, content.bytes, size);
            if (at >= content.size) {
                exact[1 + bit / 8] ^= (unsigned char)(1u << bit % 8);
            }
            he_status status = he_stored_content_read(exact + 1, size, &m, &err);
            if (status != HE_OK) {
                expect_named(status, &err, 4 * content.size);
                assert_null(m);
                bits.refused += at >= content.size;
            } else {
                he_problem problem;
                size_t total;
                assert_true(at >= content.size);
                assert_int_equal(he_check(m, &problem, 1, &total, NULL), HE_OK);
                bits.same += total == 0;
                bits.other += total > 0;
            }
            he_mesh_free(m);
            free(exact);
        }
        free(content.bytes);
        run_clear(&run);
    }
    printf("note: %u contents with a bit flipped: %u refused, %u by he_check\n",
           bits.refused + bits.same + bits.other, bits.refused, bits.other);
}

static void expect_text(const he_error *err, he_status status, uint64_t at, const char *text)
{
    assert_int_equal(err->status, status);
    assert_int_equal(err->at, at);
    assert_string_equal(err->text, text);
}

static void a_newer_version_is_refused_and_both_versions_are_named(void **state)
{
    (void)state;
    specimen_run run = run_of(&specimens[0]);
    he_delta *delta = NULL;
    he_mesh *m = NULL;
    he_error err;
    run.edit.bytes[0] = 3;
    assert_int_equal(
        he_stored_edit_forward(run.edit.bytes, run.edit.size, run.issued, run.before, &delta, &err),
        HE_UNSUPPORTED);
    expect_text(&err, HE_UNSUPPORTED, 0,
                "the stored edit has version 3, but this release reads up to version 2");
    run.content.bytes[5 + 4] = 7; /* the version, which follows the part's coding and length */
    assert_int_equal(he_stored_content_read(run.content.bytes, run.content.size, &m, &err),
                     HE_UNSUPPORTED);
    expect_text(&err, HE_UNSUPPORTED, 4,
                "the stored mesh has version 7, but this release reads version 1");
    run.content.bytes[5 + 4] = 1;
    run.content.bytes[0] |= HE_CODING_PACKED;
    assert_int_equal(he_stored_content_read(run.content.bytes, run.content.size, &m, &err),
                     HE_UNSUPPORTED);
    expect_text(
        &err, HE_UNSUPPORTED, 0,
        "a part of the stored mesh has the coding 3, but this release reads only codings up to 1");
    run_clear(&run);
}

static void a_refused_edit_names_the_change_that_does_not_fit(void **state)
{
    (void)state;
    specimen_run run = run_of(&specimens[0]);
    he_delta *delta = NULL;
    he_error err;
    assert_int_equal(
        he_stored_edit_forward(run.edit.bytes, run.edit.size, run.issued, run.after, &delta, &err),
        HE_CORRUPT);
    /* The change is refused at offset 2, where the run of changes that contains it begins; before
     * that are the version and the number of runs. */
    expect_text(
        &err, HE_CORRUPT, 2,
        "change 0 cannot be applied: the mesh does not have the value that the change replaces");
    run.issued[HE_EDGE] += 1000;
    assert_int_equal(
        he_stored_edit_forward(run.edit.bytes, run.edit.size, run.issued, run.before, &delta, &err),
        HE_CORRUPT);
    expect_text(&err, HE_CORRUPT, 0,
                "a stored edit of 2 changes cannot give out ids of edges up to 1009");
    run_clear(&run);
}

/* A few bytes declare numbers of elements that would need gigabytes: the reader must refuse the
 * bytes without allocating so much memory. */
static void a_small_content_gets_no_large_memory(void **state)
{
    (void)state;
    specimen_run run = run_of(&specimens[0]);
    he_mesh *m = NULL;
    he_error err;
    memset(run.content.bytes + 5 + 16, 0x3f,
           12); /* the declared numbers of vertices, edges and faces */
    failing_at(0);
    assert_int_equal(he_stored_content_read(run.content.bytes, run.content.size, &m, &err),
                     HE_CORRUPT);
    assert_string_equal(err.text, "the stored mesh declares more bytes than its parts hold");
    assert_true(failing_count() <= 4);
    failing_off();
    run_clear(&run);
}

/* --- mesh data in several parts --- */

/* Makes a mesh whose data takes many parts. The labels (texts) of its attribute alone take more
 * than one part. */
static he_mesh *large_mesh(void)
{
    he_mesh *m = script_mesh("012,023,034,045", NULL);
    script_add_columns(m);
    script_prepare(m, "subdivide scheme=loop;subdivide scheme=loop;subdivide scheme=loop;"
                      "subdivide scheme=loop;subdivide scheme=loop;face_delete face=#7");
    he_column *column = labelled_column(m);
    for (unsigned i = 0; i < 20000; i++) {
        char text[32];
        uint32_t index;
        (void)snprintf(text, sizeof text, "label %u", i);
        assert_int_equal(he_labels_add(column->labels, text, strlen(text), &index, NULL), HE_OK);
    }
    memset(he_column_row(column, 7), 0, column->row_bytes); /* face 7 is deleted: it has no value */
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    return m;
}

/* Writes the data of a mesh as parts, and reads all parts except the last `less` parts. */
static he_status read_parts(const he_mesh *m, uint64_t less, he_mesh **out, he_error *err)
{
    unsigned char *part = malloc(HE_STORED_PART_ROOM);
    he_stored_writer writer;
    he_stored_reader *reader;
    unsigned coding;
    uint64_t parts = he_stored_parts(m), read = 0;
    he_status status = HE_OK;
    assert_int_equal(he_stored_reader_new(parts * HE_STORED_PART, &reader, NULL), HE_OK);
    he_stored_writer_init(&writer, m);
    for (size_t size; (size = he_stored_writer_next(&writer, part, &coding)) > 0; read++) {
        assert_true(size <= HE_STORED_PART_ROOM);
        if (read < parts - less && status == HE_OK) {
            status = he_stored_reader_part(reader, coding, part, size, err);
        }
    }
    assert_int_equal(read, parts);
    if (status == HE_OK) {
        status = he_stored_reader_end(reader, out, err);
    }
    he_stored_reader_free(reader);
    free(part);
    return status;
}

static void a_large_mesh_is_read_part_by_part(void **state)
{
    (void)state;
    he_mesh *m = large_mesh(), *read = NULL;
    he_error err;
    assert_valid(m);
    assert_true(he_stored_parts(m) > 10);
    assert_int_equal(read_parts(m, 0, &read, &err), HE_OK);
    assert_true(he_mesh_equal(read, m));
    he_mesh_free(read);
    read = NULL;
    for (uint64_t less = 1; less <= he_stored_parts(m); less++) {
        assert_int_equal(read_parts(m, less, &read, &err), HE_CORRUPT);
        assert_int_equal(err.at, (he_stored_parts(m) - less) * HE_STORED_PART);
        assert_string_equal(err.text, "parts of the stored mesh are missing");
        assert_null(read);
    }
    stored_bytes block = stored_content(m);
    read = stored_load(block);
    assert_true(he_mesh_equal(read, m));
    he_mesh_free(read);
    he_mesh_free(m);
    free(block.bytes);
}

static void an_empty_mesh_comes_back_from_its_bytes(void **state)
{
    (void)state;
    he_mesh *m = he_mesh_new();
    stored_bytes block = stored_content(m);
    he_mesh *read = stored_load(block);
    assert_true(he_mesh_equal(read, m));
    he_mesh_free(read);
    he_mesh_free(m);
    free(block.bytes);
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "--write") == 0) {
        return write_golden_files(argv[2]);
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_log_is_the_same_after_a_restart),
        cmocka_unit_test(without_memory_nothing_is_read_and_nothing_changes),
        cmocka_unit_test(contents_and_edits_come_back_from_their_bytes),
        cmocka_unit_test(golden_files_are_read_and_written_again),
        cmocka_unit_test(a_damaged_edit_is_refused_or_can_be_undone),
        cmocka_unit_test(a_damaged_content_is_refused_or_is_another_mesh),
        cmocka_unit_test(a_newer_version_is_refused_and_both_versions_are_named),
        cmocka_unit_test(a_refused_edit_names_the_change_that_does_not_fit),
        cmocka_unit_test(a_small_content_gets_no_large_memory),
        cmocka_unit_test(a_large_mesh_is_read_part_by_part),
        cmocka_unit_test(an_empty_mesh_comes_back_from_its_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
