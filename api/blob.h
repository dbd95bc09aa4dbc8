/* blob.h - the body of an answer that is not in memory, for example because it is in a file. */
#ifndef HE_API_BLOB_H
#define HE_API_BLOB_H

#include <stddef.h>
#include <stdint.h>

typedef struct api_blob {
    void *self; /* first argument of the functions `read` and `free`; NULL if there is no blob */
    uint64_t length;
    /* Reads up to `size` bytes from position `at`. Returns how many were read, or -1 on failure.
     * Several threads may call it at the same time. */
    int64_t (*read)(void *self, uint64_t at, char *buffer, size_t size);
    void (*free)(void *self); /* frees the blob; NULL: the blob is borrowed and must not be freed */
} api_blob;

#endif
