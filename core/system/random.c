#include "system/random.h"

#include <errno.h>
#include <stdlib.h>
#include <sys/random.h>

/* Fills bytes with random numbers from the system call getrandom. If a signal interrupts the call,
 * it is repeated; it cannot fail in another way on the kernels that the daemon supports. */
static void fill(void *bytes, size_t size)
{
    unsigned char *at = bytes;
    while (size > 0) {
        ssize_t got = getrandom(at, size, 0);
        if (got > 0) {
            at += got;
            size -= (size_t)got;
        } else if (errno != EINTR) {
            abort();
        }
    }
}

uint64_t st_random(void)
{
    uint64_t value;
    fill(&value, sizeof value);
    return value;
}

void st_random_id(char *out, size_t length)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    enum { LETTERS = sizeof letters - 1, FAIR = 256 / LETTERS * LETTERS };
    size_t done = 0;
    while (done < length) {
        unsigned char bytes[32];
        fill(bytes, sizeof bytes);
        for (size_t i = 0; i < sizeof bytes && done < length; i++) {
            if (bytes[i] < FAIR) {
                out[done++] = letters[bytes[i] % LETTERS];
            }
        }
    }
    out[length] = '\0';
}
