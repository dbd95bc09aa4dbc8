/* conjugate.h - solutions of linear systems whose diagonal is heavy, by conjugate gradients.
 *
 * A step of time t of a flow has the matrix M + t L, where M is diagonal. Unless t is large for the
 * edges of the surface, M is a fair part of the diagonal, and then a few dozen products with the
 * matrix lead to the solution, in less time and memory than a factor takes (M. R. Hestenes and E.
 * Stiefel, "Methods of conjugate gradients for solving linear systems", 1952). The system is
 * preconditioned by the product of its triangles, in the form in which a step is one sweep down and
 * one up (S. C. Eisenstat, "Efficient implementation of a class of preconditioned conjugate
 * gradient methods", 1981). All sums have one order, so the result has the same bits on every
 * machine. */
#ifndef HE_SOLVE_CONJUGATE_H
#define HE_SOLVE_CONJUGATE_H

#include "solve/factor.h"

/* Solves A X = B, for at most HE_CONJUGATE_SIDES right sides and a symmetric matrix whose
 * off-diagonal entries sum up, in nearly all rows, to noticeably less than the diagonal. *solved is
 * false, and the arrays are as they were, if the diagonal is not heavy enough, or if the steps that
 * are worth their time do not make the solution exact up to a few roundings: no row leaves more of
 * its right side than 64 roundings of the row's diagonal entry times the largest number of the
 * solution. A solution has the same bits whatever the other sides are.
 * Returns HE_CANCELLED if the work was cancelled, and HE_NO_MEMORY. */
enum { HE_CONJUGATE_SIDES = 3 };
HE_NODISCARD he_status he_conjugate_solve(const he_sparse *a, he_right_sides sides,
                                          he_progress *progress, bool *solved, he_error *err);

#endif
