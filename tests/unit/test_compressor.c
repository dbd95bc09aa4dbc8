/* Bodies compressed by gzip and zstd: api/header/compressor.h compresses them,
 * api/header/decompressor.h decompresses or refuses them. */
#include "tests/unit/fixture.h"

#include "api/header/compressor.h"
#include "api/header/decompressor.h"
#include "api/limits.h"
#include "tests/failing.h"

#include <zstd.h>

typedef struct bytes {
    char *data;
    size_t length, capacity;
} bytes;

static void add(bytes *b, const void *data, size_t length)
{
    if (b->length + length > b->capacity) {
        b->capacity = 2 * (b->length + length);
        b->data = realloc(b->data, b->capacity);
        assert_non_null(b->data);
    }
    if (length > 0) {
        memcpy(b->data + b->length, data, length);
    }
    b->length += length;
}

static bool take(void *context, const char *data, size_t length)
{
    assert_true(length > 0 && length <= API_DECOMPRESS_PIECE);
    add(context, data, length);
    return true;
}

/* Returns a text of numbers that resembles a mesh file; it compresses to about a third of its
 * length. */
static bytes text_of(size_t length)
{
    bytes b = {0};
    uint32_t random = 1;
    while (b.length < length) {
        char line[80];
        random = random * 1664525 + 1013904223;
        size_t n = (size_t)snprintf(line, sizeof line, "v %u.%u 0.5 1\n", random >> 28,
                                    random >> 20 & 255);
        add(&b, line, n < length - b.length ? n : length - b.length);
    }
    return b;
}

/* A source from which the compressor reads the bytes of `of`, at most `step` bytes in each call. */
typedef struct source {
    const bytes *of;
    size_t at, step;
} source;

static int64_t read_source(void *context, char *buffer, size_t size)
{
    source *s = context;
    size_t left = s->of->length - s->at, n = left < size ? left : size;
    n = n < s->step ? n : s->step;
    if (n > 0) {
        memcpy(buffer, s->of->data + s->at, n);
    }
    s->at += n;
    return (int64_t)n;
}

/* Reads the whole output of the compressor, at most `size` bytes in each call. */
static bytes pull(api_compressor *compressor, size_t size)
{
    bytes out = {0};
    char *buffer = malloc(size);
    assert_non_null(buffer);
    int64_t got;
    while ((got = api_compressor_read(compressor, buffer, size)) > 0) {
        add(&out, buffer, (size_t)got);
    }
    assert_int_equal(got, 0);
    free(buffer);
    return out;
}

static bytes pack_bytes(api_coding coding, const bytes *plain)
{
    api_plain from = {.bytes = plain->data == NULL ? "" : plain->data, .length = plain->length};
    const char *whole;
    size_t length;
    api_compressor *compressor = api_compressor_new(coding, &from);
    assert_non_null(compressor);
    bool is_whole = api_compressor_whole(compressor, &whole, &length);
    assert_int_equal(is_whole, plain->length <= API_COMPRESS_AT_ONCE);
    if (is_whole) {
        assert_int_equal(length, plain->length);
        assert_memory_equal(whole, from.bytes, length);
    }
    assert_true(api_compressor_begin(compressor));
    bytes out = pull(compressor, 65536);
    api_compressor_free(compressor);
    return out;
}

/* The largest number of bytes by which one call of the decompressor may exceed its limit
 * API_DECOMPRESS_TURN: a block of zstd, or what zlib has buffered. */
enum { LEFT = 1 << 17 };

/* Decompresses a body that arrives in pieces of `step` bytes. If the decompressor refuses the body,
 * sets `problem` and returns false. */
static bool unfold(api_coding coding, const bytes *coded, size_t step, bytes *out,
                   api_problem *problem)
{
    *problem = (api_problem){0};
    *out = (bytes){0};
    static api_decompressor_room room;
    api_decompressor *u = api_decompressor_new(coding, &room, take, out, problem);
    assert_non_null(u);
    bool good = true;
    for (size_t at = 0, used; at < coded->length && good; at += used) {
        size_t n = coded->length - at < step ? coded->length - at : step;
        /* each piece is in a block of its own, so that a sanitizer detects reads beyond the end of
         * the piece */
        char *piece = malloc(n);
        assert_non_null(piece);
        memcpy(piece, coded->data + at, n);
        size_t before = out->length;
        used = 0;
        good = api_decompressor_feed(u, piece, n, &used, problem);
        assert_true(!good || used == n || out->length >= before + API_DECOMPRESS_TURN);
        assert_true(out->length <= before + API_DECOMPRESS_TURN + LEFT);
        free(piece);
    }
    good = good && api_decompressor_end(u, problem);
    assert_int_equal(good, problem->code == HE_OK);
    assert_true(room.lent > 0);
    api_decompressor_free(u);
    assert_int_equal(room.lent, 0);
    return good;
}

