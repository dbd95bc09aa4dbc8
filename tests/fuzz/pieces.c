#include "fuzz/pieces.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

char *fuzz_pieces_next(fuzz_pieces *p, size_t *length)
{
    if (p->at == p->size) {
        return NULL;
    }
    size_t n = p->most == 0 ? p->size : md_from(p->random, 0, p->most);
    n = n < p->size - p->at ? n : p->size - p->at;
    char *piece = malloc(n == 0 ? 1 : n);
    assert_non_null(piece);
    memcpy(piece, (const char *)p->bytes + p->at, n);
    p->at += n;
    *length = n;
    return piece;
}
