#include "fuzz/fuzz.h"

#include "base/mem.h"
#include "tests/pace.h"

#include <inttypes.h>
#include <malloc.h>
#include <math.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static atomic_size_t held;

void fuzz_fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fputs("fuzz: ", stderr);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
    va_end(arguments);
    abort();
}

static void *resize(void *context, void *memory, size_t size)
{
    (void)context;
    size_t before = memory == NULL ? 0 : malloc_usable_size(memory);
    if (size == 0) {
        free(memory);
        atomic_fetch_sub(&held, before);
        return NULL;
    }
    FUZZ_REQUIRE(size <= FUZZ_MEMORY && atomic_load(&held) - before + size <= FUZZ_MEMORY,
                 "%zu bytes are wanted where %zu are held", size, atomic_load(&held));
    void *after = realloc(memory, size);
    FUZZ_REQUIRE(after != NULL, "no memory");
    atomic_fetch_add(&held, malloc_usable_size(after) - before);
    return after;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const he_mem_hook hook = {resize, NULL};
    static bool ready;
    if (!ready) {
        he_mem_set_hook(&hook);
        /* Outside of cmocka's own tests, its asserts abort only if this variable is set. */
        setenv("CMOCKA_TEST_ABORT", "1", 1);
        ready = true;
    }
    size_t before = atomic_load(&held);
    double took;
    int tries = 0;
    do {
        double start = pace_seconds();
        fuzz_one(bytes, size);
        took = pace_seconds() - start;
    } while (took > FUZZ_SECONDS && took > FUZZ_PACES * pace_unit() && ++tries < PACE_TRIES);
    FUZZ_REQUIRE(tries < PACE_TRIES, "%.2f s for %zu bytes", took, size);
    FUZZ_REQUIRE(atomic_load(&held) == before, "%zu bytes were not given back",
                 atomic_load(&held) - before);
    return 0;
}

uint64_t fuzz_hash(const void *bytes, size_t size)
{
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ ((const uint8_t *)bytes)[i]) * UINT64_C(0x100000001B3);
    }
    return hash;
}

bool fuzz_at_end(const fuzz_tape *tape)
{
    return tape->at == tape->end;
}

uint32_t fuzz_byte(fuzz_tape *tape)
{
    return tape->at < tape->end ? *tape->at++ : 0;
}

uint32_t fuzz_below(fuzz_tape *tape, uint32_t n)
{
    uint32_t value = fuzz_byte(tape);
    return (n > 256 ? value << 8 | fuzz_byte(tape) : value) % n;
}

double fuzz_double(fuzz_tape *tape)
{
    static const double rare[] = {0.0,      -0.0,    0.5,      1.0,   -1.0,    1e-9, 1e-300,
                                  4.9e-324, 1.7e308, -1.7e308, 1e154, 0x1p-52, 2.0,  1e9};
    uint32_t kind = fuzz_byte(tape);
    if (kind < sizeof rare / sizeof *rare) {
        return rare[kind];
    }
    if (kind < 240) {
        return ((double)kind - 128) / 32;
    }
    uint64_t bits = 0;
    for (int i = 0; i < 8; i++) {
        bits = bits << 8 | fuzz_byte(tape);
    }
    double value;
    memcpy(&value, &bits, sizeof value);
    return isfinite(value) ? value : 1.0;
}