static void expect_unfolded(api_coding coding, const bytes *coded, size_t step, const bytes *plain)
{
    bytes out;
    api_problem problem;
    if (!unfold(coding, coded, step, &out, &problem)) {
        fail_msg("%s of %zu bytes by %zu: %s", api_coding_name(coding), plain->length, step,
                 problem.detail);
    }
    assert_int_equal(out.length, plain->length);
    if (out.length > 0) {
        assert_memory_equal(out.data, plain->data, out.length);
    }
    free(out.data);
}

static void expect_refused(api_coding coding, const bytes *coded, size_t step, int code,
                           const char *detail)
{
    bytes out;
    api_problem problem;
    assert_false(unfold(coding, coded, step, &out, &problem));
    if (problem.code != code || strstr(problem.detail, detail) == NULL) {
        fail_msg("not %s: %s", detail, problem.detail);
    }
    free(out.data);
}

static const api_coding both[] = {API_GZIP, API_ZSTD};

static void bodies_of_all_sizes_come_back(void **state)
{
    (void)state;
    static const size_t sizes[] = {0, 1, 2, 255, 256, 257, 5000, 65536, 65537, 400000};
    static const size_t steps[] = {1, 2, 3, 7, 1000, 32768, 1 << 20};
    for (size_t c = 0; c < 2; c++) {
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            bytes plain = text_of(sizes[i]), coded = pack_bytes(both[c], &plain);
            assert_true(plain.length < 5000 || coded.length < plain.length / 2);
            for (size_t k = 0; k < sizeof steps / sizeof *steps; k++) {
                expect_unfolded(both[c], &coded, steps[k], &plain);
            }
            free(plain.data);
            free(coded.data);
        }
    }
}

/* Compressed answers have strong entity tags (the bytes are equal if the tags are), so the sizes of
 * the reads must not influence the compressed bytes. */
static void the_same_body_packs_to_the_same_bytes(void **state)
{
    (void)state;
    static const size_t steps[] = {1, 100, 4096, 70000, 1 << 20};
    bytes plain = text_of(300000);
    for (size_t c = 0; c < 2; c++) {
        bytes first = pack_bytes(both[c], &plain);
        for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
            source from = {&plain, 0, steps[i]};
            const char *whole;
            size_t length;
            api_compressor *compressor =
                api_compressor_new(both[c], &(api_plain){.read = read_source, .context = &from});
            assert_non_null(compressor);
            assert_false(api_compressor_whole(compressor, &whole, &length));
            assert_true(api_compressor_begin(compressor));
            bytes again = pull(compressor, steps[sizeof steps / sizeof *steps - 1 - i]);
            assert_int_equal(again.length, first.length);
            assert_memory_equal(again.data, first.data, first.length);
            free(again.data);
            api_compressor_free(compressor);
        }
        free(first.data);
    }
    free(plain.data);
}

static int64_t break_off(void *context, char *buffer, size_t size)
{
    int *left = context;
    memset(buffer, 'x', size);
    return (*left)-- > 0 ? (int64_t)size : -1;
}

typedef struct nothing {
    /* `left`: how many zeros are still to be read; `read`: how many were read during the present
     * call of the compressor */
    size_t left, read;
} nothing;

static int64_t read_zeros(void *context, char *buffer, size_t size)
{
    nothing *z = context;
    size_t n = z->left < size ? z->left : size;
    memset(buffer, 0, n);
    z->left -= n;
    z->read += n;
    return (int64_t)n;
}

/* A call that reads compressed bytes may process only a limited amount of input, however well that
 * input compresses, because other requests wait during the call. */
