/* blob.h - bytes of an answer that lie elsewhere than in memory, such as in a file. */
#ifndef HE_API_BLOB_H
#define HE_API_BLOB_H

#include <stddef.h>
#include <stdint.h>

typedef struct api_blob {
    void *self; /* NULL: there is none */
    uint64_t length;
    /* Up to `size` bytes from `at` on: how many, -1 on failure. From several threads at a time. */
    int64_t (*read)(void *self, uint64_t at, char *buffer, size_t size);
    void (*free)(void *self); /* NULL: it is lent */
} api_blob;

#endif
