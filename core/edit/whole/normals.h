/* normals.h - attributes that hold normals, when vertices are mapped. */
#ifndef HE_EDIT_WHOLE_NORMALS_H
#define HE_EDIT_WHOLE_NORMALS_H

#include "mesh/mesh.h"

/* The turning of every column `normal` of three floats or doubles on vertices, half-edges or faces,
 * for a map of some vertices or all. Rows of mapped vertices turn, of half-edges that leave them,
 * and of faces whose corners are all mapped.
 *
 * A normal goes to the inverse transpose of the map's linear part times itself, at length 1 (J. D.
 * Foley, A. van Dam, S. K. Feiner and J. F. Hughes, "Computer Graphics: Principles and Practice",
 * 1990, 5.7), taken by cofactors so that a flattening map has one too where it leaves a plane. One
 * that has no direction then, or had none, stays as it is, and so do all when nothing but a shift
 * is asked for. */
typedef struct he_normals {
    he_mesh *m;
    const uint32_t *vertices; /* NULL: all */
    size_t count;
    uint64_t *chosen; /* vertices of the list, where faces need to know */
    double k[9];
    bool turns;
} he_normals;

/* Look which columns there are. `words` is how many records the writing makes at most.
 * HE_NO_MEMORY. he_normals_clear frees. */
HE_NODISCARD he_status he_normals_init(he_normals *n, he_mesh *m, const double matrix[16],
                                       const uint32_t *vertices, size_t count, size_t *words,
                                       he_error *err);
/* In COMMIT. */
void he_normals_commit(const he_normals *n);
void he_normals_clear(he_normals *n);

#endif
