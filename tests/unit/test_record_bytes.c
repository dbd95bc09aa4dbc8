/* Tests of the store's records as bytes (core/journal/record_bytes.h): reading must restore what
 * was written, every later release must be able to read the bytes in this file, and damaged records
 * must be refused with the offset of the damage.
 *  `test_record_bytes --write FOLDER` writes the records of this test as first inputs of the
 * fuzzer fuzz_record. */
#include "journal/record_bytes.h"

#include "journal/crc32c.h"
#include "unit/fixture.h"

/* The checksum of a record continues from the checksum of the record before it. This is the value
 * from which the checksums in this test continue. */
#define CHAIN UINT64_C(0x0123456789abcdef)

static const unsigned char body[] = {1, 2, 3, 250};
static char in_parts; /* a placeholder: a record whose `stage` is its address has data that the
                         journal has written in parts */

/* One record of each kind with the bytes that version 1 of the format has for it. */
static const struct specimen {
    const char *name;
    st_record record;
    const char *golden;
} specimens[] = {
    {"edit",
     {.kind = ST_RECORD_EDIT,
      .number = 7,
      .revision = 5,
      .reach = 2,
      .metadata = 1,
      .time = 1700000000.5,
      .ops = "edge_split,face_poke",
      .tally = {.known = true, .created = {1, 3, 2}, .deleted = {0, 0, 1}, .modified = {4, 300, 0}},
      .issued = {[HE_VERTEX] = 9, [HE_HALFEDGE] = 400, [HE_EDGE] = 200, [HE_FACE] = 11},
      .counts = {8, 200, 10, 0},
      .bytes = 70000,
      .body = body,
      .body_size = sizeof body},
     "06a461270101020007000000000000000500000000000000efcdab896745230100002040fc54d941"
     "01000309c8010b08c8010a00f0a20414656467655f73706c69742c666163655f706f6b6501030200"
     "000104ac0200010203fa"},
    {"undo",
     {.kind = ST_RECORD_UNDO,
      .number = 8,
      .revision = 6,
      .metadata = 1,
      .inverts = 5,
      .time = 1700000001,
      .ops = "",
      .issued = {[HE_VERTEX] = 9, [HE_HALFEDGE] = 400, [HE_EDGE] = 200, [HE_FACE] = 11},
      .counts = {8, 197, 8, 3},
      .bytes = 70000},
     "556297060102000008000000000000000600000000000000efcdab896745230100004040fc54d941"
     "01050609c8010b08c5010803f0a20400"},
    {"redo",
     {.kind = ST_RECORD_REDO,
      .number = 9,
      .revision = 7,
      .metadata = 1,
      .inverts = 6,
      .time = 1700000001.25,
      .ops = "",
      .issued = {[HE_VERTEX] = 9, [HE_HALFEDGE] = 400, [HE_EDGE] = 200, [HE_FACE] = 11},
      .counts = {8, 200, 10, 0},
      .bytes = 70000},
     "6baf64680103000009000000000000000700000000000000efcdab896745230100005040fc54d941"
     "01060709c8010b08c8010a00f0a20400"},
    {"content",
     {.kind = ST_RECORD_CONTENT,
      .barrier = true,
      .name = "a w\xc3\xb6rd",
      .number = 1,
      .revision = 1,
      .metadata = 1,
      .time = 1700000002,
      .ops = "",
      .issued = {[HE_VERTEX] = 3, [HE_HALFEDGE] = 6, [HE_EDGE] = 3, [HE_FACE] = 1},
      .counts = {3, 3, 1, 3},
      .bytes = 400,
      .body = body,
      .body_size = sizeof body},
     "4cb52fc40104010001000000000000000100000000000000efcdab896745230100008040fc54d941"
     "0100010303010303010390030007612077c3b67264010203fa"},
    {"parts",
     {.kind = ST_RECORD_EDIT,
      .number = UINT64_MAX,
      .revision = UINT64_MAX - 1,
      .metadata = UINT64_MAX,
      .time = 0,
      .ops = "subdivide",
      .issued = {[HE_VERTEX] = UINT32_MAX,
                 [HE_HALFEDGE] = UINT32_MAX - 1,
                 [HE_EDGE] = UINT32_MAX / 2,
                 [HE_FACE] = UINT32_MAX},
      .counts = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX},
      .bytes = UINT64_MAX,
      .stage = (st_stage *)&in_parts},
     "b995e9e001010400fffffffffffffffffeffffffffffffffefcdab89674523010000000000000000"
     "ffffffffffffffffff0100feffffffffffffffff01ffffffff0fffffffff07ffffffff0fffffffff"
     "0fffffffff0fffffffff0fffffffff0fffffffffffffffffff0109737562646976696465"},
    {"edit in parts",
     {.kind = ST_RECORD_EDIT,
      .barrier = true,
      .number = 3,
      .revision = 3,
      .metadata = 1,
      .time = 1700000003,
      .ops = "edge_split",
      .issued = {[HE_VERTEX] = 9, [HE_HALFEDGE] = 400, [HE_EDGE] = 200, [HE_FACE] = 11},
      .counts = {8, 200, 10, 0},
      .bytes = 70000,
      .stage = (st_stage *)&in_parts,
      .staged_edit = true},
     "eaecb4d001010d0003000000000000000300000000000000efcdab89674523010000c040fc54d941"
     "01000309c8010b08c8010a00f0a2040a656467655f73706c6974"},
    {"rename",
     {.kind = ST_RECORD_RENAME,
      .name = "",
      .number = 10,
      .revision = 7,
      .metadata = 2,
      .time = 1700000003,
      .ops = "",
      .issued = {[HE_VERTEX] = 9, [HE_HALFEDGE] = 400, [HE_EDGE] = 200, [HE_FACE] = 11},
      .counts = {8, 200, 10, 0},
      .bytes = 70000},
     "b50a029d010500000a000000000000000700000000000000efcdab89674523010000c040fc54d941"
     "02000709c8010b08c8010a00f0a2040000"},
    {"moment",
     {.kind = ST_RECORD_MOMENT,
      .number = 11,
      .revision = 7,
      .metadata = 3,
      .named = 5,
      .moment = "before the c\xc3\xbct",
      .reach = 2,
      .time = 1700000003,
      .ops = "",
      .issued = {[HE_VERTEX] = 9, [HE_HALFEDGE] = 400, [HE_EDGE] = 200, [HE_FACE] = 11},
      .counts = {8, 200, 10, 0},
      .bytes = 70000},
     "310e718b020700000b000000000000000700000000000000efcdab89674523010000c040fc54d941"
     "03050509c8010b08c8010a00f0a204000f6265666f7265207468652063c3bc74"},
};
enum { SPECIMENS = sizeof specimens / sizeof *specimens, ROOM = ST_FRAME_HEAD + 64 };

