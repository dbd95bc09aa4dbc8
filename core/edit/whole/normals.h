/* normals.h - transforms attributes that hold normals when vertices are transformed. */
#ifndef HE_EDIT_WHOLE_NORMALS_H
#define HE_EDIT_WHOLE_NORMALS_H

#include "mesh/mesh.h"

/* Describes how normals change when an affine map moves some or all vertices. The transformation
 * changes every column `normal` of three floats or doubles on vertices, half-edges or faces: the
 * rows of mapped vertices, of half-edges that leave them, and of faces whose corners are all
 * mapped.
 *
 * A normal is multiplied with the inverse transpose of the map's linear part and scaled to length 1
 * (J. D. Foley, A. van Dam, S. K. Feiner and J. F. Hughes, "Computer Graphics: Principles and
 * Practice", 1990, 5.7), computed by cofactors, which also works for a map that flattens everything
 * into a plane. A normal that is zero, or that the map makes zero, is not changed. A translation
 * changes no normals. */
typedef struct he_normals {
    he_mesh *m;
    const uint32_t *vertices; /* the vertices that the map moves; NULL: all vertices */
    size_t count;
    /* A bit for each vertex: set if the vertex is in `vertices`; NULL if `vertices` is NULL or no
     * normals change. */
    uint64_t *chosen;
    double k[9];
    bool turns;
} he_normals;

/* Finds the columns of normals and computes how they are transformed. *words gets the largest
 * number of records that he_normals_commit can make. he_normals_clear frees *n.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_normals_init(he_normals *n, he_mesh *m, const double matrix[16],
                                       const uint32_t *vertices, size_t count, size_t *words,
                                       he_error *err);
/* Writes the transformed normals. An edit must call it in its COMMIT part, which writes and cannot
 * fail. */
void he_normals_commit(const he_normals *n);
void he_normals_clear(he_normals *n);

#endif
