/* foreign.h - recognises, by their first bytes, files that are no meshes or have a format that
 * cannot be read, so that an error can say what was sent and what to do about it. */
#ifndef HE_FORMAT_IO_FOREIGN_H
#define HE_FORMAT_IO_FOREIGN_H

#include <stddef.h>

/* Returns a description such as "a PNG image", or "a ZIP archive, as 3MF files are: unpack it
 * first"; NULL if the bytes are not recognised. No file of a format that can be read is recognised
 * by this function. */
const char *he_foreign_find(const void *bytes, size_t n);

#endif
