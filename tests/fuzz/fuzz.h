/* fuzz.h - what every fuzz target must define and satisfy.
 *
 * A target is one file, fuzz_NAME.c, which defines fuzz_one. This function takes any bytes and
 * checks with FUZZ_REQUIRE, or with cmocka's asserts, what must hold for them; a failed check
 * aborts. guard.c calls it from LLVMFuzzerTestOneInput, which libFuzzer and AFL++ call, and checks
 * that each call
 *
 *     holds at most FUZZ_MEMORY bytes of base/mem.h at once, and none when it returns,
 *     takes at most FUZZ_SECONDS of processor time, or on a slow machine FUZZ_PACES times what a
 *         fixed piece of work takes (tests/pace.h),
 *     depends on its bytes alone.
 *
 * Linked with clang's -fsanitize=fuzzer (CONFIG=fuzz) a target gets inputs from libFuzzer; linked
 * with replay.c (all other configurations) it is a program that runs the files named on its command
 * line. seeds/NAME has inputs to begin from, found/NAME has those that once failed: `make test`
 * replays both. */
#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Maximum memory and time that an input may take: 256 MB, and one second. The input itself, which
 * is small, does not count. */
enum { FUZZ_MEMORY = 256 << 20, FUZZ_SECONDS = 1, FUZZ_PACES = 100 };

void fuzz_one(const uint8_t *bytes, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

_Noreturn void fuzz_fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
#define FUZZ_REQUIRE(holds, ...) ((holds) ? (void)0 : fuzz_fail(__VA_ARGS__))

/* Returns a hash of the input (64-bit FNV-1a), which serves as the seed for random choices if all
 * bytes of the input are the document under test. */
uint64_t fuzz_hash(const void *bytes, size_t size);

/* Bytes that are read one after another as choices; when there are no more, zeros are read. */
typedef struct fuzz_tape {
    const uint8_t *at, *end;
} fuzz_tape;

bool fuzz_at_end(const fuzz_tape *tape);
uint32_t fuzz_byte(fuzz_tape *tape);
/* Returns a number from 0 to n - 1 that the next bytes of the tape choose; n is not 0. */
uint32_t fuzz_below(fuzz_tape *tape, uint32_t n);
/* Returns a finite number, in most cases a small one. */
double fuzz_double(fuzz_tape *tape);

#endif