static void no_read_codes_more_than_its_turn(void **state)
{
    (void)state;
    static char room[128 * 1024];
    for (size_t c = 0; c < 2; c++) {
        nothing from = {.left = 100 << 20};
        size_t most = 0, turns = 0, total = 0;
        int64_t got;
        api_compressor *compressor =
            api_compressor_new(both[c], &(api_plain){.read = read_zeros, .context = &from});
        assert_non_null(compressor);
        assert_true(api_compressor_begin(compressor));
        while ((got = api_compressor_read(compressor, room, sizeof room)) > 0) {
            most = from.read > most ? from.read : most;
            from.read = 0;
            total += (size_t)got;
            turns++;
        }
        assert_int_equal(got, 0);
        assert_int_equal(from.left, 0);
        printf("note: %s: %zu reads of at most %zu KiB of zeros gave %zu bytes\n",
               api_coding_name(both[c]), turns, most / 1024, total);
        size_t held = both[c] == API_GZIP ? 4u << 20 : 0;
        assert_true(most <= API_COMPRESS_TURN + held + 2 * (API_COMPRESS_AT_ONCE + 1));
        api_compressor_free(compressor);
    }
}

static void a_body_that_breaks_off_is_not_ended(void **state)
{
    (void)state;
    for (size_t c = 0; c < 2; c++) {
        for (int pieces = 0; pieces < 4; pieces++) {
            int left = pieces;
            char buffer[1000];
            const char *whole;
            size_t length;
            api_compressor *compressor =
                api_compressor_new(both[c], &(api_plain){.read = break_off, .context = &left});
            assert_non_null(compressor);
            assert_false(api_compressor_whole(compressor, &whole, &length) && pieces > 0);
            assert_true(api_compressor_begin(compressor));
            int64_t got;
            while ((got = api_compressor_read(compressor, buffer, sizeof buffer)) > 0) {
            }
            assert_int_equal(got, -1);
            api_compressor_free(compressor);
        }
    }
}

static void what_cannot_be_coded_is_passed_on(void **state)
{
    (void)state;
    bytes plain = text_of(200000);
    source from = {&plain, 0, 1000};
    const char *whole;
    size_t length;
    api_compressor *compressor =
        api_compressor_new(API_GZIP, &(api_plain){.read = read_source, .context = &from});
    assert_non_null(compressor);
    assert_false(api_compressor_whole(compressor, &whole, &length));
    api_compressor_give_up(compressor);
    bytes out = pull(compressor, 777);
    assert_int_equal(out.length, plain.length);
    assert_memory_equal(out.data, plain.data, out.length);
    api_compressor_free(compressor);
    free(out.data);
    free(plain.data);
}

/* Adds a skippable frame of zstd: a magic number, a length, and `length` bytes that have no
 * meaning. */
static void add_skippable(bytes *b, uint32_t length)
{
    const unsigned char head[8] = {
        0x5A, 0x2A, 0x4D, 0x18, (unsigned char)length, (unsigned char)(length >> 8), 0, 0};
    add(b, head, sizeof head);
    for (uint32_t i = 0; i < length; i++) {
        add(b, "!", 1);
    }
}

static void members_and_frames_follow_one_another(void **state)
{
    (void)state;
    for (size_t c = 0; c < 2; c++) {
        bytes plain = {0}, coded = {0};
        for (size_t i = 0; i < 5; i++) {
            bytes part = text_of(i * 700), packed = pack_bytes(both[c], &part);
            if (both[c] == API_ZSTD) {
                add_skippable(&coded, (uint32_t)(i * 100));
            }
            add(&plain, part.data, part.length);
            add(&coded, packed.data, packed.length);
            free(part.data);
            free(packed.data);
        }
        if (both[c] == API_ZSTD) {
            add_skippable(&coded, 3);
        }
        for (size_t step = 1; step < 40; step++) {
            expect_unfolded(both[c], &coded, step, &plain);
        }
        free(plain.data);
        free(coded.data);
    }
}

static void a_body_that_ends_too_early_is_refused_wherever(void **state)
{
    (void)state;
    bytes plain = text_of(3000);
    for (size_t c = 0; c < 2; c++) {
        bytes coded = pack_bytes(both[c], &plain);
        for (size_t length = 1; length < coded.length; length++) {
            char place[40];
            snprintf(place, sizeof place, "byte %zu of the %s body", length,
                     api_coding_name(both[c]));
            expect_refused(both[c], &(bytes){coded.data, length, 0}, 1000, API_BAD_ENCODING, place);
        }
        free(coded.data);
    }
    free(plain.data);
}

