/* Tests of compressing the parts of mesh data with zstd: decompressing must restore the parts
 * unchanged; a damaged part must be refused, without taking more memory than a part may have. */
#include "journal/part_packing.h"
#include "tests/unit/dense.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"

#include "stored/stored.h"
#include "tests/failing.h"
#include "tests/model/random.h"

#include <string.h>
#include <zstd.h>

static unsigned char plain[HE_STORED_PART_ROOM], packed[HE_STORED_PART_ROOM];

/* Writes the first part of a mesh with many faces to `plain`, compresses it to `packed`, and
 * returns the uncompressed size. */
static size_t make_part(unsigned *coding)
{
    he_mesh *mesh = dense_grid(64, NULL, 1);
    he_stored_writer writer;
    he_stored_writer_init(&writer, mesh);
    const size_t size = he_stored_writer_next(&writer, plain, coding);
    he_mesh_free(mesh);
    memcpy(packed, plain, size);
    return size;
}

static void a_part_comes_back_as_it_was(void **state)
{
    (void)state;
    unsigned coding, before;
    const size_t size = make_part(&before);
    st_packer *packer = st_packer_new();
    st_unpacker *unpacker = st_unpacker_new();
    for (int again = 0; again < 2; again++) {
        st_part out = {0};
        const char *why;
        coding = before;
        memcpy(packed, plain, size);
        const size_t less = st_part_pack(packer, packed, size, &coding);
        assert_true(less < size / 2);
        assert_int_equal(coding, before | HE_CODING_PACKED);
        assert_int_equal(st_part_unpack(unpacker, (st_part){packed, less}, &out, &why), ST_OK);
        assert_int_equal(out.size, size);
        assert_memory_equal(out.bytes, plain, size);
    }
    st_packer_free(packer);
    st_unpacker_free(unpacker);
}

static void what_does_not_get_shorter_stays_as_it_is(void **state)
{
    (void)state;
    md_random random = {7};
    unsigned coding = HE_CODING_PLAIN;
    for (size_t i = 0; i < sizeof plain; i++) {
        plain[i] = (unsigned char)md_below(&random, 256);
    }
    memcpy(packed, plain, sizeof plain);
    st_packer *packer = st_packer_new();
    assert_int_equal(st_part_pack(packer, packed, sizeof packed, &coding), sizeof packed);
    assert_int_equal(coding, HE_CODING_PLAIN);
    assert_memory_equal(packed, plain, sizeof plain);
    assert_int_equal(st_part_pack(packer, packed, 1, &coding), 1);
    st_packer_free(packer);
    const size_t size = make_part(&coding);
    const unsigned before = coding;
    assert_int_equal(st_part_pack(NULL, packed, size, &coding), size);
    assert_int_equal(coding, before);
}

static void expect_refused(const void *bytes, size_t size, const char *reason)
{
    st_part out = {0};
    const char *why = "";
    st_unpacker *unpacker = st_unpacker_new();
    assert_int_equal(st_part_unpack(unpacker, (st_part){bytes, size}, &out, &why), ST_DAMAGED);
    assert_non_null(strstr(why, reason));
    st_unpacker_free(unpacker);
}

static void what_would_be_longer_than_a_part_is_refused(void **state)
{
    (void)state;
    enum { LARGE = 8 << 20 };
    unsigned char *zeros = test_calloc(1, LARGE), bomb[1024];
    const size_t size = ZSTD_compress(bomb, sizeof bomb, zeros, LARGE, 1);
    assert_false(ZSTD_isError(size));
    expect_refused(bomb, size, "more bytes than a part may have");
    test_free(zeros);
    expect_refused("", 0, "not a zstd frame");
    expect_refused("not a frame at all", 18, "not a zstd frame");
}

/* A compressed part with a changed byte must either be refused with a reason or decompress to at
 * most the size that a part may have. */
static void a_damaged_part_stays_within_its_room(void **state)
{
    (void)state;
    unsigned coding;
    const size_t size = make_part(&coding);
    st_packer *packer = st_packer_new();
    st_unpacker *unpacker = st_unpacker_new();
    const size_t less = st_part_pack(packer, packed, size, &coding);
    unsigned refused = 0;
    for (size_t i = 0; i < less; i += less / 500 + 1) {
        st_part out = {0};
        const char *why = "";
        packed[i] ^= (unsigned char)(1 << i % 8);
        st_status status = st_part_unpack(unpacker, (st_part){packed, less}, &out, &why);
        assert_true(status == ST_OK ? out.size <= HE_STORED_PART_ROOM
                                    : status == ST_DAMAGED && why[0] != '\0');
        packed[i] ^= (unsigned char)(1 << i % 8);
        status = st_part_unpack(unpacker, (st_part){packed, i}, &out, &why);
        assert_int_equal(status, ST_DAMAGED); /* a truncated part must be refused */
        refused++;
    }
    assert_true(refused > 100);
    st_packer_free(packer);
    st_unpacker_free(unpacker);
}

static void without_memory_parts_stay_as_they_are(void **state)
{
    (void)state;
    unsigned coding;
    const size_t size = make_part(&coding);
    const unsigned before = coding;
    failing f = {0};
    while (failing_next(&f)) {
        coding = before;
        memcpy(packed, plain, size);
        st_packer *packer = st_packer_new();
        const size_t less = st_part_pack(packer, packed, size, &coding);
        const bool is_packed = failing_end(&f, coding != before);
        assert_true(is_packed ? less < size : less == size);
        st_packer_free(packer);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_comes_back_as_it_was),
        cmocka_unit_test(what_does_not_get_shorter_stays_as_it_is),
        cmocka_unit_test(what_would_be_longer_than_a_part_is_refused),
        cmocka_unit_test(a_damaged_part_stays_within_its_room),
        cmocka_unit_test(without_memory_parts_stay_as_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
