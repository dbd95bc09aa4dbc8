/* codings.h - compresses and decompresses the bodies of tests with zlib and libzstd at their
 * default levels, so that the project's own compression is not tested against itself. */
#ifndef TESTS_CODINGS_H
#define TESTS_CODINGS_H

#include <stddef.h>

/* Compresses bytes; `coding` is gzip or zstd. The caller must free the result. */
char *coding_pack(const char *coding, const void *bytes, size_t length, size_t *packed);
/* Decompresses bytes; the result ends in NUL. Returns NULL if the bytes are not exactly one body in
 * this coding. */
char *coding_unpack(const char *coding, const void *bytes, size_t length, size_t *plain);

#endif
