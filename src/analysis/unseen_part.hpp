// SPDX-License-Identifier: Apache-2.0
// Splits the unseen modes off a pair. Internal.
#pragma once

#include <cmath>

#include "garrison/analysis/modes.hpp"

namespace garrison::detail {

/// Relative distance (16 n^1.5 eps) up to which a mode counts as unseen; up to 1000 times that it is unclear.
inline double unseen_level(Eigen::Index n) {
  return 16.0 * 2.220446049250313e-16 * std::pow(static_cast<double>(n), 1.5);
}
inline constexpr double kUnclear = 1000.0;

/// visibility() without the question of entries that are rounding only.
Visibility examine(const Matrix& A, const Matrix& C, double least);

/// Sets entries to 0 that may be nothing but rounding: off-diagonal ones of A up to 2 eps of its natural
/// rate, those of C up to 2 eps of the largest of their row. (Not more: units may well differ by 1e12.) False
/// when there are none.
bool drop_rounding(Matrix& A, Matrix& C);

}  // namespace garrison::detail
