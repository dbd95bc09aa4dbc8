/* exact.h - the slow, exact way to read a decimal, for number_parse.c. */
#ifndef HE_FORMAT_TEXT_EXACT_H
#define HE_FORMAT_TEXT_EXACT_H

#include <stdint.h>

/* Returns the bits of the double nearest to a decimal, ties to even; those of infinity if it is too
 * large. [digits, end) contains decimal digits, one of them not 0, and at most one point, which is
 * ignored: the value is the number made by the digits times 10^exponent. It must be between 1e-345
 * and 1e311. The closer `guess` (bits of a positive double) is, the fewer comparisons. */
uint64_t he_exact_round(const char *digits, const char *end, int64_t exponent, uint64_t guess);

#endif
