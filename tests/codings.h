/* codings.h - compresses and decompresses bodies in tests by calling zlib and libzstd directly,
 * with their default levels. The project's own compression is tested against it. */
#ifndef TESTS_CODINGS_H
#define TESTS_CODINGS_H

#include <stddef.h>

/* Compresses bytes; `coding` is gzip or zstd. The caller must free the result. */
char *coding_pack(const char *coding, const void *bytes, size_t length, size_t *packed);
/* Decompresses bytes; the result ends in NUL. Returns NULL unless the bytes are exactly one
 * compressed body in this coding. */
char *coding_unpack(const char *coding, const void *bytes, size_t length, size_t *plain);

#endif
