/* The keyed hash SipHash (base/siphash.h), and the hash of points (geometry/point_hash.h). */
#include "base/siphash.h"
#include "geometry/point_hash.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const uint64_t key[2] = {UINT64_C(0x0706050403020100), UINT64_C(0x0f0e0d0c0b0a0908)};

/* The key and the messages are the bytes 0, 1, 2, ... as in the appendix of the SipHash paper. The
 * expected values are those that the paper's authors published for an output of 128 bits. */
static void values_are_those_of_its_authors(void **state)
{
    (void)state;
    static const struct {
        size_t length;
        uint64_t out[2];
    } cases[] = {
        {0, {UINT64_C(0xe6a825ba047f81a3), UINT64_C(0x930255c71472f66d)}},
        {1, {UINT64_C(0x44af996bd8c187da), UINT64_C(0x45fc229b11597634)}},
    };
    unsigned char message[64];
    for (size_t i = 0; i < sizeof message; i++) {
        message[i] = (unsigned char)i;
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint64_t out[2];
        he_siphash h;
        he_siphash_begin(&h, key);
        he_siphash_add(&h, message, cases[i].length);
        he_siphash_end(&h, out);
        assert_true(out[0] == cases[i].out[0] && out[1] == cases[i].out[1]);
        assert_true(he_siphash_of(key, message, cases[i].length) == cases[i].out[0]);
    }
}

static void cuts_do_not_count(void **state)
{
    (void)state;
    char text[100];
    memset(text, 'x', sizeof text);
    for (size_t length = 0; length <= 40; length++) {
        uint64_t whole = he_siphash_of(key, text, length);
        for (size_t cut = 0; cut <= length; cut++) {
            uint64_t out[2];
            he_siphash h;
            he_siphash_begin(&h, key);
            he_siphash_add(&h, text, cut);
            he_siphash_add(&h, text + cut, length - cut);
            he_siphash_end(&h, out);
            assert_true(out[0] == whole);
        }
    }
}

static void length_key_and_each_byte_count(void **state)
{
    (void)state;
    uint64_t seen[64];
    size_t count = 0;
    char text[32] = {0};
    for (size_t length = 0; length < sizeof text; length++) {
        seen[count++] = he_siphash_of(key, text, length);
    }
    for (size_t i = 0; i < 16; i++) {
        text[i] = 1;
        seen[count++] = he_siphash_of(key, text, 16);
        text[i] = 0;
    }
    seen[count++] = he_siphash_of((const uint64_t[2]){key[0] + 1, key[1]}, text, 16);
    seen[count++] = he_siphash_of((const uint64_t[2]){key[0], key[1] + 1}, text, 16);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < i; j++) {
            assert_true(seen[i] != seen[j]);
        }
    }
}

static double flip(double x, uint64_t which)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits ^= which;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* A client that does not know the seed must not find points that have one hash with every seed. The
 * sign of a coordinate, together with some bits of the next one, is the pair of changes that
 * multiplication alone passes on unchanged. */
static void no_change_of_a_point_collides_for_every_seed(void **state)
{
    (void)state;
    enum { SEEDS = 1000 };
    const uint64_t sign = UINT64_C(1) << 63;
    const he_vec3 p = {1.5, -2.25, 3.125};
    for (unsigned bit = 0; bit < 64; bit++) {
        const uint64_t other = sign ^ UINT64_C(1) << bit;
        const he_vec3 q = {-p.x, flip(p.y, other), p.z};
        const he_vec3 r = {p.x, -p.y, flip(p.z, other)};
        int equal = 0;
        for (uint64_t i = 1; i <= SEEDS; i++) {
            const uint64_t seed = i * 4096; /* like an address */
            const uint32_t h = he_point_hash(seed, p);
            equal += (h == he_point_hash(seed, q)) + (h == he_point_hash(seed, r));
        }
        assert_true(equal < 3);
    }
    assert_int_equal(he_point_hash(7, (he_vec3){0, -0.0, 1}),
                     he_point_hash(7, (he_vec3){-0.0, 0, 1}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_its_authors),
        cmocka_unit_test(cuts_do_not_count),
        cmocka_unit_test(length_key_and_each_byte_count),
        cmocka_unit_test(no_change_of_a_point_collides_for_every_seed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