static void what_follows_the_coding_is_refused_at_its_byte(void **state)
{
    (void)state;
    bytes plain = text_of(3000);
    for (size_t c = 0; c < 2; c++) {
        bytes coded = pack_bytes(both[c], &plain);
        char place[80];
        const char *name = api_coding_name(both[c]);
        snprintf(place, sizeof place, "byte %zu of the %s body: the bytes are not in %s format",
                 coded.length, name, name);
        add(&coded, "garbage", 7);
        for (size_t step = 1; step < 12; step++) {
            expect_refused(both[c], &coded, step, API_BAD_ENCODING, place);
        }
        free(coded.data);
    }
    free(plain.data);
}

/* Flips each bit of a compressed body in turn: the body must then be refused or, if the bit has no
 * meaning, be decompressed to the same bytes as before. */
static void no_flipped_bit_gives_another_body(void **state)
{
    (void)state;
    bytes plain = text_of(600);
    for (size_t c = 0; c < 2; c++) {
        bytes coded = pack_bytes(both[c], &plain);
        size_t refused = 0;
        for (size_t bit = 0; bit < 8 * coded.length; bit++) {
            bytes out;
            api_problem problem;
            coded.data[bit / 8] = (char)(coded.data[bit / 8] ^ 1 << bit % 8);
            if (unfold(both[c], &coded, 64, &out, &problem)) {
                assert_int_equal(out.length, plain.length);
                assert_memory_equal(out.data, plain.data, out.length);
            } else {
                assert_true(problem.code == API_BAD_ENCODING || problem.code == API_BODY_TOO_LARGE);
                refused++;
            }
            free(out.data);
            coded.data[bit / 8] = (char)(coded.data[bit / 8] ^ 1 << bit % 8);
        }
        assert_true(refused > 8 * coded.length - 8 * 10);
        free(coded.data);
    }
    free(plain.data);
}

static void a_checksum_that_does_not_hold_is_named(void **state)
{
    (void)state;
    bytes plain = text_of(3000);
    bytes gzip = pack_bytes(API_GZIP, &plain), zstd = pack_bytes(API_ZSTD, &plain);
    /* changes one bit of the gzip checksum, which is followed only by the length in the last four
     * bytes */
    gzip.data[gzip.length - 8] ^= 1;
    expect_refused(API_GZIP, &gzip, 100, API_BAD_ENCODING, "incorrect data check");
    gzip.data[gzip.length - 8] ^= 1;
    gzip.data[gzip.length - 1] ^= 1;
    expect_refused(API_GZIP, &gzip, 100, API_BAD_ENCODING, "incorrect length check");
    zstd.data[zstd.length - 1] ^= 1;
    char place[40];
    snprintf(place, sizeof place, "byte %zu of", zstd.length - 4);
    expect_refused(API_ZSTD, &zstd, 1 << 20, API_BAD_ENCODING, place);
    free(plain.data);
    free(gzip.data);
    free(zstd.data);
}

static void other_codings_are_not_taken_for_these(void **state)
{
    (void)state;
    static const char zlib[] = "x\x9c\x03\x00\x00\x00\x00\x01"; /* data in the coding "deflate" */
    static const char old[] = "\x27\xB5\x2F\xFD\x00\x00\x00";   /* magic number of zstd 0.7 */
    static const char plain[] = "{\"shape\":\"cube\"}";
    bytes empty = {0}, gzip = pack_bytes(API_GZIP, &empty), zstd = pack_bytes(API_ZSTD, &empty);
    expect_refused(API_GZIP, &(bytes){(char *)(uintptr_t)zlib, 8, 0}, 8, API_BAD_ENCODING,
                   "byte 0 of the gzip body: the bytes are not in gzip format");
    expect_refused(API_ZSTD, &(bytes){(char *)(uintptr_t)old, 7, 0}, 7, API_BAD_ENCODING,
                   "byte 0 of the zstd body: the bytes are not in zstd format");
    expect_refused(API_GZIP, &(bytes){(char *)(uintptr_t)plain, 16, 0}, 1, API_BAD_ENCODING,
                   "byte 0");
    expect_refused(API_ZSTD, &(bytes){(char *)(uintptr_t)plain, 16, 0}, 1, API_BAD_ENCODING,
                   "byte 0");
    expect_refused(API_GZIP, &zstd, 100, API_BAD_ENCODING, "byte 0");
    expect_refused(API_ZSTD, &gzip, 100, API_BAD_ENCODING, "byte 0");
    free(gzip.data);
    free(zstd.data);
}