static size_t frame_of(const st_record *record, uint64_t chain, unsigned char frame[ROOM])
{
    memset(frame, 0xee, ROOM);
    size_t size = st_frame_write(record, frame);
    assert_true(size <= ST_FRAME_HEAD + record->body_size);
    st_frame_seal(frame, size, chain);
    return size;
}

static void assert_record(const st_record *a, const st_record *b)
{
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->barrier, b->barrier);
    assert_true(a->number == b->number && a->revision == b->revision);
    assert_true(a->metadata == b->metadata && a->inverts == b->inverts && a->reach == b->reach);
    assert_true(a->time == b->time && a->bytes == b->bytes);
    assert_string_equal(a->ops, b->ops);
    if (a->kind == ST_RECORD_MOMENT) {
        assert_string_equal(a->moment, b->moment);
    } else {
        assert_null(a->moment);
        assert_string_equal(a->name, b->name == NULL ? "" : b->name);
    }
    assert_true(a->named == b->named);
    assert_memory_equal(a->issued, b->issued, sizeof a->issued);
    assert_memory_equal(&a->counts, &b->counts, sizeof a->counts);
    assert_int_equal(a->tally.known, b->tally.known);
    assert_memory_equal(a->tally.created, b->tally.created, sizeof a->tally.created);
    assert_memory_equal(a->tally.deleted, b->tally.deleted, sizeof a->tally.deleted);
    assert_memory_equal(a->tally.modified, b->tally.modified, sizeof a->tally.modified);
    assert_int_equal(a->staged_edit, b->staged_edit);
    assert_int_equal(a->body_size, b->body_size);
    assert_memory_equal(a->body, b->body == NULL ? body : b->body, a->body_size);
}

