/* fuzz.h - what every fuzz target is held to.
 *
 * A target is one file, fuzz_NAME.c, that defines fuzz_one. It takes any bytes at all and says by
 * FUZZ_REQUIRE (or cmocka's asserts, which abort here too) what must hold of them. guard.c makes of
 * it the LLVMFuzzerTestOneInput that libFuzzer and AFL++ call, and sees that each call
 *
 *     holds at most FUZZ_MEMORY bytes of base/mem.h at once, and none when it returns,
 *     takes at most FUZZ_SECONDS of processor time, or on a slow machine FUZZ_PACES times what a
 *         fixed piece of work takes (tests/pace.h),
 *     depends on its bytes alone.
 *
 * Linked with clang's -fsanitize=fuzzer (CONFIG=fuzz) a target makes up its inputs; with replay.c
 * (all other configurations) it is a program that goes through the files it is given. seeds/NAME
 * has inputs to begin from, found/NAME those that once went wrong: `make test` replays both. */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The contract for any input is 256 MB over its natural size, and a second: inputs here are small.
 */
enum { FUZZ_MEMORY = 256 << 20, FUZZ_SECONDS = 1, FUZZ_PACES = 100 };

void fuzz_one(const uint8_t *bytes, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

_Noreturn void fuzz_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
#define FUZZ_REQUIRE(holds, ...) ((holds) ? (void)0 : fuzz_fail(__VA_ARGS__))

/* A seed for choices about an input that is itself a document: 64-bit FNV-1a. */
uint64_t fuzz_hash(const void *bytes, size_t size);

/* Bytes that are choices, taken one after another; zeros when there are no more. */
typedef struct fuzz_tape {
    const uint8_t *at, *end;
} fuzz_tape;

bool fuzz_at_end(const fuzz_tape *tape);
uint32_t fuzz_byte(fuzz_tape *tape);
uint32_t fuzz_below(fuzz_tape *tape, uint32_t n); /* n is not 0 */
double fuzz_double(fuzz_tape *tape);              /* finite; mostly small */

#endif
