/* beside.h - files that came together with the file that is read: the buffers of a glTF asset, the
 * material library of an OBJ file.
 *
 * A reader looks them up by the names in its file; no file is ever opened. A name finds the file
 * with exactly that name. If there is none, folders are ignored, because browsers and curl send
 * names without them: the name then finds the file with the same last part after a slash or
 * backslash, unless several files have it. */
#ifndef HE_FORMAT_IO_BESIDE_H
#define HE_FORMAT_IO_BESIDE_H

#include <stdbool.h>
#include <stddef.h>

enum { HE_BESIDE_NAME = 1024 }; /* most bytes of a name, its NUL included */

typedef struct he_beside_file {
    const char *name;
    const char *bytes;
    size_t length;
    bool used; /* a reader has looked up this file */
} he_beside_file;

/* The files that came together with the one that is read. The caller of the reader fills and
 * keeps this list. */
typedef struct he_beside {
    he_beside_file *files;
    size_t count;
} he_beside;

/* Finds a file by its name of `length` bytes, and marks it as used. Returns NULL if there is no
 * such file. `beside` may be NULL, which means that no files came. */
const he_beside_file *he_beside_find(he_beside *beside, const char *name, size_t length);
/* Finds a file like he_beside_find, but by a URI reference (RFC 3986): the file of exactly this
 * name, or else the file of the name with its percent escapes decoded. */
const he_beside_file *he_beside_find_uri(he_beside *beside, const char *uri, size_t length);
/* Returns the sum of the sizes of all files. */
size_t he_beside_bytes(const he_beside *beside);
/* Lists the names of the files for a message, in printable ASCII: "a.bin, b.bin"; if they do not
 * fit, the list ends with "...". */
void he_beside_list(const he_beside *beside, char *text, size_t size);

#endif
