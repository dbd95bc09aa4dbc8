/* Random bodies compressed by api/header/compressor.h must come back from other decompressors, and
 * be compressed to the same bytes however they are read: the entity tags of answers are strong. */
#include "api/header/compressor.h"

#include "fixture.h"
#include "tests/codings.h"
#include "tests/model/random.h"
#include "tests/seed.h"

enum { LONGEST = 2000000, SHORT = 150000, WORDS = 2000 };

typedef struct body {
    size_t length, at; /* `at`: how many bytes were read */
    size_t step;       /* the most bytes that one read returns */
    char bytes[LONGEST];
} body;

static body plain;
static char words[WORDS], coded[2][LONGEST + LONGEST / 4];

static int64_t read_body(void *context, char *buffer, size_t size)
{
    body *b = context;
    const size_t left = b->length - b->at, most = left < size ? left : size;
    const size_t got = most < b->step ? most : b->step;
    memcpy(buffer, b->bytes + b->at, got);
    b->at += got;
    return (int64_t)got;
}

/* Fills `plain` with random runs: of one byte, of noise, of the bytes before the run, and of
 * text. */
static void fill_plain(md_random *random)
{
    size_t at = 0;
    plain.length = md_below(random, md_chance(random, 25) ? LONGEST : SHORT);
    while (at < plain.length) {
        const size_t left = plain.length - at, most = md_chance(random, 25) ? 100000 : 300;
        const size_t run = 1 + md_below(random, (uint32_t)(left < most ? left : most));
        const uint32_t kind = md_below(random, 4);
        const char one = (char)md_below(random, 256);
        for (size_t i = 0; i < run; i++, at++) {
            plain.bytes[at] = kind == 0               ? one
                              : kind == 1 || at < run ? (char)md_below(random, 256)
                              : kind == 2             ? plain.bytes[at - run]
                                                      : words[i % WORDS];
        }
    }
}

/* Compresses `plain`, which is read in pieces of at most `step` bytes, or at once if `step` is 0,
 * to `out` in pieces of at most `size` bytes. Returns the length of the compressed body. */
static size_t pack(api_coding coding, size_t step, size_t size, char *out)
{
    const char *whole;
    size_t length, total = 0;
    int64_t got;
    plain.at = 0;
    plain.step = step;
    api_compressor *compressor = api_compressor_new(
        coding, step == 0 ? &(api_plain){.bytes = plain.bytes, .length = plain.length}
                          : &(api_plain){.read = read_body, .context = &plain});
    assert_non_null(compressor);
    (void)api_compressor_whole(compressor, &whole, &length);
    assert_true(api_compressor_begin(compressor));
    while ((got = api_compressor_read(
                compressor, out + total,
                size < sizeof coded[0] - total ? size : sizeof coded[0] - total)) > 0) {
        total += (size_t)got;
    }
    assert_int_equal(got, 0);
    api_compressor_free(compressor);
    return total;
}

static void random_bodies_come_back(void **state)
{
    (void)state;
    enum { ROUNDS = 40 };
    const uint64_t rounds = seed_setting("ROUNDS", ROUNDS);
    md_random random = {seed_of_run()};
    for (size_t i = 0; i < WORDS; i++) {
        words[i] = "v 0.123456789 e+-\n"[md_below(&random, 18)];
    }
    for (uint64_t round = 0; round < rounds; round++) {
        fill_plain(&random);
        for (api_coding coding = 0; coding < API_IDENTITY; coding++) {
            size_t length, first = pack(coding, 0, sizeof coded[0], coded[0]);
            const size_t again = pack(coding, 1 + md_below(&random, 100000),
                                      1 + md_below(&random, 100000), coded[1]);
            assert_int_equal(again, first);
            assert_memory_equal(coded[1], coded[0], first);
            char *back = coding_unpack(api_coding_name(coding), coded[0], first, &length);
            assert_non_null(back);
            assert_int_equal(length, plain.length);
            assert_memory_equal(back, plain.bytes, length);
            free(back);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_bodies_come_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