static bytes zeros_in(api_coding coding, size_t length)
{
    bytes zeros = {calloc(1, length), length, length};
    assert_non_null(zeros.data);
    bytes coded = pack_bytes(coding, &zeros);
    free(zeros.data);
    return coded;
}

static void a_bomb_is_refused_before_it_unfolds(void **state)
{
    (void)state;
    for (size_t c = 0; c < 2; c++) {
        bytes most = {calloc(1, API_DECOMPRESS_FREE), API_DECOMPRESS_FREE, API_DECOMPRESS_FREE},
              out;
        bytes small = pack_bytes(both[c], &most), bomb = zeros_in(both[c], 200 << 20);
        /* a body that grows to at most API_DECOMPRESS_FREE bytes is accepted at any ratio between
         * decompressed and compressed size */
        expect_unfolded(both[c], &small, 1000, &most);
        for (size_t step = 100; step <= 10000; step *= 10) {
            api_problem problem;
            assert_false(unfold(both[c], &bomb, step, &out, &problem));
            assert_int_equal(problem.code, API_BODY_TOO_LARGE);
            assert_true(out.length <= API_DECOMPRESS_FREE + API_DECOMPRESS_RATIO * 10000);
            free(out.data);
        }
        free(most.data);
        free(small.data);
        free(bomb.data);
    }
}

/* Returns random bytes, which cannot be compressed, followed by zeros. */
static bytes noise_and_zeros(size_t noise, size_t zeros)
{
    bytes out = {malloc(noise + zeros), noise + zeros, noise + zeros};
    uint64_t random = 1;
    assert_non_null(out.data);
    memset(out.data, 0, out.length);
    for (size_t i = 0; i < noise; i++) {
        random = random * UINT64_C(6364136223846793005) + 1442695040888963407u;
        out.data[i] = (char)(random >> 56);
    }
    return out;
}

/* A body may become at most a certain multiple of its compressed size. Data that does not belong to
 * the present gzip member or zstd frame, such as comments and earlier members or frames, must not
 * raise this limit. */
static void only_compressed_data_lets_a_body_unfold(void **state)
{
    (void)state;
    enum { COMMENT = 400000, ZEROS = 20 << 20 };
    for (size_t c = 0; c < 2; c++) {
        bytes noise = noise_and_zeros(COMMENT, 0), bomb = zeros_in(both[c], ZEROS);
        bytes named = {0}, after = pack_bytes(both[c], &noise);
        if (both[c] == API_GZIP) {
            static const unsigned char head[10] = {0x1F, 0x8B, 8, 0x10, 0, 0, 0, 0, 0, 3};
            add(&named, head, sizeof head);
            for (size_t i = 0; i < COMMENT; i++) {
                add(&named, "c", 1);
            }
            add(&named, "", 1);
            add(&named, bomb.data + 10, bomb.length - 10);
        } else {
            for (size_t i = 0; i < COMMENT / 50000; i++) {
                add_skippable(&named, 50000);
            }
            add(&named, bomb.data, bomb.length);
        }
        add(&after, bomb.data, bomb.length);
        expect_refused(both[c], &named, 30000, API_BODY_TOO_LARGE,
                       "larger than the allowed 100 times");
        expect_refused(both[c], &named, named.length, API_BODY_TOO_LARGE,
                       "larger than the allowed 100 times");
        expect_refused(both[c], &after, 30000, API_BODY_TOO_LARGE,
                       "larger than the allowed 100 times");
        free(noise.data);
        free(bomb.data);
        free(named.data);
        free(after.data);
    }
    /* The first megabyte of a decompressed body is allowed whatever its compressed size. A body of
     * many small gzip members or zstd frames must get this allowance only once. */
    for (size_t c = 0; c < 2; c++) {
        bytes part = zeros_in(both[c], 200000), coded = {0};
        for (size_t i = 0; i < 20; i++) {
            add(&coded, part.data, part.length);
        }
        expect_refused(both[c], &coded, 1000, API_BODY_TOO_LARGE,
                       "larger than the allowed 100 times");
        free(part.data);
        free(coded.data);
    }
}

