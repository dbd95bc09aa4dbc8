#include "journal/crc32c.h"

#include <pthread.h>
#include <stdbool.h>
#include <string.h>

enum { BYTE_VALUES = 256 };
/* the polynomial of CRC-32C, with its bits in reverse order */
#define POLYNOMIAL UINT32_C(0x82f63b78)

static uint32_t table[BYTE_VALUES];
static bool has_instruction;
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void prepare(void)
{
    for (uint32_t i = 0; i < BYTE_VALUES; i++) {
        uint32_t value = i;
        for (int bit = 0; bit < 8; bit++) {
            value = value >> 1 ^ (value & 1 ? POLYNOMIAL : 0);
        }
        table[i] = value;
    }
#if defined(__x86_64__)
    has_instruction = __builtin_cpu_supports("sse4.2");
#endif
}

uint32_t st_crc32c_by_table(uint32_t before, const void *bytes, size_t size)
{
    pthread_once(&once, prepare);
    const unsigned char *at = bytes;
    uint32_t crc = ~before;
    for (size_t i = 0; i < size; i++) {
        crc = crc >> 8 ^ table[(crc ^ at[i]) & 255];
    }
    return ~crc;
}

#if defined(__x86_64__)
__attribute__((target("sse4.2"))) static uint32_t by_instruction(uint32_t before, const void *bytes,
                                                                 size_t size)
{
    const unsigned char *at = bytes;
    uint64_t crc = ~before;
    for (; size >= sizeof(uint64_t); size -= sizeof(uint64_t), at += sizeof(uint64_t)) {
        uint64_t word;
        memcpy(&word, at, sizeof word);
        crc = __builtin_ia32_crc32di(crc, word);
    }
    for (; size > 0; size--) {
        crc = __builtin_ia32_crc32qi((uint32_t)crc, *at++);
    }
    return ~(uint32_t)crc;
}
#endif

uint32_t st_crc32c(uint32_t before, const void *bytes, size_t size)
{
    pthread_once(&once, prepare);
#if defined(__x86_64__)
    if (has_instruction) {
        return by_instruction(before, bytes, size);
    }
#endif
    return st_crc32c_by_table(before, bytes, size);
}
