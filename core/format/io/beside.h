/* beside.h - files that came with the one that is read: the buffers of a glTF asset, the material
 * library of an OBJ file.
 *
 * A reader asks for them by the names that its file gives; nothing is ever opened. A name fits the
 * file that has it. Where none has, folders do not count, since browsers and curl send names
 * without them: then it fits the file that has the same name behind the last slash or backslash,
 * unless several have. */
#ifndef HE_FORMAT_IO_BESIDE_H
#define HE_FORMAT_IO_BESIDE_H

#include <stdbool.h>
#include <stddef.h>

enum { HE_BESIDE_NAME = 1024 }; /* bytes of a name that can fit, its NUL included */

typedef struct he_beside_file {
    const char *name;
    const char *bytes;
    size_t length;
    bool used; /* a reader has asked for it */
} he_beside_file;

/* Filled and kept by the caller of the reader. */
typedef struct he_beside {
    he_beside_file *files;
    size_t count;
} he_beside;

/* The file that the `length` bytes at `name` name, marked as used, or NULL. `beside` may be NULL:
 * nothing came. */
const he_beside_file *he_beside_find(he_beside *beside, const char *name, size_t length);
/* he_beside_find for a URI reference (RFC 3986): the file of exactly this name, or else of the name
 * with its percent escapes decoded. */
const he_beside_file *he_beside_find_uri(he_beside *beside, const char *uri, size_t length);
/* All sizes together. */
size_t he_beside_bytes(const he_beside *beside);
/* The names, for a message: "a.bin, b.bin", cut to fit with "...". Printable ASCII. */
void he_beside_list(const he_beside *beside, char *text, size_t size);

#endif
