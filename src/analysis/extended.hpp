// SPDX-License-Identifier: Apache-2.0
// Small matrices of long doubles, for residuals that need the digits. Plain loops: Eigen's blocked ones gain
// nothing at these sizes and take ten seconds to compile in every file that uses them.
#pragma once

#include "garrison/core/types.hpp"

namespace garrison::detail {

using Extended = Eigen::Matrix<long double, Dynamic, Dynamic>;

inline Extended extended(const Matrix& M) { return M.cast<long double>(); }

/// a b
Extended product(const Extended& a, const Extended& b);

/// a b a'
Extended congruence(const Extended& a, const Extended& b);

/// Upper triangular R with R R' = S^-1, S positive definite (otherwise NaN).
Extended inverse_root(const Extended& S);

}  // namespace garrison::detail
