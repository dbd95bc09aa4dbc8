/* number.h - prints and parses numbers, equally in every locale.
 *
 * Doubles are printed as the shortest decimal that reads back to the same bits, and the closest one
 * among those: R. Giulietti, "The Schubfach way to render doubles" (2020). They are read exactly,
 * ties to even: D. Lemire, "Number parsing at a gigabyte per second" (2021), the method known as
 * Eisel-Lemire, with big integers where its 128 bits do not decide.
 *
 * Printed numbers are valid JSON, and equal to what ECMAScript prints except that an exponent has
 * no plus sign:
 *     0  -0  1  0.1  123456789  1e21  1.5e300  0.000001  1e-7  5e-324
 *
 * The parsers read a number from the bytes [begin, end), skip no blanks, and set *used to the
 * length of the number. They take no he_error, because only the caller knows the line. */
#ifndef HE_FORMAT_TEXT_NUMBER_H
#define HE_FORMAT_TEXT_NUMBER_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/* No number that these functions print takes more bytes than this. */
enum { HE_NUMBER_TEXT = 32 };

/* These functions write a finite value as text, without a NUL at the end, and return the length of
 * the text. he_float_print writes the shortest text that reads back to the same float. */
size_t he_double_print(double value, char *text);
size_t he_float_print(float value, char *text);
size_t he_u32_print(uint32_t value, char *text);
size_t he_u64_print(uint64_t value, char *text);
size_t he_i64_print(int64_t value, char *text);

/* HE_JSON_NUMBER is the grammar of RFC 8259. HE_FILE_NUMBER is what mesh files hold: also a
 * leading plus, leading zeros, and a point with digits on one side only; "nan", "inf", "infinity"
 * in any letter case and the "1.#" forms of old C libraries are recognised as not finite. */
typedef enum he_grammar { HE_JSON_NUMBER, HE_FILE_NUMBER } he_grammar;

/* Parses a number in linear time. Sets `*used` if it returns HE_OK or HE_NOT_FINITE, and `*value`
 * only if it returns HE_OK. A number too small for a normal double rounds to a subnormal or zero.
 * Returns HE_SYNTAX if there is no number.
 * Returns HE_NOT_FINITE if the number is too large for a double, or is one of the words for
 * infinity and NaN. */
HE_NODISCARD he_status he_double_parse(const char *begin, const char *end, he_grammar grammar,
                                       double *value, size_t *used);

/* These functions parse a whole number in decimal digits; he_i64_parse accepts a minus sign.
 * Returns HE_SYNTAX if there is no digit.
 * Returns HE_BAD_VALUE if the number does not fit into 64 bits; `*used` is set. */
HE_NODISCARD he_status he_u64_parse(const char *begin, const char *end, uint64_t *value,
                                    size_t *used);
HE_NODISCARD he_status he_i64_parse(const char *begin, const char *end, int64_t *value,
                                    size_t *used);

#endif
