/* laplacian.h - the Laplace operator of a surface of triangles. */
#ifndef HE_SOLVE_LAPLACIAN_H
#define HE_SOLVE_LAPLACIAN_H

#include "solve/intrinsic.h"
#include "solve/sparse.h"

/* The operator in its weak form: matrix L and lumped masses m. L has, for each edge (i, j) of the
 * intrinsic Delaunay triangulation with the opposite angles a and b, the entry
 * -(cot a + cot b) / 2 at (i, j), and the sum of a row is 0, so L is positive semidefinite; the
 * Laplacian of a function f is -L f / m. The mass of a vertex is a third of the area of the
 * triangles around it. Both are for lengths in units of the mesh. A vertex without triangles has
 * the mass 0, and zero as its only entry. */
typedef struct he_laplacian {
    he_sparse matrix;
    double *masses;
    uint64_t flips; /* intrinsic edges that were flipped */
} he_laplacian;

/* Makes the operator. The caller frees it with he_laplacian_clear.
 * Returns what he_intrinsic_make and he_sparse_make return, and HE_CANCELLED. */
HE_NODISCARD he_status he_laplacian_make(const he_surface *surface, he_progress *progress,
                                         he_laplacian *out, he_error *err);
void he_laplacian_clear(he_laplacian *l);

/* Makes the matrix m + amount L, with masses on the diagonal, of an implicit step of the heat
 * equation by the time `amount` (Desbrun, Meyer, Schroeder and Barr, Implicit fairing of irregular
 * meshes using diffusion and curvature flow, 1999). */
HE_NODISCARD he_status he_laplacian_step(const he_laplacian *l, double amount, he_sparse *out,
                                         he_error *err);

#endif
