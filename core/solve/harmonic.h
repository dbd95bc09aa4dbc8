/* harmonic.h - functions on a surface that are as smooth as their fixed values allow.
 *
 * A function is k-harmonic if its Laplacian, applied k times, is 0 at all free vertices. With k = 1
 * it is continuous at the fixed vertices, with k = 2 its tangent, and with k = 3 its curvature
 * continues, too, if enough rings of vertices are fixed: k of them (Botsch and Kobbelt, An
 * intuitive framework for real-time freeform modeling, 2004). */
#ifndef HE_SOLVE_HARMONIC_H
#define HE_SOLVE_HARMONIC_H

#include "solve/factor.h"
#include "solve/laplacian.h"

typedef struct he_harmonic he_harmonic;

/* Prepares the system of order `k`, 1 to 3. `fixed` is a bit set over the vertices of the operator;
 * vertices of mass 0 must be fixed. At least one vertex of each component must be fixed, or the
 * system has no single solution. The system keeps nothing of the operator. The caller owns the
 * system; it can be solved often, for other fixed values. Returns HE_BAD_VALUE if the system has no
 * single solution, HE_LIMIT, HE_CANCELLED or HE_NO_MEMORY. */
HE_NODISCARD he_status he_harmonic_make(const he_laplacian *l, unsigned k, const uint64_t *fixed,
                                        he_progress *progress, he_harmonic **out, he_error *err);
void he_harmonic_free(he_harmonic *h);
/* Returns the bytes that a system occupies. */
size_t he_harmonic_bytes(const he_harmonic *h);

/* Replaces the values of the free vertices. `values` has `sides` functions of one number for each
 * vertex, function after function; the fixed ones are read. `once` and `residual` are those of
 * he_factor_solve.
 * Returns HE_NOT_FINITE if a value is not finite, or HE_NO_MEMORY; the values of free vertices then
 * have no meaning. */
HE_NODISCARD he_status he_harmonic_solve(const he_harmonic *h, double *values, uint32_t sides,
                                         bool once, double *residual, he_error *err);

#endif
