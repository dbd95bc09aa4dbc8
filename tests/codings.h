/* codings.h - bodies in gzip and zstd for tests, by the libraries themselves and at their usual
 * levels, so that the project's own packing is not tested against itself. */
#ifndef TESTS_CODINGS_H
#define TESTS_CODINGS_H

#include <stddef.h>

/* `coding` is gzip or zstd. The caller frees. */
char *coding_pack(const char *coding, const void *bytes, size_t length, size_t *packed);
/* Ends in NUL. NULL where the bytes are not exactly one body in this coding. */
char *coding_unpack(const char *coding, const void *bytes, size_t length, size_t *plain);

#endif
