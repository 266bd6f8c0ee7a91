// SPDX-License-Identifier: Apache-2.0
// Splits the unseen modes off a pair. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "garrison/analysis/modes.hpp"

namespace garrison::detail {

/// Relative distance up to which a mode counts as unseen: 16 n^1.5 eps, at most 2000 eps.
inline double unseen_level(Eigen::Index n) {
  const double factor = std::min(16.0 * std::pow(static_cast<double>(n), 1.5), 2000.0);
  return factor * std::numeric_limits<double>::epsilon();
}
/// Up to this it is unclear: 1000 times that, at most 1e-10.
inline double unclear_level(Eigen::Index n) { return std::min(1000.0 * unseen_level(n), 1e-10); }

/// visibility() without the question of entries that are rounding only.
Visibility examine(const Matrix& A, const Matrix& C, double least);

/// Sets entries to 0 that may be nothing but rounding: off-diagonal ones of A up to 2 eps of its natural
/// rate, those of C up to 2 eps of the largest of their row. (Not more: units may well differ by 1e12.) False
/// when there are none.
bool drop_rounding(Matrix& A, Matrix& C);

}  // namespace garrison::detail