static void what_was_written_is_read_again(void **state)
{
    (void)state;
    for (size_t i = 0; i < SPECIMENS; i++) {
        unsigned char bytes[ROOM];
        st_frame frame;
        size_t size = frame_of(&specimens[i].record, CHAIN, bytes);
        assert_int_equal(st_frame_read(bytes, size, &frame, NULL), HE_OK);
        assert_true(frame.chain == CHAIN);
        assert_int_equal(frame.in_parts, specimens[i].record.stage != NULL);
        assert_null(frame.record.stage);
        assert_record(&frame.record, &specimens[i].record);
    }
}

static void a_version_always_has_these_bytes(void **state)
{
    (void)state;
    for (size_t i = 0; i < SPECIMENS; i++) {
        unsigned char bytes[ROOM];
        char hex[2 * ROOM + 1];
        size_t size = frame_of(&specimens[i].record, CHAIN, bytes);
        for (size_t k = 0; k < size; k++) {
            (void)snprintf(hex + 2 * k, 3, "%02x", bytes[k]);
        }
        assert_string_equal(hex, specimens[i].golden);
    }
}

static void texts_are_cut_where_they_are_too_long(void **state)
{
    (void)state;
    char text[400];
    unsigned char bytes[ROOM];
    st_frame frame;
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    st_record record = specimens[3].record;
    record.ops = record.name = text;
    record.tally.known = true;
    size_t size = frame_of(&record, CHAIN, bytes);
    assert_int_equal(st_frame_read(bytes, size, &frame, NULL), HE_OK);
    assert_int_equal(strlen(frame.record.ops), ST_FRAME_OPS);
    assert_int_equal(strlen(frame.record.name), ST_MESH_NAME);
    st_record moment = specimens[SPECIMENS - 1].record;
    moment.moment = text;
    size = frame_of(&moment, CHAIN, bytes);
    assert_int_equal(st_frame_read(bytes, size, &frame, NULL), HE_OK);
    assert_int_equal(strlen(frame.record.moment), ST_MOMENT_NAME);
}

static void a_cut_or_a_flipped_bit_is_refused(void **state)
{
    (void)state;
    unsigned refused = 0;
    for (size_t i = 0; i < SPECIMENS; i++) {
        unsigned char bytes[ROOM];
        size_t size = frame_of(&specimens[i].record, CHAIN, bytes);
        for (size_t n = 0; n < 9 * size; n++) {
            size_t cut = n < size ? n : size, bit = n - size;
            /* a block that ends with the record, so that a sanitizer detects reads past the end */
            unsigned char *exact = malloc(cut + 1);
            memcpy(exact + 1, bytes, cut);
            if (n >= size) {
                exact[1 + bit / 8] ^= (unsigned char)(1u << bit % 8);
            }
            st_frame frame;
            he_error err = {.status = HE_OK};
            assert_int_equal(st_frame_read(exact + 1, cut, &frame, &err), HE_CORRUPT);
            assert_int_equal(err.place, HE_PLACE_BYTE);
            assert_true(err.at <= size && err.text[0] != '\0');
            free(exact);
            refused++;
        }
    }
    printf("note: %u damaged records: all refused\n", refused);
}

/* Changes a byte of a record, corrects the checksum and reads the record. Damage that a checksum
 * does not detect gives the reader such a record. */
static he_status read_resealed(const st_record *record, size_t at, unsigned value, he_error *err)
{
    unsigned char bytes[ROOM];
    st_frame frame;
    size_t size = frame_of(record, CHAIN, bytes);
    bytes[at] = (unsigned char)value;
    st_frame_seal(bytes, size, CHAIN);
    return st_frame_read(bytes, size, &frame, err);
}

