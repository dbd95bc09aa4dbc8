/* The keyed hash SipHash (base/siphash.h). */
#include "base/siphash.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_those_of_its_authors),
        cmocka_unit_test(cuts_do_not_count),
        cmocka_unit_test(length_key_and_each_byte_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
