/* pieces.h - an input that is read in pieces of random lengths, as a connection would bring it. */
#ifndef TESTS_FUZZ_PIECES_H
#define TESTS_FUZZ_PIECES_H

#include "model/random.h"

#include <stddef.h>

typedef struct fuzz_pieces {
    const void *bytes;
    size_t size;
    uint32_t most;     /* the maximum length of a piece; 0: the input is one piece */
    md_random *random; /* chooses the lengths */
    size_t at;         /* where the next piece begins */
} fuzz_pieces;

/* Copies the next piece, which may be empty, to a block of its own, so that a sanitizer detects
 * reads beyond it, and moves on. Returns NULL at the end of the input; the caller must free the
 * piece. */
char *fuzz_pieces_next(fuzz_pieces *p, size_t *length);

#endif
