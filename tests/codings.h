/* codings.h - compresses and decompresses the bodies of tests with zlib and libzstd at their
 * default levels, because the project's own compression cannot be tested against itself. */
#ifndef TESTS_CODINGS_H
#define TESTS_CODINGS_H

#include <stddef.h>

/* Compresses bytes; `coding` is gzip or zstd. The caller must free the result. */
char *coding_pack(const char *coding, const void *bytes, size_t length, size_t *packed);
/* Decompresses bytes; the result ends in NUL. Returns NULL unless the bytes are exactly one
 * compressed body in this coding. */
char *coding_unpack(const char *coding, const void *bytes, size_t length, size_t *plain);

#endif
