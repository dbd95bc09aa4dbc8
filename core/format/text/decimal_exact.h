/* decimal_exact.h - the slow, exact way to read a decimal number; number_parse.c uses it when the
 * fast way cannot decide. */
#ifndef HE_FORMAT_TEXT_DECIMAL_EXACT_H
#define HE_FORMAT_TEXT_DECIMAL_EXACT_H

#include <stdint.h>

/* Returns the bits of the double nearest to a decimal number, ties to even; the bits of infinity if
 * the number is too large. [digits, end) contains decimal digits, one of them not 0, and at most
 * one point, which is ignored: the number is what the digits make, times 10^exponent. It must be
 * between 1e-345 and 1e311. `guess` is the bits of a positive double near the result: the closer it
 * is, the fewer comparisons are needed. */
uint64_t he_decimal_exact_round(const char *digits, const char *end, int64_t exponent,
                                uint64_t guess);

#endif
