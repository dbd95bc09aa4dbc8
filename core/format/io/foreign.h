/* foreign.h - files that are no meshes, or of formats that are not read here, by their first bytes:
 * so that a refusal can say what was sent, and what to do about it. */
#ifndef HE_FORMAT_IO_FOREIGN_H
#define HE_FORMAT_IO_FOREIGN_H

#include <stddef.h>

/* "a PNG image", or "a ZIP archive, as 3MF files are: unpack it first"; NULL where the bytes are of
 * nothing that is known. None of these begins a file of a format that is read. */
const char *he_foreign_find(const void *bytes, size_t n);

#endif
