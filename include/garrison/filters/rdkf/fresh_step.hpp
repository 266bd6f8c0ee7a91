// SPDX-License-Identifier: Apache-2.0
// The convex step where Q and M are used once: no singular values, only triangular factors.
#pragma once

#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {

/// Solves one step like `solve`, without factors made before: the same minimiser within rounding, several
/// times cheaper than `step_factors` and `solve` together. Newton's method on the secular equation with a
/// Cholesky factor of D + mu I per iteration (docs/filters/rdkf.md#r-exact). Its result is checked against
/// the optimality conditions; where D has no inverse, or the check fails, the spectral way of `step_factors`
/// is gone instead.
///
/// @param Q n x n, symmetric positive definite; @param M q x n; @param b q numbers, finite
/// @param penalty norm or huber; @param price of the penalty
/// @param x n numbers, x0 on entry and the minimiser on return
/// @throws InvalidInput where Q is not positive definite
GARRISON_EXPORT Step solve_fresh(const MatrixRef& Q, const MatrixRef& M, Penalty penalty, const Price& price,
                                 const double* b, double* x);

}  // namespace garrison::rdkf