/* A body that becomes large must be decompressed in several calls. unfold() checks that each call
 * adds only a limited number of bytes. */
static void a_dense_body_takes_its_turns(void **state)
{
    (void)state;
    bytes plain = noise_and_zeros(200000, 12 << 20);
    for (size_t c = 0; c < 2; c++) {
        bytes coded = pack_bytes(both[c], &plain);
        expect_unfolded(both[c], &coded, coded.length, &plain);
        expect_unfolded(both[c], &coded, 25000, &plain);
        expect_unfolded(both[c], &coded, 1, &plain);
        free(coded.data);
    }
    free(plain.data);
}

/* The frame contains fewer bytes than its header says. libzstd alone accepts such a frame if it
 * comes in pieces, so the daemon has to check the length. */
static void a_frame_has_the_length_it_says(void **state)
{
    (void)state;
    static const unsigned char frame[] = {
        0x28, 0xB5, 0x2F, 0xFD,           /* magic number */
        0x20, 5,                          /* frame header: declares five bytes of data */
        0x18, 0,    0,    'a',  'b', 'c', /* an uncompressed block of three bytes */
        0x01, 0,    0,                    /* the last block, which is empty */
    };
    bytes coded = {0}, plain = {0};
    add(&coded, frame, sizeof frame);
    add(&plain, "abc", 3);
    for (size_t step = 1; step <= sizeof frame; step++) {
        coded.data[5] = 5;
        expect_refused(
            API_ZSTD, &coded, step, API_BAD_ENCODING,
            "byte 15 of the zstd body: the length of the decompressed frame differs from "
            "the length in the frame's header");
        coded.data[5] = 3;
        expect_unfolded(API_ZSTD, &coded, step, &plain);
    }
    free(coded.data);
    free(plain.data);
}

/* Returns a zstd frame that declares a window of 2^log bytes. */
static bytes with_window(int log)
{
    bytes plain = text_of(100000), out = {0};
    size_t room = ZSTD_compressBound(plain.length);
    out = (bytes){malloc(room), 0, room};
    assert_non_null(out.data);
    ZSTD_CCtx *zstd = ZSTD_createCCtx();
    assert_non_null(zstd);
    ZSTD_CCtx_setParameter(zstd, ZSTD_c_windowLog, log);
    ZSTD_CCtx_setParameter(zstd, ZSTD_c_contentSizeFlag, 0);
    ZSTD_inBuffer in = {plain.data, plain.length, 0};
    ZSTD_outBuffer to = {out.data, room, 0};
    assert_false(ZSTD_isError(ZSTD_compressStream2(zstd, &to, &in, ZSTD_e_continue)));
    assert_int_equal(ZSTD_compressStream2(zstd, &to, &in, ZSTD_e_end), 0);
    out.length = to.pos;
    ZSTD_freeCCtx(zstd);
    free(plain.data);
    return out;
}

static void a_window_may_be_so_large(void **state)
{
    (void)state;
    bytes plain = text_of(100000);
    bytes good = with_window(API_DECOMPRESS_WINDOW), bad = with_window(API_DECOMPRESS_WINDOW + 1);
    expect_unfolded(API_ZSTD, &good, 1000, &plain);
    expect_refused(API_ZSTD, &bad, 1000, API_BODY_TOO_LARGE, "a window of more than 8388608 bytes");
    free(plain.data);
    free(good.data);
    free(bad.data);
}

static void decoders_have_a_common_ceiling(void **state)
{
    (void)state;
    bytes plain = text_of(100000), wide = with_window(API_DECOMPRESS_WINDOW);
    bytes small[2] = {
        [API_ZSTD] = pack_bytes(API_ZSTD, &plain), [API_GZIP] = pack_bytes(API_GZIP, &plain)};
    for (size_t c = 0; c < 2; c++) {
        for (size_t left = 0; left <= 12u << 20; left = left == 0 ? 1000 : left * 5) {
            const bytes *coded = both[c] == API_ZSTD ? &wide : &small[both[c]];
            size_t used, others = API_MAX_DECOMPRESSING - left;
            static api_decompressor_room room;
            room.lent = others;
            bytes out = {0};
            api_problem problem = {0};
            api_decompressor *u = api_decompressor_new(both[c], &room, take, &out, &problem);
            bool good =
                u != NULL && api_decompressor_feed(u, coded->data, coded->length, &used, &problem);
            assert_true(room.lent <= API_MAX_DECOMPRESSING);
            api_decompressor_free(u);
            assert_int_equal(room.lent, others);
            assert_int_equal(problem.code, good ? HE_OK : API_TOO_MANY_CODED);
            assert_int_equal(good, left > (both[c] == API_ZSTD ? 8u << 20 : 40000u));
            free(out.data);
        }
        free(small[c].data);
    }
    free(plain.data);
    free(wide.data);
}