static void what_no_release_wrote_is_refused_by_name(void **state)
{
    (void)state;
    const st_record *edit = &specimens[0].record;
    he_error err = {.status = HE_OK};
    const st_record *moment = &specimens[SPECIMENS - 1].record;
    assert_int_equal(read_resealed(edit, 4, 3, &err), HE_UNSUPPORTED);
    assert_non_null(strstr(err.text, "version 3"));
    assert_non_null(strstr(err.text, "version 2"));
    assert_int_equal(read_resealed(edit, 4, 2, &err), HE_CORRUPT); /* version 2 only names */
    assert_int_equal(read_resealed(moment, 4, 1, &err), HE_CORRUPT);
    assert_int_equal(read_resealed(edit, 4, 0, &err), HE_CORRUPT);
    assert_int_equal(read_resealed(edit, 5, 0, &err), HE_CORRUPT);
    assert_int_equal(read_resealed(edit, 5, 7, &err), HE_CORRUPT);
    assert_int_equal(read_resealed(moment, 5, 8, &err), HE_CORRUPT);
    assert_int_equal(read_resealed(edit, 6, 8, &err), HE_CORRUPT);
    assert_int_equal(read_resealed(edit, 6, 2 | 4, &err), HE_CORRUPT);          /* parts and body */
    assert_int_equal(read_resealed(edit, 5, ST_RECORD_UNDO, &err), HE_CORRUPT); /* a body */
    assert_int_equal(read_resealed(edit, 8, 0, &err), HE_CORRUPT);              /* number 0 */
    assert_int_equal(read_resealed(edit, 16, 0, &err), HE_CORRUPT);             /* revision 0 */
    assert_int_equal(read_resealed(&specimens[6].record, 6, 4, &err), HE_CORRUPT); /* no content */
    assert_int_equal(read_resealed(edit, 4, 1, &err), HE_OK);
}

static void the_chain_covers_all_that_came_before(void **state)
{
    (void)state;
    unsigned char first[ROOM], second[ROOM];
    size_t size = st_frame_write(&specimens[3].record, first);
    uint64_t origin = 12345, chain = st_chain_of_origin(origin);
    assert_true(chain != st_chain_of_origin(origin + 1));
    uint64_t next = st_frame_seal(first, size, chain);
    assert_true(next == st_frame_next_chain(first, size));
    assert_true(next != chain);
    /* Two meshes have different origins, from which the checksums of their records continue: equal
     * records of the two meshes must therefore have different checksums. */
    memcpy(second, first, size);
    assert_true(st_frame_seal(second, size, st_chain_of_origin(origin + 1)) != next);
}

/* The expected values are those of RFC 3720, B.4. Both implementations of the checksum must give
 * these values. */
static void checksums_are_those_of_the_standard(void **state)
{
    (void)state;
    unsigned char bytes[64] = {0};
    assert_int_equal(st_crc32c(0, "123456789", 9), 0xe3069283);
    assert_int_equal(st_crc32c(0, bytes, 32), 0x8a9136aa);
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (unsigned char)i;
    }
    assert_int_equal(st_crc32c(0, bytes, 32), 0x46dd794e);
    for (size_t size = 0; size <= sizeof bytes; size++) {
        uint32_t whole = st_crc32c(0, bytes, size);
        assert_int_equal(whole, st_crc32c_by_table(0, bytes, size));
        for (size_t cut = 0; cut <= size; cut++) {
            assert_int_equal(st_crc32c(st_crc32c(0, bytes, cut), bytes + cut, size - cut), whole);
        }
    }
}

static int write_seeds(const char *folder)
{
    bool good = true;
    for (size_t i = 0; i < SPECIMENS && good; i++) {
        char path[256];
        unsigned char bytes[ROOM];
        (void)snprintf(path, sizeof path, "%s/%s", folder, specimens[i].name);
        FILE *file = fopen(path, "wb");
        size_t size = frame_of(&specimens[i].record, CHAIN, bytes);
        good = file != NULL && fwrite(bytes, 1, size, file) == size;
        good = file != NULL && fclose(file) == 0 && good;
    }
    return good ? 0 : 1;
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "--write") == 0) {
        return write_seeds(argv[2]);
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_written_is_read_again),
        cmocka_unit_test(a_version_always_has_these_bytes),
        cmocka_unit_test(texts_are_cut_where_they_are_too_long),
        cmocka_unit_test(a_cut_or_a_flipped_bit_is_refused),
        cmocka_unit_test(what_no_release_wrote_is_refused_by_name),
        cmocka_unit_test(the_chain_covers_all_that_came_before),
        cmocka_unit_test(checksums_are_those_of_the_standard),
    };
    return cmocka_run_group_tests_name("record_bytes", tests, NULL, NULL);
}
