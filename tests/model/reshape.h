/* reshape.h - random calls of the operations that reshape, select or measure a whole surface, for
 * meshes that are too large for the oracle. */
#ifndef TESTS_MODEL_RESHAPE_H
#define TESTS_MODEL_RESHAPE_H

#include "model/arguments.h"

/* A call, with the lists of ids and the points of its arguments. */
typedef struct md_reshape {
    md_call call;
    uint32_t *list[2]; /* a list of ids for each of at most two parameters */
    he_mesh *other;    /* the argument `with` of deviation */
} md_reshape;

enum { MD_RESHAPES = 8 };
/* The names of the operations. hole_fill mostly gets the method smooth. */
extern const char *const md_reshapes[MD_RESHAPES];

/* Draws a call of md_reshapes[which] for a mesh. Lengths and places are mostly of the size of the
 * mesh, and sometimes huge, tiny or 0; lists sometimes have an element twice, one that is deleted
 * or one that never existed. The caller frees the call with md_reshape_clear. */
void md_reshape_draw(md_reshape *c, size_t which, const he_mesh *m, md_random *r);
void md_reshape_clear(md_reshape *c);

#endif