static bool take_none(void *context, const char *data, size_t length)
{
    (void)data;
    (void)length;
    ++*(int *)context;
    return false;
}

static void who_takes_may_have_enough(void **state)
{
    (void)state;
    bytes plain = text_of(300000);
    for (size_t c = 0; c < 2; c++) {
        bytes coded = pack_bytes(both[c], &plain);
        int calls = 0;
        api_problem problem = {0};
        size_t used;
        static api_decompressor_room room;
        api_decompressor *u = api_decompressor_new(both[c], &room, take_none, &calls, &problem);
        assert_non_null(u);
        assert_false(api_decompressor_feed(u, coded.data, coded.length, &used, &problem));
        assert_int_equal(calls, 1);
        assert_int_equal(problem.code, HE_OK);
        api_decompressor_free(u);
        free(coded.data);
    }
    free(plain.data);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    bytes plain = text_of(100000);
    for (size_t c = 0; c < 2; c++) {
        bytes coded = pack_bytes(both[c], &plain);
        failing decompressing = {.what = "unpacking"};
        while (failing_next(&decompressing)) {
            bytes out = {0};
            api_problem problem = {0};
            size_t used;
            static api_decompressor_room room;
            api_decompressor *u = api_decompressor_new(both[c], &room, take, &out, &problem);
            bool done = u != NULL &&
                        api_decompressor_feed(u, coded.data, coded.length, &used, &problem) &&
                        api_decompressor_end(u, &problem);
            api_decompressor_free(u);
            failing_end(&decompressing, done);
            assert_int_equal(room.lent, 0);
            assert_true(done || problem.code == HE_NO_MEMORY);
            free(out.data);
        }
        failing packing = {.what = "packing"};
        while (failing_next(&packing)) {
            const char *whole;
            size_t length;
            api_compressor *compressor = api_compressor_new(
                both[c], &(api_plain){.bytes = plain.data, .length = plain.length});
            bool done = compressor != NULL && !api_compressor_whole(compressor, &whole, &length) &&
                        api_compressor_begin(compressor);
            if (compressor != NULL && !done) {
                api_compressor_give_up(compressor);
            }
            if (compressor != NULL) {
                /* The compressor allocates nothing after api_compressor_begin() or
                 * api_compressor_give_up(), so it can be read although allocations fail. */
                bytes out = pull(compressor, 1000);
                assert_int_equal(out.length, done ? coded.length : plain.length);
                free(out.data);
            }
            api_compressor_free(compressor);
            failing_end(&packing, done);
        }
        free(coded.data);
    }
    free(plain.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_of_all_sizes_come_back),
        cmocka_unit_test(the_same_body_packs_to_the_same_bytes),
        cmocka_unit_test(no_read_codes_more_than_its_turn),
        cmocka_unit_test(a_body_that_breaks_off_is_not_ended),
        cmocka_unit_test(what_cannot_be_coded_is_passed_on),
        cmocka_unit_test(members_and_frames_follow_one_another),
        cmocka_unit_test(a_body_that_ends_too_early_is_refused_wherever),
        cmocka_unit_test(what_follows_the_coding_is_refused_at_its_byte),
        cmocka_unit_test(no_flipped_bit_gives_another_body),
        cmocka_unit_test(a_checksum_that_does_not_hold_is_named),
        cmocka_unit_test(other_codings_are_not_taken_for_these),
        cmocka_unit_test(a_bomb_is_refused_before_it_unfolds),
        cmocka_unit_test(only_compressed_data_lets_a_body_unfold),
        cmocka_unit_test(a_dense_body_takes_its_turns),
        cmocka_unit_test(a_frame_has_the_length_it_says),
        cmocka_unit_test(a_window_may_be_so_large),
        cmocka_unit_test(decoders_have_a_common_ceiling),
        cmocka_unit_test(who_takes_may_have_enough),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
