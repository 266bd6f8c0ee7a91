// SPDX-License-Identifier: Apache-2.0
// Splits the unseen modes off a pair. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "garrison/analysis/modes.hpp"

namespace garrison::detail {

/// Relative distance up to which a mode counts as unseen, what a change of coordinates leaves: 4 n eps, at
/// most 500 eps.
inline double unseen_level(Eigen::Index n) {
  return std::min(4.0 * static_cast<double>(n), 500.0) * std::numeric_limits<double>::epsilon();
}
/// What the rounding of a change of coordinates becomes in balanced units: 16 n^1.5 eps, at most 2000 eps. Up
/// to this a mode counts as unseen if it is up to unseen_level in some units.
inline double balanced_level(Eigen::Index n) {
  return std::min(16.0 * std::pow(static_cast<double>(n), 1.5), 2000.0) *
         std::numeric_limits<double>::epsilon();
}
/// Up to this it is unclear: 16000 n^1.5 eps, at most 1e-10.
inline double unclear_level(Eigen::Index n) {
  return std::min(16e3 * std::pow(static_cast<double>(n), 1.5) * std::numeric_limits<double>::epsilon(),
                  1e-10);
}

/// visibility() without the question of entries that are rounding only.
Visibility examine(const Matrix& A, const Matrix& C, double least);

/// Sets entries to 0 that may be nothing but rounding: off-diagonal ones of A up to 2 eps of its natural
/// rate, those of C up to 2 eps of the largest of their row. (Not more: units may well differ by 1e12.) Not
/// those that are small by their units alone: a_ij a_ji and c_j a_ji / c_i are the same in all units. False
/// when there are none.
bool drop_rounding(Matrix& A, Matrix& C);

/// Makes entries that are that small, up to unclear_level(), but not 0, as large as the others: what a mode
/// would be seen by if they were not so small. False when there are none.
bool enlarge_small(Matrix& A, Matrix& C);

}  // namespace garrison::detail
