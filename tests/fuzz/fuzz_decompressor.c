/* Compressed bodies: they are read as zstd if they begin with its magic number, else as gzip.
 * Reading a body whole and in pieces must give the same bytes or the same refusal, and never more
 * bytes than the allowed ratio; zlib and libzstd, called once for the whole body, must give the
 * same bytes. Any bytes that are compressed must decompress to themselves. */
#include "fuzz/fuzz.h"
#include "fuzz/pieces.h"

#include "api/header/compressor.h"
#include "api/header/decompressor.h"
#include "api/limits.h"
#include "tests/codings.h"
#include "unit/fixture.h"

typedef struct unfolded {
    uint64_t length, hash;
} unfolded;

static bool take(void *context, const char *bytes, size_t length)
{
    unfolded *u = context;
    assert_true(length > 0 && length <= API_DECOMPRESS_PIECE);
    for (size_t i = 0; i < length; i++) {
        u->hash = (u->hash ^ (uint8_t)bytes[i]) * UINT64_C(0x100000001B3);
    }
    u->length += length;
    return true;
}

/* Decompresses a body in pieces. Returns the code of the refusal, or HE_OK. */
static int unfold(api_coding coding, fuzz_pieces pieces, unfolded *out)
{
    api_problem problem = {0};
    *out = (unfolded){0, UINT64_C(0xCBF29CE484222325)};
    static api_decompressor_room room;
    api_decompressor *u = api_decompressor_new(coding, &room, take, out, &problem);
    assert_non_null(u);
    bool good = true;
    char *piece;
    size_t n;
    while (good && (piece = fuzz_pieces_next(&pieces, &n)) != NULL) {
        size_t used = 0;
        good = api_decompressor_feed(u, piece, n, &used, &problem);
        free(piece);
        pieces.at -=
            n - used; /* the next call gets the bytes of the piece that this call did not take */
    }
    good = good && api_decompressor_end(u, &problem);
    api_decompressor_free(u);
    assert_int_equal(room.lent, 0);
    assert_true(good == (problem.code == HE_OK));
    assert_true(out->length <= API_DECOMPRESS_FREE + API_DECOMPRESS_RATIO * (uint64_t)pieces.size);
    return problem.code;
}

static void pack_and_unpack(api_coding coding, const uint8_t *bytes, size_t size, md_random *random)
{
    api_plain plain = {.bytes = (const char *)bytes, .length = size};
    api_compressor *compressor = api_compressor_new(coding, &plain);
    assert_non_null(compressor);
    assert_true(api_compressor_begin(compressor));
    size_t length = 0, again;
    char *packed = malloc(2 * size + 4096);
    assert_non_null(packed);
    int64_t got;
    while ((got = api_compressor_read(compressor, packed + length, md_from(random, 1, 1000))) > 0) {
        length += (size_t)got;
        assert_true(length <= 2 * size + 1024);
    }
    assert_int_equal(got, 0);
    api_compressor_free(compressor);
    char *back = coding_unpack(api_coding_name(coding), packed, length, &again);
    assert_non_null(back);
    assert_int_equal(again, size);
    assert_true(size == 0 || memcmp(back, bytes, size) == 0);
    free(back);
    free(packed);
}

/* If zlib or libzstd decodes the body in one call, the daemon must accept it, too, and get the same
 * bytes. There are two exceptions, which the caller leaves out: a gzip body that exceeds the
 * allowed ratio, and a zstd body that the daemon refuses, because libzstd accepts blocks larger
 * than RFC 8878 allows when it decodes in one call. */
static void compare(api_coding coding, const uint8_t *bytes, size_t size, int code,
                    const unfolded *whole)
{
    size_t length;
    char *plain = coding_unpack(api_coding_name(coding), bytes, size, &length);
    FUZZ_REQUIRE(plain == NULL || code == HE_OK, "zlib takes what is refused with %d", code);
    if (plain != NULL) {
        assert_true(length == whole->length && fuzz_hash(plain, length) == whole->hash);
    }
    free(plain);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    static const uint8_t frame[] = {0x28, 0xB5, 0x2F, 0xFD}, skipped[] = {0x2A, 0x4D, 0x18};
    md_random random = {fuzz_hash(bytes, size)};
    bool zstd = size >= 4 && (memcmp(bytes, frame, 4) == 0 || memcmp(bytes + 1, skipped, 3) == 0);
    api_coding coding = zstd ? API_ZSTD : API_GZIP;
    unfolded whole, cut;
    int code = unfold(coding, (fuzz_pieces){bytes, size, 0, &random, 0}, &whole);
    int second =
        unfold(coding, (fuzz_pieces){bytes, size, 1u << md_below(&random, 9), &random, 0}, &cut);
    FUZZ_REQUIRE(code == second, "whole %d, in pieces %d", code, second);
    assert_true(code != HE_NO_MEMORY);
    if (code == HE_OK) {
        assert_true(whole.length == cut.length && whole.hash == cut.hash);
    }
    if (size > 0 && (zstd ? code == HE_OK : code != API_BODY_TOO_LARGE)) {
        compare(coding, bytes, size, code, &whole);
    }
    pack_and_unpack(md_chance(&random, 50) ? API_ZSTD : API_GZIP, bytes, size, &random);
}
