/* reader.h - what holds of any bytes that are read as a mesh file.
 *
 * Whole and in pieces they give the same import or the same refusal, and a refusal names its place.
 * An import can be built, or is refused with its place; then the repairs that are advised let it
 * pass. What was built passes he_check, and written in each format it can be read again: in its own
 * format to the same document. Sizes of pieces, further repairs and encodings follow from the
 * bytes. */
#ifndef TESTS_FUZZ_READER_H
#define TESTS_FUZZ_READER_H

#include <stddef.h>

/* `format` is a name of the table. */
void fuzz_reader(const char *format, const void *bytes, size_t size);

#endif
