// SPDX-License-Identifier: Apache-2.0
// Dense algebra in place, for sizes that change from call to call: nothing allocates. Internal.
#pragma once

#include <utility>

#include "garrison/core/types.hpp"

namespace garrison::certificate::detail {

/// Symmetric S (its lower half is read) becomes its Cholesky factor L, S = L L', in the lower half. False
/// when a pivot is not positive.
bool cholesky(Eigen::Ref<Matrix> S) noexcept;
/// x becomes L^-1 x, or L'^-1 x. Only the lower half of L is read.
void solve_lower(const MatrixRef& L, Eigen::Ref<Vector> x) noexcept;
void solve_upper(const MatrixRef& L, Eigen::Ref<Vector> x) noexcept;

/// Least and largest eigenvalue of a symmetric S (both halves are read and destroyed), to rounding of the
/// largest. `room`: 3 columns, at least as many rows as S. (0, 0) for an empty S.
std::pair<double, double> extreme_eigenvalues(Eigen::Ref<Matrix> S, Eigen::Ref<Matrix> room) noexcept;

/// Symmetric S (both halves) becomes diagonal, S = U diag U', by rotations: for the few numbers of a state.
/// U: n x n.
void diagonalise(Eigen::Ref<Matrix> S, Eigen::Ref<Matrix> U) noexcept;

}  // namespace garrison::certificate::detail
