// SPDX-License-Identifier: Apache-2.0
// The step through a general nonlinear programming solver: a cross-check of the exact one.
#pragma once

#include <memory>

#include "garrison/filters/rdkf/step.hpp"

namespace garrison::rdkf {

/// Built with the system's Ipopt (CMake option GARRISON_IPOPT).
GARRISON_EXPORT bool ipopt_available();
/// Refuses when it was not, and says how to get it.
GARRISON_EXPORT void require_ipopt();

/// eps where none was asked for.
inline constexpr double kIpoptSmoothing = 1e-6;

/// min over x of lambda sqrt(|b - M x|^2 + eps^2) + (x - x0)' Q (x - x0), n variables, no constraint, exact
/// Hessian.
///
/// The plain norm does not end at a zero residual, and the cone |r|^2 <= t^2 violates the constraint
/// qualification at its apex; so the norm is smoothed, and the error in x is O(eps) where the true residual
/// is zero, O(eps^2/3) on the edge and O(eps^2) elsewhere: 2e-7, 4e-5 and 1e-13 at eps = 1e-6
/// (docs/filters/rdkf.md#r-ipopt). It allocates, takes milliseconds, and one solve at a time runs in the
/// process. Sizes as in `solve`, b whitened. Returns the iterations and mu; iterations = -1 when the solver
/// failed, x is then x0.
GARRISON_EXPORT Step solve_ipopt(const MatrixRef& Q, const MatrixRef& M, const VectorRef& b,
                                 const Price& price, double* x) noexcept;

}  // namespace garrison::rdkf
