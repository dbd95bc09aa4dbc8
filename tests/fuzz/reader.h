/* reader.h - the checks on any bytes that are read as a mesh file.
 *
 * Read whole and in pieces they must give the same import or the same refusal, and a refusal must
 * name its place in the file. A mesh can be built from the import, or building fails with an error
 * that names a place; in that case it must succeed after the repairs that the error advises. The
 * built mesh must pass he_check, and each format in which it is written must be readable again; in
 * its own format it must give the same file. The sizes of the pieces, the other repairs and the
 * encodings are derived from the bytes. */
#ifndef TESTS_FUZZ_READER_H
#define TESTS_FUZZ_READER_H

#include <stddef.h>

/* Checks the bytes as a file of this format, a name in the table of formats. */
void fuzz_reader(const char *format, const void *bytes, size_t size);

#endif
